"""The service when its disk is full, and what it does to the folder of its data: nothing."""
import shutil
import tempfile
import unittest
from pathlib import Path

from service import BERLIN, CITY, Service

TILE = "3910_5817.gml"
ROOM = 1_000_000  # bytes of a file: enough for the job database and a small job, not for a mesh as text
FEW = {"bbox": [13.400, 52.497, 13.401, 52.498]}


class Disk(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="citymesh-e2e-")
        self.addCleanup(folder.cleanup)
        self.data, self.state = Path(folder.name) / "data", Path(folder.name) / "state"
        self.data.mkdir()
        shutil.copy(BERLIN / TILE, self.data)

    def serve(self, **limits):
        service = Service(self.data, self.state, **limits)
        self.addCleanup(service.kill)
        return service

    def test_job_on_a_full_disk_fails_with_the_reason_and_leaves_no_files(self):
        service = self.serve(max_file_bytes=ROOM)
        job = service.execute({"bbox": CITY, "formats": ["stl"]})
        status = service.wait(job)
        self.assertEqual(status["status"], "failed", status)
        self.assertIn("cannot write", status["message"])
        self.assertIn("too large", status["exception"]["detail"])
        self.assertEqual(list((self.state / "results").glob(job.rsplit("/", 1)[1] + "/*")), [])

        small = service.execute({"bbox": FEW})
        self.assertEqual(service.wait(small)["status"], "successful")

    def test_data_stay_as_they_are(self):
        before = {path: path.stat().st_mtime_ns for path in (self.data, *self.data.rglob("*"))}
        service = self.serve()
        self.assertEqual(service.wait(service.execute({"bbox": FEW}))["status"], "successful")
        self.assertEqual(service.stop(), 0)
        self.assertEqual({path: path.stat().st_mtime_ns for path in (self.data, *self.data.rglob("*"))}, before)


if __name__ == "__main__":
    unittest.main()

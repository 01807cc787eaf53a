"""`kill -9` in the middle of a job: after a restart the job is finished or honestly failed, and no other one is touched."""
import tempfile
import unittest
from pathlib import Path

from service import OPEN, SEA, Service, is_closed, make_big_city, read_obj


class Crash(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="citymesh-e2e-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.city = make_big_city(self.folder / "city")

    def start(self):
        service = Service(self.city, self.folder / "state", "--workers", "1", "--threads", "2")
        self.addCleanup(service.kill)
        return service

    @staticmethod
    def path_of(job):
        return "/jobs/" + job.rsplit("/", 1)[1]

    def test_job_survives_two_kills_of_the_server(self):
        service = self.start()
        before = self.path_of(service.execute({"bbox": SEA}))
        self.assertEqual(service.wait(before)["status"], "successful")
        report = service.get(before + "/results/report").body
        running = self.path_of(service.execute({}))
        waiting = self.path_of(service.execute({"bbox": SEA}))

        for _ in range(2):
            status = service.wait(running, lambda status: status.get("done", 0) > 0 or status["status"] not in OPEN)
            self.assertIn(status["status"], OPEN, "the job was over before its server could be killed")
            service.kill()
            service = self.start()

        status = service.wait(running)
        self.assertIn(status["status"], ("successful", "failed"))
        if status["status"] == "failed":
            self.assertTrue(status["exception"]["detail"])
        else:
            bodies = read_obj(service.get(running + "/results/obj").body.decode())
            self.assertGreater(len(bodies), 100)
            self.assertEqual([name for name, faces in bodies.items() if not is_closed(faces)], [])
        self.assertEqual(service.wait(waiting)["status"], "successful")
        self.assertEqual(service.get(before + "/results/report").body, report)

    def test_job_that_kills_its_server_every_time_fails_with_the_reason(self):
        service = self.start()
        job = self.path_of(service.execute({}))
        for _ in range(10):
            status = service.wait(job, lambda status: status.get("done", 0) > 0 or status["status"] not in OPEN)
            if status["status"] not in OPEN:
                break
            service.kill()
            service = self.start()
        self.assertEqual(status["status"], "failed", status)
        self.assertTrue(status["exception"]["detail"])
        self.assertEqual(service.wait(service.execute({"bbox": SEA}))["status"], "successful")


if __name__ == "__main__":
    unittest.main()

"""The Python client against the real service."""
import io
import json
import os
import pty
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import citymesh_client
from citymesh_client import Client
from citymesh_client.progress import Eta, ProgressBar
from service import ROOT, SEA, SMALL, ServiceTest

BOX = SMALL["bbox"]
BOX_TEXT = ",".join(map(str, BOX))
# Two buildings that lie further apart than the numbers of binary STL reach.
FAR_APART = ["BLDG_0003000e00964090", "BLDG_000300080002fb36"]
NO_JOB = "00000000-0000-4000-8000-000000000000"


class Terminal(io.StringIO):
    def isatty(self):
        return True


class PythonClient(ServiceTest):
    options = ("--workers", "1")

    def setUp(self):
        self.client = Client(self.service.url)
        folder = tempfile.TemporaryDirectory(prefix="citymesh-client-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_processes_are_listed_and_described(self):
        self.assertEqual({process["id"] for process in self.client.processes()} & {"export-for-simulation", "heal", "validate"},
                         {"export-for-simulation", "heal", "validate"})
        self.assertIn("bbox", self.client.process("heal")["inputs"])

    def test_estimate_makes_no_job(self):
        before = len(list(self.client.jobs()))
        expected = self.client.estimate("heal", {"bbox": {"bbox": BOX}, "formats": ["cityjson"]})
        self.assertGreater(expected["buildings"], 0)
        self.assertIn("cityjson", expected["expected"]["outputs"])
        self.assertEqual(len(list(self.client.jobs())), before)

    def test_export_is_one_line(self):
        files = self.client.export(BOX, to=self.folder / "new" / "folder", formats=["obj", "stl"], snap_tolerance_m=0.002)
        self.assertLessEqual({"model.obj", "model.stl", "report.json", "report.html", "picture.svg", "run.json"}, files.keys())
        self.assertEqual(sorted(path.name for path in (self.folder / "new" / "folder").iterdir()), sorted(files))
        report = json.loads(files["report.json"].read_text(encoding="utf-8"))
        self.assertGreater(report["counts"]["delivered"], 0)
        self.assertEqual(report["options"]["snap_tolerance_m"], 0.002)

    def test_files_are_what_the_service_has(self):
        job = self.client.submit("export-for-simulation", {"bbox": SMALL})
        status = job.wait()
        self.assertEqual((status.state, status.percent), ("successful", 100))
        self.assertEqual({file.name for file in job.files()}, {file.name for file in status.files})
        by_output, by_name = job.download("obj", self.folder), job.download("model.obj", self.folder / "mesh.obj")
        self.assertEqual(by_output, self.folder / "model.obj")
        mesh = self.service.get(f"/jobs/{job.id}/results/obj").body
        self.assertEqual([by_output.read_bytes(), by_name.read_bytes()], [mesh, mesh])
        self.assertEqual(next(file.size_bytes for file in status.files if file.name == "model.obj"), len(mesh))
        self.assertIn("obj", job.results())

    def test_progress_is_told_to_a_function(self):
        seen = []
        self.client.submit("export-for-simulation", {"bbox": SMALL}).wait(progress=seen.append)
        self.assertEqual(seen[-1].state, "successful")
        self.assertTrue(all(not status.ended for status in seen[:-1]))

    def test_job_of_another_time_is_found_by_its_id(self):
        job = self.client.submit("validate", {"bbox": SMALL})
        self.assertEqual(self.client.job(job.id).wait().job_id, job.id)
        self.assertIn(job.id, [status.job_id for status in self.client.jobs(processID="validate", status=["successful", "failed"])])

    def test_same_key_is_the_same_job(self):
        first = self.client.submit("export-for-simulation", {"bbox": SEA}, idempotency_key="key of this test")
        again = self.client.submit("export-for-simulation", {"bbox": SEA}, idempotency_key="key of this test")
        self.assertEqual(first.id, again.id)
        with self.assertRaises(citymesh_client.InvalidRequest) as caught:
            self.client.submit("export-for-simulation", {"bbox": SMALL}, idempotency_key="key of this test")
        self.assertEqual(caught.exception.status, 422)

    def test_refusals_carry_the_explanation(self):
        with self.assertRaises(citymesh_client.InvalidRequest) as caught:
            self.client.submit("export-for-simulation", {"formats": ["dxf"]})
        self.assertEqual(caught.exception.problem["status"], 400)
        self.assertIn("dxf", caught.exception.detail)
        with self.assertRaises(citymesh_client.NotFound) as caught:
            self.client.submit("paint", {})
        self.assertTrue(caught.exception.type.endswith("/no-such-process"))
        for broken in (self.client.job(NO_JOB).status, self.client.job(NO_JOB).wait, self.client.job("../processes").status):
            with self.assertRaises(citymesh_client.NotFound):
                broken()
        done = self.client.submit("validate", {"bbox": SEA})
        done.wait()
        with self.assertRaises(citymesh_client.NotFound):
            done.download("no such file", self.folder)
        with self.assertRaises(citymesh_client.Conflict):
            done.dismiss()
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_failed_job_says_why(self):
        job = self.client.submit("export-for-simulation", {"object_ids": FAR_APART, "formats": ["stl_binary"]})
        try:
            job.wait()
        except citymesh_client.JobFailed as failed:
            self.assertEqual(failed.job_id, job.id)
            self.assertTrue(failed.problem["detail"])
            self.assertIn(failed.problem["detail"], str(failed))
            self.assertEqual(job.files(), [])
        else:
            self.fail("the job should have failed")

    def test_dismissed_and_late_jobs(self):
        jobs = [self.client.submit("export-for-simulation", {}) for _ in range(3)]
        with self.assertRaises(citymesh_client.WaitTimeout):
            jobs[-1].wait(timeout_s=0.1)
        for job in reversed(jobs):
            self.assertEqual(job.dismiss().state, "dismissed")
        with self.assertRaises(citymesh_client.JobDismissed):
            jobs[-1].wait()

    def test_wrong_use_is_explained_before_anything_is_sent(self):
        for wrong in ("ftp://example.org", "example.org", "http://name:word@example.org", ""):
            with self.assertRaises(ValueError):
                Client(wrong)
        with self.assertRaises(ValueError):
            Client(self.service.url, api_key="a", token="b")
        with self.assertRaises(ValueError) as caught:
            self.client.export("13.4,52.5", to=self.folder)
        self.assertIn("13.4,52.5", str(caught.exception))
        self.assertEqual(citymesh_client.parse_bbox("1,2,3,4@EPSG:25833"), {"bbox": [1, 2, 3, 4], "crs": "EPSG:25833"})

    def run_command(self, *words, **environment):
        return subprocess.run([sys.executable, "-B", "-m", "citymesh_client", *words], capture_output=True, text=True, timeout=240,
                              env={**os.environ, **environment})

    def test_command_exports(self):
        done = self.run_command("export", "--url", self.service.url, "--bbox", BOX_TEXT, "--format", "obj,stl", "--set", "lod=2,1",
                                "--set", "planarity_tolerance_m=0.02", "--output", str(self.folder))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("successful", done.stderr)
        self.assertEqual({Path(line).name for line in done.stdout.splitlines()}, {path.name for path in self.folder.iterdir()})
        options = json.loads((self.folder / "report.json").read_text(encoding="utf-8"))["options"]
        self.assertEqual((options["lod"], options["planarity_tolerance_m"]), (["2", "1"], 0.02))

    def test_command_shows_a_bar_on_a_terminal(self):
        ours, theirs = pty.openpty()
        with open(ours, "rb", buffering=0) as terminal:
            process = subprocess.Popen([sys.executable, "-B", "-m", "citymesh_client", "export", "--url", self.service.url, "--bbox",
                                        BOX_TEXT, "--output", str(self.folder)], stdout=subprocess.DEVNULL, stderr=theirs)
            os.close(theirs)
            shown = b""
            try:
                while piece := terminal.read(4096):
                    shown += piece
            except OSError:
                pass  # how a terminal says that its other end is closed
            self.assertEqual(process.wait(240), 0, shown)
        self.assertIn(b"\r\033[K", shown)
        self.assertIn(b"model.obj [", shown)

    def test_command_explains_what_went_wrong(self):
        refused = self.run_command("export", "--url", self.service.url, "--set", "colour=red", "--output", str(self.folder))
        self.assertEqual(refused.returncode, 1)
        self.assertIn("colour", refused.stderr)
        usage = self.run_command("export", "--url", self.service.url, "--bbox", "-1,2", "--output", str(self.folder))
        self.assertEqual(usage.returncode, 2)
        self.assertIn("minx,miny", usage.stderr)
        nobody = self.run_command("processes", "--url", "http://127.0.0.1:9", "--retries", "0")
        self.assertEqual(nobody.returncode, 1)
        self.assertIn("127.0.0.1:9", nobody.stderr)

    def test_interrupted_command_says_how_to_go_on(self):
        command = [sys.executable, "-B", "-m", "citymesh_client", "export", "--url", self.service.url, "--output", str(self.folder)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            job = process.stderr.readline().split()[1]
            process.stderr.readline()  # the first state: it waits
            process.send_signal(signal.SIGINT)
            _, told = process.communicate(timeout=240)
        self.assertEqual(process.returncode, 130, told)
        self.assertIn(f"fetch --url {self.service.url} {job} --output", told)
        dismissed = self.run_command("dismiss", job, "--url", self.service.url)
        self.assertEqual((dismissed.returncode, dismissed.stdout), (0, "dismissed\n"))

    def test_command_fetches_a_job_of_before(self):
        job = self.client.submit("validate", {"bbox": SMALL})
        done = self.run_command("fetch", job.id, "--url", self.service.url, "--output", str(self.folder), "--quiet")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("report.json", done.stdout)


class Bar(unittest.TestCase):
    def setUp(self):
        self.now = 0.0

    def status(self, done, total=12, **more):
        return citymesh_client.JobStatus("id", "running", stage="heal", done=done, total=total, **more)

    def test_bar_shows_stage_counts_and_time_left(self):
        out = Terminal()
        with ProgressBar(out, lambda: self.now) as bar:
            bar.job(self.status(3, eta_s=125.0))
            self.assertIn("heal     [#######.......................] 3/12  25 %, 2:05 left", out.getvalue())
        self.assertTrue(out.getvalue().endswith("\r\033[K"))

    def test_time_left_is_reckoned_where_the_service_does_not_tell(self):
        eta = Eta(lambda: self.now)
        self.assertIsNone(eta.of("heal", 2, 12))
        self.now = 4.0
        self.assertEqual(eta.of("heal", 4, 12), 16.0)
        self.assertIsNone(eta.of("write", 1, 12), "the rate of another stage says nothing")

    def test_lines_are_few_where_there_is_no_terminal(self):
        out = io.StringIO()
        with ProgressBar(out, lambda: self.now) as bar:
            for done in range(12):
                self.now += 0.5
                bar.job(self.status(done))
                bar.download("small.obj", 1, 2)
        self.assertEqual(len(out.getvalue().splitlines()), 2)
        self.assertNotIn("\r", out.getvalue())


class Package(unittest.TestCase):
    def test_version_is_the_same_everywhere(self):
        folder = ROOT / "clients" / "python"
        self.assertIn(f'version = "{citymesh_client.__version__}"', (folder / "pyproject.toml").read_text())
        self.assertIn(f"citymesh-client/{citymesh_client.__version__}", (folder / "citymesh_client" / "transport.py").read_text())


if __name__ == "__main__":
    unittest.main()

"""Clients that have to show who they are, with keys that `citymesh make-key` made: each sees its own jobs only."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import citymesh_client
from citymesh_client import Client
from service import PROGRAM, SEA, ServiceTest

try:
    import grpc
except ImportError:
    grpc = None

VALIDATE = "validate"


class Access(ServiceTest):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="citymesh-keys-")
        cls.addClassCleanup(folder.cleanup)
        file = Path(folder.name) / "keys"
        cls.keys = {}
        with open(file, "w", encoding="utf-8") as lines:
            for name, role in (("portal", "submit"), ("other", "submit"), ("reader", "read-own"), ("operator", "admin")):
                made = subprocess.run([PROGRAM, "make-key", name, role], check=True, capture_output=True, text=True)
                lines.write(made.stdout)
                cls.keys[name] = made.stderr.split()[-1]
        cls.options = ("--api_keys", str(file))
        super().setUpClass()

    def client(self, name):
        return Client(self.service.url, api_key=self.keys[name], retries=0)

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="citymesh-client-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_key_opens_the_whole_way_to_the_files(self):
        files = self.client("portal").export(SEA["bbox"], to=self.folder / "key", progress=False)
        self.assertIn("report.json", files)
        as_bearer = Client(self.service.url, token=self.keys["portal"])
        self.assertIn("report.json", as_bearer.export(SEA["bbox"], to=self.folder / "bearer"))

    def test_without_a_key_or_with_a_wrong_one_nothing_is_submitted(self):
        for stranger in (Client(self.service.url, retries=0), Client(self.service.url, api_key="citymesh_wrong", retries=0),
                         Client(self.service.url, token="wrong", retries=0)):
            with self.assertRaises(citymesh_client.Forbidden) as caught:
                stranger.submit(VALIDATE, {"bbox": SEA})
            self.assertEqual(caught.exception.status, 401)
            self.assertTrue(caught.exception.detail)
        with self.assertRaises(citymesh_client.Forbidden) as caught:
            self.client("reader").submit(VALIDATE, {"bbox": SEA})
        self.assertEqual(caught.exception.status, 403)
        self.assertTrue(Client(self.service.url).processes(), "what the service is stays open")

    def test_jobs_of_others_do_not_exist(self):
        job = self.client("portal").submit(VALIDATE, {"bbox": SEA})
        job.wait()
        other = self.client("other").job(job.id)
        for look in (other.status, other.wait, other.dismiss, lambda: other.download("report", self.folder)):
            with self.assertRaises(citymesh_client.NotFound):
                look()
        seen = {name: job.id in [status.job_id for status in self.client(name).jobs()] for name in self.keys}
        self.assertEqual(seen, {"portal": True, "other": False, "reader": False, "operator": True})
        self.assertEqual(self.client("operator").job(job.id).wait().state, "successful")

    def test_same_idempotency_key_of_two_clients_is_two_jobs(self):
        jobs = {self.client(name).submit(VALIDATE, {"bbox": SEA}, idempotency_key="the same").id for name in ("portal", "other", "portal")}
        self.assertEqual(len(jobs), 2)

    def test_command_takes_the_key_from_the_environment(self):
        command = [sys.executable, "-B", "-m", "citymesh_client", "export", "--url", self.service.url, "--bbox", "3,55,3.01,55.01",
                   "--output", str(self.folder)]
        for variable in ("CITYMESH_API_KEY", "CITYMESH_TOKEN"):
            done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, variable: self.keys["portal"]})
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertNotIn(self.keys["portal"], done.stdout + done.stderr)
        refused = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(refused.returncode, 1)
        self.assertIn("401", refused.stderr)

    @unittest.skipIf(grpc is None, "gRPC for Python is not installed: python3-grpcio")
    def test_key_in_the_metadata_of_a_call(self):
        with grpc.insecure_channel(self.service.grpc) as channel:
            listing = channel.unary_unary("/citymesh.v1.Jobs/List")
            listing(b"", metadata=[("x-api-key", self.keys["portal"])], timeout=60)
            with self.assertRaises(grpc.RpcError) as caught:
                listing(b"", timeout=60)
            self.assertEqual(caught.exception.code(), grpc.StatusCode.UNAUTHENTICATED)

    def test_key_is_in_no_log(self):
        self.client("portal").submit(VALIDATE, {"bbox": SEA}).wait()
        log = self.service.log.read_text(errors="replace")
        for key in self.keys.values():
            self.assertNotIn(key, log)


if __name__ == "__main__":
    unittest.main()

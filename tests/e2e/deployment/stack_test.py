"""The stack of docker-compose.yml while it runs, as deploy/try-compose.sh brought it up."""
import json
import os
import re
import subprocess
import sys
import time
import unittest
import urllib.error
import urllib.request
from pathlib import Path

from service import ROOT, SMALL, delivered_names, is_closed, read_obj

import grpc

STACK = os.environ.get("CITYMESH_STACK")
KEY = os.environ.get("CITYMESH_KEY", "")
LIMIT_S = 240
VERSIONS = ("citymesh", "citymesh-v4")
INPUTS = {"bbox": SMALL, "formats": ["obj"]}


def get(url, body=None, key=KEY):
    request = urllib.request.Request(url, body and json.dumps(body).encode(), {"Content-Type": "application/json", "X-API-Key": key})
    return urllib.request.urlopen(request, timeout=LIMIT_S)


def container_of(service):
    ran = subprocess.run(["podman", "ps", "--filter", f"label=com.docker.compose.service={service}", "--format", "{{.Names}}"],
                         check=True, capture_output=True, text=True)
    return ran.stdout.split()[0]


def inside(service, *command, **more):
    return subprocess.run(["podman", "exec", container_of(service), *command], capture_output=True, text=True, **more)


@unittest.skipUnless(STACK, "CITYMESH_STACK names no running stack; deploy/try-compose.sh does")
class Stack(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.ports = json.loads(Path(STACK).read_text(encoding="utf-8"))
        cls.stubs = str(Path(STACK).parent / "stubs")
        os.makedirs(cls.stubs, exist_ok=True)
        subprocess.run(["protoc", f"-I{ROOT / 'proto'}", f"--python_out={cls.stubs}", f"--grpc_out={cls.stubs}",
                        "--plugin=protoc-gen-grpc=/usr/bin/grpc_python_plugin", "citymesh/v1/jobs.proto"], check=True)
        sys.path.insert(0, cls.stubs)

    def url(self, name):
        return f"http://127.0.0.1:{self.ports[name]}"

    def export_over_rest(self, name):
        """The report and the OBJ file."""
        job = get(self.url(name) + "/processes/export-for-simulation/execution", {"inputs": INPUTS}).headers["Location"]
        limit = time.monotonic() + LIMIT_S
        while (status := json.load(get(job)))["status"] in ("accepted", "running"):
            self.assertLess(time.monotonic(), limit, status)
            time.sleep(0.1)
        self.assertEqual(status["status"], "successful", status)
        return json.load(get(job + "/results/report.json")), get(job + "/results/model.obj").read()

    def export_over_grpc(self, name):
        from citymesh.v1 import jobs_pb2, jobs_pb2_grpc
        metadata = [("x-api-key", KEY)]
        with grpc.insecure_channel(f"127.0.0.1:{self.ports[name + '-grpc']}") as channel:
            jobs = jobs_pb2_grpc.JobsStub(channel)
            job = jobs.Submit(jobs_pb2.SubmitRequest(process="export-for-simulation", inputs_json=json.dumps(INPUTS)),
                              timeout=LIMIT_S, metadata=metadata)
            last = list(jobs.Watch(jobs_pb2.GetRequest(job_id=job.job_id), timeout=LIMIT_S, metadata=metadata))[-1]
            self.assertIn("SUCCESSFUL", jobs_pb2.JobState.Name(last.state))

            def fetch(output):
                request = jobs_pb2.FetchResultRequest(job_id=job.job_id, output=output)
                return b"".join(chunk.data for chunk in jobs.FetchResult(request, timeout=LIMIT_S, metadata=metadata))
            return json.loads(fetch("report")), fetch("obj")

    def test_a_box_is_exported_from_both_versions_by_both_ways(self):
        results = {}
        for name in VERSIONS:
            for way in (self.export_over_rest, self.export_over_grpc):
                with self.subTest(service=name, way=way.__name__):
                    report, obj = way(name)
                    counts = report["counts"]
                    bodies = read_obj(obj.decode())
                    self.assertGreater(counts["requested"], 50)
                    self.assertEqual(counts["delivered"], counts["requested"])
                    self.assertEqual(set(bodies), delivered_names(report))
                    self.assertTrue(all(is_closed(faces) for faces in bodies.values()))
                    results[name, way.__name__] = obj
                    print(f"{name}, {way.__name__}: {counts['delivered']} of {counts['requested']} buildings, {len(bodies)} closed bodies,"
                          f" {len(obj)} bytes of OBJ")
        self.assertEqual(len(results), 4)
        geometry = {"\n".join(line for line in obj.decode().splitlines() if not line.startswith("#")) for obj in results.values()}
        self.assertEqual(len(geometry), 1, "every way and version gives the same meshes")

    def test_whoever_shows_no_key_is_refused(self):
        for name in VERSIONS:
            for path in ("/jobs", "/metrics"):
                with self.assertRaises(urllib.error.HTTPError) as refused:
                    get(self.url(name) + path, key="")
                self.assertEqual(refused.exception.code, 401)
            self.assertEqual(get(self.url(name) + "/readyz", key="").status, 200)

    def test_prometheus_reads_the_metrics_with_its_own_key(self):
        limit = time.monotonic() + 60
        while True:
            found = json.load(get(self.url("prometheus") + "/api/v1/query?query=up%7Bjob%3D%22citymesh%22%7D"))["data"]["result"]
            if found and found[0]["value"][1] == "1":
                break
            self.assertLess(time.monotonic(), limit, found)
            time.sleep(0.5)

    def test_no_secret_stands_in_a_list_of_processes_or_in_a_log(self):
        secrets = {path.name: path.read_text(encoding="utf-8").strip() for path in Path(os.environ["CITYMESH_SECRETS"]).iterdir()
                   if path.name.endswith(("_password", "_key"))}
        self.assertIn("citydb_reader_password", secrets)
        shown = b"\n".join(path.read_bytes() for path in Path("/proc").glob("[0-9]*/cmdline")).decode(errors="replace")
        for name in VERSIONS:
            shown += subprocess.run(["podman", "logs", container_of(name)], capture_output=True, text=True).stdout
        for name, secret in secrets.items():
            self.assertNotIn(secret, shown, name)

    def test_the_service_may_do_little(self):
        for name in VERSIONS:
            self.assertEqual(inside(name, "id", "-u").stdout.strip(), "10001")
            self.assertNotEqual(inside(name, "touch", "/usr/bin/more").returncode, 0)
            self.assertEqual(inside(name, "touch", "/var/lib/citymesh/.writable").returncode, 0)
            status = inside(name, "cat", "/proc/1/status").stdout
            self.assertEqual(re.findall(r"^(?:CapEff|CapBnd):\s*(\w+)", status, re.MULTILINE), ["0" * 16] * 2)
            self.assertRegex(status, r"NoNewPrivs:\s*1")

    def test_the_service_reads_the_database_and_writes_nothing(self):
        reader = Path(os.environ["CITYMESH_SECRETS"], "citydb_reader_password").read_text(encoding="utf-8")
        for name, table in (("citydb", "feature"), ("citydb-v4", "cityobject")):
            def psql(sql):
                command = ["podman", "exec", "--env", "PGPASSWORD", container_of(name), "psql", "-h", "127.0.0.1", "-U", "citymesh", "-d",
                           "citydb", "-Atqc", sql]
                return subprocess.run(command, capture_output=True, text=True, env=os.environ | {"PGPASSWORD": reader})
            self.assertGreater(int(psql(f"SELECT count(*) FROM citydb.{table}").stdout), 1000)
            for sql in (f"DELETE FROM citydb.{table}", "CREATE TABLE citydb.mine (a int)"):
                self.assertIn("permission denied", psql(sql).stderr)

    def test_the_service_stays_up_while_its_database_restarts(self):
        subprocess.run(["podman", "restart", container_of("citydb")], check=True, capture_output=True)
        self.assertEqual(get(self.url("citymesh") + "/healthz").status, 200)
        limit = time.monotonic() + 60
        while inside("citydb", "pg_isready", "-h", "127.0.0.1").returncode != 0:
            self.assertLess(time.monotonic(), limit)
            time.sleep(0.2)
        report, _ = self.export_over_rest("citymesh")
        self.assertGreater(report["counts"]["delivered"], 50)


if __name__ == "__main__":
    unittest.main()

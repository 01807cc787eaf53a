"""Every request that the documentation shows means the same on the command line, over REST and over gRPC, and gives the same bytes."""
import json
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

from grpc_test import GrpcTest
from service import BERLIN, PROGRAM, ROOT

PAGES = ("README.md", "docs/rest.md", "docs/clients.md", "docs/processes/export-for-simulation.md", "docs/processes/heal.md",
         "docs/processes/validate.md")
REQUEST = re.compile(r"/processes/([a-z-]+)/execution.*?-d '(\{.*?\})'", re.DOTALL)
ON_FILES = ("export-for-simulation", "heal", "validate")
NOT_RESULTS = {"run.json", "events.jsonl"}  # times and progress of one run


def documented_requests():
    """(process, body) of every execute request in a code block, each once."""
    found = {}
    for page in PAGES:
        for block in re.findall(r"```sh\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), re.DOTALL):
            for process, body in REQUEST.findall(block):
                if process in ON_FILES:
                    found[process, json.dumps(json.loads(body), sort_keys=True)] = None
    return [(process, json.loads(body)) for process, body in found]


def asks_for_estimate(body):
    return body["inputs"].get("mode") == "estimate"


def command_line(inputs):
    """The arguments of `citymesh run` that say the same."""
    arguments = []
    for name, value in inputs.items():
        if name == "bbox":
            crs = "@" + value["crs"] if "crs" in value else ""
            arguments += ["--bbox", ",".join(map(str, value["bbox"])) + crs]
        elif name == "formats":
            arguments += ["--format", ",".join(value)]
        else:
            arguments += ["--set", f"{name}={value if isinstance(value, str) else json.dumps(value)}"]
    return arguments


class ThreeWays(GrpcTest):
    def over_rest(self, process, body):
        job = self.service.execute(body["inputs"], process)
        status = self.service.wait(job)
        self.assertEqual(status["status"], "successful", status)
        items = {link["title"]: link["href"] for link in status["links"] if link["rel"] == "item"}
        return {name: self.service.get(href).body for name, href in items.items()}

    def over_grpc(self, process, body):
        job = self.watch(self.submit(body["inputs"], process=process))[-1]
        self.assertEqual(job.state, self.pb.SUCCESSFUL, job)
        return {file.file_name: self.fetch(job, file.file_name) for file in job.results}

    def on_the_command_line(self, process, body):
        with tempfile.TemporaryDirectory(prefix="citymesh-e2e-") as folder:
            done = subprocess.run([PROGRAM, "run", process, "--input", BERLIN, "--output", Path(folder) / "out",
                                   *command_line(body["inputs"])], capture_output=True, text=True)
            self.assertIn(done.returncode, (0, 1), done.stderr)  # 1: there were findings
            return {file.name: file.read_bytes() for file in (Path(folder) / "out").iterdir()}

    def test_documented_requests_give_the_same_bytes(self):
        requests = [(process, body) for process, body in documented_requests() if not asks_for_estimate(body)]
        self.assertGreaterEqual({process for process, _ in requests}, set(ON_FILES))
        for process, body in requests:
            with self.subTest(process=process, inputs=body["inputs"]):
                rest, grpc, command = (way(process, body) for way in (self.over_rest, self.over_grpc, self.on_the_command_line))
                options = [json.loads(files["report.json"])["options"] for files in (rest, grpc, command)]
                self.assertEqual(options[0], options[1])
                self.assertEqual(options[0], options[2])
                names = rest.keys() - NOT_RESULTS
                self.assertIn("report.json", names)
                self.assertEqual(names, grpc.keys() - NOT_RESULTS)
                self.assertEqual(names, command.keys() - NOT_RESULTS)
                for name in sorted(names):
                    self.assertEqual(rest[name], grpc[name], name)
                    self.assertEqual(rest[name], command[name], name)

    def test_documented_estimates_say_the_same(self):
        requests = [(process, body) for process, body in documented_requests() if asks_for_estimate(body)]
        self.assertTrue(requests)
        for process, body in requests:
            with self.subTest(process=process, inputs=body["inputs"]):
                answer = self.service.send("POST", f"/processes/{process}/execution", body)
                self.assertEqual(answer.status, 200, answer.body)
                rest = answer.json()
                grpc = self.jobs.Estimate(self.pb.SubmitRequest(process=process, inputs_json=json.dumps(body["inputs"])), timeout=30)
                done = subprocess.run([PROGRAM, "run", process, "--input", BERLIN, *command_line(body["inputs"])],
                                      capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stderr)
                command = json.loads(done.stdout)
                self.assertGreater(rest["buildings"], 0)
                self.assertEqual(rest["buildings"], grpc.buildings)
                self.assertEqual(rest["expected"]["bytes"], grpc.expected_bytes)
                self.assertEqual(rest["expected"]["outputs"], {output.output: output.bytes for output in grpc.outputs})
                for member in ("process", "buildings", "crs", "problems"):
                    self.assertEqual(rest[member], command[member])
                self.assertEqual(rest["expected"]["outputs"].keys(), command["expected"]["outputs"].keys())


del GrpcTest  # its tests are those of grpc_test.py

if __name__ == "__main__":
    unittest.main()

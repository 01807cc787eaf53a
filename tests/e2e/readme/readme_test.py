#!/usr/bin/env python3
"""Runs the code blocks of the README, of the pages about REST, about echo and about clients, and of the Python client's README, as
they stand, against a server of our own: only the two addresses and the place of the program are replaced.

    readme_test.py CITYMESH
"""
import hmac
import json
import os
import re
import signal
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PROGRAM = None
BLOCK = re.compile(r"```(sh|python)\n(.*?)```", re.DOTALL)
READY_LIMIT_S = 60


def python_with(modules):
    """Debian's Python has Debian's packages; another one in front of it may not."""
    for python in (sys.executable, "/usr/bin/python3"):
        if subprocess.run([python, "-c", f"import {modules}"], capture_output=True).returncode == 0:
            return python
    return None


class Readme(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        blocks, cls.rest_blocks, cls.client_blocks, cls.package_blocks, cls.echo_blocks = (
            BLOCK.findall((ROOT / page).read_text(encoding="utf-8"))
            for page in ("README.md", "docs/rest.md", "docs/clients.md", "clients/python/README.md", "docs/processes/echo.md"))
        cls.run_block, cls.curl_block, cls.python_block, cls.stubs_block, cls.grpc_block = blocks
        cls.folder = Path(tempfile.mkdtemp(prefix="citymesh-readme-"))
        for name in ("tests", "proto", "clients"):
            (cls.folder / name).symlink_to(ROOT / name)
        cls.log = open(cls.folder / "server.log", "wb")
        cls.server = subprocess.Popen(
            [PROGRAM, "serve", "--data", "tests/data/berlin", "--state", "state", "--listen", "127.0.0.1:0", "--grpc", "127.0.0.1:0"],
            cwd=cls.folder, stdout=cls.log, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
        try:
            cls.rest, cls.grpc = cls.addresses()
        except BaseException:
            cls.tearDownClass()
            raise

    @classmethod
    def addresses(cls):
        limit = time.monotonic() + READY_LIMIT_S
        while time.monotonic() < limit and cls.server.poll() is None:
            for line in (cls.folder / "server.log").read_text(errors="replace").splitlines():
                if line.startswith("{") and '"listening"' in line:
                    event = json.loads(line)
                    return event["rest"].removeprefix("http://"), event["grpc"]
            time.sleep(0.05)
        raise AssertionError("the server did not say where it listens:\n" + (cls.folder / "server.log").read_text(errors="replace"))

    @classmethod
    def tearDownClass(cls):
        if cls.server.poll() is None:
            cls.server.send_signal(signal.SIGTERM)
            cls.server.wait(30)
        cls.log.close()
        shutil.rmtree(cls.folder, ignore_errors=True)

    def run_example(self, block, python=sys.executable):
        kind, text = block
        text = text.replace("127.0.0.1:8080", self.rest).replace("127.0.0.1:50051", self.grpc)
        text = text.replace("build/release/services/apps/citymesh", str(PROGRAM))
        command = [python, "-B", "-c", text] if kind == "python" else ["bash", "-euc", text]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=120, stdin=subprocess.DEVNULL,
                              env={"PYTHONPATH": "clients/python", **os.environ, "no_proxy": "*"})
        self.assertEqual(done.returncode, 0, f"{text}\n{done.stdout}\n{done.stderr}")
        return done.stdout

    def counts(self, report):
        counts = json.loads((self.folder / report).read_text(encoding="utf-8"))["counts"]
        self.assertGreater(counts["delivered"], 0)
        return counts

    def test_command_line(self):
        self.run_example(self.run_block)
        self.counts("out/mitte/report.json")
        self.assertTrue((self.folder / "out/mitte/model.obj").exists())
        self.assertTrue((self.folder / "out/mitte/model.stl").exists())

    def test_echo(self):
        answer = json.loads(self.run_example(self.echo_blocks[0]))
        self.assertEqual(answer, {"number": {"mediaType": "application/json", "value": 1.5}, "text": "hello"})

    def test_all_ways_give_the_same_mesh(self):
        self.assertIn("successful", self.run_example(self.curl_block))
        self.counts("out/curl/report.json")
        mesh = (self.folder / "out/curl/model.obj").read_bytes()

        self.assertIn("successful", self.run_example(self.python_block))
        self.assertEqual(mesh, (self.folder / "out/python/model.obj").read_bytes())

        python = python_with("grpc, google.protobuf")
        if python is None or shutil.which("grpc_python_plugin") is None:
            self.skipTest("gRPC for Python is not installed: python3-grpcio, protobuf-compiler-grpc")
        self.run_example(self.stubs_block)
        self.assertIn("SUCCESSFUL", self.run_example(self.grpc_block, python))
        self.assertEqual(mesh, (self.folder / "out/grpc/model.obj").read_bytes())

    def check_verification(self, text):
        names = {}
        exec(compile(text, "docs/rest.md", "exec"), names)
        seconds = str(int(time.time()))
        digest = hmac.new(b"secret", seconds.encode() + b".{}", "sha256").hexdigest()
        self.assertTrue(names["is_genuine"](f"t={seconds},v1={digest}", b"{}", b"secret"))
        self.assertFalse(names["is_genuine"](f"t={seconds},v1={digest}", b"{ }", b"secret"))
        self.assertFalse(names["is_genuine"](f"t={int(seconds) - 1},v1={digest}", b"{}", b"secret"))

    def test_page_about_rest(self):
        at_once, estimate, as_job, events, verification, download = self.rest_blocks
        self.check_verification(verification[1])
        report = json.loads(self.run_example(at_once))
        self.assertEqual(report["process"], "validate")
        self.assertGreater(report["counts"]["requested"], 0)
        self.assertEqual(json.loads(self.run_example(estimate))["buildings"], 57)
        accepted = self.run_example(as_job)
        self.assertIn("HTTP/1.1 201", accepted)
        self.assertIn("Preference-Applied: respond-async", accepted)
        seen = self.run_example(events)
        self.assertIn("event: status", seen)
        self.assertIn('"status":"successful"', seen)
        self.assertEqual(self.run_example(download).strip(), "304")
        lines = (self.folder / "out/rest/model.obj").read_text().splitlines()
        self.assertGreater(len(lines), 20)
        self.assertTrue(lines[0].startswith("#") and all(line[:2] in ("# ", "o ", "g ", "v ", "f ", "") for line in lines), lines[:3])

    def test_page_about_clients(self):
        curl, python, command, stubs, grpc, owslib = self.client_blocks
        self.assertIn("event: status", self.run_example(curl))
        self.counts("out/with-curl/report.json")
        mesh = (self.folder / "out/with-curl/model.obj").read_bytes()

        self.assertIn("delivered", self.run_example(python))
        self.assertIn("out/with-command/model.obj", self.run_example(command))
        for way in ("with-client", "with-command"):
            self.assertEqual(mesh, (self.folder / "out" / way / "model.obj").read_bytes())

        with self.subTest("gRPC"):
            interpreter = python_with("grpc, google.protobuf")
            if interpreter is None or shutil.which("grpc_python_plugin") is None:
                self.skipTest("gRPC for Python is not installed: python3-grpcio, protobuf-compiler-grpc")
            self.run_example(stubs)
            self.assertIn("SUCCESSFUL", self.run_example(grpc, interpreter))
            self.assertEqual(mesh, (self.folder / "out/with-grpc/model.obj").read_bytes())
        with self.subTest("owslib"):
            interpreter = python_with("owslib.ogcapi.processes")
            if interpreter is None:
                self.skipTest("owslib is not installed: python3-owslib")
            self.assertIn("requested", self.run_example(owslib, interpreter))

    def test_readme_of_the_python_client(self):
        export, steps, command = self.package_blocks
        self.assertIn("report.json", self.run_example(export))
        self.assertIn("successful", self.run_example(steps))
        self.assertEqual(json.loads((self.folder / "healed.city.json").read_text(encoding="utf-8"))["type"], "CityJSON")
        self.assertIn("out/mitte-command/model.obj", self.run_example(command))
        self.assertEqual((self.folder / "out/mitte-python/model.obj").read_bytes(),
                         (self.folder / "out/mitte-command/model.obj").read_bytes())


if __name__ == "__main__":
    PROGRAM = Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)

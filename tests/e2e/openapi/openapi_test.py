"""The description of the REST API: it lints clean, and neither requests nor answers differ from it (prism stands between client and
service and turns every difference into an error)."""
import functools
import os
import re
import shutil
import socket
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import rest_test
from service import EXECUTION, LIMIT_S, PROGRAM, ROOT, SEA, ServiceTest

HERE = Path(__file__).resolve().parent
NODE = Path(os.environ.get("CITYMESH_NODE", HERE / "node"))
PAGES = ("rest.md", "clients.md", "processes/export-for-simulation.md", "processes/heal.md", "processes/validate.md",
         "processes/echo.md")
INSTALL_LIMIT_S = 600
PROGRAMS = NODE / "node_modules" / ".bin"


@functools.cache
def install():
    """Why the programs of package-lock.json cannot be had; empty: they are there."""
    lock = NODE / "package-lock.json"
    if (PROGRAMS / "prism").exists() and lock.exists() and lock.read_bytes() == (HERE / lock.name).read_bytes():
        return ""
    if shutil.which("npm") is None:
        return "npm is not installed"
    NODE.mkdir(parents=True, exist_ok=True)
    lock.unlink(missing_ok=True)
    with tempfile.TemporaryDirectory(dir=NODE) as folder:
        for name in ("package.json", "package-lock.json", ".npmrc"):
            shutil.copy(HERE / name, folder)
        try:
            done = subprocess.run(["npm", "ci", "--loglevel=error"], cwd=folder, capture_output=True, text=True,
                                  timeout=INSTALL_LIMIT_S, stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            return f"npm did not get prism and spectral within {INSTALL_LIMIT_S} s"
        if done.returncode != 0:
            return "npm cannot get prism and spectral: " + " ".join(done.stderr.split())[:200]
        shutil.rmtree(NODE / "node_modules", ignore_errors=True)
        shutil.move(Path(folder) / "node_modules", NODE)
        shutil.copy(HERE / lock.name, lock)
    return ""


def skip_without_programs():
    why_not = install()
    if why_not:
        raise unittest.SkipTest(why_not)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Proxied:
    """A service behind prism; its own links lead through prism, too."""

    expected_violations = set()

    @classmethod
    def setUpClass(cls):
        skip_without_programs()
        port = free_port()
        proxy = f"http://127.0.0.1:{port}"
        cls.options = ("--public_url", proxy)
        super().setUpClass()
        description = Path(cls.folder.name) / "openapi.json"
        description.write_bytes(cls.service.get("/openapi.json").body)
        cls.prism_log = Path(cls.folder.name) / "prism.log"
        with open(cls.prism_log, "wb") as log:
            cls.prism = subprocess.Popen([PROGRAMS / "prism", "proxy", description, cls.service.url, "--host", "127.0.0.1",
                                          "--port", str(port), "--errors"], stdin=subprocess.DEVNULL, stdout=log,
                                         stderr=subprocess.STDOUT)
        cls.addClassCleanup(cls.prism.wait)
        cls.addClassCleanup(cls.prism.kill)
        cls.wait_for_prism("Prism is listening")
        cls.service.url = proxy

    @classmethod
    def wait_for_prism(cls, words):
        """What it has said when it has said this."""
        limit = time.monotonic() + LIMIT_S
        while cls.prism.poll() is None and time.monotonic() < limit:
            said = cls.prism_log.read_text(errors="replace")
            if words in said:
                return said
            time.sleep(0.05)
        raise AssertionError(f"prism does not say '{words}':\n" + cls.prism_log.read_text(errors="replace"))

    @classmethod
    def tearDownClass(cls):
        # It writes about violations after the answer: what comes last shows that nothing is missing.
        cls.service.get("/jobs/the-last-one")
        said = cls.wait_for_prism("/jobs/the-last-one has returned")
        found = re.findall(r"^.*prism/errors#(\w+).*$", said, re.MULTILINE)
        assert set(found) == cls.expected_violations, said


class JobCycle(Proxied, rest_test.JobCycle):
    """The requests of the tests of the REST API, but for those that are wrong on purpose."""

    test_bad_requests_are_explained_and_the_server_stays_healthy = None
    test_errors_are_plain_json_for_a_client_that_names_only_that = None
    test_connection_survives_garbage_from_others = None


class Description(Proxied, ServiceTest):
    def test_documented_requests_are_as_described(self):
        blocks = [(page, block) for page in PAGES
                  for block in re.findall(r"```sh\n(.*?)```", (ROOT / "docs" / page).read_text(encoding="utf-8"), re.DOTALL)
                  if "http://127.0.0.1:8080" in block and "curl" in block]
        self.assertGreater(len(blocks), 5)
        for page, block in blocks:
            with self.subTest(page=page, block=block):
                done = subprocess.run(["bash", "-euc", block.replace("http://127.0.0.1:8080", self.service.url)],
                                      cwd=self.folder.name, capture_output=True, text=True, timeout=LIMIT_S,
                                      stdin=subprocess.DEVNULL, env=os.environ | {"no_proxy": "*"})
                self.assertEqual(done.returncode, 0, done.stderr)

    def test_example_of_every_process_is_as_described(self):
        description = self.service.get("/openapi.json").json()
        for path in description["paths"]:
            if path.endswith("/execution"):
                schema = description["components"]["schemas"]["execute-" + path.split("/")[2]]
                body = schema["example"] | {"inputs": schema["example"].get("inputs", {})}
                answer = self.service.send("POST", path, body, {"Prefer": "respond-async"})
                self.assertEqual(answer.status, 201, answer.body)
                self.assertIn(self.service.send("DELETE", answer.headers["Location"]).status, (200, 409))

    def test_every_way_to_wait_and_to_dismiss_is_as_described(self):
        slow = {"inputs": {"text": "hello", "pause": 30}}
        waited = self.service.send("POST", "/processes/echo/execution", slow, {"Prefer": "wait=1"})
        self.assertEqual(waited.status, 201, waited.body)
        job = waited.headers["Location"]
        self.assertEqual(self.service.get(job + "/results").status, 404)
        self.assertEqual(self.service.send("DELETE", job).json()["status"], "dismissed")
        self.assertEqual(self.service.get(job + "/results").status, 404)
        reference = {"inputs": {"text": "hello"}, "outputs": {"text": {"transmissionMode": "reference"}}}
        self.assertEqual(self.service.send("POST", "/processes/echo/execution", reference).status, 204)

    def test_errors_are_as_described(self):
        for status, target in ((404, "/processes/paint"), (404, "/jobs/nobody"), (404, "/jobs/nobody/results/obj"),
                               (400, "/jobs?datetime=yesterday")):
            self.assertEqual(self.service.get(target).status, status, target)
            self.assertEqual(self.service.get(target, {"Accept": "text/html"}).status, status, target)
        unknown = {"inputs": {"bbox": SEA | {"crs": "EPSG:0"}}}
        self.assertEqual(self.service.send("POST", EXECUTION, unknown).status, 400)
        job = self.service.execute({"bbox": SEA})
        self.service.wait(job)
        self.assertEqual(self.service.send("DELETE", job).status, 409)
        file = job + "/results/report"
        self.assertEqual(self.service.get(file, {"Range": "bytes=99999999-"}).status, 416)
        self.assertEqual(self.service.get(file, {"If-None-Match": "*"}).status, 304)
        self.assertEqual(self.service.get(file, {"If-Match": '"other"'}).status, 412)


class Judge(Proxied, ServiceTest):
    expected_violations = {"UNPROCESSABLE_ENTITY"}

    def test_description_tells_wrong_requests_from_right_ones(self):
        for target, body in ((EXECUTION, {"inputs": {"colour": "red"}}), (EXECUTION, {"inputs": {"formats": ["dxf"]}}),
                             (EXECUTION, {"inputs": {"bbox": {"bbox": [1, 2, "x", 4]}}}), (EXECUTION, {"outputs": {"paint": {}}}),
                             ("/jobs?status=lost", None), ("/jobs?limit=0", None)):
            answer = self.service.send("POST" if body else "GET", target, body)
            self.assertEqual(answer.status, 422, answer.body)


class Lint(unittest.TestCase):
    def test_description_lints_clean(self):
        skip_without_programs()
        with tempfile.TemporaryDirectory(prefix="citymesh-e2e-") as folder:
            description = Path(folder) / "openapi.json"
            description.write_bytes(subprocess.run([PROGRAM, "openapi"], check=True, capture_output=True).stdout)
            done = subprocess.run([PROGRAMS / "spectral", "lint", description, "--ruleset", HERE / ".spectral.yaml",
                                   "--fail-severity", "hint"], capture_output=True, text=True, stdin=subprocess.DEVNULL)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()

"""Runs `citymesh serve` for a test and talks to it. Python's standard library only."""
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.error
import urllib.request
from pathlib import Path

ROOT = Path(os.environ.get("CITYMESH_ROOT", Path(__file__).resolve().parents[3]))
PROGRAM = os.environ.get("CITYMESH_PROGRAM", "citymesh")
BERLIN = ROOT / "tests" / "data" / "berlin"
# Longitude and latitude of a part of Berlin Mitte that the data covers, without the few buildings that take an instrumented
# program long, and of the open sea.
CITY = {"bbox": [13.385, 52.495, 13.41, 52.51]}
SMALL = {"bbox": [13.400, 52.495, 13.405, 52.500]}
SEA = {"bbox": [3.0, 55.0, 3.01, 55.01]}
EXECUTION = "/processes/export-for-simulation/execution"
EXCEPTIONS = "http://www.opengis.net/def/exceptions/ogcapi-processes-1/1.0/"
LIMIT_S = 240
OPEN = ("accepted", "running")


class Answer:
    def __init__(self, status, headers, body):
        self.status, self.headers, self.body = status, headers, body

    def json(self):
        return json.loads(self.body)


def limit_files(max_bytes):
    """What fails is as with a full disk, without one."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (max_bytes, max_bytes))


class Service:
    """The program in a process of its own, over a file, a folder or the URL of a source; the ports are those it found free."""

    def __init__(self, data, state, *options, max_file_bytes=None):
        self.log = Path(state).with_suffix(".log")
        command = [PROGRAM, "serve", "--source" if "://" in str(data) else "--data", str(data), "--state", str(state), "--listen", "127.0.0.1:0",
                   "--grpc", "127.0.0.1:0", *options]
        with open(self.log, "wb") as log:
            self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT,
                                            preexec_fn=limit_files(max_file_bytes) if max_file_bytes else None)
        event = self._wait_for("listening")
        self.url, self.grpc = event["rest"], event["grpc"]

    def _wait_for(self, name):
        limit = time.monotonic() + LIMIT_S
        while time.monotonic() < limit:
            for line in self.log.read_text(errors="replace").splitlines():
                if line.startswith("{"):
                    try:
                        event = json.loads(line)
                    except ValueError:
                        continue  # not written to its end yet
                    if event.get("event") == name:
                        return event
            if self.process.poll() is not None:
                break
            time.sleep(0.02)
        self.kill()
        raise AssertionError(f"no event '{name}' in the log of the service:\n{self.log.read_text(errors='replace')}")

    def send(self, method, target, body=None, headers=None):
        """Any answer, also an error; a target may be a path or a complete URL."""
        url = target if target.startswith("http") else self.url + target
        data = json.dumps(body).encode() if isinstance(body, (dict, list)) else body
        fields = {"Content-Type": "application/json"} if data is not None else {}
        request = urllib.request.Request(url, data, fields | (headers or {}), method=method)
        try:
            with urllib.request.urlopen(request, timeout=LIMIT_S) as answer:
                return Answer(answer.status, answer.headers, answer.read())
        except urllib.error.HTTPError as error:
            return Answer(error.code, error.headers, error.read())

    def get(self, target, headers=None):
        return self.send("GET", target, headers=headers)

    def execute(self, inputs, process="export-for-simulation", **more):
        """The URL of a new job."""
        answer = self.send("POST", f"/processes/{process}/execution", {"inputs": inputs, **more}, {"Prefer": "respond-async"})
        assert answer.status == 201, answer.body
        return answer.headers["Location"]

    def wait(self, job, until=lambda status: status["status"] not in OPEN):
        limit = time.monotonic() + LIMIT_S
        while time.monotonic() < limit:
            status = self.get(job).json()
            if until(status):
                return status
            time.sleep(0.02)
        raise AssertionError(f"{job} is still {status}")

    def logged(self, **members):
        """Lines of the log that have these members."""
        written = self.log.read_text(errors="replace").rpartition("\n")[0]
        lines = [json.loads(line) for line in written.splitlines() if line.startswith("{")]
        return [line for line in lines if members.items() <= line.items()]

    def kill(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGKILL)
        self.process.wait()

    def stop(self):
        """The exit code after a polite request to end."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        return self.process.wait(LIMIT_S)


class ServiceTest(unittest.TestCase):
    """One service for all tests of a class."""

    data = BERLIN
    options = ()
    result_cache = "off"  # tests ask for the same again and again, and mean it

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="citymesh-e2e-")
        cls.addClassCleanup(cls.folder.cleanup)
        cls.service = Service(cls.data, Path(cls.folder.name) / "state", "--result_cache", cls.result_cache, *cls.options)
        cls.addClassCleanup(cls.service.kill)


def make_big_city(folder):
    """A folder with one file of so many buildings that jobs over it run for seconds, however the program was built."""
    Path(folder).mkdir(parents=True, exist_ok=True)
    megabytes = os.environ.get("CITYMESH_CITY_MB", "25")
    subprocess.run([sys.executable, ROOT / "scripts" / "make_big_city.py", BERLIN / "3910_5817.gml", megabytes,
                    Path(folder) / "city.gml"], check=True, stdout=subprocess.DEVNULL)
    return folder


def read_obj(text):
    """Body name → list of triangles or polygons as point indices; every index is checked."""
    points, bodies, body = 0, {}, None
    for line in text.splitlines():
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        if words[0] == "v":
            assert len([float(word) for word in words[1:]]) == 3, line
            points += 1
        elif words[0] == "o":
            assert words[1] not in bodies, f"body {words[1]} twice"
            body = bodies.setdefault(words[1], [])
        elif words[0] == "f":
            face = [int(word.split("/")[0]) for word in words[1:]]
            assert len(set(face)) == len(face) >= 3 and all(1 <= index <= points for index in face), line
            body.append(face)
    return bodies


def is_closed(faces):
    """Every edge is used once in each direction."""
    edges = {(a, b) for face in faces for a, b in zip(face, face[1:] + face[:1])}
    return len(edges) == sum(map(len, faces)) and all((b, a) in edges for a, b in edges)


def delivered_names(report):
    """Names of the bodies that stand for delivered buildings or their parts."""
    names = set()
    for building in report["buildings"]:
        if building["outcome"] == "delivered":
            parts = [part["name"] for part in building.get("parts", []) if part.get("outcome") == "delivered"]
            names.update(parts or [building["name"]])
    return names

#!/usr/bin/env python3
"""Starts `citymesh serve` over a folder of city models and exports a bounding box through the REST job API.

With --serve the service is left running and its addresses are printed. Python's standard library only.
"""
import argparse
import collections
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from pathlib import Path

# Berlin, south of Mitte, in longitude and latitude: a part of tests/data/berlin.
BBOX = [13.393, 52.498, 13.411, 52.502]
START_LIMIT_S = 60


class DemoError(Exception):
    """What a person can act on; `log` is worth showing."""


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def request(url, body=None, accept="application/json"):
    """(status, headers, bytes); the server's own words on an error."""
    data = None if body is None else json.dumps(body).encode()
    headers = {"Accept": accept} | ({"Content-Type": "application/json"} if data else {})
    try:
        with urllib.request.urlopen(urllib.request.Request(url, data, headers), timeout=60) as answer:
            return answer.status, answer.headers, answer.read()
    except urllib.error.HTTPError as error:
        try:
            problem = json.loads(error.read())
            detail = problem.get("detail") or problem.get("title")
        except ValueError:
            detail = error.reason
        raise DemoError(f"{url} answered {error.code}: {detail}") from None
    except (urllib.error.URLError, OSError) as error:
        raise DemoError(f"{url} cannot be reached: {error}") from None


class Server:
    """`citymesh serve`, its log in a file; stopped with this object."""

    def __init__(self, program, data, state, log, listen, grpc):
        self.log = Path(log)
        self.log.parent.mkdir(parents=True, exist_ok=True)
        self.url, self.grpc = f"http://{listen}", grpc
        command = [program, "serve", "--data", data, "--state", state, "--listen", listen, "--grpc", grpc]
        with open(self.log, "wb") as output:
            try:
                self.process = subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
            except OSError as error:
                raise DemoError(f"{program} cannot be started: {error}; build it with `make build`") from None

    def wait_until_ready(self):
        limit = time.monotonic() + START_LIMIT_S
        while time.monotonic() < limit:
            if self.process.poll() is not None:
                raise DemoError(f"the service ended with exit code {self.process.returncode}")
            try:
                request(self.url + "/readyz", accept="*/*")
                return
            except DemoError:
                time.sleep(0.1)
        raise DemoError(f"the service was not ready after {START_LIMIT_S} s")

    def ended(self):
        """Its exit code (negative: the signal that killed it); None while it runs."""
        try:
            return self.process.wait(0.5)
        except subprocess.TimeoutExpired:
            return None

    def stop(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
            try:
                self.process.wait(20)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()

    def log_tail(self, lines=20):
        return "\n".join(self.log.read_text(errors="replace").splitlines()[-lines:])


class ProgressBar:
    """One line that redraws itself on a terminal; elsewhere a line per stage and fifth of the way."""

    WIDTH = 30

    def __init__(self):
        self.live = sys.stdout.isatty()
        self.shown = None

    def show(self, status):
        stage = status.get("stage") or status["status"]
        done, total = status.get("done", 0), status.get("total", 0)
        filled = round(self.WIDTH * status.get("progress", 0) / 100)
        line = f"  [{'#' * filled}{'.' * (self.WIDTH - filled)}] {status.get('progress', 0):3d} %  {stage}"
        if total:
            line += f", {done} of {total} buildings"
        if self.live:
            print("\r" + line.ljust(90), end="", flush=True)
        elif (step := (stage, status.get("progress", 0) // 20)) != self.shown:
            self.shown = step
            print(line, flush=True)

    def end(self):
        if self.live:
            print()


def run_job(server, bbox, formats):
    """Submits, waits, returns (job URL, final status)."""
    inputs = {"bbox": {"bbox": bbox}, "formats": formats}
    status, headers, _ = request(server.url + "/processes/export-for-simulation/execution", {"inputs": inputs})
    job = headers.get("Location")
    if status != 201 or not job:
        raise DemoError(f"the service answered {status} without a Location instead of creating a job")
    print(f"Job {job}")
    bar = ProgressBar()
    while True:
        state = json.loads(request(job)[2])
        bar.show(state)
        if state["status"] not in ("accepted", "running"):
            break
        time.sleep(0.1)
    bar.end()
    if state["status"] != "successful":
        raise DemoError(f"the job is {state['status']}: {state.get('message', 'no message')}")
    return job, state


def download(status, folder):
    paths = []
    for link in status["links"]:
        if link["rel"] == "item":
            path = folder / Path(link["title"]).name
            path.write_bytes(request(link["href"], accept="*/*")[2])
            paths.append(path)
    if not any(path.name == "report.json" for path in paths):
        raise DemoError("the results of the job hold no report.json")
    return paths


def tally(pairs):
    return ", ".join(f"{count} {name}" for name, count in collections.Counter(pairs).most_common())


def tell(report, paths, seconds):
    counts, buildings = report["counts"], report["buildings"]
    delivered = [building for building in buildings if building["outcome"] == "delivered"]
    dropped = [building for building in buildings if building["outcome"] == "dropped"]
    print(f"\n{counts['requested']} buildings requested, done in {seconds:.1f} s")
    print(f"  {counts['delivered']:5d} delivered" + (f": {tally(b['rung'] for b in delivered)}" if delivered else ""))
    print(f"  {counts['merged']:5d} merged into a neighbour")
    print(f"  {counts['dropped']:5d} dropped" + (f": {tally(b['reason'] for b in dropped)}" if dropped else ""))
    for building in dropped[:10]:
        print(f"          {building['gml_id']}: {building['reason']}")
    if len(dropped) > 10:
        print(f"          and {len(dropped) - 10} more in report.json")
    for warning in report.get("warnings", []):
        print(f"  warning: {warning}")
    what = {".obj": "mesh", ".stl": "mesh", ".svg": "picture", ".html": "report to read", ".json": "report"}
    print("\nFiles")
    for path in sorted(paths, key=lambda path: list(what).index(path.suffix) if path.suffix in what else 9):
        print(f"  {what.get(path.suffix, 'file'):14s} {path}  ({path.stat().st_size / 1e6:.1f} MB)")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="build/release/services/apps/citymesh")
    parser.add_argument("--data", default="tests/data/berlin", help="folder of CityGML and CityJSON files")
    parser.add_argument("--output", type=Path, default=Path("out/demo"))
    parser.add_argument("--bbox", default=",".join(map(str, BBOX)), help="minx,miny,maxx,maxy in longitude and latitude")
    parser.add_argument("--formats", default="obj,stl")
    parser.add_argument("--serve", action="store_true", help="leave the service running")
    parser.add_argument("--listen", help="HOST:PORT of REST; a free port when absent")
    parser.add_argument("--grpc", help="HOST:PORT of gRPC; a free port when absent")
    parser.add_argument("--state", help="folder of jobs and results; a temporary one when absent")
    return parser.parse_args()


def demo(server, arguments):
    bbox = [float(number) for number in arguments.bbox.split(",")]
    print(f"Service {server.url} over {arguments.data}")
    started = time.monotonic()
    _, status = run_job(server, bbox, arguments.formats.split(","))
    seconds = time.monotonic() - started
    paths = download(status, arguments.output)
    tell(json.loads((arguments.output / "report.json").read_text(encoding="utf-8")), paths, seconds)


def serve(server):
    print(f"REST     {server.url}            landing page, /processes, /jobs, /api, /metrics, /healthz")
    print(f"gRPC     {server.grpc}")
    print(f"log      {server.log}")
    print("Ctrl-C stops the service.", flush=True)
    server.process.wait()
    if server.process.returncode not in (0, -signal.SIGINT, -signal.SIGTERM):
        raise DemoError(f"the service ended with exit code {server.process.returncode}")


def main():
    arguments = parse_arguments()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    if not Path(arguments.data).is_dir():
        print(f"error: {arguments.data} is no folder", file=sys.stderr)
        return 2
    if not arguments.serve:
        shutil.rmtree(arguments.output, ignore_errors=True)
        arguments.output.mkdir(parents=True)
    temporary = None if arguments.state else tempfile.mkdtemp(prefix="citymesh-demo-")
    state = arguments.state or temporary
    os.makedirs(state, exist_ok=True)
    log = Path(state, "server.log") if arguments.serve else arguments.output / "server.log"
    server = None
    try:
        server = Server(arguments.program, arguments.data, state, log,
                        arguments.listen or f"127.0.0.1:{free_port()}", arguments.grpc or f"127.0.0.1:{free_port()}")
        server.wait_until_ready()
        serve(server) if arguments.serve else demo(server, arguments)
        return 0
    except DemoError as error:
        print(f"\nerror: {error}", file=sys.stderr)
        if server:
            if server.ended() not in (None, 0):
                print(f"The service has ended with exit code {server.ended()}.", file=sys.stderr)
            print(f"The last lines of {server.log}:\n{server.log_tail()}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 0
    finally:
        if server:
            server.stop()
        if temporary:
            shutil.rmtree(temporary, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(main())

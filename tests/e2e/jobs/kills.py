#!/usr/bin/env python3
"""Jobs while the server is killed again and again: none is lost, none gives its results twice.

Starts the service, has some boxes exported in peace, then submits many jobs over the same boxes while `kill -9` hits the server at
random moments, also in the middle of its start. At the end

  - every submission that was answered is one job in the list, and the list has no other ones;
  - every job was successful or failed with its reason; none is open;
  - the results of each job are its own (its report has its options), the same bytes as in peace, and there once on disk;
  - a job that was seen successful never changed again;
  - the job database is whole.

Prints a table; the exit code is 0 if all of that holds. The moments follow from --seed, what they hit does not.

    kills.py --program build/release/services/apps/citymesh --jobs 1000 --kills 150
"""
import argparse
import json
import os
import random
import signal
import socket
import sqlite3
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "clients" / "python"))
from citymesh_client import CitymeshError, Client  # noqa: E402

PROCESS = "export-for-simulation"
WEST, SOUTH, EAST, NORTH = 13.385, 52.495, 13.41, 52.51  # of the test data
BOXES = 12
FIRST_MARK = 10_000  # an option that changes nothing, and is another one for every job


def free_address():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return f"127.0.0.1:{probe.getsockname()[1]}"


class Server:
    """The service at an address that stays, killed and started by one thread at a time."""

    def __init__(self, arguments, folder):
        self.folder, self.address = folder, free_address()
        self.url = f"http://{self.address}"
        self.state = folder / "state"
        self.command = [str(arguments.program), "serve", "--data", str(arguments.data), "--state", str(self.state), "--listen",
                        self.address, "--grpc", free_address(), "--workers", str(arguments.workers), "--max_open_jobs",
                        str(arguments.jobs + BOXES + 1)]
        self.starts, self.process = 0, None

    def start(self):
        self.starts += 1
        with open(self.folder / f"server-{self.starts:04}.log", "wb") as log:
            self.process = subprocess.Popen(self.command, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT)

    def check_alive(self):
        if self.process.poll() is not None:
            log = (self.folder / f"server-{self.starts:04}.log").read_text(errors="replace")
            raise SystemExit(f"the server ended by itself with {self.process.returncode}:\n{log[-3000:]}")

    def kill(self):
        self.check_alive()
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()

    def stop(self):
        self.check_alive()
        self.process.send_signal(signal.SIGTERM)
        if self.process.wait(300) != 0:
            raise SystemExit(f"the server stopped with exit code {self.process.returncode}")

    def events(self):
        """Of every start: the complete lines of its log."""
        for log in sorted(self.folder.glob("server-*.log")):
            lines = []
            for line in log.read_text(errors="replace").splitlines():
                try:
                    lines.append(json.loads(line))
                except ValueError:
                    pass  # for people, or cut off by the kill
            yield [line for line in lines if isinstance(line, dict)]


def box_of(number):
    """Small boxes from place to place, the same for everybody; some without a building."""
    places = random.Random(number)
    west, south = places.uniform(WEST, EAST - 0.004), places.uniform(SOUTH, NORTH - 0.003)
    return {"bbox": [round(west, 6), round(south, 6), round(west + 0.004, 6), round(south + 0.003, 6)]}


def inputs_of(number):
    return {"bbox": box_of(number % BOXES), "max_hole_area_m2": FIRST_MARK + number}


def content(job, name):
    with tempfile.TemporaryDirectory() as folder:
        return job.download(name, folder).read_bytes()


def kill_at_random(server, arguments, chance, done):
    """Kills and starts until all kills are made, or nothing is left to disturb."""
    kills = 0
    while kills < arguments.kills and not done.is_set():
        # One in four hits the start: catalogue, migration, jobs that the one before left behind.
        uptime_s = chance.uniform(0.0, 0.3) if chance.random() < 0.25 else chance.uniform(0.3, 2.0 * arguments.uptime_s)
        done.wait(uptime_s)
        server.kill()
        server.start()
        kills += 1
    return kills


def submit_all(client, arguments, seen):
    """number → job, the answered ones; between them some look after their results, which must be final then."""
    def submit(number):
        job = client.submit(PROCESS, inputs_of(number), idempotency_key=f"kills-{number}")
        return number, job

    jobs = {}
    with ThreadPoolExecutor(arguments.clients) as pool:
        for number, job in pool.map(submit, range(arguments.jobs)):
            jobs[number] = job
            if number % 10 == 9:
                note_successes(client, seen)
    return jobs


def note_successes(client, seen):
    for status in client.jobs(status="successful"):
        seen.setdefault(status.job_id, status.raw["finished"])


def check(jobs, expected, seen, client, server):
    """Problems found, and what the jobs came to."""
    problems, outcomes, reasons = [], Counter(), Counter()
    listed = [status.job_id for status in client.jobs()]
    ours = [job.id for job in jobs.values()]
    outcomes["lost"] = len(set(ours) - set(listed))
    outcomes["twice"] = len(listed) - len(set(listed)) + len(ours) - len(set(ours))
    outcomes["nobody's"] = len(set(listed) - set(ours)) - BOXES
    for number, job in jobs.items():
        status = job.status()
        outcomes[status.state] += 1
        if status.job_id in seen and (status.state, status.raw.get("finished")) != ("successful", seen[status.job_id]):
            problems.append(f"job {job.id} was successful at {seen[job.id]} and is {status.state} at {status.raw.get('finished')}")
        folders = sorted(path.name for path in (server.state / "results" / job.id).glob("*"))
        if status.state == "successful":
            report = json.loads(content(job, "report.json"))
            if report["options"]["max_hole_area_m2"] != FIRST_MARK + number:
                problems.append(f"job {job.id} has the results of another one")
            if content(job, "model.obj") != expected[number % BOXES]:
                problems.append(f"job {job.id} has another mesh than in peace")
            if len(folders) != 1 or folders[0].endswith(".partial"):
                problems.append(f"job {job.id} is on disk as {folders}")
        elif status.state == "failed":
            reason = status.raw.get("exception", {}).get("detail")
            reasons[reason] += 1
            if not reason:
                problems.append(f"job {job.id} failed without a reason")
            outcomes["left"] += len(folders)
            if not all(name.endswith(".partial") for name in folders):
                problems.append(f"job {job.id} failed and has results: {folders}")
        else:
            problems.append(f"job {job.id} is {status.state}")
    problems += [f"{outcomes[kind]} jobs are {kind}" for kind in ("lost", "twice", "nobody's") if outcomes[kind]]
    return problems, outcomes, reasons


def runs_in(server):
    """(runs that a kill broke, jobs that ended successfully more than once)."""
    broken, successes = 0, Counter()
    for events in server.events():
        running = set()
        for event in events:
            if event.get("event") == "job_started":
                running.add(event["job_id"])
            elif event.get("event") == "job_ended":
                running.discard(event["job_id"])
                successes[event["job_id"]] += event.get("state") == "successful"
        broken += len(running)
    return broken, [job for job, times in successes.items() if times > 1]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, default=os.environ.get("CITYMESH_PROGRAM"))
    parser.add_argument("--data", type=Path, default=ROOT / "tests/data/berlin")
    parser.add_argument("--jobs", type=int, default=30)
    parser.add_argument("--kills", type=int, default=6, help="at most: none are made when all jobs have ended")
    parser.add_argument("--uptime_s", type=float, default=1.5, help="between two kills, on average")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--clients", type=int, default=4, help="that submit at the same time")
    arguments = parser.parse_args()
    if arguments.program is None:
        parser.error("--program is missing")

    with tempfile.TemporaryDirectory(prefix="citymesh-kills-") as folder:
        server = Server(arguments, Path(folder))
        server.start()
        client = Client(server.url, retries=60, timeout_s=30)
        try:
            run(server, client, arguments)
        finally:
            if server.process.poll() is None:
                server.process.kill()
                server.process.wait()


def run(server, client, arguments):
    peaceful = [client.submit(PROCESS, {"bbox": box_of(number)}) for number in range(BOXES)]
    expected = [job.wait() and content(job, "model.obj") for job in peaceful]

    started, seen, done = time.monotonic(), {}, threading.Event()
    with ThreadPoolExecutor(1) as killer:
        killing = killer.submit(kill_at_random, server, arguments, random.Random(arguments.seed), done)
        try:
            jobs = submit_all(client, arguments, seen)
            submitted_s = time.monotonic() - started
            while any(True for _ in client.jobs(status=["accepted", "running"])):
                note_successes(client, seen)
                time.sleep(0.5)
        except CitymeshError as error:
            raise SystemExit(f"the service did not come back: {error}") from error
        finally:
            done.set()
        kills = killing.result()
    took_s = time.monotonic() - started

    # Once more from cold, in peace: what the disk has is what counts.
    client.processes()
    server.stop()
    server.start()
    problems, outcomes, reasons = check(jobs, expected, seen, client, server)
    server.stop()
    broken, twice = runs_in(server)
    problems += [f"job {job} ended successfully more than once" for job in twice]
    with sqlite3.connect(server.state / "jobs.sqlite") as database:
        sound = database.execute("PRAGMA integrity_check").fetchone()[0]
    if sound != "ok":
        problems.append(f"the job database: {sound}")

    rows = [("jobs submitted", len(jobs)), ("kills", kills), ("runs broken by a kill", broken), ("lost", outcomes["lost"]),
            ("results twice", outcomes["twice"] + len(twice)), ("successful", outcomes["successful"]), ("failed", outcomes["failed"]),
            ("unfinished folders that failed jobs left", outcomes["left"]), ("submitted in", f"{submitted_s:.0f} s"), ("all ended after", f"{took_s:.0f} s"), ("seed", arguments.seed)]
    print("| | |\n| --- | --- |")
    for name, value in rows:
        print(f"| {name} | {value} |")
    for reason, times in reasons.items():
        print(f"\n{times} failed: {reason}")
    if problems:
        sys.exit("\n".join(["", *problems[:50], f"{len(problems)} problems"]))


if __name__ == "__main__":
    main()

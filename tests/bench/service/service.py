#!/usr/bin/env python3
"""The speed figures of the service: submissions, polling, event streams, downloads and dismissals, on loopback, with load and service on the same
machine.

    service.py --program build/release/services/apps/citymesh [--only submissions,polling,streams,downloads,dismissals]

Prints a Markdown table with what was asked for, what was measured, and how. Needs wrk and curl.
"""
import argparse
import asyncio
import json
import os
import random
import resource
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "e2e" / "jobs"))
import load  # noqa: E402
import service as harness  # noqa: E402

MEGABYTE = 1_000_000
MEASURES = ("submissions", "polling", "streams", "downloads", "dismissals")
OPEN_FILES = 4096


class Memory:
    """What the server holds: its own memory, and files that it has mapped."""

    def __init__(self, process):
        self.folder = Path("/proc") / str(process.pid)

    def reset_peak(self):
        (self.folder / "clear_refs").write_text("5")

    def mb(self, name="VmHWM"):
        line = next(line for line in (self.folder / "status").read_text().splitlines() if line.startswith(name + ":"))
        return int(line.split()[1]) * 1024 / MEGABYTE

    def cpu_s(self):
        fields = (self.folder / "stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Bench:
    """Starts a service over a big city for each measure, and keeps the rows of the table."""

    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, Path(folder)
        self.rows, self.services = [], 0
        self.city = self.folder / "city"
        os.environ["CITYMESH_CITY_MB"] = str(arguments.city_mb)
        harness.make_big_city(self.city)

    def start(self, state=None, data=None):
        self.services += 1
        state = state or self.folder / f"state-{self.services}"
        return harness.Service(data or self.city, state, "--workers", "1", "--threads", "1", "--max_open_jobs", "1000000",
                               "--max_connections", "4000", "--result_cache", "off")

    def row(self, what, target, measured, holds):
        self.rows.append((what, target, measured, "yes" if holds else "no"))
        print(f"{what}: {measured}", file=sys.stderr)

    def busy_job(self, service):
        """A job that keeps the worker busy, once it has begun its work."""
        job = service.execute({})
        service.wait(job, lambda status: status.get("done", 0) > 0 or status["status"] not in harness.OPEN)
        return job

    def still_busy(self, service, job):
        return "the worker was busy" if service.get(job).json()["status"] == "running" else "the worker was NOT busy all the time"

    def submissions(self):
        service = self.start()
        try:
            job = self.busy_job(service)
            body = json.dumps({"inputs": {"bbox": harness.SEA}}).encode()
            rate, seconds = self.arguments.rate, self.arguments.seconds
            latencies, statuses, took_s = load.submissions(service.url, harness.EXECUTION, lambda _: body, rate, seconds)
            p50, p99 = (1000 * load.percentile(latencies, part) for part in (0.5, 0.99))
            wrong = sum(status != 201 for status in statuses)
            busy = self.still_busy(service, job)
            listed = int(sum(float(line.split()[-1]) for line in service.get("/metrics").body.decode().splitlines()
                             if line.startswith("citymesh_queue_length")))
            self.row(f"{rate}/s submissions for {seconds} s", "p99 < 50 ms",
                     f"{len(latencies) / took_s:.0f}/s, p50 {p50:.1f} ms, p99 {p99:.1f} ms, longest {1000 * latencies[-1]:.0f} ms, {wrong} "
                     f"refused, {listed} in the queue; {busy}", p99 < 50 and wrong == 0 and len(latencies) / took_s > 0.98 * rate)
        finally:
            service.kill()

    def polling(self):
        service = self.start()
        try:
            jobs = [service.execute({"bbox": harness.SEA}) for _ in range(50)]
            for job in jobs:
                service.wait(job)
            paths = ["/jobs/" + job.rsplit("/", 1)[1] for job in jobs]
            for busy in (False, True):
                job = self.busy_job(service) if busy else None
                rate, p50, p99, wrong = load.polling(service.url, paths, self.arguments.poll_s, 32)
                state = self.still_busy(service, job) if busy else "the worker was idle"
                self.row(f"status polling on 32 connections for {self.arguments.poll_s} s", "5,000/s",
                         f"{rate:,.0f}/s, p50 {1000 * p50:.1f} ms, p99 {1000 * p99:.1f} ms, {wrong} wrong; {state}",
                         rate >= 5000 and wrong == 0)
        finally:
            service.kill()

    def streams(self):
        service = self.start()
        memory = Memory(service.process)
        try:
            job = self.busy_job(service)
            before_mb, told = memory.mb("VmRSS"), {}

            async def hold(seen):
                loop = asyncio.get_running_loop()
                told["open"] = seen["open"]
                events, cpu_s, since = seen["events"], memory.cpu_s(), time.monotonic()
                await asyncio.sleep(self.arguments.hold_s)
                took_s = time.monotonic() - since
                told["per_s"] = (seen["events"] - events) / took_s
                told["cpu"] = (memory.cpu_s() - cpu_s) / took_s
                told["mb"] = memory.mb("VmRSS") - before_mb
                told["status_ms"] = await loop.run_in_executor(None, self.time_status, service, job)
                told["dismissed"] = time.monotonic()
                await loop.run_in_executor(None, service.send, "DELETE", job)

            path = "/jobs/" + job.rsplit("/", 1)[1] + "/events"
            seen = load.streams(service.url, [path] * self.arguments.streams, hold)
            all_told = seen["ended"] == self.arguments.streams
            self.row(f"{self.arguments.streams} open event streams for {self.arguments.hold_s} s", "all open, all told",
                     f"{told['open']} open, {seen['refused']} refused, {told['per_s']:,.0f} events/s, {told['cpu']:.2f} cores with the worker's, "
                     f"{told['mb']:+.0f} MB, a status in {told['status_ms']:.1f} ms beside them; {seen['ended']} told of the end within "
                     f"{seen['last_end'] - told['dismissed']:.2f} s", told["open"] == self.arguments.streams and all_told)
        finally:
            service.kill()

    @staticmethod
    def time_status(service, job):
        times = []
        for _ in range(50):
            started = time.monotonic()
            service.get(job)
            times.append(time.monotonic() - started)
        return 1000 * load.percentile(sorted(times), 0.5)

    def downloads(self):
        state = self.folder / "state-downloads"
        service = self.start(state, harness.BERLIN)
        job = service.execute({"bbox": harness.SMALL})
        if service.wait(job)["status"] != "successful":
            sys.exit("the job whose results are to be downloaded failed")
        service.stop()
        job_id = job.rsplit("/", 1)[1]
        size = self.arguments.megabytes * MEGABYTE
        enlarge(state, job_id, "model.obj", size)
        service = self.start(state, harness.BERLIN)
        memory = Memory(service.process)
        try:
            memory.reset_peak()
            count = self.arguments.downloads
            cpu_s = memory.cpu_s()
            took_s, sizes = load.downloads(f"{service.url}/jobs/{job_id}/results/obj", count)
            peak_mb, complete = memory.mb(), sum(got == size for got in sizes)
            self.row(f"{count} parallel downloads of {self.arguments.megabytes} MB", "memory < 200 MB",
                     f"peak {peak_mb:.0f} MB (RSS), {complete} complete in {took_s:.1f} s, {sum(sizes) / took_s / MEGABYTE:,.0f} MB/s, "
                     f"{(memory.cpu_s() - cpu_s) / took_s:.2f} cores", peak_mb < 200 and complete == count)
        finally:
            service.kill()

    def dismissals(self):
        """Of jobs at random moments of their run: how long the worker goes on, and what is left in memory."""
        service = self.start()
        memory, moment = Memory(service.process), random.Random(1)
        try:
            times, before_mb = [], None
            for _ in range(self.arguments.dismissals):
                job = self.busy_job(service)
                time.sleep(moment.uniform(0, 0.5))
                started = time.monotonic()
                status = service.send("DELETE", job).json()["status"]
                if status != "dismissed":
                    status = service.wait(job)["status"]
                if status == "dismissed":
                    times.append(time.monotonic() - started)
                before_mb = before_mb or memory.mb("VmRSS")
            times.sort()
            p50, longest = 1000 * load.percentile(times, 0.5), 1000 * times[-1]
            grown_mb = memory.mb("VmRSS") - before_mb
            self.row(f"{self.arguments.dismissals} jobs dismissed while they run", "each within 100 ms",
                     f"p50 {p50:.0f} ms, longest {longest:.0f} ms, {len(times)} dismissed; {grown_mb:+.0f} MB since the first",
                     longest < 100 and len(times) == self.arguments.dismissals)
        finally:
            service.kill()


def enlarge(state, job_id, name, size):
    """Makes a result of a finished job so large, by its own content again and again, as if it had been written like that."""
    path = next((state / "results" / job_id).glob(f"attempt-*/{name}"))
    content = path.read_bytes()
    block = content * (1 + 8 * MEGABYTE // len(content))
    with open(path, "wb") as file:
        left = size
        while left > 0:
            left -= file.write(block[:left])
    with sqlite3.connect(state / "jobs.sqlite") as database:
        results = json.loads(database.execute("SELECT results FROM job WHERE id = ?", (job_id,)).fetchone()[0])
        for result in results:
            if name in result.values():
                result["bytes"] = size
        database.execute("UPDATE job SET results = ? WHERE id = ?", (json.dumps(results), job_id))
    database.close()


def machine():
    def git(*words):
        return subprocess.run(["git", "-C", str(ROOT), *words], capture_output=True, text=True).stdout.strip()
    commit = git("rev-parse", "--short", "HEAD") + (" with changes" if git("status", "--porcelain", "--untracked-files=no") else "")
    model = next((line.split(":", 1)[1].strip() for line in Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("model name")),
                 "unknown processor")
    return (f"Commit {commit}, {time.strftime('%Y-%m-%d')}, {len(os.sched_getaffinity(0))} cores ({model}) for service and load together, "
            f"load before: {os.getloadavg()[0]:.1f}.")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--only", default=",".join(MEASURES), help=",".join(MEASURES))
    parser.add_argument("--rate", type=int, default=500, help="submissions a second")
    parser.add_argument("--seconds", type=int, default=30, help="of submissions")
    parser.add_argument("--poll_s", type=int, default=10)
    parser.add_argument("--streams", type=int, default=1000)
    parser.add_argument("--hold_s", type=int, default=10, help="streams are held open for so long")
    parser.add_argument("--downloads", type=int, default=32)
    parser.add_argument("--megabytes", type=int, default=500, help="of a download")
    parser.add_argument("--dismissals", type=int, default=50)
    parser.add_argument("--city_mb", type=int, default=100, help="size of the city that keeps the worker busy")
    parser.add_argument("--folder", type=Path, help="on the disk that the stores are to use; default: that of temporary files")
    arguments = parser.parse_args()
    wanted = arguments.only.split(",")
    if unknown := set(wanted) - set(MEASURES):
        parser.error(f"--only {','.join(sorted(unknown))}: expected some of {', '.join(MEASURES)}")
    _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if hard != resource.RLIM_INFINITY and hard < OPEN_FILES:
        sys.exit(f"{hard} open files are allowed, expected {OPEN_FILES} or more (ulimit -n)")
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    harness.PROGRAM = str(arguments.program.resolve())

    head = machine()
    folder = tempfile.mkdtemp(prefix="citymesh-bench-", dir=arguments.folder)
    try:
        bench = Bench(arguments, folder)
        for measure in wanted:
            getattr(bench, measure)()
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    print(f"{head}\n\n| load | target | measured | holds |\n| --- | --- | --- | --- |")
    for row in bench.rows:
        print("| " + " | ".join(row) + " |")


if __name__ == "__main__":
    main()

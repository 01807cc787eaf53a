"""Load for the benchmark of the service: raw sockets, so that one core is enough for it. wrk and curl do what they are better at."""
import asyncio
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from urllib.parse import urlsplit


def percentile(sorted_values, part):
    """The value below which this part lies."""
    return sorted_values[min(len(sorted_values) - 1, int(part * len(sorted_values)))] if sorted_values else float("nan")


def program(name, package):
    path = shutil.which(name)
    if path is None:
        sys.exit(f"{name} is missing: apt-get install {package}")
    return path


class Connection:
    """Keeps one connection alive and has one request on it at a time."""

    def __init__(self, url):
        self.address = urlsplit(url)
        self.reader = self.writer = None

    async def exchange(self, head, body=b""):
        """The status of the answer; its body is read and dropped."""
        if self.writer is None:
            self.reader, self.writer = await asyncio.open_connection(self.address.hostname, self.address.port)
        self.writer.write(head + body)
        try:
            fields = await self.reader.readuntil(b"\r\n\r\n")
            length = re.search(rb"\r\ncontent-length: *(\d+)", fields, re.IGNORECASE)
            await self.reader.readexactly(int(length.group(1)) if length else 0)
        except (asyncio.IncompleteReadError, OSError):
            self.close()
            return 0
        if b"connection: close" in fields.lower():
            self.close()
        return int(fields.split(b" ", 2)[1])

    def close(self):
        if self.writer is not None:
            self.writer.close()
            self.writer = None


async def at_a_rate(url, head, bodies, rate, seconds, connections):
    """(latencies in seconds, statuses). Requests begin when their time has come, whatever became of those before; their latency
    counts from that time, so a server that stalls cannot hide it."""
    free = asyncio.Queue()
    for _ in range(connections):
        free.put_nowait(Connection(url))
    latencies, statuses = [], []
    begin = time.monotonic() + 0.1

    async def one(due, body):
        connection = await free.get()
        try:
            statuses.append(await connection.exchange(head(len(body)), body))
            latencies.append(time.monotonic() - due)
        finally:
            free.put_nowait(connection)

    running = []
    for number in range(int(rate * seconds)):
        due = begin + number / rate
        await asyncio.sleep(max(0.0, due - time.monotonic()))
        running.append(asyncio.create_task(one(due, bodies(number))))
    await asyncio.gather(*running)
    took_s = time.monotonic() - begin
    while not free.empty():
        free.get_nowait().close()
    return sorted(latencies), statuses, took_s


def submissions(url, path, bodies, rate, seconds, connections=64):
    host = urlsplit(url).netloc

    def head(length):
        return (f"POST {path} HTTP/1.1\r\nHost: {host}\r\nContent-Type: application/json\r\nPrefer: respond-async\r\n"
                f"Content-Length: {length}\r\n\r\n").encode()
    return asyncio.run(at_a_rate(url, head, bodies, rate, seconds, connections))


async def _streams(url, paths, hold):
    """`hold(seen)` is awaited when all streams are open; then they are read to their end."""
    address = urlsplit(url)
    seen = {"open": 0, "events": 0, "refused": 0, "ended": 0, "last_end": 0.0}

    async def one(path):
        reader, writer = await asyncio.open_connection(address.hostname, address.port)
        writer.write(f"GET {path} HTTP/1.1\r\nHost: {address.netloc}\r\nAccept: text/event-stream\r\n\r\n".encode())
        fields = await reader.readuntil(b"\r\n\r\n")
        if b" 200 " not in fields.split(b"\r\n", 1)[0]:
            seen["refused"] += 1
            writer.close()
            return
        first, final = True, False
        while True:
            line = await reader.readline()
            if line.startswith(b"data:"):
                seen["events"] += 1
                seen["open"] += first
                first = False
                final = b'"status":"dismissed"' in line or b'"status":"successful"' in line
            if not line or final:
                break
        seen["ended"] += final
        seen["last_end"] = time.monotonic()
        writer.close()

    tasks = [asyncio.create_task(one(path)) for path in paths]
    limit = time.monotonic() + 60
    while seen["open"] + seen["refused"] < len(tasks) and time.monotonic() < limit:
        await asyncio.sleep(0.02)
    await hold(seen)
    await asyncio.wait(tasks, timeout=60)
    return seen


def streams(url, paths, hold):
    return asyncio.run(_streams(url, paths, hold))


def polling(url, paths, seconds, connections):
    """(requests a second, p50 and p99 in seconds, answers that were no success) by wrk, one thread."""
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder) / "paths.lua"
        listed = ", ".join(f'"{path}"' for path in paths)
        script.write_text(f"""local paths = {{{listed}}}
local at = 0
request = function()
  at = at % #paths + 1
  return wrk.format("GET", paths[at])
end
done = function(summary, latency)
  local wrong = summary.errors.status + summary.errors.connect + summary.errors.read + summary.errors.write + summary.errors.timeout
  io.write(string.format("figures %f %f %f %d\\n", summary.requests / summary.duration * 1e6,
           latency:percentile(50) / 1e6, latency:percentile(99) / 1e6, wrong))
end
""", encoding="utf-8")
        command = [program("wrk", "wrk"), "-t1", f"-c{connections}", f"-d{seconds}s", "-s", script, url]
        text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    rate, p50, p99, wrong = re.search(r"^figures (\S+) (\S+) (\S+) (\d+)$", text, re.MULTILINE).groups()
    return float(rate), float(p50), float(p99), int(wrong)


def downloads(url, count):
    """(seconds, bytes of each) of so many at the same time, by curl."""
    started = time.monotonic()
    command = [program("curl", "curl"), "-sS", "-o", "/dev/null", "-w", "%{http_code} %{size_download}", url]
    running = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(count)]
    sizes = []
    for process in running:
        status, size = process.communicate()[0].split()
        sizes.append(int(size) if status == "200" else 0)
    return time.monotonic() - started, sizes

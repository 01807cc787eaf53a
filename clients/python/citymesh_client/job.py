"""A job at the service: watching it, fetching its results, dismissing it."""
from __future__ import annotations

import time
import urllib.parse
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Optional, Tuple, Union, cast

from .download import fetch, name_of, safe_name
from .errors import HttpError, JobDismissed, JobFailed, WaitTimeout
from .events import read_events
from .progress import ProgressBar
from .status import JobStatus, ResultFile
from .transport import NETWORK_ERRORS, Transport

SILENCE_S = 45.0  # the service sends a line every 15 s; a stream that is silent for so long is broken
MOST_FRUITLESS_STREAMS = 2  # then something between here and the service swallows events
FIRST_POLL_S, LONGEST_POLL_S = 0.2, 5.0

ShowStatus = Callable[[JobStatus], None]


class Job:
    """Made by Client.submit() or, for a job from before, by Client.job()."""

    def __init__(self, transport: Transport, job_id: str):
        self._transport = transport
        self._path = "/jobs/" + urllib.parse.quote(job_id, safe="")
        self.id = job_id
        self.url = transport.base + self._path

    def __repr__(self) -> str:
        return f"Job({self.url!r})"

    def status(self) -> JobStatus:
        """The state it is in now."""
        return JobStatus.of(self._transport.json("GET", self._path))

    def states(self, until: Optional[float] = None) -> Iterator[JobStatus]:
        """Its states as they come, the last one final; `until` (time.monotonic) ends it early. They arrive as server-sent events;
        where those do not get through the service is asked again and again."""
        last_id, fruitless, poll_s = "", 0, FIRST_POLL_S
        while True:
            came = False
            if fruitless < MOST_FRUITLESS_STREAMS and _left_s(until) > SILENCE_S:
                for last_id, status in self._stream(last_id, until):
                    came = True
                    if status.ended:
                        break  # an event has no links and no reason of a failure
                    yield status
                fruitless = 0 if came else fruitless + 1
            status = self.status()
            yield status
            if status.ended or _left_s(until) <= 0:
                return
            poll_s = FIRST_POLL_S if came else min(LONGEST_POLL_S, 1.5 * poll_s)
            time.sleep(max(0.0, min(poll_s, _left_s(until))))

    def wait(self, progress: Union[bool, ShowStatus] = False, timeout_s: Optional[float] = None) -> JobStatus:
        """Returns when it was successful; raises JobFailed with the reason, JobDismissed, or WaitTimeout. `progress`: a bar on
        standard error, or a function that is called with every state."""
        until = None if timeout_s is None else time.monotonic() + timeout_s
        if progress is True:
            with ProgressBar() as bar:
                status = self._last_state(bar.job, until)
        else:
            status = self._last_state(progress or None, until)
        if not status.ended:
            raise WaitTimeout(f"job {self.id} is still {status.state} after {timeout_s} s")
        if status.state == "dismissed":
            raise JobDismissed(self.id)
        if status.state != "successful":
            raise JobFailed(self.id, status.raw.get("exception") or {"detail": status.message})
        return status

    def files(self) -> List[ResultFile]:
        """What it has written; nothing unless it was successful."""
        return list(self.status().files)

    def results(self) -> Dict[str, Any]:
        """The results document: by output a value or a link. Only of jobs that were not asked for raw values."""
        return cast(Dict[str, Any], self._transport.json("GET", self._path + "/results"))

    def download(self, output: str, path: Union[str, Path] = ".", progress: Union[bool, Callable[[int, int], None]] = False) -> Path:
        """Writes an output (`obj`) or a file (`picture.svg`) to `path`, which is a file or an existing folder. A download that broke,
        now or in an earlier run of the program, goes on where it was. `progress`: a bar on standard error, or a function that is
        called with the bytes that are there and all bytes."""
        target = Path(path)
        source = f"{self._path}/results/{urllib.parse.quote(output, safe='')}"
        if target.is_dir():
            target /= self._file_name(source)
        if progress is True:
            with ProgressBar() as bar:
                return fetch(self._transport, source, target, lambda done, total: bar.download(target.name, done, total))
        return fetch(self._transport, source, target, progress or None)

    def download_all(self, folder: Union[str, Path], progress: bool = False) -> Dict[str, Path]:
        """Every file of a job that was successful, by name, in a folder that is made if it is missing."""
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        return {file.name: self.download(file.name, folder / safe_name(file.name), progress) for file in self.files()}

    def dismiss(self) -> JobStatus:
        """Stops it, or forgets that it was wanted. Raises Conflict when it has ended by itself."""
        return JobStatus.of(self._transport.json("DELETE", self._path))

    def _last_state(self, show: Optional[ShowStatus], until: Optional[float]) -> JobStatus:
        for status in self.states(until):
            if show:
                show(status)
        return status

    def _stream(self, last_id: str, until: Optional[float]) -> Iterator[Tuple[str, JobStatus]]:
        """(id, state) of every event until the stream breaks, or polling is the better way to be in time."""
        asked = {"Accept": "text/event-stream"}
        if last_id:
            asked["Last-Event-ID"] = last_id
        try:
            with self._transport.open("GET", self._path + "/events", headers=asked, timeout_s=SILENCE_S) as stream:
                if not stream.headers.get("Content-Type", "").startswith("text/event-stream"):
                    return
                for last_id, data in read_events(stream):
                    if data is not None:
                        yield last_id, JobStatus.of(data)
                    if _left_s(until) <= SILENCE_S:
                        return
        except (HttpError, *NETWORK_ERRORS, ValueError, KeyError):
            return  # whether the job is there, and the service, is seen when its state is asked for

    def _file_name(self, source: str) -> str:
        def attempt() -> str:
            with self._transport.open("HEAD", source, headers={"Accept": "*/*"}) as answer:
                return name_of(answer.headers)
        return self._transport.retried(attempt)


def _left_s(until: Optional[float]) -> float:
    return float("inf") if until is None else until - time.monotonic()

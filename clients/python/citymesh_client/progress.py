"""A progress bar on a terminal, a line now and then elsewhere."""
from __future__ import annotations

import shutil
import sys
import time
from typing import Callable, Optional, TextIO

from .status import JobStatus

BAR_WIDTH = 30
PLAIN_PAUSE_S = 5.0
REDRAW_S = 0.1


def format_time(seconds: float) -> str:
    """`3 s`, `2:05`, `1:00:00`."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    minutes, rest = divmod(whole, 60)
    return f"{minutes}:{rest:02}" if minutes < 60 else f"{minutes // 60}:{minutes % 60:02}:{rest:02}"


def format_bytes(count: float) -> str:
    """`512 B`, `1.5 MB`."""
    for unit in ("B", "kB", "MB"):
        if count < 1000:
            return f"{count:.0f} B" if unit == "B" else f"{count:.1f} {unit}"
        count /= 1000
    return f"{count:.1f} GB"


def bar_line(name: str, done: float, total: float, counts: str, eta_s: Optional[float] = None) -> str:
    """`heal     [######........] 3/12  25 %, 6 s left`"""
    part = min(1.0, done / total) if total > 0 else 0.0
    filled = int(part * BAR_WIDTH)
    line = f"{name:<8} [{'#' * filled}{'.' * (BAR_WIDTH - filled)}] {counts} {100 * part:3.0f} %"
    return line if eta_s is None else f"{line}, {format_time(eta_s)} left"


class Eta:
    """Time left at the rate since a stage was first seen, for states that do not tell it."""

    def __init__(self, clock: Callable[[], float] = time.monotonic):
        self._clock = clock
        self._stage, self._done, self._since = "", 0, 0.0

    def of(self, stage: str, done: int, total: int) -> Optional[float]:
        now = self._clock()
        if stage != self._stage or done < self._done:
            self._stage, self._done, self._since = stage, done, now
        if done <= self._done or now <= self._since or total < done:
            return None
        return (total - done) * (now - self._since) / (done - self._done)


class ProgressBar:
    """Shows states of a job and downloads. A context manager: at its end the bar is gone."""

    def __init__(self, out: Optional[TextIO] = None, clock: Callable[[], float] = time.monotonic):
        self._out = sys.stderr if out is None else out
        self._terminal = self._out.isatty()
        self._clock = clock
        self._eta = Eta(clock)
        self._download_eta = Eta(clock)
        self._name = ""
        self._shown = clock()

    def __enter__(self) -> ProgressBar:
        return self

    def __exit__(self, *_: object) -> None:
        if self._terminal:
            self._out.write("\r\033[K")
        self._out.flush()

    def job(self, status: JobStatus) -> None:
        """To be called with every state."""
        own_eta_s = self._eta.of(status.stage, status.done, status.total)
        if status.state == "running" and status.total > 0:
            eta_s = own_eta_s if status.eta_s is None else status.eta_s
            self._show(status.stage, bar_line(status.stage, status.done, status.total, f"{status.done}/{status.total}", eta_s),
                       fresh=status.stage != self._name)
        else:
            self._show(status.state, f"{status.state}: {status.message}" if status.message else status.state,
                       fresh=status.state != self._name)

    def download(self, name: str, done: int, total: int) -> None:
        """To be called with every piece of a file."""
        eta_s = self._download_eta.of(name, done, total)
        self._show(name, bar_line(name, done, total, f"{format_bytes(done)} of {format_bytes(total)}", eta_s),
                   fresh=self._terminal and name != self._name)

    def _show(self, name: str, line: str, fresh: bool) -> None:
        now = self._clock()
        if not fresh and now - self._shown < (REDRAW_S if self._terminal else PLAIN_PAUSE_S):
            return
        self._name, self._shown = name, now
        if self._terminal:
            width = shutil.get_terminal_size().columns - 1
            self._out.write(f"\r\033[K{line[:width]}")
        else:
            self._out.write(line + "\n")
        self._out.flush()

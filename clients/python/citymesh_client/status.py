"""What the service says about a job."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Dict, Optional, Tuple

OPEN_STATES = ("accepted", "running")


@dataclass(frozen=True)
class ResultFile:
    """A file that a job has written."""

    name: str
    media_type: str
    size_bytes: Optional[int]


@dataclass(frozen=True)
class JobStatus:
    """The state of a job at one moment. `raw` is the document as it came."""

    job_id: str
    state: str  # accepted, running, successful, failed or dismissed
    percent: int = 0
    message: str = ""
    stage: str = ""
    done: int = 0
    total: int = 0
    rate_per_s: Optional[float] = None
    eta_s: Optional[float] = None
    raw: Dict[str, Any] = field(default_factory=dict, compare=False, repr=False)

    @property
    def ended(self) -> bool:
        return self.state not in OPEN_STATES

    @property
    def files(self) -> Tuple[ResultFile, ...]:
        """The results of a successful job; of others, and in events, none."""
        return tuple(ResultFile(str(link.get("title", "")), str(link.get("type", "")), link.get("length"))
                     for link in self.raw.get("links", ()) if link.get("rel") == "item")

    @staticmethod
    def of(document: Dict[str, Any]) -> JobStatus:
        """From a statusInfo document or the data of an event."""
        return JobStatus(str(document["jobID"]), str(document["status"]), int(document.get("progress", 0)),
                         str(document.get("message", "")), str(document.get("stage", "")), int(document.get("done", 0)),
                         int(document.get("total", 0)), document.get("rate_per_s"), document.get("eta_s"), document)

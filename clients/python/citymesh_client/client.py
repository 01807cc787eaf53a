"""The service as seen from Python."""
from __future__ import annotations

import ssl
import uuid
from pathlib import Path
from typing import Any, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Union, cast
from urllib.parse import quote, urlencode, urlsplit

from .job import Job
from .status import JobStatus
from .transport import Transport

EXPORT = "export-for-simulation"
PAGE_LENGTH = 100

Box = Union[str, Sequence[float], Mapping[str, Any]]


def parse_bbox(box: Box) -> Dict[str, Any]:
    """The form that the service takes, of `minx,miny[,minz],maxx,maxy[,maxz][@CRS]`, of four or six numbers, or of that form."""
    if isinstance(box, Mapping):
        return dict(box)
    crs = ""
    numbers: Iterable[Any] = box
    if isinstance(box, str):
        text, _, crs = box.partition("@")
        numbers = text.split(",")
    try:
        values = [float(number) for number in numbers]
    except (TypeError, ValueError):
        values = []
    if len(values) not in (4, 6):
        raise ValueError(f"bbox is {box!r}, expected minx,miny,maxx,maxy or minx,miny,minz,maxx,maxy,maxz, with @CRS behind it if it is "
                         "not longitude and latitude")
    return {"bbox": values, "crs": crs} if crs else {"bbox": values}


class Client:
    """One citymesh service.

    url: what its addresses begin with, `https://example.org/citymesh`. Links in answers are not followed, so that it also works
        through a tunnel.
    api_key, token: sent with every request as `X-API-Key`, or as a bearer token.
    timeout_s: longest silence of the service.
    retries: how often a request that was turned away for now (429, 503; Retry-After is heeded) or lost on the way is sent again.
    context: of TLS, for an own authority: `ssl.create_default_context(cafile="ca.pem")`.
    """

    def __init__(self, url: str, api_key: Optional[str] = None, token: Optional[str] = None, *, timeout_s: float = 60.0, retries: int = 5,
                 context: Optional[ssl.SSLContext] = None):
        self._transport = Transport(url, api_key, token, timeout_s, retries, context)

    def processes(self) -> List[Dict[str, Any]]:
        """Summaries of the processes there are."""
        return cast(List[Dict[str, Any]], self._transport.json("GET", "/processes")["processes"])

    def process(self, process: str) -> Dict[str, Any]:
        """The description of one, with its inputs and outputs."""
        return cast(Dict[str, Any], self._transport.json("GET", f"/processes/{quote(process, safe='')}"))

    def submit(self, process: str, inputs: Mapping[str, Any], *, outputs: Optional[Mapping[str, Any]] = None,
               response: Optional[str] = None, idempotency_key: Optional[str] = None) -> Job:
        """A new job. The request may be sent several times, but makes one job: the service recognises it by its key. The key of
        an earlier call gives the job of that call."""
        body: Dict[str, Any] = {"inputs": dict(inputs)}
        if outputs is not None:
            body["outputs"] = dict(outputs)
        if response is not None:
            body["response"] = response
        headers = {"Prefer": "respond-async", "Idempotency-Key": idempotency_key or str(uuid.uuid4())}
        document = self._transport.json("POST", f"/processes/{quote(process, safe='')}/execution", body, headers)
        return Job(self._transport, str(document["jobID"]))

    def estimate(self, process: str, inputs: Mapping[str, Any]) -> Dict[str, Any]:
        """What a job would process: `buildings`, `expected` triangles and bytes, `problems`. Makes none."""
        body = {"inputs": {**inputs, "mode": "estimate"}}
        return cast(Dict[str, Any], self._transport.json("POST", f"/processes/{quote(process, safe='')}/execution", body))

    def job(self, job_id: str) -> Job:
        """A job from before. Whether it exists is seen when it is asked for something."""
        return Job(self._transport, job_id)

    def jobs(self, **filters: Any) -> Iterator[JobStatus]:
        """The states of all jobs, newest first; filters as in `/jobs?status=running&processID=heal`, several values as a list."""
        listed = {name: ",".join(map(str, value)) if isinstance(value, (list, tuple)) else value for name, value in filters.items()}
        query: Optional[str] = urlencode({**listed, "limit": PAGE_LENGTH})
        while query is not None:
            page = self._transport.json("GET", f"/jobs?{query}")
            yield from map(JobStatus.of, page["jobs"])
            query = next((urlsplit(link["href"]).query for link in page["links"] if link.get("rel") == "next"), None)

    def export(self, bbox: Optional[Box] = None, *, to: Union[str, Path], process: str = EXPORT, progress: bool = False,
               timeout_s: Optional[float] = None, idempotency_key: Optional[str] = None, **inputs: Any) -> Dict[str, Path]:
        """Exports a box into a folder: submits, waits and downloads. Returns the files by name. All other inputs of the process
        are given by name: `formats=["obj", "stl"], snap_tolerance_m=0.002`."""
        if bbox is not None:
            inputs["bbox"] = parse_bbox(bbox)
        job = self.submit(process, inputs, idempotency_key=idempotency_key)
        job.wait(progress, timeout_s)
        return job.download_all(to, progress)

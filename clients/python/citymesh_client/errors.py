"""What can go wrong. Errors that the service explained carry its problem document (RFC 7807)."""
from __future__ import annotations

from typing import Any, Dict, Optional, Type

Problem = Dict[str, Any]


class CitymeshError(Exception):
    """Base of all errors of this package."""


class Unreachable(CitymeshError):
    """No answer, or a broken one, after all retries."""


class DownloadFailed(CitymeshError):
    """A result file could not be fetched as a whole. What came stays and is continued by the next download."""


class WaitTimeout(CitymeshError, TimeoutError):
    """A job has not ended in the time given. It goes on."""


class HttpError(CitymeshError):
    """The service refused a request. `problem` is its explanation, with `type`, `title`, `status` and `detail`."""

    def __init__(self, status: int, problem: Problem, url: str, retry_after_s: Optional[float] = None):
        self.status = status
        self.problem = problem
        self.url = url
        self.retry_after_s = retry_after_s
        super().__init__(f"{status} {self.title}: {self.detail}" if self.detail else f"{status} {self.title}")

    @property
    def title(self) -> str:
        return str(self.problem.get("title", "no explanation"))

    @property
    def detail(self) -> str:
        return str(self.problem.get("detail", ""))

    @property
    def type(self) -> str:
        return str(self.problem.get("type", "about:blank"))


class InvalidRequest(HttpError):
    """An input, its form or its size is not what the service takes (400, 405, 413, 415, 422, 431)."""


class Forbidden(HttpError):
    """Credentials are missing, wrong or not enough (401, 403)."""


class NotFound(HttpError):
    """No such process, job or output, or its results are not there yet or any more (404, 410)."""


class Conflict(HttpError):
    """The job has ended (409), or the file has changed (412)."""


class TooManyRequests(HttpError):
    """The service is full (429), and stayed so during all retries."""


class ServerError(HttpError):
    """The service failed (5xx)."""


class ServiceUnavailable(ServerError):
    """The service, or a proxy in front of it, cannot answer now (502, 503, 504), and could not during all retries."""


class JobFailed(CitymeshError):
    """The job ended without results. `problem` says why."""

    def __init__(self, job_id: str, problem: Problem):
        self.job_id = job_id
        self.problem = problem
        super().__init__(f"job {job_id} failed: {problem.get('detail') or problem.get('title') or 'no reason given'}")


class JobDismissed(CitymeshError):
    """Somebody dismissed the job."""

    def __init__(self, job_id: str):
        self.job_id = job_id
        super().__init__(f"job {job_id} was dismissed")


_KINDS: Dict[int, Type[HttpError]] = {
    401: Forbidden, 403: Forbidden, 404: NotFound, 409: Conflict, 410: NotFound, 412: Conflict, 429: TooManyRequests,
    502: ServiceUnavailable, 503: ServiceUnavailable, 504: ServiceUnavailable,
}


def http_error(status: int, problem: Problem, url: str, retry_after_s: Optional[float] = None) -> HttpError:
    """The error that belongs to a status."""
    kind = _KINDS.get(status) or (InvalidRequest if 400 <= status < 500 else ServerError if status >= 500 else HttpError)
    return kind(status, problem, url, retry_after_s)

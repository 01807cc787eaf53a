"""Requests with credentials, retries and errors that explain themselves."""
from __future__ import annotations

import email.utils
import http.client
import json
import random
import ssl
import time
import urllib.error
import urllib.parse
import urllib.request
from email.message import Message
from typing import Any, Callable, Dict, Mapping, Optional, Tuple, TypeVar, cast

from .errors import HttpError, Problem, Unreachable, http_error

CREDENTIALS = ("Authorization", "X-api-key")  # in urllib's spelling
TEMPORARY = (429, 502, 503, 504)
NETWORK_ERRORS = (OSError, http.client.HTTPException)
LONGEST_PAUSE_S = 60.0
MOST_PROBLEM_BYTES = 1 << 20

Value = TypeVar("Value")


class _SameOriginCredentials(urllib.request.HTTPRedirectHandler):
    """Follows redirects, but tells no other server the key of this one."""

    def redirect_request(self, request: Any, file: Any, code: int, message: str, headers: Any,
                         url: str) -> Optional[urllib.request.Request]:
        redirected = super().redirect_request(request, file, code, message, headers, url)
        if redirected is not None and _origin(url) != _origin(request.full_url):
            for name in CREDENTIALS:
                redirected.remove_header(name)
        return redirected


def _origin(url: str) -> Tuple[str, Optional[str], Optional[int]]:
    parts = urllib.parse.urlsplit(url)
    return parts.scheme, parts.hostname, parts.port


class Transport:
    """Sends requests to one service. Has no state that changes, so threads may share it."""

    def __init__(self, url: str, api_key: Optional[str] = None, token: Optional[str] = None, timeout_s: float = 60.0, retries: int = 5,
                 context: Optional[ssl.SSLContext] = None):
        parts = urllib.parse.urlsplit(url)
        if parts.scheme not in ("http", "https") or not parts.hostname:
            raise ValueError(f"url is {url!r}, expected one that starts with http:// or https://")
        if parts.username is not None or parts.query or parts.fragment:
            raise ValueError("url must have neither user nor query nor fragment; keys are given as api_key or token")
        if api_key and token:
            raise ValueError("api_key and token are both given, expected one of them")
        self.base = url.rstrip("/")
        self.timeout_s = timeout_s
        self.retries = retries
        self._credentials: Dict[str, str] = {}
        if api_key:
            self._credentials["X-API-Key"] = api_key
        if token:
            self._credentials["Authorization"] = f"Bearer {token}"
        self._opener = urllib.request.build_opener(_SameOriginCredentials(), urllib.request.HTTPSHandler(context=context))

    def open(self, method: str, path: str, body: Any = None, headers: Optional[Mapping[str, str]] = None,
             timeout_s: Optional[float] = None) -> http.client.HTTPResponse:
        """One attempt; the answer is yet to be read and to be closed. Raises HttpError, or what the network raises."""
        fields = {"Accept": "application/json", "User-Agent": "citymesh-client/0.1.0", **self._credentials, **(headers or {})}
        data = None
        if body is not None:
            data = json.dumps(body).encode()
            fields["Content-Type"] = "application/json"
        request = urllib.request.Request(self.base + path, data, fields, method=method)
        try:
            answer = self._opener.open(request, timeout=self.timeout_s if timeout_s is None else timeout_s)
            return cast(http.client.HTTPResponse, answer)
        except urllib.error.HTTPError as error:
            with error:
                raise http_error(error.code, _problem(error), self.base + path, _retry_after_s(error.headers)) from None

    def json(self, method: str, path: str, body: Any = None, headers: Optional[Mapping[str, str]] = None) -> Any:
        """The answer as JSON. Retried, so only for requests that may be sent twice."""
        def attempt() -> Any:
            with self.open(method, path, body, headers) as answer:
                return json.loads(answer.read())
        return self.retried(attempt)

    def retried(self, attempt: Callable[[], Value]) -> Value:
        """The result of the first attempt that is neither turned away for now nor lost on the way."""
        number = 0
        while True:
            try:
                return attempt()
            except HttpError as error:
                if not is_temporary(error) or number == self.retries:
                    raise
                time.sleep(pause_s(number, error.retry_after_s))
            except (*NETWORK_ERRORS, json.JSONDecodeError, UnicodeDecodeError) as error:
                if number == self.retries or _is_final(error):
                    raise Unreachable(f"{self.base}: {_reason(error)}, {number + 1} attempts") from error
                time.sleep(pause_s(number))
            number += 1


def is_temporary(error: HttpError) -> bool:
    """Whether it is worth while to ask again soon."""
    return error.status in TEMPORARY and (error.retry_after_s or 0.0) <= LONGEST_PAUSE_S


def pause_s(number: int, retry_after_s: Optional[float] = None) -> float:
    """How long to wait after the attempt of this number: what the server says, else longer and longer; never the same for
    clients that were turned away together."""
    shortest = 0.5 * 2 ** min(number, 6) if retry_after_s is None else retry_after_s
    return min(LONGEST_PAUSE_S, float(shortest)) * random.uniform(1.0, 1.25)


def _retry_after_s(headers: Message) -> Optional[float]:
    text = headers.get("Retry-After")
    if text is None:
        return None
    if text.strip().isdigit():
        return float(text)
    try:
        return max(0.0, email.utils.parsedate_to_datetime(text).timestamp() - time.time())
    except (TypeError, ValueError):
        return None


def _problem(error: urllib.error.HTTPError) -> Problem:
    """The problem document; of others than our service a stand-in."""
    try:
        text = error.read(MOST_PROBLEM_BYTES)
        problem = json.loads(text)
        if isinstance(problem, dict):
            return problem
    except (*NETWORK_ERRORS, ValueError):
        pass
    return {"type": "about:blank", "title": str(error.reason), "status": error.code}


def _is_final(error: Exception) -> bool:
    """A certificate does not get better by asking again."""
    return isinstance(getattr(error, "reason", error), ssl.SSLCertVerificationError)


def _reason(error: Exception) -> str:
    reason = getattr(error, "reason", None) or error
    return str(reason) or type(reason).__name__

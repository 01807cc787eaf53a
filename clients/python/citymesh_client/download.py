"""Fetching a file that goes on where it broke: within a call, and from a call to the next."""
from __future__ import annotations

import os
import re
import time
import urllib.parse
from email.message import Message
from pathlib import Path
from typing import Callable, Optional, Tuple

from .errors import CitymeshError, DownloadFailed, HttpError
from .transport import NETWORK_ERRORS, Transport, is_temporary, pause_s

PIECE_BYTES = 1 << 18
CONTENT_RANGE = re.compile(r"bytes (\d+)-\d+/(\d+)$")

Progress = Callable[[int, int], None]  # bytes there, bytes in all


def safe_name(name: str) -> str:
    """A file name that a server gave, if it is one and stays in its folder."""
    if name in ("", ".", "..") or any(char in '/\\:' or ord(char) < 32 for char in name):
        raise CitymeshError(f"the service names a file {name!r}, which cannot be a file name here")
    return name


def name_of(headers: Message) -> str:
    """The file name in a Content-Disposition."""
    match = re.search(r'filename="([^"]*)"', headers.get("Content-Disposition", ""))
    return safe_name(urllib.parse.unquote(match.group(1)) if match else "")


def fetch(transport: Transport, path: str, target: Path, progress: Optional[Progress] = None) -> Path:
    """Writes the file to `target`, which is there only when it is complete. Until then `target.part` holds what has come, and
    `target.part.etag` of which version of the file it is."""
    part = target.with_name(target.name + ".part")
    tag_file = target.with_name(target.name + ".part.etag")
    failures = 0
    while True:
        before = _size(part)
        error, pause = _fetch_rest(transport, path, part, tag_file, progress)
        if error is None:
            break
        failures = 0 if _size(part) > before else failures + 1
        if failures > transport.retries:
            raise DownloadFailed(f"{target.name}: {error}; {_size(part)} bytes are in {part}") from error
        time.sleep(pause_s(failures, pause))
    os.replace(part, target)
    _remove(tag_file)
    return target


def _fetch_rest(transport: Transport, path: str, part: Path, tag_file: Path, progress: Optional[Progress]
                ) -> Tuple[Optional[Exception], Optional[float]]:
    """(None, None) when all is there, else what broke the connection and how long the server wants to be left alone."""
    etag = tag_file.read_text(encoding="ascii") if tag_file.exists() else ""
    there = _size(part) if etag else 0
    asked = {"Accept": "*/*"}
    if there:
        asked.update({"Range": f"bytes={there}-", "If-Range": etag})
    try:
        answer = transport.open("GET", path, headers=asked)
    except HttpError as error:
        if error.status == 416:  # what is here is no beginning of the file
            _remove(part)
            return error, 0.0
        if is_temporary(error):
            return error, error.retry_after_s
        raise
    except NETWORK_ERRORS as error:
        return error, None

    with answer:
        span = CONTENT_RANGE.match(answer.headers.get("Content-Range", "")) if answer.status == 206 else None
        if span and int(span.group(1)) == there:
            total: Optional[int] = int(span.group(2))
        elif answer.status == 206:
            _remove(part)
            return DownloadFailed(f"asked for bytes from {there}, got {answer.headers.get('Content-Range')!r}"), None
        else:  # the whole file
            there = 0
            length = answer.headers.get("Content-Length")
            total = int(length) if length else None
            _remove(part)
            etag = answer.headers.get("ETag", "")
            if etag and not etag.startswith("W/"):
                tag_file.write_text(etag, encoding="ascii")
            else:
                _remove(tag_file)
        with open(part, "ab" if there else "wb") as file:
            while True:
                try:
                    piece = answer.read(PIECE_BYTES)
                except NETWORK_ERRORS as error:
                    return error, None
                if not piece:
                    break
                file.write(piece)
                there += len(piece)
                if progress:
                    progress(there, total or there)
    if total is not None and there != total:
        if there > total:
            _remove(part)
        return DownloadFailed(f"the connection ended after {there} of {total} bytes"), None
    return None, None


def _size(path: Path) -> int:
    return path.stat().st_size if path.exists() else 0


def _remove(path: Path) -> None:
    if path.exists():
        path.unlink()

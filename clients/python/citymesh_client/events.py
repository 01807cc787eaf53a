"""Server-sent events: what browsers do with them, as far as a job needs it."""
from __future__ import annotations

import json
from typing import Any, Dict, IO, Iterator, List, Optional, Tuple

MOST_LINE_BYTES = 1 << 20


def read_events(stream: IO[bytes]) -> Iterator[Tuple[str, Optional[Dict[str, Any]]]]:
    """(id, data) of every complete event; one that the connection cut off is none. Data are JSON objects; None stands for a comment,
    by which the service says that it is still there."""
    last_id = ""
    data: List[str] = []
    while True:
        line = stream.readline(MOST_LINE_BYTES)
        if not line.endswith(b"\n"):
            return
        text = line.decode("utf-8", "replace").rstrip("\r\n")
        if not text:
            if data:
                document = json.loads("\n".join(data))
                if not isinstance(document, dict):
                    raise ValueError(f"the data of an event are {document!r}, expected an object")
                yield last_id, document
            data = []
            continue
        name, _, value = text.partition(":")
        value = value[1:] if value.startswith(" ") else value
        if not name:
            yield last_id, None
        elif name == "data":
            data.append(value)
        elif name == "id":
            last_id = value

"""Client of the citymesh service. Python's standard library only.

    from citymesh_client import Client

    Client("http://127.0.0.1:8080").export([13.400, 52.495, 13.405, 52.500], to="out/mitte", formats=["obj"])
"""
from .client import Client, parse_bbox
from .errors import (CitymeshError, Conflict, DownloadFailed, Forbidden, HttpError, InvalidRequest, JobDismissed, JobFailed, NotFound,
                     ServerError, ServiceUnavailable, TooManyRequests, Unreachable, WaitTimeout)
from .job import Job
from .status import JobStatus, ResultFile

__version__ = "0.1.0"

__all__ = ["CitymeshError", "Client", "Conflict", "DownloadFailed", "Forbidden", "HttpError", "InvalidRequest", "Job", "JobDismissed",
           "JobFailed", "JobStatus", "NotFound", "ResultFile", "ServerError", "ServiceUnavailable", "TooManyRequests", "Unreachable",
           "WaitTimeout", "parse_bbox"]

"""The service from the command line: python3 -m citymesh_client export --url URL --bbox BOX --output DIR"""
from __future__ import annotations

import argparse
import json
import os
import ssl
import sys
from pathlib import Path
from typing import Any, Dict, List, Optional

from .client import EXPORT, Client, parse_bbox
from .errors import CitymeshError
from .job import Job

KEY_VARIABLE, TOKEN_VARIABLE = "CITYMESH_API_KEY", "CITYMESH_TOKEN"
ENDED_BADLY, WRONG_USAGE, INTERRUPTED = 1, 2, 130


def input_of(text: str, schema: Dict[str, Any]) -> Any:
    """The value of `name=value`, in the form that the description of the input asks for."""
    kind = schema.get("type")
    if kind == "string":
        return text
    if kind == "array":
        return [item for item in text.split(",") if item]
    try:
        return json.loads(text)
    except ValueError:
        return text  # the service says what it expected


def inputs_of(arguments: argparse.Namespace, client: Client) -> Dict[str, Any]:
    described = client.process(arguments.process).get("inputs", {}) if arguments.set else {}
    inputs = {}
    for setting in arguments.set:
        name, found, text = setting.partition("=")
        if not found:
            raise ValueError(f"--set {setting}: expected name=value")
        inputs[name] = input_of(text, described.get(name, {}).get("schema", {}))
    if arguments.bbox:
        inputs["bbox"] = parse_bbox(arguments.bbox)
    if arguments.format:
        inputs["formats"] = arguments.format.split(",")
    return inputs


def finish(job: Job, arguments: argparse.Namespace) -> None:
    """Waits for a job and puts its files into the folder."""
    show = not arguments.quiet
    try:
        status = job.wait(progress=show)
        files = job.download_all(arguments.output, progress=show)
    except KeyboardInterrupt:
        again = f"python3 -m citymesh_client {{}} --url {arguments.url} {job.id}"
        print(f"\nThe job goes on. Its results: {again.format('fetch')} --output {arguments.output}\n"
              f"To stop it: {again.format('dismiss')}", file=sys.stderr)
        raise
    if show:
        print(status.message, file=sys.stderr)
    for path in files.values():
        print(path)


def export(client: Client, arguments: argparse.Namespace) -> None:
    job = client.submit(arguments.process, inputs_of(arguments, client), idempotency_key=arguments.idempotency_key)
    if not arguments.quiet:
        print(f"job {job.id}", file=sys.stderr)
    finish(job, arguments)


def fetch(client: Client, arguments: argparse.Namespace) -> None:
    finish(client.job(arguments.job), arguments)


def dismiss(client: Client, arguments: argparse.Namespace) -> None:
    print(client.job(arguments.job).dismiss().state)


def processes(client: Client, arguments: argparse.Namespace) -> None:
    for process in client.processes():
        print(f"{process['id']}: {process.get('description', '')}")


def parse_arguments(words: Optional[List[str]]) -> argparse.Namespace:
    service = argparse.ArgumentParser(add_help=False)
    service.add_argument("--url", required=True, help="what the addresses of the service begin with")
    service.add_argument("--ca", metavar="FILE", help="certificates to trust instead of those of the system")
    service.add_argument("--timeout_s", type=float, default=60.0, metavar="S", help="longest silence of the service (default: 60)")
    service.add_argument("--retries", type=int, default=5, metavar="N", help="of requests turned away or lost (default: 5)")
    folder = argparse.ArgumentParser(add_help=False)
    folder.add_argument("--output", required=True, type=Path, metavar="DIR", help="folder of the results")
    folder.add_argument("--quiet", action="store_true", help="no progress bar")

    parser = argparse.ArgumentParser(
        prog="citymesh_client", description="The citymesh service from the command line.",
        epilog=f"An API key is taken from the environment variable {KEY_VARIABLE}, a bearer token from {TOKEN_VARIABLE}. Exit codes: "
               "0 done; 1 refused, failed or not reached, the reason is on stderr; 2 wrong usage.")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    command = commands.add_parser("export", parents=[service, folder], help="exports a box into a folder")
    command.add_argument("--bbox", metavar="BOX", help="minx,miny,maxx,maxy[@CRS]; longitude and latitude when no CRS is named")
    command.add_argument("--format", metavar="LIST", help="obj,stl,…")
    command.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="any other input; may be repeated")
    command.add_argument("--process", default=EXPORT, metavar="ID", help=f"default: {EXPORT}")
    command.add_argument("--idempotency_key", metavar="KEY", help="the same key again gives the job of the first time")
    command.set_defaults(run=export)

    command = commands.add_parser("fetch", parents=[service, folder], help="waits for a job and fetches its results")
    command.add_argument("job", help="id of the job")
    command.set_defaults(run=fetch)

    command = commands.add_parser("dismiss", parents=[service], help="stops a job")
    command.add_argument("job", help="id of the job")
    command.set_defaults(run=dismiss)

    command = commands.add_parser("processes", parents=[service], help="lists the processes")
    command.set_defaults(run=processes)
    return parser.parse_args(joined(sys.argv[1:] if words is None else words))


def joined(words: List[str]) -> List[str]:
    """With `--bbox -1,51,0,52` as one word: argparse would take the box for a flag."""
    result: List[str] = []
    for word in words:
        if result and result[-1] == "--bbox":
            result[-1] = f"--bbox={word}"
        else:
            result.append(word)
    return result


def main(words: Optional[List[str]] = None) -> int:
    arguments = parse_arguments(words)
    try:
        context = ssl.create_default_context(cafile=arguments.ca) if arguments.ca else None
        client = Client(arguments.url, os.environ.get(KEY_VARIABLE), os.environ.get(TOKEN_VARIABLE), timeout_s=arguments.timeout_s,
                        retries=arguments.retries, context=context)
        arguments.run(client, arguments)
    except ValueError as error:
        print(error, file=sys.stderr)
        return WRONG_USAGE
    except (CitymeshError, OSError) as error:
        print(error, file=sys.stderr)
        return ENDED_BADLY
    except KeyboardInterrupt:
        return INTERRUPTED
    return 0


if __name__ == "__main__":
    sys.exit(main())

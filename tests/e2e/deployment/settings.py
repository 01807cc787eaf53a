"""What `citymesh serve` makes of an environment, for tests of what sets that environment."""
import os
import re
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(os.environ.get("CITYMESH_ROOT", Path(__file__).resolve().parents[3]))
PROGRAM = os.environ.get("CITYMESH_PROGRAM", "citymesh")


def names():
    """The environment variables that are settings."""
    text = subprocess.run([PROGRAM, "serve", "--help"], check=True, capture_output=True, text=True).stdout
    return set(re.findall(r"\(Env:(CITYMESH_\w+)\)", text)) | {"CITYMESH_CONFIG"}


def accepted(environment, files):
    """What the program says of its settings, as texts by name; `files` are contents by the path that a container has them at."""
    with tempfile.TemporaryDirectory(prefix="citymesh-settings-") as folder:
        here = {}
        for path, content in files.items():
            file = Path(folder) / Path(path).name
            file.write_text(content, encoding="utf-8")
            here[path] = str(file)
        clean = {name: value for name, value in os.environ.items() if not name.startswith("CITYMESH_")}
        ran = subprocess.run([PROGRAM, "serve", "--print_config"], capture_output=True, text=True,
                             env=clean | {name: here.get(value, value) for name, value in environment.items()})
        assert ran.returncode == 0, ran.stderr
        there = {file: path for path, file in here.items()}
        found = dict(re.findall(r'^(\w+) ?= ?"?([^"\n]*)"?$', ran.stdout, re.MULTILINE))
        return {name: there.get(value, value) for name, value in found.items()}


def made_secrets(folder):
    """The files of deploy/make-secrets.sh by name."""
    subprocess.run([ROOT / "deploy" / "make-secrets.sh", "--folder", folder, "--citymesh", PROGRAM], check=True,
                   capture_output=True)
    return {path.name: path.read_text(encoding="utf-8") for path in Path(folder).iterdir()}

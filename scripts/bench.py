#!/usr/bin/env python3
"""The speed figures: reading against xmllint, buildings per second of the whole run on one core, growth with size, memory; with
--catalogue: indexing a folder and finding a box in it.

Tiles real CityGML to the wanted sizes (kept in out/bench), pins every measured program to one core, takes the median of the runs
and prints a Markdown table.
"""
import argparse
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def big_file(source, megabytes, folder):
    path = folder / f"{Path(source).name.split('.')[0]}_{megabytes}.gml"
    if not path.exists():
        subprocess.run([sys.executable, ROOT / "scripts/make_big_city.py", source, str(megabytes), path.with_suffix(".part")], check=True)
        path.with_suffix(".part").rename(path)
    return path


def measured(command, core):
    """(CPU seconds, peak MB, standard output) of a child pinned to one core."""
    with tempfile.TemporaryFile() as output, tempfile.TemporaryFile() as errors:
        child = subprocess.Popen([str(word) for word in command], stdout=output, stderr=errors, stdin=subprocess.DEVNULL,
                                 preexec_fn=lambda: os.sched_setaffinity(0, {core}))
        _, status, usage = os.wait4(child.pid, 0)
        seconds = usage.ru_utime + usage.ru_stime  # what else runs on the machine does not count
        child.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        text = output.read().decode(errors="replace")
        if child.returncode not in (0, 1):
            errors.seek(0)
            raise SystemExit(f"exit code {child.returncode}: {' '.join(map(str, command))}\n{errors.read().decode(errors='replace')}")
    return seconds, usage.ru_maxrss / 1024, text


def median_of(runs, command, core):
    results = [measured(command, core) for _ in range(runs)]
    return statistics.median(r[0] for r in results), max(r[1] for r in results), results[0][2]


def big_folder(megabytes, folder):
    """All Berlin tiles of the tests, tiled to the same size each."""
    sources = sorted((ROOT / "tests/data/berlin").glob("*.gml*"))
    tiles = folder / f"city_{megabytes}"
    tiles.mkdir(exist_ok=True)
    for source in sources:
        big_file(source, round(int(megabytes) / len(sources)), tiles)
    return tiles


def buildings_in(path):
    count = 0
    with open(path, "rb") as file:
        for line in file:
            count += len(re.findall(rb"<(?:\w+:)?Building[ >]", line))
    return count


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=ROOT / "build/tools")
    parser.add_argument("--source", default=ROOT / "tests/data/berlin/3910_5817.gml")
    parser.add_argument("--sizes", default="10,100", help="megabytes")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--core", type=int, default=sorted(os.sched_getaffinity(0))[-1])
    parser.add_argument("--catalogue", metavar="MB", help="also index a folder of this size and ask for boxes")
    parser.add_argument("--folder", type=Path, default=ROOT / "out/bench")
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    program = arguments.build / "services/apps/citymesh"
    reader = arguments.build / "tests/bench/source/read_throughput"

    if arguments.catalogue:
        tiles = big_folder(arguments.catalogue, arguments.folder)
        latency = arguments.build / "tests/bench/catalogue/catalogue_latency"
        print(measured([latency, tiles, "50", arguments.runs], arguments.core)[2], flush=True)

    print(f"Median of {arguments.runs}, one core, {Path(arguments.source).name} tiled\n")
    print("| file | buildings | xmllint | selecting | reading | reading / xmllint | whole run | buildings/s | peak memory |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    whole = []
    for size in arguments.sizes.split(","):
        path = big_file(arguments.source, size, arguments.folder)
        buildings = buildings_in(path)
        megabytes = path.stat().st_size / 1e6
        lint_s, _, _ = median_of(arguments.runs, ["xmllint", "--stream", "--noout", "--huge", path], arguments.core)
        select = reading = ratio = "-"
        if reader.exists():
            # It prints the two passes of a source: finding the selection, and parsing it to a city model.
            text = measured([reader, path, arguments.runs], arguments.core)[2]
            select_s, read_s = (float(re.search(rf"^{name} +([0-9.]+) s", text, re.MULTILINE)[1]) for name in ("select", "read"))
            select, reading, ratio = f"{select_s:.2f} s", f"{read_s:.2f} s", f"{read_s / lint_s:.2f}"
        out = Path(tempfile.mkdtemp(prefix="citymesh-bench-"))
        seconds, peaks = [], []
        try:
            for run in range(arguments.runs):
                run_s, peak, _ = measured([program, "run", "export-for-simulation", "--input", path, "--output", out / str(run),
                                           "--format", "obj", "--threads", "1"], arguments.core)
                seconds.append(run_s)
                peaks.append(peak)
                shutil.rmtree(out / str(run))
        finally:
            shutil.rmtree(out)
        run_s = statistics.median(seconds)
        whole.append((megabytes, run_s))
        print(f"| {path.name}, {megabytes:.0f} MB | {buildings} | {lint_s:.2f} s | {select} | {reading} | {ratio} | {run_s:.2f} s | "
              f"{buildings / run_s:.0f} | {max(peaks):.0f} MB |", flush=True)
    if len(whole) > 1:
        (small, small_s), (large, large_s) = whole[0], whole[-1]
        print(f"\n{large / small:.1f} times the input takes {large_s / small_s:.1f} times as long.")


if __name__ == "__main__":
    main()

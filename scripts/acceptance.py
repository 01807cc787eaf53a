#!/usr/bin/env python3
"""Runs export-for-simulation over every file whose number of buildings is known and has an independent checker read every body.

For each file of tests/support/expected_counts.tsv below CITYMESH_EXTRA_DATA: counts.requested is the known number, every
building is accounted for, and every body of model.obj and model.stl is sound for the checker. Prints a Markdown table.
Exit code 0: all hold; 1: some do not; 77: there is no data.
"""
import argparse
import collections
import concurrent.futures
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def known_files(table, data, only):
    for line in table.read_text(encoding="utf-8").splitlines():
        if line.startswith("#") or not line.strip():
            continue
        name, form, buildings, parts, *options = line.split("\t")
        if only in name:
            yield name, data / name, form, int(buildings), int(parts), options


def accounting_faults(report, expected):
    counts = report["counts"]
    if counts["requested"] != expected:
        yield f"requested {counts['requested']}, expected {expected}"
    for label, these in (("buildings", counts), ("parts", counts["parts"])):
        if these["requested"] != these["delivered"] + these["merged"] + these["dropped"]:
            yield f"{label}: requested is not delivered + merged + dropped: {these}"
    buildings = report["buildings"]
    if len(buildings) != counts["requested"]:
        yield f"{len(buildings)} entries in buildings[], {counts['requested']} requested"
    outcomes = collections.Counter(building["outcome"] for building in buildings)
    for outcome in ("delivered", "merged", "dropped"):
        if outcomes[outcome] != counts[outcome]:
            yield f"{outcomes[outcome]} buildings are {outcome} in buildings[], {counts[outcome]} in counts"
    for building in buildings:
        if building["outcome"] == "dropped" and not building.get("reason"):
            yield f"{building['gml_id']} is dropped without a reason"
        if building["outcome"] == "delivered" and not building.get("rung"):
            yield f"{building['gml_id']} is delivered without a rung"
        if building["outcome"] == "delivered" and any(part["outcome"] == "dropped" for part in building.get("parts", [])):
            yield f"{building['gml_id']} is delivered without all its parts"
    names = [building["name"] for building in buildings]
    if len(set(names)) != len(names):
        yield "two buildings have one name"


def body_names(path):
    """Bodies of an OBJ or ASCII STL file, each once, in the order of the file."""
    names = {}
    with open(path, encoding="ascii") as file:
        for line in file:
            if line.startswith("o "):
                names[line[2:].strip()] = None
            elif line.startswith("solid "):
                solid = line[6:].strip().rpartition("__")[0]
            elif line.lstrip().startswith("facet"):
                names[solid] = None  # a solid without facets is no body
    return list(names)


def body_faults(report, obj_names, stl_names):
    if obj_names != stl_names:
        yield f"OBJ and STL hold different bodies ({len(obj_names)} and {len(stl_names)})"
    owners = {}
    for building in report["buildings"]:
        owners[building["name"]] = building
        for part in building.get("parts", []):
            owners[part["name"]] = building
    bodies = collections.Counter()
    for name in obj_names:
        if name not in owners:
            yield f"body {name} is in no building of the report"
        else:
            bodies[owners[name]["name"]] += 1
    for building in report["buildings"]:
        has_body = bodies[building["name"]] > 0
        if building["outcome"] == "delivered" and not has_body:
            yield f"{building['gml_id']} is delivered but has no body"
        if building["outcome"] == "dropped" and has_body:
            yield f"{building['gml_id']} is dropped but has a body"


def judge(program, checker, path, expected, extra):
    """(row cells, faults)"""
    with tempfile.TemporaryDirectory(prefix="citymesh-acceptance-") as folder:
        output = Path(folder, "out")
        started = time.monotonic()
        run = subprocess.run([program, "run", "export-for-simulation", "--input", path, "--output", output,
                              "--format", "obj,stl", "--threads", "1", *extra], capture_output=True, text=True, stdin=subprocess.DEVNULL)
        seconds = time.monotonic() - started
        if run.returncode not in (0, 1):
            last = (run.stderr.strip().splitlines() or ["no message"])[-1]
            return ["-", "-", "-", "-", "-", "not run"], [f"exit code {run.returncode}: {last}"]
        report = json.loads((output / "report.json").read_text(encoding="utf-8"))
        counts = report["counts"]
        faults = list(accounting_faults(report, expected))
        if run.returncode != (1 if counts["dropped"] or any(i["state"] == "failed" for i in report["inputs"]) else 0):
            faults.append(f"exit code {run.returncode} with {counts['dropped']} dropped")

        verdicts, names = [], {}
        for kind in ("obj", "stl"):
            model = output / f"model.{kind}"
            if not model.exists():
                faults.append(f"{model.name} was not written")
                continue
            names[kind] = body_names(model)
            check = subprocess.run([checker, model, "--json"], capture_output=True, text=True, stdin=subprocess.DEVNULL)
            if check.returncode not in (0, 1):
                faults.append(f"checker: {check.stderr.strip()}")
                continue
            verdict = json.loads(check.stdout)
            verdicts.append(verdict["bodies"] - verdict["unsound"] if verdict["unsound"] else verdict["bodies"])
            for failure in verdict["failures"]:
                faults.append(f"{kind}: {failure['body']}: {'; '.join(failure['findings'])}")
        if len(names) == 2:
            faults += body_faults(report, names["obj"], names["stl"])
        reasons = collections.Counter(b["reason"] for b in report["buildings"] if b["outcome"] == "dropped")
        rungs = collections.Counter(b["rung"] for b in report["buildings"] if b["outcome"] == "delivered")
        text = lambda tally: ", ".join(f"{key} {count}" for key, count in tally.most_common()) or "-"
        bodies = " / ".join(str(verdict) for verdict in verdicts) + " sound"
        return [counts["requested"], counts["delivered"], counts["merged"],
                f"{counts['dropped']}" + (f" ({text(reasons)})" if reasons else ""), text(rungs),
                bodies + f" ({seconds:.1f} s)"], faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, help="citymesh")
    parser.add_argument("--checker", required=True, help="citymesh_mesh_checker")
    parser.add_argument("--only", default="", help="files whose name contains this")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--output", type=Path, help="also write the table here")
    parser.add_argument("--set", action="append", default=[], help="option for citymesh run, name=value")
    arguments = parser.parse_args()

    data = os.environ.get("CITYMESH_EXTRA_DATA")
    if not data or not Path(data).is_dir():
        print("skipped: CITYMESH_EXTRA_DATA names no folder; it holds the city models of the acceptance run")
        return 77
    settings = lambda options: [word for option in options for word in ("--set", option)]
    files = list(known_files(ROOT / "tests/support/expected_counts.tsv", Path(data), arguments.only))
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        results = list(pool.map(lambda file: judge(arguments.program, arguments.checker, file[1], file[3],
                                                    settings(file[5] + arguments.set)), files))

    lines = ["| file | expected | requested | delivered | merged | dropped | rungs | bodies, OBJ / STL | |",
             "| --- | ---: | ---: | ---: | ---: | --- | --- | --- | --- |"]
    totals = collections.Counter()
    for (name, _, _, expected, *_), (cells, faults) in zip(files, results):
        lines.append(f"| {name} | {expected} | " + " | ".join(map(str, cells)) + f" | {'**fault**' if faults else 'ok'} |")
        totals.update(expected=expected, files=1, faulty=bool(faults))
        for key, cell in zip(("requested", "delivered", "merged"), cells):
            totals[key] += cell if isinstance(cell, int) else 0
    lines.append(f"\n{totals['files']} files, {totals['expected']} buildings expected, {totals['requested']} requested, "
                 f"{totals['delivered']} delivered, {totals['merged']} merged; {totals['faulty']} files with faults.")
    table = "\n".join(lines)
    print(table)
    if arguments.output:
        arguments.output.write_text(table + "\n", encoding="utf-8")
    for (name, *_), (_, faults) in zip(files, results):
        for fault in faults[:10]:
            print(f"{name}: {fault}", file=sys.stderr)
        if len(faults) > 10:
            print(f"{name}: and {len(faults) - 10} more", file=sys.stderr)
    return 1 if totals["faulty"] else 0


if __name__ == "__main__":
    sys.exit(main())

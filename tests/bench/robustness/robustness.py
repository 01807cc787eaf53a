#!/usr/bin/env python3
"""Measures what becomes of every building: of real city models, of generated defective houses, of collections of defects.

    robustness.py --program citymesh --checker citymesh_mesh_checker --make-defects citymesh_make_defects [--output docs/robustness.md]

Real data is looked for below CITYMESH_EXTRA_DATA (or --data): the files of tests/support/expected_counts.tsv, and the folders
*-defects and soups, whose objects only have to be accounted for. Every mesh is judged by an independent checker. With --output
the tables replace those between the markers of that page. Exit code 0: all targets hold; 1: some do not; 77: there is no data.
"""
import argparse
import collections
import concurrent.futures
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
RUNGS = ("as_is", "healed", "rebuilt_2_5d", "rebuilt_3d", "reconstructed", "wrapped", "lod1_block")
SHARP = RUNGS[:4]  # rungs that keep planes and edges
MAX_VOLUME_ERROR = 0.005
BEGIN, END = "<!-- measured: begin -->", "<!-- measured: end -->"


def call(command):
    """(exit code, stdout, last line of stderr, CPU seconds)"""
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        child = subprocess.Popen([str(word) for word in command], stdout=out, stderr=err, stdin=subprocess.DEVNULL)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0), err.seek(0)
        last = (err.read().strip().splitlines() or [""])[-1]
        return child.returncode, out.read(), last, usage.ru_utime + usage.ru_stime


class Outcome:
    """What a run made of one file, or of several of one data set."""

    def __init__(self, name):
        self.name = name
        self.buildings = []  # entries of report.json
        self.bodies = 0
        self.faults = []     # what must not be
        self.notes = []      # what a reader should know
        self.seconds = 0.0
        self.val3dity = None  # (errors by code, its seconds, those of healing to CityJSON)

    def add(self, other):
        self.buildings += other.buildings
        self.bodies += other.bodies
        self.faults += other.faults
        self.notes += other.notes
        self.seconds += other.seconds
        if other.val3dity:
            codes, *seconds = self.val3dity or (collections.Counter(), 0.0, 0.0)
            more, *others = other.val3dity
            self.val3dity = codes + more, seconds[0] + others[0], seconds[1] + others[1]

    def rungs(self):
        return collections.Counter(b["rung"] for b in self.buildings if b["outcome"] == "delivered")

    def dropped(self):
        return [b for b in self.buildings if b["outcome"] == "dropped"]

    def deviation(self):
        healed = [b for b in self.buildings if b["outcome"] == "delivered"]
        if not healed:
            return "-"
        return f"{max(b['deviation_max_m'] for b in healed):.3f} / {sum(b['deviation_mean_m'] for b in healed) / len(healed):.4f}"


def judge_meshes(outcome, checker, folder, formats):
    for kind in formats:
        model = folder / f"model.{kind}"
        if not model.exists():
            outcome.faults.append(f"{outcome.name}: {model.name} was not written")
            continue
        code, out, last, _ = call([checker, model, "--json"])
        if code not in (0, 1):
            outcome.faults.append(f"{outcome.name}: checker: {last}")
            continue
        verdict = json.loads(out)
        outcome.bodies += verdict["bodies"] if kind == formats[0] else 0
        outcome.faults += [f"{outcome.name}: {kind}: {failure['body']}: {'; '.join(failure['findings'])}"
                           for failure in verdict["failures"]]


def judge_with_val3dity(outcome, tools, path, options):
    """The format that val3dity reads alone, for the sake of comparable times."""
    with tempfile.TemporaryDirectory(prefix="citymesh-val3dity-") as temporary:
        folder, report = Path(temporary, "out"), Path(temporary, "report.json")
        _, _, _, healing = call([tools.program, "run", "heal", "--input", path, "--output", folder,
                                 "--format", "cityjson", "--threads", "1", *options])
        code, _, last, seconds = call([tools.val3dity, folder / "model.city.json", "--report", report])
        if not report.exists():
            outcome.notes.append(f"{outcome.name}: val3dity: exit code {code}: {last}")
            return
        codes = collections.Counter()

        def collect(errors):
            codes.update(str(error["code"]) for error in errors)

        text = json.loads(report.read_text(encoding="utf-8"))
        for feature in text.get("features", []):
            collect(feature.get("errors", []))
            for primitive in feature.get("primitives", []):
                collect(primitive.get("errors", []))
        collect(text.get("dataset_errors", []))
        outcome.val3dity = codes, seconds, healing


def run_file(tools, name, path, options, strict=True):
    outcome = Outcome(name)
    with tempfile.TemporaryDirectory(prefix="citymesh-robustness-") as temporary:
        folder = Path(temporary, "out")
        code, _, last, outcome.seconds = call([tools.program, "run", tools.process, "--input", path, "--output", folder,
                                               "--format", "obj,stl", "--threads", "1", *options])
        if code not in (0, 1):
            (outcome.faults if strict or code < 0 or code > 100 else outcome.notes).append(f"{name}: exit code {code}: {last}")
            return outcome
        report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
        outcome.buildings = report["buildings"]
        for building in outcome.buildings:
            building["file"] = name
        if len(outcome.buildings) != report["counts"]["requested"]:
            outcome.faults.append(f"{name}: {len(outcome.buildings)} buildings in the report, {report['counts']['requested']} requested")
        for building in outcome.buildings:
            if building["outcome"] == "dropped" and not building["reason"]:
                outcome.faults.append(f"{name}: {building['gml_id']} is dropped without a reason")
            if building["outcome"] == "delivered" and building["rung"] not in RUNGS:
                outcome.faults.append(f"{name}: {building['gml_id']} is delivered without a rung")
        for entry in report["inputs"]:
            if entry["state"] == "failed":
                (outcome.faults if strict else outcome.notes).append(f"{name}: not read: {entry['message']}")
        if any(building["outcome"] == "delivered" for building in outcome.buildings):
            judge_meshes(outcome, tools.checker, folder, ("obj", "stl"))
            if tools.val3dity:
                judge_with_val3dity(outcome, tools, path, options)
    return outcome


def known_files(data, only):
    for line in (ROOT / "tests/support/expected_counts.tsv").read_text(encoding="utf-8").splitlines():
        if line.startswith("#") or not line.strip():
            continue
        name, _, _, _, *options = line.split("\t")
        if only in name:
            yield name, data / name, [word for option in options for word in ("--set", option)]


def collections_of_defects(data, only):
    suffixes = (".gml", ".xml", ".json", ".jsonl", ".obj", ".off", ".ply", ".poly", ".stl", ".gz")
    for folder in sorted([*data.glob("*-defects"), *data.glob("soups")]):
        for path in sorted(folder.rglob("*")):
            name = path.relative_to(data).as_posix()
            if path.is_file() and path.suffix in suffixes and only in name:
                yield name, path, []


def read_truth(path):
    truth = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            gml_id, shape, defects, volume, undefined = line.split("\t")
            truth[gml_id] = (shape, defects, float(volume), float(undefined))
    return truth


def volume_error(building, truth):
    _, _, volume, undefined = truth[building["gml_id"]]
    return max(0.0, abs(building["volume_after_m3"] - volume) - undefined) / volume


def table_row(outcome, extra):
    rungs = outcome.rungs()
    dropped = outcome.dropped()
    cells = [outcome.name, len(outcome.buildings), sum(rungs.values()), len(dropped)]
    cells += [rungs[rung] or "" for rung in RUNGS]
    cells += ["red" if outcome.faults else f"green ({outcome.bodies})", outcome.deviation(), f"{outcome.seconds:.1f} s", *extra]
    return "| " + " | ".join(map(str, cells)) + " |"


def table_head(first, extra):
    names = [first, "buildings", "delivered", "dropped", *RUNGS, "gates (bodies)", "distance max / mean, m", "time", *extra]
    return ["| " + " | ".join(names) + " |", "| --- |" + " ---: |" * (len(names) - 1)]


def val3dity_cells(outcome):
    if not outcome.val3dity:
        return ["-", "-"]
    codes, seconds, healing = outcome.val3dity
    return [", ".join(f"{code}: {count}" for code, count in sorted(codes.items())) or "0", f"{healing:.1f} / {seconds:.1f} s"]


def percent(part, whole):
    return f"{100.0 * part / whole:.2f} %" if whole else "-"


def target(lines, holds, text):
    lines.append(f"- {'holds' if holds else '**missed**'}: {text}")
    return holds


def without_area(building):
    """Buildings that no face of positive area belongs to are not counted."""
    return building["outcome"] == "dropped" and building["reason"] == "no_geometry"


def real_part(tools, data, only, page, offenders):
    sets = {}
    files = list(known_files(data, only))
    if not files:
        return True
    with concurrent.futures.ThreadPoolExecutor(tools.jobs) as pool:
        outcomes = list(pool.map(lambda file: run_file(tools, *file), files))
    for outcome in outcomes:
        folder = outcome.name.split("/")[0]
        sets.setdefault(folder, Outcome(folder)).add(outcome)
    extra = ["val3dity errors", "heal / val3dity"] if tools.val3dity else []
    total = Outcome("all")
    page += ["## Real city models", ""] + table_head("data set", extra)
    for outcome in sets.values():
        page.append(table_row(outcome, val3dity_cells(outcome) if extra else []))
        total.add(outcome)
    page += [table_row(total, val3dity_cells(total) if extra else []), ""]
    rungs, empty = total.rungs(), [b for b in total.buildings if without_area(b)]
    counted, delivered = len(total.buildings) - len(empty), sum(rungs.values())
    sharp = sum(rungs[rung] for rung in SHARP)
    ok = target(page, delivered == counted, f"{delivered} of {counted} buildings with a face are delivered ({percent(delivered, counted)}; target 100 %)")
    ok &= target(page, not total.faults, f"delivery gates of {total.bodies} bodies, read back from OBJ and STL by the independent checker: {len(total.faults)} faults")
    ok &= target(page, sharp >= 0.98 * counted, f"{percent(sharp, counted)} on as_is … rebuilt_3d (target 98 %)")
    ok &= target(page, rungs["lod1_block"] < 0.002 * counted, f"{percent(rungs['lod1_block'], counted)} on lod1_block (target below 0.2 %)")
    if tools.val3dity and total.val3dity:
        codes, seconds, healing = total.val3dity
        ok &= target(page, not codes, f"val3dity finds {sum(codes.values())} errors in the healed CityJSON (target 0)")
        ok &= target(page, healing <= seconds, f"{healing:.1f} s for reading, healing, gates and writing as CityJSON, {seconds:.1f} s for val3dity to validate the result (one thread each)")
    page.append("")
    if empty:
        page += ["Not counted, because nothing of the asked levels of detail has a face: "
                 + ", ".join(f"`{b['gml_id']}` ({b['file']})" for b in empty) + ".", ""]
    offenders += [b for b in total.buildings if not without_area(b) and (b["outcome"] == "dropped" or b["rung"] not in SHARP)]
    page += fault_lines(total)
    return ok


def generated_part(tools, plan, page, offenders):
    with tempfile.TemporaryDirectory(prefix="citymesh-defects-") as folder:
        city, truth_file = Path(folder, "city.json"), Path(folder, "truth.tsv")
        code, _, last, _ = call([tools.make_defects, *plan, city, truth_file])
        if code != 0:
            raise SystemExit(f"{tools.make_defects}: {last}")
        truth = read_truth(truth_file)
        outcome = run_file(tools, "generated", city, [])
    by_defect = {}
    for building in outcome.buildings:
        kind = truth[building["gml_id"]][1].replace("-", "none (sound)")
        kind = kind if "+" not in kind else "pairs with " + kind.split("+")[0]
        by_defect.setdefault(kind, Outcome(kind)).buildings.append(building)
    page += ["## Generated houses", "",
             f"`citymesh_make_defects {' '.join(plan)}`: {len(truth)} houses, {len({t[0] for t in truth.values()})} shapes.", ""]
    names = ["defects", "houses", "delivered", *RUNGS, "volume within 0.5 %", "largest error on as_is … rebuilt_3d", "distance max / mean, m"]
    page += ["| " + " | ".join(names) + " |", "| --- |" + " ---: |" * (len(names) - 1)]
    right = {b["gml_id"] for b in outcome.buildings
             if b["outcome"] == "delivered" and b["rung"] in SHARP and volume_error(b, truth) <= MAX_VOLUME_ERROR}
    for kind in [*sorted(by_defect), "all"]:
        part = by_defect.get(kind, outcome)
        rungs = part.rungs()
        errors = [volume_error(b, truth) for b in part.buildings if b["outcome"] == "delivered" and b["rung"] in SHARP]
        good = sum(b["gml_id"] in right for b in part.buildings)
        cells = [kind, len(part.buildings), sum(rungs.values()), *(rungs[rung] or "" for rung in RUNGS), good,
                 f"{100 * max(errors, default=0):.3f} %", part.deviation()]
        page.append("| " + " | ".join(map(str, cells)) + " |")
    page.append("")
    count = len(outcome.buildings)
    delivered = sum(outcome.rungs().values())
    ok = target(page, count == len(truth) and delivered == count, f"{delivered} of {len(truth)} houses are delivered (target 100 %)")
    ok &= target(page, not outcome.faults, f"delivery gates of {outcome.bodies} bodies: {len(outcome.faults)} faults")
    ok &= target(page, len(right) >= 0.99 * count, f"{percent(len(right), count)} on as_is … rebuilt_3d with a volume within 0.5 % of the truth (target 99 %)")
    if outcome.val3dity:
        ok &= target(page, not outcome.val3dity[0], f"val3dity finds {sum(outcome.val3dity[0].values())} errors in the healed CityJSON: {val3dity_cells(outcome)[0]} (target 0)")
    page.append(f"- {outcome.seconds:.1f} s of CPU for all houses")
    page.append("")
    page += fault_lines(outcome)
    offenders += [dict(b, error=volume_error(b, truth) if b["outcome"] == "delivered" else None)
                  for b in outcome.buildings if b["gml_id"] not in right]
    return ok


def defects_part(tools, data, only, page):
    files = list(collections_of_defects(data, only))
    if not files:
        return True
    with concurrent.futures.ThreadPoolExecutor(tools.jobs) as pool:
        outcomes = list(pool.map(lambda file: run_file(tools, *file, strict=False), files))
    sets, counts = {}, collections.Counter()
    for outcome in outcomes:
        folder = outcome.name.split("/")[0]
        counts[folder] += 1
        sets.setdefault(folder, Outcome(folder)).add(outcome)
    names = ["collection", "files", "refused files", "objects", "delivered", *RUNGS, "dropped, by reason", "gates (bodies)", "time"]
    page += ["## Collections of defects and soups", "", "Every object is on a rung or dropped with its reason; a file that is no city model is refused with a message.", "",
             "| " + " | ".join(names) + " |", "| --- |" + " ---: |" * (len(names) - 1)]
    ok = True
    for folder, outcome in sets.items():
        rungs = outcome.rungs()
        reasons = collections.Counter(b["reason"] for b in outcome.dropped())
        cells = [folder, counts[folder], len(outcome.notes), len(outcome.buildings), sum(rungs.values()),
                 *(rungs[rung] or "" for rung in RUNGS),
                 ", ".join(f"{reason} {count}" for reason, count in reasons.most_common()) or "-",
                 "red" if outcome.faults else f"green ({outcome.bodies})", f"{outcome.seconds:.1f} s"]
        page.append("| " + " | ".join(map(str, cells)) + " |")
    page.append("")
    for outcome in sets.values():
        page += fault_lines(outcome)
        ok &= not outcome.faults
    return ok


def fault_lines(outcome):
    lines = [f"- fault: {fault}" for fault in outcome.faults[:20]]
    if len(outcome.faults) > 20:
        lines.append(f"- and {len(outcome.faults) - 20} more faults")
    return lines + [""] if lines else []


def write_page(path, lines):
    text = path.read_text(encoding="utf-8")
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    if not rest:
        raise SystemExit(f"{path}: has no line {BEGIN}")
    path.write_text(before + BEGIN + "\n" + "\n".join(lines).rstrip() + "\n" + END + after, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, help="citymesh")
    parser.add_argument("--checker", required=True, help="citymesh_mesh_checker")
    parser.add_argument("--make-defects", required=True, help="citymesh_make_defects")
    parser.add_argument("--process", default="export-for-simulation", help="process to run")
    parser.add_argument("--val3dity", help="also let this program validate the healed CityJSON")
    parser.add_argument("--data", type=Path, default=os.environ.get("CITYMESH_EXTRA_DATA"), help="folder of the real city models")
    parser.add_argument("--only", default="", help="files whose name contains this; `generated` for the generated houses")
    parser.add_argument("--skip-collections", action="store_true", help="leave out the collections of defects and soups")
    parser.add_argument("--plan", default="seed=1 sound=4 singles=4 pairs=3", help="options of citymesh_make_defects")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time; more than one spoils the times")
    parser.add_argument("--output", type=Path, help="page whose measured part is replaced")
    parser.add_argument("--offenders", type=Path, help="list buildings that miss a target here, as JSON")
    tools = parser.parse_args()

    page, offenders, ok = [], [], True
    if tools.only in ("", "generated"):
        ok &= generated_part(tools, [f"--{word}" for word in tools.plan.split()], page, offenders)
    if tools.data and Path(tools.data).is_dir():
        ok &= real_part(tools, Path(tools.data), tools.only, page, offenders)
        if not tools.skip_collections:
            ok &= defects_part(tools, Path(tools.data), tools.only, page)
    elif tools.only != "generated":
        print("CITYMESH_EXTRA_DATA names no folder; it holds the city models of the real part", file=sys.stderr)
        return 77
    print("\n".join(page))
    if tools.output:
        write_page(tools.output, page)
    if tools.offenders:
        tools.offenders.write_text(json.dumps(offenders, indent=1, ensure_ascii=False), encoding="utf-8")
    return 0 if ok else 1


if __name__ == "__main__":
    sys.exit(main())

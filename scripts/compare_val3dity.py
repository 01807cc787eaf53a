#!/usr/bin/env python3
"""What citymesh and val3dity find in the same CityJSON files, object by object and level by level.

    compare_val3dity.py --program build/citymesh --val3dity val3dity FILES…

Runs both at their defaults on every file (.json, .jsonl; also .gz) and prints a Markdown table: how many pairs of object and
level of detail both judged, on how many they agree, and each difference with its reason. Exits with 1 when a difference has
no known reason. val3dity is not part of citymesh: https://github.com/tudelft3d/val3dity.
"""
import argparse
import collections
import gzip
import json
import math
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

JUDGED = ("Building", "BuildingPart")
PLACE = re.compile(r"coid=(.+?)\|geom=(\d+)")
SNAP_TOLERANCE_M = 0.001
LEVEL = re.compile(r"lod=(\S+)")

# Codes that mean the same where the two name a defect differently.
SAME = [
    ({401}, {402}, "402 is what two equal shells are; val3dity reports 401"),
    ({201}, {202}, "202 is what two equal rings are; val3dity reports 201"),
    ({303}, {307}, "a turned face: val3dity adds faces one by one, and where no place is left it calls that 303"),
    ({303, 307}, {307}, "a turned face: val3dity adds faces one by one, and where no place is left it calls that 303"),
]


def unpacked(path, folder):
    if path.suffix != ".gz":
        return path
    target = Path(folder) / path.stem
    target.write_bytes(gzip.open(path).read())
    return target


def rings_of(boundaries):
    """All lists of numbers in lists of lists."""
    if boundaries and not isinstance(boundaries[0], list):
        yield boundaries
        return
    for part in boundaries:
        yield from rings_of(part)


def is_on_tolerance(document, geometry, scale):
    """Whether two points in a row of a ring are as far apart as the snap tolerance, but for rounding."""
    vertices = document["vertices"]
    for ring in rings_of(geometry.get("boundaries", [])):
        for a, b in zip(ring, ring[1:] + ring[:1]):
            distance = math.dist([x * s for x, s in zip(vertices[a], scale)], [x * s for x, s in zip(vertices[b], scale)])
            if abs(distance - SNAP_TOLERANCE_M) < 1e-6:
                return True
    return False


def objects_of(path):
    """id → (type, ids of parts, level of each geometry, levels with points that are as far apart as the snap tolerance)."""
    text = path.read_text(encoding="utf-8-sig")
    documents = [json.loads(line) for line in text.splitlines() if line.strip()] if path.suffix == ".jsonl" else [json.loads(text)]
    objects = {}
    scale = documents[0].get("transform", {}).get("scale", [1, 1, 1])  # of a sequence: that of its first line
    for document in documents:
        for key, value in document.get("CityObjects", {}).items():
            levels = [str(geometry.get("lod", "")) for geometry in value.get("geometry", [])]
            close = {level for level, geometry in zip(levels, value.get("geometry", [])) if is_on_tolerance(document, geometry, scale)}
            objects[key] = (value["type"], value.get("children", []), levels, close)
    return objects


def val3dity_codes(program, path, objects, folder):
    report = Path(folder) / "val3dity.json"
    start = time.monotonic()
    subprocess.run([program, str(path), "--report", str(report)], check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    seconds = time.monotonic() - start
    codes = collections.defaultdict(set)
    for feature in json.loads(report.read_text())["features"]:
        for error in feature.get("errors", []):
            if error["code"] == 601:
                codes[feature["id"], LEVEL.search(error["info"]).group(1)].add(601)
                continue
            place = PLACE.search(error["id"])
            if not place:
                sys.exit(f"{path}: val3dity's error names no geometry: {error}")
            key, geometry = place.group(1), int(place.group(2))
            codes[key, objects[key][2][geometry]].add(error["code"])
    return codes, seconds


def citymesh_codes(program, path, levels, folder):
    codes = collections.defaultdict(set)
    seconds = 0
    for level in levels:
        output = Path(folder) / f"citymesh_{level}"
        start = time.monotonic()
        done = subprocess.run(
            [program, "validate", str(path), "--set", f'lod={level}', "--set", "source_crs=EPSG:28992", "--threads", "1",
             "--overwrite", "--output", str(output)], check=False, capture_output=True, text=True)
        if done.returncode == 2:
            done = subprocess.run(
                [program, "validate", str(path), "--set", f'lod={level}', "--threads", "1", "--overwrite", "--output",
                 str(output)], check=False, capture_output=True, text=True)
        if done.returncode == 2:
            sys.exit(f"{path}: {done.stderr}")
        seconds += time.monotonic() - start
        for building in json.loads((output / "report.json").read_text())["buildings"]:
            for part in [building, *building["parts"]]:
                for issue in part["issues_before"]:
                    if not issue["code"].startswith("C"):
                        codes[part["gml_id"], level].add(int(issue["code"]))
    return codes, seconds


def reason_for(theirs, ours, on_tolerance):
    if on_tolerance and theirs ^ ours <= {101, 102, 104}:
        return "points exactly the snap tolerance apart: val3dity's doubles fall to either side of it, our integers do not merge them"
    if theirs ^ ours == {204}:
        return "slivers of millimetres: the triangulation of nearly collinear corners is not unique, nor what its triangles are compared with"
    for a, b, reason in SAME:
        if a <= theirs and b <= ours and theirs - a == ours - b:
            return reason
    return ""


def compare(arguments, path, folder):
    path = unpacked(path, folder)
    objects = objects_of(path)
    places = {(key, level) for key, (kind, _, levels, _) in objects.items() if kind in JUDGED for level in levels if level}
    theirs, their_seconds = val3dity_codes(arguments.val3dity, path, objects, folder)
    ours, our_seconds = citymesh_codes(arguments.program, path, sorted({level for _, level in places}), folder)
    differences = []
    parents = {part: key for key, (_, parts, _, _) in objects.items() for part in parts}
    for key, level in sorted(places | {place for place in theirs if objects[place[0]][0] in JUDGED}):
        a, b = theirs.get((key, level), set()), ours.get((key, level), set())
        if key in parents:  # overlaps stand with the building
            a, b = a - {601}, b - {601}
        if a != b:
            differences.append((key, level, a, b, reason_for(a, b, level in objects[key][3])))
    found = sum(1 for place in places if theirs.get(place))
    return len(places), found, differences, their_seconds, our_seconds


def text_of(codes):
    return " ".join(map(str, sorted(codes))) or "none"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True)
    parser.add_argument("--val3dity", required=True)
    parser.add_argument("files", nargs="+", type=Path)
    arguments = parser.parse_args()
    unexplained = 0
    details = []
    print("| file | geometries | with defects | agree | differ | val3dity s | citymesh s |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for path in sorted(arguments.files, key=lambda file: file.stat().st_size):
        with tempfile.TemporaryDirectory() as folder:
            count, found, differences, their_seconds, our_seconds = compare(arguments, path, folder)
        print(f"| {path.name} | {count} | {found} | {count - len(differences)} | {len(differences)} | {their_seconds:.2f} | "
              f"{our_seconds:.2f} |", flush=True)
        unexplained += sum(1 for difference in differences if not difference[4])
        details += [(path.name, *difference) for difference in differences]
    for name, key, level, theirs, ours, reason in details:
        print(f"- {name} {key} LoD {level}: val3dity {text_of(theirs)}, citymesh {text_of(ours)}: {reason or 'NO REASON KNOWN'}")
    return 1 if unexplained else 0


if __name__ == "__main__":
    sys.exit(main())

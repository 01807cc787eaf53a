#!/usr/bin/env python3
"""Draws what the options of healing do: heals tiny models with two values of an option each and joins the before/after
pictures of their reports.

    option_pictures.py CITYMESH [docs/images]
"""
import html
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

FIGURE = re.compile(r'<svg class="ba".*?</title>(.*?)</svg>', re.DOTALL)
RULES = re.compile(r'<section class="gallery">.*?<style>(.*?)</style>', re.DOTALL)
ROW_HEIGHT, TEXT_HEIGHT, WIDTH = 220, 34, 600


def box(width=4.0, depth=3.0, height=2.5, x=0.0):
    """The faces of a box as lists of corners, by name."""
    a, b, c, d = (x, 0, 0), (x + width, 0, 0), (x + width, depth, 0), (x, depth, 0)
    e, f, g, h = (x, 0, height), (x + width, 0, height), (x + width, depth, height), (x, depth, height)
    return {"ground": [a, d, c, b], "south": [a, b, f, e], "east": [b, c, g, f], "north": [c, d, h, g], "west": [d, a, e, h],
            "roof": [e, f, g, h]}


TYPES = {"ground": "GroundSurface", "roof": "RoofSurface"}


def building(faces, parent=None):
    """A CityJSON building and its own vertices."""
    vertices = sorted({corner for ring in faces.values() for corner in ring})
    geometry = {"type": "MultiSurface", "lod": "2",
                "boundaries": [[[vertices.index(corner) for corner in ring]] for ring in faces.values()],
                "semantics": {"surfaces": [{"type": TYPES.get(name, "WallSurface"), "id": name} for name in faces],
                              "values": list(range(len(faces)))}}
    return {"type": "BuildingPart" if parent else "Building", **({"parents": [parent]} if parent else {}),
            "geometry": [geometry]}, vertices


def city(*parts):
    """CityJSON of one building, of several parts where there are several."""
    objects, vertices = {}, []
    for number, faces in enumerate(parts):
        made, own = building(faces, "house" if len(parts) > 1 else None)
        for ring in (ring for face in made["geometry"][0]["boundaries"] for ring in face):
            ring[:] = [index + len(vertices) for index in ring]
        vertices += own
        objects[f"part_{number + 1}" if len(parts) > 1 else "house"] = made
    if len(parts) > 1:
        objects["house"] = {"type": "Building", "children": list(objects)}
    return {"type": "CityJSON", "version": "2.0", "transform": {"scale": [0.001] * 3, "translate": [391000, 5820000, 30]},
            "metadata": {"referenceSystem": "https://www.opengis.net/def/crs/EPSG/0/25833"}, "CityObjects": objects,
            "vertices": [[round(1000 * value) for value in corner] for corner in vertices]}


def shifted_corner(by=0.25):
    """A box whose roof misses one corner of the walls."""
    faces = box()
    faces["roof"] = [(x - by, y + by, z) if (x, y) == (4.0, 0) else (x, y, z) for x, y, z in faces["roof"]]
    return faces


def warped_rim(by=0.6):
    """A box without roof, one corner of whose walls is lower than the others."""
    faces = box()
    del faces["roof"]
    lower = {(4.0, 0, 2.5): (4.0, 0, 2.5 - by)}
    return {name: [lower.get(corner, corner) for corner in ring] for name, ring in faces.items()}


def without(*names):
    return {name: ring for name, ring in box().items() if name not in names}


def footprint():
    """Nothing but a footprint and a height."""
    model = city({"ground": box()["ground"]})
    house = model["CityObjects"]["house"]
    house["attributes"] = {"measuredHeight": 2.5}
    house["geometry"][0]["lod"] = "0"
    return model


WIDE = ("max_displacement_m=1", "snap_tolerance_m=0.4")
PICTURES = {
    "snap_tolerance_m": (city(shifted_corner()), [("snap_tolerance_m=0.001",), WIDE]),
    "planarity_tolerance_m": (city(warped_rim()), [("planarity_tolerance_m=0.01",), ("planarity_tolerance_m=0.5",)]),
    "max_displacement_m": (city(shifted_corner()), [("snap_tolerance_m=0.4", "max_displacement_m=0.1"),
                                                    ("snap_tolerance_m=0.4", "max_displacement_m=1")]),
    "max_hole_area_m2": (city(without("east")), [("max_hole_area_m2=1",), ("max_hole_area_m2=10000",)]),
    "on_failure": (footprint(), [("on_failure=block",), ("on_failure=drop",)]),
    "parts": (city(without("west"), box(1.6, 1.6, 4.2, 2.9)), [("parts=keep",), ("parts=merge",)]),
}


def healed(program, model, settings, folder):
    """Style rules, picture and outcome of one run."""
    source, output = folder / "house.city.json", folder / "-".join(settings)
    source.write_text(json.dumps(model))
    options = [word for setting in settings for word in ("--set", setting)]
    run = subprocess.run([program, "heal", source, "--output", output, *options], capture_output=True, text=True)
    if run.returncode == 2:
        raise RuntimeError(run.stderr)
    page = (output / "report.html").read_text(encoding="utf-8")
    report = json.loads((output / "report.json").read_text(encoding="utf-8"))["buildings"][0]
    figure = FIGURE.search(page)
    return RULES.search(page).group(1) if figure else "", figure.group(1) if figure else "", report


def drawn(program, model, variants):
    """One SVG with a row for each variant."""
    rules, rows = [], []
    for number, settings in enumerate(variants):
        with tempfile.TemporaryDirectory() as folder:
            style, figure, report = healed(program, model, settings, Path(folder))
        rules += [rule for rule in style.replace("}", "}\n").splitlines() if rule not in rules]
        outcome = report["rung"] or f'{report["outcome"]}: {report["reason"]}'
        top = number * (ROW_HEIGHT + TEXT_HEIGHT)
        rows.append(f'<text x="14" y="{top + 23}"><tspan class="o">{html.escape(", ".join(settings))}</tspan> → '
                    f'{html.escape(outcome)}</text>\n<g transform="translate(0 {top + TEXT_HEIGHT})">{figure}</g>')
    height = len(variants) * (ROW_HEIGHT + TEXT_HEIGHT)
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}">\n<style>'
            + "".join(rules) + '.ba circle{fill:#d3312b;fill-opacity:.85;stroke:#fff;stroke-width:1.2}.ba .cut{stroke:#c3cad4}'
            'text{font:14px system-ui,"Segoe UI",Roboto,"DejaVu Sans",sans-serif;fill:#2f3b52}.o{font-weight:600}</style>\n'
            f'<rect width="{WIDTH}" height="{height}" fill="#eef1f5"/>\n<g class="ba">\n' + "\n".join(rows) + "\n</g>\n</svg>\n")


def main():
    program = Path(sys.argv[1]).resolve()
    images = Path(sys.argv[2] if len(sys.argv) > 2 else Path(__file__).resolve().parents[1] / "docs" / "images")
    for option, (model, variants) in PICTURES.items():
        try:
            (images / f"option-{option}.svg").write_text(drawn(program, model, variants), encoding="utf-8")
            print(images / f"option-{option}.svg")
        except RuntimeError as refusal:
            print(f"no picture of {option}: {refusal}", file=sys.stderr)


if __name__ == "__main__":
    main()

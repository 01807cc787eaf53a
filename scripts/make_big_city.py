#!/usr/bin/env python3
"""Tiles a CityGML file with projected coordinates until it has the wanted size, for benchmarks.

    make_big_city.py SOURCE.gml[.gz] MEGABYTES OUTPUT.gml

Every copy gets its own ids (and the links to them) and its own place on a square grid, so that no two buildings overlap. The
output is written tile by tile; the same arguments give the same bytes.
"""
import gzip
import math
import re
import sys

MEMBER = re.compile(r"<(\w+:)?cityObjectMember\b")
MEMBERS_END = re.compile(r"</(\w+:)?cityObjectMember\s*>(?!.*</(\w+:)?cityObjectMember\s*>)", re.DOTALL)
# What changes from copy to copy: ids, links to them, coordinates.
PLACES = re.compile(r'((?:gml:id|xlink:href)=")([^"]+)(")'
                    r"|(<app:target[^>]*>)(#[^<]+)(<)"
                    r"|(<gml:(?:posList|pos|lowerCorner|upperCorner)\b[^>]*>)([^<]+)(<)")
GAP_M = 50.0


def read(path):
    opener = gzip.open if path.endswith(".gz") else open
    with opener(path, "rt", encoding="utf-8") as file:
        return file.read()


def decimals(word):
    return len(word.partition(".")[2])


class Template:
    """Text with places: a place is a function of the copy's suffix and shift."""

    def __init__(self, text):
        self.parts = []
        self.low, self.high = [math.inf] * 2, [-math.inf] * 2
        end = 0
        for match in PLACES.finditer(text):
            self.parts.append(text[end:match.start()])
            end = match.end()
            before, value, after = match.group(1, 2, 3) if match.group(1) else match.group(4, 5, 6) if match.group(4) else match.group(7, 8, 9)
            self.parts.append(before)
            if match.group(7):
                words = value.split()
                if len(words) % 3:
                    raise SystemExit(f"coordinates are not in threes: {value[:60]!r}")
                numbers = [(float(word), decimals(word)) for word in words]
                for axis in (0, 1):
                    values = [number for number, _ in numbers[axis::3]]
                    self.low[axis] = min(self.low[axis], *values)
                    self.high[axis] = max(self.high[axis], *values)
                self.parts.append(numbers)
            elif before.startswith("xlink") and not value.startswith("#"):
                self.parts.append(value)
            else:
                self.parts.append((value,))
            self.parts.append(after)
        self.parts.append(text[end:])

    def copy(self, suffix, dx, dy):
        shift = (dx, dy, 0.0)
        for part in self.parts:
            if isinstance(part, str):
                yield part
            elif isinstance(part, tuple):
                yield part[0] + suffix
            else:
                yield " ".join("%.*f" % (places, number + shift[i % 3]) for i, (number, places) in enumerate(part))


def main():
    if len(sys.argv) != 4:
        raise SystemExit(__doc__)
    text = read(sys.argv[1])
    wanted = int(float(sys.argv[2]) * 1e6)
    first = MEMBER.search(text)
    last = MEMBERS_END.search(text)
    if not first or not last:
        raise SystemExit(f"{sys.argv[1]}: has no cityObjectMember")
    head, body, tail = text[:first.start()], text[first.start():last.end()], text[last.end():]
    template = Template(body)
    width, depth = (template.high[axis] - template.low[axis] + GAP_M for axis in (0, 1))
    copies = max(1, math.ceil((wanted - len(head) - len(tail)) / len(body.encode())))
    columns = math.ceil(math.sqrt(copies * depth / width))
    rows = math.ceil(copies / columns)

    # The declared extent covers all copies.
    def corner(match):
        words = match.group(2).split()
        upper = "upperCorner" in match.group(1)
        x, y = (template.high[0] + (columns - 1) * width, template.high[1] + (rows - 1) * depth) if upper else template.low
        return match.group(1) + " ".join([f"{x:.3f}", f"{y:.3f}", *words[2:]]) + match.group(3)

    head = re.sub(r"(<gml:(?:lowerCorner|upperCorner)\b[^>]*>)([^<]+)(<)", corner, head)
    with open(sys.argv[3], "w", encoding="utf-8") as output:
        output.write(head)
        for i in range(copies):
            output.writelines(template.copy(f"_t{i}", (i % columns) * width, (i // columns) * depth))
            output.write("\n")
        output.write(tail)
    print(f"{sys.argv[3]}: {copies} copies in {columns} columns")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""The architecture as rules: who may include whom, what stays out of headers, what every folder has.

    rules.py ROOT     prints one line per violation and exits with 1 if there is any

The tables of rooms in core/README.md and services/README.md are the rules; this file only reads them.
"""
import re
import sys
from pathlib import Path

SOURCES = {".h", ".cpp"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
STANDARD_HEADER = re.compile(r"^[a-z_0-9]+$")
# Rooms of words that others speak; every later room has a door, a header named like it.
ROOMS_WITHOUT_DOOR = {"base", "geometry", "citymodel"}
# The core knows no console, socket, database, log or service.
NOT_IN_CORE = ("iostream", "sys/socket.h", "netinet/", "sqlite3.h", "spdlog/", "prometheus/", "grpc", "google/protobuf/",
               "boost/asio", "boost/beast", "citymesh/v1/")
MACHINE_PATH = re.compile(r"(?<![\w.])/(?:work|home|root|Users)/[\w.-]")
OPEN_TASK = re.compile(r"\b(?:TODO|FIXME|XXX)\b(?!\(\w+\))")


class Tree:
    """The text files of a working copy."""

    FOLDERS = ("core", "services", "proto", "tests", "cmake", "scripts", "clients", "docs", "deploy", ".ci")
    TEXT = SOURCES | {".txt", ".cmake", ".md", ".py", ".sh", ".proto", ".json", ".yml", ".html", ".js", ".css", ""}

    def __init__(self, root):
        self.root = Path(root)
        self.texts = {}
        for folder in self.FOLDERS:
            for path in sorted((self.root / folder).rglob("*")):
                name = path.relative_to(self.root).as_posix()
                if name.startswith("tests/data/") or "__pycache__" in name or "/node_modules/" in name:
                    continue
                if path.is_file() and path.suffix in self.TEXT:
                    self.texts[name] = path.read_text(encoding="utf-8", errors="replace")
        for path in self.root.glob("*"):
            if path.is_file() and path.name in ("CMakeLists.txt", "CMakePresets.json", "Makefile", "README.md", "CONTRIBUTING.md"):
                self.texts[path.name] = path.read_text(encoding="utf-8", errors="replace")

    def sources(self, folder):
        for name, text in self.texts.items():
            if name.startswith(folder + "/") and Path(name).suffix in SOURCES:
                yield name, text

    def includes(self, folder):
        """(file, is quoted, header) of every include line under a folder."""
        for name, text in self.sources(folder):
            for quote, header in INCLUDE.findall(text):
                yield name, quote == '"', header

    def rooms(self, house):
        """Folders of a house that have sources."""
        return sorted({name.split("/")[1] for name, _ in self.sources(house) if name.count("/") > 1})


def allowed_rooms(tree, house):
    """room → rooms it may use, from the table `| room | does | may use |` of the house's README."""
    readme = tree.texts.get(f"{house}/README.md", "")
    allowed, above = {}, []
    for line in readme.splitlines():
        cells = [cell.strip().strip("`") for cell in line.strip().strip("|").split("|")]
        if len(cells) != 3 or cells[0] in ("room", "") or set(cells[0]) <= {"-", " "}:
            continue
        room, _, uses = cells
        if uses == "all of the above":
            allowed[room] = set(above)
        else:
            allowed[room] = {use.strip(" `") for use in uses.split(",")} - {"-", "–", ""}
        above.append(room)
    return allowed


def room_of(header, house):
    parts = header.split("/")
    return parts[1] if parts[0] == house and len(parts) > 2 else None


def rooms_use_only_what_the_table_allows(tree):
    for house in ("core", "services"):
        allowed = allowed_rooms(tree, house)
        for room in tree.rooms(house):
            if room not in allowed:
                yield f"{house}/{room}: is missing from the table of {house}/README.md"
                continue
            for name, _, header in tree.includes(f"{house}/{room}"):
                used = room_of(header, house)
                if used and used != room and used not in allowed[room]:
                    yield f"{name}: includes {header}; {room} may use {', '.join(sorted(allowed[room])) or 'nothing'}"


def the_core_knows_nothing_outside(tree):
    for name, _, header in tree.includes("core"):
        if header.startswith(("services/", "proto/", "tests/")) or header.startswith(NOT_IN_CORE):
            yield f"{name}: includes {header}, which has no place in the core"


def wire_formats_never_meet(tree):
    for one, other in (("rest", "rpc"), ("rpc", "rest")):
        for name, _, header in tree.includes(f"services/{one}"):
            if header.startswith(f"services/{other}/"):
                yield f"{name}: includes {header}; rest and rpc meet only in jobs"
    for name, _, header in tree.includes("services"):
        if header.startswith("citymesh/v1/") and not name.startswith("services/rpc/"):
            yield f"{name}: includes {header}; messages stop at services/rpc"


def third_party_headers_stay_in_sources(tree):
    for house in ("core", "services"):
        for name, quoted, header in tree.includes(house):
            if name.endswith(".h") and not quoted and not STANDARD_HEADER.match(header):
                yield f"{name}: includes <{header}>; third-party headers stay in .cpp files"


def own_headers_are_included_from_the_root(tree):
    for house in ("core", "services", "tests"):
        for name, quoted, header in tree.includes(house):
            generated = header.startswith("citymesh/v1/")
            if quoted and not generated and header not in tree.texts:
                yield f'{name}: includes "{header}", which is no file of this project seen from its root'


def headers_are_read_once(tree):
    for house in ("core", "services", "tests"):
        for name, text in tree.sources(house):
            if name.endswith(".h") and "#pragma once" not in text:
                yield f"{name}: has no #pragma once"


NAMESPACE = re.compile(r"^namespace(?: ([\w:]+))? {$")
TYPE = re.compile(r"^(?:struct|class|enum class) (\w+)(?: final)?(?: : [^;]*)? {")


def types_at_namespace_level(text):
    """Names with their namespaces; what is in a namespace without a name cannot clash."""
    within = []
    for line in text.splitlines():
        if opened := NAMESPACE.match(line):
            within.append(opened[1] or "")
        elif line.startswith("}  // namespace"):
            del within[-1:]
        elif (found := TYPE.match(line)) and "" not in within:
            yield "::".join([*within, found[1]])


def no_two_types_share_a_name(tree):
    """Two definitions of one name are no error to a compiler and a linker, but to the running program."""
    defined = {}
    for house in ("core", "services"):
        for name, text in tree.sources(house):
            for type_name in types_at_namespace_level(text):
                defined.setdefault(type_name, []).append(name)
    for type_name, names in defined.items():
        if len(names) > 1:
            yield f"{type_name} is defined in {' and in '.join(names)}"


def every_stage_has_its_door(tree):
    for room in allowed_rooms(tree, "core"):
        if room not in ROOMS_WITHOUT_DOOR and f"core/{room}/{room}.h" not in tree.texts:
            yield f"core/{room}: has no door, the header core/{room}/{room}.h"


LIBRARY = re.compile(r"citymesh_library\(\s*(\w+)([^)]*)\)")
KEYWORDS = ("SOURCES", "USES", "PRIVATE_USES", "KIND", "TIMEOUT", "CORPUS", "WHOLE")


def arguments_of(text):
    """`SOURCES a b USES c` → {"SOURCES": ["a", "b"], "USES": ["c"]}; comments are dropped."""
    found, key = {}, None
    for word in re.sub(r"#.*", "", text).split():
        if word in KEYWORDS:
            key = word
            found[key] = []
        elif key:
            found[key].append(word)
    return found


def link_lists_match_the_includes(tree):
    libraries = {}  # name → (folder, own rooms linked)
    for name, text in tree.texts.items():
        if name.startswith(("core/", "services/")) and name.endswith("CMakeLists.txt"):
            for library, rest in LIBRARY.findall(text):
                arguments = arguments_of(rest)
                links = set(arguments.get("USES", []))
                links |= {use[len("citymesh_"):] for use in arguments.get("PRIVATE_USES", []) if use.startswith("citymesh_")}
                libraries[library] = (name.rsplit("/", 1)[0], links)

    def reachable(library, seen):
        for link in libraries.get(library, ("", set()))[1]:
            if link not in seen:
                seen.add(link)
                reachable(link, seen)
        return seen

    folder_of = {folder: library for library, (folder, _) in libraries.items()}
    for library, (folder, links) in libraries.items():
        house, _, room = folder.partition("/")
        allowed = allowed_rooms(tree, house).get(room)
        if allowed is None:
            continue
        for link in links:
            target = libraries.get(link, (None,))[0]
            if target and target.startswith(house + "/") and target.split("/")[1] not in allowed:
                yield f"{folder}/CMakeLists.txt: links {link}, which {room} may not use"
        linked = reachable(library, {library})
        for name, _, header in tree.includes(folder):
            for other in ("core", "services"):
                used = room_of(header, other)
                target = folder_of.get(f"{other}/{used}") if used else None
                if target and target not in linked:
                    yield f"{folder}/CMakeLists.txt: does not link {target}, but {name} includes {header}"


def tests_carry_the_kind_of_their_folder(tree):
    for name, text in tree.texts.items():
        parts = name.split("/")
        if parts[0] != "tests" or parts[-1] != "CMakeLists.txt" or len(parts) < 4:
            continue
        for test in re.findall(r"citymesh_test\(([^)]*)\)", text):
            kind = arguments_of(test).get("KIND", ["none"])[0]
            if kind != parts[1] and not kind.startswith("${"):
                yield f"{name}: a test has the kind {kind}; its folder says {parts[1]}"
        for properties in re.findall(r"add_test\(\s*NAME\s+(\S+)", text):
            if "LABELS" not in text:
                yield f"{name}: the test {properties} has no label"


def nothing_depends_on_a_machine(tree):
    for name, text in tree.texts.items():
        if name.startswith("tests/architecture/"):
            continue  # the rules themselves
        for number, line in enumerate(text.splitlines(), 1):
            if MACHINE_PATH.search(line):
                yield f"{name}:{number}: names a path of one machine: {line.strip()[:80]}"


def open_tasks_have_an_owner(tree):
    for name, text in tree.texts.items():
        if name.startswith("tests/architecture/"):
            continue
        for number, line in enumerate(text.splitlines(), 1):
            if OPEN_TASK.search(line):
                yield f"{name}:{number}: open task without an owner: {line.strip()[:80]}"


RULES = (
    rooms_use_only_what_the_table_allows,
    the_core_knows_nothing_outside,
    wire_formats_never_meet,
    third_party_headers_stay_in_sources,
    own_headers_are_included_from_the_root,
    headers_are_read_once,
    no_two_types_share_a_name,
    every_stage_has_its_door,
    link_lists_match_the_includes,
    tests_carry_the_kind_of_their_folder,
    nothing_depends_on_a_machine,
    open_tasks_have_an_owner,
)


def violations(root):
    tree = Tree(root)
    return [f"{violation}  [{rule.__name__}]" for rule in RULES for violation in sorted(set(rule(tree)))]


if __name__ == "__main__":
    found = violations(sys.argv[1])
    print("\n".join(found) or f"{len(RULES)} rules hold")
    sys.exit(1 if found else 0)

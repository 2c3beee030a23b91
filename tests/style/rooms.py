#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Does every line stand where docs/contributing.md says? `rooms.py SOURCE_ROOT`."""
import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1])

# In src, what stands on what, from below; a file includes only files of lower rows, or of its own noun.
LAYERS = [
    {"vec2", "status", "random", "aligned", "grow", "threads", "units"},
    {"trail", "audience", "publish"},
    {"record"},
    {"boundary", "coupling", "lattice", "sides", "springs", "triangles", "box_tree", "path", "arkode", "method",
     "bulk", "pool", "hdf5_file"},
    {"motion", "vector", "lattice_mesh", "solid", "surface", "obstacle", "overlap", "impact", "stress", "order",
     "grid", "table", "foreign", "notes"},
    {"layout"},
    {"sweep", "lanes_portable", "lanes_avx2", "lanes_avx512"},
    {"model", "sweep_body", "peaks", "events", "frames", "history", "probe", "lattice_file", "obstacle_file"},
    {"forces"},
    {"touch", "options", "diagnostics", "film", "integrator", "verlet", "tangent", "kernel", "sweep_portable",
     "sweep_avx2", "sweep_avx512", "peaks_file"},
    {"reaction", "books", "engine", "spectrum", "constants", "reel"},
    {"site", "segments"},
    {"sites", "search"},
    {"strike", "watch", "ball"},
    {"patch"},
    {"contact", "trajectory"},
    {"queue"},
    {"run"},
    {"view", "recall"},
    {"simulation", "replace"},
]
# Folders of the drivers: what each may include from besides itself, where nothing goes in circles.
FOLDERS = {"common": set(), "namelist": {"common"}, "body": {"common", "namelist"}, "deck": {"common", "namelist", "body"},
           "batch": {"common", "namelist", "body", "deck"}, "plot": {"common"}, "export": {"common", "namelist"}}
# Within a layer: who may include whom all the same.
BESIDE = {("lattice", "sides"), ("lattice_mesh", "lattice")}
ROOMS = [  # pattern, files that may have it
    (r'#include [<"](arkode|nvector|sundials)/', {"src/arkode.h", "src/integrator.c", "src/method.c", "src/vector.c",
                                                 "src/vector.h"}),
    (r"#include <immintrin", {"src/lanes_avx2.h", "src/lanes_avx512.h"}),
    (r"_Pragma|#pragma|_OPENMP", {"src/threads.h"}),
    (r'#include [<"]hdf5\.h', {"src/hdf5_file.c", "src/hdf5_file.h"}),
    (r'#include [<"]gsl/', {"drivers/body/area.c", "drivers/body/pores.c", "drivers/deck/profile.c",
                          "drivers/batch/report.c", "drivers/batch/preview.c"}),
    (r"#include [<\"]zlib", {"src/record.c"}),
    (r"#include [<\"]cairo", {"drivers/body/png.c", "drivers/plot/paint.c"}),
    (r"\b(f?printf|puts|fputs|putchar|perror|exit|abort|signal|sigaction|getenv)\s*\(", "drivers"),
    (r"[+*]\s*[\w.\[\]]*(->)?restitution\b|\brestitution\s*[-+*]", {"src/impact.c"}),
    (r"/\s*\(?[\w.>\[\]-]*\brest(_length)?\b(?!\w)", {"src/springs.c", "src/springs.h"}),
    (r"\b(TODO|FIXME|XXX|HACK)\b", set()),
]
MAX_FILE, MAX_FUNCTION, MAX_PARAMETERS, MAX_LINE = 600, 60, 6, 120

faults = []
beside = {}  # of a noun of the drivers: the nouns of its folder that it includes


def complain(path, line, text):
    faults.append(f"{path.relative_to(ROOT)}:{line}: {text}")


def without_comments(text):
    """The code with comments and strings blanked, line for line."""
    blank = lambda m: re.sub(r"[^\n]", " ", m.group(0))
    text = re.sub(r"/\*.*?\*/", blank, text, flags=re.S)
    return re.sub(r'(?m)^(?!\s*#include)(.*)$', lambda m: re.sub(r'"(\\.|[^"\\])*"', blank, m.group(0)), text)


def layer_of(noun):
    return next((k for k, layer in enumerate(LAYERS) if noun in layer), None)


def check_folders(path, lines):
    for number, line in enumerate(lines, 1):
        found = re.match(r'#include "(\w+)\.h"', line)
        home = found and next((d for d in FOLDERS if (ROOT / "drivers" / d / f"{found.group(1)}.h").exists()), None)
        if home == path.parent.name:
            beside.setdefault(f"{home}/{path.stem}", set()).add(f"{home}/{found.group(1)}")
        elif home and home not in FOLDERS[path.parent.name]:
            complain(path, number, f"drivers/{path.parent.name} stands on drivers/{home}")


def check_circles():
    """Takes away, as long as there is one, a noun that includes no other that is left."""
    left = {noun: others - {noun} for noun, others in beside.items()}
    while free := [noun for noun, others in left.items() if not others & left.keys()]:
        for noun in free:
            del left[noun]
    faults.extend(f"drivers/{noun}.c: includes go in a circle" for noun in sorted(left))


def check_includes(path, lines):
    own = layer_of(path.stem)
    if own is None:
        complain(path, 1, f"'{path.stem}' has no layer")
        return
    for number, line in enumerate(lines, 1):
        found = re.match(r'#include "([\w/]+)\.h"', line)
        if found is None or found.group(1) == path.stem:
            continue
        other = layer_of(found.group(1))
        if other is None or (other >= own and (path.stem, found.group(1)) not in BESIDE):
            complain(path, number, f"includes {found.group(1)}.h, which does not stand below it")


def check_rooms(path, lines):
    name = str(path.relative_to(ROOT))
    for pattern, rooms in ROOMS:
        if name in rooms or (rooms == "drivers" and name.startswith("drivers/")):
            continue
        for number, line in enumerate(lines, 1):
            if re.search(pattern, line):
                complain(path, number, f"'{line.strip()}' has its place elsewhere")


def check_functions(path, lines):
    start, head = None, ""
    for number, line in enumerate(lines, 1):
        if re.match(r"^[A-Za-z_].*\(", line) and not line.rstrip().endswith(";"):
            start, head = number, line
        elif start is not None and number == start + 1 and not line.startswith("{"):
            head += line
            if line.rstrip().endswith(";"):
                start = None
        if line.startswith("}") and start is not None:
            if number - start >= MAX_FUNCTION:
                complain(path, start, f"function of {number - start + 1} lines")
            dictated = path.stem == "arkode"  # by SUNDIALS
            if path.relative_to(ROOT).parts[0] != "tests" and not dictated and head.count(",") >= MAX_PARAMETERS and "..." not in head and "(*" not in head:
                complain(path, start, f"function of {head.count(',') + 1} parameters")
            start = None


sources = sorted(p for d in ("src", "drivers", "include/dem", "tests") for p in (ROOT / d).rglob("*.[ch]"))
for source in sources:
    text = source.read_text(encoding="utf-8")
    if not text.startswith("/* SPDX-License-Identifier: BSD-3-Clause */\n"):
        complain(source, 1, "does not begin with its licence")
    for number, row in enumerate(text.splitlines(), 1):
        if len(row) > MAX_LINE:
            complain(source, number, f"line of {len(row)} characters")
    rows = without_comments(text).splitlines()
    length = sum(1 for row in rows if row.strip())
    if length > MAX_FILE and source.relative_to(ROOT).parts[0] != "tests":
        complain(source, 1, f"{length} lines of code")
    check_functions(source, rows)
    top = source.relative_to(ROOT).parts[0]
    if top == "src":
        check_includes(source, rows)
    if top == "drivers":
        check_folders(source, rows)
    if top in ("src", "drivers"):
        check_rooms(source, rows)
check_circles()

print("\n".join(faults) if faults else f"{len(sources)} files stand where they should")
sys.exit(1 if faults else 0)

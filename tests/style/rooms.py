#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Does every line stand where docs/architecture.md says? `rooms.py SOURCE_ROOT`."""
import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1])

ROOMS = [  # pattern, files that may have it
    (r'#include [<"](arkode|nvector|sundials)/', {"src/time/arkode_compat.h", "src/time/arkode_integrator.c", "src/time/butcher.c", "src/time/nvector.c",
                                                 "src/time/nvector.h"}),
    (r"#include <immintrin", {"src/elastic/lanes_avx2.h", "src/elastic/lanes_avx512.h", "src/surface_contact/contact_batch.c",
                             "src/surface_contact/way_box.c"}),
    (r"_Pragma|#pragma", {"src/base/inline.h"}),
    (r"\bpthread_create\b|#include <semaphore", {"src/base/team.c"}),
    (r"#include <stdatomic", {"src/base/team.c", "src/base/stored_file.c"}),
    (r'#include [<"]mpi\.h', {"src/mpi/mpi_ranks.h"}),
    (r'#include [<"]hdf5\.h', {"src/output/hdf5_api.h"}),
    (r'#include [<"]gsl/', {"drivers/body/copies.c", "drivers/body/gsl_errors.c", "drivers/deck/profile.c",
                          "drivers/batch/preview.c"}),
    (r"#include [<\"]zlib", {"src/base/checkpoint_format.c", "src/base/section.c",
                          "src/output/hdf5_chunks.c"}),
    (r"#include [<\"]cairo", {"drivers/body/png.c", "drivers/plot/paint.c"}),
    (r"\b(f?printf|puts|fputs|putchar|perror|exit|abort|signal|sigaction|getenv)\s*\(", "drivers"),
    (r"\bdem_model_lattice\(", {"src/model/model.c", "src/output/fragment_table.c", "src/output/frames.c", "src/output/probe.c",
                               "src/output/trajectory_rows.c", "drivers/body/body.c", "drivers/body/clearance.c",
                               "drivers/deck/whole_nodes.c"}),
    (r"[+*]\s*[\w.\[\]]*(->)?restitution\b|\brestitution\s*[-+*]", {"src/contact/impact_law.c"}),
    (r"/\s*\(?[\w.>\[\]-]*\brest(_length)?\b(?!\w)", {"src/elastic/springs.c", "src/elastic/springs.h"}),
    (r"\b(TODO|FIXME|XXX|HACK)\b", set()),
]
# Rooms that know no number of dimensions, so no vectors of two components; and their files that still do. Of forces the
# tables of functions are free, and what they are filled with is not.
DIMENSION_FREE = {"base", "time", "forces", "events", "simulation", "output"}
TWO_DIMENSIONAL = {"src/base/box.h", "src/base/vec2.h", "src/forces/band.c", "src/forces/boundary_conditions.c", "src/forces/boundary_conditions.h", "src/forces/diagnostics.c",
                   "src/forces/forces.c", "src/forces/forces.h", "src/forces/kernel.c", "src/forces/local_elements.c", "src/forces/local_elements.h", "src/forces/local_springs.c", "src/forces/rigid_motion.c", "src/forces/survey.c", "src/simulation/options.c",
                   "src/output/event_table.c", "src/output/probe.c"}
# What of the library the programs compile for themselves.
SHARED = {"base/file", "base/grow", "base/numbered_file", "base/peak_source", "base/slab_recipe", "base/text_reader",
          "base/union_find", "lattice/lattice_source", "output/slab_file", "shape/shape_slab"}
MAX_FILE, MAX_FUNCTION, MAX_PARAMETERS, MAX_LINE = 600, 60, 6, 120



def read_edges(heading):
    """What each folder may include from besides itself: a table of docs/architecture.md."""
    text = (ROOT / "docs/architecture.md").read_text(encoding="utf-8").split(f"## {heading}\n")[1].split("\n## ")[0]
    rows = re.findall(r"^\| `(\w+)` \|[^|]*\|([^|]*)\|$", text, re.M)
    return {folder: set(re.findall(r"`(\w+)`", others)) for folder, others in rows}


SRC, DRIVERS = read_edges("Rooms of the library"), read_edges("Folders of the programs")
faults = []
beside = {}  # of a noun: the nouns of its folder that it includes


def complain(path, line, text):
    faults.append(f"{path.relative_to(ROOT)}:{line}: {text}")


def without_comments(text):
    """The code with comments and strings blanked, line for line."""
    blank = lambda m: re.sub(r"[^\n]", " ", m.group(0))
    text = re.sub(r"/\*.*?\*/", blank, text, flags=re.S)
    return re.sub(r'(?m)^(?!\s*#include)(.*)$', lambda m: re.sub(r'"(\\.|[^"\\])*"', blank, m.group(0)), text)


def check_edges(path, lines):
    """Includes go to the same folder or along an allowed edge. In src an include names its folder."""
    top, room = path.relative_to(ROOT).parts[:2]
    edges = SRC if top == "src" else DRIVERS
    if room not in edges:
        complain(path, 1, f"'{room}' is no folder of {top}")
        return
    for number, line in enumerate(lines, 1):
        found = re.match(r'#include "(?:(\w+)/)?(\w+)\.h"', line)
        if found is None:
            continue
        if top == "drivers" and f"{found.group(1)}/{found.group(2)}" in SHARED:
            continue
        home = found.group(1) or next((d for d in edges if (ROOT / top / d / f"{found.group(2)}.h").exists()), None)
        if top == "src" and found.group(1) is None:
            complain(path, number, f"includes {found.group(2)}.h without its folder")
        elif home == room:
            beside.setdefault(f"{top}/{room}/{path.stem}", set()).add(f"{top}/{room}/{found.group(2)}")
        elif home and home not in edges[room]:
            complain(path, number, f"{top}/{room} must not include {top}/{home}")


def check_circles():
    """Takes away, as long as there is one, a noun that includes no other that is left."""
    left = {noun: others - {noun} for noun, others in beside.items()}
    while free := [noun for noun, others in left.items() if not others & left.keys()]:
        for noun in free:
            del left[noun]
    faults.extend(f"{noun}.c: includes go in a circle" for noun in sorted(left))


def check_rooms(path, lines):
    name = str(path.relative_to(ROOT))
    for pattern, rooms in ROOMS:
        if name in rooms or (rooms == "drivers" and name.startswith("drivers/")):
            continue
        for number, line in enumerate(lines, 1):
            if re.search(pattern, line):
                complain(path, number, f"'{line.strip()}' has its place elsewhere")


def check_dimensions(path, lines):
    top, room = path.relative_to(ROOT).parts[:2]
    if top != "src" or room not in DIMENSION_FREE or str(path.relative_to(ROOT)) in TWO_DIMENSIONAL:
        return
    for number, line in enumerate(lines, 1):
        if re.search(r"vec2|sym2", line):
            complain(path, number, f"src/{room} knows no number of dimensions, and so no vec2")


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
            dictated = path.stem == "arkode_compat"  # by SUNDIALS
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
    if top in ("src", "drivers"):
        check_edges(source, rows)
        check_rooms(source, rows)
        check_dimensions(source, rows)
check_circles()
for top, rooms in (("src", SRC), ("drivers", DRIVERS)):
    faults.extend(f"docs/architecture.md: {top}/{room} is not there" for room in rooms if not (ROOT / top / room).is_dir())

print("\n".join(faults) if faults else f"{len(sources)} files stand where they should")
sys.exit(1 if faults else 0)

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Does docs/method.md take all ten equations to functions and tests that are there? `method.py SOURCE_ROOT`."""
import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1])
faults = []


def sources_of(folder, name):
    return [p for p in (ROOT / folder).rglob(pathlib.PurePath(name).name) if str(p).endswith(name)]


def check_function(row, function, path):
    """`function`, path: it is defined, or declared, there."""
    source = ROOT / path
    if not source.is_file():
        faults.append(f"{row}: {path} is not there")
    elif not re.search(rf"^[A-Za-z_][\w *]*\b{function}\(", source.read_text(encoding="utf-8"), re.M):
        faults.append(f"{row}: {path} has no function {function}")


def check_number(row, paths):
    """The code beside one of the functions names the equation."""
    if not any(row in (ROOT / path).read_text(encoding="utf-8") for path in paths if (ROOT / path).is_file()):
        faults.append(f"{row}: {', '.join(paths)} does not name it")


def check_row(row, cells):
    where, shown = cells
    places = re.findall(r"`(\w+)`[^,;]*, ((?:src|drivers)/[\w/]+\.[ch])", where)
    if not places:
        faults.append(f"{row}: no function, or not where it is")
    for function, path in places:
        check_function(row, function, path)
    if row.startswith("("):
        check_number(row, [path for _, path in places])
    tests = re.findall(r"(?:tests/\w+/)?test_\w+\.c", shown)
    if not tests:
        faults.append(f"{row}: no test")
    for test in tests:
        if not sources_of("tests", test):
            faults.append(f"{row}: {test} is not there")


text = (ROOT / "docs/method.md").read_text(encoding="utf-8")
rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if re.match(r"\| (\(\d+\)|-) \|", line)]
found = [row[0] for row in rows if row[0] != "-"]
wanted = [f"({k})" for k in range(1, 11)]
if found != wanted:
    faults.append(f"equations {' '.join(found)} instead of {' '.join(wanted)}")
for row in rows:
    check_row(row[0] if row[0] != "-" else row[1], row[2:4])

print("\n".join(faults) if faults else f"{len(found)} equations, {len(rows)} rows")
sys.exit(1 if faults else 0)

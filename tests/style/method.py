#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Does docs/method.md have the ten equations, and docs/algorithms.md take them to functions and tests that are there?
Is the page of physics free of files of the code? `method.py SOURCE_ROOT`."""
import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1])
WANTED = [f"({k})" for k in range(1, 11)]
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


def rows_of(page):
    """The rows of its table of equations; those without a number begin with a dash."""
    text = (ROOT / page).read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if re.match(r"\| (\(\d+\)|-) \|", line)]
    table = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    found = [row[0] for row in table if row[0] != "-"]
    if found != WANTED:
        faults.append(f"{page}: equations {' '.join(found)} instead of {' '.join(WANTED)}")
    return table


def check_physics(page):
    """Functions and files of the code stand on the page for developers."""
    for number, line in enumerate((ROOT / page).read_text(encoding="utf-8").splitlines(), 1):
        for place in re.findall(r"\b(?:src|drivers|include)/[\w/]*", line):
            faults.append(f"{page}:{number}: {place} belongs to docs/algorithms.md")


rows_of("docs/method.md")
check_physics("docs/method.md")
rows = rows_of("docs/algorithms.md")
for row in rows:
    check_row(row[0] if row[0] != "-" else row[1], row[2:4])

print("\n".join(faults) if faults else f"{len(WANTED)} equations, {len(rows)} rows")
sys.exit(1 if faults else 0)

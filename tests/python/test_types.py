#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""mypy finds nothing in the package, strictly, nor in typed.py but what is written there, nor in the lines of Python
that pages show: `test_types.py PACKAGE PAGE...`."""
import importlib.util
import os
import pathlib
import re
import subprocess
import sys
import tempfile

PACKAGE, PAGES = pathlib.Path(sys.argv[1]).resolve(), [pathlib.Path(page).resolve() for page in sys.argv[2:]]
PROGRAM = pathlib.Path(__file__).with_name("typed.py").resolve()

if importlib.util.find_spec("mypy") is None:
    print("skipped: the Python package mypy is needed")
    sys.exit(77)


# Lines of pages are not strict, and variables of theirs come from nowhere.
LOOSE = '# mypy: disable-error-code="var-annotated, has-type", allow-untyped-defs, allow-untyped-calls, no-check-untyped-defs\n'

with tempfile.TemporaryDirectory() as name:
    place = pathlib.Path(name)
    if not (PACKAGE / "py.typed").exists():
        sys.exit("without py.typed no checker looks at the types of an installed package")
    programs = [PROGRAM]
    for page in PAGES:
        lines = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.S)
        programs.append(place / f"{page.stem}_page.py")
        programs[-1].write_text(LOOSE + "\n".join(lines), encoding="utf-8")
    # All at once, as most of it is what the packages are about that these import. What has no types besides the package
    # is no mistake of it.
    words = [sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports", "--cache-dir", place / "cache", PACKAGE]
    done = subprocess.run([*words, *programs], cwd=place, env=os.environ | {"MYPYPATH": str(PACKAGE.parent)}, check=False,
                          capture_output=True, text=True)
    print(done.stdout + done.stderr, end="")
    sys.exit(1 if done.returncode != 0 else 0)

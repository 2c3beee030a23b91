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


def check(folder, *words):
    """What has no types besides the package is no mistake of it."""
    words = [sys.executable, "-m", "mypy", "--ignore-missing-imports", "--cache-dir", folder / "cache", *words]
    done = subprocess.run(words, cwd=folder, env=os.environ | {"MYPYPATH": str(PACKAGE.parent)}, check=False,
                          capture_output=True, text=True)
    print(done.stdout + done.stderr, end="")
    if done.returncode != 0:
        sys.exit(1)


with tempfile.TemporaryDirectory() as name:
    place = pathlib.Path(name)
    if not (PACKAGE / "py.typed").exists():
        sys.exit("without py.typed no checker looks at the types of an installed package")
    check(place, "--strict", PACKAGE, PROGRAM)
    for page in PAGES:
        lines = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.S)
        program = place / f"{page.stem}.py"
        program.write_text("\n".join(lines), encoding="utf-8")
        check(place, "--disable-error-code=var-annotated", "--disable-error-code=has-type", program)

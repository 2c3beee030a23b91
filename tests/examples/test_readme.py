#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A page's program is the compiled example, and it runs: `test_readme.py SOURCE PAGE PROGRAM [OTHER_PROGRAM]`. The other
one, in another language, finds the same speed."""
import pathlib
import re
import subprocess
import sys
import tempfile

source, page, *programs = (pathlib.Path(word).resolve() for word in sys.argv[1:])
code = re.sub(r"\A((/\*|!).*\n)+", "", source.read_text(encoding="utf-8")).strip()
if code not in page.read_text(encoding="utf-8"):
    sys.exit(f"the program in {page.name} is not {source.name}")
speeds = set()
for program in programs:
    with tempfile.TemporaryDirectory() as folder:
        speed = subprocess.run([program], cwd=folder, capture_output=True, text=True, check=True).stdout
        if not pathlib.Path(folder, "drop.vtkhdf").exists():
            sys.exit("no drop.vtkhdf")
    value, unit = speed.split()
    if unit != "m/s" or not -10.0 < float(value) < 10.0:
        sys.exit(f"it printed '{speed.strip()}'")
    speeds.add(f"{float(value):g}")  # as C prints it
print(*speeds, "m/s")
sys.exit(len(speeds) != 1)

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""README's program is the compiled example, and it runs: `test_readme.py PROGRAM SOURCE README`."""
import pathlib
import subprocess
import sys
import tempfile

program, source, readme = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
code = source.read_text(encoding="utf-8").split("*/\n", 2)[2].strip()
if code not in readme.read_text(encoding="utf-8"):
    sys.exit(f"the program in {readme.name} is not {source.name}")
with tempfile.TemporaryDirectory() as folder:
    speed = subprocess.run([program], cwd=folder, capture_output=True, text=True, check=True).stdout
    if not pathlib.Path(folder, "drop.vtkhdf").exists():
        sys.exit("no drop.vtkhdf")
value, unit = speed.split()
if unit != "m/s" or not -10.0 < float(value) < 10.0:
    sys.exit(f"it printed '{speed.strip()}'")
print(speed.strip())

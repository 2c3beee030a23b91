#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Is every source formatted as .clang-format has it? `format.py SOURCE_ROOT`. Versions differ in taste: it is version 14's."""
import os
import pathlib
import shutil
import subprocess
import sys

root = pathlib.Path(sys.argv[1])
beside_python = str(pathlib.Path(sys.executable).parent)
program = shutil.which("clang-format", path=beside_python + os.pathsep + os.environ["PATH"])
version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout if program else ""
if " 14." not in version:
    print("skipped: clang-format 14 is not there")
    sys.exit(77)
sources = sorted(p for d in ("src", "drivers", "include/dem", "tests") for p in (root / d).rglob("*.[ch]"))
sys.exit(subprocess.run([program, "--dry-run", "--Werror", *sources], check=False).returncode)

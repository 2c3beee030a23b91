#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The programs of a page run, one after the other: `test_page.py PAGE DROP`. The first one prints what DROP prints, the
program of the same body in C; comments that follow what is printed are right."""
import contextlib
import io
import os
import pathlib
import re
import subprocess
import sys
import tempfile

page, drop = (pathlib.Path(word).resolve() for word in sys.argv[1:])
programs = re.findall(r"^```python\n(.*?)^```$", page.read_text(encoding="utf-8"), re.M | re.S)
names, printed = {}, []
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    expected = subprocess.run([drop], capture_output=True, text=True, check=True).stdout
    for program in programs:
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            exec(compile(program, page.name, "exec"), names)
        printed.append(out.getvalue())
        print(out.getvalue(), end="")
        for wanted in re.findall(r"# .*: (\S+ m)$", program, re.M):
            if wanted not in out.getvalue():
                sys.exit(f"{page.name} says {wanted}")
    os.chdir("/")
sys.exit(printed[0] != expected and f"the program in C prints {expected}")

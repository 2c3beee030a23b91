#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Do two programs print the same? `same.py PROGRAM PROGRAM`"""
import difflib
import subprocess
import sys

a, b = (subprocess.run([p], capture_output=True, text=True, check=True).stdout.splitlines() for p in sys.argv[1:])
difference = "\n".join(difflib.unified_diff(a, b, *sys.argv[1:], n=0, lineterm=""))
sys.exit(difference or (0 if a else 'they print nothing'))

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The disc at 10 mm under valgrind: no error, nothing definitely or indirectly lost: `test_valgrind.py VALGRIND DEM_BATCH INPUTS`."""
import pathlib
import subprocess
import sys
import tempfile

VALGRIND, DEM_BATCH, INPUTS = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
deck = pathlib.Path(INPUTS, "disc.nml").read_text(encoding="utf-8").replace("2.5e-3", "1e-2", 1)
with tempfile.TemporaryDirectory() as folder:
    pathlib.Path(folder, "deck.nml").write_text(deck, encoding="utf-8")
    command = [VALGRIND, "--quiet", "--error-exitcode=99", "--leak-check=full", "--errors-for-leak-kinds=definite,indirect",
               DEM_BATCH, "deck.nml"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
print(done.stdout[-400:], done.stderr)
sys.exit(done.returncode)

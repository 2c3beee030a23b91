#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs decks and reads their files back with VTK and h5py: `test_frames.py DEM_BATCH INPUTS READ_VTKHDF`."""
import pathlib
import subprocess
import sys
import tempfile

DEM_BATCH, INPUTS, READER = (pathlib.Path(word).resolve() for word in sys.argv[1:4])

DECKS = [
    # name, changes, frames, interval
    ("rectangle", {"2.5e-3": "1e-2"}, 21, 1e-3),
    ("disc", {"2.5e-3": "1e-2", "t_end   = 20e-3": "t_end   = 7e-3"}, 8, 1e-3),
    ("every_key", {"precision = 'single'": "precision = 'double'", "deflate = 1": "deflate = 0"}, 6, 1e-3),
]


def check(name, changes, frames, interval):
    text = pathlib.Path(INPUTS, f"{name}.nml").read_text(encoding="utf-8")
    for old, new in changes.items():
        assert old in text, f"{old} is not in {name}.nml"
        text = text.replace(old, new, 1)
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "deck.nml").write_text(text, encoding="utf-8")
        subprocess.run([DEM_BATCH, "deck.nml"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        command = [sys.executable, READER, pathlib.Path(folder, f"{name}.vtkhdf")]
        return subprocess.run([*command, "--expect-frames", str(frames), "--interval", str(interval)], check=False).returncode


for deck in DECKS:
    code = check(*deck)
    if code != 0:
        sys.exit(code)

# SPDX-License-Identifier: BSD-3-Clause
"""The paper's three decks at 5, 2.5 and 1.25 mm, with the folding guard and without: the table of docs/verification.md.

Without the guard triangles are turned inside out, whose surfaces cannot push: then bodies do not touch each other.

    build/python/bin/python3 tests/bench/resolution.py build/drivers/dem_batch inputs
"""
import pathlib
import re
import subprocess
import sys
import tempfile

import h5py
import numpy as np

SPACINGS_MM = (5, 2.5, 1.25)


def deck_of(text, spacing_mm, guard):
    text, n = re.subn(r"(?m)^(\s*spacing\s*=).*$", rf"\1 {spacing_mm}e-3", text)
    assert n == 1
    text, n = re.subn(r"(?m)^(\s*density\s*=)", rf"    guard = {guard}\n\1", text)
    assert n == 1
    text += "" if guard else "&contact bodies = 'none' /\n"
    return re.sub(r"(?m)^(\s*frame_interval\s*=).*$", r"\1 10e-3", text)


def figures(log, result):
    """Contact, s; rebound, m/s; least J; largest guard energy over the energy at the start; closure."""
    with h5py.File(result) as f:
        history = f["history"]
        kinetic = history["kinetic"][0]
        guard = np.max(history["guard"][:]) / kinetic
        inverted = np.max(history["inverted"][:])
        closure = history["closure"][-1]
    first, last = map(float, re.search(r"contact +first at (\S+) s, last at (\S+) s", log).groups())
    rebound = float(re.search(r"vertical velocity of the centre of mass (\S+) m/s at the last", log)[1])
    area = float(re.search(r"smallest area (\S+) of", log)[1])
    nodes = int(re.search(r"lattice +(\d+) nodes", log)[1])
    return nodes, last - first, rebound, area, guard, inverted, closure


def main(dem_batch, inputs):
    print("| body | spacing, mm | nodes | guard | contact, ms | rebound, m/s | smallest J | guard's share | inverted | closure |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name in ("rectangle", "disc", "porous"):
            text = (inputs / f"{name}.nml").read_text()
            for spacing in SPACINGS_MM:
                for guard in (0.02, 0):
                    deck = pathlib.Path(folder) / f"{name}_{spacing}_{guard}.nml"
                    outdir = deck.with_suffix("")
                    outdir.mkdir()
                    deck.write_text(deck_of(text, spacing, guard))
                    run = subprocess.run([dem_batch, "--verbose", "--outdir", outdir, deck], capture_output=True, text=True, check=True)
                    n, contact, rebound, area, share, inverted, closure = figures(run.stdout, outdir / f"{name}.vtkhdf")
                    print(f"| {name} | {spacing} | {n} | {guard} | {1e3 * contact:.3f} | {rebound:.3f} | {area:.2f} | "
                          f"{share:.1e} | {inverted} | {closure:.1e} |", flush=True)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]))

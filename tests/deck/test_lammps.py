#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""LAMMPS on the exported body comes to where we are: `test_lammps.py DEM_BATCH DEM_EXPORT`. A plate with a hole is let go
stretched by 5 %, of springs alone, and vibrates freely. `bond_style harmonic` with K = E_ij/(2 d0) has our law at any
strain, so what is between the two is the error of its velocity Verlet, which falls with the square of its step."""
import itertools
import pathlib
import subprocess
import sys
import tempfile
from importlib import metadata

try:
    import h5py
    import numpy as np
    metadata.version("lammps"), metadata.version("mpich")
except ImportError as error:
    print(f"skipped: the Python packages h5py, lammps, mpich and numpy are needed ({error})")
    sys.exit(77)

DEM_BATCH, DEM_EXPORT = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
LMP = pathlib.Path(sys.executable).with_name("lmp")

SPACING, STRETCH = 1e-2, 0.05
TIME = 4e-3             # s: two periods of the longest wave, 19 of the shortest
STEPS = (1500, 3000, 6000)
LEAST = 1e-4            # spacings, of the finest
# Of the ratios of errors from 4, over 4: the frequencies' next term is (omega h)^2/10 of the first, 6e-4 for the fastest
# mode in the coarsest run, whose phase is 0.03 off; found 6e-4.
ORDER = 5e-3

BODY = f"""
&run t_end = 1e-9, gravity = 0, 0 /
&material youngs_modulus = 1e7, density = 1050, guard = 0 /
&body shape = 'rectangle', size = 0.1, 0.06, spacing = {SPACING}, outline = 'lattice' /
&void centre = 0.01, 0.03, radius = 0.012 /
&output name = 'body' /
"""
RUN = f"""
&run t_end = {TIME}, gravity = 0, 0 /
&body shape = 'file', file = 'stretched.h5' /
&solver rtol = 1e-11 /
&output name = 'run', frame_interval = {TIME}, precision = 'double' /
"""


def call(*command):
    done = subprocess.run([str(word) for word in command], cwd=FOLDER, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{command[0]}: {done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stderr


def run_deck(text):
    pathlib.Path(FOLDER, "deck.nml").write_text(text, encoding="utf-8")
    call(DEM_BATCH, "deck.nml")


def run_here():
    """Positions at the end."""
    run_deck(BODY)
    with h5py.File(FOLDER / "body.vtkhdf") as body, h5py.File(FOLDER / "stretched.h5", "w") as file:
        body.copy("lattice", file)
        file["lattice/position"][...] = file["lattice/x"][...] * [1 + STRETCH, 1]
    run_deck(RUN)
    with h5py.File(FOLDER / "run.vtkhdf") as file:
        assert file["history/strain_max"][...].max() >= STRETCH
        assert file["history/closure"][-1] < 1e-9
        return file["VTKHDF/Points"][...].reshape(2, -1, 3)[1, :, :2]


def run_lammps(steps):
    call(LMP, "-in", "in.run", "-log", "none", "-var", "n", steps)
    return np.loadtxt(FOLDER / "run.end.dump", skiprows=9, usecols=(2, 3))


with tempfile.TemporaryDirectory() as folder:
    FOLDER = pathlib.Path(folder)
    ours = run_here()
    assert call(DEM_EXPORT, "run.vtkhdf", "--to", "lammps") == ""     # nothing of the run is left out
    errors = [np.abs(run_lammps(steps) - ours).max() / SPACING for steps in STEPS]
for steps, error in zip(STEPS, errors):
    print(f"{steps} steps of LAMMPS: {error:.3e} spacings off")
ratios = [coarse / fine for coarse, fine in itertools.pairwise(errors)]
print("ratios", *(f"{ratio:.4f}" for ratio in ratios))
if not errors[-1] < LEAST:
    sys.exit(f"with the finest step {errors[-1]:.1e} spacings off, not {LEAST}")
if any(abs(ratio / 4 - 1) > ORDER for ratio in ratios):
    sys.exit("the error does not fall with the square of the step")

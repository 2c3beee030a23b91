#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the springs of a frame, coloured by strain, and the obstacles: `plot_matplotlib.py RUN.vtkhdf OUT.png [FRAME]`.
Frames count from 0, -1 is the last. It needs h5py and matplotlib."""
import sys

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")  # no display
from matplotlib import pyplot  # noqa: E402
from matplotlib.collections import LineCollection  # noqa: E402

if len(sys.argv) < 3:
    sys.exit(__doc__)
path, out = sys.argv[1:3]
with h5py.File(path) as file:
    vtk = file["VTKHDF"]
    times, ends = vtk["Steps/Values"][...], file["lattice/ends"][...]
    frame = range(len(times))[int(sys.argv[3]) if len(sys.argv) > 3 else -1]
    n, m = len(file["lattice/x"]), len(ends)
    x = vtk["Points"][frame * n:(frame + 1) * n, :2]
    strain = vtk["CellData/strain"][frame * m:(frame + 1) * m]
    whole = vtk["CellData/broken"][frame * m:(frame + 1) * m] == 0
    limit = np.abs(vtk["CellData/strain"][...]).max()  # of all frames, so that their colours compare
    obstacles = [obstacle["points"][...] for obstacle in file.get("obstacles", {}).values()]

figure, axes = pyplot.subplots(figsize=(8, 6), dpi=150, layout="compressed")
springs = LineCollection(x[ends[whole]], array=strain[whole], cmap="coolwarm", clim=(-limit, limit), linewidths=1.2)
axes.add_collection(springs)
for points in obstacles:
    axes.plot(*points.T, color="0.2", linewidth=2)
margin = 0.1 * np.ptp(x, axis=0).max()
(left, bottom), (right, top) = x.min(axis=0) - margin, x.max(axis=0) + margin
axes.set(aspect="equal", xlim=(left, right), ylim=(bottom, top), xlabel="x, m", ylabel="y, m", title=f"t = {times[frame]:.4g} s")
figure.colorbar(springs, label="strain")
figure.savefig(out)

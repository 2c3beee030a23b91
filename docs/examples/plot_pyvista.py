#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the springs of a frame, coloured by strain, on the filled bodies, and the obstacles: `plot_pyvista.py RUN.vtkhdf
OUT.png [FRAME]`. Frames count from 0, -1 is the last. It needs PyVista, and no display."""
import os
import sys

import pyvista

if len(sys.argv) < 3:
    sys.exit(__doc__)
path, out = sys.argv[1:3]


def read_frame(name, number):
    reader = pyvista.get_reader(name).reader  # VTK's own: PyVista's has no times
    reader.UpdateInformation()
    reader.SetStep(range(reader.GetNumberOfSteps())[number])
    reader.Update()
    return pyvista.wrap(reader.GetOutput())


frame = int(sys.argv[3]) if len(sys.argv) > 3 else -1
body = read_frame(path, frame)
limit = abs(body["peak_strain"]).max() if "peak_strain" in body.cell_data else abs(body["strain"]).max()
whole = body.extract_cells(body["broken"] == 0)

plotter = pyvista.Plotter(off_screen=True, window_size=(1200, 900))
plotter.set_background("white")
plotter.add_mesh(whole, scalars="strain", cmap="coolwarm", clim=(-limit, limit), line_width=2.5,
                 scalar_bar_args={"title": "strain", "color": "black", "vertical": True, "position_x": 0.88, "position_y": 0.2})
triangles = path.removesuffix(".vtkhdf") + ".body.vtkhdf"
if os.path.exists(triangles):
    # Without what has broken, which add_mesh() by itself would draw.
    filled = read_frame(triangles, frame).extract_surface(algorithm="dataset_surface")
    plotter.add_mesh(filled.translate((0, 0, -1e-3 * body.length)), color="#f0f0f0", lighting=False)  # behind the springs
obstacle = path.removesuffix(".vtkhdf") + ".obstacle.vtkhdf"
if os.path.exists(obstacle):
    plotter.add_mesh(pyvista.read(obstacle), color="#333333", line_width=3)
plotter.add_text(f"t = {body.field_data['Time'][0]:.4g} s", font_size=12, color="black")
plotter.view_xy(bounds=body.bounds)
plotter.enable_parallel_projection()
plotter.screenshot(out)

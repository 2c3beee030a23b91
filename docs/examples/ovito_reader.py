#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""OVITO reads a run by this: nodes as particles, springs that are not broken as bonds, with all that the frames show.
`pip install docs/examples` into OVITO Pro's Python, or any that has the package ovito, and it opens *.vtkhdf by itself;
or without installing: `import_file(path, input_format=DemReader)`. `ovito_reader.py RUN.vtkhdf OUT.png [FRAME]` draws a frame."""
import sys

import h5py
import ovito
from ovito.io import FileReaderInterface, import_file
from ovito.modifiers import ColorCodingModifier
from ovito.vis import TachyonRenderer, Viewport

OVITO_NAMES = {"id": "Particle Identifier", "velocity": "Velocity", "displacement": "Displacement"}
BLUE_GREY_RED = [(0.23, 0.30, 0.75), (0.87, 0.87, 0.87), (0.71, 0.02, 0.15)]


class DemReader(FileReaderInterface):
    @staticmethod
    def detect(filename):
        if not h5py.is_hdf5(filename):
            return False
        with h5py.File(filename) as file:
            return "VTKHDF" in file and "lattice" in file

    def scan(self, filename, register_frame):
        with h5py.File(filename) as file:
            for time in file["VTKHDF/Steps/Values"][...]:
                register_frame(label=float(time))

    def parse(self, data, *, filename, frame_index, **kwargs):
        with h5py.File(filename) as file:
            frames, lattice = file["VTKHDF"], file["lattice"]
            nodes, springs = len(lattice["x"]), len(lattice["ends"])

            def shown(array, rows):  # the frame's rows; there is one set only of what stays the same
                first = frame_index * rows if len(array) > rows else 0
                return array[first:first + rows]

            particles = data.create_particles(count=nodes)
            particles.create_property("Position", data=shown(frames["Points"], nodes))
            for name, array in frames["PointData"].items():
                particles.create_property(OVITO_NAMES.get(name, name), data=shown(array, nodes))
            whole = shown(frames["CellData/broken"], springs) == 0
            bonds = particles.create_bonds(count=whole.sum())
            bonds.create_property("Topology", data=lattice["ends"][...][whole])
            for name in sorted(frames["CellData"].keys() - {"broken", "vtkGhostType"}):
                bonds.create_property(name, data=shown(frames["CellData"][name], springs)[whole])
            spacing = lattice["rest_length"][...].min() if springs else 1.0
            particles.vis.radius, bonds.vis.width = 0.15 * spacing, 0.15 * spacing


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    pipeline = import_file(sys.argv[1], input_format=DemReader)
    frame = range(pipeline.num_frames)[int(sys.argv[3]) if len(sys.argv) > 3 else -1]
    limit = abs(pipeline.compute(frame).particles.bonds["strain"][...]).max()
    pipeline.modifiers.append(ColorCodingModifier(operate_on="bonds", property="strain", start_value=-limit, end_value=limit,
                                                  gradient=ColorCodingModifier.Gradient(BLUE_GREY_RED)))
    pipeline.add_to_scene()
    ovito.scene.anim.current_frame = frame
    view = Viewport(type=Viewport.Type.Top)
    view.zoom_all(size=(1200, 900))
    view.render_image(filename=sys.argv[2], size=(1200, 900), frame=frame, renderer=TachyonRenderer(ambient_occlusion=False))

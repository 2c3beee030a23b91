#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""progress=True shows a bar of tqdm, in a terminal and in a notebook: `test_progress.py INPUTS`."""
import fcntl
import importlib.util
import os
import pathlib
import pty
import struct
import sys
import tempfile
import termios
import unittest

SECONDS = 120  # of a cell, on a machine with much else to do
# Frames take longer than what a bar waits between two times that it is shown, however fast the machine is.
PROGRAM = """
import time
import dem
lattice = dem.Lattice.disc(0.065, 4e-3).assemble(dem.Material(youngs_modulus=1e7, density=1050, thickness=1))
lattice.move((0, 0.1)).launch((0, -10))
with dem.Simulation(lattice, dem.Obstacle([(-0.3, 0.1), (0.3, -0.1)])) as simulation:
    simulation.observe(frame=lambda _: time.sleep(0.15), interval=4e-3)
    simulation.advance(20e-3, progress=True)
"""
RUN = """
dem.run("{deck}", set={{"run.t_end": 1e-3, "body.spacing": 5e-3}}, outdir="{folder}", progress=True)
"""

for needed in ("nbclient", "ipykernel", "ipywidgets", "tqdm"):
    if importlib.util.find_spec(needed) is None:
        print(f"skipped: the Python package {needed} is needed")
        sys.exit(77)

import nbformat  # noqa: E402
from nbclient import NotebookClient  # noqa: E402

INPUTS = pathlib.Path(sys.argv.pop(1)).resolve()


def on_terminal(program):
    """What it writes to one of 80 columns, line by line as they take each other's place."""
    child, end = pty.fork()
    if child == 0:
        os.execv(sys.executable, [sys.executable, "-c", program])
    fcntl.ioctl(end, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
    out = b""
    while True:
        try:
            more = os.read(end, 4096)
        except OSError:  # so it ends on Linux
            break
        out += more
    _, status = os.waitpid(child, 0)
    return status, out.decode().replace("\n", "\r").split("\r")


class Bars(unittest.TestCase):
    def test_in_a_terminal(self):
        status, lines = on_terminal(PROGRAM)
        lines = [line for line in lines if line.strip()]
        self.assertEqual(status, 0, lines)
        self.assertRegex(lines[0], r"^  0\.0 % \| +\| 0 of 0\.02 s, \? left$")
        self.assertRegex(lines[-1], r"^100\.0 % \|█+\| 0\.02 of 0\.02 s, 00:00 left$")
        self.assertGreater(len(lines), 2, "it is shown on the way, too")

    def test_in_a_notebook(self):
        with tempfile.TemporaryDirectory() as folder:
            for variable in ("HOME", "IPYTHONDIR", "JUPYTER_RUNTIME_DIR", "MPLCONFIGDIR"):
                os.environ[variable] = folder
            cells = [PROGRAM, RUN.format(deck=INPUTS / "disc.nml", folder=folder)]
            book = nbformat.v4.new_notebook(cells=list(map(nbformat.v4.new_code_cell, cells)))
            NotebookClient(book, timeout=SECONDS, kernel_name="python3").execute()
        shown = [[output.data for output in cell.outputs if output.output_type == "display_data"]
                 for cell in book.cells]
        self.assertEqual([len(outputs) for outputs in shown], [1, 1], shown)
        widgets = book.metadata.widgets["application/vnd.jupyter.widget-state+json"]["state"]
        texts = "100.0 % 0.02 of 0.02 s, 00:00 left", "100.0 % 00:00 left"
        for outputs, end, text in zip(shown, (20e-3, 1.0), texts):
            box = widgets[outputs[0]["application/vnd.jupyter.widget-view+json"]["model_id"]]
            names = [name.removeprefix("IPY_MODEL_") for name in box["state"]["children"]]
            left, bar, right = (widgets[name]["state"] for name in names)
            self.assertEqual((bar["value"], bar["max"], bar["bar_style"]), (end, end, "success"))
            self.assertEqual(" ".join((left["value"] + right["value"]).split()), text)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Obstacles that move are drawn where they are at each frame: `test_moving_output.py DEM_BATCH DEM_EXPORT`. VTK's readers
and h5py find the same; without one that moves the file has no steps."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml

try:
    import h5py
    import numpy as np
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError as error:
    print(f"skipped: the Python packages h5py, numpy and vtk are needed ({error})")
    sys.exit(77)

DEM_BATCH, DEM_EXPORT = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
DECK = """
&run t_end = 4e-3 /
&material youngs_modulus = 1e7, density = 1050 /
&body shape = 'rectangle', size = 0.04, 0.04, spacing = 0.01, position = 0, 1e-3{body} /
&obstacle points = -0.3, -0.1, 0.3, -0.1 /
&obstacle points = -0.3, 0, 0, -0.005, 0.3, 0, velocity = {velocity} /
&output name = 'a', frame_interval = 1e-3 /
"""
GIVEN = np.array([[-0.3, -0.1], [0.3, -0.1], [-0.3, 0], [0, -0.005], [0.3, 0]])
VELOCITY = np.array([[0, 0], [0, 0], [-2, 5], [-2, 5], [-2, 5]])


def run(folder, velocity, body=""):
    pathlib.Path(folder, "a.nml").write_text(DECK.format(velocity=velocity, body=body), encoding="utf-8")
    subprocess.run([DEM_BATCH, "a.nml"], cwd=folder, capture_output=True, check=True)
    with h5py.File(pathlib.Path(folder, "a.vtkhdf")) as file:
        return file["VTKHDF/Steps/Values"][...]


class MovingOutput(unittest.TestCase):
    def check(self, grid, t):
        self.assertEqual(grid.GetNumberOfCells(), 3)
        self.assertEqual(vtk_to_numpy(grid.GetCellData().GetArray("obstacle")).tolist(), [0, 1, 1])
        ends = [[grid.GetCell(k).GetPointId(end) for end in (0, 1)] for k in range(3)]
        self.assertEqual(ends, [[0, 1], [2, 3], [3, 4]])
        points = vtk_to_numpy(grid.GetPoints().GetData())
        self.assertTrue(np.array_equal(points[:, :2], GIVEN + t * VELOCITY))
        self.assertTrue(np.all(points[:, 2] == 0))

    def test_the_file_has_the_times_of_the_frames(self):
        with tempfile.TemporaryDirectory() as folder:
            times = run(folder, "-2, 5")
            self.assertEqual(len(times), 5)
            path = pathlib.Path(folder, "a.obstacle.vtkhdf")
            with h5py.File(path) as file:
                self.assertTrue(np.array_equal(file["VTKHDF/Steps/Values"][...], times))
                self.assertEqual(file["VTKHDF/Steps"].attrs["NSteps"], len(times))
            reader = vtkHDFReader()
            reader.SetFileName(str(path))
            reader.UpdateInformation()
            for t in times[::-1]:
                reader.UpdateTimeStep(t)
                self.check(reader.GetOutputDataObject(0), t)

    def test_history_and_frames_have_what_swings_and_turns(self):
        """Differences from numpy's sine and cosine are roundings; the power of lasting contacts is in the closure of
        the ledger by its integral."""
        keys = """0.2, 0, motion = 'translate', 'oscillate', 'rotate', amplitude = 0, 1e-4, frequency = 400,
    phase = 90, pivot = 0.1, 0, spin = -8, ramp = 1e-3, friction = 0.5"""
        with tempfile.TemporaryDirectory() as folder:
            times = run(folder, keys, ", velocity = 0, -1")
            with h5py.File(pathlib.Path(folder, "a.vtkhdf")) as file:
                history = {name: column[...] for name, column in file["history"].items()}
            result = json.loads(pathlib.Path(folder, "a.json").read_text(encoding="utf-8"))
            with h5py.File(pathlib.Path(folder, "a.obstacle.vtkhdf")) as file:
                points = file["VTKHDF/Points"][...].reshape(len(times), len(GIVEN), 3)[:, :, :2]

        def ramp(t):
            s = np.clip(t / 1e-3, 0, 1)
            return s**3 * (10 - 15 * s + 6 * s**2), np.where(t < 1e-3, 1e-3 * s**4 * (2.5 - 3 * s + s**2), t - 5e-4)

        def place(t):
            value, area = ramp(t)
            return np.stack([0.2 * area, 1e-4 * value * np.cos(2 * np.pi * 400 * t)], axis=-1), -8 * area

        way, angle = place(history["t"])
        self.assertTrue(np.allclose(history["obstacle_displacement"][:, 1], way, rtol=0, atol=1e-16))
        self.assertTrue(np.allclose(history["obstacle_angle"][:, 1], angle, rtol=0, atol=1e-15))
        self.assertTrue(np.all(history["obstacle_displacement"][:, 0] == 0))
        self.assertGreater(np.abs(history["obstacle_power"][:, 1]).max(), 0.1)
        self.assertLess(np.abs(history["closure"]).max(), 1e-4)
        (dx, dy), q = place(result["t"])
        moved = result["obstacles"][1]
        self.assertTrue(np.allclose([*moved["displacement"], moved["angle"]], [dx, dy, q], rtol=0, atol=1e-15))
        self.assertIsInstance(moved["power"], (int, float))
        self.assertNotIn("displacement", result["obstacles"][0])
        for t, found in zip(times, points):
            (dx, dy), q = place(t)
            turn = np.array([[np.cos(q), -np.sin(q)], [np.sin(q), np.cos(q)]])
            expected = (GIVEN[2:] - [0.1, 0]) @ turn.T + [0.1 + dx, dy]
            self.assertTrue(np.allclose(found[2:], expected, rtol=0, atol=1e-15))
            self.assertTrue(np.array_equal(found[:2], GIVEN[:2]))

    def test_an_export_has_a_file_for_each_frame(self):
        with tempfile.TemporaryDirectory() as folder:
            times = run(folder, "-2, 5")
            subprocess.run([DEM_EXPORT, "a.vtkhdf", "--to", "vtu", "--frames", "1,4"], cwd=folder, check=True)
            sets = xml.parse(pathlib.Path(folder, "a.obstacle.pvd")).getroot().findall("Collection/DataSet")
            self.assertEqual([float(s.get("timestep")) for s in sets], [times[1], times[4]])
            self.assertFalse(pathlib.Path(folder, "a.obstacle.vtu").exists())
            for s in sets:
                reader = vtkXMLUnstructuredGridReader()
                reader.SetFileName(str(pathlib.Path(folder, s.get("file"))))
                reader.Update()
                self.check(reader.GetOutput(), float(s.get("timestep")))
            again = subprocess.run([DEM_EXPORT, "a.vtkhdf", "--to", "vtu", "--frames", "1"], cwd=folder,
                                   capture_output=True, text=True, check=False)
            self.assertNotEqual(again.returncode, 0)

    def test_what_is_at_rest_has_no_steps(self):
        with tempfile.TemporaryDirectory() as folder:
            run(folder, "0, 0")
            with h5py.File(pathlib.Path(folder, "a.obstacle.vtkhdf")) as file:
                self.assertNotIn("Steps", file["VTKHDF"])
                self.assertTrue(np.array_equal(file["VTKHDF/Points"][:, :2], GIVEN))


if __name__ == "__main__":
    del sys.argv[1:3]
    unittest.main()

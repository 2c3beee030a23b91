#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The shipped decks whose bodies touch each other or an obstacle that moves, judged by what they have written:
`test_bodies.py DEM_BATCH INPUTS [--whole]`. `--whole` pours all 200 discs, else 12."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "property"))
try:
    import h5py
    import numpy as np

    import deck_judge
except ImportError as lack:
    print(f"skipped: {lack}")
    sys.exit(77)

DEM_BATCH, INPUTS, IS_WHOLE = None, None, False


class Written:
    """What a deck has written: the history, the surfaces in all frames."""

    def __init__(self, name, *settings):
        with tempfile.TemporaryDirectory() as folder:
            sets = [word for setting in ("output.precision=double", *settings) for word in ("--set", setting)]
            done = subprocess.run([DEM_BATCH, INPUTS / f"{name}.nml", *sets], cwd=folder, capture_output=True, text=True,
                                  check=False)
            if done.returncode != 0:
                raise AssertionError(done.stderr)
            self.log = done.stderr + done.stdout
            with h5py.File(pathlib.Path(folder, f"{name}.vtkhdf")) as f:
                self.h = {key: column[...] for key, column in f["history"].items()}
                self.lattice = {key: column[...] for key, column in f["lattice"].items()}
                frames = len(f["VTKHDF/Steps/Values"])
                self.x = f["VTKHDF/Points"][...].reshape(frames, -1, 3)[:, :, :2]

    def crossings(self):
        """Of surfaces, in any frame."""
        rim = deck_judge.rim_of(self.lattice)
        return sum(deck_judge.crossed(x, rim) for x in self.x)

    def masses(self):
        return np.bincount(self.lattice["body"], weights=self.lattice["mass"])

    def inertia(self, body):
        chosen = self.lattice["body"] == body
        x, mass = self.lattice["x"][chosen], self.lattice["mass"][chosen]
        return (mass * ((x - np.average(x, axis=0, weights=mass)) ** 2).sum(axis=1)).sum()


class Bodies(unittest.TestCase):
    def test_two_discs_throw_each_other_back(self):
        run = Written("two_discs")
        v, spins = run.h["body_velocity"], run.h["body_angular_momentum"]
        self.assertEqual(run.crossings(), 0)
        self.assertIn('"warnings":[]', run.log)
        # the same masses: what one loses the other has; 3,000 steps of rounding
        self.assertLess(np.abs(v.sum(axis=1)).max(), 1e-12 * 5.0)
        # about the common centre; the method keeps it to its error, rtol 1e-6 (found 9e-10)
        centres = run.h["body_centre"]
        turning = centres[:, :, 0] * v[:, :, 1] - centres[:, :, 1] * v[:, :, 0]
        whole = (run.masses() * turning).sum(axis=1) + spins.sum(axis=1)
        self.assertLess(np.abs(whole - whole[0]).max(), 1e-8 * abs(whole[0]))
        # the deck's header: its digits; frictionless, so that only the mesh makes them spin
        self.assertAlmostEqual(np.linalg.norm(v[-1, 0]), 4.90, delta=0.01)
        self.assertAlmostEqual(np.degrees(np.arctan2(v[-1, 1, 1], v[-1, 1, 0])), 34.3, delta=0.1)
        self.assertLess(np.abs(spins[-1] / [run.inertia(0), run.inertia(1)]).max(), 1.0)
        self.assertLess(np.abs(run.h["closure"]).max(), 3e-5)  # found 1.1e-5 at rtol 1e-6

    def test_the_bar_of_a_mill_works_by_its_moment(self):
        run = Written("mill")
        h, (mass,), spin = run.h, run.masses(), -100.0
        self.assertIn('"warnings":[]', run.log)
        centre, v = h["body_centre"][:, 0], h["body_velocity"][:, 0]
        turning = mass * (centre[:, 0] * v[:, 1] - centre[:, 1] * v[:, 0]) + h["body_angular_momentum"][:, 0]
        moment = -9.81 * mass * centre[:, 0]  # of the weight; by trapezoids, to 1e-9 of what the bar does
        weight = (0.5 * np.diff(h["t"]) * (moment[1:] + moment[:-1])).sum()
        # a bar of constant spin works by spin times the moment about its axis, which the particle has taken up
        work = h["obstacle"][-1]
        self.assertAlmostEqual(work / (spin * (turning[-1] - turning[0] - weight)), 1.0, delta=1e-9)  # found 6e-13
        self.assertGreater(work, 3.0)
        # thrown off elastically it would have twice the bar's speed there less its own 1 m/s; waves keep a little of it
        place = centre[0, 0]
        ratio = np.linalg.norm(v[-1]) / (2.0 * 100.0 * place - 1.0)
        self.assertTrue(0.95 < ratio < 1.0, ratio)  # found 0.984
        self.assertLess(np.abs(h["closure"][-1]), 3e-8)  # found 3e-9
        inside = [self.is_in_bar(x, t) for x, t in zip(run.x, np.linspace(0.0, 6e-4, len(run.x)))]
        self.assertLess(max(inside), 1e-8)  # some penetration tolerances of 1.5e-9 m; found none

    @staticmethod
    def is_in_bar(x, t):
        """How deep the deepest node is in the bar, m."""
        c, s = np.cos(100.0 * t), np.sin(100.0 * t)
        own = np.stack([c * x[:, 0] - s * x[:, 1], s * x[:, 0] + c * x[:, 1]])
        return np.minimum(0.1 - np.abs(own[0] - 0.1), 0.01 - np.abs(own[1])).max()

    def test_a_rigid_hammer_squeezes_a_ring(self):
        run = Written("hammer")
        h, masses = run.h, run.masses()
        self.assertEqual(run.crossings(), 0)
        self.assertIn('"warnings":[]', run.log)
        v, t = h["body_velocity"], h["t"]
        # the guide and the mirror leave the vertical alone; what acts along it is the anvil and the weight, 39 N s at first
        rising = (masses * v[:, :, 1]).sum(axis=1)
        lost = rising - rising[0] - h["obstacle_impulse"][:, 0, 1] + 9.81 * masses.sum() * t
        self.assertLess(np.abs(lost).max(), 1e-12 * 39.0)
        self.assertTrue((v[:, 1, 0] == 0.0).all())
        self.assertLess(np.abs(h["body_angular_momentum"][:, 1]).max(), 1e-15)  # rounding of its sum
        hammer = run.x[:, run.lattice["body"] == 1]
        self.assertLess(np.abs(hammer - hammer[:, :1] - (hammer[0] - hammer[0, :1])).max(), 1e-15)  # of 0.1 m: rounding
        # the deck's header: its digits
        self.assertAlmostEqual(t[h["body_centre"][:, 1, 1].argmin()], 5.1e-3, delta=5e-5)
        self.assertAlmostEqual(hammer[:, :, 1].min(), 0.067, delta=5e-4)
        self.assertAlmostEqual(t[h["pairs"] > 0].max(), 1.03e-2, delta=5e-5)
        self.assertAlmostEqual(v[h["pairs"] > 0][-1, 1, 1], 4.43, delta=0.01)
        self.assertAlmostEqual(v[-1, 0, 1], 2.0, delta=0.05)
        self.assertLess(np.abs(h["closure"]).max(), 1e-5)

    def test_discs_poured_into_a_hopper_come_to_rest(self):
        run = Written("granular", *([] if IS_WHOLE else ["body.copies=4,3", "body.position=-0.069,0.42"]))
        self.assertEqual(run.crossings(), 0)
        self.assertEqual(len(run.masses()), 200 if IS_WHOLE else 12)
        h, weight = run.h, 9.81 * run.masses().sum()
        self.assertGreater(h["pairs"][-1], 0)  # the flat bottom has no room for all: some lie on others
        fallen = -(h["gravity"][-1] - h["gravity"][0])
        self.assertLess(h["kinetic"][-1], 1e-5 * fallen)  # drag ends what is left; found 1.8e-6 of 12 discs
        self.assertAlmostEqual(h["obstacle_reaction"][-1, 0, 1] / weight, 1.0, delta=0.01)
        self.assertLess(np.abs(h["closure"]).max(), 1e-3)
        # in the hopper, whose walls are at 0.5 m and whose bottom is at 0
        self.assertLess(np.abs(run.x[-1, :, 0]).max(), 0.5 + 1e-6)
        self.assertGreater(run.x[:, :, 1].min(), -1e-6)


if __name__ == "__main__":
    IS_WHOLE = "--whole" in sys.argv
    if IS_WHOLE:
        sys.argv.remove("--whole")
    DEM_BATCH, INPUTS = (pathlib.Path(sys.argv.pop(1)).resolve() for _ in range(2))
    unittest.main()

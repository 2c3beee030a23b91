#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A floor that comes to a body at rest does what it does at rest to a body that comes: `test_moving.py DEM_BATCH`."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

DEM_BATCH = None
DECK = """
&run t_end = 4e-3 /
&material youngs_modulus = 1e7, density = 1050 /
&body shape = 'rectangle', size = 0.04, 0.04, spacing = 5e-3, position = 0, 1e-3, velocity = {body} /
&obstacle points = -0.3, 0, 0, -0.005, 0.3, 0, restitution = 0.3, friction = 0.3, velocity = {floor} /
&solver rtol = 1e-8, v_scale = 1 /
&contact method = '{method}' /
&output name = 'a' /
"""


def run(folder, floor, body, method):
    path = pathlib.Path(folder, "a.nml")
    path.write_text(DECK.format(floor=floor, body=body, method=method), encoding="utf-8")
    done = subprocess.run([DEM_BATCH, path, "--overwrite", "--verbose"], cwd=folder, capture_output=True, text=True, check=False)
    return done.returncode, done.stderr + done.stdout


class Moving(unittest.TestCase):
    def compare(self, method):
        with tempfile.TemporaryDirectory() as folder:
            results = []
            for floor, body in (("0, 0", "2, -5"), ("-2, 5", "0, 0")):
                code, text = run(folder, floor, body, method)
                self.assertEqual(code, 0, text)
                results.append(json.loads(pathlib.Path(folder, "a.json").read_text(encoding="utf-8")))
                self.assertEqual("motion     obstacle 1: velocity (-2, 5) m/s" in text, body == "0, 0")
        rest, moving = results
        # not sticks: one that begins to slide on a slope may be turned back by rounding first, which counts
        for key in ("impacts", "closings", "releases", "slips", "passings"):
            self.assertEqual(rest[key], moving[key], key)
        self.assertGreater(rest["impacts"], 5)
        # rtol 1e-8, some 500 steps, energies of 35 J
        self.assertAlmostEqual(moving["rising_speed"], rest["rising_speed"] + 5.0, delta=1e-6)
        for key in ("impact", "friction", "elastic"):
            self.assertAlmostEqual(moving["energy"][key], rest["energy"][key], delta=1e-5)
        for result in results:
            self.assertLess(abs(result["closure"]), 1e-5)
        impulse = moving["obstacles"][0]["impulse"]
        for a, b in zip(impulse, rest["obstacles"][0]["impulse"]):
            self.assertAlmostEqual(a, b, delta=1e-6)

    def test_local(self):
        self.compare("local")

    def test_exact(self):
        self.compare("exact")


if __name__ == "__main__":
    DEM_BATCH = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()

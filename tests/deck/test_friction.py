#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The paper's three decks, coarse, thrown at 3 m/s along rough ground with eta 0.5, in both laws of friction:
`test_friction.py DEM_BATCH INPUTS`. Of the bodies' motion along the ground Coulomb's friction takes more than none and less than
what sticks."""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

DEM_BATCH, INPUTS = None, None

# What stands in the deck, and what shall: 8 ms see the bodies off.
CHANGES = (("t_end   = 20e-3", "t_end = 8e-3"), ("spacing   = 2.5e-3", "spacing = 5e-3"),
           ("velocity  = 0, -10", "velocity = 3, -10"), ("frame_interval = 1e-3", "frame_interval = 8e-3"))
FRICTION = {"none": "", "coulomb": ", friction = 0.5, friction_law = 'coulomb'",
            "sticking": ", friction = 1e3, friction_law = 'coulomb'", "paper": ", friction = 0.5, friction_law = 'paper'"}


def run(name, law):
    """Runs a deck with that friction and returns its summary as text."""
    deck = pathlib.Path(INPUTS, f"{name}.nml").read_text(encoding="utf-8")
    for old, new in CHANGES + (("restitution = 0 ", f"restitution = 0.5{FRICTION[law]} "),):
        if deck.count(old) != 1:
            raise AssertionError(f"'{old}' is not once in {name}.nml")
        deck = deck.replace(old, new)
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "deck.nml")
        path.write_text(deck, encoding="utf-8")
        done = subprocess.run([DEM_BATCH, "--verbose", path], cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode != 0 or not pathlib.Path(folder, f"{name}.vtkhdf").exists():
            raise AssertionError(f"{law}: exit {done.returncode}: {done.stderr}")
    return done.stdout


def numbers(pattern, summary):
    found = re.search(pattern.replace("(", r"\(").replace(")", r"\)").replace("#", r"([-+0-9.e]+)"), summary)
    if found is None:
        raise AssertionError(f"no '{pattern}' in\n{summary}")
    return [float(word) for word in found.groups()]


class Friction(unittest.TestCase):
    def check(self, name):
        along = {}
        for law in FRICTION:
            with self.subTest(law):
                summary = run(name, law)
                taken = re.search(r"ledger .*, friction ([-+0-9.e]+)", summary)
                along[law], _, fx, fy = numbers("impulse (#, #) N s, by friction (#, #) N s, 0 contacts", summary)
                slips, sticks = numbers("# slips, # sticks", summary)
                start, = numbers("ledger     start # J", summary)
                self.assertLess(abs(numbers("closure #", summary)[0]), 2e-4)  # ledger, of the largest energy
                self.assertEqual(fx == 0.0 and fy == 0.0, law == "none")
                self.assertEqual(taken is not None, law in ("coulomb", "sticking"))
                self.assertEqual(slips + sticks > 0, law in ("coulomb", "sticking"))
                if law == "coulomb":
                    self.assertGreater(float(taken.group(1)), 0.005 * start)
                if law == "sticking":  # what sticks does not rub, but for its last instants
                    self.assertLess(float(taken.group(1)), 1e-4 * start)
        self.assertTrue(min(along["none"], along["sticking"]) < along["coulomb"] <
                        max(along["none"], along["sticking"]), along)

    def test_the_rectangle_rebounds_between_frictionless_and_sticking(self):
        self.check("rectangle")

    def test_the_disc_rebounds_between_frictionless_and_sticking(self):
        self.check("disc")

    def test_the_porous_square_rebounds_between_frictionless_and_sticking(self):
        self.check("porous")


if __name__ == "__main__":
    DEM_BATCH, INPUTS = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    unittest.main(argv=sys.argv[:1])

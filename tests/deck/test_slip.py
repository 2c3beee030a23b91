#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Contacts that begin to slide, or turn, within a step of Verlet's method where friction is strong:
`test_slip.py DEM_BATCH`. The runs end, with as many such events as those of the exact method, and the ledger closes as
well."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

DEM_BATCH = None

# A disc whose lower edge lies on a vertex, and begins to slide on it just before it leaves.
EDGE_ON_A_VERTEX = """&run t_end=0.002 /
&material name='m', youngs_modulus=2.53848e+08, density=4384.18, damping_time=3.42e-07 /
&body shape='disc', spacing=0.00802237, material='m', lattice='square', clearance=0.0001, 
  velocity=-0.00635803,-2, disconnected='remove', radius=0.0240671 /
&obstacle points=-0.144402584,-0.00962683895, -0.00481341948,-0.00962683895, 0,0.00316786456,
  0.00481341948,-0.00962683895, 0.144402584,-0.00962683895, restitution=0.7, friction=1.5 /
&solver method='verlet', rtol=1e-08 /
&output name='s' /
"""
# A block let go a micrometre above the floor, whose middle node begins to slide as its weight is taken off it.
BLOCK_LET_GO = """&run t_end=0.0105074 /
&material name='m', youngs_modulus=4.21379e+07, density=2345.02, thickness=0.01, poissons_ratio=0.3 /
&body shape='rectangle', spacing=0.00293437, material='m', clearance=1e-06, velocity=0,0, size=0.0586875,0.0338504,
  outline='lattice' /
&obstacle points=-0.176062423,0, 0.176062423,0, restitution=1, friction=1.5 /
&contact vertices=.false. /
&solver method='verlet', rtol=1e-05 /
&output name='s' /
"""
# A ring whose outermost node slides, turns back, and turns again within one step.
NODE_THAT_TURNS_TWICE = """&run t_end=0.00360395 /
&material name='m', youngs_modulus=4.98489e+07, density=6420.17 /
&body shape='ring', spacing=0.00115195, material='m', lattice='square', clearance=1.15195e-05,
  velocity=0.000104288,-0.0347626, disconnected='remove', radius=0.00748766, inner_radius=0.00301995 /
&obstacle points=-0.0898518639,0, 0.0898518639,0, restitution=0.7, friction=1.5 /
&solver method='verlet', rtol=1e-8 /
&output name='s' /
"""


def summary(deck, method):
    """Runs the deck with a contact method; what its JSON says."""
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "deck.nml").write_text(deck, encoding="utf-8")
        done = subprocess.run([DEM_BATCH, "deck.nml", "--set", f"contact.method='{method}'"], cwd=folder,
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise AssertionError(f"{method}: exit {done.returncode}: {done.stderr}")
        return json.loads(pathlib.Path(folder, "s.json").read_text(encoding="utf-8"))


class Slip(unittest.TestCase):
    def check(self, deck):
        local, exact = summary(deck, "local"), summary(deck, "exact")
        # Fixed steps leave the ledger open in both methods; of 500 random decks the ratio was below 2.5 in 95 of 100.
        # These have 1.0, 2.2 and 0.9.
        self.assertLess(abs(local["closure"]), 3.0 * abs(exact["closure"]))
        # The block's motion is chaotic and has 130 slips against 84, the others have the same; a storm has 10000.
        for kind in ("slips", "sticks"):
            self.assertLess(local[kind], 5 * exact[kind] + 10)

    def test_an_edge_begins_to_slide_on_a_vertex(self):
        self.check(EDGE_ON_A_VERTEX)

    def test_nodes_of_a_block_begin_to_slide_on_a_floor(self):
        self.check(BLOCK_LET_GO)

    def test_a_node_turns_twice_within_a_step(self):
        self.check(NODE_THAT_TURNS_TWICE)


if __name__ == "__main__":
    DEM_BATCH = pathlib.Path(sys.argv[1]).resolve()
    unittest.main(argv=sys.argv[:1])

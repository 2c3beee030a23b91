#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Decks in which contact events once followed each other without end: `test_storms.py DEM_BATCH`. They run to their end
with some ten events, or end with the reason."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

DEM_BATCH = None

# A peak that, with the lowest nodes on both sides of it, ended in a pore of the disc, through the wall of the pore.
PEAK_IN_A_PORE = """&run t_end=0.00999771 /
&material name='m', youngs_modulus=1.7902e+08, density=6024.65, thickness=1, plane='strain', poissons_ratio=0.45 /
&body shape='disc', spacing=0.00359041, material='m', {place}, velocity=-6.78232,-20,
  disconnected='remove', spin=-453.32, radius=0.0359041, outline='lattice' /
&pores number=3, radius=0.0043085,0.0057446, wall=0.0071808, seed=41 /
&obstacle points=-0.215424327,-0.0143616218, -0.00718081089,-0.0143616218, 0,0.020370846, 0.00718081089,-0.0143616218,
  0.215424327,-0.0143616218, restitution=0, friction=0 /
&contact window=0, bodies='none' /
&output name='s' /
"""
# A rubbery plate without the guard, whose triangles are turned inside out: its outline crosses itself at a vertex.
FOLDED_PLATE = """&run t_end=0.01 /
&material name='m', youngs_modulus=3.04845e+06, density=825.22, thickness=0.01, plane='strain', poissons_ratio=0.2,
  {guard} /
&body shape='rectangle', spacing=0.0026452, material='m', angle=-104.773, clearance=0, velocity=-1.61472,-3.03896,
  disconnected='remove', spin=-382, size=0.0317424,0.0622854, outline='lattice' /
&pores number=3, radius=0.0031742,0.0042323, wall=0.0052904, seed=23 /
&obstacle points=-0.0952270551,0, -0.0549249939,0.00527889152, -0.0387624746,0.000306347438, -0.0193251076,0.0025570206,
  0.0523229187,0.00595254444, 0.0697534134,0.00299304852, 0.0952270551,0, restitution=0.3, friction=1,
  friction_law='paper' /
&solver method='rk4' /
&contact bodies='{bodies}' /
&output name='s' /
"""
# A disc on a rough floor that shakes: where friction is short of holding its nodes by less than the error of Verlet's
# velocities within a step, they turned back at once, 10,000 times.
SHAKEN_FLOOR = """&run t_end=1e-3, gravity=126,-530 /
&material name='m', youngs_modulus=9.68e8, density=7022, thickness=1, plane='stress', springs='independent' /
&body shape='disc', radius=0.02, spacing=0.0064, material='m', disconnected='keep', angle=303, velocity=-2.3,-11.9,
  clearance=1e-4 /
&obstacle points=-1.7,0, 1.7,0, restitution=0, friction=0.1, motion='oscillate', frequency=7780,
  amplitude=-9.07e-5,-8.45e-5 /
&contact bodies='none' /
&solver {solver} /
&output name='s' /
"""
# A node that the paper's law stops in each bend of 0.03 degrees, and that forces press on along the next segment.
DISC_IN_A_BEND = """&run t_end=8.19396940e-5, gravity=23438.5621,-141866.927 /
&material name='m', youngs_modulus=549451084.7, density=6249.11777, thickness=0.0751481 /
&body shape='disc', radius=0.0033424167935258474, spacing=0.0012481294226268271, material='m', clearance=0,
  position=0.0018511125305814568,0.006687440814977532 /
&obstacle points=-0.020054500761155086,0, -0.006016350228346525,0.003285495163281329,
  0.008021800304462035,-0.0031900795367687915, 0.020054500761155086,0, profile='smooth', restitution=0.5,
  resolution=0.0005277500200303969, friction_law='paper', friction=0 /
&contact penetration_tolerance=4.0285940446212765e-10 /
&solver method='verlet' /
&output name='s' /
"""


def run(deck, method):
    """Exit code, standard error, the JSON of a run with a contact method."""
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "deck.nml").write_text(deck, encoding="ascii")
        done = subprocess.run([DEM_BATCH, "deck.nml", "--set", f"contact.method='{method}'"], cwd=folder,
                              capture_output=True, text=True, check=False)
        return done.returncode, done.stderr, json.loads(done.stdout.splitlines()[-1])


class Storms(unittest.TestCase):
    def check_end(self, deck, method):
        code, stderr, result = run(deck, method)
        self.assertEqual(code, 0, stderr)
        self.assertEqual(result["t"], result["t_end"])
        self.assertEqual(result["rejected"] + result["late"], 0)
        return result

    def test_a_body_is_put_in_front_of_a_peak_that_goes_through_its_side(self):
        local, exact = (self.check_end(PEAK_IN_A_PORE.format(place="clearance=0.0001"), method)
                        for method in ("local", "exact"))
        self.assertEqual(local["events"], exact["events"])
        # of the speed: fixed tolerances of the two methods, 1e-6, grow a hundredfold in the rebound
        self.assertAlmostEqual(local["rebound_speed"] / exact["rebound_speed"], 1, delta=1e-4)

    def test_a_body_with_a_peak_through_its_side_is_refused(self):
        # as far as the peak goes into the pore, and its nodes are 0.1 mm in front
        code, stderr, _ = run(PEAK_IN_A_PORE.format(place="position=0,0.0464"), "local")
        self.assertEqual(code, 3)
        self.assertRegex(stderr, r"^deck\.nml:3:1: error: body 1 starts with obstacle 1, after its point 2, through its "
                                 r"side at .*; 'position' or 'clearance' can put it in front\n$")

    def test_a_folded_body_ends_with_the_reason(self):
        code, stderr, result = run(FOLDED_PLATE.format(guard="guard=0", bodies="none"), "local")
        self.assertEqual(code, 4)
        self.assertRegex(stderr, r"the vertex at .* inside the body, behind the edge .*; \d+ triangles are turned "
                                 r"inside out, whose surfaces cannot push: 'guard' in &material prevents that\n$")
        self.assertLess(result["events"], 100)

    def test_a_node_that_friction_nearly_holds_sticks_to_the_end_of_the_step(self):
        # Verlet's error is of second order: a quarter of the step has a sixteenth of it, found 1.3e-3 and 9e-5
        code, stderr, exact = run(SHAKEN_FLOOR.format(solver="method='fehlberg45', rtol=1e-9"), "local")
        self.assertEqual(code, 0, stderr)
        for solver, error in (("method='verlet'", 2e-3), ("method='verlet', fixed_step=3.9e-7", 2e-4)):
            with self.subTest(solver=solver):
                found = self.check_end(SHAKEN_FLOOR.format(solver=solver), "local")
                self.assertLess(found["events"], 100)
                for name in ("friction", "impact"):
                    self.assertAlmostEqual(found["energy"][name] / exact["energy"][name], 1, delta=error)

    def test_a_node_stays_on_the_side_of_a_bend_that_it_presses(self):
        for method in ("local", "exact"):
            self.assertLess(self.check_end(DISC_IN_A_BEND, method)["events"], 10)

    def test_with_the_guard_it_does_not_fold(self):
        for bodies in ("none", "all"):
            for method in ("local", "exact"):
                with self.subTest(bodies=bodies, method=method):
                    code, stderr, result = run(FOLDED_PLATE.format(guard="guard=1", bodies=bodies), method)
                    self.assertEqual(code, 0, stderr)
                    self.assertEqual(result["inverted"], 0)
                    self.assertLess(result["events"], 300)


if __name__ == "__main__":
    DEM_BATCH = pathlib.Path(sys.argv[1]).resolve()
    unittest.main(argv=sys.argv[:1])

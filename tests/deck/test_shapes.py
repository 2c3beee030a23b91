#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A deck of every shape, from reading to the end of a run: `test_shapes.py DEM_BATCH`. Standard library only.

What is looked at: Euler's number of the lattice, nodes - springs + triangles, which is pieces - holes; the mass against
the true one; a run that touches the ground and closes its energy ledger."""
import math
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

DEM_BATCH = None
NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?"

HEAD = """&run t_end = 2e-4 /
&material name = 'rubber', youngs_modulus = 1e7, density = 1000 /
"""
FLOOR = "&obstacle points = -1, 0, 1, 0 /\n"
BODY = "&body material = 'rubber', spacing = 5e-3, clearance = 1e-4, velocity = 0, -5, shape = "

# A face of 40 x 40 pixels of 2.5 mm with two eyes and a mouth, on a dark ground of 2 pixels.
FACE = [[0 if min(x, y) < 2 or max(x, y) > 37 or (8 < y < 15 and (8 < x < 15 or 24 < x < 31)) or (24 < y < 29 and 10 < x < 30)
         else 200 for x in range(40)] for y in range(40)]
EYES = 2 * 6 * 6 + 4 * 19

# Half a ring of radii 3 and 5, two rows of eight cells of two triangles each; the second row is turned clockwise.
RADII, N = (3.0, 4.0, 5.0), 8


def mesh():
    places = [(r * math.cos(math.pi * k / N), r * math.sin(math.pi * k / N)) for r in RADII for k in range(N + 1)]
    places.append((9.0, 9.0))  # of no triangle
    triangles = []
    for row in range(2):
        for k in range(N):
            a, b = row * (N + 1) + k + 1, (row + 1) * (N + 1) + k + 1
            cell = [(a, b, b + 1), (a, b + 1, a + 1)]
            triangles += cell if row == 0 else [(p, r, q) for p, q, r in cell]
    nodes = "\n".join(f"{x:.17g} {y:.17g} 0" for x, y in places)
    return ("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 1 0\n1 0 0 0 1 1 0 0 0\n$EndEntities\n"
            f"$Nodes\n1 {len(places)} 1 {len(places)}\n2 1 0 {len(places)}\n"
            + "\n".join(str(k + 1) for k in range(len(places))) + f"\n{nodes}\n$EndNodes\n"
            f"$Elements\n1 {len(triangles)} 1 {len(triangles)}\n2 1 2 {len(triangles)}\n"
            + "\n".join(f"{k + 1} {' '.join(map(str, t))}" for k, t in enumerate(triangles)) + "\n$EndElements\n")


def pgm(rows):
    return f"P2\n# a face\n{len(rows[0])} {len(rows)}\n255\n" + "\n".join(" ".join(map(str, row)) for row in rows) + "\n"


def png(rows):
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    head = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 0, 0, 0, 0)
    data = zlib.compress(b"".join(b"\0" + bytes(row) for row in rows))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b"")


# name, groups, Euler's number, true area over mm^2, least and largest ratio of masses: edges are jagged by a spacing
SHAPES = [
    ("rectangle", BODY + "'rectangle', size = 0.1, 0.08 /\n", 1, 8000, 0.9, 1.05),
    ("disc", BODY + "'disc', radius = 0.06 /\n", 1, 3600 * math.pi, 0.85, 1),
    ("ring", BODY + "'ring', radius = 0.06, inner_radius = 0.03 /\n", 0, 2700 * math.pi, 0.75, 1),
    ("polygon", BODY + "'polygon', points = -0.05,0, 0.05,0, 0.05,0.08, 0.02,0.08, 0,0.02, -0.02,0.08, -0.05,0.08 /\n", 1,
     8000 - 1200, 0.85, 1.05),
    ("smooth disc", BODY + "'disc', radius = 0.06, outline = 'smooth' /\n", 1, 3600 * math.pi, 0.998, 1),
    ("smooth ring", BODY + "'ring', radius = 0.06, inner_radius = 0.03, outline = 'smooth' /\n", 0, 2700 * math.pi, 0.998, 1.002),
    ("smooth plate", BODY + "'rectangle', size = 0.1, 0.08, outline = 'smooth', jitter = 0.2 /\n"
     "&void shape = 'polygon', centre = 0.02, 0.04, points = -0.015,-0.01, 0.015,-0.01, 0,0.015 /\n"
     "&void centre = -0.02, 0.04, radius = 0.015 /\n", -1, 8000 - 375 - 225 * math.pi, 0.998, 1.004),
    ("squares", BODY + "'rectangle', size = 0.1, 0.08, lattice = 'square' /\n", 1, 8000, 1, 1),
    ("ring of squares", BODY + "'ring', radius = 0.06, inner_radius = 0.03, lattice = 'square', jitter = 0.2 /\n", 0,
     2700 * math.pi, 0.65, 1),
    ("cracked squares", BODY + "'rectangle', size = 0.1, 0.08, lattice = 'square', diagonal = 0.4, jitter = 0.1 /\n"
     "&crack points = -0.03, 0.03, 0, 0.05, 0.03, 0.05 /\n", 0, 8000, 0.85, 1),
    ("inclusions", "&material name = 'steel', youngs_modulus = 1e9, density = 4000, poissons_ratio = 0.2 /\n"
     + BODY + "'rectangle', size = 0.1, 0.08, lattice = 'square' /\n"
     "&inclusion material = 'steel', shape = 'ring', centre = 0, 0.04, radius = 0.03, inner_radius = 0.015 /\n"
     "&void centre = 0, 0.04, radius = 0.01 /\n", 0, 8000 + 3 * 675 * math.pi - 100 * math.pi, 0.9, 1.05),
    ("jitter", BODY + "'disc', radius = 0.06, jitter = 0.3, seed = 5 /\n", 1, 3600 * math.pi, 0.85, 1),
    ("voids", BODY + "'rectangle', size = 0.1, 0.08 /\n"
     "&void shape = 'rectangle', centre = -0.02, 0.04, size = 0.02, 0.03, angle = 45 /\n"
     "&void shape = 'polygon', centre = 0.02, 0.04, points = -0.01,-0.02, 0.01,-0.02, 0,0.02 /\n",
     -1, 8000 - 600 - 400, 0.8, 1.05),
    ("island", BODY + "'rectangle', size = 0.1, 0.08, disconnected = 'keep' /\n"
     "&void shape = 'ring', centre = 0, 0.04, radius = 0.03, inner_radius = 0.02 /\n", 1, 8000 - 500 * math.pi, 0.75, 1.05),
    ("edge crack", BODY + "'rectangle', size = 0.1, 0.08 /\n&crack points = -0.06, 0.04, 0, 0.04 /\n", 1, 8000, 0.85, 1.05),
    ("inner crack", BODY + "'rectangle', size = 0.1, 0.08 /\n&crack points = -0.03, 0.03, 0, 0.05, 0.03, 0.05 /\n", 0, 8000,
     0.85, 1.05),
    ("crack through", BODY + "'rectangle', size = 0.1, 0.08, disconnected = 'keep' /\n"
     "&crack points = -0.06, 0.04, 0.06, 0.03 /\n", 2, 8000, 0.85, 1.05),
    ("mask", BODY + "'mask', file = 'face.pgm', scale = 2.5e-3 /\n", -2, (36 * 36 - EYES) * 6.25, 0.75, 1),
    ("mesh", BODY.replace("spacing = 5e-3, ", "") + "'mesh', file = 'arc.msh', scale = 0.01 /\n", 1,
     800 * N * math.sin(math.pi / N), 1, 1),
    ("mesh with a crack", BODY.replace("spacing = 5e-3, ", "") + "'mesh', file = 'arc.msh', scale = 0.01 /\n"
     "&crack points = 0.001, 0, 0.001, 0.035 /\n", 1, 800 * N * math.sin(math.pi / N), 0.9, 0.999),
]


def described(log):
    """What a log says of a body and its run, but for memory and output."""
    return [line for line in log.splitlines()[2:] if not line.startswith(("memory", "output"))]


class Shapes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "face.pgm").write_text(pgm(FACE), encoding="ascii")
        (self.folder / "arc.msh").write_text(mesh(), encoding="ascii")

    def call(self, deck, *options, code=0):
        (self.folder / "deck.nml").write_text(deck, encoding="utf-8")
        done = subprocess.run([DEM_BATCH, "--verbose", *options, "deck.nml"], cwd=self.folder, capture_output=True, text=True, timeout=60,
                              check=False)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stdout if code == 0 else done.stderr

    def numbers(self, start, log):
        lines = [line for line in log.splitlines() if line.startswith(start)]
        self.assertEqual(len(lines), 1, f"{start!r} in\n{log}")
        return [float(number) for number in re.findall(NUMBER, lines[0])]

    def test_every_shape_runs(self):
        for name, groups, euler, area, least, largest in SHAPES:
            with self.subTest(name):
                log = self.call(HEAD + FLOOR + groups + f"&output name = '{name}' /\n")
                nodes, springs, triangles = self.numbers("lattice ", log)[:3]
                diagonals = triangles / 2 if "square" in groups else 0  # springs that are no edge, one in a cell
                self.assertEqual(nodes - springs + diagonals + triangles, euler)
                _, mass, true_mass, ratio = self.numbers("mass ", log)
                self.assertAlmostEqual(true_mass / (area * 1e-3), 1, delta=2e-5)  # six digits, and the slices
                self.assertAlmostEqual(mass / true_mass, ratio, delta=1e-4)
                self.assertTrue(least <= ratio <= largest, ratio)
                self.assertRegex(log, r"(?m)^contact    first at ")
                self.assertLess(abs(self.numbers("ledger ", log)[-1]), 1e-5)

    # The same face in black on white, as scans are.
    def test_an_inverted_image_is_the_same(self):
        (self.folder / "scan.pgm").write_text(pgm([[255 - grey for grey in row] for row in FACE]), encoding="ascii")
        deck = HEAD + FLOOR + BODY + "'mask', file = 'face.pgm', scale = 2.5e-3 /\n"
        scan = deck.replace("face.pgm'", "scan.pgm', invert = .true.")
        self.assertEqual(described(self.call(scan, "--check")), described(self.call(deck, "--check")))
        fault = self.call(deck.replace("face.pgm", "scan.pgm"), code=3)
        self.assertRegex(fault, r"share no edge .*; bright pixels are material: for the dark ones give 'invert = .true.'")

    def test_what_is_apart_is_reported(self):
        through = next(groups for name, groups, *_ in SHAPES if name == "crack through")
        log = self.call(HEAD + FLOOR + through, "--check")
        cracked = self.numbers("cracks ", log)[1]
        self.assertGreater(cracked, 35)
        part, apart, triangles, *_ = self.numbers("parts ", log)
        self.assertEqual((part, apart), (1, 1))
        log = self.call(HEAD + FLOOR + through.replace("keep", "remove"), "--check")
        self.assertEqual(self.numbers("parts ", log)[2], triangles)
        self.assertRegex(log, r"(?m)^parts      body 1: 1 removed, of ")
        whole = self.call(HEAD + FLOOR + SHAPES[0][1], "--check")
        left = self.numbers("lattice ", log)[2]
        self.assertEqual(left + triangles + cracked, self.numbers("lattice ", whole)[2])
        self.assertIn("'disconnected' can remove or keep such parts", self.call(HEAD + FLOOR + through.replace("keep", "refuse"),
                                                                              "--check", code=3))

    # Row 8 keeps of its nodes within 2 cm of the middle that at 0 only: one triangle above it, one below.
    def test_hinges_are_reported(self):
        row = 8 * 5e-3 * math.sqrt(0.75)
        voids = [f"&void shape = 'rectangle', centre = {x}, {row}, size = 0.0235, 1e-3 /\n" for x in (-0.0125, 0.0125)]
        lattice = HEAD + FLOOR + SHAPES[0][1].replace(" /\n", ", outline = 'lattice' /\n")
        self.assertNotIn("hinge", self.call(lattice + voids[0], "--check"))
        log = self.call(lattice + voids[0] + voids[1], "--check")
        self.assertEqual(self.numbers("hinges ", log)[:4], [1, 1, 0, float(f"{row:.6g}")])

    def test_pores_come_near_to_their_porosity(self):
        for distribution in ("", ", distribution = 'normal', mean = 3e-3, deviation = 1e-3",
                             ", distribution = 'lognormal', mean = 3e-3, deviation = 2e-3"):
            log = self.call(HEAD + FLOOR + BODY + "'rectangle', size = 0.2, 0.2, disconnected = 'remove' /\n"
                            f"&pores porosity = 0.2, radius = 2e-3, 6e-3, wall = 1e-3{distribution} /\n", "--check")
            with self.subTest(distribution):
                _, number, porosity = self.numbers("pores ", log)
                self.assertAlmostEqual(porosity, 0.2, delta=0.5 * math.pi * 36 / 40000 + 1e-4)  # half a pore
                self.assertTrue(70 < number < 640)
                self.assertAlmostEqual(self.numbers("mass ", log)[2], 40 * (1 - porosity), delta=40 * 1e-4)

    # A slot of one row leans by 30 degrees from upright; its mouth goes from x = -a to 0. A spike stands in it until the
    # falling body's slot meets its tip with the upper face, sqrt(3) 0.7 a above the mouth.
    def test_the_faces_of_a_crack_touch(self):
        a, gap, speed, g = 5e-3, 1e-4, 5.0, 9.81
        deep = 5 * a * math.sqrt(3)
        log = self.call(HEAD.replace("2e-4", "2e-3") + f"&obstacle points = -3e-3, -0.2, {-0.3 * a}, 0, 0, -0.2 /\n"
                        + BODY.replace("clearance = 1e-4", f"position = 0, {gap}") + "'rectangle', size = 0.1, 0.1 /\n"
                        f"&crack points = {-5 * a}, {-deep}, {5 * a}, {deep} /\n")
        way = gap + 0.7 * math.sqrt(3) * a
        self.assertAlmostEqual(self.numbers("contact    first", log)[0],
                               (math.sqrt(speed * speed + 2 * g * way) - speed) / g, delta=2e-9)  # the penetration tolerance / speed

    def test_files_make_the_problem(self):
        deck = HEAD + FLOOR + "&body material = 'rubber', shape = 'mesh', file = 'arc.msh', scale = 0.01, clearance = 1e-4 /\n"
        problem = [re.findall(r"problem (\w+)", self.call(deck, "--check"))[0]]
        (self.folder / "other").mkdir()
        (self.folder / "arc.msh").rename(self.folder / "other" / "arc.msh")
        problem.append(re.findall(r"problem (\w+)", self.call(deck.replace("arc", "other/arc"), "--check"))[0])
        (self.folder / "arc.msh").write_text(mesh() + "\n", encoding="ascii")
        problem.append(re.findall(r"problem (\w+)", self.call(deck, "--check"))[0])
        self.assertEqual(problem[0], problem[1])
        self.assertNotEqual(problem[0], problem[2])
        self.assertIn(f"file = '{self.folder.resolve()}/arc.msh'", self.call(deck, "--echo"))

    def test_a_png_image_is_the_same_as_a_pgm_one(self):
        (self.folder / "face.png").write_bytes(png(FACE))
        deck = HEAD + FLOOR + BODY + "'mask', file = 'face.pgm', scale = 2.5e-3 /\n"
        expected = self.call(deck, "--check")
        (self.folder / "deck.nml").write_text(deck.replace("pgm", "png"), encoding="utf-8")
        done = subprocess.run([DEM_BATCH, "--verbose", "--check", "deck.nml"], cwd=self.folder, capture_output=True, text=True, timeout=60,
                              check=False)
        if "need cairo" in done.stderr:
            self.assertEqual(done.returncode, 3)
        else:
            self.assertEqual(described(done.stdout), described(expected))


if __name__ == "__main__":
    DEM_BATCH = os.path.abspath(sys.argv.pop(1))
    unittest.main()

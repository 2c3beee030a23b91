#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What dem_batch does under mpirun: `test_batch.py MPIRUN DEM_BATCH INPUTS_FOLDER COMPARE [NAMES]`. Files of ranks are
those of one process."""
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

try:
    import h5py
except ImportError:
    h5py = None

MPIRUN = DEM_BATCH = DECK = INPUTS = COMPARE = None
SECONDS = 60
SHORT = ["--set", "run.t_end=1e-4", "--set", "body.spacing=1e-2"]
# Two bodies, of which one is damped by its springs, one pulled and one held; they overlap, which nothing undoes.
FREE = """
&run t_end = 2e-4 /
&material youngs_modulus = 1e7, poissons_ratio = 0.3, density = 1050, damping_time = 1e-5 /
&body shape = 'disc', radius = 0.05, spacing = 6e-3, velocity = 1, 2, spin = 30 /
&body shape = 'rectangle', size = 0.1, 0.04, spacing = 5e-3, position = 0.07, 0, velocity = -5, 0 /
&boundary body = 1, where = 'side', side = 'left', kind = 'force', force = 1000, 0, ramp = 1e-3 /
&boundary body = 2, where = 'side', side = 'right', kind = 'velocity', velocity = 0, 1 /
&contact bodies = 'none' /
&solver checkpoint_steps = 10 /
&output name = 'free', frame_interval = 5e-5, peak_every = 3,
    fields = 'displacement', 'velocity', 'stress', 'strain', 'force', 'fragment' /
&probe name = 'middle', body = 1, place = 0, 0 /
"""
PLATE = """
&run t_end = 2e-4, residual = 0.1, gravity = 0, 0 /
&material youngs_modulus = 210e9, poissons_ratio = 0.3, density = 7850 /
&body shape = 'rectangle', size = 0.2, 0.1, spacing = 1.6e-2 /
&boundary where = 'side', side = 'left' /
&boundary where = 'side', side = 'right', kind = 'traction', traction = 1e6, 0, ramp = 5e-5 /
&contact bodies = 'none' /
&solver method = 'verlet', checkpoint_steps = 50 /
&output name = 'free', frame_interval = 1 /
"""
# So many nodes that not every step has a row.
WITH_RULE = """
&run t_end = 4e-3 /
&material youngs_modulus = 1e6, density = 1000 /
&body shape = 'rectangle', size = 0.2, 0.2, spacing = 2.9e-3, velocity = 0, -5, spin = 20 /
&contact bodies = 'none' /
&solver method = 'verlet', checkpoint_steps = 100 /
&output name = 'free', frame_interval = 1 /
"""
# A rigid hammer on a guide hits a ring on a floor, and a disc hits it from the side: with friction of all with all.
TOUCHING = """
&run t_end = 1.2e-3 /
&material name = 'soft', youngs_modulus = 1e7, density = 1050, friction = 0.4 /
&material name = 'hard', youngs_modulus = 1e9, density = 2000, friction = 0.3 /
&body shape = 'ring', radius = 0.04, inner_radius = 0.02, spacing = 6e-3, position = 0, 0.0403, velocity = 0, -4,
    material = 'soft' /
&body shape = 'rectangle', size = 0.05, 0.02, spacing = 6e-3, position = 0, 0.082, velocity = 0, -9,
    rigid = .true., guide = 'y', material = 'hard' /
&body shape = 'disc', radius = 0.02, spacing = 6e-3, position = -0.061, 0.035, velocity = 9, 0, material = 'soft' /
&obstacle points = -0.2, 0, 0.2, 0, friction = 0.3 /
&solver checkpoint_steps = 25 /
&output name = 'free', frame_interval = 1e-4, fields = 'displacement', 'stress', 'contact' /
"""
# A brittle block, damped by its springs, whose strengths scatter, with a crack, between a disc that does not break and a
# floor: what softens, breaks, and touches.
BREAKING = """
&run t_end = 1e-3 /
&material name = 'soft', youngs_modulus = 1e7, density = 1050, friction = 0.4 /
&material name = 'brittle', youngs_modulus = 1e7, density = 1050, friction = 0.3, fracture = 'stress', strength = 1.2e5,
    fracture_energy = 35, damping_time = 4e-6 /
&body shape = 'disc', radius = 0.04, spacing = 4e-3, position = 0, 0.0925, velocity = 0, -12, material = 'soft' /
&body shape = 'rectangle', size = 0.08, 0.05, spacing = 6e-3, position = 0, 0.0003, velocity = 0, -8, jitter = 0.2,
    material = 'brittle' /
&crack points = -0.05, 0.0261, -0.02, 0.0261 /
&obstacle points = -0.2, 0, 0.2, 0, friction = 0.3 /
&solver checkpoint_steps = 10 /
&output name = 'free', frame_interval = 1e-4, peak_every = 3,
    fields = 'displacement', 'stress', 'principal', 'strain', 'force', 'fragment', 'damage', 'contact' /
"""
# Cracked, it touches uneven ground and itself. Constants are not measured, as they are not of a million nodes.
IN_SLABS = """
&run t_end = 2e-3 /
&material youngs_modulus = 1e6, poissons_ratio = 0.3, density = 1050 /
&body shape = 'ring', radius = 0.05, inner_radius = 0.03, spacing = 4e-3, outline = 'lattice', clearance = 2e-4,
    velocity = 2, -12, spin = 5, jitter = 0.1 /
&void shape = 'disc', centre = 0, 0.04, radius = 0.005 /
&crack points = 0.03, 0.01, 0.042, 0.012 /
&obstacle points = -0.2, -0.02, -0.01, -0.01, 0.01, 0.01, 0.2, -0.02, friction = 0.3 /
&solver checkpoint_steps = 20 /
&output name = 'free', frame_interval = 2e-4, peak_every = 3, measure = .false.,
    fields = 'displacement', 'velocity', 'stress', 'strain', 'force', 'contact' /
&probe name = 'top', place = 0, 1 /
&probe name = 'across', kind = 'gauge', place = -0.05, 0, 0.05, 0 /
&probe name = 'left', kind = 'spring', place = -0.04, 0.01 /
"""
# A square with a core is pushed at a smooth disc, which spins on copies of another one: slabs begin within bodies.
SEVERAL_IN_SLABS = """
&run t_end = 1.5e-3 /
&material name = 'soft', youngs_modulus = 1e6, poissons_ratio = 0.3, density = 1050, friction = 0.4 /
&material name = 'damped', youngs_modulus = 3e6, poissons_ratio = 0.25, density = 2000, damping_time = 1e-5 /
&body shape = 'rectangle', size = 0.05, 0.05, spacing = 4e-3, lattice = 'square', jitter = 0.1, position = -0.06, 0.06,
    angle = 8, velocity = 15, 0, material = 'soft' /
&inclusion body = 1, shape = 'disc', centre = 0, 0.025, radius = 0.012, material = 'damped' /
&body shape = 'disc', radius = 0.03, spacing = 4e-3, jitter = 0.1, clearance = 0.042, spin = 60, velocity = 0, -9,
    material = 'damped' /
&crack body = 2, points = -0.031, 0.002, -0.02, 0.005 /
&body shape = 'disc', radius = 0.018, spacing = 4e-3, outline = 'lattice', copies = 3, 1, pitch = 0.04, 1,
    position = -0.042, 0.0185, velocity = 1, -6, material = 'soft' /
&boundary where = 'side', side = 'top', kind = 'velocity', velocity = 0, 0, components = 'y' /
&boundary where = 'side', side = 'left', kind = 'traction', traction = 3e4, 0, ramp = 1e-4 /
&obstacle points = -0.2, 0, 0.2, 0, friction = 0.3 /
&solver checkpoint_steps = 20 /
&output name = 'free', frame_interval = 2e-4, peak_every = 3, measure = .false.,
    fields = 'displacement', 'velocity', 'stress', 'strain', 'force', 'contact' /
&probe name = 'top', body = 2, place = 0, 1 /
&probe name = 'any', kind = 'gauge', number = 0, 150 /
"""
# A smooth disc, and a block that spins, whose outputs are what the deck behind them begins with. The second of 3 ranks
# has nothing of them.
SOURCES = """
&run t_end = 1e-6 /
&material youngs_modulus = 1e6, poissons_ratio = 0.3, density = 1050, damping_time = 1e-5 /
&body shape = 'disc', radius = 0.03, spacing = 4e-3 /
&output name = 'disc', frame_interval = 1 /
""", """
&run t_end = 1e-6 /
&material youngs_modulus = 2e6, poissons_ratio = 0.3, density = 2000 /
&body shape = 'rectangle', size = 0.05, 0.04, spacing = 4e-3, lattice = 'square', jitter = 0.2, spin = 40 /
&output name = 'block', frame_interval = 1 /
"""
OF_FILES = """
&run t_end = 1.5e-3 /
&material youngs_modulus = 1e6, poissons_ratio = 0.3, density = 1050 /
&body shape = 'file', file = 'disc.vtkhdf', clearance = 2e-4, velocity = 2, -12, spin = 5 /
&body shape = 'rectangle', size = 0.05, 0.03, spacing = 1.9e-3, outline = 'lattice', position = -0.09, 0.03,
    velocity = 15, 0 /
&body shape = 'file', file = 'block.vtkhdf', copies = 2, 1, pitch = 0.055, 1, position = 0.063, 0.0125, angle = 12,
    velocity = -8, -3 /
&obstacle points = -0.2, -0.02, -0.01, -0.01, 0.01, 0.01, 0.2, -0.02, friction = 0.3 /
&solver checkpoint_steps = 20 /
&output name = 'free', frame_interval = 2e-4, peak_every = 3, measure = .false.,
    fields = 'displacement', 'velocity', 'stress', 'strain', 'force', 'contact' /
&probe name = 'top', place = 0, 1 /
&probe name = 'any', kind = 'spring', body = 1, place = 0, 0 /
&boundary body = 2, where = 'side', side = 'left', kind = 'traction', traction = 3e4, 0, ramp = 1e-4 /
"""
# So many nodes that rows are left out, which falls on a floor and comes off again.
LANDS = """
&run t_end = 6e-3 /
&material youngs_modulus = 1e7, density = 1050 /
&body shape = 'rectangle', size = 0.2, 0.2, spacing = 2.8e-3, clearance = 4e-3, velocity = 0, -5 /
&obstacle points = -1, 0, 1, 0 /
&solver method = 'verlet', checkpoint_steps = 40 /
&output name = 'free', frame_interval = 1e-3 /
"""
# 400,000 nodes that take several steps at once, and land before the last checkpoint, which has the last step that the
# report has seen: of ranks it sees all that are taken by themselves.
LARGE = """
&run t_end = 4.4e-6 /
&material youngs_modulus = 1e7, density = 1050 /
&body shape = 'rectangle', size = 0.1, 0.1, spacing = 1.7e-4, clearance = 2e-5, velocity = 0, -5 /
&obstacle points = -1, 0, 1, 0 /
&solver method = 'verlet', checkpoint_steps = 25 /
&output name = 'free', frame_interval = 1.7e-6, history_interval = 1.4e-6, peak_every = 14 /
"""
# Falls from rest, and is soon so fast that no rank has foreseen at the only checkpoint what it will hit.
DROPPED = """
&run t_end = 2.2e-3, gravity = 0, -1.6e4 /
&material youngs_modulus = 1e7, poissons_ratio = 0.3, density = 1050 /
&body shape = 'disc', radius = 0.04, spacing = 5e-3, position = 0, 0.056 /
&obstacle points = -0.2, 0.003, 0, 0, 0.2, 0.003, friction = 0.3, restitution = 0.5 /
&contact bodies = 'none' /
&solver checkpoint_steps = 100000 /
&output name = 'free', frame_interval = 1e-4, history_interval = 5e-5, events = .true., peak_every = 3,
    fields = 'displacement', 'velocity', 'stress' /
&probe name = 'middle', body = 1, place = 0, 0 /
"""


class UnderMpirun(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_on(self, n, *command, **settings):
        done = subprocess.run([MPIRUN, "-n", str(n), *command], cwd=self.folder, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=SECONDS, check=False, **settings)
        said = [line for line in done.stderr.splitlines() if line.startswith("dem_batch")]
        return done.returncode, said, sorted(path.name for path in self.folder.iterdir())

    def test_without_mpi_copies_are_refused_in_one_line(self):
        library = self.folder / "broken"
        library.mkdir()
        (library / "libdem_mpi.so.2").write_text("no library", encoding="ascii")
        code, said, files = self.run_on(3, DEM_BATCH, DECK, env={**os.environ, "LD_LIBRARY_PATH": str(library)})
        self.assertEqual((code, files, len(said)), (2, ["broken"], 1), said)
        self.assertRegex(said[0], "3 processes.*without mpirun or srun, or with --serial")

    def test_jobs_are_refused_in_one_line(self):
        code, said, files = self.run_on(2, DEM_BATCH, "--jobs", "2", DECK)
        self.assertEqual((code, files, len(said)), (2, [], 1), said)
        self.assertRegex(said[0], "2 processes.*--jobs")

    def test_more_writers_than_ranks_are_refused_in_one_line(self):
        for launcher, writers, ranks in (([], "2", "1 rank that there is"),
                                         ([MPIRUN, "-n", "2"], "3", "2 ranks that there are")):
            done = subprocess.run([*launcher, DEM_BATCH, "--writers", writers, DECK], cwd=self.folder,
                                  stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=SECONDS, check=False)
            said = [line for line in done.stderr.splitlines() if line.startswith("dem_batch")]
            self.assertEqual((done.returncode, list(self.folder.iterdir())), (2, []), done.stderr)
            self.assertEqual(said, [f"dem_batch: error: {writers} writers ('--writers') are more than the {ranks}"])

    def test_one_process_is_a_run(self):
        code, said, files = self.run_on(1, DEM_BATCH, *SHORT, DECK)
        self.assertEqual((code, said), (0, []))
        self.assertIn("rectangle.json", files)

    def test_processes_with_outputs_of_their_own_run(self):
        each = f'{DEM_BATCH} --serial {" ".join(SHORT)} --set output.name=r$OMPI_COMM_WORLD_RANK$PMI_RANK {DECK}'
        code, said, files = self.run_on(2, "sh", "-c", each)
        self.assertEqual((code, said), (0, []))
        self.assertEqual([name for name in files if name.endswith(".json")], ["r0.json", "r1.json"])

    def test_a_deck_is_checked_once_and_what_each_rank_has_of_it_is_said(self):
        done = subprocess.run([MPIRUN, "-n", "3", DEM_BATCH, "--check", "--set", "contact.bodies=none", *SHORT, DECK],
                              cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              timeout=SECONDS, check=False)
        self.assertEqual((done.returncode, list(self.folder.iterdir())), (0, []), done.stderr)
        nodes = int(re.search(r"^lattice +(\d+) nodes", done.stdout, re.M)[1])
        said = re.findall(r"^ranks +3: (\d+)(?: to (\d+))? own nodes, (\d+)(?: to (\d+))? ghosts, (\d+)(?: to (\d+))? "
                          r"common nodes of others; memory so far (\S+) to (\S+) MB$", done.stdout, re.M)
        self.assertEqual(len(said), 1, done.stdout)
        own, most_own, ghosts, most_ghosts, common, most_common, least, most = (float(n or "nan") for n in said[0])
        self.assertEqual((own, most_own if nodes % 3 else own), (nodes // 3, -(-nodes // 3)))
        self.assertLessEqual(own + max(ghosts, most_ghosts), nodes)
        self.assertGreater(max(common, most_common), 0)  # near the obstacle
        self.assertTrue(1 < least <= most < 1000)

    def test_what_only_prints_is_done_by_each_process(self):
        self.assertEqual(self.run_on(2, DEM_BATCH, "--version"), (0, [], []))


def stored(path):
    """Of each dataset the chunks as they are in the file, packed; nothing where there is no h5py."""
    found = {}

    def look(name, item):
        if isinstance(item, h5py.Dataset) and item.chunks is not None and not name.startswith("provenance"):
            places = [item.id.get_chunk_info(k).chunk_offset for k in range(item.id.get_num_chunks())]
            found[name] = [item.id.read_direct_chunk(place) for place in places]

    if h5py is not None:
        with h5py.File(path) as file:
            file.visititems(look)
    return found


class Runs(unittest.TestCase):
    within = ()  # words by which mpirun starts each process of dem_batch

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "free.nml").write_text(FREE, encoding="ascii")
        (self.folder / "plate.nml").write_text(PLATE, encoding="ascii")
        (self.folder / "large.nml").write_text(WITH_RULE, encoding="ascii")
        (self.folder / "touching.nml").write_text(TOUCHING, encoding="ascii")
        (self.folder / "breaking.nml").write_text(BREAKING, encoding="ascii")
        (self.folder / "slabs.nml").write_text(IN_SLABS, encoding="ascii")
        (self.folder / "several.nml").write_text(SEVERAL_IN_SLABS, encoding="ascii")
        (self.folder / "dropped.nml").write_text(DROPPED, encoding="ascii")

    def command(self, n, outdir, *more, deck="free.nml"):
        launcher = [] if n == 0 else [MPIRUN, "-n", str(n), *self.within]
        return [*launcher, DEM_BATCH, *([] if n == 0 else ["--mpi"]), "--outdir", outdir, *more, deck]

    def run_on(self, n, outdir, *more, deck="free.nml"):
        done = subprocess.run(self.command(n, outdir, *more, deck=deck), cwd=self.folder, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=SECONDS, check=False)
        return done.returncode, done.stdout, done.stderr

    def result(self, outdir):
        found = json.loads((self.folder / outdir / "free.json").read_text(encoding="utf-8"))
        changing = ("output", "set", "wall_start", "wall_seconds")
        return {key: value for key, value in found.items() if key not in changing}

    def check_going_on(self, deck, ends, key):
        """3 ranks, none and 2 go on in turn, to what one process comes to, with something of this kind at each end."""
        self.assertEqual(self.run_on(0, "one", deck=deck)[0], 0)
        for k, n in enumerate((3, 0, 2)):
            code, log, errors = self.run_on(n, "parts", "--set", f"run.t_end={ends[k]}", deck=deck)
            self.assertEqual(code, 0, errors)
            self.assertEqual("resumed" in log, k > 0)
            self.assertGreater(self.result("parts")[key], 0)
        self.assert_same("one", "parts")

    def assert_same(self, one, other):
        paths = [str(self.folder / outdir / "free.vtkhdf") for outdir in (one, other)]
        done = subprocess.run([sys.executable, COMPARE, *paths], capture_output=True, text=True, check=False)
        self.assertIn(done.returncode, (0, 77), done.stdout)
        self.assertEqual(*((self.folder / outdir / "free.checkpoint").read_bytes() for outdir in (one, other)))
        self.assertEqual(self.result(one), self.result(other))

    def check_files(self, *numbers):
        self.assertEqual(self.run_on(0, "one")[0], 0)
        for n in numbers:
            code, log, errors = self.run_on(n, f"ranks{n}")
            self.assertEqual(code, 0, errors)
            self.assert_same("one", f"ranks{n}")
            # It is there where standard output is no terminal: Open MPI makes one of it.
            self.assertEqual(json.loads(log.splitlines()[-1])["exit_code"], 0)


class FreeBodies(Runs):
    def test_files_are_those_of_one_process(self):
        self.check_files(7)

    def test_a_run_ends_at_rest_as_that_of_one_process(self):
        self.assertEqual(self.run_on(0, "one", deck="plate.nml")[0], 0)
        code, _, errors = self.run_on(3, "ranks", deck="plate.nml")
        self.assertEqual(code, 0, errors)
        self.assert_same("one", "ranks")

    def test_any_number_of_ranks_goes_on(self):
        self.assertEqual(self.run_on(0, "one")[0], 0)
        for k, n in enumerate((3, 0, 2)):
            code, log, errors = self.run_on(n, "parts", "--set", f"run.t_end={(k + 2) * 5e-5}")
            self.assertEqual(code, 0, errors)
            self.assertEqual("resumed" in log, k > 0)
        self.assert_same("one", "parts")

    def test_large_bodies_have_the_rows_of_one_process(self):
        self.assertEqual(self.run_on(0, "one", deck="large.nml")[0], 0)
        self.assertGreater(self.result("one")["history_interval"], 0)
        for k, n in enumerate((3, 2)):
            code, _, errors = self.run_on(n, "parts", "--set", f"run.t_end={(k + 1) * 2e-3}", deck="large.nml")
            self.assertEqual(code, 0, errors)
        self.assert_same("one", "parts")

    def test_what_ranks_deflate_has_the_bytes_of_one_process(self):
        frames = ["--set", "run.t_end=1e-3", "--set", "output.frame_interval=5e-4"]
        self.assertEqual(self.run_on(0, "one", *frames, deck="large.nml")[0], 0)
        code, _, errors = self.run_on(3, "ranks", *frames, deck="large.nml")
        self.assertEqual(code, 0, errors)
        self.assert_same("one", "ranks")
        self.assertEqual(*(stored(self.folder / outdir / "free.vtkhdf") for outdir in ("one", "ranks")))

    def test_rows_left_out_leave_the_checkpoints_of_one_process(self):
        """In flight, on the floor, and off it again: what has been seen last is in them."""
        (self.folder / "lands.nml").write_text(LANDS, encoding="ascii")
        for k, t_end in enumerate((6e-4, 3e-3, 6e-3)):
            for n in (0, 3):
                code, _, errors = self.run_on(n, f"{n}_{k}", "--set", f"run.t_end={t_end}", deck="lands.nml")
                self.assertEqual(code, 0, errors)
            self.assert_same(f"0_{k}", f"3_{k}")
        self.assertGreater(self.result("0_2")["history_interval"], 0)
        self.assertEqual(self.result("0_2")["contacts"], 0)

    def test_more_ranks_than_nodes_are_refused_in_one_line(self):
        (self.folder / "few.nml").write_text("&run t_end = 1e-5 /\n&material youngs_modulus = 1e7, density = 1050 /\n"
                                             "&body shape = 'rectangle', size = 0.01, 0.01, spacing = 0.01 /\n"
                                             "&contact bodies = 'none' /\n&output name = 'few' /\n", encoding="ascii")
        code, _, errors = self.run_on(7, "ranks", deck="few.nml")
        self.assertEqual((code, (self.folder / "ranks").exists()), (3, False))
        self.assertEqual([line for line in errors.splitlines() if line.startswith("few.nml")],
                         ["few.nml: error: 7 ranks are more than the 3 nodes that they are to share"])

    def test_what_fails_fails_on_all_in_one_line(self):
        settings = ("--set", "run.t_end=1e-3", "--set", "solver.method='verlet'", "--set", "solver.fixed_step=1e-4")
        code, _, errors = self.run_on(0, "one", *settings)
        self.assertEqual(code, 4)
        there, _, heard = self.run_on(3, "ranks", *settings)
        self.assertEqual(there, 4)
        self.assertEqual([line for line in heard.splitlines() if line.startswith("free.nml")], errors.splitlines())


class Obstacles(Runs):
    SETTINGS = ("--set", "run.t_end=2e-3", "--set", "body.spacing=7e-3", "--set",
                "solver.checkpoint_steps=20", "--set", "output.name=free")

    def run_on(self, n, outdir, *more, deck="falling.nml"):
        return super().run_on(n, outdir, *self.SETTINGS, *more, deck=deck)

    def take(self, name):
        text = (INPUTS / f"{name}.nml").read_text(encoding="ascii")
        (self.folder / "falling.nml").write_text(text, encoding="ascii")

    def check_deck(self, name, n):
        self.take(name)
        self.assertEqual(self.run_on(0, name)[0], 0)
        self.assertGreater(self.result(name)["events"], 5)
        code, _, errors = self.run_on(n, f"ranks_{name}")
        self.assertEqual(code, 0, errors)
        self.assert_same(name, f"ranks_{name}")

    def test_files_are_those_of_one_process(self):
        self.check_deck("disc", 3)

    def test_any_number_of_ranks_goes_on_with_closed_contacts(self):
        self.take("rectangle")
        self.assertEqual(self.run_on(0, "one")[0], 0)
        for k, n in enumerate((3, 0, 2)):
            code, log, errors = self.run_on(n, "parts", "--set", f"run.t_end={(k + 4) * 2e-3 / 6}")
            self.assertEqual(code, 0, errors)
            self.assertEqual("resumed" in log, k > 0)
            self.assertGreater(self.result("parts")["contacts"], 0)
        self.assert_same("one", "parts")


class Dropped(Runs):
    def test_what_was_not_foreseen_is_in_the_files_once(self):
        self.assertEqual(self.run_on(0, "one", deck="dropped.nml")[0], 0)
        self.assertGreater(self.result("one")["events"], 5)
        code, _, errors = self.run_on(3, "ranks", deck="dropped.nml")
        self.assertEqual(code, 0, errors)
        self.assert_same("one", "ranks")


class Writers(Runs):
    def stripes(self, outdir):
        return sorted(path.name for path in (self.folder / outdir).glob("*.h5*"))

    def check_virtual(self, outdir, writers):
        """Each array of frames is in all stripes, and nothing else is."""
        if h5py is None:
            return
        names = {f"free.{k + 1}of{writers}.h5" for k in range(writers)}
        with h5py.File(self.folder / outdir / "free.vtkhdf") as file:
            there = file["VTKHDF/Points"].virtual_sources()
            self.assertEqual({source.file_name for source in there}, names)
            self.assertTrue(file["VTKHDF/CellData/broken"].is_virtual and file["bodies/CellData/vtkGhostType"].is_virtual)
            self.assertFalse(file["VTKHDF/PointData/id"].is_virtual or file["history/t"].is_virtual)

    def exported(self, outdir):
        """What dem_export reads, as text by the names of its files."""
        export = str(pathlib.Path(DEM_BATCH).with_name("dem_export"))
        subprocess.run([export, str(self.folder / outdir / "free.vtkhdf"), "--to", "csv", "-o", f"{outdir}/"],
                       cwd=self.folder, stdout=subprocess.DEVNULL, check=True)
        return {path.name: path.read_bytes() for path in (self.folder / outdir).glob("*.csv")}

    def test_stripes_read_as_the_files_of_one_process_and_any_number_of_writers_goes_on(self):
        self.assertEqual(self.run_on(0, "one")[0], 0)
        for k, (n, writers) in enumerate(((3, 2), (0, 1), (3, 3))):
            code, log, errors = self.run_on(n, "parts", "--writers", str(writers), "--set",
                                            f"run.t_end={(k + 2) * 5e-5}")
            self.assertEqual(code, 0, errors)
            self.assertEqual("resumed" in log, k > 0)
            self.assertEqual(self.stripes("parts"),
                             [f"free.{j + 1}of{writers}.h5" for j in range(writers if writers > 1 else 0)])
        self.assert_same("one", "parts")
        self.check_virtual("parts", 3)
        self.assertEqual(self.exported("one"), self.exported("parts"))

    def test_what_breaks_is_in_stripes_and_segments(self):
        """Of a run that is stopped after some, and goes on with another number of writers."""
        self.assertEqual(self.run_on(0, "one", deck="breaking.nml")[0], 0)
        code, _, errors = self.run_on(3, "parts", "--writers", "3", "--checkpoint-interval", "0.1", "--max-wall", "2",
                                      deck="breaking.nml")
        self.assertIn(code, (75, 0), errors)
        code, _, errors = self.run_on(2, "parts", "--writers", "2", deck="breaking.nml")
        self.assertEqual((code, self.stripes("parts")), (0, ["free.1of2.h5", "free.2of2.h5"]), errors)
        self.assert_same("one", "parts")

    def test_what_names_stripes_is_not_renamed_and_a_stripe_that_is_missing_is_missed(self):
        early = ("--set", "run.t_end=1e-4", "--writers", "2")
        self.assertEqual(self.run_on(2, "ranks", *early)[0], 0)
        before = {path.name: path.read_bytes() for path in (self.folder / "ranks").iterdir()}
        code, _, errors = self.run_on(2, "ranks", *early, "--set", "material.density=1051", "--overwrite")
        self.assertEqual(code, 5)
        self.assertRegex(errors, r"the output cannot be renamed, as its files name free\.\dof2\.h5")
        self.assertEqual({path.name: path.read_bytes() for path in (self.folder / "ranks").iterdir()} | before, before)
        (self.folder / "ranks" / "free.2of2.h5").unlink()
        code, _, errors = self.run_on(2, "ranks")
        self.assertEqual(code, 5)
        self.assertRegex(errors, r"ranks/free\.vtkhdf does not hold its rows")


class Touching(Runs):
    def test_any_number_of_ranks_goes_on_with_surfaces_that_push(self):
        self.check_going_on("touching.nml", [2 * 3e-4, 3 * 3e-4, 4 * 3e-4], "pairs")


class Breaking(Runs):
    def test_any_number_of_ranks_goes_on_with_what_is_broken(self):
        self.check_going_on("breaking.nml", [8e-4, 9e-4, 1e-3], "broken_triangles")


class LongerTouching(Runs):
    NAMED = ("--set", "output.name=free")

    def test_files_are_those_of_one_process(self):
        for name, t_end in (("two_discs", 2e-3), ("hammer", 2e-3), ("rectangle", 2e-3)):
            deck = str(INPUTS / f"{name}.nml")
            settings = (*self.NAMED, "--set", f"run.t_end={t_end}")
            self.assertEqual(self.run_on(0, name, *settings, deck=deck)[0], 0)
            for n in (2, 7):
                code, _, errors = self.run_on(n, f"{name}{n}", *settings, deck=deck)
                self.assertEqual(code, 0, errors)
                self.assert_same(name, f"{name}{n}")


class InSlabs(Runs):
    """Nobody has the whole of a body."""

    def test_files_are_those_of_one_process_and_any_number_of_ranks_goes_on(self):
        self.assertEqual(self.run_on(0, "one", deck="slabs.nml")[0], 0)
        self.assertGreater(self.result("one")["events"] + self.result("one")["pairs_most"], 20)
        for k, (n, nodes) in enumerate(((3, "1"), (2, "1000000"), (4, "1"))):
            code, log, errors = self.run_on(n, "parts", "--set", f"run.t_end={(k + 2) * 5e-4}", "--slab-nodes", nodes,
                                            deck="slabs.nml")
            self.assertEqual(code, 0, errors)
            self.assertEqual("of slabs" in log, nodes == "1")
            self.assertEqual("resumed" in log, k > 0)
        self.assert_same("one", "parts")

    def test_files_of_several_bodies_are_those_of_one_process(self):
        self.assertEqual(self.run_on(0, "one", deck="several.nml")[0], 0)
        self.assertGreater(min(self.result("one")["events"], self.result("one")["pairs_most"]), 10)
        for k, n in enumerate((4, 3)):
            code, log, errors = self.run_on(n, "parts", "--set", f"run.t_end={(k + 1) * 7.5e-4}", "--slab-nodes", "1",
                                            deck="several.nml")
            self.assertEqual(code, 0, errors)
            self.assertIn("of slabs", log)
        self.assert_same("one", "parts")

    def test_files_of_bodies_from_files_are_those_of_one_process(self):
        for k, text in enumerate(SOURCES):
            (self.folder / f"source{k}.nml").write_text(text, encoding="ascii")
            self.assertEqual(self.run_on(0, ".", deck=f"source{k}.nml")[0], 0)
        (self.folder / "files.nml").write_text(OF_FILES, encoding="ascii")
        self.assertEqual(self.run_on(0, "one", deck="files.nml")[0], 0)
        self.assertGreater(min(self.result("one")["events"], self.result("one")["pairs_most"]), 10)
        code, log, errors = self.run_on(3, "none", "--check", "--slab-nodes", "1", deck="files.nml")
        self.assertEqual(code, 0, errors)
        self.assertRegex(log, r"(?m)^ranks +3, of slabs: ")
        for k, n in enumerate((3, 2)):
            code, log, errors = self.run_on(n, "parts", "--set", f"run.t_end={(k + 1) * 7.5e-4}", "--slab-nodes", "1",
                                            deck="files.nml")
            self.assertEqual(code, 0, errors)
            self.assertIn("of slabs", log)
            self.assertEqual("resumed" in log, k > 0)
        self.assert_same("one", "parts")

    def test_what_is_refused_has_the_line_of_one_process(self):
        """Bodies that overlap are known of by the ranks alone."""
        said = []
        for n, more in ((0, ()), (3, ("--slab-nodes", "1"))):
            code, _, errors = self.run_on(n, "ranks", "--set", "body(1).position=0,0.02", *more, deck="several.nml")
            self.assertEqual(code, 3)
            said.append([line for line in errors.splitlines() if line.startswith("several.nml")])
        self.assertRegex(said[0][0], r"^several.nml:1:1: error: .* of body 3 .* must not cross at the start; bodies = 'none' in")
        self.assertEqual(*said)

    def test_a_run_ends_at_rest_as_that_of_one_process(self):
        stepped = ("--set", "body.outline=lattice", "--set", "output.measure=false")
        self.assertEqual(self.run_on(0, "one", *stepped, deck="plate.nml")[0], 0)
        code, log, errors = self.run_on(3, "ranks", *stepped, "--slab-nodes", "1", deck="plate.nml")
        self.assertEqual(code, 0, errors)
        self.assertIn("of slabs", log)
        self.assert_same("one", "ranks")

    def test_a_deck_that_does_not_suit_is_built_as_a_whole(self):
        self.assertEqual(self.run_on(0, "one", "--set", "output.fields=fragment")[0], 0)
        code, log, errors = self.run_on(3, "ranks", "--slab-nodes", "1", "--set", "output.fields=fragment")
        self.assertEqual(code, 0, errors)
        self.assertNotIn("of slabs", log)
        self.assert_same("one", "ranks")


class LongerAtOnce(Runs):
    def test_files_are_those_of_one_process(self):
        (self.folder / "free.nml").write_text(LARGE, encoding="ascii")
        self.check_files(2)
        self.assertGreater(self.result("one")["events"], 20)


class LongerOnObstacles(Obstacles):
    def test_files_are_those_of_one_process(self):
        self.check_deck("rectangle", 2)
        self.check_deck("porous", 7)


class Longer(Runs):
    def test_files_are_those_of_one_process(self):
        self.check_files(1, 3, 4)

    def test_ranks_but_rank_0_never_have_the_whole(self):
        """Of 1e5 nodes. Where each of 4 ranks compiled the whole they took 0.65 of what rank 0 takes, now 0.31."""
        done = subprocess.run([MPIRUN, "-n", "4", DEM_BATCH, "--check", "--set", "body.spacing=3.4e-4", DECK],
                              cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              timeout=SECONDS, check=False)
        least, most = re.search(r"memory so far (\S+) to (\S+) MB$", done.stdout, re.M).groups()
        self.assertLess(2 * float(least), float(most))

    def test_after_the_death_of_a_rank_the_same_command_goes_on(self):
        long = ("--set", "run.t_end=1.5e-3", "--checkpoint-interval", "0.05")
        self.assertEqual(self.run_on(0, "one", *long)[0], 0)
        with subprocess.Popen(self.command(2, "ranks", *long), cwd=self.folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as run:
            checkpoint = self.folder / "ranks" / "free.checkpoint"
            while not checkpoint.exists() and run.poll() is None:
                time.sleep(0.02)
            for victim in children(run.pid)[-1:]:
                os.kill(victim, signal.SIGKILL)
            self.assertNotEqual(run.wait(timeout=10), 0)
        code, _, errors = self.run_on(3, "ranks", *long)
        self.assertEqual(code, 0, errors)
        self.assert_same("one", "ranks")


class Asked(Runs):
    """A run that signals are sent to: on any rank they have the effect that they have on a process alone."""
    LONG = ("--set", "run.t_end=1.5e-3")
    RANKS = 3

    def ask_mpirun_for_the_end(self, run):
        """By a signal that it passes on to all ranks and survives itself. Returns its name."""
        version = subprocess.run([MPIRUN, "--version"], capture_output=True, text=True, check=True).stdout
        name = "SIGTERM" if "HYDRA" in version else "SIGUSR2"  # that of MPICH, or of Open MPI
        run.send_signal(signal.Signals[name])
        return name

    def start(self, outdir):
        run = subprocess.Popen(self.command(self.RANKS, outdir, *self.LONG), cwd=self.folder, stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.communicate)
        self.addCleanup(run.kill)
        self.read_to(run, "output ")
        return run

    def read_to(self, run, word):
        for line in run.stdout:
            if word in line:
                return
        self.fail(f"there is no '{word}' in the log, but {run.stderr.read()}")

    def rank_of(self, run, rank):
        """The process of a rank."""
        ranks = [pid for pid in children(run.pid) if number_of(pid) == rank]
        self.assertEqual(len(ranks), 1)
        return ranks[0]

    def check_stop(self, run, by):
        out, err = run.communicate(timeout=SECONDS)
        said = [line for line in err.splitlines() if line.startswith("dem_batch")]
        self.assertEqual((run.returncode, said), (75, []))
        self.assertRegex(out, rf"\nstopped    at \S+ s by {by}; the same command goes on from \S+/free.checkpoint\n")

    def check_end(self, n, *outdirs):
        """The same command, on n ranks, ends as a run that nothing happened to."""
        self.assertEqual(self.run_on(0, "one", *self.LONG)[0], 0)
        for outdir in outdirs:
            self.assertEqual(self.run_on(n, outdir, *self.LONG)[0], 0)
            self.assert_same("one", outdir)


class Signals(Asked):
    def test_any_rank_is_asked_for_a_checkpoint_and_mpirun_for_the_end(self):
        run = self.start("ranks")
        os.kill(self.rank_of(run, 2), signal.SIGUSR1)
        self.read_to(run, "checkpoint t ")
        self.check_stop(run, self.ask_mpirun_for_the_end(run))
        self.check_end(0, "ranks")


class LongerSignals(Asked):
    def test_any_rank_is_asked_for_the_end(self):
        names = ("SIGTERM", "SIGINT", "SIGXCPU", "SIGUSR2")
        for name in names:
            for rank in range(self.RANKS):
                with self.subTest(name, rank=rank):
                    run = self.start(f"{name}{rank}")
                    os.kill(self.rank_of(run, rank), signal.Signals[name])
                    self.check_stop(run, name)
        self.check_end(2, *(f"{name}{rank}" for rank, name in zip((2, 1, 2, 1), names)))

    def test_mpirun_passes_on_a_request_for_a_checkpoint(self):
        run = self.start("ranks")
        run.send_signal(signal.SIGUSR1)
        self.read_to(run, "checkpoint t ")
        self.check_stop(run, self.ask_mpirun_for_the_end(run))


def number_of(pid):
    """Its rank; -1: it is none."""
    try:
        names = pathlib.Path("/proc", str(pid), "environ").read_bytes().split(b"\0")
    except OSError:
        return -1
    ranks = [int(name.split(b"=")[1]) for name in names if name.startswith((b"OMPI_COMM_WORLD_RANK=", b"PMI_RANK="))]
    return ranks[0] if ranks else -1


def children(parent):
    """Processes of dem_batch that mpirun has started, by itself or by processes of its own."""
    found = []
    try:
        own = pathlib.Path("/proc", str(parent), "task", str(parent), "children").read_text(encoding="ascii").split()
        for pid in own:
            is_rank = pathlib.Path("/proc", pid, "comm").read_text(encoding="ascii") == "dem_batch\n"
            found += [int(pid)] if is_rank else children(int(pid))
    except OSError:
        pass  # it has ended meanwhile
    return found


def begin(mpirun, dem_batch, inputs, compare):
    """Has to be called before any of the tests here, or of a class that is derived from theirs."""
    global MPIRUN, DEM_BATCH, DECK, INPUTS, COMPARE
    MPIRUN, DEM_BATCH, COMPARE = mpirun, str(pathlib.Path(dem_batch).resolve()), compare
    INPUTS = pathlib.Path(inputs).resolve()
    DECK = str(INPUTS / "rectangle.nml")


if __name__ == "__main__":
    begin(*sys.argv[1:5])
    sys.argv[1:] = sys.argv[5:]
    unittest.main()

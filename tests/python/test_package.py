#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The package dem: bodies, the time loop, callbacks, interrupts, threads, views, files.
`test_package.py DEM_BATCH INPUTS`"""
import contextlib
import gc
import io
import json
import locale
import math
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import types
import unittest
import weakref

import numpy as np

import dem

DEM_BATCH = INPUTS = None
RUBBER = {"youngs_modulus": 1e7, "density": 1050.0, "thickness": 1.0}


def disc(radius=0.02, spacing=5e-3, height=0.021, velocity=(0.0, -10.0)):
    lattice = dem.Lattice.disc(radius, spacing).assemble(dem.Material(**RUBBER))
    return lattice.move((0.0, height)).launch(velocity)


def floor(**values):
    return dem.Obstacle([(-1.0, 0.0), (1.0, 0.0)], **values)


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


class Lattices(Case):
    def test_a_block_has_its_mass_and_its_constants(self):
        block = dem.Lattice.rectangle(0.04, 0.04, 0.01).assemble(dem.Material(**RUBBER))
        self.assertAlmostEqual(block.mass.sum(), 1050.0 * 0.04 * 5 * 0.01 * math.sqrt(0.75), delta=0.6)  # whole rows
        with dem.Simulation(block) as simulation:
            constants = simulation.constants()
        self.assertAlmostEqual(constants.youngs_modulus / 1e7, 1.0, delta=1e-9)  # exact for a regular block
        self.assertAlmostEqual(constants.poissons_ratio, 1.0 / 3.0, delta=1e-9)

    def test_a_rotation_is_about_a_place_or_the_centre_of_mass(self):
        about = dem.Lattice.disc(0.02, 5e-3).spin(2.0, centre=(0.5, -0.25)).velocity
        own = disc(velocity=(0.0, 0.0)).spin(2.0)
        away = dem.Lattice.disc(0.02, 5e-3).x - (0.5, -0.25)
        np.testing.assert_allclose(about, 2.0 * np.column_stack([-away[:, 1], away[:, 0]]), rtol=1e-14)
        np.testing.assert_allclose(own.mass @ own.velocity, (0.0, 0.0), atol=1e-15)

    def test_arrays_are_views_that_may_be_written_to(self):
        block = dem.Lattice.rectangle(0.02, 0.02, 0.01)
        x = block.x
        x[:, 0] += 1.0
        self.assertEqual(block.x.min(), x.min())
        self.assertTrue(np.shares_memory(block.x, x))
        self.assertIsNone(block.mass, "before it is assembled")
        del block
        gc.collect()
        self.assertTrue(np.isfinite(np.frombuffer(x.tobytes())).all(), "a view keeps the memory")

    def test_every_array_of_a_lattice_has_its_type(self):
        declared = set(dem.Lattice.__annotations__) - {"n_nodes", "n_springs", "n_triangles"}
        self.assertEqual(declared, set(dem.lattice.ARRAYS))

    def test_a_lattice_of_arrays_is_that_of_the_library(self):
        made = disc()
        again = dem.Lattice.of_arrays(made.x, triangles=dem.Lattice.disc(0.02, 5e-3).triangles)
        again.assemble(dem.Material(**RUBBER))
        self.assertTrue(np.array_equal(again.ends, made.ends))
        self.assertTrue(np.array_equal(made.copy().stiffness, made.stiffness))

    def test_what_is_wrong_is_said(self):
        block = dem.Lattice.rectangle(0.02, 0.02, 0.01)
        for fault, kind, message in (
                (lambda: dem.Lattice.disc(-1.0, 0.1), dem.ArgumentError, "radius"),
                (lambda: dem.Material(youngs=1.0), TypeError, "youngs_modulus"),
                (lambda: dem.Material(plane="bent"), ValueError, "'stress', 'strain'"),
                (lambda: block.trim([True]), ValueError, "shape"),
                (lambda: setattr(block, "mass", [1.0, 2.0]), ValueError, "2 elements"),
                (lambda: dem.Simulation(block), dem.ArgumentError, "masses"),
                (lambda: dem.Lattice.read("none.vtkhdf"), dem.FileError, "none.vtkhdf"),
                (lambda: dem.Simulation(disc(), floor(restitution=2.0)), dem.ModelError, "restitution")):
            with self.subTest(message):
                with self.assertRaises(kind) as caught:
                    fault()
                self.assertIn(message, str(caught.exception))

    def test_cut_append_and_rigid_bodies(self):
        ring = dem.Lattice.disc(0.03, 5e-3).cut(lambda x: np.hypot(*x) > 0.011)
        self.assertGreater(np.hypot(*ring.x.T).min(), 0.011)
        both = disc().append(disc(height=0.1).stiffen("y"))
        self.assertEqual(set(both.body), {0, 1})
        self.assertEqual(len(set(both.parts())), 2)


class Shapes(Case):
    PLATE = staticmethod(lambda **values: dem.Shape(dem.Outline.rectangle(0.2, 0.1), 5e-3, **values))

    def test_areas_are_those_of_the_formulas(self):
        hole = dem.Outline.disc(0.02, centre=(0.05, 0.0))
        for shape, area in ((self.PLATE(), 0.02), (self.PLATE(voids=[hole]), 0.02 - math.pi * 4e-4),
                            (dem.Shape(dem.Outline.ring(0.1, 0.05), 5e-3), 0.0075 * math.pi),
                            (dem.Shape(dem.Outline.polygon([(0, 0), (0.2, 0), (0, 0.2)], angle=1.0), 5e-3), 0.02)):
            self.assertAlmostEqual(shape.area / area, 1.0, delta=1e-4)

    def test_a_smooth_lattice_has_its_mass_and_a_report(self):
        ring = dem.Shape(dem.Outline.ring(0.1, 0.05, centre=(1.0, 0.0)), 5e-3, edge="smooth")
        lattice = ring.lattice().assemble(dem.Material(**RUBBER, springs="coupled"))
        self.assertAlmostEqual(lattice.mass.sum() / (1050.0 * 0.0075 * math.pi), 1.0, delta=5e-3)
        self.assertAlmostEqual(lattice.x[:, 0].mean(), 1.0, delta=1e-3)
        self.assertGreater(ring.report.n_rim, 100)
        self.assertEqual(ring.report.n_off, 0)

    def test_pores_add_up_and_are_left_out(self):
        plate = self.PLATE().add_pores(4e-3, 6e-3, porosity=0.1, wall=2e-3).add_pores(2e-3, 2e-3, number=3, wall=2e-3)
        self.assertAlmostEqual(plate.area / 0.02, 0.9 - 3 * math.pi * 4e-6 / 0.02, delta=3e-3)
        lattice = plate.lattice()
        for x, y, radius in plate.pores:
            self.assertGreater(np.hypot(*(lattice.x - (x, y)).T).min(), radius - 1e-9)
        np.testing.assert_array_equal(self.PLATE().add_pores(4e-3, 6e-3, porosity=0.1, wall=2e-3).pores,
                                      plate.pores[:-3])

    def test_an_image_an_inclusion_and_a_crack(self):
        grey = np.full((20, 40), 200)
        grey[:10, :20] = 10
        lattice = dem.Shape.image(grey >= 128, 1e-3, 1e-3).lattice()
        self.assertFalse(((lattice.x[:, 0] < -1e-3) & (lattice.x[:, 1] > 11e-3)).any())
        corner = dem.inside(lattice, dem.Outline.rectangle(0.01, 0.01, centre=(0.01, 0.005)))
        self.assertAlmostEqual(corner.mean(), 1.0 / 6.0, delta=0.03)
        stiff = {**RUBBER, "youngs_modulus": 1e8}
        lattice.copy().assemble(dem.Material(**RUBBER), dem.Material(**stiff), of=corner.astype(np.int64))
        cut = dem.crossed(lattice, [(0.003, -1.0), (0.003, 1.0)], aside=1e-9)
        self.assertGreater(cut.sum(), 20)
        lattice.trim(~cut).assemble(dem.Material(**RUBBER))
        self.assertEqual(len(set(lattice.parts())), 2)

    def test_figures_have_distances_boxes_and_corners(self):
        square = dem.Outline.rectangle(2.0, 2.0, centre=(5.0, 0.0), angle=math.pi / 4)
        np.testing.assert_allclose(square.box, (5 - math.sqrt(2), -math.sqrt(2), 5 + math.sqrt(2), math.sqrt(2)))
        np.testing.assert_allclose(square.distance([(5, 0), (8, 0)]), (-1.0, 3.0 - math.sqrt(2)))
        np.testing.assert_allclose(square.corners[0], (5, -math.sqrt(2)), atol=1e-15)
        self.assertEqual(dem.Outline.disc(1.0).corners.shape, (0, 2))

    def test_what_is_no_shape_is_refused(self):
        outside = dem.Outline.disc(0.01, centre=(9.0, 9.0))
        for fault, kind, message in (
                (lambda: dem.Outline.polygon([(0, 0), (2, 2), (2, 0), (0, 2)]), dem.ArgumentError, "meets itself"),
                (lambda: dem.Outline.ring(1.0, 2.0), dem.ArgumentError, "inner radius"),
                (lambda: dem.Shape(dem.Outline.disc(1.0), 2.0).lattice(), dem.ArgumentError, "spacing 2 m"),
                (lambda: self.PLATE(voids=[outside]).lattice(), dem.ModelError, "void 0 takes no node"),
                (lambda: self.PLATE().add_pores(0.04, 0.04, number=9), dem.ModelError, "finds no place"),
                (lambda: self.PLATE(edge="round"), ValueError, "'stepped', 'smooth'")):
            with self.subTest(message):
                with self.assertRaises(kind) as caught:
                    fault()
                self.assertIn(message, str(caught.exception))


class Meshes(Case):
    SOLID = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "thickness": 0.01, "springs": "coupled"}

    def test_a_mesh_is_the_body_of_a_deck_to_the_bit(self):
        """As dem_batch has written it."""
        deck = dem.deck(run={"t_end": 1e-9}, material={"name": "steel", **self.SOLID}, output={"name": "ring"},
                        body={"shape": "mesh", "file": str(INPUTS / "ring.msh"), "scale": 1e-3, "material": "steel"},
                        obstacle={"points": [(-1, -1), (1, -1)]})
        (self.folder / "ring.nml").write_text(deck, encoding="utf-8")
        dem.run(self.folder / "ring.nml", outdir=self.folder)
        written = dem.Lattice.read(self.folder / "ring.vtkhdf")
        made = dem.Lattice.mesh(INPUTS / "ring.msh", 1e-3).assemble(dem.Material(**self.SOLID))
        for name in ("x", "mass", "ends", "rest_length", "stiffness", "triangles", "coupling"):
            np.testing.assert_array_equal(getattr(made, name), getattr(written, name), name)

    def test_a_text_is_read_as_its_file_is(self):
        text = (INPUTS / "ring.msh").read_bytes()
        file, memory = dem.Lattice.mesh(INPUTS / "ring.msh"), dem.Lattice.mesh(text)
        np.testing.assert_array_equal(file.x, memory.x)
        np.testing.assert_array_equal(file.triangles, memory.triangles)
        self.assertAlmostEqual(np.hypot(*file.x.T).max(), 50.0, delta=1e-6)  # mm
        with self.assertRaisesRegex(dem.ModelError, "the mesh:2: MSH version 4.1"):
            dem.Lattice.mesh(text.replace(b"4.1 0 8", b"2.2 0 8"))
        with self.assertRaisesRegex(dem.FileError, "none.msh: No such file"):
            dem.Lattice.mesh("none.msh")
        with self.assertRaisesRegex(dem.ArgumentError, "scale"):
            dem.Lattice.mesh(text, scale=-1.0)


class Runs(Case):
    def test_a_run_is_that_of_dem_batch_to_the_bit(self):
        subprocess.run([DEM_BATCH, "--set", "run.t_end=8e-3", str(INPUTS / "disc.nml")], cwd=self.folder, check=True,
                       capture_output=True)
        result = json.loads((self.folder / "disc.json").read_text(encoding="utf-8"))
        written = dem.read(self.folder / "disc.vtkhdf")
        law = written.obstacle()
        ground = dem.Obstacle(written.obstacle_points(0, 0.0), restitution=law.restitution, friction=law.friction,
                              friction_law=law.friction_law)
        with dem.Simulation(dem.Lattice.read(self.folder / "disc.vtkhdf"), ground, bodies="all") as simulation:
            simulation.advance(8e-3)
            self.assertEqual(simulation.body().velocity[1], result["rising_speed"])
            self.assertEqual(simulation.energy.elastic, result["energy"]["elastic"])
            self.assertEqual(simulation.counts.steps, result["steps"])
            self.assertEqual(simulation.counts.impacts, result["impacts"])
            self.assertTrue(np.array_equal(simulation.x, written.positions(-1)))

    def test_the_lines_of_the_readme_are_a_deck(self):
        """Its speed is that of dem_batch, to the bit."""
        lines = re.search(r"```python\n(.*?)```", (INPUTS.parent / "README.md").read_text(encoding="utf-8"), re.S)[1]
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            exec(lines, {})
        deck = dem.deck(run={"t_end": 20e-3}, contact={"bodies": "none"},
                        material={"youngs_modulus": 1e7, "density": 1050, "thickness": 1},
                        body={"shape": "disc", "radius": 0.065, "spacing": 5e-3, "outline": "lattice",
                              "position": (0, 0.1), "velocity": (0, -10)},
                        obstacle={"points": [(-0.3, 0.1), (0.3, -0.1)]}, output={"name": "disc"})
        (self.folder / "disc.nml").write_text(deck, encoding="utf-8")
        run = dem.run(self.folder / "disc.nml", outdir=self.folder)
        self.assertEqual(out.getvalue(), f"{run.result['rising_speed']} m/s\n")

    def test_cuts_and_a_progress_bar_change_no_bit(self):
        def end(cuts):
            with dem.Simulation(disc(), floor()) as simulation:
                for t in cuts:
                    self.assertTrue(simulation.advance(t))
                return simulation.x.tobytes() + simulation.v.tobytes()
        self.assertEqual(end([3e-3]), end([1e-3, 1.1e-3, 2.9e-3, 3e-3]))

    def test_a_node_falls_and_rebounds(self):
        """v^2 = 2 g h, restitution 0.5: it rises to a quarter of the height."""
        node = dem.Lattice.of_arrays([(0.0, 1.0)], mass=[1.0], flags=[2])
        heights = []
        with dem.Simulation(node, floor(restitution=0.5), spacing=1.0, max_step=1e-2, rtol=1e-10) as simulation:
            simulation.observe(event=lambda s, event: heights.append((event.t, event.after[1])))
            simulation.advance(0.9)
        self.assertAlmostEqual(heights[0][0], math.sqrt(2.0 / 9.81), delta=1e-6)  # the penetration tolerance over v
        self.assertAlmostEqual(heights[0][1], 0.5 * math.sqrt(2.0 * 9.81), delta=1e-5)

    def test_a_force_and_a_boundary(self):
        """A free body under a uniform force m a: x = a t^2/2. One that is held stays."""
        block = dem.Lattice.rectangle(0.02, 0.02, 0.01).assemble(dem.Material(**RUBBER))
        mass = block.mass.copy()

        def push(t, nodes, x, v):
            return np.outer(mass[nodes], (3.0, 0.0))

        with dem.Simulation(block, gravity=(0.0, 0.0), force=push) as simulation:
            start = simulation.body().centre[0]
            simulation.advance(0.01)
            self.assertAlmostEqual(simulation.body().centre[0] - start, 1.5e-4, delta=1e-10)
        held = dem.Boundary("velocity", range(block.n_nodes), (0.0, 0.0))
        with dem.Simulation(block, boundaries=held) as simulation:
            simulation.advance(1e-3)
            self.assertTrue(np.array_equal(simulation.x, block.x))
            self.assertAlmostEqual(simulation.boundary().force[1], 9.81 * mass.sum(), delta=1e-9)

    def test_it_goes_on_from_a_checkpoint_to_the_same_bits(self):
        with dem.Simulation(disc(), floor()) as simulation:
            simulation.advance(3e-3)
            simulation.save(self.folder / "c")
            simulation.advance(4e-3)
            whole = simulation.x.tobytes()
        with dem.Simulation(disc(), floor(), checkpoint=self.folder / "c") as simulation:
            self.assertGreater(simulation.t, 0.0)
            simulation.advance(4e-3)
            self.assertEqual(simulation.x.tobytes(), whole)

    def test_a_body_breaks_into_fragments(self):
        brittle = dem.Lattice.rectangle(0.06, 0.03, 5e-3).assemble(dem.Material(**RUBBER, strength=3e5))
        broken = []
        with dem.Simulation(brittle.move((0.0, 1e-3)).launch((0.0, -15.0)), floor(), bodies="all") as simulation:
            simulation.observe(broken=lambda s, what: broken.append(what.triangle))
            simulation.advance(2e-3)
            self.assertEqual(simulation.broken().sum(), len(broken))
            self.assertEqual(simulation.fracture.triangles, len(broken))
            self.assertGreater(len(broken), 0)
            self.assertEqual(len(set(simulation.fragments())), simulation.fracture.fragments)


class Decks(Case):
    DECK = {"run": {"t_end": 1e-3, "title": "it's a \"test\""},
            "material": {"youngs_modulus": 1e7, "density": 1050, "thickness": 1},
            "body": [{"shape": "disc", "radius": 0.02, "spacing": 5e-3, "position": (-0.03, 0.03)},
                     {"shape": "rectangle", "size": (0.02, 0.02), "spacing": 5e-3, "velocity": [0, -5]}],
            "obstacle": {"points": np.array([(-1.0, -0.001), (1.0, -0.001)]), "restitution": 0.5},
            "output": {"name": "d", "events": True}}

    def test_a_deck_is_written_run_and_read(self):
        path = self.folder / "d.nml"
        path.write_text(dem.deck(**self.DECK), encoding="utf-8")
        run = dem.run(path, outdir=self.folder / "out")
        self.assertEqual((run.result["status"], run.result["title"]), ("done", "it's a \"test\""))
        self.assertEqual(run.result["steps"], run.history["steps"][-1] + 1)
        self.assertEqual(len(run.times), 2)
        again = dem.run(path, outdir=self.folder / "out")
        self.assertEqual(again.result, run.result, "done already")
        other = dem.run(path, {"obstacle.restitution": 0.25, "output.name": "e"}, outdir=self.folder / "out")
        self.assertNotEqual(other.result["energy"], run.result["energy"])

    def test_each_of_several_processes_runs_its_own(self):
        """As scripts with mpi4py are started, by mpirun."""
        path = self.folder / "d.nml"
        path.write_text(dem.deck(**self.DECK), encoding="utf-8")
        os.environ["OMPI_COMM_WORLD_SIZE"] = "2"
        self.addCleanup(os.environ.pop, "OMPI_COMM_WORLD_SIZE")
        run = dem.run(path, outdir=self.folder / "1")
        self.assertEqual(run.result["status"], "done")

    def test_faults_are_those_of_the_program(self):
        wrong = self.DECK | {"run": {"tend": 1.0}}
        with self.assertRaisesRegex(dem.DeckError, "^deck.nml:2:5: error: .*did you mean 't_end'") as caught:
            dem.deck(**wrong)
        self.assertEqual((caught.exception.code, caught.exception.line, caught.exception.column), (3, 2, 5))
        with self.assertRaisesRegex(dem.DeckError, "No such file") as caught:
            dem.run(self.folder / "none.nml")
        self.assertIsNone(caught.exception.line)
        with self.assertRaisesRegex(ValueError, "null"):
            dem.run(self.folder / "a\0b.nml")


class RunsInProcess(Case):
    """dem.run(): the program's results, and nothing of the process is touched."""
    def run_disc(self, outdir, t_end=8e-3, **how):
        return dem.run(INPUTS / "disc.nml", set={"run.t_end": t_end, "body.spacing": 5e-3},
                       outdir=self.folder / outdir, **how)

    def assert_same(self, run, other):
        for key in run.result:
            if key not in ("output", "wall_start", "wall_seconds"):
                self.assertEqual(run.result[key], other.result[key], key)
        self.assertEqual(run.times.tobytes(), other.times.tobytes())
        for frame in range(len(run.times)):
            self.assertEqual(run.positions(frame).tobytes(), other.positions(frame).tobytes())
            for name in run.arrays:
                self.assertEqual(run.array(name, frame).tobytes(), other.array(name, frame).tobytes(), name)
        for table in run.tables:
            for name, column in run.table(table).items():
                self.assertEqual(column.tobytes(), other.table(table)[name].tobytes(), (table, name))

    def interrupt(self):
        timer = threading.Timer(0.15, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        self.addCleanup(timer.join)

    def test_a_run_is_that_of_the_program_to_the_bit(self):
        within, beside = self.run_disc("within"), self.run_disc("beside", process=True)
        self.assert_same(within, beside)
        steady = [re.sub(r"beside|within|[\d.]+ s left|\d+ steps/s|wall time.*", "", run.log)
                  for run in (within, beside)]
        self.assertEqual(*steady)
        self.assertIn("lattice    525 nodes", within.log)

    def test_an_interrupt_leaves_a_checkpoint_from_which_it_goes_on(self):
        handler = signal.getsignal(signal.SIGINT)
        for process in (False, True):
            with self.subTest(process=process):
                out = f"stopped{process}"
                self.interrupt()
                with self.assertRaises(KeyboardInterrupt):
                    self.run_disc(out, 10.0, process=process)
                self.assertFalse((self.folder / out / "disc.lock").exists())
                stopped = json.loads((self.folder / out / "disc.json").read_text(encoding="utf-8"))
                self.assertEqual((stopped["status"], stopped["exit_code"]), ("stopped", 75))
                later = stopped["t"] + 1e-3
                rest, whole = self.run_disc(out, later, process=process), self.run_disc(f"whole{process}", later)
                self.assertIn("resumed    from ", rest.log)
                self.assertEqual(rest.positions(-1).tobytes(), whole.positions(-1).tobytes())
        self.assertIs(signal.getsignal(signal.SIGINT), handler)

    def test_what_progress_raises_ends_the_run(self):
        """With a bar in the place of that of tqdm."""
        seen = []

        class Bar:
            def __init__(self, total, initial, **_):
                self.n = initial

            def update(self, more):
                self.n += more
                seen.append(self.n)
                if self.fails and 0.0 < self.n < 1.0:
                    raise KeyError("bar")

            def close(self):
                seen.append("closed")

        module = types.ModuleType("tqdm.auto")
        module.tqdm = Bar
        before, sys.modules["tqdm.auto"] = sys.modules.get("tqdm.auto"), module
        self.addCleanup(sys.modules.__setitem__, "tqdm.auto", before)
        Bar.fails = False
        self.run_disc("shown", 0.03, progress=True)
        self.assertEqual(seen[-2:], [1.0, "closed"])
        self.assertTrue(any(0.0 < part < 1.0 for part in seen[:-2]) and sorted(seen[:-1]) == seen[:-1])
        Bar.fails = True
        with self.assertRaisesRegex(KeyError, "bar"):
            self.run_disc("failed", 10.0, progress=True)
        self.assertTrue((self.folder / "failed" / "disc.checkpoint").exists())

    def test_runs_in_threads(self):
        """Each with an output of its own has its bits; of two with one output the later is refused."""
        alone, found = self.run_disc("alone", 0.03), {}

        def work(name):
            found[name] = self.run_disc(name, 0.03)

        threads = [threading.Thread(target=work, args=[name]) for name in ("a", "b")]
        for thread in threads:
            thread.start()
        while not (self.folder / "a" / "disc.lock").exists():
            time.sleep(0.01)
        with self.assertRaisesRegex(dem.DeckError, "another run of this process is writing this output") as caught:
            self.run_disc("a", 0.03)
        self.assertEqual(caught.exception.code, 7)
        for thread in threads:
            thread.join()
        for run in found.values():
            self.assert_same(run, alone)

    def test_nothing_of_the_process_is_touched(self):
        """Standard streams, signals, the folder and the locale, in which numbers may have a comma."""
        signals = [signal.SIGINT, signal.SIGTERM, signal.SIGUSR1, signal.SIGPIPE, signal.SIGXFSZ, signal.SIGCHLD]
        before = [signal.getsignal(number) for number in signals], os.getcwd(), self.use_commas()
        with tempfile.TemporaryFile() as caught:
            kept = [os.dup(number) for number in (1, 2)]
            for number in (1, 2):
                os.dup2(caught.fileno(), number)
            try:
                run = self.run_disc("quiet")
                with self.assertRaises(dem.DeckError):
                    self.run_disc("none", -1.0)
            finally:
                for number, copy in zip((1, 2), kept):
                    os.dup2(copy, number)
                    os.close(copy)
            caught.seek(0)
            self.assertEqual(caught.read(), b"")
        after = [signal.getsignal(number) for number in signals], os.getcwd(), locale.setlocale(locale.LC_NUMERIC)
        self.assertEqual(before, after)
        self.assertEqual(run.result["t_end"], 8e-3)

    def use_commas(self):
        """Where the system can make such a locale."""
        made = subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", str(self.folder / "de_DE.UTF-8")],
                              capture_output=True, check=False)
        before = locale.setlocale(locale.LC_NUMERIC)
        self.addCleanup(locale.setlocale, locale.LC_NUMERIC, before)
        os.environ["LOCPATH"] = str(self.folder)
        self.addCleanup(os.environ.pop, "LOCPATH")
        return locale.setlocale(locale.LC_NUMERIC, "de_DE.UTF-8") if made.returncode == 0 else before


class Callbacks(Case):
    def test_an_exception_of_a_force_comes_out_as_itself(self):
        class Own(Exception):
            pass

        def force(t, nodes, x, v):
            if t > 1e-3:
                raise Own("at last")
            return np.zeros_like(x)

        with dem.Simulation(disc(), floor(), force=force) as simulation:
            with self.assertRaisesRegex(Own, "at last"):
                simulation.advance(5e-3)
            self.assertTrue(0.0 < simulation.t <= 1e-3, "the last good state")
            self.assertTrue(np.isfinite(simulation.x).all())

    def test_an_exception_of_an_observer_and_a_stop(self):
        with dem.Simulation(disc(), floor()) as simulation:
            seen = []

            def frame(s):
                seen.append(s.t)
                if len(seen) == 3:
                    return dem.STOP
                if len(seen) == 5:
                    raise KeyError("five")
                return None

            simulation.observe(frame=frame, interval=1e-4)
            self.assertFalse(simulation.advance(1e-3))
            self.assertAlmostEqual(simulation.t, 2e-4, delta=1e-12)
            with self.assertRaises(KeyError):
                simulation.advance(1e-3)
            self.assertTrue(simulation.advance(1e-3))
            np.testing.assert_allclose(seen, np.arange(11) * 1e-4, atol=1e-12)

    def test_an_observer_says_which_steps_it_sees(self):
        every, fifth, late = [], [], []
        with dem.Simulation(disc(), method="verlet") as simulation:
            simulation.observe(step=lambda s: every.append(s.t))
            simulation.observe(step=lambda s: fifth.append(s.t), step_every=5)
            simulation.observe(step=lambda s: late.append(s.t), step_interval=1e-4)
            simulation.advance(1e-3)
        self.assertGreater(len(every), 20)
        self.assertEqual(fifth, every[::5])
        windows = np.floor(np.array(every) / 1e-4)
        self.assertEqual(late, [t for t, new in zip(every, np.diff(windows, prepend=-1.0)) if new > 0.0])

    def test_a_motion_by_a_function(self):
        """A floor that rises with 1 m/s meets a body at rest."""
        def rise(t, pose):
            pose.place[1], pose.velocity[1] = t, 1.0

        moving = floor(motion=rise, most_speed=1.0, most_acceleration=1.0)
        with dem.Simulation(disc(height=0.021, velocity=(0.0, 0.0)), moving, gravity=(0.0, 0.0)) as simulation:
            simulation.advance(2e-3)
            self.assertAlmostEqual(simulation.obstacle().displacement[1], 2e-3, delta=1e-12)
            self.assertGreater(simulation.body().velocity[1], 0.0)

    def test_an_interrupt_stops_cleanly(self):
        with dem.Simulation(disc(spacing=1e-3), floor()) as simulation:
            timer = threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT))
            timer.start()
            with self.assertRaises(KeyboardInterrupt):
                simulation.advance(1e3)
            timer.join()
            t = simulation.t
            self.assertTrue(0.0 < t < 1e3)
            simulation.advance(t + 1e-5)
            self.assertEqual(simulation.t, t + 1e-5)

    def test_no_interrupt_is_lost_between_functions_of_python(self):
        """Most come while the library computes, and are seen by the interpreter as the next callback begins."""
        def force(t, nodes, x, v):
            return np.zeros_like(x)

        handler = signal.getsignal(signal.SIGINT)
        with dem.Simulation(disc(spacing=1e-3), floor(), force=force) as simulation:
            seconds = 4000 * simulation.options.max_step  # of some tenths on the wall
            for k in range(8):
                timer = threading.Timer(0.02 + 0.003 * k, lambda: os.kill(os.getpid(), signal.SIGINT))
                timer.start()
                with self.assertRaises(KeyboardInterrupt):
                    simulation.advance(simulation.t + seconds)
                timer.join()
        self.assertIs(signal.getsignal(signal.SIGINT), handler)

    def test_an_interrupt_within_a_function_of_python(self):
        def frame(s):
            os.kill(os.getpid(), signal.SIGINT)
            threading.Event().wait(5.0)

        with dem.Simulation(disc(), floor()) as simulation:
            simulation.observe(frame=frame, interval=1e-3)
            start = time.monotonic()
            with self.assertRaises(KeyboardInterrupt):
                simulation.advance(5e-3)
            self.assertLess(time.monotonic() - start, 4.0, "the wait was cut short")


class Threads(Case):
    def test_two_simulations_in_two_threads(self):
        def end():
            with dem.Simulation(disc(), floor()) as simulation:
                simulation.advance(4e-3)
                return simulation.x.tobytes()

        alone, found = end(), []
        threads = [threading.Thread(target=lambda: found.append(end())) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(found, [alone, alone])

    def test_the_interpreter_is_free_meanwhile(self):
        """Another thread counts on while a simulation computes for some tenths of a second."""
        counted, done = [0], threading.Event()

        def count():
            while not done.wait(1e-3):
                counted[0] += 1

        thread = threading.Thread(target=count)
        with dem.Simulation(disc(spacing=5e-4), floor()) as simulation:
            thread.start()
            before = counted[0]
            status = dem.library.library.dem_simulation_advance(simulation._c, 3e-4)
            within = counted[0] - before
            done.set()
            thread.join()
        self.assertEqual(status, 0)
        self.assertGreater(within, 5)


class Views(Case):
    def test_a_view_outlives_its_simulation(self):
        """Bytes are copied by the C library, which AddressSanitizer watches, as it does not watch NumPy."""
        simulation = dem.Simulation(disc(), floor())
        simulation.advance(1e-3)
        x, rest = simulation.x, simulation.lattice.x
        copied = x.copy()
        handle = weakref.ref(simulation._handle)
        simulation.close()
        with self.assertRaisesRegex(ValueError, "closed"):
            simulation.x
        del simulation
        gc.collect()
        self.assertEqual(x.tobytes(), copied.tobytes())
        self.assertEqual(len(rest.tobytes()), x.nbytes)
        self.assertIsNotNone(handle())
        del x, rest
        gc.collect()
        self.assertIsNone(handle(), "the last view has freed it")

    def test_what_is_the_library_s_cannot_be_written_to(self):
        with dem.Simulation(disc(), floor()) as simulation:
            for array in (simulation.x, simulation.v, simulation.lattice.mass):
                with self.assertRaises(ValueError):
                    array[0] = 0.0
            with self.assertRaisesRegex(ValueError, "copy"):
                simulation.lattice.launch((1.0, 0.0))
            simulation.set_motion(v=np.zeros_like(simulation.v))
            self.assertEqual(simulation.energy.kinetic, 0.0)


class Files(Case):
    def test_a_run_read_back(self):
        path = self.folder / "drop.vtkhdf"
        with dem.Simulation(disc(), floor(friction=0.3)) as simulation:
            with simulation.record(path, 5e-4, fields=["velocity", "von_mises", "strain"], events=True,
                                   double_precision=True) as recording:
                recording.note("title", "drop")
                simulation.advance(4e-3)
            x, v, stress, strains = simulation.x.copy(), simulation.v.copy(), simulation.stress(), simulation.strains()
            counts, energy = simulation.counts, simulation.energy
        run = dem.read(path)
        np.testing.assert_allclose(run.times, np.arange(9) * 5e-4, atol=1e-12)
        self.assertTrue(np.array_equal(run.positions(-1), x))
        self.assertTrue(np.array_equal(run.array("velocity")[:, :2], v))
        np.testing.assert_allclose(run.array("von_mises"), dem.von_mises(stress), rtol=1e-6)
        self.assertTrue(np.array_equal(run.array("strain"), strains))
        self.assertEqual(run.history["steps"].tolist(), list(range(len(run.history["t"]))))
        self.assertLessEqual(run.history["t"][-1], 4e-3)  # the step in hand ends later
        self.assertLessEqual(counts.steps - run.history["steps"][-1], 1)
        self.assertTrue((np.diff(run.events["t"]) >= 0.0).all() and len(run.events["t"]) > 0)
        self.assertAlmostEqual(run.table("frames")["kinetic_energy"][-1], energy.kinetic, delta=1e-12 * energy.kinetic)
        self.assertEqual(run.obstacle_points(0, 0.0).tolist(), [[-1.0, 0.0], [1.0, 0.0]])
        with self.assertRaises(IndexError):
            run.positions(9)
        with self.assertRaises(IndexError):
            run.obstacle_points(1, 0.0)

    def test_one_that_is_not_finished_stays_a_part(self):
        with dem.Simulation(disc(), floor()) as simulation, self.assertRaises(RuntimeError):
            with simulation.record(self.folder / "a.vtkhdf", 1e-4):
                simulation.advance(1e-3)
                raise RuntimeError
        self.assertTrue((self.folder / "a.part.vtkhdf").exists())
        self.assertFalse((self.folder / "a.vtkhdf").exists())

    def test_pictures(self):
        import matplotlib
        matplotlib.use("Agg")
        with dem.Simulation(disc(), floor()) as simulation, simulation.record(self.folder / "a.vtkhdf", 1e-3):
            simulation.advance(3e-3)
        run = dem.read(self.folder / "a.vtkhdf")
        run.plot(1).figure.savefig(self.folder / "a.png")
        run.animate(self.folder / "a.gif")
        self.assertGreater((self.folder / "a.png").stat().st_size, 5000)
        self.assertGreater((self.folder / "a.gif").stat().st_size, 5000)

    def test_colours_are_those_of_dem_plot(self):
        """By its own numbers. Those of its scale's ends as its pictures have them, for what is made of the numbers."""
        text = (INPUTS.parent / "drivers" / "plot" / "palette.c").read_text(encoding="utf-8")
        rows = re.search(r"\[DIVERGING\] = \{(\{.*?\})\},.*?\[SEQUENTIAL\] =\s*\{(\{.*?\})\}", text, re.S)
        for row, stops, ends in zip(rows.groups(), (dem.picture.DIVERGING, dem.picture.SEQUENTIAL),
                                    (((0, 71, 143), (138, 28, 16)), ((236, 222, 144), (42, 36, 92)))):
            kept = [tuple(map(int, stop.split(","))) for stop in re.findall(r"\{([^{}]*)\}", row)]
            self.assertEqual(kept, list(stops))
            made = np.round(255 * dem.picture.palette(stops)([0.0, 1.0])[:, :3]).astype(int)
            np.testing.assert_array_equal(made, ends)

    def test_the_solid_side_of_obstacles_is_filled(self):
        """Of a floor what is below, of a box what is outside, of a block what is inside."""
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
        block = [(-0.02, 0.0), (-0.02, 0.01), (0.02, 0.01), (0.02, 0.0), (-0.02, 0.0)]
        for obstacle, solid, free in ((floor(), (0.0, -0.01), (0.025, 0.02)),
                                      (dem.Obstacle(block), (0.0, 5e-3), (0.0, -5e-3)),
                                      (dem.box(-0.022, -0.001, 0.022, 0.2), (0.0, -5e-3), (0.021, 0.0))):
            path = self.folder / f"{len(obstacle.points)}{solid}.vtkhdf"
            with dem.Simulation(disc(height=0.04), obstacle) as simulation, simulation.record(path, 1e-4):
                simulation.advance(1e-4)
            ax = dem.read(path).plot(0)
            ax.set(xlim=(-0.03, 0.03), ylim=(-0.02, 0.06))
            ax.figure.canvas.draw()
            image = np.asarray(ax.figure.canvas.buffer_rgba())[::-1]
            for place, colour in ((solid, (67, 67, 69)), (free, (255, 255, 255))):
                column, row = np.round(ax.transData.transform(place)).astype(int)
                self.assertEqual(tuple(map(int, image[row, column, :3])), colour, (len(obstacle.points), place))
            pyplot.close(ax.figure)


if __name__ == "__main__":
    DEM_BATCH = pathlib.Path(sys.argv.pop(1)).resolve()
    os.environ["DEM_BATCH"] = str(DEM_BATCH)
    INPUTS = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()

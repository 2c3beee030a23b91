#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A run that is stopped, killed, requeued or continued gives what an undisturbed one gives: `test_resume.py DEM_BATCH`.

Where h5py is there, outputs are compared with compare.py, otherwise only their results."""
import json
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import zlib

try:
    import compare
    import h5py
except SystemExit:  # it needs h5py
    compare = h5py = None

DEM_BATCH = None
SECONDS = 120  # more than any of these runs takes, under a sanitizer too

# Lands on a rough slope and slides down it: impacts, stick and slip; boundaries, probes, events and peaks.
DECK = """
&run t_end = 4e-3, title = 'slide' /
&material youngs_modulus = 1e6, density = 1000, damping_time = 1e-6 /
&body shape = 'rectangle', size = 0.04, 0.02, spacing = 5e-3, velocity = 3, -2, clearance = 1e-5, position = -0.02, 0,
  outline = 'lattice' /
&obstacle points = -0.3, 0.03, 0.3, -0.03, profile = 'rough', roughness = 1e-4, correlation = 2e-2, resolution = 2e-3,
          restitution = 0.6, friction = 0.4, velocity = 0.5, 0.1 /
&solver checkpoint_steps = 7 /
&probe name = 'corner', number = 0, every = 3 /
&output name = 'a', frame_interval = 2.5e-4, precision = 'double', events = .true., peak_every = 3 /
"""
REST = """
&run t_end = 1, residual = 1e-3 /
&material youngs_modulus = 1e6, density = 1000 /
&body shape = 'rectangle', size = 0.04, 0.04, spacing = 1e-2 /
&boundary where = 'side', side = 'top' /
&solver checkpoint_steps = 50 /
&output name = 'a', frame_interval = 1 /
"""
BRITTLE = """
&run t_end = 6e-4 /
&material youngs_modulus = 1e9, density = 2500, fracture = 'stress', strength = 4e6 /
&body shape = 'disc', radius = 0.03, spacing = 3e-3, jitter = 0.2, velocity = 0, -8, clearance = 1e-4 /
&obstacle points = -0.3, -0.02, 0, 0, 0.3, -0.03, restitution = 0, friction = 0.3 /
&solver checkpoint_steps = 80 /
&output name = 'a', frame_interval = 5e-5, precision = 'double', events = .true. /
"""
# Some 5,600 nodes, of which not every step has a row.
LARGE = """
&run t_end = 4e-3 /
&material youngs_modulus = 1e6, density = 1000 /
&body shape = 'rectangle', size = 0.2, 0.2, spacing = 2.9e-3, velocity = 0, -5, clearance = 1e-3 /
&obstacle points = -1, 0, 1, 0 /
&solver method = 'verlet', checkpoint_steps = 100 /
&output name = 'a', frame_interval = 1 /
"""
FILES = {"a.vtkhdf", "a.obstacle.vtkhdf", "a.body.vtkhdf", "a.json", "a.checkpoint"}
WAY_OUT = "move it away, change 'name' in &output, or use --overwrite"
OFTEN = ("--checkpoint-interval", "1e-9")  # every checkpoint goes to disk
AT_ONCE = ("--max-wall", "1e-9")           # a checkpoint further with each command


def lasting(result):
    """A result without what is of its process."""
    return {key: value for key, value in result.items() if not key.startswith("wall_") and key not in ("output", "set")}


class Case(unittest.TestCase):
    maxDiff = 4000

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.put(DECK)

    def put(self, text, name="a.nml"):
        (self.folder / name).write_text(text, encoding="utf-8")

    def start(self, *arguments, outdir="."):
        (self.folder / outdir).mkdir(exist_ok=True)
        return subprocess.Popen([DEM_BATCH, "a.nml", "--outdir", outdir, *arguments], cwd=self.folder, text=True,
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def call(self, code, *arguments, outdir=".", stderr=""):
        process = self.start(*arguments, outdir=outdir)
        out, err = process.communicate(timeout=SECONDS)
        self.assertEqual(err, stderr)
        self.assertEqual(process.returncode, code, out)
        return out

    def files(self, outdir="."):
        return {path.name for path in (self.folder / outdir).iterdir() if path.is_file()} - {"a.nml"}

    def result(self, outdir="."):
        return json.loads((self.folder / outdir / "a.json").read_text(encoding="utf-8"))

    def expect_same(self, outdir, files=FILES):
        """Against the undisturbed run, in `whole`."""
        self.assertEqual(lasting(self.result(outdir)), lasting(self.result("whole")))
        self.assertEqual(self.files(outdir), files)
        for name in files & {"a.vtkhdf", "a.obstacle.vtkhdf"} if compare is not None else ():
            paths = [self.folder / folder / name for folder in ("whole", outdir)]
            with h5py.File(paths[0], "r") as first, h5py.File(paths[1], "r") as second:
                whole = compare.objects(first)
                self.assertGreater(len(whole), 3)
                self.assertEqual(list(compare.compare(whole, compare.objects(second), paths)), [])

    def go_on(self, outdir, *arguments):
        """Until it is done; how many commands that takes."""
        for n in range(1, 1000):
            process = self.start(*arguments, outdir=outdir)
            out, err = process.communicate(timeout=SECONDS)
            self.assertEqual(err, "")
            if process.returncode == 0:
                return n
            self.assertEqual(process.returncode, 75, out)
            self.assertEqual(self.result(outdir)["status"], "stopped")
        self.fail("it does not come to an end")


class Cuts(Case):
    def test_at_every_checkpoint(self):
        self.put(DECK.replace("events = .true.", "closure = 1e-9, events = .true.") + "&contact rest_speed = 1e-9 /\n")
        log = self.call(0, outdir="whole")
        result = self.result("whole")
        self.assertRegex("\n".join(result["warnings"]), r"^'rest_speed' .*\nthe energy ledger is open by ")
        self.assertGreaterEqual(result["impacts"], 100)
        self.assertGreaterEqual(result["slips"], 5)
        self.assertGreater(result["sticks"], 10)
        n = self.go_on("cut", *AT_ONCE)
        self.assertGreaterEqual(n, result["steps"] // 7)
        self.expect_same("cut")
        self.assertNotIn("resumed", log)

    def test_checkpoints_on_disk_change_nothing(self):
        self.call(0, outdir="whole")
        log = self.call(0, *OFTEN, outdir="often")
        self.assertGreater(log.count("\ncheckpoint t "), 20)
        self.expect_same("often")

    def test_other_threads_and_kernels(self):
        self.put(DECK.replace("checkpoint_steps = 7", "checkpoint_steps = 20"))
        self.call(0, outdir="whole")
        shifts = [("--set", f"solver.kernel='{kernel}'", "--set", f"solver.threads={threads}")
                  for kernel, threads in (("portable", 2), ("auto", 1), ("portable", 1), ("auto", 2))]
        for k in range(1000):
            process = self.start(*AT_ONCE, *shifts[k % len(shifts)], outdir="cut")
            process.communicate(timeout=SECONDS)
            if process.returncode != 75:
                break
        self.assertEqual(process.returncode, 0)
        result, whole = lasting(self.result("cut")), lasting(self.result("whole"))
        self.assertEqual({key for key in result if result[key] != whole[key]}, {"run"}, "which has kernel and threads")

    def test_a_history_at_an_interval(self):
        self.call(0, outdir="dense")
        self.put(DECK.replace("peak_every = 3", "peak_every = 3, history_interval = 1e-4"))
        self.call(0, outdir="whole")
        self.assertGreater(self.go_on("cut", *AT_ONCE), 10)
        self.expect_same("cut")
        dense, whole = self.result("dense"), self.result("whole")
        self.assertEqual(whole["rebound"], dense["rebound"])
        self.assertLessEqual(whole["strain_max"]["strain"], dense["strain_max"]["strain"])
        if compare is None:
            return
        with h5py.File(self.folder / "dense/a.vtkhdf") as all_rows, h5py.File(self.folder / "whole/a.vtkhdf") as file:
            every, t = list(all_rows["history/t"]), list(file["history/t"])
            due = [every[0]] + [b for a, b in zip(every, every[1:]) if int(b / 1e-4) > int(a / 1e-4)]
            self.assertEqual(t, due)
            self.assertGreater(len(every), 2 * len(t))
            elastic = dict(zip(every, all_rows["history/elastic"]))
            self.assertEqual(list(file["history/elastic"]), [elastic[instant] for instant in t])

    def test_a_large_body_has_rows_by_its_size(self):
        self.put(LARGE)
        self.assertRegex(self.call(0, outdir="whole"), "\nlooks      rows of /history .* s apart by size.*, for peaks every 256 steps by size")
        self.call(0, "--set", "run.t_end=1.3e-3", outdir="longer")
        self.call(0, outdir="longer")
        self.expect_same("longer")
        self.assertGreater(self.go_on("cut", *AT_ONCE), 5)
        self.expect_same("cut")
        self.assertIn("\nlooks      a row of /history each step, for peaks every 256 steps by size",
                      self.call(0, "--set", "output.history_interval=0", outdir="dense"))
        dense, whole = self.result("dense"), self.result("whole")
        self.assertEqual((dense["history_interval"], dense["peak_every"], whole["peak_every"]), (0, 256, 256))
        self.assertEqual(dense["rebound"], whole["rebound"])
        if compare is None:
            return
        with h5py.File(self.folder / "dense/a.vtkhdf") as all_rows, h5py.File(self.folder / "whole/a.vtkhdf") as file:
            every, t, h = list(all_rows["history/t"]), list(file["history/t"]), file["history/h"][-1]
            self.assertAlmostEqual(whole["history_interval"], 64 * h, delta=1e-9 * h)
            self.assertEqual(float(file["provenance/history_interval"].asstr()[()]), whole["history_interval"])
            self.assertEqual(int(file["provenance/peak_every"].asstr()[()]), 256)
            due = [every[0]] + [b for a, b in zip(every, every[1:])
                                if int(b / whole["history_interval"]) > int(a / whole["history_interval"])]
            self.assertEqual(t, due)
            self.assertGreater(len(every), 60 * (len(t) - 1))

    def test_a_run_to_rest(self):
        self.put(REST)
        self.call(0, outdir="whole")
        self.assertGreater(self.go_on("cut", *AT_ONCE), 3)
        self.expect_same("cut", FILES - {"a.obstacle.vtkhdf"})

    def test_a_body_that_breaks(self):
        self.put(BRITTLE)
        log = self.call(0, outdir="whole")
        self.assertRegex(log, r"\nbalance .* fracture [1-9]\d+\.?\d* J; error")
        self.assertRegex(log, r"\nfracture   [1-9]\d+ of \d+ triangles and [1-9]\d+ of \d+ springs are broken, which")
        self.assertGreater(self.result("whole")["broken_triangles"], 10)
        self.assertRegex(log, r"\nfragments  [1-9]\d*; the largest has 0?\.?\d+ of the mass, single nodes ")
        self.assertGreater(self.result("whole")["energy"]["fracture"], 10.0)
        # The error of the integrator: 1.1e-6 at its rtol of 1e-6, 3.8e-9 at 1e-10, where one of the ledger would stay.
        self.assertLess(abs(self.result("whole")["closure"]), 2e-6)
        self.call(0, "--set", "solver.rtol=1e-10", outdir="fine")
        self.assertLess(abs(self.result("fine")["closure"]), 1e-8)
        self.expect_breaks("whole", 0.05)
        self.call(0, "--set", "contact.bodies='others'", outdir="alone")
        self.expect_breaks("alone", 0.0)
        self.assertGreater(self.go_on("cut", *AT_ONCE), 10)
        self.expect_same("cut")
        self.call(0, "--set", "solver.kernel='portable'", "--set", "solver.threads=2", outdir="other")
        other, whole = lasting(self.result("other")), lasting(self.result("whole"))
        self.assertEqual({key for key in other if other[key] != whole[key]}, {"run"}, "which has kernel and threads")

    def test_a_body_that_softens(self):
        self.put(BRITTLE.replace("strength = 4e6", "strength = 3e6, fracture_energy = 150"))
        self.call(0, outdir="whole")
        self.assertGreater(self.result("whole")["broken_triangles"], 5)
        self.assertLess(abs(self.result("whole")["closure"]), 1e-6)
        if compare is not None:
            with h5py.File(self.folder / "whole" / "a.vtkhdf", "r") as file:
                damage = file["VTKHDF/PointData/damage"][...]
                self.assertTrue(damage.min() == 0.0 and damage.max() <= 1.0)
                self.assertTrue(((damage > 0.0) & (damage < 0.3)).any(), "something has softened a little")
        self.assertGreater(self.go_on("cut", *AT_ONCE), 10)
        self.expect_same("cut")
        self.call(0, "--set", "solver.kernel='portable'", "--set", "solver.threads=2", outdir="other")
        other, whole = lasting(self.result("other")), lasting(self.result("whole"))
        self.assertEqual({key for key in other if other[key] != whole[key]}, {"run"}, "which has kernel and threads")

    def expect_breaks(self, run, pushed):
        """The table has each triangle that is broken at the end, once, in the order of time, and all of the energy but
        what was taken with faces that pushed each other, this share at most: where a body touches itself."""
        if compare is None:
            return
        with h5py.File(self.folder / run / "a.vtkhdf", "r") as file:
            table, triangles = file["breaks"], sorted(file["breaks/triangle"][...])
            last = file["fracture/triangles"][-len(file["lattice/triangles"]):]
            self.assertEqual(triangles, [k for k, broken in enumerate(last) if broken])
            self.assertTrue(all(table["t"][1:] >= table["t"][:-1]))
            taken = file["history/fracture"][-1]
            self.assertLessEqual(sum(table["energy"]), taken * (1.0 + 1e-12))
            self.assertGreaterEqual(sum(table["energy"]), taken * (1.0 - pushed - 1e-12))
            result, frames = self.result(run), file["fragments/frame_offset"]
            self.assertEqual(result["breaks"], len(triangles))
            first = result["first_break"]
            self.assertEqual([first["t"], first["x"]], [table["t"][0], list(table["x"][0])])
            before = [t < first["t"] for t in file["history/t"]].index(False) - 1
            self.assertEqual(first["load"], {"force": list(file["history/obstacle_reaction"][before, 0]), "obstacle": 0})
            self.assertEqual(result["fragments"], frames[-1] - frames[-2])
            self.assertAlmostEqual(result["crack_length"], file["history/crack_length"][-1], delta=1e-15)

    def test_a_later_end(self):
        """Three ends, each continued; that of the whole run is one more."""
        self.call(0, outdir="whole")
        for t_end in ("2e-4", "1.1e-3", "3.9999e-3"):
            with self.subTest(t_end):
                self.call(0, "--set", f"run.t_end={t_end}", outdir=t_end)
                self.assertEqual(self.files(t_end), FILES)
                self.assertIn("\nresumed    from ", self.call(0, outdir=t_end))
                self.expect_same(t_end)
        self.assertIn("\nresumed    from ", self.call(0, "--set", "run.title='other'", outdir="whole"))
        self.call(7, "--set", "run.t_end=2e-3", outdir="whole", stderr="whole/a.vtkhdf: error: the file exists, and its "
                  f"run goes beyond t_end = 0.002 s; {WAY_OUT}\n")


class Signals(Case):
    def setUp(self):
        super().setUp()
        self.put(DECK.replace("spacing = 5e-3", "spacing = 3e-3").replace("checkpoint_steps = 7", "checkpoint_steps = 20"))

    def lines(self, process, word):
        """Reads the log up to a line that has the word."""
        read = []
        for line in process.stdout:
            read.append(line)
            if word in line:
                return read
        self.fail("".join(read))

    def test_the_end_is_asked_for_at_any_moment(self):
        self.call(0, outdir="whole")
        seconds = self.result("whole")["wall_seconds"]
        chance = random.Random(1)
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGXCPU, signal.SIGUSR2):
            with self.subTest(number):
                for k in range(50):
                    process = self.start(outdir=number.name)
                    self.lines(process, "output ")
                    if number == signal.SIGTERM or k == 0:
                        time.sleep(chance.uniform(0.0, 0.5 * seconds))
                        process.send_signal(number)
                    out, err = process.communicate(timeout=30)
                    self.assertEqual(err, "")
                    if process.returncode == 0:
                        break
                    self.assertEqual(process.returncode, 75, out)
                    self.assertRegex(out, rf"\nstopped    at \S+ s by {number.name}; the same command goes on from "
                                          rf"{number.name}/a.checkpoint\n")
                    self.assertNotIn("a.lock", self.files(number.name))
                    result = self.result(number.name)
                    self.assertEqual((result["status"], result["exit_code"]), ("stopped", 75))
                    self.assertEqual(result["message"], f"a.nml: stopped by {number.name}")
                self.assertEqual(process.returncode, 0, "it comes to an end")
                self.expect_same(number.name)

    def test_killed_behind_a_checkpoint(self):
        self.call(0, outdir="whole")
        process = self.start(*OFTEN, outdir="killed")
        for _ in range(5):
            self.lines(process, "checkpoint t ")
        process.kill()
        process.communicate()
        self.assertIn("a.lock", self.files("killed"))
        self.assertIn("\nresumed    from ", self.call(0, outdir="killed"))
        self.expect_same("killed")

    def test_a_checkpoint_is_asked_for(self):
        process = self.start()
        self.lines(process, "output ")
        process.send_signal(signal.SIGUSR1)
        t = float(re.search(r"checkpoint t (\S+) s in a.checkpoint", self.lines(process, "checkpoint t ")[-1])[1])
        self.assertTrue({"a.checkpoint", "a.part.vtkhdf"} <= self.files())
        process.kill()
        process.communicate()
        log = self.call(0)
        self.assertGreaterEqual(float(re.search(r"\nresumed    from (\S+) s, a.checkpoint\n", log)[1]), t)

    def test_decks_behind_a_stopped_one_are_not_begun(self):
        self.put(DECK.replace("'a'", "'b'"), "b.nml")
        out = self.call(75, "b.nml", *AT_ONCE)
        results = [json.loads(line) for line in out.splitlines() if line.startswith("{")]
        self.assertEqual([(r["deck"], r["exit_code"], r["message"]) for r in results],
                         [("a.nml", 75, "a.nml: stopped by --max-wall"), ("b.nml", 75, "b.nml: not begun")])


class Refusals(Case):
    def setUp(self):
        super().setUp()
        self.call(75, "--max-wall", "1e-9")  # at the checkpoint of t = 0
        self.call(75, "--max-wall", "1e-9")

    def state(self):
        return {name: (self.folder / name).read_bytes() for name in self.files()}

    def test_another_problem(self):
        before = self.state()
        for setting, then, group, now in (("material.density=1001", "density = 1000", "material", "density = 1001"),
                                          ("output.frame_interval=5e-4", "frame_interval = 0.00025", "output",
                                           "frame_interval = 0.0005"),
                                          ("solver.rtol=1e-7", "rtol = 1e-06", "solver", "rtol = 1e-07"),
                                          ("probe.every=4", "every = 3", "probe", "every = 4")):
            with self.subTest(setting):
                where = "a.checkpoint"
                why = f"the run that it is of has {then} in &{group}, this one has {now}; {WAY_OUT}"
                if group in ("material", "solver"):
                    where = "a.vtkhdf"
                    why = f"the unfinished run in a.part.vtkhdf has {then} in &{group}, this one has {now}; {WAY_OUT}"
                self.call(7, "--set", setting, stderr=f"{where}: error: {why}\n")
        self.assertEqual(self.state(), before)
        (self.folder / "a.part.vtkhdf").unlink()
        self.call(7, "--set", "material.density=1001", stderr="a.checkpoint: error: the run that it is of has "
                  f"density = 1000 in &material, this one has density = 1001; {WAY_OUT}\n")
        self.call(7, "--set", "run.t_end=1e-9", stderr="a.checkpoint: error: the run is at "
                  f"{self.result()['t']:g} s already, beyond t_end = 1e-09 s; {WAY_OUT}\n")

    def test_it_is_set_aside(self):
        before = self.state()
        self.assertNotIn("resumed", self.call(0, "--set", "output.frame_interval=5e-4", "--overwrite"))
        self.assertEqual(self.state(), self.state() | {name.replace("a.", "a.old.", 1): text for name, text in before.items()})
        self.call(0, "--set", "output.name='a.old'")
        self.assertEqual(json.loads((self.folder / "a.old.json").read_text(encoding="utf-8"))["status"], "done")

    def test_the_one_before_serves_where_one_is_damaged(self):
        self.call(0, outdir="whole")
        text = (self.folder / "a.checkpoint").read_bytes()
        for damage in (b"", text[:100] + bytes([text[100] ^ 1]) + text[101:]):
            with self.subTest(len(damage)):
                (self.folder / "a.checkpoint").write_bytes(damage)
                self.assertIn("\nresumed    from 0 s", self.call(75, *AT_ONCE))
                self.assertEqual((self.folder / "a.checkpoint").read_bytes(), text, "the same checkpoint again")
                self.assertTrue({"a.checkpoint", "a.checkpoint.prev"} <= self.files())
        (self.folder / "a.checkpoint").write_bytes(text[:-1])
        self.call(0)
        self.assertEqual(lasting(self.result()), lasting(self.result("whole")))

    def test_both_are_damaged(self):
        (self.folder / "a.checkpoint").write_bytes(b"x" * 1000)
        (self.folder / "a.checkpoint.prev").write_bytes(b"y")
        before = self.state()
        process = self.start()
        _, err = process.communicate(timeout=SECONDS)
        self.assertEqual(process.returncode, 5)
        self.assertRegex(err, r"\Aa\.checkpoint: error: .*use --overwrite\n\Z")
        self.assertEqual(self.state(), before)
        self.assertIn("set aside as a.old.vtkhdf\n", self.call(0, "--overwrite"))

    def test_a_segment_is_missing(self):
        self.call(75, "--max-wall", "1e-9")
        (self.folder / "a.00001.vtkhdf").unlink()
        process = self.start()
        _, err = process.communicate(timeout=SECONDS)
        self.assertEqual(process.returncode, 5)
        self.assertRegex(err, r"\Aa\.vtkhdf: error: .*a\.00001\.vtkhdf.*--overwrite sets the output aside and begins anew\n\Z")
        self.assertIn("set aside as a.old.vtkhdf\n", self.call(0, "--overwrite"))
        self.assertEqual(self.result()["status"], "done")

    def test_another_version(self):
        """The checkpoint is given another version's name, of the same length, and a checksum that fits."""
        self.call(0, outdir="whole")
        versions = self.result()["versions"]
        other = versions.replace("dem 0", "dem 9")
        text = (self.folder / "a.checkpoint").read_bytes().replace(versions.encode(), other.encode())
        (self.folder / "a.checkpoint").write_bytes(with_checksum(text))
        self.call(7, stderr=f"a.checkpoint: error: it is of '{other}', this is '{versions}'; --resume-anyway goes on all the same\n")
        self.call(75, "--resume-anyway", "--max-wall", "1e-9")
        self.call(0)
        result, whole = lasting(self.result()), lasting(self.result("whole"))
        self.assertEqual(result, whole)
        if h5py is None:
            return
        with h5py.File(self.folder / "a.vtkhdf", "r") as file:
            self.assertEqual(file["/provenance/versions"].asstr()[()], f"{other}\n{versions}")

    def test_a_failed_run_keeps_its_state(self):
        text = DECK.replace("'a'", "'storm'") + "&contact max_impacts = 2 /\n"
        self.put(text)
        process = self.start()
        _, first = process.communicate(timeout=SECONDS)
        self.assertEqual(process.returncode, 4)
        self.assertTrue({"storm.checkpoint", "storm.part.vtkhdf", "storm.json"} <= self.files())
        process = self.start()
        out, again = process.communicate(timeout=SECONDS)
        self.assertEqual((process.returncode, again), (4, first))
        self.assertIn("\nresumed    from ", out)
        self.put(text.replace("max_impacts = 2", "max_impacts = 1000"))
        self.assertIn("\nresumed    from ", self.call(0))


def with_checksum(text):
    """src/base/checkpoint_entries.c: the checksum, of the file with 0 in its place, is behind magic, byte order, format, size and number."""
    blank = text[:32] + bytes(8) + text[40:]
    return text[:32] + zlib.crc32(blank).to_bytes(8, sys.byteorder) + text[40:]


if __name__ == "__main__":
    DEM_BATCH = os.path.abspath(sys.argv.pop(1))
    unittest.main()

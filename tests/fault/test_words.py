#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""HDF5 and SUNDIALS do not speak to the user: `test_words.py DEM_BATCH`. Runs end for the numbers' sake, on disks without
room, on input and output that cannot be read or is damaged. Each says so in one line of ours with the cause and the documented
exit code, or, where the damage does no harm, nothing. Needs the standard library only."""
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import unittest

SEED = 20261122
SECONDS = 120
RAW = re.compile(r"HDF5-DIAG|#0\d\d:|HDF5: infinite|\[ERROR\]|\[WARNING\]|SUNDIALS|ARKODE|ARKode|ARK_[A-Z]|ERKStep|ARKStep|"
                 r"H5[A-Z][a-z_]|Assertion|\0")
VERSION = re.compile(r'SUNDIALS(": ")? ?[\d.]+')  # stands in the log of every run
DONE, INVALID, NUMERICS, IO, MEMORY, TAKEN, AGAIN = 0, 3, 4, 5, 6, 7, 75

# A disc slides over the ground; every step but the first few can end with a contact event.
BASE = """&run t_end = 6e-4 /
&material youngs_modulus = 1e7, density = 1050 /
&body shape = 'disc', radius = 0.03, spacing = 0.01, outline = 'lattice', clearance = 1e-4, velocity = 2, -5 /
&obstacle points = -0.3, -0.02, -0.05, 0.004, 0, -0.01, 0.045, 0.01, 0.3, -0.02, restitution = 0.3, friction = 0.4 /
&solver checkpoint_steps = 24 /
&output name = 'disc', frame_interval = 2e-4, events = T /
"""
READS = """&run t_end = 1e-4 /
&body shape = 'file', file = 'lattice.h5' /
&output name = 'read' /
"""
LONGER = ("--set", "run.t_end=8e-4")  # goes on from the checkpoint of a run that is done
SLOW = ("--set", "solver.rtol=1e-9", "--set", "run.t_end=5")  # until it is stopped


class Words(unittest.TestCase):
    program = ""

    def setUp(self):
        self.folder = self.make_folder()
        self.put(BASE)

    def make_folder(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        return pathlib.Path(folder.name)

    def put(self, deck):
        (self.folder / "deck.nml").write_text(deck, encoding="ascii")

    def run_deck(self, *options, prepare=None):
        return subprocess.run([self.program, *options, "deck.nml"], cwd=self.folder, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, errors="replace", timeout=SECONDS, preexec_fn=prepare,
                              check=False)

    def ends(self, codes, *options, prepare=None, lines=1):
        """One of the codes; one line of ours, or none of a run that did not fail. Returns what was written to stderr."""
        done = self.run_deck(*options, prepare=prepare)
        self.assertIn(done.returncode, codes, done.stderr)
        for line in done.stderr.splitlines():
            self.assertIn(": error: ", line)
            self.assertIsNone(RAW.search(line), line)
        self.assertIsNone(RAW.search(VERSION.sub("", done.stdout)))
        self.assertEqual(done.stderr.count("\n"), 0 if done.returncode in (DONE, AGAIN) else lines, done.stderr)
        return done.stderr

    # ---- numbers

    def test_numbers(self):
        edits = {
            "a storm": ("&solver", "&contact max_impacts = 1 /\n&solver", r"had more than 1 contact events within \S+ s"),
            "below rounding": ("2, -5", "0, -1e200", r"the step from t = \S+ s fails: rounding alone is more than rtol allows"),
            "no step short enough": ("&run ", "&run gravity = 0, -1e70, ",
                                     r"the step from t = \S+ s fails: no step is short enough for rtol; the error is largest at node \d+, at \(\S+, \S+\) m"),
            "not finite": ("&run ", "&run gravity = 0, -1e300, ", r"forces overflow at t = 0 s"),
            "a step too long": ("checkpoint_steps = 24", "fixed_step = 1e-3", r"the fixed step of 0.001 s is \S+ times the \S+ s up to which"),
        }
        for name, (old, new, cause) in edits.items():
            with self.subTest(name):
                self.assertEqual(BASE.count(old), 1)
                self.put(BASE.replace(old, new).replace("'disc', frame", f"'{len(name)}', frame"))
                message = self.ends([NUMERICS])
                self.assertRegex(message, rf"\Adeck\.nml: error: [^\n]*{cause}[^\n]*\n\Z")

    # ---- room

    def test_no_room(self):
        self.assertEqual(self.ends([DONE]), "")
        largest = max(path.stat().st_size for path in self.folder.iterdir())
        for size in [0, 1, 1000] + [largest * k // 5 for k in range(1, 6)]:
            with self.subTest(size):
                self.folder = self.make_folder()
                self.put(BASE)
                message = self.ends([IO], prepare=lambda n=size: resource.setrlimit(resource.RLIMIT_FSIZE, (n, n)),
                                    lines=2 if size < 2 else 1)  # there is no room for NAME.json either
                self.assertRegex(message, r"no room|File too large|cannot be")

    # ---- files

    def damages(self, data, n):
        """Short ones, and such with some bytes changed; most of the latter near the beginning, where HDF5 has its words."""
        chance = random.Random(SEED)
        yield b""
        yield b"This is no file of HDF5.\n"
        for _ in range(n):
            yield data[:chance.randrange(len(data))]
        for k in range(3 * n):
            spoilt = bytearray(data)
            for _ in range(1 + k % 8):
                spoilt[int(len(data) * chance.random() ** 3)] = chance.randrange(256)
            yield bytes(spoilt)

    def spoil(self, path, codes, *options, n=6):
        """Runs of the folder, each with another damage to this file of it. Returns how many failed."""
        whole, name, failed = self.folder, path.name, 0
        for k, data in enumerate(self.damages(path.read_bytes(), n)):
            with self.subTest(file=name, damage=k):
                self.folder = self.make_folder()
                shutil.copytree(whole, self.folder, dirs_exist_ok=True)
                (self.folder / name).write_bytes(data)
                failed += self.ends([DONE, *codes], *options) != ""
        self.folder = whole
        return failed

    def test_an_input(self):
        self.assertEqual(self.ends([DONE]), "")
        (self.folder / "disc.vtkhdf").rename(self.folder / "lattice.h5")
        self.put(READS)
        self.assertEqual(self.ends([DONE]), "")
        for path in self.folder.glob("read*"):
            path.unlink()
        self.assertGreater(self.spoil(self.folder / "lattice.h5", [INVALID, MEMORY]), 10)
        (self.folder / "lattice.h5").unlink()
        self.assertRegex(self.ends([INVALID]), "No such file or directory")
        (self.folder / "lattice.h5").mkdir()
        self.ends([INVALID])

    def test_an_output_that_goes_on(self):
        self.assertEqual(self.ends([DONE]), "")
        for name in ("disc.vtkhdf", "disc.checkpoint"):
            self.spoil(self.folder / name, [INVALID, IO, MEMORY, TAKEN], *LONGER)
        self.assertEqual(self.ends([DONE], *LONGER), "")

    def test_segments_and_a_part(self):
        self.assertEqual(self.ends([AGAIN], *SLOW, "--max-wall", "1"), "")
        for path in sorted(self.folder.glob("*.vtkhdf")):
            self.spoil(path, [IO, MEMORY, TAKEN, AGAIN], *SLOW, "--max-wall", "0.01", n=3)

    def test_a_folder_in_the_way(self):
        (self.folder / "disc.part.vtkhdf").mkdir()
        (self.folder / "disc.part.vtkhdf" / "kept").touch()
        self.ends([IO, TAKEN])


if __name__ == "__main__":
    Words.program = os.path.abspath(sys.argv.pop(1))
    unittest.main()

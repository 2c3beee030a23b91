#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Every deck on ranks: `test_decks.py MPIRUN DEM_BATCH INPUTS_FOLDER COMPARE [NAMES]`.

All decks of the folder, some of them coarser and all shorter, run on 1, 2, 3, 4 and 7 ranks with 1 and 2 threads each,
with 1 in slabs, if the deck suits, and with 2 by as many writers as ranks: all data and the last checkpoint are those of
one process. Then a run with many impacts goes on from each of its checkpoints on another number of ranks."""
import re
import shutil
import subprocess
import sys
import time
import unittest

import test_batch

test_batch.SECONDS = 300  # a run may take, on more ranks than there are cores
RANKS = (1, 2, 3, 4, 7)
# When a deck ends, in s, and what is set otherwise: some 300 steps, with contacts; or so weak that much breaks. A deck
# that is not listed runs for a hundredth of its time.
DECKS = {
    "brazilian_disc": (2e-3, "body.spacing=4e-3", "material(1).strength=10e6"),
    "brittle_disc": (8e-4, "body.spacing=6e-3", "material(1).strength=4e6"),
    "disc": (3e-3, "body.spacing=6e-3"),
    "disc_friction": (3e-3, "body.spacing=7e-3"),
    "every_key": (2e-3,),
    "granular": (0.034, "body.copies=3,2", "body.spacing=1e-2", "body.velocity=0,-4"),
    "hammer": (1.2e-3, "body(1).spacing=5e-3"),
    "kalthoff": (9e-5, "body.spacing=4e-3", "material(1).strength=5e8"),
    "kirsch": (5e-6,),
    "mill": (6e-5, "body.spacing=3e-3"),
    "porous": (2.5e-3, "body.spacing=6e-3"),
    "pulled_strip": (6e-3, "body.spacing=4e-3", "material(1).strength=4e6"),
    "rectangle": (3e-3, "body.spacing=6e-3"),
    "ring_mesh": (1.2e-5, "body.velocity=0,-30"),
    "two_discs": (1.2e-3, "body(1).spacing=6e-3", "body(2).spacing=6e-3"),
}
AT_REST = ("kirsch",)  # which is too short for it, with exit code 4
BREAK = ("brazilian_disc", "brittle_disc", "kalthoff", "pulled_strip")


def settings_of(deck):
    """Those of a deck's file."""
    t_end = float(re.search(r"\bt_end *= *([0-9.e-]+)", deck.read_text(encoding="utf-8"))[1])
    t_end, *others = DECKS.get(deck.stem, (t_end / 100,))
    words = ("output.name=free", "output.measure=.false.", f"run.t_end={t_end}", *others)  # as of a million nodes
    return [word for setting in words for word in ("--set", setting)]


class OnRanks(test_batch.Runs):
    def result(self, outdir):
        found = super().result(outdir)
        found.pop("run")  # a hash of all keys, of which one is the number of threads
        return found

    def assert_same(self, one, other):
        """All files with data, which a run that fails leaves in parts; the checkpoint, if it takes any; and the
        result."""
        files = [sorted(path.name for path in (self.folder / outdir).glob("*.vtkhdf")) for outdir in (one, other)]
        self.assertEqual(*files)
        for name in files[0]:
            paths = [str(self.folder / outdir / name) for outdir in (one, other)]
            done = subprocess.run([sys.executable, test_batch.COMPARE, *paths], capture_output=True, text=True,
                                  check=False)
            self.assertIn(done.returncode, (0, 77), name + ": " + done.stdout)
        checkpoints = [self.folder / outdir / "free.checkpoint" for outdir in (one, other)]
        self.assertEqual(*(path.read_bytes() if path.exists() else None for path in checkpoints))
        self.assertEqual(self.result(one), self.result(other))

    def run_deck(self, n, outdir, deck, *settings, threads=1, writers=1):
        more = ("--set", f"solver.threads={threads}", "--set", "solver.thread_nodes=20", "--writers", str(writers))
        if threads == 1:
            more += ("--slab-nodes", "1")  # where the deck suits
        return self.run_on(n, outdir, *settings, *more, deck=str(deck))


class Decks(OnRanks):
    def compare(self, deck, settings, expected):
        """The number of runs on ranks."""
        runs = 0
        for n in RANKS:
            for threads in (1, 2):
                name = f"{deck.stem}{n}x{threads}"
                writers = n if threads > 1 else 1
                code, _, errors = self.run_deck(n, name, deck, *settings, threads=threads, writers=writers)
                self.assertEqual(code, expected, errors)
                self.assert_same(deck.stem, name)
                runs += 1
        return runs

    def check(self, deck):
        begin = time.monotonic()
        expected = 4 if deck.stem in AT_REST else 0
        settings = settings_of(deck)
        code, _, errors = self.run_deck(0, deck.stem, deck, *settings)
        self.assertEqual(code, expected, errors)
        found = self.result(deck.stem)
        runs = self.compare(deck, settings, expected)
        if deck.stem in BREAK:
            self.assertGreater(found["broken_triangles"], 0)
        elif deck.stem in DECKS and deck.stem not in AT_REST:
            self.assertGreater(found["events"] + found["pairs_most"], 0)
        print(f"{deck.stem:15}{found['steps']:6}{found['events']:8}{found['pairs_most']:7}{found['broken_triangles']:7}"
              f"{runs:6}{time.monotonic() - begin:7.1f}", flush=True)

    def test_data_are_those_of_one_process(self):
        decks = sorted(test_batch.INPUTS.glob("*.nml"))
        self.assertGreaterEqual(len(decks), len(DECKS))
        print("deck            steps  events  pairs broken  runs      s", flush=True)
        for deck in decks:
            with self.subTest(deck.stem):
                self.check(deck)


class Records(OnRanks):
    """A run with many impacts is cut so often that each cut leaves another checkpoint."""
    CUTS = 16

    def test_a_run_goes_on_from_each_of_its_records(self):
        deck = test_batch.INPUTS / "disc_friction.nml"
        t_end = 3e-3
        often = ("--set", "body.spacing=6e-3", "--set", "solver.checkpoint_steps=8", "--set", "output.name=free")
        records = []
        for k in range(1, self.CUTS + 1):
            settings = (*often, "--set", f"run.t_end={t_end * k / self.CUTS}")
            code, _, errors = self.run_deck(0, "one", deck, *settings)
            self.assertEqual(code, 0, errors)
            shutil.copytree(self.folder / "one", self.folder / f"record{k}")
            records.append((self.folder / "one" / "free.checkpoint").read_bytes())
        self.assertEqual(len(set(records)), self.CUTS)
        self.assertGreater(self.result("one")["events"], 100)
        whole = (*often, "--set", f"run.t_end={t_end}")
        for k in range(1, self.CUTS):
            n, threads = RANKS[k % len(RANKS)], 1 + k % 2
            with self.subTest(record=k, ranks=n):
                code, log, errors = self.run_deck(n, f"record{k}", deck, *whole, threads=threads)
                self.assertEqual(code, 0, errors)
                self.assertIn("resumed", log)
                self.assert_same("one", f"record{k}")


if __name__ == "__main__":
    test_batch.begin(*sys.argv[1:5])
    test_batch.SECONDS = 300
    sys.argv[1:] = sys.argv[5:]
    unittest.main()

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What fails on one rank ends all: `test_failing.py LACKING MPIRUN DEM_BATCH INPUTS_FOLDER COMPARE [NAMES]`, LACKING
being lacking.c as a library. There is one line with what has failed, one exit code, no rank waits for another for long,
and the same command then goes on to the data of a run that nothing happened to."""
import pathlib
import random
import resource
import sys
import time
import unittest

import test_batch
from test_batch import Asked

LACKING = None
LONGEST = 10  # s, from the failure to the end
SEED = 20261128


class Failing(Asked):
    def check_failure(self, code, expected, errors, seconds):
        """The failure of a run that took so long from then on."""
        said = [line for line in errors.splitlines() if ": error: " in line]
        self.assertEqual((code, len(said)), (expected, 1), errors)
        self.assertLess(seconds, LONGEST)

    def check_next(self, outdir):
        code, _, errors = self.run_on(0, outdir, *self.LONG)
        self.assertEqual(code, 0, errors)
        self.assert_same("one", outdir)


class Memory(Failing):
    LONG = ("--checkpoint-interval", "0.01")
    WRITERS = 1

    def setUp(self):
        super().setUp()
        self.assertEqual(self.run_on(0, "one", *self.LONG)[0], 0)

    def run_without(self, rank, nth, outdir):
        """A run in which an allocation fails on a rank; 0: none does. Returns how many are asked for."""
        count = self.folder / "count"
        self.within = ("env", f"LD_PRELOAD={LACKING}", f"LACKING_RANK={rank}", f"LACKING_NTH={nth}",
                       f"LACKING_COUNT={count}")
        code, _, errors = self.run_on(self.RANKS, outdir, *self.LONG, "--writers", str(self.WRITERS))
        self.within = ()
        n = int(count.read_text(encoding="ascii"))
        if nth > 0:
            self.check_failure(code, 6, errors, time.time() - count.stat().st_mtime)
            self.assertEqual(n, nth)
        else:
            self.assertEqual(code, 0, errors)
        count.unlink()
        return n

    def fail_each(self, rank, choose):
        n = self.run_without(rank, 0, f"all{rank}")
        self.assertGreater(n, 300)
        for nth in choose(n):
            with self.subTest(rank=rank, allocation=nth, of=n):
                outdir = f"lacks{rank}_{nth}"
                self.run_without(rank, nth, outdir)
                self.check_next(outdir)

    def test_a_rank_runs_out_of_memory_in_the_midst(self):
        self.fail_each(2, lambda n: [n // 2])


class LongerMemory(Memory):
    """From the problem that rank 0 sends to the last row that a rank writes."""
    WRITERS = Memory.RANKS

    def test_a_rank_runs_out_of_memory_in_the_midst(self):
        for rank in range(self.RANKS):
            self.fail_each(rank, lambda n: random.Random(SEED).sample(range(1, n + 1), 20))


class Disk(Failing):
    LONG = ("--set", "run.t_end=6e-4", "--checkpoint-interval", "0.01")

    def fill_disk(self, rank, outdir):
        """Of a rank. Returns what is said of it."""
        run = self.start(outdir)
        resource.prlimit(self.rank_of(run, rank), resource.RLIMIT_FSIZE, (4096, 4096))
        begin = time.monotonic()
        _, errors = run.communicate(timeout=test_batch.SECONDS)
        self.check_failure(run.returncode, 5, errors, time.monotonic() - begin)
        return errors

    def test_the_disk_of_a_writer_is_full(self):
        """Of rank 0, which writes all, and of rank 1 of 3, which writes the second of two stripes."""
        self.assertEqual(self.run_on(0, "one", *self.LONG)[0], 0)
        self.fill_disk(0, "full")
        self.check_next("full")
        short, self.LONG = self.LONG, (*self.LONG, "--writers", "2")
        self.assertRegex(self.fill_disk(1, "fuller"), r"fuller/free\.0000\d\.2of2\.h5: (there is no room for \d+ bytes|cannot be written)")
        self.LONG = short
        self.check_next("fuller")


if __name__ == "__main__":
    LACKING = str(pathlib.Path(sys.argv[1]).resolve())
    test_batch.begin(*sys.argv[2:6])
    sys.argv[1:] = sys.argv[6:]
    unittest.main()

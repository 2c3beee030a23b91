#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""SIGKILL of a random rank at a random time: `test_kill.py MPIRUN DEM_BATCH INPUTS_FOLDER COMPARE [NUMBER [SEED]]`.

A run is killed, and the same command goes on with 1 to 3 ranks and is killed, until one comes to its end: its data are
those of a run that nothing happened to. Of the ranks as many write frames as a lot says. Then another run begins, of free bodies, of bodies that touch, or of one that
breaks, until there were that many kills. Every run that has lost a rank ends within ten seconds."""
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

import test_batch

DECKS = {"free": test_batch.FREE, "touching": test_batch.TOUCHING, "breaking": test_batch.BREAKING}
OPTIONS = ("--checkpoint-interval", "0.02")
LONGEST = 10  # s, from the death of a rank to the end of all
MOST_RANKS = 3


def is_alive(pid):
    try:
        return pathlib.Path("/proc", str(pid), "stat").read_text(encoding="ascii").rsplit(")")[1].split()[0] != "Z"
    except OSError:
        return False


class Kills:
    def __init__(self, folder, number, seed):
        self.folder, self.left, self.chance = folder, number, random.Random(seed)
        self.starts = self.runs = 0
        self.longest = {}  # s, of a run that nothing happens to, by its deck and the number of its ranks
        self.slowest = 0.0  # s, from a kill to the end
        self.by_rank = [0] * MOST_RANKS

    def start(self, deck, n, outdir, writers=1):
        self.starts += 1
        command = [test_batch.MPIRUN, "-n", str(n), test_batch.DEM_BATCH, "--mpi", "--outdir", outdir, *OPTIONS,
                   "--writers", str(writers), f"{deck}.nml"]
        return subprocess.Popen(command, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True)

    def measure(self, deck, n):
        if (deck, n) in self.longest:
            return
        begin = time.monotonic()
        run = self.start(deck, n, f"{deck}{n}")
        said, _ = run.communicate()
        if run.returncode != 0:
            raise RuntimeError(f"an undisturbed run of {deck} on {n} ranks ends with {run.returncode}: {said}")
        self.longest[deck, n] = time.monotonic() - begin

    def kill_one(self, run, n):
        """Whether a rank was there to be killed."""
        ranks = sorted(test_batch.children(run.pid), key=test_batch.number_of)
        if not ranks or run.poll() is not None:
            return False
        victim = self.chance.randrange(len(ranks))
        try:
            os.kill(ranks[victim], signal.SIGKILL)
        except ProcessLookupError:
            return False
        self.by_rank[min(victim, n - 1)] += 1
        self.left -= 1
        return True

    def run_once(self, deck, outdir):
        """Whether the run came to its end, and what was wrong."""
        n = self.chance.randint(1, MOST_RANKS)
        self.measure(deck, n)
        run = self.start(deck, n, outdir, self.chance.randint(1, n))
        time.sleep(self.chance.uniform(0.0, self.longest[deck, n]))
        killed = self.left > 0 and self.kill_one(run, n)
        begin = time.monotonic()
        try:
            said, _ = run.communicate(timeout=LONGEST if killed else None)
        except subprocess.TimeoutExpired:
            alive = [pid for pid in test_batch.children(run.pid) if is_alive(pid)]
            run.kill()
            run.communicate()
            return False, f"{LONGEST} s after a kill mpirun has not ended, {len(alive)} of its {n} ranks are left"
        self.slowest = max(self.slowest, time.monotonic() - begin) if killed else self.slowest
        if not killed and run.returncode != 0:
            return False, f"{n} ranks end with {run.returncode}, which nobody has killed: {said}"
        return run.returncode == 0, ""

    def difference(self, deck, outdir):
        """From an undisturbed run, in words."""
        paths = [str(self.folder / name / "free.vtkhdf") for name in (f"{deck}1", outdir)]
        done = subprocess.run([sys.executable, test_batch.COMPARE, *paths], capture_output=True, text=True, check=False)
        checkpoints = [pathlib.Path(path).with_suffix(".checkpoint").read_bytes() for path in paths]
        if done.returncode not in (0, 77):
            return f"{outdir} has other data than an undisturbed run: {done.stdout}{done.stderr}"
        if checkpoints[0] != checkpoints[1]:
            first = next((k for k, (a, b) in enumerate(zip(*checkpoints)) if a != b), min(map(len, checkpoints)))
            sizes = " and ".join(str(len(bytes_)) for bytes_ in checkpoints)
            return f"the checkpoints of an undisturbed run and {outdir}, {sizes} bytes, differ at byte {first}"
        return ""

    def until_done(self, outdir):
        """What was wrong with a run that is killed again and again."""
        deck = self.chance.choice(sorted(DECKS))
        self.measure(deck, 1)
        self.runs += 1
        for _ in range(1000):
            is_done, wrong = self.run_once(deck, outdir)
            if wrong:
                return wrong
            if is_done:
                return self.difference(deck, outdir)
        return "a run comes to no end"

    def all(self):
        while self.left > 0:
            wrong = self.until_done(f"run{self.runs}")
            if wrong:
                return wrong
        return ""


def main(number, seed):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in DECKS.items():
            (pathlib.Path(folder) / f"{name}.nml").write_text(text, encoding="ascii")
        kills = Kills(pathlib.Path(folder), number, seed)
        wrong = kills.all()
        counts = ", ".join(f"{n} of rank {rank}" for rank, n in enumerate(kills.by_rank))
        print(f"seed {seed}: {number - kills.left} kills ({counts}) in {kills.starts} starts, {kills.runs} runs to "
              f"their end; at most {kills.slowest:.1f} s from a kill to the end")
        if wrong:
            print(wrong)
        return wrong != ""


if __name__ == "__main__":
    test_batch.begin(*sys.argv[1:5])
    NUMBER, SEED = [int(word) for word in sys.argv[5:7]] + [2, 1][len(sys.argv) - 5:]
    sys.exit(main(NUMBER, SEED))

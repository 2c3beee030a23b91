#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""SIGKILL at random moments, and at chosen calls: `test_kill.py FAULTY DEM_BATCH [long]`.

After every kill each published file can be read and a checkpoint that was there still is; the same command, again and
again, ends with the data of a run that nothing happened to. `long`: 1,000 kills at random, and one at each call that changes
a file, before it and, where it is a write, in the middle of it."""
import random
import subprocess
import sys
import time

import machine
import outputs
from decks import OPTIONS, STICKS, TINY

SEED = 20261121
KILLS, KILLS_LONG = 30, 1000
SHARE = 0.0005  # of the calls, by default
CHANGING = ("open", "write", "sync", "rename", "close", "link", "resize")


def seconds_of(problem):
    start = time.monotonic()
    with problem.folder() as folder:
        problem.run(folder)
    return time.monotonic() - start


class Kills:
    """One folder until its run is done, then a fresh one, until there were that many kills."""

    def __init__(self, problem, kills):
        self.problem, self.left = problem, kills
        self.chance, self.longest = random.Random(SEED), seconds_of(problem)
        self.starts = 0

    def run_and_kill(self, folder):
        """Whether the run was killed, and what was wrong."""
        self.starts += 1
        saved = outputs.checkpoints(folder)
        process = self.problem.start(folder)
        try:
            stdout, stderr = process.communicate(timeout=self.chance.uniform(0, 0.8 * self.longest))
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            lost = ["the checkpoint is lost"] if saved and not outputs.checkpoints(folder) else []
            return True, lost + outputs.faults_of_files(folder)
        result = machine.Result(process.returncode, stdout, stderr)
        wrong = machine.faults_of_ending(result, (machine.DONE,))
        return False, wrong or self.problem.faults_of_data(folder)

    def until_done(self):
        n = 0
        with self.problem.folder() as folder:
            while self.left > 0:
                killed, faults = self.run_and_kill(folder)
                n += killed
                self.left -= killed
                if faults or not killed:
                    return f"after {n} kills", ("done", faults)
            return f"after {n} kills", ("done", self.problem.faults_of_next_run(folder))

    def all(self):
        while self.left > 0:
            yield self.until_done()


def kill_at_random(report, problem, n):
    kills = Kills(problem, n)
    report.series(f"{n} kills at random", kills.all())
    print(f"    {kills.starts} starts")


def kill_at_calls(report, problem, share, start, named):
    def trial(**faults):
        with problem.folder(start) as folder:
            saved = outputs.checkpoints(folder)
            result = problem.run(folder, **faults)
            wrong = [] if result.code == -9 else [f"exit code {result.code}, it was not killed"]
            wrong += ["the checkpoint is lost"] if saved and not outputs.checkpoints(folder) else []
            wrong += outputs.faults_of_files(folder) + problem.faults_of_next_run(folder)
            return faults, ("killed", wrong)

    counts = problem.counts(start)
    for kind in CHANGING:
        numbers = machine.chosen(counts[kind], share, SEED, 1)
        report.series(f"{named}, killed before {kind}", (trial(fail=kind, nth=n, how="kill") for n in numbers))
    numbers = machine.chosen(counts["write"], share, SEED, 1)
    report.series(f"{named}, killed within write", (trial(fail="write", nth=n, how="torn") for n in numbers))


def main(faulty, program, long):
    report = machine.Report()
    failing = machine.Machine(faulty, program)
    kill_at_random(report, machine.Problem(failing, STICKS, *OPTIONS), KILLS_LONG if long else KILLS)
    problem, share = machine.Problem(failing, TINY, *OPTIONS), 1 if long else SHARE
    if long:
        kill_at_calls(report, problem, share, None, "run")
    kill_at_calls(report, problem, share, problem.begun.name, "resumed run")
    return report.exit_code()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], "long" in sys.argv[3:]))

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""SIGKILL at random moments, and at chosen calls: `test_kill.py FAULTY DEM_BATCH [long]`.

After every kill each published file can be read; the same command, again and again, ends with the data of a run that
nothing happened to. `long`: 1,000 kills at random, and one at each call of the run but reads, before it and, where it
is a write, in the middle of it."""
import random
import subprocess
import sys
import time

import machine
from decks import STICKS

SEED = 20261121
KILLS, KILLS_LONG = 30, 1000
SHARE = 0.006  # of the calls, by default
CHANGING = ("open", "write", "sync", "rename", "close", "link", "resize")


def seconds_of(problem):
    start = time.monotonic()
    with problem.folder() as folder:
        problem.run(folder)
    return time.monotonic() - start


def kill_at_random(report, problem, kills):
    """One folder until its run is done, then a fresh one, until there were that many kills."""
    chance, longest, done = random.Random(SEED), seconds_of(problem), 0

    def until_done(limit):
        nonlocal done
        with problem.folder() as folder:
            faults, killed = [], 0
            while killed < limit and not faults:
                process = problem.start(folder)
                try:
                    stdout, stderr = process.communicate(timeout=chance.uniform(0, longest))
                except subprocess.TimeoutExpired:
                    process.kill()
                    process.communicate()
                    killed += 1
                    faults = problem.faults_of_files(folder)
                    continue
                result = machine.Result(process.returncode, stdout, stderr)
                faults = machine.faults_of_ending(result, (machine.DONE,)) or problem.faults_of_data(folder)
                break
            else:
                faults += problem.faults_of_next_run(folder)
            done += killed
            return f"{killed} kills", ("done", faults)

    def runs():
        while done < kills:
            yield until_done(kills - done)

    report.series(f"{kills} kills at random", runs())


def kill_at_calls(report, problem, share):
    def trial(**faults):
        with problem.folder() as folder:
            result = problem.run(folder, **faults)
            wrong = [] if result.code == -9 else [f"exit code {result.code}, it was not killed"]
            wrong += problem.faults_of_files(folder) + problem.faults_of_next_run(folder)
            return faults, ("killed", wrong)

    counts = problem.counts()
    for kind in CHANGING:
        numbers = machine.chosen(counts[kind], share, SEED)
        report.series(f"kill before {kind}", (trial(fail=kind, nth=n, how="kill") for n in numbers))
    numbers = machine.chosen(counts["write"], share, SEED)
    report.series("kill within write", (trial(fail="write", nth=n, how="torn") for n in numbers))


def main(faulty, program, long):
    report = machine.Report()
    problem = machine.Problem(machine.Machine(faulty, program), STICKS)
    kill_at_random(report, problem, KILLS_LONG if long else KILLS)
    kill_at_calls(report, problem, 1 if long else SHARE)
    return report.exit_code()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], "long" in sys.argv[3:]))

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Memory runs out anywhere in the process, HDF5 and SUNDIALS included: `test_allocations.py FAULTY DEM_BATCH [long]`.

Our own code ends with exit code 6, or 5 where a file could not be written for want of memory, or goes on where a library
could do without. Libraries may crash, or end the process: that is counted by library, and must cost no data. Whatever
happens, what is published can be read, and the same command gives the data of an undisturbed run.
`long`: each allocation once, and every tenth from then on."""
import collections
import sys
import tempfile

import machine
from decks import TINY

SEED = 20261121
SHARE = 0.001  # of the allocations, by default
CODES = (machine.DONE, machine.IO, machine.MEMORY)
LIBRARIES = ("libhdf5", "libsundials", "libgsl", "libgomp", "libc.so")


class Trials:
    def __init__(self, problem):
        self.problem = problem
        self.crashes = collections.Counter()  # by library and function

    def run(self, **faults):
        with self.problem.folder() as folder, tempfile.NamedTemporaryFile("r") as crash:
            result = self.problem.run(folder, fail="memory", crash=crash.name, **faults)
            culprit = crash.read().strip()
            if culprit == "" and result.code in CODES:
                return faults, (f"exit {result.code}", self.problem.faults_after(folder, result, CODES))
            self.crashes[culprit] += 1
            wrong = [] if culprit.startswith(LIBRARIES) else [f"exit code {result.code} by {culprit or 'our code'}"]
            wrong += self.problem.faults_of_files(folder) + self.problem.faults_of_next_run(folder)
            return faults, ("ended by a library", wrong)


def main(faulty, program, long):
    report = machine.Report()
    problem = machine.Problem(machine.Machine(faulty, program), TINY)
    n = problem.counts()["memory"]
    trials = Trials(problem)
    report.series("an allocation fails", (trials.run(nth=k) for k in machine.chosen(n, 1 if long else SHARE, SEED)))
    report.series("allocations fail from then on", (trials.run(nth=k, how="always") for k in
                                                    machine.chosen(n, 0.1 if long else SHARE / 4, SEED + 1)))
    for culprit, times in trials.crashes.most_common():
        print(f"    {times} times ended by {culprit}")
    return report.exit_code()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], "long" in sys.argv[3:]))

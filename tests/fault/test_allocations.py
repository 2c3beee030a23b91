#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Memory runs out anywhere in the process, HDF5 and SUNDIALS included: `test_allocations.py FAULTY DEM_BATCH [long]`.

Our own code ends with exit code 6; where a library says no more than that it could not do what it should, with 5 (HDF5)
or 4 (SUNDIALS); and it goes on where a library could do without. Libraries may crash, end the process, or, where they
cannot even begin, write on stderr: that is counted, and must cost no data. Whatever happens, what is published can be read, no checkpoint is lost, and the same
command gives the data of an undisturbed run.
`long`: of the allocations with the same eight innermost callers the first and the last fail; of every tenth of these
paths all that follows does, too."""
import collections
import dataclasses
import sys
import tempfile

import machine
import outputs
from decks import OPTIONS, TINY

SEED = 20261121
SHARE = 0.0001  # of the allocations, by default
CODES = (machine.DONE, machine.NUMERICS, machine.IO, machine.MEMORY)
LIBRARIES = ("libhdf5", "libsundials", "libgsl", "libc.so")


class Trials:
    def __init__(self, problem, start):
        self.problem, self.start = problem, start
        self.crashes = collections.Counter()  # by library and function
        self.talked = 0  # times that a library wrote on stderr

    def run(self, **faults):
        with self.problem.folder(self.start) as folder, tempfile.NamedTemporaryFile("r") as crash:
            before, saved = machine.names_in(folder), outputs.checkpoints(folder)
            result = self.problem.run(folder, fail="memory", crash=crash.name, **faults)
            culprit = crash.read().strip()
            wrong = ["the checkpoint is lost"] if saved and not outputs.checkpoints(folder) else []
            if machine.split_words(result)[1] and result.code in CODES:
                self.talked += 1
                result = dataclasses.replace(result, stderr="\n".join(machine.split_words(result)[0]))
            if culprit == "" and result.code in CODES:
                wrong += self.problem.faults_after(folder, result, CODES, before)
                return faults, (f"exit {result.code}", wrong)
            self.crashes[culprit] += 1
            wrong += [] if culprit.startswith(LIBRARIES) else [f"exit code {result.code} by {culprit or 'our code'}"]
            wrong += outputs.faults_of_files(folder) + self.problem.faults_of_next_run(folder)
            return faults, ("ended by a library", wrong)


def chosen(problem, start, long):
    """Numbers of allocations that fail once, and from then on."""
    if not long:
        n = problem.counts(start)["memory"]
        return machine.chosen(n, SHARE, SEED), machine.chosen(n, SHARE / 4, SEED + 1, 2)
    stacks = problem.stacks(start)
    numbered = range(1, len(stacks) + 1)
    last = dict(zip(stacks, numbered))
    first = dict(zip(reversed(stacks), reversed(numbered)))
    print(f"    {len(stacks)} allocations by {len(last)} paths")
    return sorted({*first.values(), *last.values()}), sorted(first.values())[::10]


def run_out(report, problem, long, start, named):
    trials = Trials(problem, start)
    once, always = chosen(problem, start, long)
    report.series(f"{named}, an allocation fails", (trials.run(nth=n) for n in once))
    report.series(f"{named}, allocations fail from then on", (trials.run(nth=n, how="always") for n in always))
    print(f"    {trials.talked} times a library wrote on stderr")
    for culprit, times in trials.crashes.most_common():
        print(f"    {times} times ended by {culprit}")


def main(faulty, program, long):
    report = machine.Report()
    problem = machine.Problem(machine.Machine(faulty, program), TINY, *OPTIONS)
    run_out(report, problem, long, None, "run")
    run_out(report, problem, long, problem.begun.name, "resumed run")
    return report.exit_code()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], "long" in sys.argv[3:]))

# SPDX-License-Identifier: BSD-3-Clause
"""Runs of dem_batch on a machine that fails them (faulty.c), and what has to hold afterwards."""
import array
import collections
import dataclasses
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile

import outputs

SECONDS = 120  # more than any of these runs takes
DONE, INVALID, NUMERICS, IO, MEMORY, TAKEN, AGAIN = 0, 3, 4, 5, 6, 7, 75
NOT_CAUGHT = 127
RAW = re.compile(r"HDF5-DIAG|HDF5: infinite|\[ARKODE|\[ERROR\]|Assertion")  # not our words


@dataclasses.dataclass(frozen=True)
class Result:
    code: int
    stdout: str
    stderr: str


class Machine:
    """A program, and the library that fails it."""

    def __init__(self, faulty, program):
        self.faulty, self.program = str(pathlib.Path(faulty).resolve()), str(pathlib.Path(program).resolve())

    def start(self, folder, *options, prepare=None, **faults):
        """fail='write', nth=3, how='torn', ... are FAULTY_FAIL and so on; `prepare` is called in the new process."""
        environment = dict(os.environ)
        if faults:
            environment["LD_PRELOAD"] = self.faulty
            environment.update({f"FAULTY_{key.upper()}": str(value) for key, value in faults.items()})
        return subprocess.Popen([self.program, *options, "deck.nml"], cwd=folder, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace",
                                env=environment, preexec_fn=prepare)

    def run(self, folder, *options, **faults):
        process = self.start(folder, *options, **faults)
        stdout, stderr = process.communicate(timeout=SECONDS)
        return Result(process.returncode, stdout, stderr)


class Problem:
    """A deck with the options it is run with, the data that it has on a machine that does not fail, and a folder where
    it was killed half-way."""

    def __init__(self, machine, deck, *options):
        self.machine, self.deck, self.options = machine, deck, options
        self.reference, self.begun = self.folder(), self.folder()
        result = self.run(self.reference.name)
        assert result.code == DONE and result.stderr == "", result
        self.run(self.begun.name, fail="write", nth=self.counts()["write"] // 2, how="kill")

    def folder(self, start=None):
        """A fresh one with the deck in it, or a copy of one to start from; to be used in a `with`."""
        made = tempfile.TemporaryDirectory()
        if start is not None:
            shutil.copytree(start, made.name, dirs_exist_ok=True)
        pathlib.Path(made.name, "deck.nml").write_text(self.deck, encoding="utf-8")
        return made

    def start(self, folder, **faults):
        return self.machine.start(folder, *self.options, **faults)

    def run(self, folder, **faults):
        return self.machine.run(folder, *self.options, **faults)

    def counts(self, start=None):
        """How often each kind of call is made in a run."""
        with self.folder(start) as folder, tempfile.NamedTemporaryFile() as counts:
            result = self.run(folder, counts=counts.name)
            if result.code == NOT_CAUGHT:
                print("skipped: system calls cannot be caught here")
                sys.exit(77)
            assert result.code == DONE, result
            rows = (row.split() for row in pathlib.Path(counts.name).read_text(encoding="ascii").splitlines())
            return {kind: int(n) for kind, n in rows}

    def stacks(self, start=None):
        """Of each allocation of a run, who asks for it."""
        with self.folder(start) as folder, tempfile.NamedTemporaryFile() as stacks:
            self.run(folder, stacks=stacks.name)
            return array.array("Q", stacks.read())

    # What has to hold; each gives a list of what does not.

    def faults_of_data(self, folder):
        return outputs.faults_of_data(folder, self.reference.name)

    def faults_of_next_run(self, folder):
        """Of the same command once more, on a machine that does not fail."""
        result = self.run(folder)
        if result.code != DONE or result.stderr != "":
            return [f"the next run: exit code {result.code}, {result.stderr.strip()}"]
        return [f"after the next run: {fault}" for fault in self.faults_of_data(folder)]

    def faults_after(self, folder, result, codes, before=frozenset({"deck.nml"})):
        """Of a run that ended by itself with one of the codes, and of what it left. A deck that cannot be read is an
        invalid one, and then no file is another than before."""
        faults = faults_of_ending(result, codes + (INVALID,) if names_in(folder) == before else codes)
        if result.code == DONE:
            return faults + self.faults_of_data(folder)
        return faults + outputs.faults_of_files(folder) + self.faults_of_next_run(folder)

    def trial(self, codes, start=None, **faults):
        """One run on a failing machine: what was done to it, how it ended, and what was wrong."""
        with self.folder(start) as folder:
            before, saved = names_in(folder), outputs.checkpoints(folder)
            result = self.run(folder, **faults)
            wrong = [] if not saved or outputs.checkpoints(folder) else ["the checkpoint is lost"]
            wrong += self.faults_after(folder, result, codes, before)
            return faults, (f"exit {result.code}", wrong)


def names_in(folder):
    return {path.name for path in pathlib.Path(folder).iterdir()}


def faults_of_ending(result, codes):
    """A documented exit code, and what is wrong said in our words."""
    faults = []
    if result.code not in codes:
        name = signal.Signals(-result.code).name if result.code < 0 else result.code
        faults.append(f"exit code {name}, not of {codes}")
    ours, others = split_words(result)
    if (len(ours) == 0) != (result.code == DONE):
        faults.append(f"{len(ours)} lines of ours on stderr")
    faults += [f"not our words: {line}" for line in others]
    return faults and faults + [f"stderr: {result.stderr.strip()}"]


def split_words(result):
    """Lines of stderr that are ours, and those that are not."""
    lines = result.stderr.splitlines()
    ours = [line for line in lines if ": error: " in line and not RAW.search(line)]
    return ours, [line for line in lines if line not in ours]


class Report:
    """Trials, how they ended, and what was wrong; one line for each series of them."""

    SHOWN = 5  # trials of a series that went wrong

    def __init__(self):
        self.n_wrong = 0

    def series(self, name, trials):
        """Each trial gives what it was, how it ended, and what was wrong; returns how many ended how."""
        endings, wrong = collections.Counter(), []
        for trial, (ending, faults) in trials:
            endings[ending] += 1
            if faults:
                wrong.append((trial, faults))
        self.n_wrong += len(wrong)
        counts = ", ".join(f"{n} {ending}" for ending, n in sorted(endings.items()))
        print(f"{name}: {endings.total()} trials: {counts}; {len(wrong)} wrong", flush=True)
        for trial, faults in wrong[:self.SHOWN]:
            print(f"    {trial}: " + "\n        ".join(fault[:400] for fault in faults), flush=True)
        return endings

    def expect(self, holds, text):
        if not holds:
            self.n_wrong += 1
            print(f"    {text}")

    def exit_code(self):
        return 1 if self.n_wrong > 0 else 0


def chosen(n, share, seed, least=4):
    """Of the numbers 1 to n a seeded share, in their order, and at least a few."""
    return sorted(random.Random(seed).sample(range(1, n + 1), max(min(n, least), round(share * n))))

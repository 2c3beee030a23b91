# SPDX-License-Identifier: BSD-3-Clause
"""Runs of dem_batch on a machine that fails them (faulty.c), and what has to hold afterwards."""
import collections
import dataclasses
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "deck"))
import compare  # skips the test where h5py is missing
import h5py

SECONDS = 120  # more than any of these runs takes
DONE, INVALID, NUMERICS, IO, MEMORY = 0, 3, 4, 5, 6
RAW = re.compile(r"HDF5-DIAG|#0\d\d:|SUNDIALS|ARKODE|ERKStep|ARKStep|Assertion|libgomp")  # words that are not ours
STARTED = re.compile(rb"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ")  # of /provenance


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

    def counts(self, deck, *options):
        """How often each kind of call is made in a run."""
        with tempfile.TemporaryDirectory() as folder, tempfile.NamedTemporaryFile() as counts:
            pathlib.Path(folder, "deck.nml").write_text(deck, encoding="utf-8")
            result = self.run(folder, *options, counts=counts.name)
            if result.code == 127:
                print("skipped: system calls cannot be caught here")
                sys.exit(77)
            assert result.code == DONE, result
            rows = (row.split() for row in pathlib.Path(counts.name).read_text(encoding="ascii").splitlines())
            return {kind: int(n) for kind, n in rows}


def published(folder):
    """The files that a reader may take for whole."""
    return sorted(path for path in pathlib.Path(folder).glob("*.vtkhdf") if ".part." not in path.name)


def same_file(path, other):
    """Why two outputs are not the same data; nothing if they are. Equal bytes are the quick way to know it."""
    if STARTED.sub(b"", path.read_bytes()) == STARTED.sub(b"", other.read_bytes()):
        return []
    with h5py.File(path, "r") as first, h5py.File(other, "r") as second:
        return list(compare.compare(compare.objects(first), compare.objects(second), [str(path), str(other)]))


def read_whole(path):
    """Every number and every string of a file; an OSError where one cannot be had."""
    with h5py.File(path, "r") as file:
        for item in compare.objects(file).values():
            if isinstance(item, h5py.Dataset):
                item[()]
            for name in item.attrs:
                item.attrs[name]


class Problem:
    """A deck, and the data that it has on a machine that does not fail."""

    def __init__(self, machine, deck, *options):
        self.machine, self.deck, self.options = machine, deck, options
        self.reference = tempfile.TemporaryDirectory()
        self.prepare(self.reference.name)
        result = self.run(self.reference.name)
        assert result.code == DONE and result.stderr == "", result

    def prepare(self, folder):
        pathlib.Path(folder, "deck.nml").write_text(self.deck, encoding="utf-8")

    def start(self, folder, **faults):
        return self.machine.start(folder, *self.options, **faults)

    def run(self, folder, **faults):
        return self.machine.run(folder, *self.options, **faults)

    def counts(self):
        return self.machine.counts(self.deck, *self.options)

    def folder(self):
        """A fresh one with the deck in it, to be used in a `with`."""
        made = tempfile.TemporaryDirectory()
        self.prepare(made.name)
        return made

    # What has to hold; each gives a list of what does not.

    def faults_of_data(self, folder):
        """Of a finished run."""
        ours = {path.name for path in published(folder)}
        theirs = {path.name for path in published(self.reference.name)}
        faults = [f"{name} is there in one of the runs only" for name in sorted(ours ^ theirs)]
        for name in sorted(ours & theirs):
            faults += same_file(pathlib.Path(folder, name), pathlib.Path(self.reference.name, name))
        return faults

    def faults_of_files(self, folder):
        """Of what lies in the folder at any moment."""
        faults = []
        for path in published(folder):
            try:
                read_whole(path)
            except (OSError, RuntimeError, KeyError) as error:
                faults.append(f"{path.name} cannot be read: {error}")
        return faults

    def faults_of_next_run(self, folder):
        """Of the same command once more, on a machine that does not fail."""
        result = self.run(folder)
        if result.code != DONE or result.stderr != "":
            return [f"the next run: exit code {result.code}, {result.stderr.strip()}"]
        return [f"after the next run: {fault}" for fault in self.faults_of_data(folder)]

    def faults_after(self, folder, result, codes):
        """Of a run that ended by itself with one of the codes, and of what it left. A deck that cannot be read is an
        invalid one: nothing has been written."""
        untouched = [path.name for path in pathlib.Path(folder).iterdir()] == ["deck.nml"]
        faults = faults_of_ending(result, codes + (INVALID,) if untouched else codes)
        if result.code == DONE:
            return faults + self.faults_of_data(folder)
        return faults + self.faults_of_files(folder) + self.faults_of_next_run(folder)


def faults_of_ending(result, codes):
    """A documented exit code, and one line in our words for one that is not 0."""
    faults = []
    if result.code not in codes:
        name = signal.Signals(-result.code).name if result.code < 0 else result.code
        faults.append(f"exit code {name}, not of {codes}")
    lines = result.stderr.splitlines()
    if len(lines) != (0 if result.code == DONE else 1):
        faults.append(f"{len(lines)} lines of stderr")
    faults += [f"raw: {line}" for line in lines if RAW.search(line)]
    faults += [f"no error line of ours: {line}" for line in lines if ": error: " not in line]
    return faults and faults + [f"stderr: {result.stderr.strip()}"]


class Report:
    """Trials, how they ended, and what was wrong; one line for each series of them."""

    SHOWN = 5  # trials of a series that went wrong

    def __init__(self):
        self.n_wrong = 0

    def series(self, name, trials):
        """Each trial gives a word for how it ended, the faults found, and the folder, if it is still there."""
        endings, wrong = collections.Counter(), []
        for trial, (ending, faults) in trials:
            endings[ending] += 1
            if faults:
                wrong.append((trial, faults))
        self.n_wrong += len(wrong)
        told = ", ".join(f"{n} {ending}" for ending, n in sorted(endings.items()))
        print(f"{name}: {endings.total()} trials: {told}; {len(wrong)} wrong", flush=True)
        for trial, faults in wrong[:self.SHOWN]:
            print(f"    {trial}: " + "\n        ".join(faults), flush=True)
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

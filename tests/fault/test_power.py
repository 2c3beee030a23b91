#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Power cuts: `test_power.py FAULTY DEM_BATCH [long]`.

The calls that change files are kept with their data (faulty.c), and the disk is built up as a power cut may leave it:
what was synced is there; of what was written since to a file any part may be, in any mixture; of what happened to
names since their folder was synced, the first few. Every published file on such a disk can be read, and the same
command gives the data of a run that nothing happened to. SIGKILL cannot show a missing sync, this does.
`long`: a cut after each sync, rename, removal and at every tenth of the other calls, with several mixtures."""
import collections
import pathlib
import random
import sys
import tempfile

import machine
import outputs
from decks import OPTIONS, STICKS

SEED = 20261121
CUTS = 6  # of each, by default
MIXTURES_LONG = 4
KEPT = 0.7  # of the writes that nothing has synced


def read_log(path):
    """Yields each call as its words, a write with its data behind them."""
    data, at = path.read_bytes(), 0
    while at < len(data):
        end = data.index(b"\n", at)
        words = data[at:end].decode().split("\t")
        at = end + 1
        if words[0] == "write":
            size = int(words[3])
            words[3] = data[at:at + size]
            at += size
        yield words


class File:
    def __init__(self, synced=b""):
        self.synced, self.since = bytearray(synced), []  # changes: (offset, bytes), or (length, None)

    def changed(self, content, changes):
        for place, data in changes:
            if data is None:
                content = content[:place].ljust(place, b"\0")
            else:
                content = content.ljust(place, b"\0")
                content[place:place + len(data)] = data
        return content

    def sync(self):
        self.synced, self.since = self.changed(self.synced, self.since), []

    def after_cut(self, chance):
        return self.changed(self.synced[:], [change for change in self.since if chance.random() < KEPT])


class Disk:
    def __init__(self, folder):
        self.synced = {path.name: File(path.read_bytes()) for path in pathlib.Path(folder).iterdir()}
        self.names, self.since = dict(self.synced), []  # changes: dictionaries of what is new, None: no more

    def rename(self, **changes):
        self.since.append(changes)
        self.names = self.applied(self.names, [changes])

    def applied(self, names, changes):
        together = collections.ChainMap(*reversed(changes), names)
        return {name: file for name, file in together.items() if file is not None}

    def carry_out(self, words):
        kind, name, rest = words[0], words[1], words[2:]
        if kind == "open":
            if name not in self.names:
                self.rename(**{name: File()})
            elif rest[0] == "1":
                self.names[name].since.append((0, None))
        elif kind == "sync" and name == "":
            self.synced, self.since = dict(self.names), []
        elif kind == "sync":
            self.names[name].sync()
        elif kind in ("write", "resize"):
            data = rest[1] if kind == "write" else None
            if name in self.names:  # not removed while it was open
                self.names[name].since.append((int(rest[0]), data))
        elif kind == "remove":
            self.rename(**{name: None})
        elif kind == "rename":
            self.rename(**{rest[0]: self.names[name], name: None})
        elif kind == "link":
            self.rename(**{rest[0]: self.names[name]})

    def write_after_cut(self, folder, chance):
        names = self.applied(self.synced, self.since[:chance.randint(0, len(self.since))])
        for name, file in names.items():
            pathlib.Path(folder, name).write_bytes(file.after_cut(chance))


def cut_power(report, problem, long, start, named):
    """Cuts while a run begins, or goes on from the folder `start`."""
    chance = random.Random(SEED)
    with tempfile.TemporaryDirectory() as scratch, problem.folder(start) as folder:
        log = pathlib.Path(scratch, "log")
        disk = Disk(folder)
        result = problem.run(folder, log=log)
        assert result.code == machine.DONE, result
        calls = list(read_log(log))
    few = [k for k, words in enumerate(calls) if words[0] in ("sync", "rename", "remove", "link")]
    if long:
        at = sorted({*few, *range(0, len(calls), 10)}) * MIXTURES_LONG
    else:
        at = chance.sample(few, min(CUTS // 2, len(few))) + chance.sample(range(len(calls)), CUTS // 2)
    wanted = collections.Counter(at)

    def cuts():
        for k, words in enumerate(calls):
            disk.carry_out(words)
            for mixture in range(wanted[k]):
                with tempfile.TemporaryDirectory() as folder:
                    disk.write_after_cut(folder, chance)
                    faults = outputs.faults_of_files(folder) + problem.faults_of_next_run(folder)
                yield f"after call {k}, {words[:2]}, mixture {mixture}", ("cut", faults)

    report.series(f"{named} of {len(calls)} calls", cuts())


def main(faulty, program, long):
    report = machine.Report()
    problem = machine.Problem(machine.Machine(faulty, program), STICKS, *OPTIONS)
    if long:
        cut_power(report, problem, long, None, "run")
    cut_power(report, problem, long, problem.begun.name, "resumed run")
    return report.exit_code()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], "long" in sys.argv[3:]))

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Files that cannot be opened, read, written, synced, renamed or closed, and full disks: `test_io.py FAULTY DEM_BATCH
[long]`.

A run that the machine fails ends with exit code 5 and says why, or goes on where nothing is lost; what is published can
be read, no checkpoint is lost, and the same command, once the machine is well, gives the data of a run that nothing
happened to. `long`: each call in turn (of reads every tenth), of a run that begins and of one that goes on; true small disks besides
those of faulty.c."""
import pathlib
import resource
import subprocess
import sys
import tempfile

import machine
import outputs
from decks import OPTIONS, TINY

SEED = 20261121
SHARE = 0.001  # of the calls, by default
DISKS, DISKS_LONG = 5, 48
CODES = (machine.DONE, machine.IO)
KINDS = ("open", "read", "write", "sync", "rename", "close", "link", "resize", "lock")
LASTING = ("write", "sync", "rename", "any")  # a disk that has gone


def fail_each(report, problem, share, start, named):
    counts = problem.counts(start)

    def series(kind, how, part, seed):
        numbers = machine.chosen(counts[kind], part, seed, 1)
        return report.series(f"{named}, {kind} fails {how}",
                             (problem.trial(CODES, start, fail=kind, nth=n, how=how) for n in numbers))

    for kind in KINDS:
        series(kind, "once", share / 10 if kind == "read" else share, SEED)
    for kind in LASTING:
        series(kind, "always", share / 10, SEED + 1)
    report.expect(set(series("write", "short", share / 10, SEED + 2)) <= {"exit 0"}, "a short write is no failure")


def size_needed(problem):
    """Bytes that a disk must have for a run: the smallest that suffices, to 5 %."""
    too_small, enough = 0, 1 << 26
    while enough - too_small > enough // 20:
        middle = (too_small + enough) // 2
        with problem.folder() as folder:
            if problem.run(folder, budget=middle).code == machine.DONE:
                enough = middle
            else:
                too_small = middle
    return enough


def sizes(enough, n):
    """From no room at all to more than is needed, evenly."""
    return [round(enough * k / (n - 2)) for k in range(n)]


def fill(report, problem, enough, n):
    """Disks of many sizes, by faulty.c: what is beyond the size is not written, and ENOSPC is what there is to say."""
    endings = report.series(f"disk full, 0 to {enough} bytes",
                            (problem.trial(CODES, budget=size) for size in sizes(enough, n)))
    report.expect(len(endings) > 1, "disks of all these sizes were too small, or large enough")


def fill_true_disk(report, problem, enough, n):
    """The same on file systems of their own; needs to be root."""
    def on_disk(size):
        with tempfile.TemporaryDirectory() as folder:
            mount = ["mount", "-t", "tmpfs", "-o", f"size={max(size, 4096)}", "tmpfs", folder]
            if subprocess.run(mount, capture_output=True, check=False).returncode != 0:
                return size, ("not mounted", [])
            try:
                pathlib.Path(folder, "deck.nml").write_text(problem.deck, encoding="utf-8")
                result = problem.run(folder)
                faults = machine.faults_of_ending(result, CODES) + outputs.faults_of_files(folder)
                subprocess.run(["mount", "-o", f"remount,size={4 * enough}", folder], check=True)
                faults += problem.faults_of_next_run(folder)
            finally:
                subprocess.run(["umount", folder], check=True)
        return size, (f"exit {result.code}", faults)

    report.series("tmpfs full", (on_disk(size) for size in sizes(enough, n)))


def limit_files(report, problem, enough, n):
    """`ulimit -f`: the system stops a process that writes beyond it by a signal, unless that is ignored."""
    def limited(size):
        with problem.folder() as folder:
            def limit():
                resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
            result = problem.run(folder, prepare=limit)
            return size, (f"exit {result.code}", problem.faults_after(folder, result, CODES))

    endings = report.series("file size limited", (limited(size) for size in sizes(enough, n)))
    report.expect(len(endings) > 1, "all these limits were too small, or large enough")


def main(faulty, program, long):
    report = machine.Report()
    problem = machine.Problem(machine.Machine(faulty, program), TINY, *OPTIONS)
    share, disks = (1, DISKS_LONG) if long else (SHARE, DISKS)
    if long:
        fail_each(report, problem, share, None, "run")
    fail_each(report, problem, share, problem.begun.name, "resumed run")
    enough = size_needed(problem)
    fill(report, problem, enough, disks)
    if long:
        fill_true_disk(report, problem, enough, disks)
    limit_files(report, problem, enough, disks)
    return report.exit_code()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], "long" in sys.argv[3:]))

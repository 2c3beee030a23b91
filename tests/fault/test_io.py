#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Files that cannot be opened, read, written, synced, renamed, closed, and full disks: `test_io.py FAULTY DEM_BATCH [long]`.

A run that the machine fails ends with exit code 5 and one line that says why, or goes on where nothing is lost; what is
published can be read, and the same command, once the machine is well, gives the data of a run that nothing happened to.
`long`: each call of the run in turn, and true small disks and limits besides those of faulty.c."""
import pathlib
import resource
import subprocess
import sys
import tempfile

import machine
from decks import STICKS

SEED = 20261121
SHARE = 0.005  # of the calls, by default
DISKS, DISKS_LONG = 10, 40
REPEATED = ("read", "write", "resize", "open", "close")  # many of them; the others are few and all tried


def fail_each(report, problem, share):
    """Each call fails once; then those that write fail from then on, as a disk that has gone."""
    counts = problem.counts()
    for kind in ("open", "read", "write", "sync", "rename", "close", "link", "resize", "lock"):
        numbers = machine.chosen(counts[kind], share if kind in REPEATED else 1, SEED)
        report.series(f"{kind} fails once", (trial(problem, fail=kind, nth=n) for n in numbers))
    for kind in ("write", "sync", "rename", "any"):
        numbers = machine.chosen(counts[kind], share / 4 if kind in ("write", "any") else 1, SEED + 1)
        report.series(f"{kind} fails from then on", (trial(problem, fail=kind, nth=n, how="always") for n in numbers))
    numbers = machine.chosen(counts["write"], share / 4, SEED + 2)
    short = report.series("write is short", (trial(problem, fail="write", nth=n, how="short") for n in numbers))
    report.expect(set(short) <= {"exit 0"}, "a short write is none that fails")


def trial(problem, **faults):
    with problem.folder() as folder:
        result = problem.run(folder, **faults)
        return faults, (f"exit {result.code}", problem.faults_after(folder, result, (machine.DONE, machine.IO)))


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


def fill(report, problem, n):
    """Disks of many sizes, by faulty.c: what is beyond the size is not written, and ENOSPC is what there is to say."""
    enough = size_needed(problem)
    endings = report.series(f"disk full, 0 to {enough} bytes", (trial(problem, budget=size) for size in sizes(enough, n)))
    report.expect(len(endings) > 1, "disks of all these sizes were too small, or large enough")
    return enough


def fill_true_disk(report, problem, enough, n):
    """The same on file systems of their own; needs to be root."""
    def on_disk(size):
        with tempfile.TemporaryDirectory() as folder:
            mount = ["mount", "-t", "tmpfs", "-o", f"size={max(size, 4096)}", "tmpfs", folder]
            if subprocess.run(mount, capture_output=True, check=False).returncode != 0:
                return size, ("not mounted", [])
            try:
                problem.prepare(folder)
                result = problem.run(folder)
                faults = machine.faults_of_ending(result, (machine.DONE, machine.INVALID, machine.IO))
                faults += problem.faults_of_files(folder)
                subprocess.run(["mount", "-o", f"remount,size={4 * enough}", folder], check=True)
                faults += problem.faults_of_next_run(folder)
            finally:
                subprocess.run(["umount", folder], check=True)
        return size, (f"exit {result.code}", faults)

    report.series("tmpfs full", (on_disk(size) for size in sizes(enough, n)))


def limit_files(report, problem, n):
    """`ulimit -f`: the system stops a process that writes beyond it by a signal, unless that is ignored."""
    largest = max(path.stat().st_size for path in pathlib.Path(problem.reference.name).iterdir())

    def limited(size):
        with problem.folder() as folder:
            def limit():
                resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
            result = problem.run(folder, prepare=limit)
            return size, (f"exit {result.code}", problem.faults_after(folder, result, (machine.DONE, machine.IO)))

    endings = report.series("file size limited", (limited(size) for size in sizes(4 * largest, n)))
    report.expect(len(endings) > 1, "all these limits were too small, or large enough")


def main(faulty, program, long):
    report = machine.Report()
    problem = machine.Problem(machine.Machine(faulty, program), STICKS)
    fail_each(report, problem, 1 if long else SHARE)
    disks = DISKS_LONG if long else DISKS
    enough = fill(report, problem, disks)
    if long:
        fill_true_disk(report, problem, enough, disks)
    limit_files(report, problem, disks)
    return report.exit_code()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], "long" in sys.argv[3:]))

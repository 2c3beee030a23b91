# SPDX-License-Identifier: BSD-3-Clause
"""Processor time of runs, in what the evaluation of one node takes. Stages are counted, so that all methods are alike;
what a step takes besides is that of so many nodes more.

A small deck's time is that of its start and its files. So all decks are first held to what their steps, nodes and
frames should take together. Those that took much longer are run again, and if they do so again, their steps are timed
by themselves, without files and without the start. The machine may be busy with other things: other decks are run
beside them, and the shortest of several runs counts."""
import json
import pathlib
import resource
import shutil
import statistics
import subprocess
import tempfile

# Node evaluations of the program's start and its files, of a frame, and of a node in it; by 230 decks, whose time is
# 0.8 to 1.3 times this, of nine in ten.
START, FRAME, NODE_OF_FRAME = 6e5, 15e3, 75
MUCH = 1.8  # times the median
NOISE = 0.02  # s, by which two runs of one deck may differ
REPEATS, REFERENCES = 3, 9
QUIET = ["output.events=.false.", "output.peak_every=0", "output.fields='displacement'", "output.deflate=0"]


def seconds_of_children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def is_of_steps(deck, run):
    """Whether steps take most of the time: not the contacts of a crowd, threads that wait for each other, or what breaks
    and softens, each fall of which has its correction (docs/performance.md)."""
    return not deck.is_crowd and "threads" not in deck.solver and run.history["fracture"][-1] == 0.0


def work_of_steps(result, n_nodes):
    return (result["evaluations"] + 2 * result["steps"]) * (n_nodes + 30)


def work_of_run(result, n_nodes, n_frames):
    return START + n_frames * (FRAME + NODE_OF_FRAME * n_nodes) + work_of_steps(result, n_nodes)


class Clock:
    """How long the runs took."""

    def __init__(self, program):
        self.program = program
        self.runs = []  # (deck, its result, its nodes, its work, seconds)

    def note(self, deck, seconds, result, n_nodes, n_frames):
        self.runs.append((deck, result, n_nodes, work_of_run(result, n_nodes, n_frames), seconds))

    def shortest(self, folder, sets):
        """Seconds of the shortest of some runs with these keys, and its result."""
        words = [word for one in sets for word in ("--set", one)]
        found = []
        for _ in range(REPEATS):
            shutil.rmtree(pathlib.Path(folder, "timed"), ignore_errors=True)  # what is there is not computed again
            before = seconds_of_children()
            done = subprocess.run([self.program, "--outdir", "timed", "deck.nml", *words], cwd=folder,
                                  stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
            found.append(seconds_of_children() - before)
        return min(found), json.loads(done.stdout.splitlines()[-1])

    def share(self, run):
        """Seconds of a node evaluation, all in all."""
        deck, _, _, work, _ = run
        with tempfile.TemporaryDirectory() as name:
            deck.write(pathlib.Path(name))
            return self.shortest(name, [])[0] / work

    def of_steps(self, run):
        """Seconds of the steps alone, and their work."""
        deck, result, n_nodes, _, _ = run
        quiet = [*QUIET, f"output.frame_interval={result['t_end']}"]
        with tempfile.TemporaryDirectory() as name:
            deck.write(pathlib.Path(name))
            start, _ = self.shortest(name, [*quiet, f"run.t_end={1e-9 * result['t_end']}"])
            whole, result = self.shortest(name, quiet)
        return whole - start, work_of_steps(result, n_nodes)

    def slow(self):
        """(deck, how many times as long as others its steps took, for step, stage and node)"""
        if len(self.runs) < 2 * REFERENCES:
            return []
        shares = [seconds / work for *_, work, seconds in self.runs]
        usual = statistics.median(shares)
        late = [run for run, share in zip(self.runs, shares) if share > MUCH * usual]
        if not late:
            return []
        others = [run for run, share in zip(self.runs, shares) if share <= MUCH * usual]
        others = sorted(others, key=lambda run: work_of_steps(run[1], run[2]))[-REFERENCES:]  # more than noise
        usual = statistics.median(self.share(run) for run in others)
        late = [run for run in late if self.share(run) > MUCH * usual]
        if not late:
            return []
        seconds, work = map(sum, zip(*map(self.of_steps, others)))
        each, found = seconds / work, []
        for run in late:
            seconds, work = self.of_steps(run)
            found.append((run[0], max(0.0, seconds - NOISE) / (each * work)))
        return found

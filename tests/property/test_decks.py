#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Random decks through the program, judged from outside: `test_decks.py DEM_BATCH [NUMBER] [--seed FIRST]
[--moving|--crowds] [--times]`.

A deck is refused with a line, or runs to its end: no storm, no crash, nothing that is not finite, energy and momentum
in balance, nobody inside of anything. A deck that fails is printed whole, and `test_decks.py DEM_BATCH 1 --seed SEED`
runs it again."""
import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
try:
    import deck_clock
    import deck_crowd
    import deck_judge
    import deck_maker
except ImportError as lack:
    print(f"skipped: {lack}")
    sys.exit(77)

SECONDS = 900  # of a run that does not end
MEMORY = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None  # what a disk makes of it is no question here
REFUSAL = re.compile(r"deck\.nml:\d+:\d+: error: [^\n]+\n")


class Census:
    """How many decks ended how, the worst of each measure with its deck, and what was covered."""

    def __init__(self):
        self.ends = {"ran": 0, "refused": 0, "stopped at an overlap": 0, "not at rest": 0}
        self.worst = {}
        self.sums = {}

    def measure(self, name, value, share, seed):
        """`share`: of what is right."""
        if name not in self.worst or share > self.worst[name][1]:
            self.worst[name] = (value, share, seed)

    def count(self, result):
        for name in ("impacts", "vertex_impacts", "early", "closings", "releases", "slips", "sticks", "passings",
                     "breaks"):
            self.sums[name] = self.sums.get(name, 0) + result[name]
        for name, is_so in (("broken", result["breaks"] > 0), ("rigid", len(result["rigid"]) > 0)):
            self.sums[name] = self.sums.get(name, 0) + is_so
        self.sums["touching"] = self.sums.get("touching", 0) + (result["events"] > 0)

    def print(self, number, n_faulty):
        ends = ", ".join(f"{count} {end}" for end, count in self.ends.items())
        print(f"{number} decks: {ends}, {n_faulty} faulty")
        for name, (value, share, seed) in sorted(self.worst.items()):
            print(f"worst: {name} {value:.2g}, {100 * share:.2g} % of what is right, seed {seed}")
        print("covered: " + ", ".join(f"{name} {count}" for name, count in self.sums.items()))


def run_deck(program, deck, folder):
    """Exit code, result or None, standard error, seconds of the processor."""
    deck.write(folder)
    (folder / "out").mkdir()
    before = deck_clock.seconds_of_children()
    done = subprocess.run([program, "--outdir", "out", "deck.nml"], cwd=folder, stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, timeout=SECONDS, check=False)
    seconds = deck_clock.seconds_of_children() - before
    results = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    return done.returncode, results[0] if len(results) == 1 else None, done.stderr, seconds


def judge_refusal(stderr, folder):
    faults = [] if REFUSAL.fullmatch(stderr) else ["a refusal that is not one line"]
    return faults + [f"a refusal wrote {path.name}" for path in (folder / "out").iterdir()]


def judge_run(deck, result, seconds, folder, census, clock):
    run = deck_judge.Run(folder / "out" / "deck.vtkhdf")
    census.count(result)
    if deck_clock.is_of_steps(deck, run):
        clock.note(deck, seconds, result, len(run.lattice["mass"]), len(run.times))
    early = result["t"] != result["t_end"] and not deck.rests
    faults = [f"ended at {result['t']} s of {result['t_end']} s"] if early else []
    if not deck_judge.is_finite(run):
        return faults + ["something is not finite"]
    census.sums["contacts of bodies"] = census.sums.get("contacts of bodies", 0) + (run.history["contact"].max() > 0.0)
    for name, measure in deck_judge.OF_CROWDS if deck.is_crowd else deck_judge.MEASURES:
        found = measure(run, deck)
        if found is None:
            continue
        value, limit = found
        census.measure(name, value, value / limit, deck.seed)
        if not value <= limit:
            faults.append(f"{name} {value:.3g}, at most {limit:.3g} is right")
    return faults


def judge(program, deck, folder, census, clock):
    """What is wrong with the deck's run."""
    try:
        code, result, stderr, seconds = run_deck(program, deck, folder)
    except subprocess.TimeoutExpired:
        return [f"no end within {SECONDS} s"]
    if result is None or result["exit_code"] != code:
        return [f"exit code {code} without its result", stderr]
    if code == 0:
        census.ends["ran"] += 1
        return judge_run(deck, result, seconds, folder, census, clock)
    if code == 3:
        census.ends["refused"] += 1
        print(f"seed {deck.seed}: {stderr.strip()}")
        return judge_refusal(stderr, folder)
    if code == 4 and deck.contact.get("overlap") == "stop" and "overlap" in result:
        census.ends["stopped at an overlap"] += 1
        return []
    if code == 4 and deck.rests and "not at rest" in result["message"]:
        census.ends["not at rest"] += 1
        return []
    return [f"exit code {code}", stderr]


def make(seed, options):
    return deck_crowd.random_crowd(seed) if options.crowds else deck_maker.random_deck(seed, options.moving)


def show(deck, faults):
    print(f"seed {deck.seed} is wrong: " + "; ".join(faults) + f"\n---- deck.nml\n{deck.text}")
    for name, text in deck.files.items():
        print(f"---- {name}\n{text}")
    print("----", flush=True)


def try_seed(program, deck, census, clock):
    """Whether the deck is right; else it is printed."""
    with tempfile.TemporaryDirectory(dir=MEMORY) as name:
        faults = judge(program, deck, pathlib.Path(name), census, clock)
    if faults:
        show(deck, faults)
    return not faults


def try_times(clock, census):
    """How many decks take over 3 times as long as the others for step, stage and node."""
    n_slow = 0
    for deck, times in clock.slow():
        census.measure("times as slow", times, times / 3.0, deck.seed)
        if times > 3.0:
            show(deck, [f"takes {times:.3g} times what others do for step, stage and node, at most 3 is right"])
            n_slow += 1
    return n_slow


# What a deck is to have at least, on the average: a third to a half of what was found.
LEAST = {"touching": 0.4, "impacts": 5.0, "vertex_impacts": 0.3, "early": 0.05, "closings": 0.3, "releases": 0.1,
         "slips": 0.03, "sticks": 0.1, "passings": 0.01, "broken": 0.04, "rigid": 0.02}
LEAST_OF_CROWDS = {"contacts of bodies": 0.3, "touching": 0.05, "impacts": 4.0}


def shortfalls(census, number, is_crowd):
    """What the decks were to cover and did not, of a number that is not small."""
    if number < 100:
        return []
    least = LEAST_OF_CROWDS if is_crowd else LEAST
    found = [f"{name}: {census.sums.get(name, 0)}, {share * number:g} were to be" for name, share in least.items()
             if census.sums.get(name, 0) < share * number]
    return found + (["too many are refused"] if census.ends["refused"] > 0.05 * number else [])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("number", type=int, nargs="?", default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--moving", action="store_true", help="obstacles that move")
    parser.add_argument("--crowds", action="store_true", help="2 to 12 bodies that touch each other")
    parser.add_argument("--times", action="store_true", help="judge how long the runs take, too")
    options = parser.parse_args()
    program, census = os.path.abspath(options.program), Census()
    clock = deck_clock.Clock(program)
    seeds = range(options.seed, options.seed + options.number)
    n_faulty = sum(not try_seed(program, make(seed, options), census, clock) for seed in seeds)
    n_faulty += try_times(clock, census) if options.times else 0
    census.print(options.number, n_faulty)
    missing = shortfalls(census, options.number, options.crowds)
    for line in missing:
        print(line)
    sys.exit(1 if n_faulty or missing else 0)


if __name__ == "__main__":
    main()

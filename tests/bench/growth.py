#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How the impact of bench_impact (W2, 1 ms) grows as the spacing is halved: the table of docs/performance.md.

    growth.py --bench build/tests/bench --work DIR [--method fehlberg45] [--contact local] [--law 1 0 0]
              [--halvings 4] [--counted 3]

The law is that of floor and springs: restitution, friction, damping time in s. An event is an impact or a change of a
lasting contact. Instructions are of the time loop, counted by callgrind for the first `--counted` halvings, with the
kernel that its processor has.
"""
import argparse
import pathlib
import re

from lammps import call, numbers

COARSEST, TIME = 5e-3, 1e-3     # m, s
OPTIONS = (1e-6, 0.5, 1e-6)     # rtol, longest step times omega_max, penetration tolerance over spacing: the defaults
COUNT = ("valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", "--log-file=callgrind.log",
         "--toggle-collect=dem_simulation_advance")


def instructions(command, work):
    call([*COUNT, *command], work)
    return int(re.search(r"Collected : (\d+)", (work / "callgrind.log").read_text())[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bench", type=lambda path: pathlib.Path(path).resolve(), required=True)
    parser.add_argument("--work", type=lambda path: pathlib.Path(path).resolve(), required=True)
    parser.add_argument("--method", default="fehlberg45")
    parser.add_argument("--contact", default="local")
    parser.add_argument("--law", type=float, nargs=3, default=(1, 0, 0))
    parser.add_argument("--halvings", type=int, default=4)
    parser.add_argument("--counted", type=int, default=3)
    a = parser.parse_args()
    a.work.mkdir(parents=True, exist_ok=True)
    before = None
    print("| spacing, mm | nodes | evaluations | impacts | CPU, s | instructions | growth of these four | us per event |\n" +
          8 * "|---" + "|")
    for halving in range(a.halvings + 1):
        spacing = COARSEST / 2 ** halving
        body, options = [a.bench / "bench_impact", spacing, TIME], [a.method, a.contact, *OPTIONS, "/dev/null", *a.law]
        run = numbers(call([*body, 0, *options], a.work))
        now = [run[key][0] for key in ("evaluations", "impacts", "cpu")]
        if halving <= a.counted:
            now.append(instructions([*body, 1, *options], a.work))
        growth = " ".join(f"{new / old:.2f}" for new, old in zip(now, before)) if before else ""
        print(f"| {1e3 * spacing} | {run['nodes'][0]:.0f} | {now[0]:.0f} | {now[1]:.0f} | {now[2]:.3g} | " +
              (f"{now[3]:.3g}" if len(now) > 3 else "") +
              f" | {growth} | {1e6 * run['take'][0] / run['events'][0]:.1f} |", flush=True)
        before = now


if __name__ == "__main__":
    main()

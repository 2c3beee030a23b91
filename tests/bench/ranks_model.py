#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What a step would take on many ranks, by a model whose parameters were measured on few: predictions, not measurements
(docs/performance.md, A model of many ranks).

    ranks_model.py [--nodes 1e6 ...] [--ranks 8 ...]

A rank integrates its own nodes, rings of ghosts about them, and the common nodes of a body that stands on an obstacle;
it sends one message to each neighbour, takes part in one reduction, and resolves the events of all ranks:

    T = c (N/P + R sqrt(N/P)) + a + b R sqrt(N/P) + r log2 P, and in contact + c K sqrt(N) + e sqrt(N) t
"""
import argparse
import math

# c, s a node and step; R, ghosts over the root of the own nodes of a square; bytes sent of a ghost
METHODS = {"fehlberg45": (34e-9, 12, 32), "verlet": (4.5e-9, 4, 16)}
COMMON = 9          # K: the surface of a square and four rings about one side, measured; about all sides 20
EVENTS = 0.024      # e, a step: a block of 89,099 nodes had 1715 in the 236 steps of its landing
EVENT = 9e-6        # t, s, measured
LATENCY = 8e-6      # a, s: six neighbours at 1.3 us each, as a fast network has it; not measured
BYTE = 1 / 2e9      # b, s, of each of the ranks that share a machine's network; not measured
REDUCTION = 1.5e-6  # r, s; not measured


def step(method, n, ranks, touches):
    """Seconds that a step takes, and what a process alone would take over the number of ranks."""
    cost, rings, size = METHODS[method]
    alone = ranks == 1
    ghosts = 0 if alone else rings * math.sqrt(n / ranks)
    talk = 0 if alone else LATENCY + size * BYTE * ghosts + REDUCTION * math.log2(ranks)
    events = EVENTS * math.sqrt(n) * EVENT if touches else 0
    common = COMMON * math.sqrt(n) * (1 - 1 / ranks) if touches else 0
    return cost * (n / ranks + ghosts + common) + talk + events, (cost * n + events) / ranks


def two_digits(x):
    return f"{float(f'{x:.2g}'):g}"


def cell(method, n, ranks):
    if n / ranks < 1000:
        return "-"
    times = [step(method, n, ranks, touches) for touches in (False, True)]
    shares = ", ".join(f"{100 * ideal / real:.0f}" for real, ideal in times)
    return f"{shares} % ({', '.join(two_digits(1e3 * real) for real, _ in times)})"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--nodes", type=float, nargs="+", default=[1e6, 1e7, 1e8, 1e9])
    parser.add_argument("--ranks", type=int, nargs="+", default=[8, 128, 1024, 10240])
    given = parser.parse_args()
    print("| nodes | method | " + " | ".join(f"{ranks} ranks" for ranks in given.ranks) + " |")
    print("|" + "---|" * (len(given.ranks) + 2))
    for n in given.nodes:
        for method in METHODS:
            print(f"| {n:.0e} | {method} | " + " | ".join(cell(method, n, ranks) for ranks in given.ranks) + " |")


if __name__ == "__main__":
    main()

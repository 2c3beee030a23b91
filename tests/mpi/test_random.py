#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Random decks on ranks: `test_random.py MPIRUN DEM_BATCH INPUTS_FOLDER COMPARE [NUMBER [FIRST_SEED]]`.

Decks of tests/property, by turns of what may break, of any body, of bodies that run into each other, and of obstacles
that move, on 1 to 7 ranks with 1 or 2 threads, of which 1 to all write: files are those of one process, or the run ends
with its code and its line."""
import collections
import pathlib
import sys
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "property"))
import deck_crowd
import deck_maker
import test_batch
import test_decks

NUMBER, SEED = 5, 16  # of which each kind is one that breaks, or touches
MOST_TRIES = 100


def may_break(seed):
    """One of the decks from a thousand times the seed on."""
    decks = (deck_maker.random_deck(k) for k in range(1000 * seed, 1000 * seed + MOST_TRIES))
    return next(deck for deck in decks if deck.breaks)


KINDS = (may_break, deck_maker.random_deck, deck_crowd.random_crowd, lambda seed: deck_maker.random_deck(seed, True))


class Census:
    """What the decks had."""

    def __init__(self):
        self.sums = collections.Counter()
        self.codes = collections.Counter()

    def count(self, code, found):
        self.codes[code] += 1
        if found is None:
            return
        self.sums["events"] += found["events"]
        self.sums["decks that touch obstacles"] += found["events"] > 0
        self.sums["decks whose bodies touch"] += found.get("pairs_most", 0) > 0
        self.sums["decks that break"] += found["breaks"] > 0
        self.sums["breaks"] += found["breaks"]

    def __str__(self):
        codes = ", ".join(f"{n} with exit code {code}" for code, n in sorted(self.codes.items()))
        return codes + "; " + ", ".join(f"{n} {name}" for name, n in self.sums.items())


class RandomDecks(test_decks.OnRanks):
    def run_as(self, outdir, n, threads, writers=1):
        code, _, errors = self.run_deck(n, outdir, "deck.nml", "--set", "output.name=free", threads=threads,
                                        writers=writers)
        return code, [line for line in errors.splitlines() if line.startswith("deck.nml")]

    def check(self, seed, census):
        deck = KINDS[seed % len(KINDS)](seed)
        deck.write(self.folder)
        n, threads = test_decks.RANKS[seed % len(test_decks.RANKS)], 1 + seed // 7 % 2
        code, said = self.run_as(f"one{seed}", 0, 1)
        there, heard = self.run_as(f"ranks{seed}", n, threads, 1 + seed // 3 % n)
        if any("ranks are more than the" in line for line in heard):
            census.sums["decks with fewer nodes than ranks"] += 1
            return
        self.assertEqual((there, heard), (code, said), deck.text)
        has_files = (self.folder / f"one{seed}" / "free.json").exists()
        census.count(code, self.result(f"one{seed}") if has_files else None)
        if has_files:
            self.assert_same(f"one{seed}", f"ranks{seed}")

    def test_files_are_those_of_one_process(self):
        census = Census()
        for seed in range(SEED, SEED + NUMBER):
            with self.subTest(seed=seed):
                self.check(seed, census)
        print(f"{NUMBER} decks from seed {SEED}: {census}", flush=True)
        if NUMBER >= len(KINDS):  # else nothing is compared, if all are refused
            for what in ("events", "breaks", "decks whose bodies touch"):
                self.assertGreater(census.sums[what], 0, what)


if __name__ == "__main__":
    test_batch.begin(*sys.argv[1:5])
    NUMBER, SEED = [int(word) for word in sys.argv[5:7]] + [NUMBER, SEED][len(sys.argv) - 5:]
    sys.argv[1:] = []
    unittest.main()

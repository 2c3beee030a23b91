#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Decks that take more memory, steps or disk than they may: `test_refused_limits.py DEM_BATCH`. Refused by arithmetic:
each within the time and memory of any other refusal, however large its numbers are."""
import refusal
from refusal import (BASE, DISC, MASK, POLYGON, edit, jagged, stderr_of, without)

SQUARE = edit(BASE, "0.01\n -> 0.01\n    lattice = 'square'\n", "frame_interval = 1e-4 -> frame_interval = 1e-3")


def of_size(size, spacing, base=SQUARE):
    return edit(base, f"0.04, 0.05 -> {size}, {size}", f"spacing = 0.01 -> spacing = {spacing}")


def memory(place, least, nodes, most="8"):
    return (f"{place} the run takes at least {least} GB of memory for its {nodes} nodes; the limit is {most} GB, and "
            "--max-memory sets it")


def steps(place, t_end, least, step, most="1e+10"):
    return (f"{place} 't_end' in &run, {t_end} s, takes at least {least} steps of {step} s; the limit is {most}, and "
            "--max-steps sets it")


def disk(place, takes, frames, least, most):
    return (f"{place} the output takes about {takes} GB, {frames} frames and {least} steps until 't_end', twice while "
            f"it is put together; the limit is {most} GB, and --max-disk sets it")


MANY = ["--max-steps", "1e300", "--max-disk", "1e290"]  # only memory counts
# name, options, exit code, text, messages
DECKS = [
    # memory
    ("1e9 x 1e9 cells", ["--max-memory", "8", *MANY], 6, of_size("1e7", "0.01"),
     [memory("14:5", "6e+11", "1e+18")]),
    ("1e18 x 1e18 cells", ["--max-memory", "8", *MANY], 6, of_size("1e9", "1e-9"),
     [memory("14:5", "6e+29", "1e+36")]),
    ("products that overflow", ["--max-memory", "8", *MANY], 6, of_size("1e300", "1e-50"),
     [memory("14:5", "6e+243", "1e+250")]),
    ("more than most machines have", ["--max-memory", "1000000", *MANY], 6, of_size("1e5", "0.01"),
     [memory("14:5", "6e+07", "1e+14", "1e+06")]),
    ("more than this machine has", MANY, 6, of_size("1e9", "0.01"), None),
    ("little more than asked for", ["--max-memory", "0.05"], 6, of_size("3", "0.01"),
     [memory("14:5", "0.054", "9.06e+04", "0.05")]),
    ("Verlet's method takes less", ["--max-memory", "0.05"], 0, of_size("3", "0.01") + "&solver method = 'verlet' /\n",
     []),
    ("disc", ["--max-memory", "8", *MANY], 6, edit(DISC, "radius = 0.03 -> radius = 1e3", "spacing = 0.01 -> spacing = 1e-3"),
     [memory("14:5", "2.18e+06", "4.62e+12")]),
    ("ring that is thin", ["--max-memory", "8", *MANY], 6,
     edit(BASE, "'rectangle' -> 'ring'", "size = 0.04, 0.05 -> radius = 1e3, inner_radius = 999.99", "0.01\n -> 0.001\n"),
     [memory("14:5", "2.96e+05", "4.62e+12")]),
    ("polygon that is thin", ["--max-memory", "8", *MANY], 6,
     edit(POLYGON, "0,0, 0.04,0, 0.04,0.05, 0,0.05 -> 0,0, 1e3,1e3, 1e3,1001", "0.01\n -> 0.001\n"),
     [memory("14:5", "7.4e+04", "1.16e+12")]),
    ("mask of few pixels", ["--max-memory", "8", *MANY], 6, edit(MASK, "scale = 0.01 -> scale = 1e3"),
     [memory("14:5", "1.48e+04", "2.31e+11")]),
    ("voids do not help before they are cut", ["--max-memory", "0.5", *MANY], 6,
     of_size("30", "0.01") + "&void centre = 0, 15, radius = 100 /\n",
     [memory("14:5", "0.576", "9.01e+06", "0.5")]),
    ("second body", ["--max-memory", "8", *MANY], 6,
     BASE + "&body shape = 'disc', radius = 1e3, spacing = 1e-3, material = 'rubber' /\n",
     [memory("27:37", "2.18e+06", "4.62e+12")]),
    ("bodies together", ["--max-memory", "0.05"], 6,
     of_size("2", "0.01") + "&body shape = 'rectangle', size = 2.5, 2.5, spacing = 0.01, lattice = 'square',\n"
     "material = 'rubber' /\n",
     [memory("28:45", "0.0615", "1.02e+05", "0.05")]),
    ("mesh as large as its file", ["--max-memory", "1e-7"], 6,
     without(edit(BASE, "'rectangle' -> 'mesh'", "size = 0.04, 0.05 -> file = 'good.msh', scale = 0.01"),
             "    spacing = 0.01\n"),
     ["11:1 the run takes at least 1.39e-07 GB of memory; the limit is 1e-07 GB, and --max-memory sets it"]),
    # steps
    ("t_end far away", ["--max-disk", "1e290"], 6, edit(BASE, "t_end = 1e-3 -> t_end = 1e9", "= 1e-4 -> = 1e8"),
     [steps("2:5", "1e+09", "4.78e+13", "2.09e-05")]),
    ("stiff and light", ["--max-disk", "1e290"], 6, edit(BASE, "1e7 -> 1e27", "1050 -> 1e-3"),
     [steps("2:5", "0.001", "4.9e+14", "2.04e-18")]),
    ("fewer than it takes", ["--max-steps", "40"], 6, BASE,
     [steps("2:5", "0.001", "48", "2.09e-05", "40")]),
    ("fewer than it takes once it is built", ["--max-steps", "50"], 6, jagged(BASE),
     [steps("2:5", "0.001", "59", "1.71e-05", "50")]),
    ("as many as it takes", ["--max-steps", "59"], 0, jagged(BASE), []),
    ("max_step tiny", ["--max-disk", "1e290"], 6, BASE + "&solver max_step = 1e-200 /\n",
     [steps("2:5", "0.001", "1e+197", "1e-200")]),
    ("fixed_step tiny", ["--max-disk", "1e290"], 6, BASE + "&solver fixed_step = 1e-15 /\n",
     [steps("2:5", "0.001", "1e+12", "1e-15")]),
    ("masses damped away", ["--max-disk", "1e290"], 6, jagged(BASE + "&solver mass_damping = 1e100 /\n"),
     [steps("2:5", "0.001", "2e+97", "5e-101") + "; 'damping_time' or 'mass_damping' has shortened the steps from 1.71e-05 s"]),
    # disk
    ("frames", ["--max-disk", "0.01"], 5, edit(BASE, "1e-4 -> 1e-7"),
     [disk("25:5", "0.0242", "10001", "48", "0.01")]),
    ("history", ["--max-disk", "0.01"], 5, BASE + "&solver fixed_step = 1e-8 /\n",
     [disk("25:5", "0.0394", "11", "1e+05", "0.01")]),
    ("frames as often as by default", ["--max-disk", "1"], 5,
     without(edit(BASE, "t_end = 1e-3 -> t_end = 1000"), "    frame_interval = 1e-4\n"),
     [disk("23:1", "21.1", "1000001", "4.78e+07", "1")]),
    # several
    ("everything", ["--max-memory", "1e-3", "--max-steps", "10", "--max-disk", "1e-4"], 6,
     of_size("1", "0.01"),
     [steps("2:5", "0.001", "42", "2.42e-05", "10"),
      memory("14:5", "0.006", "1.02e+04", "0.001"),
      disk("26:5", "0.00264", "2", "42", "0.0001")]),
    ("faults of the deck go before", ["--max-memory", "8"], 3, edit(of_size("1e7", "0.01"), "1050 -> -1050"),
     ["8:15 'density' in &material must be > 0, got -1050"]),
]


class Limits(refusal.Refusal):
    def test_decks(self):
        self.assertEqual(len({deck[0] for deck in DECKS}), len(DECKS))
        for name, options, code, deck, messages in DECKS:
            with self.subTest(name):
                self.put(deck)
                expected = None if messages is None else stderr_of(messages)
                if code == 0:
                    found, _, stderr, _ = self.run_program("--check", *options, "deck.nml")
                    self.assertEqual((found, stderr), (0, ""))
                elif expected is None:
                    found, _, stderr, _ = self.run_program("--check", *options, "deck.nml")
                    self.assertRegex(stderr, r"^deck\.nml:14:5: error: the run takes at least 6e\+15 GB of memory for its "
                                           r"1e\+22 nodes; the limit is [\d.e+]+ GB, and --max-memory sets it\n$")
                    self.assertEqual(found, code)
                else:
                    self.refuse(code, expected, "--outdir", "out", *options, "deck.nml")
                    self.refuse(code, expected, "--check", *options, "deck.nml")

    def test_the_echo_is_held_against_memory_only(self):
        self.put(edit(BASE, "t_end = 1e-3 -> t_end = 1e9", "= 1e-4 -> = 1e8"))
        code, _, stderr, _ = self.run_program("--echo", "--max-disk", "1e-9", "deck.nml")
        self.assertEqual((code, stderr), (0, ""))
        self.put(of_size("1e7", "0.01"))
        self.refuse(6, stderr_of([memory("14:5", "6e+11", "1e+18")]), "--echo", "--max-memory", "8", "deck.nml")

    def test_the_process_has_a_limit(self):
        """`ulimit -v` and the like; a sanitizer reserves terabytes of addresses for itself."""
        if self.sanitized:
            return
        self.put(of_size("100", "0.01"))
        code, _, stderr, _ = self.run_program("--check", *MANY, "deck.nml", space=10**9)
        self.assertEqual((code, stderr), (6, stderr_of([memory("14:5", "60", "1e+08", "1")])))

    def test_a_run_that_has_begun_may_fill_the_disk(self):
        """What there is of it needs no room once more."""
        self.put(edit(BASE, "1e-4 -> 1e-3"))
        code, _, stderr, _ = self.run_program("--outdir", "out", "deck.nml")
        self.assertEqual((code, stderr), (0, ""))
        code, _, stderr, _ = self.run_program("--outdir", "out", "deck.nml")
        self.assertEqual((code, stderr), (0, ""))

    def test_limits_that_are_none(self):
        self.put(BASE)
        for option in ("--max-memory", "--max-steps", "--max-disk"):
            self.refuse_usage(f"'{option}' needs a number above 0", "deck.nml", option)
            for text in ("", "0", "-1", "1GB", "nan", "inf", "1e999", "x"):
                with self.subTest(option + text):
                    self.refuse_usage(f"'{option}' needs a number above 0, got {text}", option, text, "deck.nml")


if __name__ == "__main__":
    refusal.main()

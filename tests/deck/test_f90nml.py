#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the PyPI package f90nml writes, dem_batch reads: `test_f90nml.py DEM_BATCH`.

Each deck is written by f90nml, resolved by `dem_batch --echo`, and the echo read back by f90nml."""
import copy
import io
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import f90nml
except ImportError:
    print("skipped: the PyPI package f90nml is not there; install it with: python3 -m pip install f90nml")
    sys.exit(77)

DEM_BATCH = None

DECK = {
    "run": {"title": "Rubber on rough granite", "t_end": 0.02, "gravity": [0, -9.81]},
    "material": {"name": "rubber", "youngs_modulus": 1.0e7, "density": 1050},
    "body": {"shape": "rectangle", "size": [0.08, 0.13], "spacing": 0.0025, "material": "rubber",
             "velocity": [0, -10], "clearance": 2.0e-4},
    "obstacle": {"points": [-0.3, -0.02, -0.09, -0.012, -0.05, 0.004, 0.3, -0.02], "restitution": 0.5},
    "output": {"name": "rectangle", "deflate": 3},
}


def namelist(**changes):
    """The deck with keys of some groups replaced or added."""
    deck = copy.deepcopy(DECK)
    for group, keys in changes.items():
        deck.setdefault(group, {}).update(keys)
    return f90nml.Namelist(deck)


def text_of(deck, **options):
    """What f90nml writes, with its formatting options set."""
    for option, value in options.items():
        setattr(deck, option, value)
    file = io.StringIO()
    deck.write(file)
    return file.getvalue()


def echo_of(text):
    """The resolved deck as f90nml reads it."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "deck.nml")
        path.write_text(text, encoding="utf-8")
        done = subprocess.run([DEM_BATCH, "--echo", path], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(f"exit {done.returncode} for\n{text}\n{done.stderr}")
    return f90nml.reads(done.stdout)


def same(got, expected):
    """Equal, with numbers compared as numbers to the last bit."""
    if isinstance(expected, list):
        return isinstance(got, list) and len(got) == len(expected) and all(map(same, got, expected))
    if isinstance(expected, (int, float)):
        return float(got) == float(expected) and math.copysign(1, got) == math.copysign(1, expected)
    return got == expected


class Written(unittest.TestCase):
    def check(self, deck, text=None):
        """The echo holds each value of `deck`, which was written as `text`."""
        echo = echo_of(text_of(deck) if text is None else text)
        for group, keys in deck.items():
            for key, expected in keys.items():
                self.assertTrue(same(echo[group][key], expected),
                                f"{group}.{key}: {echo[group][key]!r}, expected {expected!r}")

    def test_a_plain_deck(self):
        self.check(namelist())

    def test_upper_case(self):
        deck = namelist()
        self.check(deck, text_of(deck, uppercase=True))

    def test_commas_at_ends_of_lines(self):
        deck = namelist()
        self.check(deck, text_of(deck, end_comma=True))

    def test_no_blanks_round_the_equal_sign(self):
        deck = namelist()
        self.check(deck, text_of(deck, assign_spacing=False))

    def test_indents(self):
        for indent in (0, 1, 8, "\t"):
            deck = namelist()
            self.check(deck, text_of(deck, indent=indent))

    def test_column_widths_down_to_one_value_a_line(self):
        for width in (20, 40, 72, 400):
            deck = namelist()
            self.check(deck, text_of(deck, column_width=width))

    def test_strings_split_over_lines(self):
        deck = namelist(run={"title": "a title that is longer than the column width, and then some"})
        self.check(deck, text_of(deck, split_strings=True, column_width=30))

    def test_long_arrays_go_on_in_the_next_lines(self):
        points = [z for k in range(1000) for z in (0.01 * k, math.sin(k) * 10.0 ** (k % 7 - 3))]
        self.check(namelist(obstacle={"points": points}))

    def test_repeat_counts(self):
        deck = namelist(obstacle={"points": [-2.5, -2.5, -2.5, 0.5, 0.5, 0.5]}, body={"velocity": [3.0, 3.0]})
        self.check(deck, text_of(deck, repeat_counter=True))

    def test_float_formats(self):
        for form in ("", ".17g", ".16e", "+.12E", ".6f"):
            deck = namelist(body={"spacing": 0.01, "angle": -0.5})
            text = text_of(deck, float_format=form)
            self.check(f90nml.reads(text), text)

    def test_extreme_reals(self):
        self.check(namelist(solver={"max_step": 5e-324, "v_scale": 1.7976931348623157e308},
                            body={"velocity": [0.1 + 0.2, -1e-300]}))

    def test_minus_zero(self):
        self.check(namelist(body={"position": [-0.0, 0.0]}))

    def test_strings_with_quotes_blanks_and_syntax(self):
        for title in ("it's", 'say "so"', "it's \"so\"", "", " blanks ", "/ & ! , = $end", "back\\slash", "Größe 3 µm"):
            with self.subTest(title=title):
                text = text_of(namelist(run={"title": title}))
                self.assertEqual(echo_of(text)["run"]["title"], title)

    def test_large_integers(self):
        self.check(namelist(pores={"number": 7, "radius": [0.004, 0.008], "seed": 2 ** 53}))

    def test_repeated_groups(self):
        deck = f90nml.reads(text_of(namelist()) + "".join(
            text_of(f90nml.Namelist({"void": {"centre": [0.01 * k, 0.05], "radius": 0.001}})) for k in range(3)))
        echo = echo_of(text_of(deck))
        self.assertEqual([void["centre"][0] for void in echo["void"]], [0, 0.01, 0.02])

    def test_null_values_keep_defaults(self):
        deck = namelist(run={"gravity": [None, -3.0]}, output={"frame_interval": None})
        text = text_of(deck)
        echo = echo_of(text)
        self.assertEqual(echo["run"]["gravity"], [0, -3])
        self.assertEqual(echo["output"]["frame_interval"], 1e-3)

    def test_none_keeps_the_default(self):
        echo = echo_of(text_of(namelist(material={"thickness": None})))
        self.assertEqual(echo["material"]["thickness"], 1)

    def test_start_indices(self):
        deck = namelist(run={"gravity": [-3.5]}, body={"velocity": [1.5, 2.5]})
        deck["run"].start_index["gravity"] = [2]
        deck["body"].start_index["velocity"] = [1]
        text = text_of(deck)
        self.assertIn("(2)", text)
        self.assertIn("(1:2)", text)
        echo = echo_of(text)
        self.assertEqual(echo["run"]["gravity"], [0, -3.5])
        self.assertEqual(echo["body"]["velocity"], [1.5, 2.5])

    def test_default_start_index(self):
        deck = namelist()
        self.check(deck, text_of(deck, default_start_index=1))

    def test_a_patched_deck(self):
        with tempfile.TemporaryDirectory() as folder:
            before, after = pathlib.Path(folder, "a.nml"), pathlib.Path(folder, "b.nml")
            before.write_text(text_of(namelist()).replace("&body", "! a comment\n&body ! it's one"), encoding="utf-8")
            f90nml.patch(before, {"run": {"t_end": 0.5}, "body": {"size": [0.5, 0.25]}}, after)
            text = after.read_text(encoding="utf-8")
        self.check(namelist(run={"t_end": 0.5}, body={"size": [0.5, 0.25]}), text)

    def test_the_echo_written_again_resolves_to_itself(self):
        first = echo_of(text_of(namelist()))
        self.assertEqual(echo_of(text_of(copy.deepcopy(first))), first)


if __name__ == "__main__":
    DEM_BATCH = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()

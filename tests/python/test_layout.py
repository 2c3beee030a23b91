#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Is the C interface of the package that of the headers? `test_layout.py PROGRAM`

The program prints what C makes of the headers: every constant, the size of every type, offset and bytes of every member
at rest, and what the inline functions return. The library has every function of the interface, and none besides."""
import ctypes
import re
import subprocess
import sys
import unittest

from dem import c_interface, library

PROGRAM = None


def place_of(kind, member):
    """Offset and size of a member, whose names in nested structures are joined by dots."""
    offset = 0
    for name in member.split("."):
        field = getattr(kind, name)
        offset += field.offset
        kind = dict(entry[:2] for entry in kind._fields_)[name]
    return offset, field.size


def structure_of(name):
    """One at rest, or as an inline function of this name returns it."""
    name = re.sub(r"_(default|empty)$", "_default", name)
    return getattr(c_interface, name, None)


class Layout(unittest.TestCase):
    def test_constants_sizes_members_and_defaults(self):
        lines = subprocess.run([PROGRAM], capture_output=True, text=True, check=True).stdout.splitlines()
        compared = 0
        for line in lines:
            label, number, *data = line.split()
            name, _, member = label.partition(".")
            made = structure_of(name)
            if made is None and "_" in name and name.isupper():
                owner = next((kind for kind in vars(c_interface).values()
                              if isinstance(kind, type) and name in getattr(kind, "__members__", ())), None)
                self.assertIsNotNone(owner, label)
                self.assertEqual(int(owner[name]), int(number), label)
            elif isinstance(made, int):
                self.assertEqual(made, int(number), label)
            elif made is None:
                continue  # an inline function of arguments, which the package has no use for
            elif hasattr(made, "__members__"):
                self.assertEqual(ctypes.sizeof(ctypes.c_int), int(number), label)
            elif not member:
                self.assertEqual(ctypes.sizeof(made()), int(number), label)
            else:
                value = made()
                offset, size = place_of(type(value), member)
                self.assertEqual((offset, size), (int(number), len(data)), label)
                # A size is that of a structure at rest if its class sets it; of one within another who makes that does.
                is_size, is_made = member.endswith("struct_size"), name != type(value).__name__
                is_set = member == "struct_size" and issubclass(type(value), c_interface.SizedStructure)
                if not is_size or is_made or is_set:
                    found = list(bytes(value)[offset:offset + size])
                    self.assertEqual(found, [int(byte) % 256 for byte in data], label)
            compared += 1
        self.assertGreater(compared, 300)

    def test_functions_are_those_of_the_library(self):
        names = subprocess.run(["nm", "-D", "--defined-only", library.find()], capture_output=True, text=True,
                               check=True).stdout
        exported = set(re.findall(r" T (dem_(?!private_)\w+)", names))
        self.assertEqual(set(c_interface.FUNCTIONS), exported)

    def test_every_function_and_struct_says_what_it_does(self):
        silent = [name for name, (_, _, text) in c_interface.FUNCTIONS.items() if name not in text]
        self.assertEqual(silent, [])
        self.assertIn("m/s, the derivative of the place", c_interface.dem_pose.__doc__)
        self.assertIn("kg/m^3", c_interface.dem_material.__doc__)
        self.assertIn("[n_nodes][2] m", c_interface.FUNCTIONS["dem_reader_positions"][2])


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()

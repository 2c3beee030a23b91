#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes python/dem/c_interface.py, the C interface of include/dem for ctypes, and python/dem/records.py, what the
package gives and takes of it: `bindings.py SOURCE_ROOT`. With `--check` it only says whether they are what it would
write."""
import difflib
import os.path
import pathlib
import re
import sys
import textwrap

ROOT = pathlib.Path(sys.argv[1])
sys.path.insert(0, str(ROOT / "src" / "fortran"))
from headers import read_headers  # noqa: E402

NUMBERS = {"double": "c_double", "int": "c_int", "int32_t": "c_int32", "uint32_t": "c_uint32", "bool": "c_bool",
           "uint64_t": "c_uint64", "size_t": "c_size_t", "unsigned char": "c_ubyte", "dem_index": "c_int64",
           "char": "c_char", "void": "None"}
MAX_LINE = 120
HEAD = '''\
# SPDX-License-Identifier: BSD-3-Clause
"""The C interface of dem, name by name, written by python/bindings.py from the headers in include/dem. The texts are
those of the headers: shapes, units, ranges, errors, ownership. Programs use the package dem, which is made of this."""
from ctypes import (CFUNCTYPE, POINTER, Structure, c_bool, c_char, c_char_p, c_double, c_int, c_int32, c_int64,
                    c_size_t, c_ubyte, c_uint32, c_uint64, c_void_p, sizeof)
from enum import IntEnum
from typing import Any


class SizedStructure(Structure):
    """Begins with its size, by which the library knows what a struct of a program holds."""

    def __init__(self, **values: Any) -> None:
        super().__init__(struct_size=sizeof(type(self)), **values)
'''
RECORDS_HEAD = '''\
# SPDX-License-Identifier: BSD-3-Clause
"""What the package gives and takes of the structs of the library, with types: records of one instant, and keywords of
materials, obstacles and options. Written by python/bindings.py from the headers in include/dem; units and ranges are in
the texts of c_interface."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, TypedDict

import numpy as np
from numpy.typing import NDArray

from . import c_interface as c
from .library import Record

Vector = Sequence[float] | NDArray[Any]  # of two components, or of three with 0
'''
# class: struct, of numbers that the package returns
RECORDS = {"BodyMotion": "dem_body_motion", "BoundaryLoad": "dem_boundary_load", "Break": "dem_break",
           "Constants": "dem_constants", "Contact": "dem_contact", "Counts": "dem_counts", "Energy": "dem_energy",
           "Event": "dem_event", "Fracture": "dem_fracture", "ModelSize": "dem_model_size",
           "ObstacleLaws": "dem_obstacle", "ObstacleLoad": "dem_obstacle_load", "Options": "dem_options",
           "Overlap": "dem_overlap", "Pair": "dem_pair", "ShapeReport": "dem_shape_report",
           "Strain": "dem_strain", "Surfaces": "dem_surfaces"}
# class: struct, of numbers that the package takes by their names
KEYWORDS = {"MaterialKeywords": "dem_material", "ObstacleKeywords": "dem_obstacle", "OptionsKeywords": "dem_options",
            "TrajectoryKeywords": "dem_trajectory_options"}
BY_ITSELF = {"frame_interval", "fields"}  # arguments that the package has beside the keywords


def plain(comment):
    """The text of a comment without its frame."""
    lines = [re.sub(r"^\s*\*? ?", "", line) for line in comment.splitlines()]
    text = re.sub(r"\s+", " ", " ".join(lines)).strip()
    text = re.sub(r"\\(param(\[out\])?|return)\s+", lambda m: "\n" + {"r": "Returns ", "p": ""}[m.group(1)[0]], text)
    return re.sub(r"\s*\((\d+)\)(?=$|\n)", r" (equation \1)", text)


class Texts:
    """The comments of a header, by what they are about."""
    COMMENT = r"/\*\*(?P<text>(?:(?!\*/).)*)\*/\s*"

    def __init__(self, path):
        source = path.read_text(encoding="utf-8")
        self.of = {}
        for pattern in (r"(?:DEM_API|static inline) [\w *]+?\b(?P<name>\w+)\(",
                        r"typedef (?:struct|enum) (?P<name>\w+)", r"typedef \w+ \(\*(?P<name>\w+)\)"):
            for found in re.finditer(self.COMMENT + pattern, source, re.S):
                self.of[found["name"]] = plain(found["text"])
        for struct in re.finditer(r"typedef struct (\w+) \{(.*?)\n\} \1;", source, re.S):
            self.read_members(struct.group(1), struct.group(2))
        self.defaults = {name: self.read_assignments(body) for name, body in
                         re.findall(r"static inline (\w+) \w+_(?:default|empty)\(void\)[^\n]*\n\{(.*?)\n\}", source,
                                    re.S)}

    def read_members(self, struct, body):
        for declared, text in re.findall(r"([^;{}]*);[ \t]*/\*\*<((?:(?!\*/).)*)\*/", body, re.S):
            declared = re.sub(r"/\*.*?\*/", "", declared, flags=re.S)
            names = re.findall(r"(\w+)(?:\[\d+\])*\s*(?:,|$)", declared.strip())
            self.of[f"{struct}.{names[-1]}"] = plain(text) if len(names) == 1 else f"{', '.join(names)}: {plain(text)}"

    @staticmethod
    def read_assignments(body):
        return re.findall(r"^\s*\w+\.(\w+(?:\[\d\])?) = ([^;]*);", body, re.M)


class Writer:
    def __init__(self, headers):
        self.headers = headers
        self.enums = {name for header in headers for name, _ in header.enums}
        self.structs = {name for header in headers for name in header.structs}
        self.opaque = {name for header in headers for name in header.opaque}
        self.callbacks = {name: function for header in headers for name, function in header.callbacks.items()}
        self.texts = {header.name: Texts(ROOT / "include" / "dem" / header.name) for header in headers}
        self.lines = HEAD.splitlines()

    def kind(self, item, is_result=False):
        """The type for ctypes of a value, a pointer, an argument."""
        if item.type in self.callbacks:
            return item.type
        base = NUMBERS.get(item.type) or ("c_int" if item.type in self.enums else item.type)
        stars = item.stars
        if item.type == "char" and stars == 1 and (item.const or is_result):
            return "c_char_p"
        if item.type == "void" and stars:
            base, stars = "c_void_p", stars - 1
        for _ in range(stars):
            base = f"POINTER({base})"
        return base

    def argument(self, item):
        """Of an array in the list of arguments C gets the address."""
        return f"POINTER({self.kind(item)})" if item.shape else self.kind(item)

    def member(self, item):
        kind = self.kind(item)
        for extent in reversed(item.shape):
            kind = f"{kind} * {extent}"
        return f'("{item.name}", {kind})'

    def wrap(self, indent, head, parts, tail):
        """A list that is broken where lines would be too long."""
        line = indent + head
        inner = " " * len(line)
        for k, part in enumerate(parts):
            piece = part + ("," if k + 1 < len(parts) else tail)
            if len(line) + len(piece) + 1 > MAX_LINE:
                self.lines.append(line.rstrip())
                line = inner
            line += piece + " "
        self.lines.append((line if parts else line + tail).rstrip())

    def write_text(self, indent, text, members=()):
        """A docstring."""
        parts = [part for paragraph in text.split("\n") for part in
                 (textwrap.wrap(paragraph, MAX_LINE - len(indent) - 3) or [""])]
        for name, what in members:
            parts += textwrap.wrap(f"{name}: {what}", MAX_LINE - len(indent), subsequent_indent="    ")
        parts = [part.replace("\\", "\\\\") for part in parts] or ["As in the header."]
        self.lines.append(f'{indent}"""{parts[0]}')
        self.lines += [f"{indent}{part}".rstrip() for part in parts[1:]]
        if self.lines[-1].endswith('"') or len(self.lines[-1]) > MAX_LINE - 5:
            self.lines.append(indent)
        self.lines[-1] += '"""'

    def write_enum(self, texts, name, constants):
        if not name:
            self.lines += [""] + [f"{constant} = {value}" for constant, value in constants.items()]
            return
        self.lines += ["", "", f"class {name}(IntEnum):"]
        self.write_text("    ", texts.of.get(name, f"Values of {name}."))
        self.lines += [f"    {constant} = {value}" for constant, value in constants.items()]

    def write_struct(self, texts, name, members):
        sized = members[0].name == "struct_size"
        self.lines += ["", "", f"class {name}({'SizedStructure' if sized else 'Structure'}):"]
        known = [(item.name, texts.of[f"{name}.{item.name}"]) for item in members if f"{name}.{item.name}" in texts.of]
        self.write_text("    ", texts.of.get(name, f"Fields of {name}."), known)
        self.wrap("    ", "_fields_ = [", [self.member(item) for item in members], "]")
        if name in texts.defaults:
            self.write_defaults(name, texts.defaults[name])

    def write_defaults(self, name, assignments):
        self.lines += ["", "", f"def {name}_default() -> {name}:", f'    """A {name} with its defaults."""',
                       f"    value = {name}()"]
        for member, given in assignments:
            if not given.startswith("sizeof"):
                given = {"true": "True", "false": "False"}.get(given, re.sub(r"\s+", " ", given))
                given = given.replace("_empty()", "_default()")  # of a struct in a struct
                self.lines.append(f"    value.{member} = {given}")
        self.lines.append("    return value")

    def write_callback(self, name):
        function = self.callbacks[name]
        self.lines.append("")
        result = "None" if function.result.type == "void" and not function.result.stars else self.kind(function.result)
        self.wrap("", f"{name} = CFUNCTYPE(", [result, *map(self.argument, function.arguments)], ")")

    def write_functions(self):
        """name: (result, arguments, text)."""
        self.lines += ["", "", "FUNCTIONS: dict[str, tuple[Any, list[Any], str]] = {  # result, arguments, text"]
        for header in self.headers:
            for name, function in header.functions.items():
                result = function.result
                kind = "None" if result.type == "void" and not result.stars else self.kind(result, is_result=True)
                parts = [self.argument(item) for item in function.arguments]
                self.wrap("    ", f'"{name}": ({kind}, [', parts, "],") if parts else self.lines.append(
                    f'    "{name}": ({kind}, [],')
                names = ", ".join(item.name for item in function.arguments)
                text = f"{name}({names})\n" + self.texts[header.name].of.get(name, "")
                self.write_text("        ", text.strip())
                self.lines[-1] += "),"
        self.lines.append("}")

    def module(self):
        for name in sorted(self.opaque):
            self.lines += ["", "", f"class {name}(Structure):", f'    """Known to the library only."""']
        for header in self.headers:
            texts = self.texts[header.name]
            self.lines += ["", "", f"# ---- dem/{header.name}"]
            for name, constants in header.enums:
                self.write_enum(texts, name, constants)
            first = [name for name in header.callbacks if not self.needs_struct(header, name)]
            for name in first:
                self.write_callback(name)
            for name, members in header.structs.items():
                for callback in header.callbacks:
                    if callback not in first and self.is_ready(header, callback, name):
                        self.write_callback(callback)
                        first.append(callback)
                self.write_struct(texts, name, members)
            for callback in header.callbacks:
                if callback not in first:
                    self.write_callback(callback)
        self.write_functions()
        return "\n".join(self.lines) + "\n"

    def needs_struct(self, header, callback):
        return any(item.type in header.structs for item in self.callbacks[callback].arguments)

    def is_ready(self, header, callback, struct):
        """Whether the structs of its arguments stand before this one."""
        order = list(header.structs)
        needed = [item.type for item in self.callbacks[callback].arguments if item.type in header.structs]
        return all(order.index(name) < order.index(struct) for name in needed)


def enumerators(constants):
    """The names that the package takes: 'strain' of DEM_PLANE_STRAIN."""
    prefix = os.path.commonprefix(list(constants)).rpartition("_")[0] + "_"
    return [name.removeprefix(prefix).lower() for name in constants]


class Records:
    """The types of Python of what structs have."""

    def __init__(self, headers):
        self.enums = {name: constants for header in headers for name, constants in header.enums}
        self.structs = {name: members for header in headers for name, members in header.structs.items()}
        self.callbacks = {name for header in headers for name in header.callbacks}

    def number(self, kind):
        if kind in ("double", "bool"):
            return {"double": "float"}.get(kind, kind)
        return "int" if kind in NUMBERS or kind in self.enums else "Any"

    def given(self, item):
        """The type of what a record has."""
        if item.stars or item.type in self.callbacks:
            return "Any"
        kind = self.number(item.type)
        return kind if not item.shape else f"NDArray[{'np.float64' if kind == 'float' else 'Any'}]"

    def taken(self, item):
        """The type of what is taken by a name."""
        if item.type in self.enums:
            return f"Literal{enumerators(self.enums[item.type])} | int".replace("'", '"')
        return "Vector" if item.shape else self.number(item.type)

    def is_taken(self, item):
        """Not a pointer, nor what belongs to one."""
        is_length = item.name == "struct_size" or item.name.startswith("n_")
        return not (item.stars or item.type in self.callbacks or is_length or item.name in BY_ITSELF)

    def module(self):
        lines = RECORDS_HEAD.splitlines()
        for name, struct in RECORDS.items():
            lines += ["", "", f"class {name}(Record):", f"    struct = c.{struct}"]
            members = [item for item in self.structs[struct] if item.name != "struct_size"]
            lines += [f"    {item.name}: {self.given(item)}" for item in members]
        for name, struct in KEYWORDS.items():
            lines += ["", "", f"class {name}(TypedDict, total=False):", f'    """See c_interface.{struct}."""']
            for item in filter(self.is_taken, self.structs[struct]):
                lines += textwrap.wrap(f"    {item.name}: {self.taken(item)}", MAX_LINE, subsequent_indent=" " * 8)
        return "\n".join(lines) + "\n"


def difference(path, text):
    old = path.read_text(encoding="utf-8") if path.exists() else ""
    return "\n".join(difflib.unified_diff(old.splitlines(), text.splitlines(), path.name, "headers", lineterm=""))


known = read_headers(ROOT / "include" / "dem")
files = {ROOT / "python" / "dem" / f"{name}.py": writer(known).module()
         for name, writer in (("c_interface", Writer), ("records", Records))}
if sys.argv[2:] == ["--check"]:
    changed = "\n".join(filter(None, (difference(path, text) for path, text in files.items())))
    sys.exit(f"{changed}\nrun python/bindings.py" if changed else 0)
for path, text in files.items():
    path.write_text(text, encoding="utf-8")

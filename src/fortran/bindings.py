#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the Fortran module dem_c, the C interface of include/dem: `bindings.py SOURCE_ROOT`.
With `--check` it only says whether src/fortran/dem_c.f90 is what it would write."""
import difflib
import math
import pathlib
import sys

from headers import read_headers

NUMBERS = {
    "double": "real(c_double)", "int": "integer(c_int)", "int32_t": "integer(c_int32_t)",
    "uint32_t": "integer(c_int32_t)", "bool": "logical(c_bool)", "uint64_t": "integer(c_int64_t)", "size_t": "integer(c_size_t)",
    "unsigned char": "integer(c_signed_char)", "dem_index": "integer(dem_index)", "char": "character(kind=c_char)"}

# What C leaves open: how many of a thing a pointer is for. Structs are one unless they are here; other names are to be
# in one of both. "function.argument" goes before "argument".
ONE = {"out", "omega", "energy", "inertia", "size", "n", "n_nodes", "n_springs", "n_pieces", "n_parts", "n_fragments", "n_obstacles", "n_frames", "first", "count",
       "obstacle", "by", "angle", "dem_shape_area.area"}
MANY = {
    "obstacles": "*", "materials": "*", "laws": "*", "of": "*", "keep": "*", "piece": "*", "part": "*", "fragment": "*", "n_edges": "*",
    "nodes": "*", "springs": "*", "triangle": "*", "node": "*", "spring": "*", "area": "*", "triangle_factor": "*", "spring_factor": "*", "strength_factor": "*", "energy_factor": "*", "stretch_factor": "*", "strain": "*", "force": "*", "name": "*", "path": "*", "text": "*",
    "table": "*", "values": "*", "stress": "3, *", "x": "2, *", "v": "2, *", "dem_model_gap.x": "*", "dem_obstacle_velocity.x": "*", "velocity": "*",
    "dem_force.force": "2, *", "dem_simulation_contact_forces.force": "2, *", "pressure": "*", "direction": "2", "points": "2, *", "distance": "*", "triangles": "*", "pores": "3, *"}
MAY_BE_NULL = {
    "dem_lattice_pieces.piece", "dem_lattice_parts.part", "dem_lattice_assemble_mixed.of", "dem_lattice_weibull.of",
    "dem_lattice_weibull.triangle_factor", "dem_lattice_weibull.spring_factor", "dem_lattice_weaken.strength_factor",
    "dem_lattice_weaken.energy_factor", "dem_lattice_weaken.stretch_factor",
    "dem_lattice_edge_shares.direction", "dem_shape_lattice.report", "dem_lattice_inside.triangles",
    "dem_lattice_inside.springs", "dem_lattice_crossed.triangles", "dem_lattice_crossed.springs", "dem_model_create.obstacles", "dem_model_create_borrowing.obstacles", "dem_simulation_set_motion.x",
    "dem_simulation_set_motion.v", "dem_obstacle_moves.by", "dem_simulation_break.triangle", "dem_simulation_break.spring",
    "dem_simulation_broken.triangle", "dem_simulation_broken.spring", "dem_simulation_damage.triangle",
    "dem_simulation_damage.node"}
ZERO_AT_ENTRY = {"dem_force.force"}

MAX_LINE = 120
HEAD = """\
! SPDX-License-Identifier: BSD-3-Clause
!> The C interface of dem, name by name, written by src/fortran/bindings.py from the headers in include/dem, which tell
!> what everything does, with shapes, units, errors and ownership. Programs use the module dem, which is made of this.
module dem_c
  use, intrinsic :: iso_c_binding
  implicit none
  public

  integer, parameter :: dem_index = c_int64_t
"""


BYTES = {"double": 8, "int": 4, "int32_t": 4, "uint32_t": 4, "uint64_t": 8, "size_t": 8, "unsigned char": 1,
         "dem_index": 8, "char": 1, "bool": 1}


class Writer:
    def __init__(self, headers):
        self.headers = headers
        self.enums = {name for header in headers for name, _ in header.enums}
        self.members = {name: members for header in headers for name, members in header.structs.items()}
        self.structs = set(self.members)
        self.callbacks = {name for header in headers for name in header.callbacks}
        self.lines = HEAD.splitlines()

    def kind(self, item):
        """The Fortran type of a value."""
        if item.type in NUMBERS:
            return NUMBERS[item.type]
        return f"integer({item.type})" if item.type in self.enums else f"type({item.type})"

    def extents(self, function, item):
        """Of what a pointer points to."""
        if item.shape:
            return "(" + ", ".join(map(str, reversed(item.shape))) + ")"
        full = f"{function.name}.{item.name}"
        for name in (full, item.name):
            if name in MANY and full not in ONE:
                return f"({MANY[name]})"
        if item.type not in self.structs and not ONE & {full, item.name}:
            raise SystemExit(f"{function.name}: is '{item.name}' one or many? Say so in bindings.py")
        return ""

    def argument(self, function, item):
        """Its declaration: attributes, name with extents."""
        if item.type in self.callbacks:
            return f"procedure({item.type})", item.name
        if item.stars == 2:
            return "type(c_ptr), intent(out)", item.name
        if item.stars == 1 and item.type not in NUMBERS and item.type not in self.structs | self.enums:
            return "type(c_ptr), value", item.name
        if not item.stars and not item.shape:
            return f"{self.kind(item)}, value", item.name
        full = f"{function.name}.{item.name}"
        read_too = item.type in self.structs or full in ZERO_AT_ENTRY  # of a struct at least its size is read
        changed = "inout" if read_too else "out"
        optional = ", optional" if full in MAY_BE_NULL else ""
        return (f"{self.kind(item)}, intent({'in' if item.const else changed}){optional}",
                item.name + self.extents(function, item))

    def extent(self, item):
        """Bytes of one of them, and how C aligns it."""
        if item.stars or item.type in self.callbacks:
            return 8, 8
        if item.type in self.members:
            return self.layout(self.members[item.type])
        size = BYTES.get(item.type, 4)  # else an enum
        return size, size

    def layout(self, members):
        """sizeof of a struct of these members, and how it is aligned: tests/fortran compares it with C's."""
        end = most = 0
        for item in members:
            size, alignment = self.extent(item)
            most = max(most, alignment)
            end += -end % alignment + size * math.prod(item.shape)
        return end + -end % most, most

    def member(self, item):
        if item.type in self.callbacks:
            return "type(c_funptr)", f"{item.name} = c_null_funptr"
        if item.stars:
            return "type(c_ptr)", f"{item.name} = c_null_ptr"
        extents = "(" + ", ".join(map(str, reversed(item.shape))) + ")" if item.shape else ""
        rest = {"bool": " = .false."}.get(item.type, " = 0")
        return self.kind(item), item.name + extents + ("" if item.type in self.structs else rest)

    def declare(self, indent, pairs):
        """Neighbours of one type share a line."""
        before = None
        for attributes, name in pairs:
            if attributes == before and len(self.lines[-1]) + len(name) + 2 <= MAX_LINE:
                self.lines[-1] += f", {name}"
            else:
                self.lines.append(f"{indent}{attributes} :: {name}")
            before = attributes

    def write_enum(self, name, constants):
        self.lines.append("")
        if name:
            self.lines.append(f"  integer, parameter :: {name} = c_int")
        self.lines.append("  enum, bind(c)")
        self.declare("    ", [("enumerator", f"{constant} = {value}") for constant, value in constants.items()])
        self.lines.append("  end enum")

    def write_struct(self, name, members):
        self.lines += ["", f"  type, bind(c) :: {name}"]
        declared = [self.member(item) for item in members]
        if members[0].name == "struct_size":
            declared[0] = declared[0][0], f"struct_size = {self.layout(members)[0]}"
        self.declare("    ", declared)
        self.lines.append("  end type")

    def write_function(self, function):
        result = function.result
        kind = "subroutine"
        if result.stars or result.type != "void":
            kind = ("type(c_ptr)" if result.stars else self.kind(result)) + " function"
        name, label = function.name, ""
        if result.type == "char":  # the module dem has a function of that name, which returns a Fortran string
            name, label = "c_" + name.removeprefix("dem_"), f", name='{name}'"
        names = ", ".join(item.name for item in function.arguments)
        self.lines += ["", f"    {kind} {name}({names}) bind(c{label})"]
        assert len(self.lines[-1]) <= MAX_LINE, function.name
        self.lines.append("      import")
        self.declare("      ", [self.argument(function, item) for item in function.arguments])
        self.lines.append(f"    end {kind.split()[-1]}")

    def write_interface(self, head, functions):
        if functions:
            self.lines += ["", f"  {head}"]
            for function in functions.values():
                self.write_function(function)
            self.lines += ["", "  end interface"]

    def module(self):
        for header in self.headers:
            rule = "-" * (MAX_LINE - len(f"  ! ---- dem/{header.name} "))
            self.lines += ["", f"  ! ---- dem/{header.name} {rule}"]
            for name, constants in header.enums:
                self.write_enum(name, constants)
            for name, members in header.structs.items():
                self.write_struct(name, members)
            self.write_interface("abstract interface", header.callbacks)
            self.write_interface("interface", header.functions)
        return "\n".join(self.lines + ["end module", ""])


root = pathlib.Path(sys.argv[1])
path = root / "src" / "fortran" / "dem_c.f90"
text = Writer(read_headers(root / "include" / "dem")).module()
if sys.argv[2:] != ["--check"]:
    path.write_text(text, encoding="utf-8")
    sys.exit()
old = path.read_text(encoding="utf-8")
difference = "\n".join(difflib.unified_diff(old.splitlines(), text.splitlines(), path.name, "headers", lineterm=""))
sys.exit(f"{difference}\nrun src/fortran/bindings.py" if difference else 0)

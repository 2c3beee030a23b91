#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Lattice files that are refused, made by an independent writer: `test_refused_lattice.py DEM_BATCH`. Each is one line in
our words, whatever HDF5 has to say of it. Skipped without the Python package h5py."""
import sys

import refusal
from refusal import BASE, FILE, edit, stderr_of

try:
    import h5py
    import numpy
except ImportError as error:
    print(f"skipped: the Python packages h5py and numpy are needed ({error})")
    sys.exit(77)

# A square of two triangles.
GOOD = {"x": [[0.0, 0.0], [0.01, 0.0], [0.01, 0.01], [0.0, 0.01]], "mass": [1.0, 1.0, 1.0, 1.0],
        "ends": [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]], "rest_length": [0.01, 0.01, 0.01, 0.01, 2**0.5 * 0.01],
        "stiffness": [1e3, 1e3, 1e3, 1e3, 1e3], "triangles": [[0, 1, 2], [0, 2, 3]]}


def put(file, **changes):
    """The lattice with other datasets in the place of its own; None: none."""
    for name, data in (GOOD | changes).items():
        if data is not None:
            file["lattice/" + name] = data


def empty(file, name):
    put(file, **{name: None})
    return file["lattice"]


def create(name, shape, dtype="f8", **options):
    """A maker of a file in which this dataset is made by hand."""
    return lambda file: empty(file, name).create_dataset(name, shape, dtype, **options)


def changed(**changes):
    return lambda file: put(file, **changes)


def soft(file):
    empty(file, "mass")["mass"] = h5py.SoftLink("/lattice/stiffness")


def external(file):
    empty(file, "mass")["mass"] = h5py.ExternalLink("other.h5", "/mass")


def soft_group(file):
    put(file)
    file.move("lattice", "elsewhere")
    file["lattice"] = h5py.SoftLink("/elsewhere")


def external_group(file):
    file["lattice"] = h5py.ExternalLink("other.h5", "/lattice")


def dangling(file):
    empty(file, "mass")["mass"] = h5py.SoftLink("/nowhere")


def looping(file):
    file["lattice"] = h5py.SoftLink("/lattice")


def virtual(file):
    layout = h5py.VirtualLayout((4,), "f8")
    layout[:] = h5py.VirtualSource("other.h5", "mass", (4,))
    empty(file, "mass").create_virtual_dataset("mass", layout)


def stored_outside(file):
    empty(file, "mass").create_dataset("mass", (4,), "f8", external=[("/etc/passwd", 0, 32)])


def no_space(file):
    empty(file, "mass")["mass"] = h5py.Empty("f8")


def scalar(file):
    empty(file, "mass")["mass"] = 1.0


def group_for_dataset(file):
    empty(file, "mass").create_group("mass")


def dataset_for_group(file):
    file["lattice"] = 1.0


def type_for_dataset(file):
    empty(file, "mass")["mass"] = numpy.dtype("f8")


def unknown_filter(file):
    space, plist = h5py.h5s.create_simple((4,)), h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    plist.set_chunk((4,))
    plist.set_filter(32015, h5py.h5z.FLAG_OPTIONAL, (3,))
    h5py.h5d.create(empty(file, "mass").id, b"mass", h5py.h5t.NATIVE_DOUBLE, space, plist)


def compound(file):
    empty(file, "mass").create_dataset("mass", (4,), numpy.dtype([("a", "f8"), ("b", "f8")]))


def reference(file):
    empty(file, "mass").create_dataset("mass", (4,), h5py.ref_dtype)


NOT_REAL, NOT_WHOLE = "is neither floating-point nor integer", "is not integer"
NAMES = ("is none of the datasets of a lattice: x, mass, ends, rest_length, stiffness, viscosity, critical_stretch, "
         "triangles, guard, area_stiffness, thickness, modulus, coupling, strength, softening, "
         "compressive_strength, confinement, own_stress, body, position, velocity, fixed, rigid, contact_nodes")
# name, maker, what is said behind the file's name
FILES = [
    # names and links
    ("empty file", lambda file: None, "/lattice: is missing"),
    ("empty group", lambda file: file.create_group("lattice"), "/lattice/x: is missing"),
    ("unknown name", changed(velocities=[1.0]), "/lattice/velocities: " + NAMES),
    ("name of other bytes", changed(**{"m\x1b[31mass": [1.0]}), "/lattice/m?[31mass: " + NAMES),
    ("long name", changed(**{1000 * "m": [1.0]}), "/lattice/" + 40 * "m" + ": " + NAMES),
    ("soft link", soft, "/lattice/mass: is a soft or external link"),
    ("external link", external, "/lattice/mass: is a soft or external link"),
    ("soft link to the group", soft_group, "/lattice: is a soft or external link"),
    ("external link to the group", external_group, "/lattice: is a soft or external link"),
    ("link to nowhere", dangling, "/lattice/mass: is a soft or external link"),
    ("link to itself", looping, "/lattice: is a soft or external link"),
    ("group for a dataset", group_for_dataset, "/lattice/mass: is not a readable dataset (not a dataset)"),
    ("dataset for the group", dataset_for_group, "/lattice: is not a readable group (not a group)"),
    ("type for a dataset", type_for_dataset, "/lattice/mass: is not a readable dataset (not a dataset)"),
    ("missing dataset", changed(mass=None), "/lattice/mass: is missing"),
    ("springs by half", changed(stiffness=None), "/lattice/stiffness: is missing"),
    ("guard without triangles", changed(triangles=None, guard=[1.0, 1.0]), "/lattice/guard: is there without triangles"),
    # storage
    ("virtual storage", virtual, "/lattice/mass: has a virtual or unknown layout"),
    ("external storage", stored_outside, "/lattice/mass: keeps its data in an external file"),
    ("scale-offset", create("mass", (4,), chunks=(4,), scaleoffset=3, data=numpy.ones(4)),
     "/lattice/mass: uses a filter other than deflate, shuffle and fletcher32"),
    ("LZF", create("mass", (4,), chunks=(4,), compression="lzf", data=numpy.ones(4)),
     "/lattice/mass: uses a filter other than deflate, shuffle and fletcher32"),
    ("a filter that is not there", unknown_filter,
     "/lattice/mass: uses a filter other than deflate, shuffle and fletcher32"),
    ("no data", create("mass", (4,)), "/lattice/mass: claims more data than the file holds"),
    ("absurd size without data", create("x", (2**39, 2), chunks=(1024, 2)),
     "/lattice/x: claims more data than the file holds"),
    ("more rows than any lattice", create("x", (2**41, 2), chunks=(1024, 2)), "/lattice/x: has more than 2^40 rows"),
    # types and shapes
    ("text", changed(mass="heavy"), "/lattice/mass: " + NOT_REAL),
    ("texts", changed(mass=["a", "b", "c", "d"]), "/lattice/mass: " + NOT_REAL),
    ("records", compound, "/lattice/mass: " + NOT_REAL),
    ("references", reference, "/lattice/mass: " + NOT_REAL),
    ("complex numbers", changed(mass=[1j, 1, 1, 1]), "/lattice/mass: " + NOT_REAL),
    ("lists", create("mass", (4,), h5py.vlen_dtype("f8")), "/lattice/mass: " + NOT_REAL),
    ("arrays", create("mass", (4,), numpy.dtype(("f8", (2,)))), "/lattice/mass: " + NOT_REAL),
    ("opaque bytes", changed(mass=numpy.zeros(4, "V8")), "/lattice/mass: " + NOT_REAL),
    ("booleans for reals", changed(mass=[True, True, True, True]), "/lattice/mass: " + NOT_REAL),
    ("reals for numbers of nodes", changed(ends=numpy.array(GOOD["ends"], "f8")), "/lattice/ends: " + NOT_WHOLE),
    ("reals for flags", changed(fixed=[0.0, 0.0, 0.0, 1.0]), "/lattice/fixed: is neither integer nor boolean"),
    ("no space", no_space, "/lattice/mass: is not of shape [n]"),
    ("scalar", scalar, "/lattice/mass: is not of shape [n]"),
    ("rank too high", changed(mass=[[1.0], [1.0], [1.0], [1.0]]), "/lattice/mass: is not of shape [n]"),
    ("rank too low", changed(x=8 * [0.0]), "/lattice/x: is not of shape [n][2]"),
    ("three dimensions", changed(x=numpy.zeros((4, 3))), "/lattice/x: is not of shape [n][2]"),
    ("corners by two", changed(triangles=[[0, 1], [2, 3]]), "/lattice/triangles: is not of shape [n][3]"),
    ("rank 32", changed(mass=numpy.zeros(32 * (1,))), "/lattice/mass: is not of shape [n]"),
    # numbers that do not fit together
    ("too few masses", changed(mass=[1.0, 1.0, 1.0]), "/lattice/mass: has 3 rows where the datasets before it have 4"),
    ("too many stiffnesses", changed(stiffness=6 * [1e3]),
     "/lattice/stiffness: has 6 rows where the datasets before it have 5"),
    ("too few strengths", changed(strength=[1e6]), "/lattice/strength: has 1 rows where the datasets before it have 2"),
    ("too many strengths", changed(strength=3 * [1e6]), "/lattice/strength: has 3 rows where the datasets before it have 2"),
    ("strengths of springs", changed(critical_stretch=[0.1, 0.1]),
     "/lattice/critical_stretch: has 2 rows where the datasets before it have 5"),
    ("too few softenings", changed(strength=[1e6, 1e6], softening=[2.0]),
     "/lattice/softening: has 1 rows where the datasets before it have 2"),
    ("too few strengths under pressure", changed(strength=[1e6, 1e6], compressive_strength=[1e7]),
     "/lattice/compressive_strength: has 1 rows where the datasets before it have 2"),
    ("strengths without triangles", changed(triangles=None, strength=[1e6, 1e6]),
     "/lattice/strength: is there without triangles"),
    ("no node", changed(x=numpy.zeros((0, 2)), mass=numpy.zeros(0), ends=None, rest_length=None, stiffness=None,
                        triangles=None), "/lattice/x: has no nodes"),
    ("end that is no node", changed(ends=[[0, 1], [1, 2], [2, 3], [3, 4], [0, 2]]),
     "/lattice: spring 3 has node 4, but there are 4 nodes"),
    ("negative end", changed(ends=[[0, 1], [1, 2], [2, 3], [3, -1], [0, 2]]),
     "/lattice: spring 3 has node -1, but there are 4 nodes"),
    ("corner that is no node", changed(triangles=[[0, 1, 2], [0, 2, 2**40]]),
     "/lattice: triangle 1 has node 1099511627776, but there are 4 nodes"),
    ("body that does not fit", changed(body=numpy.array([0, 0, 0, 2**40])),
     "/lattice/body: cannot be read (can't handle conversion exception)"),
    ("contact of no node", changed(contact_nodes=[0, 9]),
     "/lattice/contact_nodes: entry 1 is 9, which is no node: there are 4"),
]
NO_SPRING = ("that no spring connects to its largest, of {} m in its own coordinates; 'disconnected' can remove or keep such "
             "parts")
# What can be read and makes no body: name, maker, message
BODIES = [
    ("mass 0", changed(mass=[1.0, 0.0, 1.0, 1.0]), "13:5 body 1: node 1: mass must be > 0, got 0 kg"),
    ("mass NaN", changed(mass=[1.0, float("nan"), 1.0, 1.0]), "13:5 body 1: node 1: mass must be > 0, got nan kg"),
    ("place far away", changed(x=[[0.0, 0.0], [1e300, 0.0], [0.01, 0.01], [0.0, 0.01]]),
     "14:5 body 1 has coordinates of up to 1e+300 m, so large that rounding blurs its spacing of 0.01 m"),
    ("spring of no rest length", changed(rest_length=[0.01, 0.0, 0.01, 0.01, 0.01]),
     "13:5 body 1: spring 1: rest length must be > 0, got 0 m"),
    ("stiffness negative", changed(stiffness=[1e3, -1e3, 1e3, 1e3, 1e3]),
     "13:5 body 1: spring 1: stiffness must be > 0, got -1000 N"),
    ("viscosity negative", changed(viscosity=[0.0, -1.0, 0.0, 0.0, 0.0]),
     "13:5 body 1: spring 1: viscosity must be >= 0, got -1 N s"),
    ("spring to itself", changed(ends=[[0, 1], [1, 1], [2, 3], [3, 0], [0, 2]]),
     "13:5 body 1: spring 1 joins node 1 to itself"),
    ("two springs of two nodes", changed(ends=[[0, 1], [1, 0], [2, 3], [3, 0], [0, 2]]),
     "13:5 body 1: springs 0 and 1 both join nodes 0 and 1"),
    ("spring of no length", changed(x=[[0.0, 0.0], [0.0, 0.0], [0.01, 0.01], [0.0, 0.01]]),
     "13:5 body 1: spring 0: its nodes 0 and 1 are at the same place"),
    ("node without springs", changed(ends=[[0, 1], [1, 2], [2, 0], [0, 1], [0, 2]]),
     "11:1 body 1 has 1 part " + NO_SPRING.format("1 node at (0, 0.01)")),
    ("two parts", changed(x=GOOD["x"] + [[1.0, 0.0], [1.01, 0.0]], mass=6 * [1.0], ends=GOOD["ends"] + [[4, 5]],
                          rest_length=GOOD["rest_length"] + [0.01], stiffness=6 * [1e3]),
     "11:1 body 1 has 1 part " + NO_SPRING.format("2 nodes at (1, 0)")),
    ("triangle clockwise", changed(triangles=[[0, 2, 1], [0, 2, 3]]),
     "13:5 body 1: triangle 0 (nodes 0, 2, 1): area must be > 0, got -5e-05 m^2"),
    ("strength negative", changed(strength=[1e6, -1e6]), "13:5 body 1: triangle 1: strength must be > 0, got -1e+06 Pa"),
    ("strength NaN", changed(strength=[float("nan"), 1e6]), "13:5 body 1: triangle 0: strength must be > 0, got nan Pa"),
    ("critical stretch negative", changed(critical_stretch=[0.1, 0.1, 0.1, 0.1, -0.1]),
     "13:5 body 1: spring 4: critical stretch must be > 0, got -0.1"),
    ("critical stretch NaN", changed(critical_stretch=[0.1, 0.1, 0.1, 0.1, float("nan")]),
     "13:5 body 1: spring 4: critical stretch must be > 0, got nan"),
    ("softening NaN", changed(strength=[1e6, 1e6], softening=[2.0, float("nan")]),
     "13:5 body 1: triangle 1: softening must be >= 1, got nan"),
    ("weaker under pressure", changed(strength=[1e6, 1e6], compressive_strength=[1e7, 1e5]),
     "13:5 body 1: triangle 1: compressive strength must be at least its strength, 1e+06 Pa, got 100000 Pa"),
    ("spring between bodies", changed(body=[0, 0, 0, 2]), "13:5 body 1: spring 2 joins bodies 0 and 2"),
    ("masses too small", changed(mass=4 * [1e-308], stiffness=5 * [1e10]), "13:5 body 1: stiffness over mass is too large to compute with"),
]


class Lattice(refusal.Refusal):
    def make(self, maker):
        with h5py.File(self.folder / "part.h5", "w") as file:
            maker(file)

    def setUp(self):
        super().setUp()
        with h5py.File(self.folder / "other.h5", "w") as file:
            put(file)
            file["mass"] = GOOD["mass"]
        self.put(FILE)

    def test_the_good_file_is_good(self):
        self.make(put)
        code, _, stderr, _ = self.run_program("--check", "deck.nml")
        self.assertEqual((code, stderr), (0, ""))

    def test_files(self):
        self.assertEqual(len({name for name, _, _ in FILES}), len(FILES))
        for name, maker, reason in FILES:
            with self.subTest(name):
                self.make(maker)
                self.refuse(3, stderr_of(["13:5 body 1: part.h5: " + reason]), "--check", "deck.nml")

    def test_bodies(self):
        for name, maker, message in BODIES:
            with self.subTest(name):
                self.make(maker)
                self.refuse(3, stderr_of([message]), "--check", "deck.nml")

    def test_starts_beyond_a_limit(self):
        """Whether bodies touch or not, what is said is about the file, that of the second of two bodies, too."""
        wide = [[0.0, 0.0], [0.02, 0.0], [0.02, 0.01], [0.0, 0.01]]
        remedy = "; larger limits, or a 'position' that strains it less, are needed in its file"
        self.make(changed(position=wide, critical_stretch=5 * [0.1], thickness=[1.0, 1.0]))
        message = " at (0, {}) m has the strain 1 at the start, beyond its critical stretch 0.1" + remedy
        other = edit(BASE, "&output -> &body shape = 'file', file = 'part.h5', position = 0, 0.2 /\n&output")
        for contact in ("", "&contact bodies = 'none' /\n", "&contact bodies = 'all', thickness = 1e-4 /\n"):
            self.put(FILE + contact)
            self.refuse(3, stderr_of(["13:5 spring 0 of body 1" + message.format("0.001")]), "--check", "deck.nml")
            self.put(other + contact)
            self.refuse(3, stderr_of(["23:23 spring 73 of body 2" + message.format("0.2")]), "--check", "deck.nml")

        # Twice as wide: both triangles have the sum of r x f over 5e-5 m^3, f = 1000 N along one edge and half of 581 N
        # along the other, 503960, 25990 and 51980 Pa.
        self.make(changed(position=wide, strength=[1e5, 6e5], thickness=[1.0, 1.0]))
        self.put(FILE)
        self.refuse(3, stderr_of(["13:5 triangle 0 of body 1 at (0, 0.001) m has the stress 509545 Pa at the start, beyond its "
                                  "strength 100000 Pa" + remedy]), "--check", "deck.nml")

    def test_rigid_bodies_need_triangles(self):
        rigid = edit(FILE, "velocity = 0, -1 -> rigid = .true.")
        self.make(changed(triangles=None))
        for contact in ("", "&contact bodies = 'all', thickness = 1e-4 /\n"):
            self.put(rigid + contact + "&solver max_step = 1e-4 /\n")
            self.refuse(3, stderr_of(["15:5 'rigid' in &body: body 1 has no triangles, and so no surface that could touch anything"]),
                        "--check", "deck.nml")

    def test_a_large_lattice_is_refused_by_its_extents(self):
        """4e5 nodes in a file of a few kilobytes: nothing of them is read."""
        def large(file):
            put(file, x=None, mass=None)
            for name, shape in (("x", (400000, 2)), ("mass", (400000,))):
                file["lattice"].create_dataset(name, data=numpy.zeros(shape), chunks=(40000,) + shape[1:], compression=1)
        self.make(large)
        self.refuse(6, stderr_of(["11:1 the run takes at least 0.24 GB of memory for its 4e+05 nodes; the limit is 0.1 GB, and "
                                  "--max-memory sets it"]), "--check", "--max-memory", "0.1", "deck.nml")

    def test_files_cut_short(self):
        """Anywhere: one line, with HDF5's cause."""
        self.make(put)
        whole = (self.folder / "part.h5").read_bytes()
        for size in range(0, len(whole) - 1, len(whole) // 40):
            with self.subTest(size):
                (self.folder / "part.h5").write_bytes(whole[:size])
                code, _, stderr, _ = self.run_program("--check", "deck.nml")
                self.assertEqual(code, 3)
                self.assertRegex(stderr, r"\Adeck\.nml:13:5: error: body 1: part\.h5: [^\n]+\n\Z")


if __name__ == "__main__":
    refusal.main()

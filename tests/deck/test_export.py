#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Exports of the shipped decks, read by readers of others: `test_export.py DEM_BATCH DEM_EXPORT INPUTS DOCS`. VTU and PVD by
VTK, the files of LAMMPS by MDAnalysis and line by line, CSV by Python: all numbers are those that h5py finds in the run."""
import csv
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import warnings
import xml.etree.ElementTree as xml

try:
    import h5py
    import numpy as np
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    warnings.simplefilter("ignore")
    import MDAnalysis
except ImportError as error:
    print(f"skipped: the Python packages h5py, MDAnalysis, numpy and vtk are needed ({error})")
    sys.exit(77)

DEM_BATCH, DEM_EXPORT, INPUTS, DOCS = (pathlib.Path(word).resolve() for word in sys.argv[1:5])

RUNS = {
    "rectangle": ["body.spacing=5e-3", "run.t_end=3e-3"],
    "disc": ["body.spacing=5e-3", "run.t_end=3e-3"],
    "porous": ["run.t_end=2e-3"],
    "hammer": ["run.t_end=2e-3"],
    "every_key": ["run.t_end=2e-3", "output.precision='double'"],
}
FOLDER = None   # of all runs, until the end


def setUpModule():
    global FOLDER
    FOLDER = tempfile.TemporaryDirectory()
    for name, settings in RUNS.items():
        words = [word for setting in [*settings, "output.events=T", "output.frame_interval=1e-3"] for word in ("--set", setting)]
        subprocess.run([DEM_BATCH, *words, INPUTS / f"{name}.nml"], cwd=FOLDER.name, check=True, stdout=subprocess.DEVNULL)


def tearDownModule():
    FOLDER.cleanup()


class Run:
    """What h5py finds in it."""

    def __init__(self, name):
        self.path = pathlib.Path(FOLDER.name, f"{name}.vtkhdf")
        self.file = h5py.File(self.path)
        self.times = self.file["VTKHDF/Steps/Values"][...]
        self.lattice = {key: dataset[...] for key, dataset in self.file["lattice"].items()}
        self.count = {"PointData": len(self.lattice["x"]), "CellData": len(self.lattice["ends"])}

    def points(self, frame):
        n = self.count["PointData"]
        return self.file["VTKHDF/Points"][frame * n:(frame + 1) * n]

    def arrays(self, group, frame):
        n = self.count[group]
        for name, dataset in self.file["VTKHDF"][group].items():
            if name == "vtkGhostType":  # which tells VTK what is broken
                continue
            constant = name in ("id", "body") or name.startswith("peak_")
            yield name, constant, dataset[:] if constant else dataset[frame * n:(frame + 1) * n]


def export(*words, folder):
    return subprocess.run([DEM_EXPORT, *map(str, words)], cwd=folder, capture_output=True, text=True, check=False)


class Exports(unittest.TestCase):
    def each(self, form, *options):
        """Every run, exported into a folder of its own."""
        for name in RUNS:
            with tempfile.TemporaryDirectory() as folder:
                run = Run(name)
                done = export(run.path, "--to", form, *options, folder=folder)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(done.stdout, "")
                self.assertEqual([*pathlib.Path(folder).glob("*.new")], [])
                yield run, pathlib.Path(folder, name), done.stderr

    def same(self, found, expected, what):
        found, expected = np.asarray(found), np.asarray(expected)
        self.assertEqual(found.shape, expected.shape, what)
        self.assertTrue(np.array_equal(found, expected), what)


class Vtu(Exports):
    @staticmethod
    def read(path):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(path))
        reader.Update()
        return reader.GetOutput()

    def attributes(self, found, expected, what):
        self.assertEqual({found.GetArrayName(k) for k in range(found.GetNumberOfArrays())}, set(expected), what)
        for name, values in expected.items():
            array = vtk_to_numpy(found.GetArray(name))
            self.assertEqual(array.dtype, values.dtype, f"{what} {name}")
            self.same(array, values, f"{what} {name}")

    def test_every_frame_has_all_arrays(self):
        for run, stem, _ in self.each("vtu"):
            for frame, t in enumerate(run.times):
                grid = self.read(f"{stem}_{frame:04d}.vtu")
                self.same(vtk_to_numpy(grid.GetPoints().GetData()), run.points(frame), "points")
                self.same(vtk_to_numpy(grid.GetCells().GetConnectivityArray()), run.lattice["ends"].ravel(), "springs")
                self.assertEqual({grid.GetCellType(k) for k in range(grid.GetNumberOfCells())}, {3})
                self.attributes(grid.GetPointData(), {n: v for n, _, v in run.arrays("PointData", frame)}, "nodes")
                self.attributes(grid.GetCellData(), {n: v for n, _, v in run.arrays("CellData", frame)}, "springs")
                fields = {n: d[frame:frame + 1] for n, d in run.file["VTKHDF/FieldData"].items()}
                self.attributes(grid.GetFieldData(), {"TimeValue": np.array([t]), **fields}, "fields")

    def test_the_series_has_the_times(self):
        for run, stem, _ in self.each("vtu"):
            sets = xml.parse(f"{stem}.pvd").getroot().findall("Collection/DataSet")
            self.same([float(s.get("timestep")) for s in sets], run.times, "times")
            self.assertEqual([s.get("file") for s in sets], [f"{stem.name}_{k:04d}.vtu" for k in range(len(run.times))])

    def test_obstacles_are_lines(self):
        for run, stem, _ in self.each("vtu", "--frames", "0"):
            grid = self.read(f"{stem}.obstacle.vtu")
            points = [group["points"][...] for _, group in sorted(run.file["obstacles"].items(), key=lambda item: int(item[0]))]
            self.same(vtk_to_numpy(grid.GetPoints().GetData())[:, :2], np.vstack(points), "points")
            owner = np.repeat(np.arange(len(points), dtype="i4"), [len(p) - 1 for p in points])
            self.attributes(grid.GetCellData(), {"obstacle": owner}, "lines")


def read_dump(path, items):
    """Strictly: what LAMMPS writes, and nothing else. Yields step, box, names of columns and rows."""
    lines = iter(path.read_text(encoding="ascii").splitlines())
    for line in lines:
        assert line == "ITEM: TIMESTEP", line
        step = int(next(lines))
        assert next(lines) == f"ITEM: NUMBER OF {items}"
        count = int(next(lines))
        assert next(lines) == "ITEM: BOX BOUNDS ss ss pp"
        box = np.array([next(lines).split() for _ in range(3)], float)
        head = next(lines).split()
        assert head[:2] == ["ITEM:", items]
        yield step, box, head[2:], np.array([next(lines).split() for _ in range(count)], float).reshape(count, len(head) - 2)


def read_data(path):
    """Sections by name, each a list of rows; "" has what stands before them."""
    sections, name = {"": []}, ""
    for line in path.read_text(encoding="ascii").splitlines()[1:]:
        line = line.partition("#")[0].strip()
        if line and line[0].isalpha():
            name = line
            sections[name] = []
        elif line:
            sections[name].append(line.split())
    return sections


COMPONENTS = {"stress": "xx yy zz xy yz xz".split(), "peak_stress": "xx yy zz xy yz xz".split(), "principal_stress": "12"}


def columns_of(name, values):
    """Names and numbers of the components of an array."""
    if values.ndim == 1:
        return [(name, values)]
    return [(f"{name}_{c}", column) for c, column in zip(COMPONENTS.get(name, "xyz"), values.T)]


class Lammps(Exports):
    def test_the_data_file_is_the_body_at_the_start(self):
        for run, stem, _ in self.each("lammps"):
            data, lattice = read_data(stem.with_suffix(".data")), run.lattice
            n, m = run.count.values()
            types = [float(row[1]) for row in data["Masses"]]
            bonds = np.array(data["Bond Coeffs"], float)
            self.assertEqual(data[""][:4], [[str(n), "atoms"], [str(m), "bonds"], [str(len(types)), "atom", "types"],
                                            [str(len(bonds)), "bond", "types"]])
            atoms = np.array(data["Atoms"], float)
            self.same(atoms[:, 0], np.arange(1, n + 1), "ids")
            self.same(atoms[:, 1], lattice["body"] + 1, "molecules")
            start = lattice["position"] if "position" in lattice else lattice["x"]
            moved = lattice.get("rigid", np.zeros(n)) > 0  # which the projection on rigid motions has rounded
            self.same(atoms[~moved, 3:5], start[~moved], "positions")
            self.assertLess(np.abs(atoms[:, 3:5] - start).max(), 1e-16)
            masses = np.array(types)[atoms[:, 2].astype(int) - 1]
            self.assertLess(abs(masses / lattice["mass"] - 1).max(), 1e-12)
            seen = run.file["VTKHDF/PointData/velocity"][:n, :2]
            rounded = seen.dtype == "f4" and np.array_equal(seen, lattice["velocity"].astype("f4"))
            self.same(np.array(data["Velocities"], float)[:, 1:3], lattice["velocity"] if rounded else seen, "velocities")
            self.assertEqual(rounded, stem.name != "every_key")
            rows = np.array(data["Bonds"], int)
            self.same(rows[:, 2:], lattice["ends"] + 1, "ends")
            k, r0 = bonds[rows[:, 1] - 1, 1:].T
            self.assertLess(abs(r0 / lattice["rest_length"] - 1).max(), 1e-12)
            self.assertLess(abs(2 * k * r0 / lattice["stiffness"] - 1).max(), 3e-12)

    def test_the_dumps_are_the_frames(self):
        for run, stem, _ in self.each("lammps"):
            for items, group, ending, first in (("ATOMS", "PointData", ".dump", 6), ("ENTRIES", "CellData", ".local.dump", 4)):
                frames = list(read_dump(stem.with_suffix(ending), items))
                self.assertEqual([step for step, *_ in frames], list(range(len(run.times))))
                for step, box, names, rows in frames:
                    low, high = box[:2].T
                    x = run.points(step)[:, :2]
                    self.assertTrue((low < x.min(axis=0)).all() and (high > x.max(axis=0)).all())
                    expected = {n: v for name, constant, array in run.arrays(group, step) if not constant and name != "broken"
                                for n, v in columns_of(name.replace("velocity", "v"), array)}
                    expected = {re.sub("^v_", "v", n): v for n, v in expected.items()}
                    self.assertEqual(set(names[first:]), set(expected))
                    for k, name in enumerate(names[first:], first):
                        self.same(rows[:, k].astype(expected[name].dtype), expected[name], name)
                    if group == "PointData":
                        self.assertEqual(names[:6], ["id", "mol", "type", "x", "y", "z"])
                        self.same(rows[:, 3:6], run.points(step), "positions")
                    else:
                        self.assertEqual(names[:4], ["index", "btype", "batom1", "batom2"])
                        self.same(rows[:, 2:4], run.lattice["ends"] + 1, "ends")

    def test_mdanalysis_reads_them(self):
        for run, stem, _ in self.each("lammps"):
            universe = MDAnalysis.Universe(f"{stem}.data", f"{stem}.dump", topology_format="DATA", format="LAMMPSDUMP",
                                           lammps_coordinate_convention="unscaled", dt=1.0)
            n = run.count["PointData"]
            self.assertEqual((len(universe.atoms), universe.trajectory.n_frames), (n, len(run.times)))
            self.same(np.sort(universe.bonds.indices, axis=0), np.sort(np.sort(run.lattice["ends"], axis=1), axis=0), "bonds")
            for step, (t, (_, box, _, _)) in enumerate(zip(universe.trajectory, read_dump(stem.with_suffix(".dump"), "ATOMS"))):
                error = abs(t.positions + box[:, 0] - run.points(step))  # it moves the box to the origin, in single precision
                self.assertLess(error[:, :2].max(), 1e-6 * abs(box).max())

    def test_the_first_frame_chosen_is_the_start(self):
        for run, stem, _ in self.each("lammps", "--frames", "-1,1"):
            last = len(run.times) - 1
            atoms = np.array(read_data(stem.with_suffix(".data"))["Atoms"], float)
            self.same(atoms[:, 3:5], run.points(last)[:, :2], "positions")
            self.assertEqual([step for step, *_ in read_dump(stem.with_suffix(".dump"), "ATOMS")], [last, 1])

    def test_what_lammps_lacks_is_said(self):
        for run, stem, stderr in self.each("lammps", "--frames", "0"):
            guarded, rigid = (np.count_nonzero(run.lattice.get(key, 0)) for key in ("guard", "rigid"))
            for text in (stderr, stem.with_suffix(".data").read_text(), (stem.parent / f"in.{stem.name}").read_text()):
                self.assertEqual(f"the folding guard of {guarded} triangles" in text, guarded > 0)
                self.assertEqual(f"the rigidity of {rigid} nodes" in text, rigid > 0)
                self.assertIn(f"{len(run.file['obstacles'])} obstacle", text)


def documented_units(group):
    """Of docs/output.md, by name: a name of one group may be another number in another."""
    units, columns, section = {}, [], ""
    wanted = re.compile(f"## .*/{group}")
    for line in (DOCS / "output.md").read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.split("|")[1:-1]] if line.startswith("|") else []
        if line.startswith("## "):
            section = line
        if wanted.match(section) and "unit" in cells:
            columns = cells
        elif columns and len(cells) >= len(columns) and wanted.match(section):
            row = dict(zip(columns, cells))
            names = [name.rsplit("/", 1)[-1] for name in re.findall("`([^`]+)`", row["dataset"])]
            given = row["unit"].split(", ")
            units.update(zip(names, given if len(given) == len(names) else [row["unit"]] * len(names)))
    return units


class Csv(Exports):
    def read(self, path):
        text = path.read_bytes().decode("ascii")
        self.assertEqual(text.count("\n"), text.count("\r\n"))
        head, *rows = csv.reader(text.splitlines(keepends=True), strict=True)
        self.assertEqual({len(row) for row in rows} | {len(head)}, {len(head)})
        return dict(zip(head, np.array(rows, float).reshape(len(rows), len(head)).T))

    def names_have_units(self, table, group):
        units = {"frame": "", "t": "s", "node": "", "spring": "", "first": "", "second": "", "x": "m", "y": "m"}
        units |= documented_units(group)
        for head in table:
            name, _, unit = head.partition(" [")
            stem = next((n for n in (name, re.sub("_(x|y|z|xx|yy|zz|xy|yz|xz)$", "", name), re.sub(r"_\d+(_[xy])?$", "", name))
                         if n in units), None)
            self.assertIsNotNone(stem, head)
            self.assertEqual(unit.rstrip("]"), units[stem], head)

    def expect(self, table, expected):
        found = {head.partition(" [")[0]: values for head, values in table.items()}
        self.assertEqual(set(found), set(expected))
        for name, values in expected.items():
            self.same(found[name].astype(values.dtype), values, name)

    def test_nodes_and_springs_have_a_row_for_each_frame(self):
        for run, stem, _ in self.each("csv"):
            for group, ending in (("PointData", ".nodes.csv"), ("CellData", ".springs.csv")):
                n, frames = run.count[group], range(len(run.times))
                expected = {"frame": np.repeat(frames, n), "t": np.repeat(run.times, n)}
                if group == "PointData":
                    expected |= {"node": np.tile(np.arange(n), len(frames)), "x": run.file["VTKHDF/Points"][:, 0],
                                 "y": run.file["VTKHDF/Points"][:, 1]}
                else:
                    first, second = np.tile(run.lattice["ends"], (len(frames), 1)).T
                    expected |= {"spring": np.tile(np.arange(n), len(frames)), "first": first, "second": second}
                arrays = [dict(c for name, _, values in run.arrays(group, k) for c in columns_of(name, values)) for k in frames]
                expected |= {name: np.concatenate([a[name] for a in arrays]) for name in arrays[0]}
                table = self.read(stem.with_suffix(ending))
                self.expect(table, expected)
                self.names_have_units(table, "VTKHDF")

    def test_every_table_is_there(self):
        for run, stem, _ in self.each("csv"):
            groups = {"frames": run.file["VTKHDF/FieldData"], "history": run.file["history"], "events": run.file["events"]}
            groups |= {name: run.file[name] for name in ("breaks", "fragments") if name in run.file}
            for parent in ("probes", "most_stressed"):
                groups |= {f"{parent}.{name}": group for name, group in run.file.get(parent, {}).items()}
            found = {path.name for path in stem.parent.iterdir()}
            self.assertEqual(found, {f"{stem.name}.{name}.csv" for name in [*groups, "nodes", "springs"]})
            for name, group in groups.items():
                table = self.read(stem.with_suffix(f".{name}.csv"))
                expected = {}
                for key, dataset in group.items():
                    values = dataset[...]
                    if key == "frame_offset":
                        times = run.file["VTKHDF/Steps/Values"][...]
                        expected |= {"t": np.repeat(times, np.diff(values))}
                    elif name == "history" and re.match("body_|obstacle_|boundary_", key):
                        for item in range(values.shape[1]):
                            expected |= dict(columns_of(f"{key}_{item}", values[:, item]))
                    elif key == "stress":
                        expected |= {f"stress_{c}": values[:, k] for k, c in enumerate(("xx", "yy", "xy"))}
                    else:
                        expected |= dict(columns_of(key, values))
                self.expect(table, expected)
                self.names_have_units(table, "VTKHDF" if name == "frames" else name.split(".")[0])
                if name != "frames" and not name.startswith("most"):
                    self.assertEqual(next(iter(table)), "t [s]")


class Refusals(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.here = pathlib.Path(folder.name)
        shutil.copy(Run("disc").path, self.here / "run.vtkhdf")

    def names(self):
        return sorted(path.name for path in self.here.iterdir())

    def refused(self, code, message, *words):
        before = self.names()
        done = export(*words, folder=self.here)
        self.assertEqual((done.returncode, done.stderr), (code, f"dem_export: error: {message}\n"))
        self.assertEqual(self.names(), before)

    def test_files_that_are_there_stay(self):
        for form, name in (("lammps", "in.run"), ("vtu", "run_0002.vtu"), ("csv", "run.history.csv")):
            path = self.here / name
            path.write_text("mine")
            self.refused(7, f"{name}: is there already; --overwrite replaces it", "run.vtkhdf", "--to", form)
            self.assertEqual(path.read_text(), "mine")
            self.assertEqual(export("run.vtkhdf", "--to", form, "--overwrite", folder=self.here).returncode, 0)
            self.assertNotEqual(path.read_text(encoding="latin1"), "mine")

    def test_words_that_say_nothing(self):
        self.refused(2, "no run: dem_export --help")
        self.refused(2, "to what? --to lammps, vtu or csv", "run.vtkhdf")
        self.refused(2, "'--to' needs lammps, vtu or csv, got 'png'", "run.vtkhdf", "--to", "png")
        self.refused(2, "'-o' needs a name", "run.vtkhdf", "--to", "csv", "-o")
        self.refused(2, "'--frame' is no option: dem_export --help", "run.vtkhdf", "--frame", "1")
        self.refused(2, "one run at a time: 'run.vtkhdf' and 'b'", "run.vtkhdf", "b")
        self.refused(2, "'a b' cannot be a name in LAMMPS: letters, digits, . _ + and -; '-o' gives another", "run.vtkhdf", "--to",
                     "lammps", "-o", "a b")

    def test_what_is_not_there(self):
        self.refused(5, "none.vtkhdf: cannot be opened (No such file or directory)", "none.vtkhdf", "--to", "csv")
        self.refused(3, "run.vtkhdf: '--frames 0,4' names frames that are not there: there are 4", "run.vtkhdf", "--to", "csv",
                     "--frames", "0,4")
        self.refused(3, "run.vtkhdf: '--frames x' is no list of frames as 0,5,10 or 0:20:5: there are 4", "run.vtkhdf", "--to",
                     "csv", "--frames", "x")
        self.refused(5, "none/run_0000.vtu: cannot be written (No such file or directory)", "run.vtkhdf", "--to", "vtu", "-o", "none/")

    def test_a_damaged_run(self):
        with h5py.File(self.here / "run.vtkhdf", "r+") as file:
            del file["VTKHDF/PointData/velocity"]
            file["VTKHDF/PointData/velocity"] = np.zeros((5, 3))
        done = export("run.vtkhdf", "--to", "csv", folder=self.here)
        self.assertEqual(done.returncode, 5)
        self.assertIn("dem_export: error: run.vtkhdf: /VTKHDF/PointData/velocity: is not of shape", done.stderr)
        self.assertEqual(self.names(), ["run.vtkhdf"])

    def test_a_run_without_frames_has_tables_and_a_body(self):
        with h5py.File(self.here / "run.vtkhdf", "r+") as file:
            del file["VTKHDF"]
        self.refused(3, "run.vtkhdf: has no frames", "run.vtkhdf", "--to", "vtu")
        self.refused(3, "run.vtkhdf: has no frames", "run.vtkhdf", "--to", "csv", "--frames", "0")
        self.assertEqual(export("run.vtkhdf", "--to", "csv", "-o", "a", folder=self.here).returncode, 0)
        self.assertEqual(export("run.vtkhdf", "--to", "lammps", "-o", "a", folder=self.here).returncode, 0)
        self.assertEqual(self.names(), ["a.data", "a.events.csv", "a.history.csv", "a.most_stressed.nodes.csv",
                                        "a.most_stressed.springs.csv", "in.a", "run.vtkhdf"])

    def test_a_part_goes_where_it_is_reported(self):
        (self.here / "run.vtkhdf").rename(self.here / "run.part.vtkhdf")
        (self.here / "there").mkdir()
        for words, name in ((["-o", "there"], "there/run.part.pvd"), (["-o", "there/x"], "there/x.pvd"), ([], "run.part.pvd")):
            self.assertEqual(export("run.part.vtkhdf", "--to", "vtu", *words, folder=self.here).returncode, 0)
            self.assertTrue((self.here / name).exists(), name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

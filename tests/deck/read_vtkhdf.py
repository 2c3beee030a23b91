#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Reads a trajectory as its users do, with VTK's reader and with h5py, and compares the two value by value; holds the
history and the table of events against the laws of momentum and energy.

usage: read_vtkhdf.py RUN.vtkhdf [--expect-frames N] [--interval DT] [--bounces N] [--fields NAME,...] [--probes N]
                      [--vtk VERSION] [--bodies-only]
Exit code: 0 all equal, 1 a difference, 77 a Python package is missing."""
import argparse
import os
import re
import sys

try:
    import h5py
    import numpy as np
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkIdList, vtkVersion
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
    from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
    from vtkmodules.vtkIOHDF import vtkHDFReader
except ImportError as error:
    print(f"skipped: the Python packages vtk, h5py and numpy are needed ({error})")
    sys.exit(77)

LINE, TRIANGLE, CORNERS = 3, 5, {3: 2, 5: 3}
GHOSTS, HIDDEN = "vtkGhostType", 32
IMPACT = 0
NAMES = {"kind": "impact close release slip stick pass", "state": "free slip stick"}
EVENT_SHAPES = {
    **dict.fromkeys(("t", "weight", "normal_impulse", "tangential_impulse", "energy"), ("f8", ())),
    **dict.fromkeys(("x", "normal", "before", "after"), ("f8", (2,))),
    **dict.fromkeys(("node", "other", "obstacle", "segment"), ("i8", ())),
    **dict.fromkeys(("kind", "state"), ("i1", ())),
}


def same(what, found, expected):
    found, expected = np.asarray(found), np.asarray(expected)
    if found.shape != expected.shape or not np.array_equal(found, expected):
        sys.exit(f"{what}: differs ({found.shape} {found.ravel()[:4]}..., expected {expected.shape} "
                 f"{expected.ravel()[:4]}...)")


def close(what, found, expected, tolerance):
    error = np.max(np.abs(np.asarray(found, float) - expected), initial=0.0)
    if not error <= tolerance:
        sys.exit(f"{what}: off by {error:g}, allowed {tolerance:g}")


def names(attributes):
    return [attributes.GetArrayName(k) for k in range(attributes.GetNumberOfArrays())]


def arrays(attributes):
    return {name: vtk_to_numpy(attributes.GetAbstractArray(name)) for name in names(attributes)}


class Grid:
    """What VTK makes of a file."""

    def __init__(self, path):
        self.reader = vtkHDFReader()
        if not self.reader.CanReadFile(path):
            sys.exit(f"{path}: VTK cannot read it")
        self.reader.SetFileName(path)
        self.reader.UpdateInformation()

    def times(self):
        information = self.reader.GetOutputInformation(0)
        key = vtkStreamingDemandDrivenPipeline.TIME_STEPS()
        return [information.Get(key, k) for k in range(information.Length(key))]

    def at(self, time=None):
        if time is None:
            self.reader.Update()
        else:
            self.reader.UpdateTimeStep(time)
        return self.reader.GetOutputDataObject(0)


def cell_corners(grid, kind=LINE):
    ids, corners = vtkIdList(), []
    for k in range(grid.GetNumberOfCells()):
        if grid.GetCellType(k) != kind:
            sys.exit(f"cell {k} is of type {grid.GetCellType(k)}, not {kind}")
        grid.GetCellPoints(k, ids)
        corners.append([ids.GetId(c) for c in range(CORNERS[kind])])
    return np.array(corners, dtype=np.int64).reshape(-1, CORNERS[kind])


def points_of(grid):
    return vtk_to_numpy(grid.GetPoints().GetData()) if grid.GetNumberOfPoints() else np.empty((0, 3))


def frame_of(vtk_group, kind, name, frame, n_frames):
    """The rows of frame `frame`, found from the shape alone and checked against the stored offset."""
    data = vtk_group[f"{kind}/{name}"]
    offset = vtk_group[f"Steps/{kind}Offsets/{name}"][frame]
    changes = kind == "FieldData" or not (name in ("id", "body") or name.startswith("peak_"))
    rows = data.shape[0] // n_frames if changes else data.shape[0]
    same(f"offset of {kind}/{name}", offset, frame * rows if changes else 0)
    return data[offset:offset + rows]


def drawn(grid):
    """How many cells are left where VTK draws a surface."""
    surface = vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    surface.Update()
    return surface.GetOutput().GetNumberOfCells()


def check_hidden(here, grid, broken):
    """What is broken is not drawn; the other cells are."""
    same(here + "hidden", arrays(grid.GetCellData())[GHOSTS], HIDDEN * broken)
    same(here + "drawn", drawn(grid), np.sum(broken == 0))


def check_frame(file, grid, frame, n_frames):
    vtk_group, lattice = file["VTKHDF"], file["lattice"]
    here = f"frame {frame}: "
    points = vtk_group["Points"][...].reshape(n_frames, -1, 3)[frame]
    same(here + "points", points_of(grid), points)
    same(here + "connectivity", cell_corners(grid), lattice["ends"][...])
    fields = arrays(grid.GetFieldData())
    same(here + "time", fields.pop("Time"), vtk_group["Steps/Values"][frame:frame + 1])
    for kind, found in (("PointData", arrays(grid.GetPointData())), ("CellData", arrays(grid.GetCellData())),
                        ("FieldData", fields)):
        same(f"{here}arrays of {kind}", sorted(found), sorted(vtk_group[kind]))
        for name in vtk_group[kind]:
            same(f"{here}{kind}/{name}", found[name], frame_of(vtk_group, kind, name, frame, n_frames))
    check_hidden(here, grid, frame_of(vtk_group, "CellData", "broken", frame, n_frames))
    check_physics(here, lattice, points, vtk_group, frame, n_frames)


def check_physics(here, lattice, points, vtk_group, frame, n_frames):
    found = {name: frame_of(vtk_group, kind, name, frame, n_frames)
             for kind in ("PointData", "CellData") for name in vtk_group[kind]}
    same(here + "z", points[:, 2], np.zeros(len(points)))
    moved = points[:, :2] - lattice["x"][...]
    ends, rest, stiffness = (lattice[name][...] for name in ("ends", "rest_length", "stiffness"))
    strain = (np.linalg.norm(points[ends[:, 1]] - points[ends[:, 0]], axis=1) - rest) / rest
    largest = np.max(np.abs(strain), initial=0.0)
    if "displacement" in found:
        close(here + "displacement", found["displacement"][:, :2], moved, 2e-7 * np.max(np.abs(moved), initial=0.0))
    if "strain" in found:
        close(here + "strain", found["strain"], strain, 2e-7 * largest + 1e-13)
    if "force" in found:
        close(here + "force", found["force"], stiffness * strain + couplings_of(lattice, points[:, :2])[0],
              (2e-7 * largest + 1e-13) * np.max(stiffness, initial=0.0))
    check_stresses(here, lattice, points[:, :2], found)
    if "contact_force" in found:
        check_contact(here, lattice, found)


def von_mises_of(stress):
    xx, yy, xy = stress[:, 0], stress[:, 1], stress[:, -1 if stress.shape[1] == 3 else 3]
    return np.sqrt(xx * xx - xx * yy + yy * yy + 3.0 * xy * xy)


def check_contact(here, lattice, found):
    """Bodies push each other with the same force; on a node it is the pressure times its share of the surface."""
    force, pressure = found["contact_force"], found["contact_pressure"]
    size = np.linalg.norm(force, axis=1)
    close(here + "sum of the forces of contact", force.sum(axis=0), np.zeros(3), 1e-6 * np.sum(size))
    same(here + "force of contact across the plane", force[:, 2], np.zeros(len(force)))
    corners = lattice["triangles"][...]
    sides = np.concatenate([corners[:, [k, (k + 1) % 3]] for k in range(3)])
    thick = np.tile(lattice["thickness"][...], 3)
    _, which, count = np.unique(np.sort(sides, axis=1), axis=0, return_index=True, return_counts=True)
    outer, x = which[count == 1], lattice["x"][...]
    half = 0.5 * thick[outer] * np.linalg.norm(np.diff(x[sides[outer]], axis=1)[:, 0], axis=1)
    area = np.zeros(len(force))
    np.add.at(area, sides[outer], half[:, None])
    close(here + "pressure of contact", pressure * area, size, 1e-6 * np.max(size, initial=0.0))


def check_stresses(here, lattice, points, found):
    """Those in double precision must agree with the triangles' to rounding, others to that of single precision."""
    if "stress" not in found:
        return
    stress, expected = found["stress"], stress_of(lattice, points)
    scale = 1e-300 + np.max(np.abs(expected), initial=0.0)
    modulus = np.max(lattice["modulus"][...], initial=0.0) if "modulus" in lattice else 0.0
    close(here + "stress", stress[:, [0, 1, 3]], expected, 2e-7 * scale + 1e-11 * modulus)
    same(here + "stress across the plane", stress[:, [2, 4, 5]], np.zeros((len(stress), 3)))
    if "von_mises" in found:
        close(here + "von Mises", found["von_mises"], von_mises_of(stress), 1e-6 * scale)
    if "principal_stress" in found:
        tensors = np.stack([stress[:, [0, 3]], stress[:, [3, 1]]], axis=1)
        close(here + "principal stress", found["principal_stress"], np.linalg.eigvalsh(tensors)[:, ::-1], 1e-6 * scale)


def slopes_of(lattice, area, rest_area):
    """dW/dA of the triangles: area term and folding guard."""
    J, n = area / rest_area, len(area)
    guard = lattice["guard"][...] if "guard" in lattice else np.zeros(n)
    kappa = lattice["area_stiffness"][...] if "area_stiffness" in lattice else np.zeros(n)
    capped = np.clip(J, 0.05, 0.4)
    L = np.log(0.4 / capped)
    bend = (6.0 * L + 3.0 * L * L) / capped**2
    return kappa * (J - 1.0) + guard * (-3.0 * L * L / capped + np.minimum(J - capped, 0.0) * bend)


def sides_of(lattice):
    """The spring of each triangle's side from corner k to the next one."""
    corners = lattice["triangles"][...] if "triangles" in lattice else np.empty((0, 3), int)
    springs = {tuple(sorted(pair)): k for k, pair in enumerate(lattice["ends"][...].tolist())}
    return np.array([[springs[tuple(sorted((t[k], t[(k + 1) % 3])))] for k in range(3)] for t in corners.tolist()],
                    dtype=int).reshape(-1, 3)


def couplings_of(lattice, points):
    """What couplings add to the tension of every spring, N, and to r x f of every triangle, J."""
    force, side = np.zeros(len(lattice["ends"])), sides_of(lattice)
    if "coupling" not in lattice:
        return force, np.zeros((len(side), 3))
    coupling, corners, rest = lattice["coupling"][...], lattice["triangles"][...], lattice["rest_length"][...]
    r = points[np.roll(corners, -1, axis=1)] - points[corners]
    length = np.linalg.norm(r, axis=2)
    stretch = length - rest[side]
    tension = coupling * np.roll(stretch, 1, axis=1) + np.roll(coupling, -1, axis=1) * np.roll(stretch, -1, axis=1)
    np.add.at(force, side, tension)
    products = np.stack([r[..., 0]**2, r[..., 1]**2, r[..., 0] * r[..., 1]], axis=2)
    return force, np.sum((tension / length)[..., None] * products, axis=1)


def weights_of(lattice, area):
    """Stiffness of a coupled triangle's sides over that of an equilateral one's: (3 L^4/(32 A^2)) (1 + 3 cot^2)."""
    corners, x = lattice["triangles"][...] if "triangles" in lattice else np.empty((0, 3), int), lattice["x"][...]
    if "coupling" not in lattice:
        return np.ones((len(corners), 3))
    r = x[np.roll(corners, -1, axis=1)] - x[corners]
    dot = -np.sum(r * np.roll(r, 1, axis=1), axis=2)  # at corner k, opposite to side k + 1
    cotangent = np.roll(dot, 1, axis=1) / (2.0 * area[:, None])
    weight = 3.0 / 32.0 * np.sum(r * r, axis=2)**2 / area[:, None]**2 * (1.0 + 3.0 * cotangent**2)
    return np.where(np.any(lattice["coupling"][...] != 0.0, axis=1)[:, None], weight, 1.0)


def stress_of(lattice, points):
    """Triangle by triangle: a side's r x f by the share of modulus * thickness * area, then the mean at the nodes."""
    n, corners = len(points), lattice["triangles"][...] if "triangles" in lattice else np.empty((0, 3), int)
    x, count = lattice["x"][...], len(corners)
    thickness = lattice["thickness"][...] if "thickness" in lattice else np.ones(count)
    modulus = lattice["modulus"][...] if "modulus" in lattice else np.ones(count)

    def areas(at):
        a, b, c = (at[corners[:, k]] for k in range(3))
        return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])

    rest_area, area = areas(x), areas(points)
    side = sides_of(lattice)
    weight = (modulus * thickness * rest_area)[:, None] * weights_of(lattice, rest_area)
    sums = np.zeros(len(lattice["ends"]))
    np.add.at(sums, side, weight)
    i, j = lattice["ends"][...].T
    r, rest = points[j] - points[i], lattice["rest_length"][...]
    length = np.linalg.norm(r, axis=1)
    tension = lattice["stiffness"][...] * (length - rest) / rest / length
    virial = tension[:, None] * np.stack([r[:, 0]**2, r[:, 1]**2, r[:, 0] * r[:, 1]], axis=1)
    of_triangle = np.einsum("tk,tkc->tc", weight / sums[side], virial[side])
    of_triangle += couplings_of(lattice, points)[1]
    of_triangle[:, :2] += (area * slopes_of(lattice, area, rest_area))[:, None]
    total, volume = np.zeros((n, 3)), np.zeros(n)
    np.add.at(total, corners, of_triangle[:, None, :] / 3.0)
    np.add.at(volume, corners, (thickness * rest_area)[:, None] / 3.0)
    return total / np.where(volume > 0.0, volume, 1.0)[:, None]


def resolved(file):
    return file["provenance/resolved"].asstr()[()]


def check_peaks(file):
    """The arrays against the lists, and both against the instants of the history."""
    nodes, springs, vtk_group = file["most_stressed/nodes"], file["most_stressed/springs"], file["VTKHDF"]
    lattice, t = file["lattice"], file["history/t"][...]
    size, strain = vtk_group["PointData/peak_von_mises"][...], vtk_group["CellData/peak_strain"][...]
    close("von Mises of peaks", size, von_mises_of(vtk_group["PointData/peak_stress"][...]), 1e-6 * np.max(size, initial=0.0))
    wanted = int(re.search(r"(?m)^    most_stressed = (\d+)", resolved(file))[1])
    for found, values, name, key in ((nodes, size, "node", "von_mises"), (springs, np.abs(strain), "spring", "strain")):
        ranks = found[key][...]
        same(f"length of the list of {name}s", len(ranks), min(wanted, np.count_nonzero(values)))
        if np.any(np.diff(np.abs(ranks)) > 0):
            sys.exit(f"most stressed: {key} is in no order")
        close(f"most stressed {name}", np.abs(ranks), np.sort(values)[::-1][:len(ranks)], 1e-6 * np.max(values, initial=0.0))
        close(f"value of {name}", values[found[name][...]], np.abs(ranks), 1e-6 * np.max(values, initial=0.0))
        same(f"instants of {name}", np.isin(found["t"][...], t), np.ones(len(ranks), bool))
    for name in ("PointData/peak_von_mises_time", "CellData/peak_strain_time"):
        same(name, np.isin(vtk_group[name][...], t), np.ones(len(vtk_group[name]), bool))
    close("stress of the most stressed", von_mises_of(nodes["stress"][...]), nodes["von_mises"][...],
          1e-12 * np.max(size, initial=0.0))
    same("place of nodes", nodes["x"][...], lattice["x"][...][nodes["node"][...]])
    chosen = springs["spring"][...]
    close("place of springs", springs["x"][...], lattice["x"][...][lattice["ends"][...][chosen]].mean(axis=1), 1e-15)
    close("force of springs", springs["force"][...], lattice["stiffness"][...][chosen] * springs["strain"][...], 1e-9)


PROBE_COLUMNS = {"node": {"t": "s", "x": "m", "v": "m/s", "stress": "Pa", "von_mises": "Pa"},
                 "spring": {"t": "s", "strain": "1", "force": "N"}, "gauge": {"t": "s", "length": "m", "strain": "1"}}


def check_probe(probe, file):
    """Instants, units, and the first row against the first frame's positions."""
    kind, number = probe.attrs["kind"].decode(), np.atleast_1d(probe.attrs["number"])
    units = {name: probe[name].attrs["unit"].decode() for name in probe}
    same("columns of a probe", sorted(units.items()), sorted(PROBE_COLUMNS[kind].items()))
    same("instants of a probe", probe["t"][...], file["history/t"][...][::probe.attrs["every"]])
    lattice, points = file["lattice"], file["VTKHDF/Points"][...][:len(file["lattice/x"]), :2]
    if kind == "node":
        same("place of a probe", probe["x"][0], points[number[0]])
        close("stress of a probe", probe["stress"][0], stress_of(lattice, points)[number[0]], 1.0)
        close("von Mises of a probe", probe["von_mises"][...], von_mises_of(probe["stress"][...]), 1e-6)
        return
    ends = lattice["ends"][...][number[0]] if kind == "spring" else number
    length = np.linalg.norm(points[ends[1]] - points[ends[0]])
    rest = np.linalg.norm(np.diff(lattice["x"][...][ends], axis=0)) if kind == "gauge" else \
        lattice["rest_length"][number[0]]
    close("strain of a probe", probe["strain"][0], length / rest - 1.0, 1e-13)
    if kind == "gauge":
        close("length of a gauge", probe["length"][...], rest * (1.0 + probe["strain"][...]), 1e-13 * rest)
    else:
        own = lattice["stiffness"][number[0]] * probe["strain"][...]
        close("force of a probe", probe["force"][0], own[0] + couplings_of(lattice, points)[0][number[0]], 1e-9)
        if "coupling" not in lattice:
            close("forces of a probe", probe["force"][...], own, 1e-9)


def check_history(history):
    rows = {name: column.shape[0] for name, column in history.items()}
    if len(set(rows.values())) != 1:
        sys.exit(f"history: columns of different length: {rows}")
    t = history["t"][...]
    if len(t) > 1 and not np.all(np.diff(t) > 0):
        sys.exit("history: t does not increase")
    for name in ("impacts", "vertex_impacts", "early", "closings", "releases", "slips", "sticks", "passings", "late",
                 "events", "steps", "rejected", "retries", "crossings", "evaluations"):
        if np.any(np.diff(history[name][...], prepend=0) < 0):
            sys.exit(f"history: {name} decreases")
    same("history: gap_min without pairs", np.isinf(history["gap_min"][...]), history["pairs"][...] == 0)
    check_ledger(history)
    return len(t)


def check_ledger(history):
    """Start and end, to the 2e-3 of the largest energy of motion that docs/verification.md asks for."""
    energy = {name: history[name][...] for name in ("kinetic", "elastic", "area", "guard", "contact", "gravity", "impact",
                                                    "friction", "damping", "projection", "boundary")}
    motion = energy["kinetic"] + energy["elastic"] + energy["area"] + energy["guard"] + energy["contact"]
    largest = np.max(motion)
    ledger = sum(energy.values()) - 2.0 * energy["projection"] - 2.0 * energy["boundary"]
    close("history: ledger", ledger, ledger[0], 2e-3 * largest)
    moving = np.maximum.accumulate(motion)
    close("history: closure", history["closure"][...] * moving, ledger - ledger[0], 1e-12 * largest)


def check_fields(vtk_group, history):
    """A frame lies within a step: impacts have taken what they had in the row before it, friction and damping no less
    than there and no more than in the row behind."""
    rows = np.searchsorted(history["t"][...], vtk_group["Steps/Values"][...], side="right") - 1
    for name in ("impact", "projection"):
        same(f"{name} of the frames", vtk_group[f"FieldData/{name}_energy"][...], history[name][...][rows])
    for name in ("friction", "damping"):
        found, taken = vtk_group[f"FieldData/{name}_energy"][...], history[name][...]
        most = np.maximum(taken[rows], taken[np.minimum(rows + 1, len(taken) - 1)])
        close(f"{name} of the frames", found, np.clip(found, taken[rows], most), 1e-12 * taken[-1])


def gravity_of(file):
    words = re.search(r"(?m)^    gravity = (\S+), (\S+)", resolved(file)).groups()
    return np.array([float(word) for word in words])


def momentum_gained(file):
    """By the obstacles, from the motion of the bodies: the sum of m (v - v0), less m g t."""
    history, lattice = file["history"], file["lattice"]
    mass = np.bincount(lattice["body"][...], lattice["mass"][...])
    velocity = history["body_velocity"][...]
    return mass @ (velocity[-1] - velocity[0]) - mass.sum() * gravity_of(file) * history["t"][-1]


def impulses_of(events):
    normal = events["normal"][...]
    tangent = np.stack([normal[:, 1], -normal[:, 0]], axis=1)
    return events["normal_impulse"][...][:, None] * normal + events["tangential_impulse"][...][:, None] * tangent


def check_event_rows(events, file):
    if set(events) != set(EVENT_SHAPES):
        sys.exit(f"events: {sorted(events)}")
    n = len(events["t"])
    for name, (kind, tail) in EVENT_SHAPES.items():
        if events[name].shape != (n, *tail) or events[name].dtype != np.dtype("<" + kind):
            sys.exit(f"events: {name} is {events[name].dtype} {events[name].shape}")
    for name, words in NAMES.items():
        same(f"names of {name}", events[name].attrs["names"].decode().split(), words.split())
        same(f"codes of {name}", np.isin(events[name], range(len(words.split()))), np.ones(n, bool))
    node, other, weight = (events[name][...] for name in ("node", "other", "weight"))
    nodes = file["lattice/x"].shape[0]
    same("nodes of events", (0 <= node) & (node < nodes) & (-1 <= other) & (other < nodes), np.ones(n, bool))
    same("weights of nodes", weight[other < 0], np.zeros(np.sum(other < 0)))
    close("weights of edges", weight, 0.5, 0.5)
    close("normals", np.linalg.norm(events["normal"][...], axis=1), 1.0, 1e-12)
    same("instants of events", (events["t"][...] >= 0) & (events["t"][...] <= file["history/t"][-1]), np.ones(n, bool))
    if np.any(np.diff(events["t"][...]) < 0):
        sys.exit("events: t decreases")


def check_event_places(events, obstacles):
    """On the line of the segment, to a millionth of its length."""
    for o, s, x in zip(events["obstacle"][...], events["segment"][...], events["x"][...]):
        a, b = obstacles[str(o)]["points"][s:s + 2]
        length = np.linalg.norm(b - a)
        across = np.array([a[1] - b[1], b[0] - a[0]]) / length
        close("place of an event", across @ (x - a), 0.0, 1e-6 * length)


def check_events(file):
    """The table alone, and against the last row of the history."""
    events, history = file["events"], file["history"]
    check_event_rows(events, file)
    check_event_places(events, file.get("obstacles"))
    impact = events["kind"][...] == IMPACT
    same("impacts", np.sum(impact), history["impacts"][-1])
    same("impacts on vertices", np.sum(impact & (events["other"][...] >= 0)), history["vertex_impacts"][-1])
    impulse = impulses_of(events)
    same("impulses of what is no impact", impulse[~impact], np.zeros((np.sum(~impact), 2)))
    taken = events["energy"][...]
    close("energy of impacts", taken.sum(), history["impact"][-1], 1e-9 * np.max(history["kinetic"]))
    return len(impact)


def check_bounces(file, n):
    """Without lasting contacts the obstacles' impulses are those of the impacts, and all there is to the momentum."""
    events, history = file["events"], file["history"]
    same("bounces", [np.sum(events["kind"][...] == IMPACT), history["closings"][-1]], [n, 0])
    impulse, given = impulses_of(events), history["obstacle_impulse"][-1]
    rounding = 1e-9 * np.sum(np.abs(impulse))
    for o, expected in enumerate(given):
        close(f"impulse of obstacle {o}", impulse[events["obstacle"][...] == o].sum(axis=0), expected, rounding)
    close("balance of momentum", momentum_gained(file), given.sum(axis=0), rounding)


def check_obstacles(path, obstacles):
    grid = Grid(path).at()
    with h5py.File(path, "r") as file:
        same("obstacle points", points_of(grid), file["VTKHDF/Points"][...])
    polylines = [obstacles[str(o)]["points"][...] for o in range(len(obstacles))]
    same("obstacle points", points_of(grid)[:, :2], np.concatenate(polylines))
    owner = np.repeat(np.arange(len(polylines)), [len(p) - 1 for p in polylines])
    same("obstacle of each segment", arrays(grid.GetCellData())["obstacle"], owner)
    same("whether they have a colour of their own", grid.GetCellData().GetScalars() is not None, False)
    first = np.cumsum([0] + [len(p) for p in polylines])
    ends = np.concatenate([[[f + k, f + k + 1] for k in range(len(p) - 1)] for f, p in zip(first, polylines)])
    same("obstacle segments", cell_corners(grid), ends)
    return grid.GetNumberOfCells()


def check_bodies(path, file):
    """The triangles as cells, with the points and the data of the springs' grid; what is broken is not drawn."""
    path = path.removesuffix(".vtkhdf") + ".body.vtkhdf"
    if "triangles" not in file["lattice"]:
        same("file of bodies without triangles", os.path.exists(path), False)
        return 0
    corners, times = file["lattice/triangles"][...], file["VTKHDF/Steps/Values"][...]
    broken = file["fracture/triangles"][...].reshape(len(times), -1)
    grid = Grid(path)
    same("times of bodies", grid.times(), times)
    for frame in [*range(1, len(times), 2), *range(0, len(times), 2)]:
        here, found = f"bodies in frame {frame}: ", grid.at(times[frame])
        same(here + "points", points_of(found), file["VTKHDF/Points"][...].reshape(len(times), -1, 3)[frame])
        same(here + "corners", cell_corners(found, TRIANGLE), corners)
        cells, points = arrays(found.GetCellData()), arrays(found.GetPointData())
        same(here + "arrays of cells", sorted(cells), [GHOSTS])
        check_hidden(here, found, broken[frame])
        same(here + "arrays of points", sorted(points), sorted(file["VTKHDF/PointData"]))
        for name, values in points.items():
            same(here + name, values, frame_of(file["VTKHDF"], "PointData", name, frame, len(times)))
    return np.sum(broken[-1])


def check_springs(path, vtk_group):
    """The springs of a run that breaks: what is broken is not drawn."""
    grid = Grid(path)
    for frame, t in enumerate(grid.times()):
        check_hidden(f"springs in frame {frame}: ", grid.at(t),
                     frame_of(vtk_group, "CellData", "broken", frame, len(grid.times())))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("path")
    parser.add_argument("--expect-frames", type=int)
    parser.add_argument("--interval", type=float)
    parser.add_argument("--bounces", type=int)
    parser.add_argument("--fields")
    parser.add_argument("--probes", type=int, default=0)
    parser.add_argument("--bodies-only", action="store_true", help="of a run that may break")
    parser.add_argument("--vtk", default=vtkVersion.GetVTKVersion())
    options = parser.parse_args()
    if vtkVersion.GetVTKVersion() != options.vtk:
        print(f"skipped: VTK {options.vtk} is needed, this is {vtkVersion.GetVTKVersion()}")
        sys.exit(77)
    with h5py.File(options.path, "r") as file:
        n_broken = check_bodies(options.path, file)
        if options.bodies_only:
            same("whether something has broken", n_broken > 0, True)
            check_springs(options.path, file["VTKHDF"])
            print(f"{os.path.basename(options.path)}: {n_broken} triangles have broken and are not drawn")
            return
        grid = Grid(options.path)
        times = grid.times()
        same("times", times, file["VTKHDF/Steps/Values"][...])
        same("NSteps", file["VTKHDF/Steps"].attrs["NSteps"], len(times))
        if options.expect_frames is not None:
            same("number of frames", len(times), options.expect_frames)
        if options.interval is not None:
            close("times", times, options.interval * np.arange(len(times)), 1e-9 * options.interval * len(times))
        # not in order, so that nothing can hang on the frame before
        for frame in [*range(1, len(times), 2), *range(0, len(times), 2)]:
            check_frame(file, grid.at(times[frame]), frame, len(times))
        rows = check_history(file["history"])
        check_fields(file["VTKHDF"], file["history"])
        events = check_events(file) if "events" in file else "no"
        if "most_stressed" in file:
            check_peaks(file)
        probes = list(file.get("probes", {}).values())
        same("number of probes", len(probes), options.probes)
        for probe in probes:
            check_probe(probe, file)
        if options.fields is not None:
            vtk_group = file["VTKHDF"]
            found = {*vtk_group["PointData"], *vtk_group["CellData"]} - {"id", "body", "broken", GHOSTS}
            same("fields", sorted(name for name in found if not name.startswith("peak_")),
                 sorted(options.fields.split(",")))
        if options.bounces is not None:
            check_bounces(file, options.bounces)
        size = file["lattice/x"].shape[0], file["lattice/ends"].shape[0]
        segments = 0
        if "obstacles" in file:
            segments = check_obstacles(options.path.removesuffix(".vtkhdf") + ".obstacle.vtkhdf", file["obstacles"])
    print(f"{os.path.basename(options.path)}: {len(times)} frames of {size[0]} nodes and {size[1]} springs, {rows} "
          f"rows of history, {events} events, {segments} obstacle segments: VTK {vtkVersion.GetVTKVersion()} and h5py "
          "agree")


if __name__ == "__main__":
    main()

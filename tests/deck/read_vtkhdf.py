#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Reads a trajectory as its users do, with VTK's reader and with h5py, and compares the two value by value; holds the
history and the table of events against the laws of momentum and energy.

usage: read_vtkhdf.py RUN.vtkhdf [--expect-frames N] [--interval DT] [--bounces N]
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
    from vtkmodules.vtkIOHDF import vtkHDFReader
except ImportError as error:
    print(f"skipped: the Python packages vtk, h5py and numpy are needed ({error})")
    sys.exit(77)

LINE = 3
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


def cell_ends(grid):
    ids, ends = vtkIdList(), []
    for k in range(grid.GetNumberOfCells()):
        if grid.GetCellType(k) != LINE:
            sys.exit(f"cell {k} is of type {grid.GetCellType(k)}, not a line")
        grid.GetCellPoints(k, ids)
        ends.append([ids.GetId(0), ids.GetId(1)])
    return np.array(ends, dtype=np.int64).reshape(-1, 2)


def points_of(grid):
    return vtk_to_numpy(grid.GetPoints().GetData()) if grid.GetNumberOfPoints() else np.empty((0, 3))


def frame_of(vtk_group, kind, name, frame, n_frames):
    """The rows of frame `frame`, found from the shape alone and checked against the stored offset."""
    data = vtk_group[f"{kind}/{name}"]
    offset = vtk_group[f"Steps/{kind}Offsets/{name}"][frame]
    changes = kind == "FieldData" or name not in ("id", "body")
    rows = data.shape[0] // n_frames if changes else data.shape[0]
    same(f"offset of {kind}/{name}", offset, frame * rows if changes else 0)
    return data[offset:offset + rows]


def check_frame(file, grid, frame, n_frames):
    vtk_group, lattice = file["VTKHDF"], file["lattice"]
    here = f"frame {frame}: "
    points = vtk_group["Points"][...].reshape(n_frames, -1, 3)[frame]
    same(here + "points", points_of(grid), points)
    same(here + "connectivity", cell_ends(grid), lattice["ends"][...])
    for kind, found in (("PointData", arrays(grid.GetPointData())), ("CellData", arrays(grid.GetCellData())),
                        ("FieldData", arrays(grid.GetFieldData()))):
        missing = set(vtk_group[kind]) - set(found)
        if missing:
            sys.exit(f"{here}VTK shows no {kind} {sorted(missing)}")
        for name in vtk_group[kind]:
            same(f"{here}{kind}/{name}", found[name], frame_of(vtk_group, kind, name, frame, n_frames))
    check_physics(here, lattice, points, vtk_group, frame, n_frames)


def check_physics(here, lattice, points, vtk_group, frame, n_frames):
    x = lattice["x"][...]
    displacement = frame_of(vtk_group, "PointData", "displacement", frame, n_frames)
    strain = frame_of(vtk_group, "CellData", "strain", frame, n_frames)
    force = frame_of(vtk_group, "CellData", "force", frame, n_frames)
    moved = points[:, :2] - x
    same(here + "z", points[:, 2], np.zeros(len(points)))
    close(here + "displacement", displacement[:, :2], moved, 2e-7 * np.max(np.abs(moved), initial=0.0))
    ends, rest = lattice["ends"][...], lattice["rest_length"][...]
    length = np.linalg.norm(points[ends[:, 1]] - points[ends[:, 0]], axis=1)
    expected = (length - rest) / rest
    largest = np.max(np.abs(expected), initial=0.0)
    close(here + "strain", strain, expected, 2e-7 * largest + 1e-13)
    stiffness = lattice["stiffness"][...]
    close(here + "force", force, stiffness * expected, (2e-7 * largest + 1e-13) * np.max(stiffness, initial=0.0))


def check_history(history):
    rows = {name: column.shape[0] for name, column in history.items()}
    if len(set(rows.values())) != 1:
        sys.exit(f"history: columns of different length: {rows}")
    t = history["t"][...]
    if len(t) > 1 and not np.all(np.diff(t) > 0):
        sys.exit("history: t does not increase")
    for name in ("impacts", "vertex_impacts", "early", "closings", "releases", "slips", "sticks", "passings", "late",
                 "events", "steps", "rejected", "retries", "evaluations"):
        if np.any(np.diff(history[name][...], prepend=0) < 0):
            sys.exit(f"history: {name} decreases")
    check_ledger(history)
    return len(t)


def check_ledger(history):
    """Start and end, to the 2e-3 of the largest energy of motion that docs/verification.md asks for."""
    energy = {name: history[name][...] for name in ("kinetic", "elastic", "area", "guard", "gravity", "impact", "friction",
                                                    "damping", "projection", "boundary")}
    largest = np.max(energy["kinetic"] + energy["elastic"] + energy["area"] + energy["guard"])
    ledger = sum(energy.values()) - 2.0 * energy["projection"] - 2.0 * energy["boundary"]
    close("history: ledger", ledger, ledger[0], 2e-3 * largest)
    moving = np.maximum.accumulate(energy["kinetic"] + energy["elastic"] + energy["area"] + energy["guard"])
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
    deck = file["provenance/resolved"].asstr()[()]
    return np.array([float(word) for word in re.search(r"(?m)^    gravity = (\S+), (\S+)", deck).groups()])


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
    same("instants of events", np.isin(events["t"], file["history/t"]), np.ones(n, bool))
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
    first = np.cumsum([0] + [len(p) for p in polylines])
    ends = np.concatenate([[[f + k, f + k + 1] for k in range(len(p) - 1)] for f, p in zip(first, polylines)])
    same("obstacle segments", cell_ends(grid), ends)
    return grid.GetNumberOfCells()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("path")
    parser.add_argument("--expect-frames", type=int)
    parser.add_argument("--interval", type=float)
    parser.add_argument("--bounces", type=int)
    options = parser.parse_args()
    with h5py.File(options.path, "r") as file:
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

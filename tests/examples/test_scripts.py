#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A script of docs/examples draws a run: what it hands to its library is what the file has, and the picture shows it.
OVITO also reads what dem_export makes of the run. `test_scripts.py SCRIPT DEM_BATCH DEM_EXPORT INPUTS`."""
import importlib.util
import pathlib
import runpy
import subprocess
import sys
import tempfile

SCRIPT, DEM_BATCH, DEM_EXPORT, INPUTS = (pathlib.Path(word).resolve() for word in sys.argv[1:5])
LIBRARY = SCRIPT.stem.removeprefix("plot_").removesuffix("_reader")

for name in ("h5py", "matplotlib", LIBRARY):
    if importlib.util.find_spec(name) is None:
        print(f"skipped: the Python package {name} is needed")
        sys.exit(77)

import h5py  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.image import imread  # noqa: E402

FRAME = 19  # the body is in the air; not the last one, which scripts draw unasked
WIDTH, HEIGHT = 1200, 900
VTK_HIDDEN = 32
OVITO_NAMES = {"id": "Particle Identifier", "velocity": "Velocity", "displacement": "Displacement"}


def run_deck(folder):
    """A run at a coarse spacing; in the frame every fifth spring and every seventh triangle is made a broken one."""
    text = pathlib.Path(INPUTS, "rectangle.nml").read_text(encoding="utf-8")
    pathlib.Path(folder, "deck.nml").write_text(text.replace("spacing   = 2.5e-3", "spacing   = 1e-2"), encoding="utf-8")
    subprocess.run([DEM_BATCH, "deck.nml"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    path = pathlib.Path(folder, "rectangle.vtkhdf")
    with h5py.File(path, "r+") as file:
        n_springs = len(file["lattice/ends"])
        file["VTKHDF/CellData/broken"][FRAME * n_springs:(FRAME + 1) * n_springs] = np.arange(n_springs) % 5 == 0
        n_triangles = len(file["lattice/triangles"])
        hidden = file["bodies/CellData/vtkGhostType"]
        hidden[FRAME * n_triangles:(FRAME + 1) * n_triangles] = np.where(np.arange(n_triangles) % 7 == 0, VTK_HIDDEN, 0)
    return path


def read_frames(path):
    """Of every frame: ends of the springs that are not broken [m, 2, 2], their strains [m]."""
    with h5py.File(path) as file:
        n, ends = len(file["VTKHDF/Steps/Values"]), file["lattice/ends"][...]
        x = file["VTKHDF/Points"][...].reshape(n, -1, 3)[:, :, :2]
        strain = file["VTKHDF/CellData/strain"][...].reshape(n, -1)
        broken = file["VTKHDF/CellData/broken"][...].reshape(n, -1)
    return [(x[k][ends[broken[k] == 0]], strain[k][broken[k] == 0]) for k in range(n)]


# What the library was handed, and how that comes into the picture: ends and strains of springs, places to pixels (counted
# from below), half the width of what is drawn in pixels.


def shown_by_matplotlib(names):
    springs, axes = names["springs"], names["axes"]
    half = springs.get_linewidth()[0] * names["figure"].dpi / 72 / 2
    return np.array(springs.get_segments()), springs.get_array(), axes.transData.transform, half


def seen_from(centre, half_height):
    """Places to pixels in a parallel projection."""
    scale = 0.5 * HEIGHT / half_height
    return lambda x: (x - np.asarray(centre)[:2]) * scale + [0.5 * WIDTH, 0.5 * HEIGHT]


def shown_by_pyvista(names):
    whole, camera, filled = names["whole"], names["plotter"].camera, names["filled"]
    with h5py.File(names["path"]) as file:
        triangles = file["lattice/triangles"][...]
    unbroken = triangles[np.arange(len(triangles)) % 7 != 0]
    corners = filled.points[filled.faces.reshape(-1, 4)[:, 1:]]
    assert np.array_equal(corners, names["body"].points[unbroken]), "not what is whole of the body is filled"
    ends = whole.cells.reshape(-1, 3)[:, 1:]
    return whole.points[ends][:, :, :2], whole["strain"], seen_from(camera.focal_point, camera.parallel_scale), 1.25


def bonds_of(frame, strain="strain"):
    particles = frame.particles
    return particles.positions[...][particles.bonds.topology[...]][:, :, :2], particles.bonds[strain][...]


def shown_by_ovito(names):
    view, frame = names["view"], names["pipeline"].compute(FRAME)
    half = frame.particles.vis.radius * 0.5 * HEIGHT / view.fov
    return *bonds_of(frame), seen_from(view.camera_pos, view.fov), half


def install_reader(folder):
    """As pip does; OVITO looks for readers when it is imported."""
    import tomllib
    project = tomllib.loads((SCRIPT.parent / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    information = pathlib.Path(folder, "reader-0.dist-info")
    information.mkdir()
    (information / "METADATA").write_text(f"Name: {project['name']}\nVersion: {project['version']}\n")
    (information / "entry_points.txt").write_text("".join(
        f"[{group}]\n" + "".join(f"{name} = {what}\n" for name, what in points.items())
        for group, points in project["entry-points"].items()))
    sys.path[:0] = [folder, str(SCRIPT.parent)]


def check_reader(path):
    """Unasked, OVITO takes the installed reader; all frames, and what frames show of nodes."""
    from ovito.io import import_file
    pipeline, frames = import_file(str(path)), read_frames(path)
    assert pipeline.num_frames == len(frames)
    with h5py.File(path) as file:
        arrays = {OVITO_NAMES.get(name, name): array[...] for name, array in file["VTKHDF/PointData"].items()}
    for k, expected in enumerate(frames):
        frame = pipeline.compute(k)
        n = frame.particles.count
        assert all(map(np.array_equal, bonds_of(frame), expected)), k
        for name, array in arrays.items():
            shown = frame.particles[name][...]
            assert np.array_equal(shown, array[k * n:(k + 1) * n] if len(array) > n else array), (k, name)


def check_export(path):
    """As docs/exchange.md says."""
    from ovito.io import import_file
    from ovito.modifiers import LoadTrajectoryModifier
    subprocess.run([DEM_EXPORT, path, "--to", "lammps"], cwd=path.parent, check=True, stderr=subprocess.DEVNULL)
    stem = str(path.with_suffix(""))
    nodes, springs = LoadTrajectoryModifier(), LoadTrajectoryModifier()
    nodes.source.load(f"{stem}.dump")
    springs.source.load(f"{stem}.local.dump", columns=[None, "Bond Type", "Particle Identifiers.1", "Particle Identifiers.2",
                                                       "Force", "Strain"])
    pipeline = import_file(f"{stem}.data", atom_style="bond")
    pipeline.modifiers.extend([nodes, springs])
    frames = read_frames(path)
    assert pipeline.num_frames == len(frames)
    for k, (segments, strain) in enumerate(frames):
        found = bonds_of(pipeline.compute(k), "Strain")
        # OVITO's reading of decimals: rounding, and that of single precision
        assert np.allclose(found[0], segments, rtol=1e-14, atol=0) and np.allclose(found[1], strain, rtol=1e-7, atol=0), k


def check_picture(path, segments, strain, pixels, half):
    """What is drawn where the body is to be has its bounding box, and red outdoes blue as the strains say."""
    image = imread(path)[:, :, :3]
    assert image.shape == (HEIGHT, WIDTH, 3), image.shape
    image = image[::-1]
    at = pixels(segments.reshape(-1, 2)).reshape(segments.shape)
    low, high = at.min(axis=(0, 1)) - half, at.max(axis=(0, 1)) + half
    assert np.all(high - low > 0.3 * HEIGHT) and np.all(low > 0) and np.all(high < [WIDTH, HEIGHT]), (low, high)
    left, bottom = np.floor(low).astype(int) - 10
    right, top = np.ceil(high).astype(int) + 10
    window = image[bottom:top, left:right]
    drawn = np.argwhere(window.min(axis=2) < 0.98)[:, ::-1] + [left, bottom]
    # a pixel for the rounding of either side, one for smooth edges
    assert np.all(np.abs(drawn.min(axis=0) - low) < 3) and np.all(np.abs(drawn.max(axis=0) - high) < 3), \
        (drawn.min(axis=0), low, drawn.max(axis=0), high)
    colours = len(np.unique((255 * window).astype(int).reshape(-1, 3), axis=0))
    assert colours > 50, colours
    column, row = np.floor(at.mean(axis=1)).astype(int).T
    middle = image[row, column]
    redness = middle[:, 0] - middle[:, 2]
    correlation = np.corrcoef(redness, strain)[0, 1]
    assert correlation > 0.9, correlation
    print(f"{len(strain)} springs, {colours} colours, redness and strain correlate by {correlation:.3f}")


def check_margins(path):
    """What matplotlib draws, with its scales, stands in the middle: to a twentieth of the width, as labels differ."""
    columns = np.flatnonzero(imread(path)[:, :, :3].min(axis=(0, 2)) < 0.98)
    left, right = columns[0], WIDTH - 1 - columns[-1]
    assert abs(left - right) < 0.05 * WIDTH, (left, right)


with tempfile.TemporaryDirectory() as folder:
    run = run_deck(folder)
    if LIBRARY == "ovito":  # before it draws: OVITO 3.17 at times takes a file for a single frame afterwards
        install_reader(folder)
        check_reader(run)
        check_export(run)
    picture = pathlib.Path(folder, "out.png")
    sys.argv = [str(SCRIPT), str(run), str(picture), str(FRAME)]
    found = globals()[f"shown_by_{LIBRARY}"](runpy.run_path(str(SCRIPT), run_name="__main__"))
    segments, strain = read_frames(run)[FRAME]
    assert np.array_equal(found[0], segments) and np.array_equal(found[1], strain)
    check_picture(picture, *found)
    if LIBRARY == "matplotlib":
        check_margins(picture)

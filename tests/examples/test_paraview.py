#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""ParaView draws a run that breaks by docs/examples/plot_paraview.py: bodies are filled where triangles are whole, in the
colours of their stress, and not where they are broken; obstacles are grey. A state that the script saves of one run shows
another one, and docs/examples/run.pvsm a run of the name `run`. Files that are opened by hand show no spring that is
broken, and obstacles in one colour.
`test_paraview.py SCRIPT DEM_BATCH INPUTS PVPYTHON...`, the last with what gives it a display."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

SCRIPT, DEM_BATCH, INPUTS = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
PVPYTHON = sys.argv[4:]

try:
    import h5py
    import numpy as np
    from matplotlib.image import imread
except ImportError as error:
    print(f"skipped: the Python packages h5py, numpy and matplotlib are needed ({error})")
    sys.exit(77)

FRAME = 8
WHITE, GREY = np.ones(3), np.full(3, 0.5)

# In ParaView: runs the script, and says what its camera sees.
DRAW = """
import json, runpy, sys
script, note, sys.argv = sys.argv[1], sys.argv[2], sys.argv[2:]
view = runpy.run_path(script, run_name="__main__")["view"]
json.dump([*view.CameraFocalPoint[:2], view.CameraParallelScale, *view.ViewSize], open(note, "w"))
"""

# The state that is ready, beside a run, as the script's camera sees it.
READY = """
import json, sys
from paraview import simple
state, folder, frame, camera, out = sys.argv[1:6]
simple._DisableFirstRenderCameraReset()
simple.LoadState(state, data_directory=folder, restrict_to_data_directory=True)
view = simple.GetActiveView()
x, y, view.CameraParallelScale, *view.ViewSize = json.load(open(camera))
view.CameraFocalPoint, view.CameraPosition = [x, y, 0], [x, y, 1]
simple.GetAnimationScene().AnimationTime = simple.FindSource("bodies").TimestepValues[int(frame)]
simple.SaveScreenshot(out, view)
"""

# By hand: springs and obstacles as they come, and what the camera sees.
OPEN = """
import json, sys
from paraview import simple
name, frame, out, note = sys.argv[1:5]
view = simple.CreateRenderView(ViewSize=[1200, 900], OrientationAxesVisibility=0, UseColorPaletteForBackground=0,
                               Background=[0, 0, 0], InteractionMode="2D")
springs, obstacles = (simple.VTKHDFReader(FileName=name + end) for end in (".vtkhdf", ".obstacle.vtkhdf"))
scene = simple.GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
scene.AnimationTime = springs.TimestepValues[int(frame)]
shown = [simple.Show(source, view).ColorArrayName[1] for source in (springs, obstacles)]
view.ResetCamera(*springs.GetDataInformation().GetBounds())
simple.Render(view)
simple.SaveScreenshot(out, view)
json.dump({"camera": [*view.CameraFocalPoint[:2], view.CameraParallelScale, *view.ViewSize], "coloured by": shown},
          open(note, "w"))
"""

# A state that was saved, with files of these names from another folder.
SHOW = """
import sys
from paraview import simple
state, folder, out = sys.argv[1:4]
simple.LoadState(state, data_directory=folder, restrict_to_data_directory=True)
simple.SaveScreenshot(out, simple.GetActiveView())
"""


def run_deck(folder, spacing):
    text = (INPUTS / "brittle_disc.nml").read_text(encoding="utf-8")
    for old, new in (("spacing   = 2.5e-3", f"spacing   = {spacing}"), ("t_end   = 4e-3", "t_end   = 1e-3")):
        assert old in text, f"{old} is not in brittle_disc.nml"
        text = text.replace(old, new, 1)
    folder.mkdir()
    (folder / "deck.nml").write_text(text, encoding="utf-8")
    subprocess.run([DEM_BATCH, "deck.nml"], cwd=folder, check=True, stdout=subprocess.DEVNULL)


def in_paraview(folder, program, *arguments):
    (folder / "program.py").write_text(program, encoding="utf-8")
    done = subprocess.run([*PVPYTHON, "program.py", *map(str, arguments)], cwd=folder, check=False, capture_output=True,
                          text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def draw(folder, out):
    """The picture, from below, and what takes places to its pixels."""
    in_paraview(folder, DRAW, SCRIPT, "camera.json", "brittle_disc.vtkhdf", out, FRAME)
    return pixels_of(json.loads((folder / "camera.json").read_text(encoding="utf-8")))


def pixels_of(camera):
    """What takes places to pixels, from below."""
    x, y, scale, width, height = camera
    return lambda at: ((at - [x, y]) * 0.5 * height / scale + [0.5 * width, 0.5 * height]).astype(int)


def picture(path):
    return imread(path)[::-1, :, :3]


def inside(at, corners):
    """Whether each place is in one of the triangles [n, 3, 2], counter-clockwise."""
    found = np.zeros(len(at), bool)
    for t in corners:
        sides = np.roll(t, -1, axis=0) - t
        to = at[:, None] - t
        found |= np.all(sides[:, 0] * to[:, :, 1] - sides[:, 1] * to[:, :, 0] > 0, axis=1)
    return found


def colours_at(image, pixels):
    """Those that are in the picture, with which they are."""
    height, width = image.shape[:2]
    shown = np.flatnonzero(np.all((pixels >= 0) & (pixels < [width, height]), axis=1))
    return image[pixels[shown, 1], pixels[shown, 0]], shown


def is_near(colours, colour):
    return np.max(np.abs(colours - colour), axis=1) < 0.02


def check_picture(folder, image, to_pixels):
    with h5py.File(folder / "brittle_disc.vtkhdf") as file:
        n, k = len(file["lattice/x"]), len(file["lattice/triangles"])
        x = file["VTKHDF/Points"][FRAME * n:(FRAME + 1) * n, :2]
        stress = file["VTKHDF/PointData/von_mises"][FRAME * n:(FRAME + 1) * n]
        triangles = file["lattice/triangles"][...]
        broken = file["fracture/triangles"][FRAME * k:(FRAME + 1) * k] != 0
        ground = file["obstacles/0/points"][...]
    corners = x[triangles]
    middle, level = corners.mean(axis=1), stress[triangles].mean(axis=1)
    colours, shown = colours_at(image, to_pixels(middle[~broken]))
    assert len(shown) > 0.9 * np.sum(~broken), "the body is not in the picture"
    filled = ~is_near(colours, WHITE)
    assert np.mean(filled) > 0.97, f"{np.mean(filled):.3f} of the whole triangles are filled"  # the bar covers a few
    light = np.corrcoef(colours[:, 1], level[~broken][shown])[0, 1]  # Viridis: the more green, the more stress
    assert light > 0.9, f"green and stress correlate by {light:.3f}"
    gaps = middle[broken][~inside(middle[broken], corners[~broken])]
    colours, _ = colours_at(image, to_pixels(gaps))
    empty = is_near(colours, WHITE) | is_near(colours, GREY)
    assert len(colours) > 30 and np.mean(empty) > 0.95, f"{np.mean(empty):.3f} of {len(colours)} gaps are empty"
    along = (ground[:-1, None] + np.linspace(0.2, 0.8, 7)[:, None] * np.diff(ground, axis=0)[:, None]).reshape(-1, 2)
    colours, _ = colours_at(image, to_pixels(along))
    grey = is_near(colours, GREY)
    assert len(colours) > 10 and np.mean(grey) > 0.7, f"{np.mean(grey):.3f} of {len(colours)} places of the ground are grey"
    print(f"{np.mean(filled):.3f} of {len(filled)} triangles filled, green and stress correlate by {light:.3f}, "
          f"{np.mean(empty):.3f} of {len(empty)} gaps empty, ground grey at {np.sum(grey)} of {len(grey)} places")


def distance(at, ends):
    """Of each place from the nearest of the lines [n, 2, 2]."""
    along, to = ends[:, 1] - ends[:, 0], at[:, None] - ends[:, 0]
    share = np.clip(np.sum(to * along, axis=2) / np.sum(along**2, axis=1), 0, 1)
    return np.min(np.linalg.norm(to - share[:, :, None] * along, axis=2), axis=1)


def check_by_hand(folder):
    in_paraview(folder, OPEN, "brittle_disc", FRAME, "hand.png", "hand.json")
    seen = json.loads((folder / "hand.json").read_text(encoding="utf-8"))
    assert seen["coloured by"] == ["", ""], f"coloured by {seen['coloured by']}, and not in one colour"
    with h5py.File(folder / "brittle_disc.vtkhdf") as file:
        n, m = len(file["lattice/x"]), len(file["lattice/ends"])
        ends = file["VTKHDF/Points"][FRAME * n:(FRAME + 1) * n, :2][file["lattice/ends"][...]]
        broken = file["VTKHDF/CellData/broken"][FRAME * m:(FRAME + 1) * m] != 0
        ground = file["obstacles/0/points"][...]
    middle = ends.mean(axis=1)
    image, to_pixels, size = picture(folder / "hand.png"), pixels_of(seen["camera"]), seen["camera"][2]
    gaps = middle[broken]
    others = np.concatenate([ends[~broken], np.stack([ground[:-1], ground[1:]], axis=1)])
    gaps = gaps[distance(gaps, others) > 0.01 * size]  # where no other line is near
    dark = np.max(colours_at(image, to_pixels(gaps))[0], axis=1) < 0.1
    lines = np.max(colours_at(image, to_pixels(middle[~broken]))[0], axis=1) > 0.1
    assert np.mean(lines) > 0.9, f"{np.mean(lines):.3f} of the whole springs are drawn"
    assert len(dark) > 15 and np.mean(dark) > 0.95, f"{np.mean(dark):.3f} of {len(dark)} broken springs are not drawn"
    print(f"by hand {np.mean(lines):.3f} of the whole springs are drawn, {np.mean(~dark):.3f} of {len(dark)} broken ones")


def show_ready_state(folder, place):
    place.mkdir()
    for ending in (".vtkhdf", ".obstacle.vtkhdf"):
        shutil.copy(folder / f"brittle_disc{ending}", place / f"run{ending}")
    with h5py.File(place / "run.body.vtkhdf", "w") as file:
        file["VTKHDF"] = h5py.ExternalLink("run.vtkhdf", "/bodies")
    state = SCRIPT.with_name("run.pvsm")
    in_paraview(folder, READY, state, place, FRAME, "camera.json", "ready.png")
    return picture(folder / "ready.png")


def check_state(coarse, fine, image):
    """The state of the coarse run with the files of the fine one shows this, but for the limits of the colours."""
    draw(coarse, "run.pvsm")
    in_paraview(coarse, SHOW, "run.pvsm", fine, "again.png")
    again = picture(coarse / "again.png")
    assert again.shape == image.shape, again.shape
    same = np.mean((np.max(np.abs(again - 1), axis=2) < 0.02) == (np.max(np.abs(image - 1), axis=2) < 0.02))
    assert same > 0.97, f"{same:.3f} of the pixels are drawn in both or in none"
    print(f"the state shows another run: {same:.4f} of the pixels are drawn in both or in none")


with tempfile.TemporaryDirectory() as place:
    one, other = (pathlib.Path(place, name) for name in ("fine", "coarse"))
    run_deck(one, "4e-3")
    run_deck(other, "6e-3")
    pixels = draw(one, "out.png")
    found = picture(one / "out.png")
    check_picture(one, found, pixels)
    check_by_hand(one)
    check_picture(one, show_ready_state(one, pathlib.Path(place, "named")), pixels)
    check_state(other, one, found)

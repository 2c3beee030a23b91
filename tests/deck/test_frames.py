#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs decks and reads their files back with VTK and h5py: `test_frames.py DEM_BATCH INPUTS READ_VTKHDF [OPTIONS]`;
the options are handed on to the reader."""
import json
import pathlib
import subprocess
import sys
import tempfile

try:
    import h5py
except ImportError as error:
    print(f"skipped: the Python package h5py is needed ({error})")
    sys.exit(77)

DEM_BATCH, INPUTS, READER = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
OPTIONS = sys.argv[4:]

PROBES = """
&probe name = 'spring', kind = 'spring', number = 7, every = 3 /
&probe name = 'gauge', kind = 'gauge', place = 0, 0, 0, 0.1 /
"""

DECKS = [
    # name, changes, frames, interval, further options
    ("rectangle", {"2.5e-3": "1e-2", "'rectangle'\n    frame": "'rectangle'\n    events = T\n    frame"}, 21, 1e-3, []),
    ("disc", {"2.5e-3": "1e-2", "t_end   = 20e-3": "t_end   = 7e-3",
              "name           = 'disc'": "name = 'disc', fields = 'stress', peak_every = 0"}, 8, 1e-3, ["--fields", "stress"]),
    ("every_key", {"poissons_ratio = 0.3333333333333333": "poissons_ratio = 0.45", "precision = 'single'": "precision = 'double'", "deflate = 1": "deflate = 0",
                   "most_stressed = 5": "most_stressed = 7",
                   "events = .false.": "events = .true.", "'force'\n": "'force', 'principal'\n",
                   "&probe\n": PROBES + "&probe\n"}, 6, 1e-3,
     ["--probes", "3", "--fields", "displacement,fragment,velocity,stress,von_mises,principal_stress,strain,force"]),
]

# A point of 2 kg is thrown onto a floor, against a wall and onto the floor again.
BOUNCE = """
&run t_end = 0.9 /
&body shape = 'file', file = 'point.h5', position = 0, 0.5, velocity = 1, 0 /
&obstacle points = -1, 0, 9, 0, restitution = 0.8 /
&obstacle points = 0.5, 0.2, 0.5, 5, restitution = 0.5 /
&solver spacing = 1, max_step = 0.01, v_scale = 1 /
&output name = 'bounce', frame_interval = 0.1, events = .true. /
"""


# Two blocks of different plates run into each other; the job is stopped on its way, and goes on.
TOUCH = """
&run t_end = 1.5e-3, gravity = 0, 0 /
&material name = 'thick', youngs_modulus = 1e7, density = 1050, thickness = 0.2 /
&material name = 'thin', youngs_modulus = 1e7, density = 1050, thickness = 0.1 /
&body shape = 'rectangle', size = 0.04, 0.04, spacing = 1e-2, material = 'thick', velocity = 0, 5 /
&body shape = 'rectangle', size = 0.04, 0.04, spacing = 1e-2, material = 'thin', position = 3e-3, 0.045 /
&contact bodies = 'all' /
&output name = 'touch', frame_interval = 2.5e-4, fields = 'contact', 'strain' /
"""


def check(name, text, folder, *options):
    pathlib.Path(folder, "deck.nml").write_text(text, encoding="utf-8")
    subprocess.run([DEM_BATCH, "deck.nml"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    command = [sys.executable, READER, pathlib.Path(folder, f"{name}.vtkhdf"), *OPTIONS, *map(str, options)]
    return subprocess.run(command, check=False).returncode


def check_input(name, changes, frames, interval, options):
    text = pathlib.Path(INPUTS, f"{name}.nml").read_text(encoding="utf-8")
    for old, new in changes.items():
        assert old in text, f"{old} is not in {name}.nml"
        text = text.replace(old, new, 1)
    with tempfile.TemporaryDirectory() as folder:
        return check(name, text, folder, "--expect-frames", frames, "--interval", interval, *options)


def check_bounce():
    with tempfile.TemporaryDirectory() as folder:
        with h5py.File(pathlib.Path(folder, "point.h5"), "w") as file:
            file["lattice/x"] = [[0.0, 0.0]]
            file["lattice/mass"] = [2.0]
        return check("bounce", BOUNCE, folder, "--bounces", 3)


def check_touch():
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "deck.nml").write_text(TOUCH, encoding="utf-8")
        assert subprocess.run([DEM_BATCH, "deck.nml", "--max-wall", "1e-9"], cwd=folder, check=False,
                              stdout=subprocess.DEVNULL).returncode == 75, "the job is not stopped"
        code = check("touch", TOUCH, folder, "--expect-frames", 7, "--interval", 2.5e-4, "--fields",
                     "contact_force,contact_pressure,strain")
        with h5py.File(pathlib.Path(folder, "touch.vtkhdf")) as file:
            assert max(file["VTKHDF/PointData/contact_pressure"]) > 1e4, "nothing touches"
            assert max(file["history/pairs"]) > 4, "no pairs"
            pairs, gap, t = (file[f"history/{name}"][...] for name in ("pairs", "gap_min", "t"))
            contact = file["VTKHDF/FieldData/contact_energy"][-1]
        result = json.loads(pathlib.Path(folder, "touch.json").read_text(encoding="utf-8"))
        found = [result[key] for key in ("pairs", "pairs_most", "gap_min", "gap_min_t", "crossings")]
        expected = [pairs[-1], max(pairs), min(gap), t[gap.argmin()], 0]
        assert found == expected and result["energy"]["contact"] == contact, f"{found}, {expected}"
        share = result["gap_share"]
        assert abs(result["pressure_share"] * share / (1 - share) ** 2 - 1) < 1e-12, "not the law's pressure"
        assert 0 < share < 1 and result["gap_min"] < 2e-3, "nearer than a fifth of the spacing"
        return code


def check_break():
    text = pathlib.Path(INPUTS, "brittle_disc.nml").read_text(encoding="utf-8")
    for old, new in (("spacing   = 2.5e-3", "spacing   = 6e-3"), ("t_end   = 4e-3", "t_end   = 1e-3")):
        assert old in text, f"{old} is not in brittle_disc.nml"
        text = text.replace(old, new, 1)
    with tempfile.TemporaryDirectory() as folder:
        return check("brittle_disc", text, folder, "--bodies-only")


for code in [*(check_input(*deck) for deck in DECKS), check_bounce(), check_touch(), check_break()]:
    if code != 0:
        sys.exit(code)

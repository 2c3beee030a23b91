#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""`pip install .` makes a package that works by itself: `test_pip.py SOURCE`. Nothing is fetched, and the library is
built without optimisation, which takes a third of the time."""
import os
import pathlib
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(sys.argv[1]).resolve()
PROGRAM = """
import dem
lattice = dem.Lattice.disc(0.02, 5e-3).assemble(dem.Material(youngs_modulus=1e7, density=1050, thickness=1))
with dem.Simulation(lattice, gravity=(0, -10)) as simulation:
    simulation.advance(0.1)
    print(f"{simulation.body().velocity[1]:.9f}", dem.__version__, dem.library.find())
dem.deck(run={"t_end": 1e-3}, material={"youngs_modulus": 1e7, "density": 1050, "thickness": 1},
         body={"shape": "disc", "radius": 0.02, "spacing": 5e-3})
"""

with tempfile.TemporaryDirectory() as folder:
    subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-index",
                    "--no-deps", "--no-build-isolation", "--config-settings=setup-args=-Doptimization=0", "--target", folder,
                    SOURCE], check=True)
    environment = {name: value for name, value in os.environ.items() if name not in ("DEM_LIBRARY", "DEM_BATCH")} | {"PYTHONPATH": folder}
    out = subprocess.run([sys.executable, "-c", PROGRAM], cwd="/", env=environment, capture_output=True, text=True,
                         check=True).stdout
    speed, version, library = out.split()
    print(out, end="")
    assert abs(float(speed) + 1.0) < 1e-9, speed
    assert pathlib.Path(library) == pathlib.Path(folder, "dem", "libdem.so.2"), library
    assert pathlib.Path(folder, "dem", "py.typed").exists(), "its types are hidden"

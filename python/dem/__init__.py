# SPDX-License-Identifier: BSD-3-Clause
"""Elastic bodies as lattices of point masses and springs, dropped on rigid obstacles: they fall, collide and break.

    import dem
    lattice = dem.Lattice.disc(0.065, 5e-3)
    lattice.assemble(dem.Material(youngs_modulus=1e7, density=1050, thickness=1))
    lattice.move((0, 0.1)).launch((0, -10))
    slope = dem.Obstacle([(-0.3, 0.1), (0.3, -0.1)])
    with dem.Simulation(lattice, slope) as simulation:
        simulation.advance(20e-3)
        print(simulation.body().velocity)

Units are SI. c_interface has the library's own functions, as its headers declare them."""
from . import library
from .run import Run, read  # before deck, whose run() takes the name of this module
from .deck import DeckError, deck, run
from .lattice import Lattice, Material
from .library import ArgumentError, ContactError, Error, FileError, IntegratorError, ModelError
from .obstacle import Obstacle, box
from .shape import Outline, Shape, crossed, inside
from .simulation import STOP, Boundary, Simulation, von_mises

__version__ = library.library.dem_version().decode()

__all__ = ["ArgumentError", "Boundary", "ContactError", "DeckError", "Error", "FileError", "IntegratorError", "Lattice",
           "Material", "ModelError", "Obstacle", "Outline", "Run", "STOP", "Shape", "Simulation", "box", "crossed",
           "deck", "inside", "read", "run", "von_mises"]

# SPDX-License-Identifier: BSD-3-Clause
"""Shapes of bodies: outlines or images, less voids and pores, of which lattices are made."""
from __future__ import annotations

from collections.abc import Sequence
from ctypes import byref, c_bool, c_double, c_int64, c_ubyte, pointer as pointer_to
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import ArrayLike

from . import c_interface as c
from .lattice import Lattice
from .library import Bools, Floats, check, enumerator, fill, library, numbers, pointer
from .records import ShapeReport

Place = Sequence[float] | Floats
Grid = Literal["triangles", "squares"]


class Outline:
    """A plane figure in its place, of a body, a void, an inclusion: Outline.rectangle() and the like. Lengths in m,
    angles in rad; a rectangle is turned about its centre, a polygon about the origin of its points, and then shifted
    by `centre`."""

    def __init__(self, kind: str, points: Floats | None = None, **values: Any) -> None:
        self._points = points  # which C only looks at
        self.c = fill(c.dem_outline(), {"kind": enumerator(c.dem_outline_kind, kind, "DEM_OUTLINE_")} | values, {})
        if points is not None:
            self.c.n_points, self.c.points = len(points), pointer(points)
        check(library.dem_outline_check(byref(self.c)))

    @classmethod
    def rectangle(cls, width: float, height: float, centre: Place = (0.0, 0.0), angle: float = 0.0) -> Self:
        return cls("rectangle", size=(width, height), centre=centre, angle=angle)

    @classmethod
    def disc(cls, radius: float, centre: Place = (0.0, 0.0)) -> Self:
        return cls("disc", radius=radius, centre=centre)

    @classmethod
    def ring(cls, radius: float, inner_radius: float, centre: Place = (0.0, 0.0)) -> Self:
        return cls("ring", radius=radius, inner_radius=inner_radius, centre=centre)

    @classmethod
    def polygon(cls, points: ArrayLike, centre: Place = (0.0, 0.0), angle: float = 0.0) -> Self:
        """points: [n][2], in either sense; the last one may be the first once more"""
        return cls("polygon", numbers(points, (None, 2)), centre=centre, angle=angle)

    def distance(self, x: ArrayLike) -> Floats:
        """How far points x [n][2] lie from the edge, [n], > 0 outside."""
        places = numbers(x, (None, 2))
        out = np.empty(len(places))
        check(library.dem_outline_distance(byref(self.c), pointer(places), len(places), pointer(out)))
        return out

    @property
    def box(self) -> Floats:
        """left, bottom, right, top"""
        out = np.empty(4)
        check(library.dem_outline_box(byref(self.c), pointer(out)))
        return out

    @property
    def corners(self) -> Floats:
        """[n][2]; none of discs and rings"""
        out = np.empty((library.dem_outline_corners(byref(self.c)), 2))
        for k, row in enumerate(out):
            check(library.dem_outline_corner(byref(self.c), k, pointer(row)))
        return out


class Shape:
    """What is to be triangulated: an outline or an image, less voids, all in one system of coordinates.

        plate = dem.Shape(dem.Outline.rectangle(0.2, 0.1), 2e-3, edge="smooth", voids=[dem.Outline.disc(0.02)])
        lattice = plate.lattice().assemble(dem.Material(..., springs="coupled"))

    spacing: m, length of the sides of triangles or squares
    grid: 'triangles', or 'squares', whose lattice.assemble() needs their diagonal
    edge: 'stepped', or 'smooth': nodes near edges are moved on to them
    report: after lattice(), how well its edges are met
    """

    def __init__(self, outline: Outline | None, spacing: float, grid: Grid = "triangles",
                 edge: Literal["stepped", "smooth"] = "stepped", voids: Sequence[Outline] = ()) -> None:
        self._outline = outline
        self._image: c.dem_image | None = None
        self.report: ShapeReport | None = None
        self._voids = (c.dem_outline * len(voids))(*[void.c for void in voids])
        self._kept: list[Any] = [outline, *voids]  # with the points that C looks at
        self.pores: Floats = np.empty((0, 3))  #: x, y and radius of round voids, m
        self.c = c.dem_shape(spacing=spacing, grid=enumerator(c.dem_grid, grid, "DEM_GRID_"),
                             edge=enumerator(c.dem_edge, edge, "DEM_EDGE_"), n_voids=len(voids), voids=self._voids)
        if outline is not None:
            self.c.outline = pointer_to(outline.c)

    @classmethod
    def image(cls, solid: ArrayLike, pixel: float, spacing: float, grid: Grid = "triangles",
              voids: Sequence[Outline] = ()) -> Self:
        """A body drawn in pixels, which stands on the origin.
        solid: [height][width] true: material, the top row first, such as `grey >= 128`
        pixel: m, side of a pixel"""
        self = cls(None, spacing, grid, voids=voids)
        self._kept.append(np.ascontiguousarray(numbers(solid, (None, None), np.bool_), np.uint8))
        height, width = self._kept[-1].shape
        self._image = c.dem_image(width=width, height=height, pixel=pixel, solid=pointer(self._kept[-1], c_ubyte))
        self.c.image = pointer_to(self._image)
        return self

    def _compiled(self) -> Any:
        """The struct with the pores of now."""
        self.pores = numbers(self.pores, (None, 3))
        self.c.n_pores, self.c.pores = len(self.pores), pointer(self.pores)
        return byref(self.c)

    @property
    def area(self) -> float:
        """True area, m^2, without voids and pores."""
        out = c_double()
        check(library.dem_shape_area(self._compiled(), byref(out)))
        return out.value

    def add_pores(self, radius_min: float, radius_max: float, number: int = 0, porosity: float = 0.0, wall: float = 0.0,
                  seed: int = 1, distribution: Literal["uniform", "lognormal", "normal"] = "uniform", mean: float = 0.0,
                  deviation: float = 0.0) -> Self:
        """Places random round pores in the material that is left; the same seed gives the same ones. Returns the shape.
        porosity: where number is 0, of the area that is left now
        wall: m, least material between pores, and between a pore and an edge
        distribution: of the radii, 'uniform', 'lognormal' or 'normal', with a mean and a deviation, m"""
        area = porosity * self.area if number == 0 else 0.0
        recipe = c.dem_pores(number=number, area=area, radius_min=radius_min, radius_max=radius_max, wall=wall,
                             seed=seed, mean=mean, deviation=deviation,
                             distribution=enumerator(c.dem_pore_radii, distribution, "DEM_PORE_RADII_"))
        room, n = np.empty((c.DEM_PORES_MAX if number == 0 else number, 3)), c_int64()
        check(library.dem_shape_place_pores(self._compiled(), byref(recipe), pointer(room), len(room), byref(n)))
        self.pores = np.concatenate([self.pores, room[:n.value]])
        return self

    def lattice(self) -> Lattice:
        """A Lattice of nodes and triangles, to be assembled."""
        report = c.dem_shape_report()
        made = Lattice._made(library.dem_shape_lattice, self._compiled(), byref(report))
        self.report = ShapeReport(report)
        return made


def inside(lattice: Lattice, outline: Outline, cells: bool = False) -> Bools:
    """Which triangles of a lattice have their centres in a figure, [n_triangles] bool, as `of` of assemble() for an
    inclusion. cells: both triangles of a cell of squares go by their common centre"""
    out = np.zeros(lattice.n_triangles, np.bool_)
    check(library.dem_lattice_inside(byref(lattice._memory.c), byref(outline.c), 2 if cells else 1,
                                     pointer(out, c_bool), None))
    return out


def crossed(lattice: Lattice, points: ArrayLike, aside: float = 0.0) -> Bools:
    """Which triangles of a lattice a polyline crosses, [n_triangles] bool: lattice.trim(~dem.crossed(...)) is a crack.
    points: [n][2] m
    aside: m, how far it is shifted to its left, usually 1e-6 of the spacing, so that one along a row takes the
        triangles on its left"""
    line, out = numbers(points, (None, 2)), np.zeros(lattice.n_triangles, np.bool_)
    check(library.dem_lattice_crossed(byref(lattice._memory.c), pointer(line), len(line), aside, pointer(out, c_bool),
                                      None))
    return out

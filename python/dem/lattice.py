# SPDX-License-Identifier: BSD-3-Clause
"""What bodies are made of: materials, and lattices of nodes, springs and triangles."""
from __future__ import annotations

import ctypes
import os
from collections.abc import Callable, Sequence
from ctypes import byref, c_bool, c_double, c_int32, c_int64, c_ubyte
from typing import Any, Literal, Self, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import c_interface as c
from .library import Enumeration, Floats, Integers, check, enumerator, fill, library, numbers, pointer, view
from .records import MaterialKeywords

ENUMERATIONS: dict[str, Enumeration] = {
    "plane": (c.dem_plane, "DEM_PLANE_"), "springs": (c.dem_springs, "DEM_SPRINGS_"),
    "stress_average": (c.dem_stress_average, "DEM_STRESS_AVERAGE_")}

# name: (extent, components, type) of the arrays of a lattice
ARRAYS: dict[str, tuple[str, int, Any]] = {
    "x": ("n_nodes", 2, c_double), "mass": ("n_nodes", 1, c_double), "flags": ("n_nodes", 1, c_ubyte),
    "body": ("n_nodes", 1, c_int32), "position": ("n_nodes", 2, c_double), "velocity": ("n_nodes", 2, c_double),
    "ends": ("n_springs", 2, c_int64), "rest_length": ("n_springs", 1, c_double),
    "stiffness": ("n_springs", 1, c_double), "viscosity": ("n_springs", 1, c_double),
    "critical_stretch": ("n_springs", 1, c_double), "triangles": ("n_triangles", 3, c_int64),
    "guard": ("n_triangles", 1, c_double), "area_stiffness": ("n_triangles", 1, c_double),
    "thickness": ("n_triangles", 1, c_double), "modulus": ("n_triangles", 1, c_double),
    "coupling": ("n_triangles", 3, c_double), "strength": ("n_triangles", 1, c_double),
    "softening": ("n_triangles", 1, c_double), "compressive_strength": ("n_triangles", 1, c_double),
    "confinement": ("n_triangles", 1, c_double), "own_stress": ("n_triangles", 1, c_ubyte)}

_malloc = ctypes.CDLL(None).malloc
_malloc.restype, _malloc.argtypes = ctypes.c_void_p, [ctypes.c_size_t]
_free = ctypes.CDLL(None).free
_free.restype, _free.argtypes = None, [ctypes.c_void_p]


class Material:
    """An isotropic solid: youngs_modulus (Pa), density (kg/m^3), thickness (m), poissons_ratio (1/3), and the other
    fields of dem_material, by their names. plane is 'stress' or 'strain', springs 'independent' or 'coupled',
    stress_average 'corners' or 'element'; guard, the strength of the folding guard, is 0.02 unless given."""

    def __init__(self, **values: Unpack[MaterialKeywords]) -> None:
        self.c = fill(c.dem_material(), {"poissons_ratio": 1.0 / 3.0, "guard": 0.02, **values}, ENUMERATIONS)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.__dict__["c"], name)


class _Memory:
    """A dem_lattice and its arrays."""
    writable = True

    def __init__(self) -> None:
        self.c = c.dem_lattice_default()

    def __del__(self) -> None:
        library.dem_lattice_free(byref(self.c))


class _Borrowed:
    """A dem_lattice that belongs to the library, as long as its owner lives."""
    writable = False

    def __init__(self, lattice: Any, owner: object) -> None:
        self.c, self.owner = lattice.contents, owner


class Lattice:
    """Nodes, springs and triangles as plain arrays, to be generated, assembled, edited: Lattice.rectangle() and the
    like, then assemble(). The arrays x [n][2] (m), mass (kg), ends, triangles, ... are those of dem_lattice: views that
    may be written to, None where there is none. A method that adds or removes elements has other arrays afterwards, and
    views of before must not be used any more. Methods return the lattice, so that they can be chained."""
    n_nodes: int
    n_springs: int
    n_triangles: int
    x: Floats | Any  # Any: what may be assigned, and None where there is none
    mass: Floats | Any
    flags: NDArray[np.uint8] | Any
    body: NDArray[np.int32] | Any
    position: Floats | Any
    velocity: Floats | Any
    ends: Integers | Any
    rest_length: Floats | Any
    stiffness: Floats | Any
    viscosity: Floats | Any
    critical_stretch: Floats | Any
    triangles: Integers | Any
    guard: Floats | Any
    area_stiffness: Floats | Any
    thickness: Floats | Any
    modulus: Floats | Any
    coupling: Floats | Any
    strength: Floats | Any
    softening: Floats | Any
    compressive_strength: Floats | Any
    confinement: Floats | Any
    own_stress: NDArray[np.uint8] | Any

    def __init__(self) -> None:
        self._memory: _Memory | _Borrowed = _Memory()

    @classmethod
    def borrowed(cls, lattice: Any, owner: object) -> Self:
        """One of the library's, which cannot be changed."""
        self = cls()
        self._memory = _Borrowed(lattice, owner)
        return self

    @classmethod
    def _made(cls, create: Callable[..., int], *arguments: Any) -> Self:
        self = cls()
        check(create(byref(self._memory.c), *arguments))
        return self

    @classmethod
    def rectangle(cls, width: float, height: float, spacing: float) -> Self:
        """Equilateral triangles, standing on the origin; m."""
        return cls._made(library.dem_lattice_rectangle, width, height, spacing)

    @classmethod
    def squares(cls, width: float, height: float, spacing: float) -> Self:
        """The same of square cells; m. assemble() needs their diagonal."""
        return cls._made(library.dem_lattice_squares, width, height, spacing)

    @classmethod
    def disc(cls, radius: float, spacing: float) -> Self:
        """Equilateral triangles about the origin; m."""
        return cls._made(library.dem_lattice_disc, radius, spacing)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Self:
        """From the group /lattice of an HDF5 file, such as any that dem writes."""
        return cls._made(library.dem_lattice_read, str(path).encode())

    @classmethod
    def mesh(cls, file: str | os.PathLike[str] | bytes, scale: float = 1.0) -> Self:
        """Of a mesh by Gmsh, MSH 4.1 as text: the path of its file, or the text itself as bytes.
        scale: m, length of 1 in its coordinates"""
        if isinstance(file, bytes):
            made = c.dem_mesh(text=file, size=len(file), scale=scale)
        else:
            made = c.dem_mesh(path=os.fsencode(file), scale=scale)
        return cls._made(library.dem_mesh_lattice, byref(made))

    @classmethod
    def of_arrays(cls, x: ArrayLike, **arrays: ArrayLike) -> Self:
        """Of nodes x [n][2], m, and other arrays by the names of dem_lattice, all of which are copied; `triangles`
        alone are enough for assemble()."""
        self = cls()
        for name, values in {"x": x, **arrays}.items():
            self._put(name, values)
        return self

    def _put(self, name: str, values: ArrayLike) -> None:
        self._refuse_borrowed()
        if name not in ARRAYS:
            raise TypeError(f"a lattice has no '{name}', but {', '.join(ARRAYS)}")
        extent, components, kind = ARRAYS[name]
        array = numbers(values, (None,) if components == 1 else (None, components), np.dtype(kind))
        lattice = self._memory.c
        known = getattr(lattice, extent)
        if known not in (0, len(array)):
            raise ValueError(f"'{name}' is of {len(array)} elements, {extent} is {known}")
        setattr(lattice, extent, len(array))
        copied = _malloc(max(array.nbytes, 1))
        if not copied:
            raise MemoryError(f"'{name}'")
        ctypes.memmove(copied, array.ctypes.data, array.nbytes)
        _free(ctypes.cast(getattr(lattice, name), ctypes.c_void_p))
        setattr(lattice, name, ctypes.cast(copied, ctypes.POINTER(kind)))

    def __getattr__(self, name: str) -> Any:
        lattice = self.__dict__["_memory"].c
        if name in ARRAYS:
            extent, components, _ = ARRAYS[name]
            n = getattr(lattice, extent)
            return view(getattr(lattice, name), (n,) if components == 1 else (n, components), self._memory,
                        self._memory.writable)
        if name in ("n_nodes", "n_springs", "n_triangles"):
            return getattr(lattice, name)
        raise AttributeError(f"'Lattice' has no attribute '{name}'")

    def __setattr__(self, name: str, values: Any) -> None:
        if name in ARRAYS:
            self._put(name, values)
        else:
            super().__setattr__(name, values)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *ARRAYS, "n_nodes", "n_springs", "n_triangles"]

    def __repr__(self) -> str:
        return f"Lattice({self.n_nodes} nodes, {self.n_springs} springs, {self.n_triangles} triangles)"

    def copy(self) -> Lattice:
        """An equal one with arrays of its own."""
        return Lattice.of_arrays(**{name: values for name in ARRAYS if (values := getattr(self, name)) is not None})

    def _refuse_borrowed(self) -> None:
        if not self._memory.writable:
            raise ValueError("this lattice is the library's: change a copy()")

    def _do(self, function: Callable[..., int], *arguments: Any) -> Self:
        self._refuse_borrowed()
        check(function(byref(self._memory.c), *arguments))
        return self

    # ---- triangulations, before assemble() ----

    def cut(self, keep: Callable[[Floats], Any]) -> Self:
        """Removes the nodes at x [2] (m) for which keep(x) is false, and what they leave without a triangle."""
        return self.trim(np.array([bool(keep(x)) for x in self.x])[self.triangles].all(axis=1))

    def trim(self, keep: ArrayLike) -> Self:
        """Keeps triangles. keep: [n_triangles] bool"""
        mask = numbers(keep, (self.n_triangles,), np.bool_)
        return self._do(library.dem_lattice_trim, pointer(mask, c_bool))

    def jitter(self, radius: float, seed: int = 0) -> Self:
        """Moves every inner node to a random place within `radius`, m."""
        return self._do(library.dem_lattice_jitter, radius, seed)

    def assemble(self, material: Material, *more: Material, of: ArrayLike | None = None,
                 diagonal: float = 0.0) -> Self:
        """Springs, masses and what triangles have.
        of: [n_triangles] number of each triangle's material among those given; None: the first
        diagonal: of square cells, usually 0.5; 0: triangles"""
        materials = (c.dem_material * (1 + len(more)))(material.c, *[m.c for m in more])
        numbered = None if of is None else numbers(of, (self.n_triangles,), np.int64)
        return self._do(library.dem_lattice_assemble_mixed, materials, len(materials), pointer(numbered, c_int64),
                        diagonal)

    # ---- bodies ----

    def move(self, offset: Sequence[float] | Floats = (0.0, 0.0), angle: float = 0.0) -> Self:
        """Turns by `angle`, rad, about the origin, then shifts, m."""
        self._refuse_borrowed()
        library.dem_lattice_move(byref(self._memory.c), angle, (c_double * 2)(*offset))
        return self

    def launch(self, velocity: Sequence[float] | Floats) -> Self:
        """Adds a velocity, m/s, to that with which the motion starts."""
        return self._do(library.dem_lattice_launch, (c_double * 2)(*velocity))

    def spin(self, angular_velocity: float, centre: Sequence[float] | Floats | None = None) -> Self:
        """Adds a rotation, rad/s, counter-clockwise, about a place, m: the centre of mass if none is given."""
        if centre is None:
            return self._do(library.dem_lattice_spin, angular_velocity)
        return self._do(library.dem_lattice_spin_about, angular_velocity, (c_double * 2)(*centre))

    def append(self, other: Lattice) -> Self:
        """Adds a copy of another lattice; its bodies are numbered behind those that are there."""
        return self._do(library.dem_lattice_append, byref(other._memory.c))

    def select(self, keep: ArrayLike) -> Self:
        """Keeps nodes with what is among them.  keep: [n_nodes] bool"""
        mask = numbers(keep, (self.n_nodes,), np.bool_)
        return self._do(library.dem_lattice_select, pointer(mask, c_bool))

    def exclude(self, nodes: ArrayLike) -> Self:
        """Takes nodes, by their numbers, from contact with obstacles."""
        list_of = numbers(nodes, (None,), np.int64)
        return self._do(library.dem_lattice_exclude, pointer(list_of, c_int64), len(list_of))

    def stiffen(self, guide: Literal["none", "x", "y"] | int = "none") -> Self:
        """Makes all bodies rigid. guide: 'none', or 'x' or 'y', along which alone they move without turning"""
        return self._do(library.dem_lattice_stiffen, enumerator(c.dem_guide, guide, "DEM_GUIDE_"))

    def parts(self) -> Integers:
        """The part of each node, [n_nodes]: parts are what springs do not connect."""
        n, part = c_int64(), np.empty(self.n_nodes, np.int64)
        check(library.dem_lattice_parts(byref(self._memory.c), byref(n), pointer(part, c_int64)))
        return part

    def edge_shares(self, nodes: ArrayLike, direction: ArrayLike | None = None) -> Floats:
        """Of each of some nodes its share of the boundary edges between them, m^2, as `shares` of a traction.
        direction: [2] unit, along which edges are projected; None: by length"""
        list_of = numbers(nodes, (None,), np.int64)
        along = None if direction is None else numbers(direction, (2,))
        area = np.empty(len(list_of))
        check(library.dem_lattice_edge_shares(byref(self._memory.c), pointer(list_of, c_int64), len(list_of),
                                              pointer(along), pointer(area)))
        return area

    def weibull(self, shape: float, volume: float, seed: int = 0, section: float = 0.0,
                of: ArrayLike | None = None) -> Self:
        """Draws strengths by Weibull's law of the weakest link and multiplies those of triangles and springs by them.
        shape: m; volume: of the piece of which 1/e stands the material's strength, m^3"""
        law = c.dem_weibull(shape=shape, volume=volume, section=section, seed=seed)
        triangle, spring = np.empty(self.n_triangles), np.empty(self.n_springs)
        numbered = None if of is None else numbers(of, (self.n_triangles,), np.int64)
        check(library.dem_lattice_weibull(byref(self._memory.c), byref(law), 1, pointer(numbered, c_int64),
                                          pointer(triangle), pointer(spring)))
        return self.weaken(strength=triangle, stretch=spring)

    def weaken(self, strength: ArrayLike | None = None, energy: ArrayLike | None = None,
               stretch: ArrayLike | None = None) -> Self:
        """Multiplies strengths and fracture energies [n_triangles] and critical stretches [n_springs] by factors."""
        factors = [None if values is None else numbers(values, (n,)) for values, n in
                   ((strength, self.n_triangles), (energy, self.n_triangles), (stretch, self.n_springs))]
        return self._do(library.dem_lattice_weaken, *map(pointer, factors))

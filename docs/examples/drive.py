#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The program of drive.c in Python, by ctypes and NumPy: a rubber block in a trap.

The classes are the structures of dem/*.h, field by field under the same names; those that a program does not use it
need not have. What C is handed must live as long as C uses it: keep it in a variable."""
import ctypes
import math
import sys
from ctypes import POINTER, byref, c_char_p, c_double, c_int, c_int32, c_int64, c_size_t, c_void_p

import numpy as np

OK, STOPPED, ERROR_ARGUMENT = 0, 1, -2
GRAVITY, PERIOD, SPEED, STRETCH, FRAMES = 9.81, 10e-3, 1.0, 1e-4, 18
doubles, indices = POINTER(c_double), POINTER(c_int64)


class Sized(ctypes.Structure):
    """Begins with its size, by which the library knows what a program's structs hold."""

    def __init__(self, **given):
        super().__init__(struct_size=ctypes.sizeof(type(self)), **given)


class dem_material(Sized):
    _fields_ = [("struct_size", c_size_t), ("youngs_modulus", c_double), ("bond_stiffness", c_double),
                ("poissons_ratio", c_double), ("plane", c_int), ("density", c_double),
                ("thickness", c_double), ("guard", c_double), ("damping_time", c_double),
                ("springs", c_int), ("strength", c_double), ("critical_stretch", c_double),
                ("fracture_energy", c_double), ("compressive_strength", c_double),
                ("stress_average", c_int)]


class dem_lattice(Sized):
    _fields_ = [("struct_size", c_size_t), ("dim", c_int), ("n_nodes", c_int64), ("n_springs", c_int64),
                ("n_triangles", c_int64), ("x", doubles), ("mass", doubles), ("ends", indices),
                ("rest_length", doubles), ("stiffness", doubles), ("triangles", indices), ("viscosity", doubles),
                ("guard", doubles), ("area_stiffness", doubles), ("thickness", doubles), ("modulus", doubles),
                ("flags", POINTER(ctypes.c_ubyte)), ("body", POINTER(c_int32)), ("position", doubles),
                ("velocity", doubles), ("coupling", doubles), ("strength", doubles),
                ("critical_stretch", doubles), ("softening", doubles), ("compressive_strength", doubles),
                ("confinement", doubles), ("own_stress", POINTER(ctypes.c_ubyte))]


class dem_force_query(ctypes.Structure):
    _fields_ = [("t", c_double), ("n", c_int64), ("nodes", indices), ("x", doubles), ("v", doubles)]


dem_force = ctypes.CFUNCTYPE(c_int, c_void_p, POINTER(dem_force_query), doubles)


class dem_options(Sized):
    _fields_ = [("struct_size", c_size_t), ("method", c_int), ("gravity", c_double * 3), ("rtol", c_double),
                ("spacing", c_double), ("v_scale", c_double), ("max_step", c_double), ("fixed_step", c_double),
                ("penetration_tolerance", c_double), ("rest_speed", c_double), ("max_impacts", c_int64), ("window", c_double),
                ("mass_damping", c_double), ("vertices", ctypes.c_bool), ("contact", c_int), ("kernel", c_int),
                ("threads", c_int32), ("checkpoint_steps", c_int64), ("n_boundaries", c_int64), ("boundaries", c_void_p),
                ("force", dem_force), ("force_context", c_void_p), ("bodies", c_int),
                ("contact_thickness", c_double), ("contact_stiffness", c_double),
                ("contact_friction", c_double), ("n_body_frictions", c_int64), ("body_friction", doubles),
                ("pause", c_double), ("thread_nodes", c_int64)]

    def __init__(self, **given):
        """As dem_options_default(), which is inline in the header."""
        defaults = dict(gravity=(0.0, -9.81, 0.0), rtol=1e-6, max_impacts=10000,
                        window=-1.0, vertices=True, threads=1, checkpoint_steps=256)
        super().__init__(**{**defaults, **given})


class dem_state(Sized):
    _fields_ = [("struct_size", c_size_t), ("t", c_double), ("step", c_double), ("x", doubles), ("v", doubles),
                ("n_contacts", c_int64)]


seen = ctypes.CFUNCTYPE(c_int, c_void_p, c_void_p)


class dem_observer(Sized):
    _fields_ = [("struct_size", c_size_t), ("interval", c_double), ("frame", seen), ("step", seen),
                ("event", ctypes.CFUNCTYPE(c_int, c_void_p, c_void_p, c_void_p)),
                ("checkpoint", ctypes.CFUNCTYPE(c_int, c_void_p, c_void_p, c_void_p)), ("context", c_void_p),
                ("broken", ctypes.CFUNCTYPE(c_int, c_void_p, c_void_p, c_void_p)), ("step_every", c_int64),
                ("step_interval", c_double), ("step_touching", c_int64)]


dem = ctypes.CDLL("libdem.so.2")
dem.dem_status_message.restype = c_char_p
dem.dem_model_lattice.restype = POINTER(dem_lattice)
for function, arguments in {
        "dem_lattice_rectangle": [POINTER(dem_lattice), c_double, c_double, c_double],
        "dem_lattice_assemble": [POINTER(dem_lattice), POINTER(dem_material)],
        "dem_lattice_free": [POINTER(dem_lattice)],
        "dem_model_create": [POINTER(c_void_p), POINTER(dem_lattice), c_void_p, c_int64],
        "dem_model_lattice": [c_void_p],
        "dem_model_destroy": [c_void_p],
        "dem_simulation_create": [POINTER(c_void_p), c_void_p, POINTER(dem_options)],
        "dem_simulation_set_motion": [c_void_p, doubles, doubles],
        "dem_simulation_observe": [c_void_p, POINTER(dem_observer)],
        "dem_simulation_advance": [c_void_p, c_double],
        "dem_simulation_state": [c_void_p, POINTER(dem_state)],
        "dem_simulation_stress": [c_void_p, doubles],
        "dem_simulation_destroy": [c_void_p]}.items():
    getattr(dem, function).argtypes = arguments


def check(status):
    if status != OK:
        raise RuntimeError(dem.dem_status_message().decode())


def view(pointer, *shape):
    """The memory of C as an array, not a copy."""
    return np.ctypeslib.as_array(pointer, shape)


def pointer(array):
    return array.ctypes.data_as(doubles)


class Block:
    """What the callbacks work with. An exception must not pass through C: it ends the run and is kept."""

    def __init__(self, rest):
        n = rest.n_nodes
        self.mass, self.x, self.rate = view(rest.mass, n), view(rest.x, n, 2), 2.0 * math.pi / PERIOD
        self.way = self.stress = self.exception = None  # way: of the centre of mass from its place at rest
        self.force = dem_force(self.guarded(self.pull))
        self.frame = seen(self.guarded(self.look))

    def guarded(self, callback):
        def call(context, *arguments):
            try:
                return callback(*arguments)
            except Exception as exception:
                self.exception = exception
                return ERROR_ARGUMENT
        return call

    def pull(self, query, force):
        """The force from outside: of each node that is asked about, by its number."""
        q = query.contents
        nodes, x, f = view(q.nodes, q.n), view(q.x, q.n, 2), view(force, q.n, 2)
        mass = self.mass[nodes]
        f[:, 0] = -mass * self.rate * self.rate * (x[:, 0] - self.x[nodes, 0])
        f[:, 1] = mass * GRAVITY
        return OK

    def look(self, simulation):
        """The observer: at every frame."""
        state, n = dem_state(), len(self.mass)
        check(dem.dem_simulation_state(simulation, byref(state)))
        self.way = self.mass @ (view(state.x, n, 2) - self.x) / self.mass.sum()
        if state.t == 0.0:
            self.stress = np.empty((n, 3))
            check(dem.dem_simulation_stress(simulation, pointer(self.stress)))
        return STOPPED if self.mass @ view(state.v, n, 2)[:, 0] < 0.0 else OK


def main():
    rubber = dem_material(youngs_modulus=1e7, poissons_ratio=1.0 / 3.0, density=1050, thickness=1, guard=0.02)
    lattice, model, simulation = dem_lattice(), c_void_p(), c_void_p()
    check(dem.dem_lattice_rectangle(byref(lattice), 0.04, 0.04, 0.01))
    check(dem.dem_lattice_assemble(byref(lattice), byref(rubber)))
    check(dem.dem_model_create(byref(model), byref(lattice), None, 0))
    dem.dem_lattice_free(byref(lattice))

    block = Block(dem.dem_model_lattice(model).contents)
    options = dem_options(gravity=(0.0, -GRAVITY, 0.0), force=block.force)
    check(dem.dem_simulation_create(byref(simulation), model, byref(options)))
    x, v = block.x * (1.0 + STRETCH, 1.0), np.full_like(block.x, (SPEED, 0.0))
    check(dem.dem_simulation_set_motion(simulation, pointer(x), pointer(v)))
    observer = dem_observer(interval=PERIOD / FRAMES, frame=block.frame)
    check(dem.dem_simulation_observe(simulation, byref(observer)))
    status = dem.dem_simulation_advance(simulation, PERIOD)
    dem.dem_simulation_destroy(simulation)
    dem.dem_model_destroy(model)
    if block.exception:
        raise block.exception
    if status != STOPPED:
        check(status)

    nu = rubber.poissons_ratio
    along = rubber.youngs_modulus * STRETCH / (1.0 - nu * nu)
    expected = SPEED / block.rate * math.sin(2.0 * math.pi * 5 / FRAMES)  # turns back after 4.5 frames
    print(f"{block.way[0]:.9e} m")
    good = math.hypot(block.way[0] - expected, block.way[1]) <= 1e-6 * expected
    return 0 if good and np.abs(block.stress - (along, nu * along, 0.0)).max() <= 10.0 * STRETCH * along else 1


if __name__ == "__main__":
    sys.exit(main())

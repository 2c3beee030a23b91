# SPDX-License-Identifier: BSD-3-Clause
"""The moving state of bodies on obstacles, and the time loop."""
from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Sequence
from ctypes import POINTER, byref, c_double, c_int64, c_ubyte
from typing import Any, Literal, Self, Unpack

import numpy as np
from numpy.typing import ArrayLike

from . import c_interface as c, records
from .callbacks import Callbacks
from .lattice import Lattice
from .library import (Bools, Enumeration, Floats, Handle, Integers, ask, check, enumerator, fill, library, make,
                      numbers, pointer, view)
from .obstacle import Obstacle, compile_all
from .progress import Progress
from .recording import Recording

STOP = c.dem_status.DEM_STOPPED  # what an observer returns so as to end an advance
Force = Callable[[float, Integers, Floats, Floats], ArrayLike]
SLICE = 0.05  # s on the wall, from one look for an interrupt to the next

ENUMERATIONS: dict[str, Enumeration] = {
    "contact": (c.dem_contact_method, "DEM_CONTACT_"), "kernel": (c.dem_kernel, "DEM_KERNEL_"),
    "bodies": (c.dem_bodies, "DEM_BODIES_"), "method": (c.dem_method, "DEM_METHOD_")}


class Boundary:
    """What is done to nodes from outside: kind 'velocity' (value in m/s), 'displacement' (m) or 'force' (N), of the
    components 'x', 'y' or 'xy', with a ramp of so many seconds.
    shares: [n_nodes] of a force, as Lattice.edge_shares() has them for a traction; None: equal ones"""

    def __init__(self, kind: Literal["velocity", "displacement", "force"], nodes: ArrayLike,
                 value: Sequence[float] | Floats, components: Literal["x", "y", "xy"] = "xy", ramp: float = 0.0,
                 shares: ArrayLike | None = None) -> None:
        self.nodes = numbers(nodes, (None,), np.int64)
        self.shares = None if shares is None else numbers(shares, (len(self.nodes),))
        which = sum({"x": c.DEM_COMPONENT_X, "y": c.DEM_COMPONENT_Y}[name] for name in components)
        self.c = c.dem_boundary(kind=enumerator(c.dem_boundary_kind, kind, "DEM_BOUNDARY_"), components=which,
                                n_nodes=len(self.nodes), nodes=pointer(self.nodes, c_int64),
                                share=pointer(self.shares), value=(*value, 0.0), ramp=ramp)


class Simulation:
    """The motion of a lattice on obstacles, from t = 0. Options are those of dem_options, by their names: gravity
    (m/s^2), rtol, method ('fehlberg45', 'verlet', ...), bodies ('none', 'others', 'all'), contact_friction, ...

    force(t, nodes, x, v) returns the force from outside [n][2] (N) on the nodes of these numbers, at x, v [n][2]. It
    depends on nothing else. Whatever it, or an observer, raises ends the advance and comes out of it.

    x and v [n_nodes][2] are views of what is seen, which the next advance changes: copy what is to be kept. A view
    keeps the memory alive when the simulation itself is closed, or is no more."""

    def __init__(self, lattice: Lattice, obstacles: Obstacle | Iterable[Obstacle] = (), *, force: Force | None = None,
                 boundaries: Boundary | Iterable[Boundary] = (), checkpoint: str | os.PathLike[str] | None = None,
                 **options: Unpack[records.OptionsKeywords]) -> None:
        self._callbacks = Callbacks()
        self._kept: list[Any] = []  # what C looks at
        self._handle: Handle | None = None
        obstacles = [obstacles] if isinstance(obstacles, Obstacle) else list(obstacles)
        array, kept = compile_all(obstacles, self._wrap_motion)
        self._kept += kept
        out = POINTER(c.dem_model)()
        self._callbacks.call(library.dem_model_create, byref(out), byref(lattice._memory.c), array, len(obstacles))
        model = Handle(out, library.dem_model_destroy)
        self._begin(model, self._options(force, boundaries, dict(options)), checkpoint)

    def _wrap_motion(self, kind: Any, motion: Callable[..., object]) -> Any:
        return self._callbacks.wrap(kind, lambda t, pose: motion(t, pose.contents))

    def _options(self, force: Force | None, boundaries: Boundary | Iterable[Boundary],
                 values: dict[str, Any]) -> c.dem_options:
        given = c.dem_options_default()
        if "gravity" in values:
            values = values | {"gravity": (*values["gravity"], 0.0)[:3]}
        fill(given, values, ENUMERATIONS)
        boundaries = [boundaries] if isinstance(boundaries, Boundary) else list(boundaries)
        array = (c.dem_boundary * max(len(boundaries), 1))(*[boundary.c for boundary in boundaries])
        given.n_boundaries, given.boundaries = len(boundaries), array
        if force is not None:
            given.force = self._callbacks.wrap(c.dem_force, lambda query, out: self._evaluate(force, query, out))
        self._kept += [boundaries, array, given]
        return given

    def _begin(self, model: Handle, options: c.dem_options, checkpoint: str | os.PathLike[str] | None) -> None:
        out = POINTER(c.dem_simulation)()
        if checkpoint is None:
            self._callbacks.call(library.dem_simulation_create, byref(out), model.pointer, byref(options))
        else:
            saved = make(c.dem_checkpoint, library.dem_checkpoint_read, library.dem_checkpoint_destroy,
                         str(checkpoint).encode())
            self._callbacks.call(library.dem_simulation_resume, byref(out), model.pointer, byref(options),
                                 saved.pointer)
        self._handle = Handle(out, library.dem_simulation_destroy, model)

    @staticmethod
    def _evaluate(force: Force, query: Any, out: Any) -> None:
        q = query.contents
        nodes = np.ctypeslib.as_array(q.nodes, (q.n,))
        x, v = np.ctypeslib.as_array(q.x, (q.n, 2)), np.ctypeslib.as_array(q.v, (q.n, 2))
        np.ctypeslib.as_array(out, (q.n, 2))[...] = force(q.t, nodes, x, v)

    # ---- ends ----

    def close(self) -> None:
        """Ends it, but for the memory of views that are still there."""
        self._handle = None
        self._kept.clear()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def _open(self) -> Handle:
        if self._handle is None:
            raise ValueError("the simulation is closed")
        return self._handle

    @property
    def _c(self) -> Any:
        return self._open.pointer

    # ---- the time loop ----

    def advance(self, t_end: float, progress: bool = False) -> bool:
        """Integrates to t_end, s. An interrupt (Ctrl-C) ends it between two steps; another advance goes on from there.
        progress: shows a bar, by tqdm where that is installed
        Returns whether it came there: False if an observer has returned dem.STOP."""
        with Progress(progress, self.t, t_end) as bar:
            length = 16.0 * self.options.max_step
            while True:
                target = t_end if not self.t + length < t_end else self.t + length
                start = time.monotonic()
                stopped = self._callbacks.call(library.dem_simulation_advance, self._c, target) == STOP
                spent = max(time.monotonic() - start, 1e-6)
                bar.show(self.t)
                if stopped or target == t_end:
                    return not stopped
                length *= min(max(SLICE / spent, 0.2), 5.0)

    def set_motion(self, x: ArrayLike | None = None, v: ArrayLike | None = None) -> None:
        """Puts nodes elsewhere, m, or gives them other velocities, m/s: [n_nodes][2]"""
        n = self.lattice.n_nodes
        arrays = [None if values is None else numbers(values, (n, 2)) for values in (x, v)]
        self._callbacks.call(library.dem_simulation_set_motion, self._c, *map(pointer, arrays))

    def break_elements(self, triangles: ArrayLike = (), springs: ArrayLike = ()) -> None:
        """Breaks triangles, and springs that no triangle holds, by their numbers."""
        t, s = numbers(triangles, (None,), np.int64), numbers(springs, (None,), np.int64)
        self._callbacks.call(library.dem_simulation_break, self._c, pointer(t, c_int64), len(t), pointer(s, c_int64),
                             len(s))

    def observe(self, frame: Callable[[Simulation], int | None] | None = None,
                step: Callable[[Simulation], int | None] | None = None,
                event: Callable[[Simulation, records.Event], int | None] | None = None,
                broken: Callable[[Simulation, records.Break], int | None] | None = None, interval: float = 0.0,
                step_every: int = 0, step_interval: float = 0.0, step_touching: bool = False) -> None:
        """Calls frame(simulation) every `interval` seconds of the motion, step(simulation) after every step,
        event(simulation, event) at every change of a contact, and broken(simulation, what) at every break. Each may
        return dem.STOP. Before the first advance.
        step_every: step() only after steps whose number is a multiple of this, and at t = 0; step_interval (s): and
        after the first step in each such span of time; step_touching: and after every step in which something
        touches"""
        observer, wrap = c.dem_observer(interval=interval, step_every=step_every, step_interval=step_interval,
                                        step_touching=step_touching), self._callbacks.wrap
        if frame is not None:
            observer.frame = wrap(c.dem_observer_frame, lambda _: frame(self))
        if step is not None:
            observer.step = wrap(c.dem_observer_step, lambda _: step(self))
        if event is not None:
            observer.event = wrap(c.dem_observer_event, lambda _, what: event(self, records.Event(what.contents)))
        if broken is not None:
            observer.broken = wrap(c.dem_observer_broken, lambda _, what: broken(self, records.Break(what.contents)))
        check(library.dem_simulation_observe(self._c, byref(observer)))
        self._kept.append(observer)

    def record(self, path: str | os.PathLike[str], frame_interval: float, *, fields: Iterable[str] | int | None = None,
               **options: Unpack[records.TrajectoryKeywords]) -> Recording:
        """Writes the run to a file NAME.vtkhdf with a frame every frame_interval seconds of the motion: a context that
        finishes the file, or call finish(). Options are those of dem_trajectory_options; fields is a list of names."""
        recording = Recording(self._open, path, frame_interval, fields, options)
        self._kept.append(recording)
        return recording

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the last checkpoint, of an accepted step before now, from which Simulation(..., checkpoint=path) goes
        on to the same bits."""
        saved = library.dem_simulation_checkpoint(self._c)
        if not saved:
            raise ValueError("there is no checkpoint yet")
        check(library.dem_checkpoint_write(saved, str(path).encode()))

    # ---- what is seen ----

    def _state(self) -> c.dem_state:
        state = c.dem_state()
        check(library.dem_simulation_state(self._c, byref(state)))
        return state

    @property
    def t(self) -> float:
        """s"""
        return float(self._state().t)

    @property
    def x(self) -> Floats:
        """[n_nodes][2] m, a view."""
        x: Floats = view(self._state().x, (self.lattice.n_nodes, 2), self._handle)
        return x

    @property
    def v(self) -> Floats:
        """[n_nodes][2] m/s, a view."""
        v: Floats = view(self._state().v, (self.lattice.n_nodes, 2), self._handle)
        return v

    @property
    def lattice(self) -> Lattice:
        """As the simulation has it: its arrays are views that cannot be written to."""
        return Lattice.borrowed(library.dem_model_lattice(library.dem_simulation_model(self._c)), self._handle)

    @property
    def options(self) -> records.Options:
        """Those in force, with all defaults."""
        return ask(library.dem_simulation_options, records.Options, self._c)

    @property
    def sizes(self) -> records.ModelSize:
        return ask(library.dem_model_sizes, records.ModelSize, library.dem_simulation_model(self._c))

    @property
    def energy(self) -> records.Energy:
        """J: kinetic, elastic, ..., and the ledger."""
        return ask(library.dem_simulation_energy, records.Energy, self._c)

    @property
    def strain(self) -> records.Strain:
        """Extremes over the springs and triangles."""
        return ask(library.dem_simulation_strain, records.Strain, self._c)

    @property
    def overlap(self) -> records.Overlap:
        return ask(library.dem_simulation_overlap, records.Overlap, self._c)

    @property
    def surfaces(self) -> records.Surfaces:
        """Contact of bodies with each other."""
        return ask(library.dem_simulation_surfaces, records.Surfaces, self._c)

    @property
    def fracture(self) -> records.Fracture:
        return ask(library.dem_simulation_fracture, records.Fracture, self._c)

    @property
    def counts(self) -> records.Counts:
        return ask(library.dem_simulation_counts, records.Counts, self._c)

    @property
    def residual(self) -> float:
        """How far from equilibrium."""
        return float(library.dem_simulation_residual(self._c))

    @property
    def contacts(self) -> list[records.Contact]:
        """The lasting contacts with obstacles."""
        return [ask(library.dem_simulation_contact, records.Contact, self._c, k)
                for k in range(self._state().n_contacts)]

    @property
    def pairs(self) -> list[records.Pair]:
        """Nodes and edges of bodies that push each other."""
        return [ask(library.dem_simulation_pair, records.Pair, self._c, k) for k in range(self.surfaces.pushing)]

    def body(self, number: int = 0) -> records.BodyMotion:
        """Mean motion of a body."""
        return ask(library.dem_simulation_body, records.BodyMotion, self._c, number)

    def inertia(self, number: int = 0) -> float:
        """Moment of inertia of a body about its centre of mass, kg m^2."""
        value = c_double()
        check(library.dem_simulation_inertia(self._c, number, byref(value)))
        return value.value

    def obstacle(self, number: int = 0) -> records.ObstacleLoad:
        """What an obstacle gives to the bodies, and where it is."""
        return ask(library.dem_simulation_obstacle, records.ObstacleLoad, self._c, number)

    def boundary(self, number: int = 0) -> records.BoundaryLoad:
        """What a boundary does to its nodes."""
        return ask(library.dem_simulation_boundary, records.BoundaryLoad, self._c, number)

    def constants(self, body: int = 0) -> records.Constants:
        """Elastic constants of a body, measured."""
        return ask(library.dem_model_constants, records.Constants, library.dem_simulation_model(self._c), body)

    def _array(self, function: Callable[..., int], shape: tuple[int, ...]) -> Floats:
        out = np.empty(shape)
        check(function(self._c, pointer(out)))
        return out

    def stress(self) -> Floats:
        """Of the nodes, [n_nodes][3] Pa: xx, yy, xy."""
        return self._array(library.dem_simulation_stress, (self.lattice.n_nodes, 3))

    def strains(self) -> Floats:
        """Of the springs, [n_springs]."""
        return self._array(library.dem_simulation_strains, (self.lattice.n_springs,))

    def forces(self) -> Floats:
        """Along the springs, [n_springs] N, > 0 in tension."""
        return self._array(library.dem_simulation_forces, (self.lattice.n_springs,))

    def contact_forces(self) -> Floats:
        """By contact of bodies with each other, [n_nodes][2] N."""
        return self._array(library.dem_simulation_contact_forces, (self.lattice.n_nodes, 2))

    def broken(self) -> Bools:
        """Which triangles are broken, [n_triangles] bool."""
        out = np.empty(self.lattice.n_triangles, np.uint8)
        check(library.dem_simulation_broken(self._c, pointer(out, c_ubyte), None))
        return out.astype(bool)

    def damage(self) -> Floats:
        """What is gone of the triangles in tension, [n_triangles], 0 to 1."""
        out = np.empty(self.lattice.n_triangles)
        check(library.dem_simulation_damage(self._c, pointer(out), None))
        return out

    def fragments(self) -> Integers:
        """The fragment of each node, [n_nodes], by its lowest node."""
        n, out = c_int64(), np.empty(self.lattice.n_nodes, np.int64)
        check(library.dem_simulation_fragments(self._c, byref(n), pointer(out, c_int64)))
        return out


def von_mises(stress: ArrayLike) -> Any:
    """Von Mises' equivalent of stresses [..., 3] (xx, yy, xy), of the same unit."""
    xx, yy, xy = np.moveaxis(np.asarray(stress, float), -1, 0)
    return np.sqrt(xx * xx - xx * yy + yy * yy + 3.0 * xy * xy)

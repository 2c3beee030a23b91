# SPDX-License-Identifier: BSD-3-Clause
"""A run read back from its file."""
from __future__ import annotations

import os
from ctypes import byref, c_int64, c_ubyte
from typing import TYPE_CHECKING, Any

import numpy as np

from . import c_interface as c
from .lattice import Lattice
from .library import Bools, Floats, check, library, make, numbers, pointer, view
from .picture import box_of, draw, limits_of
from .records import ObstacleLaws

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from pandas import DataFrame


class Run:
    """A finished run, or the part of one that goes on: frames and tables, as docs/output.md lists them. What dem.run()
    has returned has the results of NAME.json as `result`, and what was printed as `log`."""
    result: dict[str, Any] | Any = None  # Any: None where the file was there already
    log: str | Any = None

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = str(path)
        self._handle = make(c.dem_reader, library.dem_reader_open, library.dem_reader_close, self.path.encode())
        self._c = self._handle.pointer
        n = c_int64()
        arrays = library.dem_reader_arrays(self._c, byref(n))
        self._arrays: dict[str, Any] = {arrays[k].name.decode(): arrays[k] for k in range(n.value)}
        columns = library.dem_reader_columns(self._c, byref(n))
        self._tables: dict[str, dict[str, Any]] = {}
        for k in range(n.value):
            self._tables.setdefault(columns[k].table.decode(), {})[columns[k].name.decode()] = columns[k]

    def __repr__(self) -> str:
        return f"Run('{self.path}', {len(self.times)} frames)"

    @property
    def times(self) -> Floats:
        """Of the frames, s; a view."""
        n = c_int64()
        times = library.dem_reader_times(self._c, byref(n))
        found: Floats = view(times, (n.value,), self._handle)
        return found

    @property
    def lattice(self) -> Lattice:
        """At rest; its arrays are views."""
        return Lattice.borrowed(library.dem_reader_lattice(self._c), self._handle)

    @property
    def arrays(self) -> list[str]:
        """Names of what frames show."""
        return list(self._arrays)

    @property
    def tables(self) -> dict[str, list[str]]:
        """Names of the tables, and of their columns."""
        return {name: list(columns) for name, columns in self._tables.items()}

    def _frame(self, frame: int) -> int:
        n = len(self.times)
        if not -n <= frame < n:
            raise IndexError(f"frame {frame} of {n}")
        return frame % n

    def positions(self, frame: int) -> Floats:
        """[n_nodes][2] m. Frames count from 0, or from -1 backwards."""
        x = np.empty((self.lattice.n_nodes, 2))
        check(library.dem_reader_positions(self._c, self._frame(frame), pointer(x)))
        return x

    def array(self, name: str, frame: int = -1) -> Floats:
        """What a frame shows of nodes or springs, [n] or [n][components]; tensors are xx yy zz xy yz xz."""
        array, lattice = self._arrays[name], self.lattice
        n = lattice.n_springs if array.of_springs else lattice.n_nodes
        values = np.empty((n, array.components))
        check(library.dem_reader_read(self._c, byref(array), self._frame(frame), pointer(values)))
        return values[:, 0] if array.components == 1 else values

    def broken_triangles(self, frame: int = -1) -> Bools:
        """[n_triangles] bool"""
        out = np.empty(self.lattice.n_triangles, np.uint8)
        check(library.dem_reader_broken_triangles(self._c, self._frame(frame), pointer(out, c_ubyte)))
        return out.astype(bool)

    def table(self, name: str) -> dict[str, Floats]:
        """Its columns by name: [rows], or [rows][items][components] without those that are one."""
        columns = {}
        for column, what in self._tables[name].items():
            values = np.empty((what.n_rows, what.items, what.components))
            check(library.dem_reader_read_column(self._c, byref(what), pointer(values)))
            keep = tuple(k for k, n in ((1, what.items), (2, what.components)) if n == 1)
            columns[column] = values.squeeze(keep) if keep else values
        return columns

    @property
    def history(self) -> dict[str, Floats]:
        """The table of all steps."""
        return self.table("history")

    @property
    def events(self) -> dict[str, Floats]:
        """The table of contact events."""
        return self.table("events")

    def pandas(self, name: str) -> DataFrame:
        """A table as a DataFrame of pandas; of vectors each component is a column, 'velocity.0', ..."""
        import pandas  # only who asks for it needs it
        flat = {}
        for column, values in self.table(name).items():
            if values.ndim == 1:
                flat[column] = values
            else:
                for index in np.ndindex(values.shape[1:]):
                    flat[".".join([column, *map(str, index)])] = values[(slice(None), *index)]
        return pandas.DataFrame(flat)

    @property
    def n_obstacles(self) -> int:
        return int(library.dem_reader_n_obstacles(self._c))

    def obstacle(self, number: int = 0) -> ObstacleLaws:
        """As it was given: its laws and how it moves, by the names of dem_obstacle."""
        return ObstacleLaws(self._obstacle(number))

    def obstacle_points(self, number: int, t: float) -> Floats:
        """Where an obstacle is at t, [n_points][2] m."""
        obstacle = self._obstacle(number)
        points = np.empty((obstacle.n_points, 2))
        check(library.dem_obstacle_points(byref(obstacle), t, pointer(points)))
        return points

    def _obstacle(self, number: int) -> c.dem_obstacle:
        obstacle = library.dem_reader_obstacle(self._c, number)
        if not obstacle:
            raise IndexError(f"obstacle {number} of {self.n_obstacles}")
        contents: c.dem_obstacle = obstacle.contents
        return contents

    # ---- pictures, by matplotlib ----

    def plot(self, frame: int = -1, colour: str = "von_mises", ax: Axes | None = None) -> Axes:
        """Draws a frame as dem_plot does: triangles that are whole, coloured by an array of the nodes, and obstacles.
        Returns the axes, which have a scale of the colours unless they were given."""
        from matplotlib import pyplot  # only who draws needs it
        given, number = ax, self._frame(frame)
        ax = pyplot.figure().add_subplot() if given is None else given
        drawn = self._draw(ax, number, colour, limits_of(self._numbers(colour, number)))
        self._look(ax, box_of(self.positions(number)))
        if given is None:
            ax.figure.colorbar(drawn, ax=ax, label=colour)
        return ax

    def _numbers(self, colour: str, frame: int) -> Floats:
        values = self.array(colour, frame)
        if values.ndim != 1 or len(values) != self.lattice.n_nodes:
            raise ValueError(f"'{colour}' is no number of nodes")
        return values

    def _draw(self, ax: Axes, frame: int, colour: str, limits: tuple[float, float]) -> Any:
        whole = np.empty((0, 3), np.int64)
        if self.lattice.n_triangles > 0:
            whole = numbers(self.lattice.triangles, dtype=np.int64)[~self.broken_triangles(frame)]
        obstacles = [self.obstacle_points(number, self.times[frame]) for number in range(self.n_obstacles)]
        ax.set_title(f"{self.times[frame]:.4g} s, {colour}")
        return draw(ax, self.positions(frame), whole, self._numbers(colour, frame), limits, obstacles)

    @staticmethod
    def _look(ax: Axes, box: tuple[Floats, Floats]) -> None:
        ax.set_xlim(box[0][0], box[1][0])
        ax.set_ylim(box[0][1], box[1][1])

    def animate(self, path: str | os.PathLike[str] | None = None, colour: str = "von_mises",
                fps: int = 15) -> FuncAnimation:
        """A film of all frames, a FuncAnimation, which is saved to a file by its name."""
        from matplotlib import animation, pyplot
        figure = pyplot.figure()
        ax = figure.add_subplot()
        frames = range(len(self.times))
        box = box_of(np.concatenate([self.positions(frame) for frame in frames]))
        limits = limits_of(np.concatenate([self._numbers(colour, frame) for frame in frames]))
        figure.colorbar(self._draw(ax, 0, colour, limits), ax=ax, label=colour)

        def show(frame: int) -> None:
            ax.clear()
            self._draw(ax, frame, colour, limits)
            self._look(ax, box)

        film = animation.FuncAnimation(figure, show, frames=len(self.times), interval=1000.0 / fps)
        if path is not None:
            film.save(str(path), fps=fps)
        return film


def read(path: str | os.PathLike[str]) -> Run:
    """Opens NAME.vtkhdf."""
    return Run(path)

# SPDX-License-Identifier: BSD-3-Clause
"""Rigid polylines on which bodies fall."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Unpack

import numpy as np
from numpy.typing import ArrayLike

from . import c_interface as c
from .library import fill, numbers, pointer
from .records import ObstacleKeywords

ENUMERATIONS = {"friction_law": (c.dem_friction_law, "DEM_FRICTION_")}


class Obstacle:
    """A polyline through points [n][2], m, closed if the last one is the first: bodies live on the left of each
    segment. restitution, friction, friction_law ('coulomb', 'paper'), and how it moves: velocity (m/s), amplitude (m)
    with frequency (Hz) and phase (degrees), spin (rad/s) about pivot (m), ramp (s).

    motion(t, pose) gives any other motion: it sets the fields of a dem_pose, which are 0 at entry, and depends on t
    alone; most_speed (m/s) and most_acceleration (m/s^2) are bounds of it."""

    def __init__(self, points: ArrayLike, motion: Callable[[float, c.dem_pose], object] | None = None,
                 **values: Unpack[ObstacleKeywords]) -> None:
        self.points = numbers(points, (None, 2))
        self.motion = motion
        given: dict[str, Any] = dict(values)
        for name in given.keys() & {"velocity", "amplitude", "pivot"}:
            given[name] = (*given[name], 0.0)[:3]
        self.c = fill(c.dem_obstacle(n_points=len(self.points), points=pointer(self.points)), given, ENUMERATIONS)

    def __getattr__(self, name: str) -> Any:
        value = getattr(self.__dict__["c"], name)
        return np.array(value) if hasattr(value, "_length_") else value


def box(left: float, low: float, right: float, high: float, **values: Unpack[ObstacleKeywords]) -> Obstacle:
    """A closed box that bodies cannot leave, m."""
    return Obstacle([(left, low), (right, low), (right, high), (left, high), (left, low)], **values)


def compile_all(obstacles: Sequence[Obstacle],
                wrap: Callable[[Any, Callable[..., object]], Any]) -> tuple[Any, list[Any]]:
    """The obstacles as C takes them, with their functions as callbacks, which wrap() makes.
    Returns the array and what has to live as long as it is used."""
    array = (c.dem_obstacle * max(len(obstacles), 1))()
    kept: list[Any] = list(obstacles)
    for k, obstacle in enumerate(obstacles):
        array[k] = obstacle.c
        if obstacle.motion is not None:
            callback = wrap(c.dem_motion, obstacle.motion)
            array[k].motion = callback
            kept.append(callback)
    return array, kept

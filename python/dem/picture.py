# SPDX-License-Identifier: BSD-3-Clause
"""Frames as dem_plot draws them, by matplotlib: its colours, and obstacles filled on the side of the solid."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .library import Floats, Integers

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import ListedColormap

# CIE L*, a*, b*, as drivers/plot/palette.c has them
DIVERGING = (30, 8, -46), (42, 0, -45), (58, -7, -34), (78, 0, 0), (58, 36, 42), (42, 53, 46), (30, 45, 36)
SEQUENTIAL = (88, -6, 40), (77, 12, 50), (65, 32, 41), (53, 46, 20), (41, 45, -12), (30, 34, -30), (18, 20, -33)
GROUND = "#434345"


def palette(stops: tuple[tuple[int, int, int], ...]) -> ListedColormap:
    """Colours between the stops, in sRGB under the white of day."""
    from matplotlib.colors import ListedColormap
    places = np.linspace(0.0, len(stops) - 1.0, 256)
    light, a, b = (np.interp(places, range(len(stops)), row) for row in np.transpose(stops))
    bent = (light + 16.0) / 116.0 + np.array([a / 500.0, 0.0 * a, -b / 200.0])
    knee = 6.0 / 29.0
    of_white = np.where(bent > knee, bent**3, 3.0 * knee * knee * (bent - 4.0 / 29.0))
    linear = np.array([[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560],
                       [0.0556434, -0.2040259, 1.0572252]]) @ (np.array([[0.95047], [1.0], [1.08883]]) * of_white)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 0.0)**(1.0 / 2.4) - 0.055)
    return ListedColormap(np.clip(encoded, 0.0, 1.0).T)


def limits_of(values: Floats) -> tuple[float, float]:
    """From 0, or of what has both signs as far to either side."""
    most = float(np.max(np.abs(values), initial=0.0))
    return (-most if np.min(values, initial=0.0) < 0.0 else 0.0), most or 1.0


def box_of(x: Floats) -> tuple[Floats, Floats]:
    """The left lower and the right upper corner of what is seen of nodes at x."""
    low, high = x.min(axis=0), x.max(axis=0)
    margin = 0.1 * (high - low).max()
    return low - margin, high + margin


def _ground(points: Floats, size: float) -> Floats:
    """The outline of the solid on the right of a polyline: points, and an arc far away where it is open; of a box that
    bodies are in, what is outside."""
    x, y = points.T
    if np.array_equal(points[0], points[-1]):
        if np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]) < 0.0:
            return points
        around = points.mean(axis=0) + size * np.array([(-1, -1), (-1, 1), (1, 1), (1, -1), (-1, -1)])
        return np.concatenate([points, around, points[:1]])
    out, back = points[-1] - points[-2], points[0] - points[1]
    start, end = np.arctan2(out[1], out[0]), np.arctan2(back[1], back[0])
    angles = start - np.linspace(0.0, (start - end) % (2.0 * np.pi), 33)
    return np.concatenate([points, points.mean(axis=0) + size * np.transpose([np.cos(angles), np.sin(angles)])])


def draw(ax: Axes, x: Floats, triangles: Integers, values: Floats, limits: tuple[float, float],
         obstacles: list[Floats]) -> Any:
    """Triangles [n][3] coloured by values of the nodes at x [n_nodes][2], or without any the nodes; and obstacles."""
    for points in obstacles:
        size = 100.0 * float(np.max(np.abs(np.concatenate([x, points]))))
        ax.fill(*_ground(points, size).T, color=GROUND, linewidth=0)
    how: dict[str, Any] = {"cmap": palette(DIVERGING if limits[0] < 0.0 else SEQUENTIAL), "vmin": limits[0],
                           "vmax": limits[1]}
    if len(triangles) > 0:
        drawn: Any = ax.tripcolor(x[:, 0], x[:, 1], values, triangles=triangles, shading="gouraud", **how)
    else:
        drawn = ax.scatter(x[:, 0], x[:, 1], c=values, s=4, **how)
    ax.set_aspect("equal")
    return drawn

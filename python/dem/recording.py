# SPDX-License-Identifier: BSD-3-Clause
"""A run that is written to a file while it goes on."""
from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from ctypes import byref
from typing import Any

from . import c_interface as c
from .library import Handle, check, fill, library, make


def _fields(names: Iterable[str]) -> int:
    """The bits of names such as 'velocity', 'von_mises'."""
    return sum({getattr(c, f"DEM_FIELD_{name.upper()}") for name in names})


class Recording:
    """An observer that writes NAME.vtkhdf, which is NAME.part.vtkhdf until finish(). A context calls that at its end,
    unless something was raised: then the part stays as of its last frame."""

    def __init__(self, simulation: Handle, path: str | os.PathLike[str], frame_interval: float,
                 fields: Iterable[str] | int | None, values: Mapping[str, Any]) -> None:
        options = c.dem_trajectory_options_default()
        if fields is not None:
            options.fields = fields if isinstance(fields, int) else _fields(fields)
        fill(options, {**values, "frame_interval": frame_interval}, {})
        self.path = str(path)
        self._handle = make(c.dem_trajectory, library.dem_trajectory_create, library.dem_trajectory_destroy,
                            self.path.encode(), simulation.pointer, byref(options), needs=(simulation,))
        observer = c.dem_observer()
        check(library.dem_trajectory_observer(self._handle.pointer, byref(observer)))
        check(library.dem_simulation_observe(simulation.pointer, byref(observer)))

    def note(self, name: str, text: str) -> None:
        """Stores a string in /provenance."""
        check(library.dem_trajectory_note(self._handle.pointer, name.encode(), text.encode()))

    def finish(self) -> None:
        """Gives the file its name."""
        check(library.dem_trajectory_finish(self._handle.pointer))

    def __enter__(self) -> Recording:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is None:
            self.finish()

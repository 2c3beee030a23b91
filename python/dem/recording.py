# SPDX-License-Identifier: BSD-3-Clause
"""A run that is written to a file while it goes on."""
from ctypes import byref

from . import c_interface as c
from .library import check, fill, library, make


def _fields(names):
    """The bits of names such as 'velocity', 'von_mises'."""
    return sum({getattr(c, f"DEM_FIELD_{name.upper()}") for name in names})


class Recording:
    """An observer that writes NAME.vtkhdf, which is NAME.part.vtkhdf until finish(). A context calls that at its end,
    unless something was raised: then the part stays as of its last frame."""

    def __init__(self, simulation, path, frame_interval, values):
        options = c.dem_trajectory_options_default()
        if not isinstance(values.get("fields", 0), int):
            values = values | {"fields": _fields(values["fields"])}
        fill(options, values | {"frame_interval": frame_interval}, {})
        self.path = str(path)
        self._handle = make(c.dem_trajectory, library.dem_trajectory_create, library.dem_trajectory_destroy,
                            self.path.encode(), simulation.pointer, byref(options), needs=(simulation,))
        observer = c.dem_observer()
        check(library.dem_trajectory_observer(self._handle.pointer, byref(observer)))
        check(library.dem_simulation_observe(simulation.pointer, byref(observer)))

    def note(self, name, text):
        """Stores a string in /provenance."""
        check(library.dem_trajectory_note(self._handle.pointer, name.encode(), text.encode()))

    def finish(self):
        """Gives the file its name."""
        check(library.dem_trajectory_finish(self._handle.pointer))

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        if kind is None:
            self.finish()

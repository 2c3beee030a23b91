# SPDX-License-Identifier: BSD-3-Clause
"""Functions of Python that the library calls. An exception must not pass through C: it ends the call, and is raised
again when that has returned."""
from . import c_interface as c
from .library import check


class Callbacks:
    """Those of one simulation."""

    def __init__(self):
        self.exception = None

    def wrap(self, kind, function):
        """A callback of C that calls function(*arguments without the context), which returns a status or None."""

        def call(_, *arguments):
            try:
                status = function(*arguments)
                return c.dem_status.DEM_OK if status is None else int(status)
            except BaseException as exception:  # an interrupt, too
                self.exception = exception
                return c.dem_status.DEM_ERROR_ARGUMENT

        return kind(call)

    def call(self, function, *arguments):
        """Calls a function of the library, and raises what a callback of it has raised, else what its status means."""
        self.exception = None
        status = function(*arguments)
        if self.exception is not None:
            exception, self.exception = self.exception, None
            raise exception
        return check(status)

# SPDX-License-Identifier: BSD-3-Clause
"""Functions of Python that the library calls. An exception must not pass through C: it ends the call, and is raised
again when that has returned."""
import signal
import threading

from . import c_interface as c
from .library import check


class Interrupts:
    """Ctrl-C during one call of the library, which calls functions of Python. The interpreter would raise it where the
    first of them begins, before anything can catch it, and it would be lost. So it is noted there, and what was to
    handle it is called once that can be caught, or when the call has returned. Only the main thread sees signals."""

    def __init__(self):
        self._handler, self._noted, self._caught = None, False, False

    def __enter__(self):
        handler = signal.getsignal(signal.SIGINT)
        if threading.current_thread() is threading.main_thread() and callable(handler):
            self._handler = handler
            signal.signal(signal.SIGINT, self._note)
        return self

    def __exit__(self, *_):
        if self._handler is not None:
            signal.signal(signal.SIGINT, self._handler)
            self._handle()

    def _note(self, *_):
        self._noted = True
        if self._caught:
            self._handle()

    def _handle(self):
        noted, self._noted = self._noted, False
        if noted:
            self._handler(signal.SIGINT, None)

    def run(self, function, *arguments):
        """A function of Python, where what it raises is caught."""
        self._caught = True
        try:
            self._handle()
            return function(*arguments)
        finally:
            self._caught = False


class Callbacks:
    """Those of one simulation."""

    def __init__(self):
        self.exception = None
        self._interrupts = None  # of the call that goes on; a query has none

    def wrap(self, kind, function):
        """A callback of C that calls function(*arguments without the context), which returns a status or None."""

        def call(_, *arguments):
            try:
                interrupts = self._interrupts
                status = function(*arguments) if interrupts is None else interrupts.run(function, *arguments)
                return c.dem_status.DEM_OK if status is None else int(status)
            except BaseException as exception:  # an interrupt, too
                self.exception = exception
                return c.dem_status.DEM_ERROR_ARGUMENT

        return kind(call)

    def call(self, function, *arguments):
        """Calls a function of the library, and raises what a callback of it has raised, else what its status means."""
        self.exception = None
        outer = self._interrupts
        with Interrupts() as self._interrupts:
            try:
                status = function(*arguments)
            finally:
                self._interrupts = outer
        if self.exception is not None:
            exception, self.exception = self.exception, None
            raise exception
        return check(status)

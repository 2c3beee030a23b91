# SPDX-License-Identifier: BSD-3-Clause
"""Functions of Python that the library calls. An exception must not pass through C: it ends the call, and is raised
again when that has returned."""
from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from types import FrameType
from typing import Any

from . import c_interface as c
from .library import check


class Interrupts:
    """Ctrl-C during one call of the library, which calls functions of Python. The interpreter would raise it where the
    first of them begins, before anything can catch it, and it would be lost. So it is noted there, and what was to
    handle it is called once that can be caught, or when the call has returned. Only the main thread sees signals."""

    def __init__(self) -> None:
        self._handler: Callable[[int, FrameType | None], Any] | None = None
        self._noted, self._caught = False, False

    def __enter__(self) -> Interrupts:
        handler = signal.getsignal(signal.SIGINT)
        if threading.current_thread() is threading.main_thread() and callable(handler):
            self._handler = handler
            signal.signal(signal.SIGINT, self._note)
        return self

    def __exit__(self, *_: object) -> None:
        if self._handler is not None:
            signal.signal(signal.SIGINT, self._handler)
            self._handle()

    def _note(self, *_: object) -> None:
        self._noted = True
        if self._caught:
            self._handle()

    def _handle(self) -> None:
        noted, self._noted = self._noted, False
        if noted and self._handler is not None:
            self._handler(signal.SIGINT, None)

    def run(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """A function of Python, where what it raises is caught."""
        self._caught = True
        try:
            self._handle()
            return function(*arguments)
        finally:
            self._caught = False


class Callbacks:
    """Those of one simulation."""

    def __init__(self) -> None:
        self.exception: BaseException | None = None
        self._interrupts: Interrupts | None = None  # of the call that goes on; a query has none

    def wrap(self, kind: Any, function: Callable[..., Any]) -> Any:
        """A callback of C that calls function(*arguments without the context), which returns a status or None."""

        def call(_: Any, *arguments: Any) -> int:
            try:
                interrupts = self._interrupts
                status = function(*arguments) if interrupts is None else interrupts.run(function, *arguments)
                return c.dem_status.DEM_OK if status is None else int(status)
            except BaseException as exception:  # an interrupt, too
                self.exception = exception
                return c.dem_status.DEM_ERROR_ARGUMENT

        return kind(call)

    def call(self, function: Callable[..., int], *arguments: Any) -> int:
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

# SPDX-License-Identifier: BSD-3-Clause
"""What dem_batch does: as a function in a thread of this process, or as a program in one of its own."""
from __future__ import annotations

import ctypes
import functools
import os
import pathlib
import shutil
import signal
import subprocess
import threading
from collections.abc import Callable, Iterable
from ctypes import POINTER, c_char_p, c_double, c_int, c_void_p
from typing import Any

from .progress import Progress

NAME = "libdem_batch.so"
LOOK = 0.1  # s on the wall, from one look at what is done to the next


class Requests(ctypes.Structure):
    """What is asked of a run while it goes on, as drivers/batch/requests.h has it."""
    _fields_ = [("end", c_int), ("checkpoint", c_int)]


def find(name: str) -> str | None:
    """A file of this name beside the program that DEM_BATCH names, else beside this file; None where there is none."""
    named = os.environ.get("DEM_BATCH")
    for neighbour in ([named] if named else []) + [__file__]:
        beside = pathlib.Path(neighbour).with_name(name)
        if beside.exists():
            return str(beside)
    return None


@functools.cache
def load() -> ctypes.CDLL:
    """The library of the function. It uses the libdem that is loaded already."""
    loaded = ctypes.CDLL(find(NAME) or NAME)
    do, free = loaded.dem_private_batch, loaded.dem_private_batch_free
    do.restype = c_int
    do.argtypes = [c_int, POINTER(c_char_p), POINTER(Requests), POINTER(c_double), POINTER(c_void_p)]
    free.restype, free.argtypes = None, [c_void_p]
    return loaded


class Call:
    """One call of the function, in a thread of its own: signals reach Python in the main thread, which waits."""

    def __init__(self, library: ctypes.CDLL, words: list[str]) -> None:
        if any("\0" in word for word in words):
            raise ValueError("embedded null character")
        self._library = library
        self._words = (c_char_p * (len(words) + 2))(b"dem_batch", *map(os.fsencode, words), None)
        self._requests, self._part, self._printed = Requests(), c_double(), (c_void_p * 2)()
        self._ended = threading.Event()
        self.code, self.texts = -1, ("", "")

    def _work(self) -> None:
        try:
            self.code = self._library.dem_private_batch(len(self._words) - 1, self._words, self._requests, self._part,
                                                        self._printed)
            out, err = (ctypes.string_at(text).decode(errors="replace") if text else "" for text in self._printed)
            self.texts = out, err
            for text in self._printed:
                self._library.dem_private_batch_free(text)
        finally:
            self._ended.set()

    def do(self, show: Callable[[float], None]) -> None:
        """Calls show() with what is done of a run, 0 to 1, meanwhile. What it raises, or an interrupt, asks for the
        end as SIGINT does, and comes out when that is there."""
        threading.Thread(target=self._work, name="dem.run").start()
        raised: BaseException | None = None
        while True:
            try:
                while not self._ended.wait(LOOK):
                    show(self._part.value)
                break
            except BaseException as exception:
                self._requests.end = signal.SIGINT
                show = lambda part: None
                raised = raised or exception
        if raised is not None:
            raise raised


def call(words: Iterable[Any], progress: bool = False) -> tuple[int, str, str]:
    """The function. Returns the exit code, and what went to standard output and to standard error."""
    made = Call(load(), [str(word) for word in words])
    with Progress(progress, 0.0, 1.0, "{percentage:5.1f} % |{bar}| {remaining} left") as bar:
        made.do(bar.show)
        if made.code == 0:
            bar.show(1.0)
    return made.code, *made.texts


def spawn(words: Iterable[Any]) -> tuple[int, str, str]:
    """The same of the program, in a process of its own. An interrupt is passed on to it."""
    program = os.environ.get("DEM_BATCH") or find("dem_batch") or shutil.which("dem_batch")
    if program is None:
        raise FileNotFoundError("dem_batch is neither on the path nor named by DEM_BATCH")
    paths = [str(pathlib.Path(__file__).parent), *filter(None, [os.environ.get("LD_LIBRARY_PATH")])]
    interrupt: KeyboardInterrupt | None = None
    with subprocess.Popen([program, *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          env=os.environ | {"LD_LIBRARY_PATH": ":".join(paths)}) as process:
        while True:
            try:
                out, err = process.communicate()
                break
            except KeyboardInterrupt as caught:
                interrupt = interrupt or caught
                process.send_signal(signal.SIGINT)
    if interrupt is not None:
        raise interrupt
    return process.returncode, out, err

# SPDX-License-Identifier: BSD-3-Clause
"""Decks, the namelist files of dem_batch: written from Python, and run."""
from __future__ import annotations

import json
import os
import pathlib
import re
import tempfile
from collections.abc import Mapping, Sequence
from typing import Any

from . import batch
from .run import Run


class DeckError(Exception):
    """A deck that was refused, or a run that failed: `code` is the exit code of dem_batch, the message what it said to
    standard error, `log` what it said besides. `line` and `column` are where the deck is wrong; None where it is
    another fault."""

    def __init__(self, code: int, message: str, log: str = "") -> None:
        super().__init__(message)
        self.code, self.log = code, log
        place = re.match(r"[^\n]*?:(\d+):(\d+): error: ", message)
        self.line = int(place[1]) if place else None
        self.column = int(place[2]) if place else None


def _checked(code: int, out: str, err: str) -> str:
    if code != 0:
        raise DeckError(code, err.strip() or out.strip(), out)
    return out


def _value(value: Any) -> str:
    """As a namelist has it."""
    if isinstance(value, bool):
        return ".true." if value else ".false."
    if isinstance(value, str):
        return "'" + value.replace("'", "''") + "'"
    if hasattr(value, "__iter__"):
        items = [item for row in value for item in (row if hasattr(row, "__iter__") and not isinstance(row, str)
                                                   else (row,))]
        return ", ".join(map(_value, items))
    return repr(value) if isinstance(value, int) else repr(float(value))


def deck(**groups: Mapping[str, Any] | Sequence[Mapping[str, Any]]) -> str:
    """The text of a deck: groups by their names, each with its keys, or a list of such, as bodies and obstacles are:
    dem.deck(run={"t_end": 0.02}, body=[{...}, {...}], obstacle={"points": [(-1, 0), (1, 0)]}, ...). The program has
    looked at it: raises DeckError with the key that is wrong."""
    lines = []
    for name, given in groups.items():
        for group in [given] if isinstance(given, Mapping) else given:
            keys = [f"    {key} = {_value(value)}\n" for key, value in group.items() if value is not None]
            lines.append(f"&{name}\n{''.join(keys)}/\n")
    text = "\n".join(lines)
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "deck.nml")
        path.write_text(text, encoding="utf-8")
        code, out, err = batch.call(["--echo", path])
        _checked(code, out, err.replace(str(path), path.name))
    return text


def run(path: str | os.PathLike[str], set: Mapping[str, Any] | None = None, outdir: str | os.PathLike[str] = ".",
        overwrite: bool = False, progress: bool = False, process: bool = False) -> Run:
    """Runs a deck, a file, and returns its Run: its `result` is what NAME.json has, its `log` what dem_batch prints.
    A run that is done already is read; one that was stopped goes on. Ctrl-C ends it as it ends dem_batch, with a
    checkpoint, and comes out as KeyboardInterrupt. Of a script that mpirun has started several times each has to have
    an outdir, or a deck, of its own.
    set: keys and their values, {"solver.rtol": 1e-8, "obstacle(2).friction": 0.3}, which take the deck's place
    overwrite: renames the output of another problem that is in the way
    progress: shows a bar, by tqdm
    process: lets the program do it in a process of its own, which keeps memory and faults apart from Python's
    Raises DeckError for a deck that is refused, and for a run that fails."""
    words: list[Any] = ["--json", "--serial", "--outdir", outdir, *(["--overwrite"] if overwrite else []),
             *(word for key, value in (set or {}).items() for word in ("--set", f"{key}={_value(value)}")), path]
    if process and progress:
        raise ValueError("a process of its own shows no progress")
    lines = _checked(*(batch.spawn(words) if process else batch.call(words, progress))).splitlines(keepends=True)
    result = next(line for line in reversed(lines) if line.startswith("{"))
    lines.remove(result)
    done = Run(json.loads(result)["output"])
    done.result, done.log = json.loads(result), "".join(lines)
    return done

# SPDX-License-Identifier: BSD-3-Clause
"""Decks, the namelist files of dem_batch: written from Python, and run by the program in a process of its own, which
keeps its signals, its output and its memory apart from Python's."""
import json
import os
import pathlib
import shutil
import subprocess
import tempfile

from .run import Run


class DeckError(Exception):
    """A deck that was refused, or a run that failed: `code` is the exit code of dem_batch, the message what it said."""

    def __init__(self, code, message):
        super().__init__(message)
        self.code = code


def _program():
    """DEM_BATCH, else beside this file, else on the path."""
    beside = pathlib.Path(__file__).with_name("dem_batch")
    found = os.environ.get("DEM_BATCH") or (str(beside) if beside.exists() else shutil.which("dem_batch"))
    if found is None:
        raise FileNotFoundError("dem_batch is neither on the path nor named by DEM_BATCH")
    return found


def _call(*arguments, **how):
    folder = str(pathlib.Path(__file__).parent)
    paths = [folder, *filter(None, [os.environ.get("LD_LIBRARY_PATH")])]
    done = subprocess.run([_program(), *map(str, arguments)], capture_output=True, text=True, check=False,
                          env=os.environ | {"LD_LIBRARY_PATH": ":".join(paths)}, **how)
    if done.returncode != 0:
        raise DeckError(done.returncode, done.stderr.strip() or done.stdout.strip())
    return done.stdout


def _value(value):
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


def deck(**groups):
    """The text of a deck: groups by their names, each with its keys, or a list of such, as bodies and obstacles are:
    dem.deck(run={"t_end": 0.02}, body=[{...}, {...}], obstacle={"points": [(-1, 0), (1, 0)]}, ...). The program has
    looked at it: raises DeckError with the key that is wrong."""
    lines = []
    for name, given in groups.items():
        for group in given if isinstance(given, (list, tuple)) else [given]:
            keys = [f"    {key} = {_value(value)}\n" for key, value in group.items() if value is not None]
            lines.append(f"&{name}\n{''.join(keys)}/\n")
    text = "\n".join(lines)
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "deck.nml").write_text(text, encoding="utf-8")
        _call("--echo", "deck.nml", cwd=folder)
    return text


def run(path, settings=None, outdir=".", overwrite=False):
    """Runs a deck, a file, and returns its Run, whose `result` is what NAME.json has. A run that is done already is
    read; one that was stopped goes on. Of a script that mpirun has started several times each has to have an outdir, or
    a deck, of its own.
    settings: keys and their values, {"solver.rtol": 1e-8, "obstacle(2).friction": 0.3}, which take the deck's place
    overwrite: renames the output of another problem that is in the way
    Raises DeckError for a deck that is refused, and for a run that fails."""
    words = [word for key, value in (settings or {}).items() for word in ("--set", f"{key}={_value(value)}")]
    out = _call("--json", "--serial", "--outdir", outdir, *(["--overwrite"] if overwrite else []), *words, path)
    result = json.loads(next(line for line in reversed(out.splitlines()) if line.startswith("{")))
    done = Run(result["output"])
    done.result = result
    return done

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the commands of docs/gallery.md and puts its pictures into docs/figures: `gallery.py DEM_BATCH DEM_PLOT`.

With `--short` a run takes a 200th of its time, with as many frames, and the pictures stay as they are; they are looked
at: eight, each small enough for a repository and shown on the page."""
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

PROGRAMS = {path.name: path for path in (pathlib.Path(word).resolve() for word in sys.argv[1:3])}
SHORT = sys.argv[3:] == ["--short"]
DOCS = pathlib.Path(__file__).resolve().parent.parent
MAX_BYTES, SHARE = 150_000, 200


def call(folder, words):
    done = subprocess.run([PROGRAMS[words[0]], *words[1:]], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{shlex.join(words)}: exit code {done.returncode}\n{done.stderr}")
    return done.stdout


def shortened(folder, words):
    """The command for a share of the time; a quasi-static run ends by itself."""
    echo = call(folder, [words[0], "--echo", *words[1:]])
    given = dict(re.findall(r"(?m)^ *(residual|t_end|frame_interval) = (\S+)", echo))
    if "residual" in given:
        return words
    for group, key in (("run", "t_end"), ("output", "frame_interval")):
        words = [*words, "--set", f"{group}.{key}={float(given[key]) / SHARE!r}"]
    return words


def check_pictures(page, names):
    for name in names:
        picture = DOCS / "figures" / name
        if f"(figures/{name})" not in page:
            sys.exit(f"the page does not show {name}")
        if not 0 < picture.stat().st_size < MAX_BYTES:
            sys.exit(f"{name} has {picture.stat().st_size} bytes")
    if len(names) != 8:
        sys.exit(f"there are {len(names)} pictures")


page = (DOCS / "gallery.md").read_text(encoding="utf-8")
made = []
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    (folder / "inputs").symlink_to(DOCS.parent / "inputs")
    for block in re.findall(r"(?ms)^```sh\n(.*?)^```$", page):
        for words in map(shlex.split, block.splitlines()):
            call(folder, shortened(folder, words) if SHORT and words[0] == "dem_batch" else words)
            if words[0] == "dem_plot":
                made.append(words[words.index("-o") + 1])
                print(made[-1], flush=True)
    if not SHORT:
        for picture in made:
            shutil.copy(folder / picture, DOCS / "figures" / picture)
check_pictures(page, made)

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Every command that a page shows works: `test_commands.py PAGE SOURCE_ROOT PROGRAM...`.

A page of Markdown has its commands in blocks, ```sh and ```python, which are run in their order in one folder; a man
page has them under EXAMPLES. The folder has what the pages take for given: decks that are run in no time, lists of
decks, a parameter file, and the variables of a batch system. The paper's bodies are coarse there, so that they take no
time either, but for README's. A block that needs a program or package which this machine lacks is left out; build
scripts are too. A block ```text has lines that the block before it prints, in their order; '...' stands for the rest of
a line. Blocks without a language are looked at for lines of a log, which one of the page's commands prints, and for
parts of decks, which stand in inputs/. The deck that a man page shows is run."""
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

PAGE, ROOT, *PROGRAMS = (pathlib.Path(word).resolve() for word in sys.argv[1:])
SECONDS = 300  # more than any block takes, under a sanitizer too
OPTIONAL = ("gmsh", "jq", "ffmpeg", "dem_plot", "mpirun")  # what a machine may lack
COARSE = {} if PAGE.name == "README.md" else {"rectangle": "1e-2", "disc": "1e-2", "porous": "7e-3",
                                              "brittle_disc": "5e-3"}  # spacings
LOG = r"(?m)^(?:contact|rebound|normal)  .*$"  # lines of a log

DROP = """&run t_end = 1e-4 /
&material youngs_modulus = 1e7, density = 1000 /
&body shape = 'disc', radius = 0.02, spacing = 1e-2, velocity = 0, -5, clearance = 1e-4 /
&obstacle points = -1, 0, 1, 0 /
&output name = '{}' /
"""
# What queues give their jobs; and leave for Open MPI to start ranks as root, which others do not look at.
JOB = {"SLURM_ARRAY_TASK_ID": "17", "SLURM_ARRAY_JOB_ID": "1", "SLURM_JOB_ID": "1", "PBS_O_WORKDIR": ".",
       "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
# What a page needs beside inputs/ and the decks: runs whose files it reads.
RUNS = {"pictures.md": ("disc", "porous"), "dem_plot.1": ("rectangle", "two_discs", "brittle_disc"), "dem_export.1": ("rectangle",)}


def make_decks(folder):
    for name in ("a", "b", "deck", "drop"):
        (folder / f"{name}.nml").write_text(DROP.format(name), encoding="utf-8")
    (folder / "decks").mkdir()
    for k in range(17):
        (folder / f"decks/{k}.nml").write_text(DROP.format(f"d{k}"), encoding="utf-8")
    (folder / "decks.txt").write_text("".join(f"decks/{k}.nml\n" for k in range(17)), encoding="utf-8")
    (folder / "restitutions.txt").write_text("".join(f"{k / 20}\n" for k in range(17)), encoding="utf-8")
    (folder / "params.in").write_text("1 variables\n0.5 restitution\n", encoding="utf-8")  # as Dakota writes it


def make_folder(folder):
    make_decks(folder)
    shutil.copytree(ROOT / "inputs", folder / "inputs")
    for name in ("rectangle", "disc", "porous", "two_discs"):
        shutil.copy(folder / f"inputs/{name}.nml", folder)
    for name, spacing in COARSE.items():
        deck = (folder / f"inputs/{name}.nml").read_text(encoding="utf-8")
        deck, n = re.subn(r"(?m)^(\s*spacing\s*=) \S+", rf"\1 {spacing}", deck)
        if n != 1:
            sys.exit(f"{name}.nml gives its spacing {n} times")
        (folder / f"inputs/{name}.nml").write_text(deck, encoding="utf-8")
        shutil.copy(folder / f"inputs/{name}.nml", folder)
    (folder / "docs").symlink_to(ROOT / "docs")
    (folder / "build/drivers").mkdir(parents=True)
    for program in PROGRAMS:
        (folder / "build/drivers" / program.name).symlink_to(program)
    for program, does in (("srun", 'exec "$@"'), ("scontrol", "exit 0")):  # of a queue, which a page's script is not in
        (folder / "build/drivers" / program).write_text(f"#!/bin/sh\n{does}\n", encoding="utf-8")
        (folder / "build/drivers" / program).chmod(0o755)
    (folder / "build/src").symlink_to(PROGRAMS[0].parent.parent / "src")
    for name in ("include", "python"):
        (folder / name).symlink_to(ROOT / name)


def blocks_of_markdown(text):
    for language, block in re.findall(r"(?ms)^ *```(\w+)\n(.*?)^ *```", text):
        if language in ("sh", "python", "text") and not block.startswith("rule "):  # of Snakemake
            yield language, re.sub(r"(?m)^\.ci/(build && |(build|test)\n)", "", block)


def same_words(a, b):
    """Whether two lines are the same; numbers to 1e-3, as another machine rounds otherwise."""
    numbers = [re.findall(r"[+-]?\d+(?:\.\d+)?(?:e[+-]\d+)?", line) for line in (a, b)]
    words = [re.sub(r"[+-]?\d+(?:\.\d+)?(?:e[+-]\d+)?", "#", line) for line in (a, b)]
    return words[0] == words[1] and all(abs(float(x) - float(y)) <= 1e-3 * abs(float(x)) for x, y in zip(*numbers))


def shows(shown, line):
    """Whether a line is the one that a page shows; '...' is for its rest."""
    if shown.endswith("..."):
        words = shown.split()[:-1]
        return same_words(" ".join(words), " ".join(line.split()[:len(words)]))
    return same_words(shown, line)


def check_shown(block, printed):
    lines = iter(printed.splitlines())
    for shown in block.splitlines():
        if not any(shows(shown, line) for line in lines):
            sys.exit(f"in its place no command prints\n{shown}\nbut\n{printed}")


def plain_blocks(text):
    return [block for language, block in re.findall(r"(?ms)^```(\w*)\n(.*?)^```$", text) if not language]


def check_decks(text):
    """What a page shows of a deck stands in one of inputs/."""
    decks = [path.read_text(encoding="utf-8") for path in (ROOT / "inputs").glob("*.nml")]
    for block in plain_blocks(text):
        if block.startswith("&") and not any(block in deck for deck in decks):
            sys.exit("no deck of inputs/ has\n" + block)


def blocks_of_manual(text):
    for deck in re.findall(r"(?ms)^\.EX\n(.*?)^\.EE", text):
        deck = deck.replace("\\(aq", "'").replace("\\-", "-")
        yield "sh", f"cat >manual.nml <<'END'\n{deck}END\ndem_batch manual.nml\n"
    examples = re.search(r"(?ms)^\.SH EXAMPLES?\n(.*?)^\.SH", text).group(1)
    for command in re.findall(r"(?m)^\.B (.*)", examples):
        yield "sh", command.replace("\\-", "-") + "\n"


def lacks(language, block):
    """What a block needs and this machine lacks; None: nothing."""
    if language == "python":
        modules = re.findall(r"(?m)^(?:import|from) (\w+)", block)
        return next((name for name in modules if importlib.util.find_spec(name) is None), None)
    have = {program.name for program in PROGRAMS}
    return next((name for name in OPTIONAL
                 if re.search(rf"\b{name}\b", block) and name not in have and not shutil.which(name)), None)


def run(language, block, folder):
    script = folder / "block"
    script.write_text(block, encoding="utf-8")
    command = [sys.executable, script] if language == "python" else ["bash", "-eu", script, "params.in", "results.out"]
    path = os.pathsep.join([str(folder / "build/drivers"), os.environ["PATH"]])
    variables = {**os.environ, **JOB, "PATH": path}
    return subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=SECONDS,
                          check=False, env=variables)


with tempfile.TemporaryDirectory() as name:
    here = pathlib.Path(name)
    make_folder(here)
    for deck in RUNS.get(PAGE.name.removesuffix(".in"), ()):
        run("sh", f"dem_batch {deck}.nml\n", here)
    content = PAGE.read_text(encoding="utf-8")
    n_run, printed, last = 0, [], None
    for kind, code in blocks_of_markdown(content) if PAGE.suffix == ".md" else blocks_of_manual(content):
        if not code.strip():
            continue
        if kind == "text":
            if last is not None:
                check_shown(code, last)
            continue
        needed = lacks(kind, code)
        if needed is not None:
            print(f"left out, for want of {needed}:\n{code}")
            last = None
            continue
        done = run(kind, code, here)
        if done.returncode != 0:
            sys.exit(f"exit code {done.returncode} of\n{code}\n{done.stdout}\n{done.stderr}")
        n_run += 1
        last = done.stdout
        printed += re.findall(LOG, done.stdout)
    check_decks(content)
    for line in re.findall(LOG, "".join(plain_blocks(content))):
        if not any(same_words(line, other) for other in printed):
            sys.exit("no command prints\n" + line + "\nbut\n" + "\n".join(printed))
print(n_run, "blocks of commands work")
sys.exit(0 if n_run > 0 else 77)

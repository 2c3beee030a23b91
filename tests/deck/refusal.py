# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of refusals share: decks to spoil, and how a refusal is held against what it must be: the exact message
and exit code, nothing written, within 1 s of the processor's time and 100 MB. Needs the standard library only."""
import json
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import threading
import unittest

MOST_SECONDS, MOST_BYTES = 1.0, 100e6

BASE = """&run
    t_end = 1e-3
    gravity = 0, -9.81
/
&material
    name = 'rubber'
    youngs_modulus = 1e7
    density = 1050
    thickness = 1
/
&body
    shape = 'rectangle'
    size = 0.04, 0.05
    spacing = 0.01
    material = 'rubber'
    position = 0, 0.001
    velocity = 0, -1
/
&obstacle
    points = -0.1, 0, 0.1, 0
    restitution = 0.5
/
&output
    name = 'block'
    frame_interval = 1e-4
/
"""


def edit(text, *edits):
    """The deck with each edit 'old -> new' made at the only place where `old` stands."""
    for change in edits:
        old, new = change.split(" -> ", 1)
        if text.count(old) != 1:
            raise ValueError(f"{old!r} stands at {text.count(old)} places of the deck")
        text = text.replace(old, new)
    return text


def jagged(text):
    """The deck with bodies whose nodes are those of the lattice, so that numbers of it are known."""
    return re.sub(r"&body\s+shape = '\w+'", r"\g<0>, outline = 'lattice'", text)


def without(text, *parts):
    return edit(text, *(part + " -> " for part in parts))


DISC = edit(BASE, "'rectangle' -> 'disc'", "size = 0.04, 0.05 -> radius = 0.03")
RING = edit(BASE, "'rectangle' -> 'ring'", "size = 0.04, 0.05 -> radius = 0.03, inner_radius = 0.01")
POLYGON = edit(BASE, "'rectangle' -> 'polygon'", "size = 0.04, 0.05 -> points = 0,0, 0.04,0, 0.04,0.05, 0,0.05")
MASK = edit(BASE, "'rectangle' -> 'mask'", "size = 0.04, 0.05 -> file = 'good.pgm', scale = 0.01")
MESH = without(edit(BASE, "'rectangle' -> 'mesh'", "size = 0.04, 0.05 -> file = 'good.msh', scale = 0.01"),
               "    spacing = 0.01\n")
FILES = {  # beside the decks
    "good.pgm": "P2 4 5 1\n" + 5 * "1 1 1 1\n", "black.pgm": "P2 4 5 1\n" + 5 * "0 0 0 0\n",
    "bad.pgm": "P2\n# 2 x 2\n2 2\n255\n0 1\n2 256\n", "large.pgm": "P5 30000 30000 255\nxyz",
    "good.msh": "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n"
                "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n"}
FILES["bad.msh"] = FILES["good.msh"].replace("1 1 2 3\n", "1 1 2 4\n")
FILES["large.msh"] = FILES["good.msh"].replace("1 3 1 3", "1 4000000000 1 3")
FILES["quads.msh"] = FILES["good.msh"].replace("2 1 2 1\n", "2 1 3 1\n")
FILE = without(edit(BASE, "'rectangle' -> 'file'", "size = 0.04, 0.05 -> file = 'part.h5'"),
               "    spacing = 0.01\n", "    material = 'rubber'\n")
OBSTACLE = "&obstacle\n    points = -0.1, 0, 0.1, 0\n    restitution = 0.5\n/\n"
ROUGH = "profile = 'rough', roughness = 1e-3, correlation = 0.01"
REVERSED = ", or reverse the obstacle's points: bodies live on the left of each segment"
TALL = edit(BASE, "0.04, 0.05 -> 0.04, 0.2") + "".join(
    f"&void shape = 'rectangle', centre = 0, {y}, size = 0.06, 0.02 /\n" for y in (0.03, 0.1, 0.17))


def stderr_of(messages):
    """What a deck's messages, 'line:column message' with '-' where there is no place, look like on the terminal."""
    lines = (message.split(" ", 1) for message in messages)
    return "".join(f"deck.nml{'' if place == '-' else ':' + place}: error: {text}\n" for place, text in lines)


class Refusal(unittest.TestCase):
    maxDiff = None
    program = ""
    sanitized = False

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "out").mkdir()
        for name, text in FILES.items():
            (self.folder / name).write_text(text, encoding="ascii")

    def put(self, deck):
        (self.folder / "deck.nml").write_bytes(deck if isinstance(deck, bytes) else deck.encode())

    def snapshot(self):
        """Every file with its size and times; folders, whose times tell of what came and went."""
        found = {}
        for path in [self.folder, *self.folder.rglob("*")]:
            info = path.lstat()
            found[path] = (info.st_mode, info.st_size, info.st_mtime_ns)
        return found

    def run_program(self, *arguments, space=resource.RLIM_INFINITY):
        """Exit code, what was printed, and what it took; `space`: bytes of addresses that it gets."""
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            child = subprocess.Popen([self.program, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=out, stderr=err,
                                     preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (space, space)))
            late = threading.Timer(60, child.kill)
            late.start()
            _, status, usage = os.wait4(child.pid, 0)
            late.cancel()
            child.returncode = os.waitstatus_to_exitcode(status)
            out.seek(0)
            err.seek(0)
            return child.returncode, out.read(), err.read().decode(), usage

    def refuse(self, code, stderr, *arguments):
        before = self.snapshot()
        found, stdout, found_stderr, usage = self.run_program(*arguments)
        self.assertEqual(found_stderr, stderr)
        self.assertEqual(found, code)
        result = json.loads(stdout) if stdout else {"exit_code": code, "status": "failed"}
        self.assertEqual((result["exit_code"], result["status"]), (code, "failed"))
        self.assertEqual(stdout == b"", code == 2 or "--check" in arguments or "--echo" in arguments, "only a run has a result")
        self.assertEqual(self.snapshot(), before, "a refusal writes nothing")
        if not self.sanitized:
            self.assertLess(usage.ru_utime + usage.ru_stime, MOST_SECONDS)
            self.assertLess(1024 * usage.ru_maxrss, MOST_BYTES)

    def refuse_all(self, decks, code=3):
        """Each by itself, and every fifth by --check, too."""
        self.assertEqual(len({name for name, _, _ in decks}), len(decks))
        for k, (name, deck, messages) in enumerate(decks):
            with self.subTest(name):
                self.put(deck)
                self.refuse(code, stderr_of(messages), *(["--outdir", "out"] if k % 2 == 0 else []), "deck.nml")
                if k % 5 == 0:
                    self.refuse(code, stderr_of(messages), "--check", "deck.nml")

    def refuse_usage(self, reason, *arguments):
        _, usage, _, _ = self.run_program("--help")
        self.assertTrue(usage.startswith(b"usage: dem_batch "))
        self.refuse(2, f"dem_batch: error: {reason}\n{usage.decode()}", *arguments)


def main():
    """`test_NAME.py DEM_BATCH`."""
    Refusal.program = os.path.abspath(sys.argv.pop(1))
    Refusal.sanitized = b"__asan_init" in pathlib.Path(Refusal.program).read_bytes()
    unittest.main()

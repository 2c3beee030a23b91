#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What dem_batch does under mpirun: `test_batch.py MPIRUN DEM_BATCH INPUTS_FOLDER`."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

MPIRUN = DEM_BATCH = DECK = None
SECONDS = 60
SHORT = ["--set", "run.t_end=1e-4", "--set", "body.spacing=1e-2"]


class UnderMpirun(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_on(self, n, *command):
        done = subprocess.run([MPIRUN, "-n", str(n), *command], cwd=self.folder, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=SECONDS, check=False)
        said = [line for line in done.stderr.splitlines() if line.startswith("dem_batch")]
        return done.returncode, said, sorted(path.name for path in self.folder.iterdir())

    def test_copies_of_a_run_are_refused_in_one_line(self):
        code, said, files = self.run_on(3, DEM_BATCH, DECK)
        self.assertEqual((code, files, len(said)), (2, [], 1), said)
        self.assertRegex(said[0], "3 processes.*without mpirun or srun, or with --serial")

    def test_one_process_is_a_run(self):
        code, said, files = self.run_on(1, DEM_BATCH, *SHORT, DECK)
        self.assertEqual((code, said), (0, []))
        self.assertIn("rectangle.json", files)

    def test_processes_with_outputs_of_their_own_run(self):
        each = f'{DEM_BATCH} --serial {" ".join(SHORT)} --set output.name=r$OMPI_COMM_WORLD_RANK$PMI_RANK {DECK}'
        code, said, files = self.run_on(2, "sh", "-c", each)
        self.assertEqual((code, said), (0, []))
        self.assertEqual([name for name in files if name.endswith(".json")], ["r0.json", "r1.json"])

    def test_what_writes_nothing_goes_on(self):
        self.assertEqual(self.run_on(2, DEM_BATCH, "--check", *SHORT, DECK), (0, [], []))
        self.assertEqual(self.run_on(2, DEM_BATCH, "--version"), (0, [], []))


if __name__ == "__main__":
    MPIRUN, DEM_BATCH = sys.argv[1:3]
    DECK = str(pathlib.Path(sys.argv[3], "rectangle.nml").resolve())
    DEM_BATCH = str(pathlib.Path(DEM_BATCH).resolve())
    sys.argv[1:] = []
    unittest.main()

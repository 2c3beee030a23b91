# SPDX-License-Identifier: BSD-3-Clause
"""What tests of pictures and of pages share."""
import subprocess

SECONDS = 120

# Needs a lattice file of one point, point.h5.
POINT = """
&run t_end = 0.4 /
&body shape = 'file', file = 'point.h5', position = 0, 0.5, velocity = 1, 0 /
&obstacle points = -1, 0, 9, 0, restitution = 0.8 /
&solver spacing = 1, max_step = 0.01, v_scale = 1 /
&output name = 'point', frame_interval = 0.1 /
"""


def run_plot(program, *words, expect=0):
    result = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=SECONDS, check=False)
    if result.returncode != expect:
        raise AssertionError(f"{words}: exit code {result.returncode} instead of {expect}: {result.stderr}")
    return result

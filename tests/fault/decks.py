# SPDX-License-Identifier: BSD-3-Clause
"""Decks that take a tenth of a second and have in them what a file or a checkpoint of a run can have."""

OPTIONS = ("--checkpoint-interval", "1e-9")  # every checkpoint goes to the disk

# A disc slides over the ground: impacts, sticking, sliding, slipping, events, probes, peaks.
STICKS = """
&run title = 'a disc sticks and slides', t_end = 1.2e-3 /
&material youngs_modulus = 1e7, density = 1050 /
&body shape = 'disc', radius = 0.03, spacing = 0.01, clearance = 1e-4, velocity = 2, -5 /
&obstacle points = -0.3, -0.02, -0.05, 0.004, 0, -0.01, 0.045, 0.01, 0.3, -0.02, restitution = 0.3, friction = 0.4 /
&probe name = 'node', place = 0, -0.02 /
&probe name = 'gauge', kind = 'gauge', place = -0.02, 0, 0.02, 0, every = 3 /
&solver checkpoint_steps = 24 /
&output name = 'sticks', frame_interval = 4e-4, events = T, fields = 'velocity', 'force', most_stressed = 2 /
"""

# As few allocations as there can be: eight nodes touch a floor.
TINY = """
&run t_end = 2e-4 /
&material youngs_modulus = 1e7, density = 1050 /
&body shape = 'rectangle', size = 0.02, 0.02, spacing = 0.01, clearance = 1e-4, velocity = 0, -5 /
&obstacle points = -0.3, 0, 0.3, 0 /
&solver checkpoint_steps = 8 /
&output name = 'tiny', frame_interval = 2e-4, fields = 'velocity', peak_every = 0 /
"""

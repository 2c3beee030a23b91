# SPDX-License-Identifier: BSD-3-Clause
"""A program as its author's type checker sees it; test_types.py has it checked, and nothing runs it. Where the checker
is to find a mistake the line names it: without that mistake the comment is one itself."""
from typing import Any, assert_type

import numpy as np
from numpy.typing import NDArray

import dem
from dem import records

Floats = NDArray[np.float64]

rubber = dem.Material(youngs_modulus=1e7, density=1050, thickness=1, springs="coupled")
dem.Material(youngs=1e7)  # type: ignore[call-arg]
dem.Material(youngs_modulus="soft")  # type: ignore[arg-type]
dem.Material(springs="loose")  # type: ignore[arg-type]
assert_type(dem.Lattice.disc(0.065, 5e-3).assemble(rubber).move((0.0, 0.1)).launch([0.0, -10.0]), dem.Lattice)
dem.Lattice.disc("large", 5e-3)  # type: ignore[arg-type]
plate = dem.Shape(dem.Outline.rectangle(0.2, 0.1), 2e-3, edge="smooth", voids=[dem.Outline.disc(0.02)])
plate.add_pores(4e-3, 6e-3, porosity=0.05)
plate.add_pores(4e-3, 6e-3, pores=3)  # type: ignore[call-arg]
lattice = plate.lattice()
lattice.trim(~dem.crossed(lattice, [(-0.1, 0.0), (-0.06, 0.0)])).assemble(rubber)
lattice.mass = [1.0, 2.0]
assert_type(lattice.n_nodes, int)
assert_type(lattice.x, Floats | Any)
slope = dem.Obstacle([(-0.3, 0.1), (0.3, -0.1)], friction=0.3, friction_law="coulomb")
dem.Obstacle([(-0.3, 0.1), (0.3, -0.1)], friction_law="mine")  # type: ignore[arg-type]


def push(t: float, nodes: NDArray[np.int64], x: Floats, v: Floats) -> Floats:
    return np.zeros_like(x)


def frame(simulation: dem.Simulation) -> int | None:
    return dem.STOP if simulation.t > 1e-3 else None


def event(simulation: dem.Simulation, what: records.Event) -> None:
    assert_type(what.impulse, Floats)


held = dem.Boundary("velocity", [0, 1], (0.0, 0.0), components="xy")
dem.Boundary("speed", [0, 1], (0.0, 0.0))  # type: ignore[arg-type]
with dem.Simulation(lattice, slope, force=push, boundaries=held, gravity=(0, -9.81), bodies="all") as simulation:
    simulation.observe(frame=frame, event=event, interval=1e-4)
    with simulation.record("run.vtkhdf", 1e-3, fields=["velocity"], events=True) as recording:
        assert_type(simulation.advance(20e-3, progress=True), bool)
        recording.note("title", "a plate")
    assert_type(simulation.energy.kinetic, float)
    assert_type(simulation.body().velocity, Floats)
    simulation.contacts[0].node  # type: ignore[attr-defined]
    assert_type([contact.nodes[0] for contact in simulation.contacts], list[Any])
    assert_type(simulation.x, Floats)
    assert_type(simulation.counts.impacts, int)
    assert_type(simulation.broken(), NDArray[np.bool_])
    simulation.advance("soon")  # type: ignore[arg-type]
dem.Simulation(lattice, slope, gravitation=(0, -9.81))  # type: ignore[call-arg]
dem.Simulation(lattice, slope, force=frame)  # type: ignore[arg-type]

run = dem.read("run.vtkhdf")
assert_type(run.history["t"], Floats)
assert_type(run.obstacle().restitution, float)
assert_type(run.array("velocity", 3), Floats)
assert_type(dem.deck(run={"t_end": 1e-3}, body=[{"shape": "disc"}, {"shape": "ring"}]), str)
assert_type(dem.run("run.nml", set={"run.t_end": 2e-3}), dem.Run)

try:
    dem.run("run.nml")
except dem.DeckError as error:
    assert_type((error.code, error.line), tuple[int, int | None])
except dem.Error as error:
    assert_type(str(error), str)

# SPDX-License-Identifier: BSD-3-Clause
"""What the package gives and takes of the structs of the library, with types: records of one instant, and keywords of
materials, obstacles and options. Written by python/bindings.py from the headers in include/dem; units and ranges are in
the texts of c_interface."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, TypedDict

import numpy as np
from numpy.typing import NDArray

from . import c_interface as c
from .library import Record

Vector = Sequence[float] | NDArray[Any]  # of two components, or of three with 0


class BodyMotion(Record):
    struct = c.dem_body_motion
    mass: float
    centre: NDArray[np.float64]
    velocity: NDArray[np.float64]
    angular_momentum: NDArray[np.float64]


class BoundaryLoad(Record):
    struct = c.dem_boundary_load
    force: NDArray[np.float64]
    displacement: NDArray[np.float64]


class Break(Record):
    struct = c.dem_break
    t: float
    triangle: int
    spring: int
    body: int
    x: NDArray[np.float64]
    stress: NDArray[np.float64]
    energy: float
    fragment_new: int


class Constants(Record):
    struct = c.dem_constants
    stiffness: NDArray[np.float64]
    youngs_modulus: float
    poissons_ratio: float
    anisotropy: float
    longitudinal_speed: float
    transverse_speed: float
    volume: float


class Contact(Record):
    struct = c.dem_contact
    state: int
    n_nodes: int
    nodes: NDArray[Any]
    weights: NDArray[np.float64]
    body: int
    obstacle: int
    segment: int
    other_body: int
    x: NDArray[np.float64]
    normal: NDArray[np.float64]
    force: float
    friction: NDArray[np.float64]


class Counts(Record):
    struct = c.dem_counts
    steps: int
    rejected: int
    evaluations: int
    events: int
    impacts: int
    vertex_impacts: int
    early: int
    closings: int
    releases: int
    slips: int
    sticks: int
    passings: int
    late: int
    retries: int
    behind: int
    crossings: int


class Energy(Record):
    struct = c.dem_energy
    ledger: float
    motion: float
    kinetic: float
    elastic: float
    area: float
    guard: float
    contact: float
    gravity: float
    impact: float
    friction: float
    damping: float
    fracture: float
    projection: float
    boundary: float
    obstacle: float


class Event(Record):
    struct = c.dem_event
    t: float
    kind: int
    state: int
    node: int
    other: int
    weight: float
    body: int
    obstacle: int
    segment: int
    other_body: int
    x: NDArray[np.float64]
    normal: NDArray[np.float64]
    impulse: NDArray[np.float64]
    before: NDArray[np.float64]
    after: NDArray[np.float64]
    energy: float


class Fracture(Record):
    struct = c.dem_fracture
    triangles: int
    springs: int
    fragments: int
    largest: float
    debris: float
    median: float
    crack_length: float
    buried: int
    buried_node: int
    buried_t: float
    buried_x: NDArray[np.float64]


class ModelSize(Record):
    struct = c.dem_model_size
    n_nodes: int
    n_springs: int
    n_triangles: int
    n_bodies: int
    n_contact_nodes: int
    n_contact_edges: int
    n_obstacles: int
    n_segments: int
    n_vertices: int


class ObstacleLaws(Record):
    struct = c.dem_obstacle
    n_points: int
    points: Any
    restitution: float
    friction: float
    friction_law: int
    velocity: NDArray[np.float64]
    amplitude: NDArray[np.float64]
    frequency: float
    phase: float
    pivot: NDArray[np.float64]
    spin: float
    ramp: float
    motion: Any
    motion_context: Any
    most_speed: float
    most_acceleration: float
    longest_step: float


class ObstacleLoad(Record):
    struct = c.dem_obstacle_load
    reaction: NDArray[np.float64]
    point: NDArray[np.float64]
    impulse: NDArray[np.float64]
    friction_impulse: NDArray[np.float64]
    n_contacts: int
    displacement: NDArray[np.float64]
    angle: float
    power: float


class Options(Record):
    struct = c.dem_options
    method: int
    gravity: NDArray[np.float64]
    rtol: float
    spacing: float
    v_scale: float
    max_step: float
    fixed_step: float
    penetration_tolerance: float
    rest_speed: float
    max_impacts: int
    window: float
    mass_damping: float
    vertices: bool
    contact: int
    kernel: int
    threads: int
    checkpoint_steps: int
    n_boundaries: int
    boundaries: Any
    force: Any
    force_context: Any
    bodies: int
    contact_thickness: float
    contact_stiffness: float
    contact_friction: float
    n_body_frictions: int
    body_friction: Any
    pause: float
    thread_nodes: int


class Overlap(Record):
    struct = c.dem_overlap
    now: int
    most: int
    t: float
    node: int
    triangle: int
    x: NDArray[np.float64]


class Pair(Record):
    struct = c.dem_pair
    node: int
    edge: NDArray[Any]
    body: int
    other_body: int
    x: NDArray[np.float64]
    normal: NDArray[np.float64]
    gap: float
    thickness: float
    force: NDArray[np.float64]
    friction: NDArray[np.float64]
    slides: int


class ShapeReport(Record):
    struct = c.dem_shape_report
    n_rim: int
    n_off: int
    n_cut: int
    farthest: float
    idle_void: int


class Strain(Record):
    struct = c.dem_strain
    min: float
    max: float
    spring_min: int
    spring_max: int
    area_min: float
    guarded: int
    inverted: int


class Surfaces(Record):
    struct = c.dem_surfaces
    gap_min: float
    gap_share: float
    thickness_min: float
    thickness_max: float
    pushing: int
    n_edges: int
    left_out: int
    modulus_min: float
    modulus_max: float
    pressure_share: float
    friction_min: float
    friction_max: float


class MaterialKeywords(TypedDict, total=False):
    """See c_interface.dem_material."""
    youngs_modulus: float
    bond_stiffness: float
    poissons_ratio: float
    plane: Literal["stress", "strain"] | int
    density: float
    thickness: float
    guard: float
    damping_time: float
    springs: Literal["independent", "coupled"] | int
    strength: float
    critical_stretch: float
    fracture_energy: float
    compressive_strength: float
    stress_average: Literal["corners", "element"] | int


class ObstacleKeywords(TypedDict, total=False):
    """See c_interface.dem_obstacle."""
    restitution: float
    friction: float
    friction_law: Literal["coulomb", "paper"] | int
    velocity: Vector
    amplitude: Vector
    frequency: float
    phase: float
    pivot: Vector
    spin: float
    ramp: float
    most_speed: float
    most_acceleration: float
    longest_step: float


class OptionsKeywords(TypedDict, total=False):
    """See c_interface.dem_options."""
    method: Literal["fehlberg45", "dopri45", "cashkarp45", "zonneveld34", "bs23", "heun12", "sayfyaburub34", "ark23",
        "ark34", "ark34b", "ark45", "ark45b", "verner56", "verner67", "verner78", "verner89", "fehlberg78",
        "knothwolke3", "rk4", "verlet"] | int
    gravity: Vector
    rtol: float
    spacing: float
    v_scale: float
    max_step: float
    fixed_step: float
    penetration_tolerance: float
    rest_speed: float
    max_impacts: int
    window: float
    mass_damping: float
    vertices: bool
    contact: Literal["local", "exact"] | int
    kernel: Literal["auto", "portable", "avx2", "avx512"] | int
    threads: int
    checkpoint_steps: int
    bodies: Literal["none", "others", "all"] | int
    contact_thickness: float
    contact_stiffness: float
    contact_friction: float
    pause: float
    thread_nodes: int


class TrajectoryKeywords(TypedDict, total=False):
    """See c_interface.dem_trajectory_options."""
    double_precision: bool
    deflate: int
    events: bool
    most_stressed: int
    breaks: bool
    fragments: bool
    history_interval: float
    stays_open: bool
    writers: int

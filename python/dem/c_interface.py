# SPDX-License-Identifier: BSD-3-Clause
"""The C interface of dem, name by name, written by python/bindings.py from the headers in include/dem. The texts are
those of the headers: shapes, units, ranges, errors, ownership. Programs use the package dem, which is made of this."""
from ctypes import (CFUNCTYPE, POINTER, Structure, c_bool, c_char, c_char_p, c_double, c_int, c_int32, c_int64,
                    c_size_t, c_ubyte, c_uint32, c_uint64, c_void_p, sizeof)
from enum import IntEnum
from typing import Any


class SizedStructure(Structure):
    """Begins with its size, by which the library knows what a struct of a program holds."""

    def __init__(self, **values: Any) -> None:
        super().__init__(struct_size=sizeof(type(self)), **values)


class dem_checkpoint(Structure):
    """Known to the library only."""


class dem_model(Structure):
    """Known to the library only."""


class dem_peaks(Structure):
    """Known to the library only."""


class dem_reader(Structure):
    """Known to the library only."""


class dem_simulation(Structure):
    """Known to the library only."""


class dem_trajectory(Structure):
    """Known to the library only."""


# ---- dem/status.h


class dem_status(IntEnum):
    """Values of dem_status."""
    DEM_OK = 0
    DEM_STOPPED = 1
    DEM_ERROR_MEMORY = -1
    DEM_ERROR_ARGUMENT = -2
    DEM_ERROR_MODEL = -3
    DEM_ERROR_INTEGRATOR = -4
    DEM_ERROR_CONTACT = -5
    DEM_ERROR_IO = -6


# ---- dem/checkpoint.h


# ---- dem/lattice.h


class dem_plane(IntEnum):
    """Values of dem_plane."""
    DEM_PLANE_STRESS = 0
    DEM_PLANE_STRAIN = 1


class dem_springs(IntEnum):
    """How the three springs of a triangle answer to its strain."""
    DEM_SPRINGS_INDEPENDENT = 0
    DEM_SPRINGS_COUPLED = 1


class dem_stress_average(IntEnum):
    """Which stress breaks a triangle."""
    DEM_STRESS_AVERAGE_CORNERS = 0
    DEM_STRESS_AVERAGE_ELEMENT = 1

DEM_NODE_FIXED = 1
DEM_NODE_CONTACT = 2
DEM_NODE_RIGID = 4
DEM_NODE_GUIDE_X = 8
DEM_NODE_GUIDE_Y = 16


class dem_guide(IntEnum):
    """How a rigid body may move."""
    DEM_GUIDE_NONE = 0
    DEM_GUIDE_X = 1
    DEM_GUIDE_Y = 2

dem_lattice_cut_keep = CFUNCTYPE(c_bool, c_void_p, POINTER(c_double))


class dem_material(SizedStructure):
    """An isotropic solid; `plane` says how it is a body in the plane.
    struct_size: to be set to sizeof(dem_material), in each of an array
    youngs_modulus: E, Pa, > 0; 0 where the springs are given by bond_stiffness
    bond_stiffness: 0, or E_ij, N, > 0: every spring has this, as the paper draws them, whatever its length; nothing
        else is known then, neither E nor nu (equation 1)
    poissons_ratio: nu, in (-1, 1) in plane stress, in (-1, 0.5) in plane strain. Springs alone have 1/3 in plane
        stress, 1/4 in plane strain; any other needs the area term
    density: rho, kg/m^3, > 0
    thickness: h, m, > 0
    guard: strength of the folding guard over E h, >= 0; 0: none; usual: 0.02
    damping_time: of the springs (Kelvin-Voigt), s, >= 0: a strain rate e' acts like a strain damping_time e'; 0: none
    springs: of triangles; coupled ones go neither with bond_stiffness nor with cells
    strength: Pa, >= 0: of its triangles; 0: none breaks by its stress
    critical_stretch: >= 0: strain at which its springs break; 0: none does
    fracture_energy: G_f, J/m^2, >= 0, that a crack takes for its area; 0: what follows from the strength. Without a
        strength triangles are brittle, with one that follows from it; with both they soften. Neither with
        critical_stretch nor with bond_stiffness
    compressive_strength: Pa, 0 or >= strength: under pressure alone, with a strength and without a fracture energy; 0:
        pressure breaks nothing. See dem_lattice
    stress_average: of its triangles, not of cells; that of the element with a strength and a fracture energy"""
    _fields_ = [("struct_size", c_size_t), ("youngs_modulus", c_double), ("bond_stiffness", c_double),
                ("poissons_ratio", c_double), ("plane", c_int), ("density", c_double), ("thickness", c_double),
                ("guard", c_double), ("damping_time", c_double), ("springs", c_int), ("strength", c_double),
                ("critical_stretch", c_double), ("fracture_energy", c_double), ("compressive_strength", c_double),
                ("stress_average", c_int)]


class dem_lattice(SizedStructure):
    """Nodes, springs in triplet form (any order, no duplicates) and triangles. Every array is owned by the lattice and
    comes from malloc; dem_lattice_free() frees them all.
    struct_size: set by dem_lattice_empty()
    dim: 2; 3 is reserved
    n_nodes: > 0
    n_springs: >= 0
    n_triangles: >= 0
    x: [n_nodes][2] rest position, m
    mass: [n_nodes] m_i > 0, kg
    ends: [n_springs][2] the two nodes, distinct
    rest_length: [n_springs] d0_ij > 0, m (equation 1)
    stiffness: [n_springs] E_ij > 0, N: force at unit strain (equation 1)
    triangles: [n_triangles][3] counter-clockwise; NULL: none
    viscosity: [n_springs] force at unit strain rate >= 0, N s; NULL: undamped
    guard: [n_triangles] guard strength >= 0, N/m; NULL: none
    area_stiffness: [n_triangles] kappa of the area term, of any sign, N/m: the energy kappa/2 (A - A0)^2/A0 of a
        triangle of area A; NULL: none
    thickness: [n_triangles] > 0, m, for stresses and pressures; NULL: 1 m
    modulus: [n_triangles] > 0, Pa, for stresses: each triangle of a spring has a share of its force in proportion to
        modulus * thickness * area, and where springs are coupled to the weight of docs/algorithms.md, Shares. No force
        depends on it. NULL: the same in all
    flags: [n_nodes] DEM_NODE_...; NULL: none fixed, contact on the boundary of the triangulation, on every node where
        there are no triangles
    body: [n_nodes] body number from 0; NULL: one body
    position: [n_nodes][2] where the motion starts, m; NULL: at x
    velocity: [n_nodes][2] with which velocity, m/s; NULL: at rest
    coupling: [n_triangles][3] of any sign, N/m: at each corner the tension of one of its two edges per change of length
        of the other. An edge that has one needs a spring; NULL: none
    strength: [n_triangles] > 0, Pa: a triangle breaks when the largest principal value of the mean of its corners'
        stresses reaches it; INFINITY: never; NULL: none breaks by its stress
    critical_stretch: [n_springs] > 0: a spring breaks when its strain reaches it, with the triangles that hold it;
        INFINITY: never; NULL: none breaks by its strain
    softening: [n_triangles] q >= 1: at its strength a triangle does not break yet, but has less and less left in
        tension, nothing at q times the strain; 1: it breaks; NULL: 1 in all
    compressive_strength: [n_triangles] f_c >= strength, Pa: a triangle breaks when max(s1, 0)/strength - min(s3, 0)/f_c
        reaches 1, s1 >= s3 being the principal values of the mean of its corners' stresses. Of one that does not
        soften; INFINITY: pressure alone does not break it; NULL: INFINITY in all
    confinement: [n_triangles] k >= 0: where s1 is a pressure, too, it breaks when -s3 is f_c - k s1. With f_c/strength
        that is Mohr-Coulomb's law in plane strain, with 0 in plane stress, where the largest principal stress is that
        of the free faces; NULL: 0 in all
    own_stress: [n_triangles] 1: its own stress breaks it or lets it soften, 0: the mean of its corners' stresses; NULL:
        0 in all"""
    _fields_ = [("struct_size", c_size_t), ("dim", c_int), ("n_nodes", c_int64), ("n_springs", c_int64),
                ("n_triangles", c_int64), ("x", POINTER(c_double)), ("mass", POINTER(c_double)),
                ("ends", POINTER(c_int64)), ("rest_length", POINTER(c_double)), ("stiffness", POINTER(c_double)),
                ("triangles", POINTER(c_int64)), ("viscosity", POINTER(c_double)), ("guard", POINTER(c_double)),
                ("area_stiffness", POINTER(c_double)), ("thickness", POINTER(c_double)),
                ("modulus", POINTER(c_double)), ("flags", POINTER(c_ubyte)), ("body", POINTER(c_int32)),
                ("position", POINTER(c_double)), ("velocity", POINTER(c_double)), ("coupling", POINTER(c_double)),
                ("strength", POINTER(c_double)), ("critical_stretch", POINTER(c_double)),
                ("softening", POINTER(c_double)), ("compressive_strength", POINTER(c_double)),
                ("confinement", POINTER(c_double)), ("own_stress", POINTER(c_ubyte))]


def dem_lattice_default() -> dem_lattice:
    """A dem_lattice with its defaults."""
    value = dem_lattice()
    value.dim = 2
    return value


class dem_weibull(SizedStructure):
    """Strengths that scatter by Weibull's law of the weakest link: a piece of volume V stands the share s of the
    strength sigma_0 of its material with the probability exp(-(V/V_0) s^m). The strength of a body under uniform
    stress then depends on its volume, and not on the mesh.
    struct_size: to be set to sizeof(dem_weibull), in each of an array
    shape: m, >= 0: the larger, the less strengths scatter; 0: they do not, all factors are 1
    volume: V_0, m^3, > 0: of a piece of which a share of 1/e stands sigma_0
    section: m^2, >= 0: of springs that no triangle holds, whose volume is this times their rest length; 0: there are
        none. That of the first law counts
    body: lattices with different numbers draw differently by one seed
    number: [n_triangles] distinct, in [0, 2^60): by which they draw; NULL: their own. A part that is cut out of a
        lattice draws like the whole where it keeps the numbers of that"""
    _fields_ = [("struct_size", c_size_t), ("shape", c_double), ("volume", c_double), ("section", c_double),
                ("seed", c_uint64), ("body", c_int64), ("number", POINTER(c_int64))]


# ---- dem/method.h


class dem_method(IntEnum):
    """How the motion is integrated. A pair of orders p(q), named by both, advances with the higher and chooses its
    steps by what the two differ; the methods with one order take steps of one length."""
    DEM_METHOD_FEHLBERG45 = 0
    DEM_METHOD_DOPRI45 = 1
    DEM_METHOD_CASHKARP45 = 2
    DEM_METHOD_ZONNEVELD34 = 3
    DEM_METHOD_BS23 = 4
    DEM_METHOD_HEUN12 = 5
    DEM_METHOD_SAYFYABURUB34 = 6
    DEM_METHOD_ARK23 = 7
    DEM_METHOD_ARK34 = 8
    DEM_METHOD_ARK34B = 9
    DEM_METHOD_ARK45 = 10
    DEM_METHOD_ARK45B = 11
    DEM_METHOD_VERNER56 = 12
    DEM_METHOD_VERNER67 = 13
    DEM_METHOD_VERNER78 = 14
    DEM_METHOD_VERNER89 = 15
    DEM_METHOD_FEHLBERG78 = 16
    DEM_METHOD_KNOTHWOLKE3 = 17
    DEM_METHOD_RK4 = 18
    DEM_METHOD_VERLET = 19


class dem_method_traits(SizedStructure):
    """What is known of a method before any step. Undamped oscillations of angular frequency omega are multiplied by
    dem_method_growth(method, omega h) in a step h.
    struct_size: to be set to sizeof(dem_method_traits)
    name: as in decks: "fehlberg45"
    order: of what advances
    evaluations: of the right-hand side (4), in an accepted step without contact events
    adaptive: whether it chooses its steps; else they are of one length, `fixed_step`
    stable: largest omega h up to which no oscillation grows; 0: each does in each step
    usable: largest omega h up to which none grows by more than 1e-3 in a step"""
    _fields_ = [("struct_size", c_size_t), ("name", c_char_p), ("order", c_int32), ("evaluations", c_int32),
                ("adaptive", c_bool), ("stable", c_double), ("usable", c_double)]


# ---- dem/model.h


class dem_friction_law(IntEnum):
    """Values of dem_friction_law."""
    DEM_FRICTION_COULOMB = 0
    DEM_FRICTION_PAPER = 1


class dem_pose(SizedStructure):
    """Place and angle of an obstacle at one time, and their derivatives. A point of it that is given at X
    (dem_obstacle's points) is at place + R(angle) X, where R turns counter-clockwise about the origin. The third
    component of every vector is 0.
    struct_size: set by the library
    place: m
    velocity: m/s, the derivative of the place
    acceleration: m/s^2, that of the velocity
    spin_rate: angle, spin, spin_rate: rad, rad/s, rad/s^2: an angle and its derivatives"""
    _fields_ = [("struct_size", c_size_t), ("place", c_double * 3), ("velocity", c_double * 3),
                ("acceleration", c_double * 3), ("angle", c_double), ("spin", c_double), ("spin_rate", c_double)]

dem_motion = CFUNCTYPE(c_int, c_void_p, c_double, POINTER(dem_pose))


class dem_obstacle(SizedStructure):
    """A rigid polyline, at rest or moving; bodies live on the left of each segment, the solid is on its right. Closed
    if the last point is the first. The ends of an open one are free: what has passed round an end may come back from
    behind, unhindered. Restitution and friction are those of velocities relative to it. Its motions add up; nothing
    pushes it off its way.
    struct_size: to be set to sizeof(dem_obstacle), in each of an array
    n_points: >= 2
    points: [n_points][2], m; from one to the next a length that can be squared
    restitution: eta in [0, 1], of a single node: a body rebounds by its waves even with 0 (equation 9)
    friction: mu >= 0; 0: none in Coulomb's law. In (10) at most 1, which is none there
    velocity: m/s, of a translation. All vectors have a third component of 0
    amplitude: m, of an oscillation amplitude sin(2 pi frequency t + phase) about the points given
    frequency: Hz, of it; > 0
    phase: degrees, of it
    pivot: m, about which it turns, as the points are given; goes with the other motions
    spin: rad/s, of a rotation, counter-clockwise
    ramp: s, >= 0: velocity, amplitude and spin grow from 0 in this time, as a boundary's value
    motion: NULL: it moves as said above; else as this says, and in no other way
    motion_context: handed to it
    most_speed: m/s, > 0 with `motion`: what no point of the obstacle exceeds at any time,
    most_acceleration: m/s^2, and this; a motion that does is a failure
    longest_step: s, a step that still follows it; 0: any"""
    _fields_ = [("struct_size", c_size_t), ("n_points", c_int64), ("points", POINTER(c_double)),
                ("restitution", c_double), ("friction", c_double), ("friction_law", c_int), ("velocity", c_double * 3),
                ("amplitude", c_double * 3), ("frequency", c_double), ("phase", c_double), ("pivot", c_double * 3),
                ("spin", c_double), ("ramp", c_double), ("motion", dem_motion), ("motion_context", c_void_p),
                ("most_speed", c_double), ("most_acceleration", c_double), ("longest_step", c_double)]


class dem_motion_field(Structure):
    """A field of dem_obstacle that says how it moves: of this name in decks and files too.
    n: 1 or 2 numbers of type double, 2 of a vector, whose third is 0 in the plane,
    offset: this many bytes behind the begin of dem_obstacle"""
    _fields_ = [("name", c_char_p), ("unit", c_char_p), ("n", c_int64), ("offset", c_size_t)]


class dem_csr(SizedStructure):
    """Springs in CSR: row i holds the neighbours of node i in ascending order. Those of rigid bodies carry nothing and
    are left out: row[n_nodes] is twice the number of the others. Views into the model, valid as long as it is.
    struct_size: to be set to sizeof(dem_csr)
    row: [n_nodes + 1] slots row[i] .. row[i+1]-1 belong to node i
    neighbour: [row[n_nodes]] node j
    spring: [row[n_nodes]] index of the spring in the lattice
    stiffness: [row[n_nodes]] E_ij, N (equation 1)
    rest_length: [row[n_nodes]] d0_ij, m (equation 1)
    viscosity: [row[n_nodes]] N s; NULL: undamped"""
    _fields_ = [("struct_size", c_size_t), ("n_nodes", c_int64), ("row", POINTER(c_int64)),
                ("neighbour", POINTER(c_int64)), ("spring", POINTER(c_int64)), ("stiffness", POINTER(c_double)),
                ("rest_length", POINTER(c_double)), ("viscosity", POINTER(c_double))]


class dem_model_size(SizedStructure):
    """Fields of dem_model_size.
    struct_size: to be set to sizeof(dem_model_size)
    n_contact_nodes: nodes that may touch
    n_contact_edges: boundary edges of the triangulation between two such nodes
    n_vertices: convex vertices of obstacles, which may touch such an edge"""
    _fields_ = [("struct_size", c_size_t), ("n_nodes", c_int64), ("n_springs", c_int64), ("n_triangles", c_int64),
                ("n_bodies", c_int64), ("n_contact_nodes", c_int64), ("n_contact_edges", c_int64),
                ("n_obstacles", c_int64), ("n_segments", c_int64), ("n_vertices", c_int64)]


class dem_constants(SizedStructure):
    """Elastic constants of a body about its rest shape, read as a plate in plane stress: a solid in plane strain has
    E/(1 - nu^2) and nu/(1 - nu).
    struct_size: to be set to sizeof(dem_constants)
    stiffness: C in s = C e, Pa: s = (s_xx, s_yy, s_xy), e = (e_xx, e_yy, 2 e_xy)
    youngs_modulus: E, Pa, of the isotropic plate nearest to C: the average over all directions
    poissons_ratio: nu of the same
    anisotropy: largest over smallest Young's modulus along a direction; 1: isotropic
    longitudinal_speed: m/s, of long waves, with E, nu and the density
    transverse_speed: m/s
    volume: m^3, of the triangles"""
    _fields_ = [("struct_size", c_size_t), ("stiffness", c_double * 3 * 3), ("youngs_modulus", c_double),
                ("poissons_ratio", c_double), ("anisotropy", c_double), ("longitudinal_speed", c_double),
                ("transverse_speed", c_double), ("volume", c_double)]


# ---- dem/simulation.h


class dem_boundary_kind(IntEnum):
    """What is done to nodes from outside."""
    DEM_BOUNDARY_VELOCITY = 0
    DEM_BOUNDARY_DISPLACEMENT = 1
    DEM_BOUNDARY_FORCE = 2

DEM_COMPONENT_X = 1
DEM_COMPONENT_Y = 2


class dem_kernel(IntEnum):
    """With which instructions forces are evaluated. All give the same results to the bit."""
    DEM_KERNEL_AUTO = 0
    DEM_KERNEL_PORTABLE = 1
    DEM_KERNEL_AVX2 = 2
    DEM_KERNEL_AVX512 = 3


class dem_contact_method(IntEnum):
    """How contact events inside a step are taken."""
    DEM_CONTACT_LOCAL = 0
    DEM_CONTACT_EXACT = 1


class dem_bodies(IntEnum):
    """Which surfaces of bodies push each other off."""
    DEM_BODIES_NONE = 0
    DEM_BODIES_OTHERS = 1
    DEM_BODIES_ALL = 2


class dem_contact_state(IntEnum):
    """Values of dem_contact_state."""
    DEM_CONTACT_FREE = 0
    DEM_CONTACT_SLIP = 1
    DEM_CONTACT_STICK = 2


class dem_event_kind(IntEnum):
    """What can happen to a contact."""
    DEM_EVENT_IMPACT = 0
    DEM_EVENT_CLOSE = 1
    DEM_EVENT_RELEASE = 2
    DEM_EVENT_SLIP = 3
    DEM_EVENT_STICK = 4
    DEM_EVENT_PASS = 5


class dem_boundary(SizedStructure):
    """The ramp is 10 s^3 - 15 s^4 + 6 s^5, s = t/ramp, up to s = 1 and 1 from there; 1 at all times for ramp = 0. Nodes
    with prescribed components do not touch obstacles: dem_lattice_exclude().
    struct_size: to be set to sizeof(dem_boundary), in each of an array
    components: which are prescribed, DEM_COMPONENT_X | DEM_COMPONENT_Y; a force has both
    nodes: [n_nodes] distinct; a component of a node is prescribed only once
    share: [n_nodes] of a force; NULL: 1/n_nodes each
    value: m/s, m, or N; the third 0
    ramp: s, >= 0; > 0 for a displacement"""
    _fields_ = [("struct_size", c_size_t), ("kind", c_int), ("components", c_int32), ("n_nodes", c_int64),
                ("nodes", POINTER(c_int64)), ("share", POINTER(c_double)), ("value", c_double * 3), ("ramp", c_double)]


class dem_force_query(Structure):
    """Where an external force is wanted: n nodes with their places and velocities at an instant. Where ranks share the
    model (dem/mpi.h) "all" are those that this rank integrates, whoever owns them.
    t: s
    n: nodes asked about: all of them in ascending order, or those near a contact
    nodes: [n] their numbers in the lattice, of ranks in the whole one
    v: x, v: [n][2] m, m/s: of nodes[k] at x[2 k], x[2 k + 1]"""
    _fields_ = [("t", c_double), ("n", c_int64), ("nodes", POINTER(c_int64)), ("x", POINTER(c_double)),
                ("v", POINTER(c_double))]

dem_force = CFUNCTYPE(c_int, c_void_p, POINTER(dem_force_query), POINTER(c_double))


class dem_options(SizedStructure):
    """Fields of dem_options.
    struct_size: set by dem_options_default(); docs/linking.md says how structs may grow
    method: default DEM_METHOD_FEHLBERG45
    gravity: m/s^2, default {0, -9.81, 0}; the third is 0 in the plane (equation 2)
    rtol: default 1e-6: error of a position over spacing, of a velocity over v_scale
    spacing: m, default 0: shortest rest length; required for a model without springs
    v_scale: m/s, default 0: largest of initial speed, sqrt(2 g drop), 1e-3 sound speed
    max_step: s, default 0: 0.5/omega_max; required for a model without springs. Damping may shorten it: docs/method.md
    fixed_step: s, default 0: adaptive; > 0: steps of this length, no error control. A method that is not adaptive takes
        max_step, which then is by default stable/(8 omega_max)
    penetration_tolerance: m, default 0: 1e-6 spacing. An impact is taken at this depth, which delays it by penetration
        tolerance/|v_n|, and the node put back on the surface
    rest_speed: m/s, default 0: a rebound not faster than this becomes a lasting contact, beside those that do by the
        rule of docs/method.md. What is below the rule's speed has no effect
    max_impacts: default 10000: changes of the contacts of one node or edge within 1/omega_max that count as a storm
    window: s, default < 0: see docs/method.md. At an impact, what would arrive within this time is reflected at once,
        and hops of less than twice this become lasting contacts; 0: every impact by itself
    mass_damping: 1/s, default 0: each node feels -mass_damping m v, so that bodies come to rest
    vertices: default true: convex vertices of obstacles touch the edges of bodies; false: only nodes touch
    contact: default DEM_CONTACT_LOCAL
    kernel: default DEM_KERNEL_AUTO
    threads: default 1, 1 to 1024: threads that work at once, at most; as many are used as pay (thread_nodes). The
        results are the same to the bit
    checkpoint_steps: default 256: accepted steps between checkpoints, of which the bits of a run depend as on a
        tolerance; 0: no checkpoints
    n_boundaries: default 0
    boundaries: [n_boundaries] copied by dem_simulation_create()
    force: default NULL: no external force
    force_context: handed to it
    bodies: default DEM_BODIES_NONE. The other two need triangles in every body
    contact_thickness: m, default 0: of each body a fifth of its mean boundary edge. The distance at which surfaces
        begin to push: less than half of the shortest boundary edge
    contact_stiffness: default 0: 1. Factor of the modulus with which they push, 0.01 to 100
    contact_friction: default 0: none. Coefficient of friction of bodies with each other and with themselves, >= 0; not
        without `bodies`
    n_body_frictions: default 0; else the number of bodies
    body_friction: [n_body_frictions] of each body instead, copied; of two bodies the smaller
    pause: default 0: none; else up to 0.1: from a break on the ramps of all boundaries stand still, until
        dem_simulation_residual() is at most this. Looked at after every 16th step; needs damping to end. Obstacles move
        on
    thread_nodes: default 0; else the nodes that a thread has to have before there is another one. By default 2500, and
        no more threads than cores that this process may use, by affinity and by the quota of its control group"""
    _fields_ = [("struct_size", c_size_t), ("method", c_int), ("gravity", c_double * 3), ("rtol", c_double),
                ("spacing", c_double), ("v_scale", c_double), ("max_step", c_double), ("fixed_step", c_double),
                ("penetration_tolerance", c_double), ("rest_speed", c_double), ("max_impacts", c_int64),
                ("window", c_double), ("mass_damping", c_double), ("vertices", c_bool), ("contact", c_int),
                ("kernel", c_int), ("threads", c_int32), ("checkpoint_steps", c_int64), ("n_boundaries", c_int64),
                ("boundaries", POINTER(dem_boundary)), ("force", dem_force), ("force_context", c_void_p),
                ("bodies", c_int), ("contact_thickness", c_double), ("contact_stiffness", c_double),
                ("contact_friction", c_double), ("n_body_frictions", c_int64), ("body_friction", POINTER(c_double)),
                ("pause", c_double), ("thread_nodes", c_int64)]


def dem_options_default() -> dem_options:
    """A dem_options with its defaults."""
    value = dem_options()
    value.gravity[1] = -9.81
    value.rtol = 1e-6
    value.max_impacts = 10000
    value.window = -1.0
    value.vertices = True
    value.threads = 1
    value.checkpoint_steps = 256
    return value


class dem_energy(SizedStructure):
    """Energies in J, of the state that is seen, and what has been taken and put in since the start. The ledger is
    computed by the library, so that it closes for a program whose header does not know all entries.
    struct_size: to be set to sizeof(dem_energy)
    ledger: motion + gravity + impact + friction + damping + fracture - projection - boundary - obstacle: what stays
        constant in a run, up to the integrator's error
    motion: kinetic + elastic + area + guard + contact: what the ledger is compared with
    kinetic: sum m_i v_i.v_i/2
    elastic: of the springs and their couplings (equation 1)
    area: of the area term; < 0 where nu < 1/3 in plane stress
    guard: of the folding guard
    contact: of surfaces that push each other off, and of what holds bodies by friction
    gravity: -sum m_i g.x_i, zero of height at the origin (equation 2)
    impact: taken by impacts so far, restitution and friction, >= 0 (9), (equation 10)
    friction: taken by lasting contacts and bodies that slide so far, >= 0; for bodies it may fall a bit
    damping: taken by the damping of springs and masses so far, >= 0
    fracture: taken by breaking so far: what the broken elements had
    projection: put in by returning nodes from the penetration tolerance to the surface so far
    boundary: put in from outside so far: work of what prescribes motions, and of forces
    obstacle: put in by moving obstacles so far, by impacts and in lasting contacts"""
    _fields_ = [("struct_size", c_size_t), ("ledger", c_double), ("motion", c_double), ("kinetic", c_double),
                ("elastic", c_double), ("area", c_double), ("guard", c_double), ("contact", c_double),
                ("gravity", c_double), ("impact", c_double), ("friction", c_double), ("damping", c_double),
                ("fracture", c_double), ("projection", c_double), ("boundary", c_double), ("obstacle", c_double)]


class dem_contact(SizedStructure):
    """A lasting contact: a weighted combination of nodes held by a partner. A node on a segment is one node of weight
    1; an obstacle's vertex on a body's edge is two nodes of weights 1 - s and s.
    struct_size: to be set to sizeof(dem_contact)
    n_nodes: 1 to 4
    nodes: that touch
    weights: sum 1
    body: of these nodes
    obstacle: the partner; -1 if that is a body
    segment: of the obstacle; of a vertex, the segment that ends there
    other_body: the partner; -1 if that is an obstacle, as in every contact yet
    x: m, where it acts
    normal: unit, out of the partner
    force: N, reaction along the normal at the last accepted step, >= 0
    friction: N, reaction along the tangents, the first of which is (normal[1], -normal[0], 0) and the second the third
        axis, along which nothing acts in the plane"""
    _fields_ = [("struct_size", c_size_t), ("state", c_int), ("n_nodes", c_int32), ("nodes", c_int64 * 4),
                ("weights", c_double * 4), ("body", c_int64), ("obstacle", c_int64), ("segment", c_int64),
                ("other_body", c_int64), ("x", c_double * 3), ("normal", c_double * 3), ("force", c_double),
                ("friction", c_double * 2)]


class dem_event(SizedStructure):
    """Events are the library's: a program reads of them what its header knows, and struct_size tells what there is.
    struct_size: bytes that the library has filled
    t: s
    state: of the contact afterwards
    node: that touches; of an edge its first
    other: the second node of the edge, or -1
    weight: of `other`, s; 0 without it
    body: of the node
    obstacle: the partner; -1 if that is a body
    segment: of the obstacle; of a vertex, the segment that ends there
    other_body: the partner; -1 if that is an obstacle, as in every event yet
    x: m, place on the partner
    normal: unit, out of the partner; in a corner that of the faster approached segment
    impulse: N s, given to the body; 0 but for impacts
    after: before, after: m/s, of the body at the contact
    energy: J, taken by the impact, >= 0"""
    _fields_ = [("struct_size", c_size_t), ("t", c_double), ("kind", c_int), ("state", c_int), ("node", c_int64),
                ("other", c_int64), ("weight", c_double), ("body", c_int64), ("obstacle", c_int64),
                ("segment", c_int64), ("other_body", c_int64), ("x", c_double * 3), ("normal", c_double * 3),
                ("impulse", c_double * 3), ("before", c_double * 3), ("after", c_double * 3), ("energy", c_double)]


class dem_state(SizedStructure):
    """The motion that is seen; arrays are views, valid until the simulation's next non-const call.
    struct_size: to be set to sizeof(dem_state)
    t: s
    step: s, length of the last accepted step
    v: x, v: [n_nodes][dim] m, m/s
    n_contacts: closed now: dem_simulation_contact()"""
    _fields_ = [("struct_size", c_size_t), ("t", c_double), ("step", c_double), ("x", POINTER(c_double)),
                ("v", POINTER(c_double)), ("n_contacts", c_int64)]


class dem_progress(SizedStructure):
    """How far a run is.
    struct_size: to be set to sizeof(dem_progress)
    t: s
    step: s, length of the last accepted step
    n_contacts: closed now: dem_simulation_contact()"""
    _fields_ = [("struct_size", c_size_t), ("t", c_double), ("step", c_double), ("n_contacts", c_int64)]


class dem_body_motion(SizedStructure):
    """Mean motion of a body.
    struct_size: to be set to sizeof(dem_body_motion)
    mass: kg
    centre: centre of mass, m
    velocity: of the centre of mass, m/s
    angular_momentum: about the centre of mass, kg m^2/s; in the plane the third alone is not 0"""
    _fields_ = [("struct_size", c_size_t), ("mass", c_double), ("centre", c_double * 3), ("velocity", c_double * 3),
                ("angular_momentum", c_double * 3)]


class dem_obstacle_load(SizedStructure):
    """What an obstacle gives to the bodies, and where it is.
    struct_size: to be set to sizeof(dem_obstacle_load)
    reaction: N, instantaneous sum over lasting contacts, with rigid bodies too
    point: m, where that resultant acts: on its line of action, nearest to the mean place of the contacts weighted by
        their forces; 0 without contacts
    impulse: N s, so far: impacts, and the reactions integrated over time
    friction_impulse: N s, the tangential part of it
    n_contacts: closed now
    displacement: m, way of its pivot from where its points were given; with a motion by a function NaN, as angle and
        power, from set_motion() to the next advance
    angle: rad, by which it has turned about it
    power: W, of its reaction: what it puts into the bodies through lasting contacts"""
    _fields_ = [("struct_size", c_size_t), ("reaction", c_double * 3), ("point", c_double * 3),
                ("impulse", c_double * 3), ("friction_impulse", c_double * 3), ("n_contacts", c_int64),
                ("displacement", c_double * 3), ("angle", c_double), ("power", c_double)]


class dem_boundary_load(SizedStructure):
    """What a boundary does to its nodes.
    struct_size: to be set to sizeof(dem_boundary_load)
    force: N, on its nodes now: given, or what the prescribed motion takes; where an external force adds to that, NaN
        before the first advance, and from set_motion() to the next
    displacement: m, mean way of its nodes from where they started"""
    _fields_ = [("struct_size", c_size_t), ("force", c_double * 3), ("displacement", c_double * 3)]


class dem_counts(SizedStructure):
    """Fields of dem_counts.
    struct_size: to be set to sizeof(dem_counts)
    steps: accepted by the integrator
    rejected: by its error test
    evaluations: of the right-hand side (equation 4)
    events: resolved: each with DEM_CONTACT_LOCAL, with DEM_CONTACT_EXACT their times
    impacts: of nodes on segments and of edges on vertices
    vertex_impacts: of edges on vertices
    early: of all impacts, those taken together with another one within the window
    releases: closings, releases: contacts that began and ceased to last
    sticks: slips, sticks: lasting contacts that began to slide, that stopped or turned back
    passings: of a segment's or an edge's end by a lasting contact
    late: events that the root finder of DEM_CONTACT_EXACT had not seen, but the check of a step
    retries: attempts repeated with a smaller step after a non-finite force
    behind: nodes that have passed round the end of an open obstacle, or have come to the surface inside one, now
    crossings: steps rejected because surfaces of bodies crossed in them"""
    _fields_ = [("struct_size", c_size_t), ("steps", c_int64), ("rejected", c_int64), ("evaluations", c_int64),
                ("events", c_int64), ("impacts", c_int64), ("vertex_impacts", c_int64), ("early", c_int64),
                ("closings", c_int64), ("releases", c_int64), ("slips", c_int64), ("sticks", c_int64),
                ("passings", c_int64), ("late", c_int64), ("retries", c_int64), ("behind", c_int64),
                ("crossings", c_int64)]


class dem_strain(SizedStructure):
    """Extremes over the springs and triangles, at one instant.
    struct_size: to be set to sizeof(dem_strain)
    max: min, max: (d - d0)/d0
    spring_max: spring_min, spring_max: where; -1 without springs
    area_min: smallest area over rest area; 1 without triangles, < 0: inverted
    guarded: triangles on which the guard acts
    inverted: triangles of area <= 0"""
    _fields_ = [("struct_size", c_size_t), ("min", c_double), ("max", c_double), ("spring_min", c_int64),
                ("spring_max", c_int64), ("area_min", c_double), ("guarded", c_int64), ("inverted", c_int64)]


class dem_overlap(SizedStructure):
    """Bodies that run into each other, or into themselves, which only the option `bodies` prevents. Nodes on the
    boundary of the triangulation inside triangles of which they are no corners; looked for at the start and after
    every 16th accepted step, every 256th where bodies touch each other and themselves.
    struct_size: to be set to sizeof(dem_overlap)
    most: now, most: pairs of node and triangle when last looked at, and the most of a look
    t: s, of the first; 0 without one
    triangle: node, triangle: of the first; -1 without one
    x: m, where that node was"""
    _fields_ = [("struct_size", c_size_t), ("now", c_int64), ("most", c_int64), ("t", c_double), ("node", c_int64),
                ("triangle", c_int64), ("x", c_double * 3)]


class dem_surfaces(SizedStructure):
    """Contact of bodies with each other and with themselves now; without the option `bodies` nothing pushes.
    struct_size: to be set to sizeof(dem_surfaces)
    gap_min: m, smallest distance of a node from an edge that pushes it; infinity: none does
    gap_share: smallest distance over contact thickness; infinity: as above
    thickness_min: m, smallest and largest contact thickness of the bodies
    pushing: pairs of a node and an edge that push each other
    n_edges: boundary edges of all bodies
    left_out: pairs of a node and an edge of one body that never push each other, as they are nearer than the contact
        thickness at rest: in notches narrower than that
    modulus_min: N/m, smallest and largest contact modulus of the bodies; two bodies push each other with the smaller
        one of theirs
    pressure_share: largest pressure between surfaces over their contact modulus, (1 - u)^2/u for u = gap_share: 0.05 at
        u = 0.8, 0.5 at u = 0.5; 0: nothing pushes
    friction_min: coefficient of friction of the bodies with each other, of two the smaller: the smallest
    friction_max: and the largest one"""
    _fields_ = [("struct_size", c_size_t), ("gap_min", c_double), ("gap_share", c_double), ("thickness_min", c_double),
                ("thickness_max", c_double), ("pushing", c_int64), ("n_edges", c_int64), ("left_out", c_int64),
                ("modulus_min", c_double), ("modulus_max", c_double), ("pressure_share", c_double),
                ("friction_min", c_double), ("friction_max", c_double)]


class dem_pair(SizedStructure):
    """A node and a boundary edge that push each other. Where a surface is concave two edges push a node, and the vertex
    between them takes back what would count twice: the forces of the two together have a meaning.
    struct_size: to be set to sizeof(dem_pair)
    node: that is pushed
    edge: ends of the edge, which runs with its body on the left
    body: of the node
    other_body: of the edge; the same where a body touches itself
    x: m, place of the edge nearest to the node
    normal: unit, from there to the node
    gap: m, distance of the node from there
    thickness: m, contact thickness of the two bodies, below which they push
    force: N, on the node, without friction; the edge feels the opposite
    friction: N, on the node; the edge feels the opposite
    slides: 1: the node slides along the surfaces of the other body, friction is all that its coefficient allows; 0: it
        holds, or there is none"""
    _fields_ = [("struct_size", c_size_t), ("node", c_int64), ("edge", c_int64 * 2), ("body", c_int64),
                ("other_body", c_int64), ("x", c_double * 3), ("normal", c_double * 3), ("gap", c_double),
                ("thickness", c_double), ("force", c_double * 3), ("friction", c_double * 3), ("slides", c_int32)]


class dem_fracture(SizedStructure):
    """How much is broken, and into what.
    struct_size: to be set to sizeof(dem_fracture)
    triangles: that are broken
    springs: of which nothing is left
    fragments: as dem_simulation_fragments() has them
    largest: share of the mass that the largest fragment has
    debris: share of the mass in fragments of a single node
    median: kg, mass of the fragment with which, from the smallest on, half of all is reached: d50
    crack_length: m, sum of sqrt(A/sqrt(3)) over the broken triangles, A the area at rest: what a row of equilateral
        triangles of that area is long
    buried: nodes that were inside an obstacle when they came to the surface: they touch it only once they have come out
    buried_node: the first of them; -1 without one
    buried_t: s, and when,
    buried_x: m, and where that was; 0 without one"""
    _fields_ = [("struct_size", c_size_t), ("triangles", c_int64), ("springs", c_int64), ("fragments", c_int64),
                ("largest", c_double), ("debris", c_double), ("median", c_double), ("crack_length", c_double),
                ("buried", c_int64), ("buried_node", c_int64), ("buried_t", c_double), ("buried_x", c_double * 3)]


# ---- dem/observer.h

dem_observer_frame = CFUNCTYPE(c_int, c_void_p, POINTER(dem_simulation))

dem_observer_step = CFUNCTYPE(c_int, c_void_p, POINTER(dem_simulation))

dem_observer_event = CFUNCTYPE(c_int, c_void_p, POINTER(dem_simulation), POINTER(dem_event))

dem_observer_checkpoint = CFUNCTYPE(c_int, c_void_p, POINTER(dem_simulation), POINTER(dem_checkpoint))


class dem_break(SizedStructure):
    """A triangle, or a spring that no triangle holds, has broken. Breaks are the library's: a program reads of them
    what its header knows, and struct_size tells what there is.
    struct_size: bytes that the library has filled
    t: s
    triangle: its number in the lattice; -1: a spring
    spring: likewise; -1: a triangle, with what it gave to its springs
    body: of its nodes
    x: m, mean place of its nodes then
    stress: Pa, of a triangle the mean of its corners' stresses just before: xx, yy, xy; 0 of a spring
    energy: J, that it had. Elements that break at one instant are taken in their order: what several of them hold goes
        with the last
    fragment_new: the fragment that it has split off, by its lowest node then; of several the lowest; -1: none. Elements
        that break at one instant are taken in their order, here too"""
    _fields_ = [("struct_size", c_size_t), ("t", c_double), ("triangle", c_int64), ("spring", c_int64),
                ("body", c_int64), ("x", c_double * 3), ("stress", c_double * 3), ("energy", c_double),
                ("fragment_new", c_int64)]

dem_observer_broken = CFUNCTYPE(c_int, c_void_p, POINTER(dem_simulation), POINTER(dem_break))


class dem_observer(SizedStructure):
    """Called during dem_simulation_advance(), in the order of time; any callback may be NULL. A status other than
    DEM_OK ends the advance and is returned by it.
    struct_size: to be set to sizeof(dem_observer)
    interval: s between frames, the first at t = 0; <= 0: no frames
    context: after every accepted step and at t = 0
    step_every: > 0: `step` is called after accepted steps whose number since the start of the run is a multiple of
        this, and at t = 0
    step_interval: s, > 0: and after the first accepted step at or behind each multiple of this. Where both are 0 it is
        called after every accepted step. Between calls the run may take steps that nobody sees, which take less time;
        its results have the same bits
    step_touching: not 0: besides after every accepted step in which something touches: in which contacts with obstacles
        change, or at whose end one is closed or surfaces of bodies push each other. And before the contact events of a
        step with the state from which it goes, unless that has been shown; a resumed run may show that of its
        checkpoint once more. After every step where bodies are rigid, and if an MPI rank leads the run"""
    _fields_ = [("struct_size", c_size_t), ("interval", c_double), ("frame", dem_observer_frame),
                ("step", dem_observer_step), ("event", dem_observer_event), ("checkpoint", dem_observer_checkpoint),
                ("context", c_void_p), ("broken", dem_observer_broken), ("step_every", c_int64),
                ("step_interval", c_double), ("step_touching", c_int64)]


class dem_node_peak(Structure):
    """Where and when a node was stressed most.
    von_mises: Pa, the largest so far; 0: none
    t: s, when
    stress: Pa, at that instant: xx, yy, xy"""
    _fields_ = [("von_mises", c_double), ("t", c_double), ("stress", c_double * 3)]


class dem_spring_peak(Structure):
    """Fields of dem_spring_peak.
    strain: that of the largest size so far, with its sign
    t: s, when"""
    _fields_ = [("strain", c_double), ("t", c_double)]


# ---- dem/shape.h


class dem_outline_kind(IntEnum):
    """Values of dem_outline_kind."""
    DEM_OUTLINE_RECTANGLE = 0
    DEM_OUTLINE_DISC = 1
    DEM_OUTLINE_RING = 2
    DEM_OUTLINE_POLYGON = 3

DEM_OUTLINE_MAX_POINTS = 10000

DEM_IMAGE_MAX_SIDE = 32768


class dem_grid(IntEnum):
    """What lattices are made of."""
    DEM_GRID_TRIANGLES = 0
    DEM_GRID_SQUARES = 1


class dem_edge(IntEnum):
    """What becomes of nodes near edges."""
    DEM_EDGE_STEPPED = 0
    DEM_EDGE_SMOOTH = 1

DEM_PORES_MAX = 10000


class dem_pore_radii(IntEnum):
    """How radii of pores are distributed."""
    DEM_PORE_RADII_UNIFORM = 0
    DEM_PORE_RADII_LOGNORMAL = 1
    DEM_PORE_RADII_NORMAL = 2


class dem_outline(SizedStructure):
    """A plane figure in its place. Members that its kind does not use are not looked at.
    struct_size: to be set to sizeof(dem_outline), in each of an array
    centre: m: of a rectangle, a disc, a ring; of a polygon how far its points are shifted
    angle: radians: by which a rectangle is turned about its centre, a polygon about the origin of its points, before it
        is shifted
    size: m, > 0: width and height of a rectangle
    radius: m, > 0: of a disc, or the outer one of a ring
    inner_radius: m, > 0, < radius: of the hole of a ring
    n_points: of a polygon, 3 to DEM_OUTLINE_MAX_POINTS; the last may be the first once more
    points: [n_points][2], m, in either sense, consecutive ones distinct; the caller's, only read"""
    _fields_ = [("struct_size", c_size_t), ("kind", c_int), ("centre", c_double * 2), ("angle", c_double),
                ("size", c_double * 2), ("radius", c_double), ("inner_radius", c_double), ("n_points", c_int64),
                ("points", POINTER(c_double))]


class dem_image(SizedStructure):
    """A body drawn in pixels. The origin is the middle of the lower edge.
    struct_size: to be set to sizeof(dem_image)
    height: width, height: pixels, 1 to DEM_IMAGE_MAX_SIDE
    pixel: m, > 0: side of a pixel
    solid: [height][width] not 0: material; the top row first; the caller's, only read"""
    _fields_ = [("struct_size", c_size_t), ("width", c_int64), ("height", c_int64), ("pixel", c_double),
                ("solid", POINTER(c_ubyte))]


class dem_shape(SizedStructure):
    """What is to be triangulated: an outline or an image, less voids and pores. All is in one system of coordinates.
    struct_size: to be set to sizeof(dem_shape)
    outline: the body's edge; NULL for an image
    image: NULL for an outline
    spacing: m, > 0: length of the sides of triangles or squares; not more than the width and the height of the body,
        the radius of a disc, the wall of a ring
    edge: smooth: neither with squares nor of an image
    n_voids: >= 0
    voids: [n_voids] that are not material; they may overlap, and stick out of the body
    n_pores: >= 0
    pores: [n_pores][3] x, y and radius > 0 of round voids, m: see dem_shape_place_pores()
    numbered: true: `strength` of the lattice holds the numbers that its triangles had before anything was cut, and
        keeps them at further cuts. They are for dem_weibull.number: what is drawn for a place then does not depend on
        voids and cracks. To be taken out, and `strength` freed and set to NULL, before the lattice is assembled
    name: by which messages call it, such as "body 1"; NULL: "the shape"
    """
    _fields_ = [("struct_size", c_size_t), ("outline", POINTER(dem_outline)), ("image", POINTER(dem_image)),
                ("spacing", c_double), ("grid", c_int), ("edge", c_int), ("n_voids", c_int64),
                ("voids", POINTER(dem_outline)), ("n_pores", c_int64), ("pores", POINTER(c_double)),
                ("numbered", c_bool), ("name", c_char_p)]


class dem_shape_report(SizedStructure):
    """What came out beside the lattice.
    struct_size: to be set to sizeof(dem_shape_report)
    n_rim: of a smooth edge: nodes at it; else 0, as the next three
    n_off: of these nodes, those that could not be moved on to an edge
    n_cut: corners that no node is near, so that they are cut off
    farthest: m, that the worst of the n_off nodes is off its edge
    idle_void: after a failure too: the void, from 0, that takes nothing of the body; else -1"""
    _fields_ = [("struct_size", c_size_t), ("n_rim", c_int64), ("n_off", c_int64), ("n_cut", c_int64),
                ("farthest", c_double), ("idle_void", c_int64)]


class dem_pores(SizedStructure):
    """Round pores of random sizes at random places.
    struct_size: to be set to sizeof(dem_pores)
    number: 0 to DEM_PORES_MAX; 0: as many as the area needs
    area: m^2, >= 0: of all pores where number is 0, such as a porosity times dem_shape_area(); they miss it by at most
        half of the last one's
    radius_min: m, > 0: no smaller one is drawn, and no larger one than the next
    radius_max: m, >= radius_min
    deviation: mean, deviation: m, > 0: of all numbers drawn, those beyond included; not of a uniform distribution
    wall: m, >= 0: least material between two pores, and between a pore and an edge
    seed: below 2^32 counts; 0 is as 4357"""
    _fields_ = [("struct_size", c_size_t), ("number", c_int64), ("area", c_double), ("radius_min", c_double),
                ("radius_max", c_double), ("distribution", c_int), ("mean", c_double), ("deviation", c_double),
                ("wall", c_double), ("seed", c_uint64)]


class dem_mesh(SizedStructure):
    """A mesh by Gmsh: MSH 4.1, text, with triangles of 3 nodes in the plane z = 0; `gmsh -2 -format msh41` writes it.
    Points and lines among its elements are passed over.
    struct_size: to be set to sizeof(dem_mesh)
    path: of its file, a regular one of 1 GiB at most; NULL for a text
    text: [size] what would be in the file, any bytes, without a zero at the end; NULL for a path
    size: bytes of the text, >= 0
    scale: m, > 0: length of 1 in its coordinates
    numbered: as in dem_shape"""
    _fields_ = [("struct_size", c_size_t), ("path", c_char_p), ("text", c_char_p), ("size", c_int64),
                ("scale", c_double), ("numbered", c_bool)]


# ---- dem/slab.h


class dem_slab(SizedStructure):
    """What a range of the nodes of a whole lattice has of it: these nodes, its *own* ones, the nodes that share a
    triangle or a spring with one of them, its *rim*, and the triangles at own nodes. Both have the order of the
    whole, own nodes without gaps, and triangles too, but for some slabs of files and of smooth edges. The lattice is
    assembled and edited as any other, by functions that look at nodes and triangles one by one
    (dem_lattice_assemble(), and dem_lattice_inside() with dem_lattice_assemble_mixed(); dem_lattice_move(),
    dem_lattice_launch(), dem_lattice_spin_about(), dem_lattice_exclude(); dem_lattice_weibull() with numbers). Own
    nodes, and springs and triangles at them, then have the bits that they have in the whole. Of the rim only places
    and bodies have: masses, flags, and springs between two of its nodes, lack what other ranges have of them.
    Numbers in messages are those of the slab.
    struct_size: set by dem_slab_empty()
    n_nodes: of the whole,
    n_triangles: likewise
    first_node: the number in the whole of the first own node; the others follow it there
    first_triangle: the number in the whole of triangle 0 of `lattice`; the others follow it there. In slabs of files
        and of smooth edges it is -1 if they do not, or if there are none
    first_own: in `lattice`, of the n_own nodes that are own ones, one behind the other
    n_own: > 0
    rim: [lattice.n_nodes - n_own] numbers in the whole of the other nodes of `lattice`, ascending
    rim_boundary: [the same] 1: on the boundary of the triangles of the whole, where dem_slab_jitter() leaves it; NULL:
        not known
    lattice: all is to be freed with dem_slab_free()"""
    _fields_ = [("struct_size", c_size_t), ("n_nodes", c_int64), ("n_triangles", c_int64), ("first_node", c_int64),
                ("first_triangle", c_int64), ("first_own", c_int64), ("n_own", c_int64), ("rim", POINTER(c_int64)),
                ("rim_boundary", POINTER(c_ubyte)), ("lattice", dem_lattice)]


def dem_slab_default() -> dem_slab:
    """A dem_slab with its defaults."""
    value = dem_slab()
    value.lattice = dem_lattice_default()
    return value


# ---- dem/dem.h


# ---- dem/reader.h


class dem_reader_type(IntEnum):
    """What numbers are in the file; all are read as double, to which a 64-bit integer beyond 2^53 is rounded."""
    DEM_READER_F64 = 0
    DEM_READER_F32 = 1
    DEM_READER_I64 = 2
    DEM_READER_I32 = 3
    DEM_READER_I8 = 4
    DEM_READER_U8 = 5


class dem_reader_array(Structure):
    """An array shown on the lattice: of nodes or springs, one for each frame or the same in all.
    name: as in the file: "velocity", "stress", "von_mises", "strain", "force", "body", ...
    unit: "m/s", "Pa", ...; "1" of a ratio; "" of a number that counts or names, or of one unknown
    type: in the file
    of_springs: true: [n_springs][components]; false: [n_nodes][components]
    components: 1 to 9; vectors have 3, z = 0; symmetric tensors 6: xx yy zz xy yz xz
    constant: true: the same in all frames, as "id", "body" and "peak_von_mises"
    """
    _fields_ = [("name", c_char_p), ("unit", c_char_p), ("type", c_int), ("of_springs", c_bool), ("components", c_int),
                ("constant", c_bool)]


class dem_reader_column(Structure):
    """A column of a table: "history", "events", "breaks", "probes/NAME", "most_stressed/nodes",
    "most_stressed/springs", "fragments", which has a row for each fragment in each frame, and "frames", which has
    one for each frame: energies and contacts.
    unit: as of arrays
    type: in the file
    n_rows: the same in all columns of a table
    items: of a row: bodies, obstacles or boundaries of "history"; else 1
    components: of an item: 2 of a vector, 3 of a stress: xx yy xy
    width: numbers in a row: items * components"""
    _fields_ = [("table", c_char_p), ("name", c_char_p), ("unit", c_char_p), ("type", c_int), ("n_rows", c_int64),
                ("items", c_int64), ("components", c_int64), ("width", c_int64)]


# ---- dem/trajectory.h

DEM_FIELD_DISPLACEMENT = 1
DEM_FIELD_VELOCITY = 2
DEM_FIELD_STRESS = 4
DEM_FIELD_VON_MISES = 8
DEM_FIELD_PRINCIPAL = 16
DEM_FIELD_STRAIN = 32
DEM_FIELD_FORCE = 64
DEM_FIELD_CONTACT = 128
DEM_FIELD_FRAGMENT = 256
DEM_FIELD_DAMAGE = 512
DEM_FIELD_ALL = 1023


class dem_probe_kind(IntEnum):
    """Values of dem_probe_kind."""
    DEM_PROBE_NODE = 0
    DEM_PROBE_SPRING = 1
    DEM_PROBE_GAUGE = 2


class dem_probe(Structure):
    """What is recorded over time in the table /probes/NAME, at t = 0 and at every `every`-th accepted step.
    name: 1 to 63 letters, digits, _ and -; of no other probe
    number: of the node or spring; of a gauge's two nodes, which are apart at rest
    every: >= 1"""
    _fields_ = [("name", c_char_p), ("kind", c_int), ("number", c_int64 * 2), ("every", c_int64)]


class dem_trajectory_options(SizedStructure):
    """Fields of dem_trajectory_options.
    struct_size: set by dem_trajectory_options_default()
    frame_interval: s between frames; <= 0: none, only the history
    double_precision: false: displacement, velocity, strain, force in single precision; true: in double
    deflate: compression 0 (none) to 9; default 1
    events: true: the table /events of all contact events; default false
    fields: DEM_FIELD_... ORed; default all but DEM_FIELD_PRINCIPAL, _CONTACT, _FRAGMENT
    peaks: written by dem_trajectory_finish(), until when they are borrowed; default NULL: none
    most_stressed: nodes and springs of the peaks that are listed; default 5
    n_probes: default 0
    probes: [n_probes] copied
    breaks: true: the table /breaks of all that breaks, and columns of /history; default false
    fragments: true: the table /fragments, of each frame; default false
    history_interval: s, at least, between rows of /history, which are accepted steps; default 0: each is
    stays_open: true: the part is whole in the file system after every frame, but stays open in this process, where
        nothing else opens it then; takes half the time of a small frame; default false
    writers: more than 1: arrays of frames are in so many files beside each file, which other ranks write of a run that
        rank 0 leads (dem_batch --writers), of which there are as many at least; the simulation then outlives the
        trajectory. What has the name of one and was not begun by a run of this lattice stays, and is DEM_ERROR_IO at
        the start. Default 0, as 1: they are in the file itself"""
    _fields_ = [("struct_size", c_size_t), ("frame_interval", c_double), ("double_precision", c_bool),
                ("deflate", c_int), ("events", c_bool), ("fields", c_uint32), ("peaks", POINTER(dem_peaks)),
                ("most_stressed", c_int64), ("n_probes", c_int64), ("probes", POINTER(dem_probe)), ("breaks", c_bool),
                ("fragments", c_bool), ("history_interval", c_double), ("stays_open", c_bool), ("writers", c_int)]


def dem_trajectory_options_default() -> dem_trajectory_options:
    """A dem_trajectory_options with its defaults."""
    value = dem_trajectory_options()
    value.deflate = 1
    value.most_stressed = 5
    value.fields = DEM_FIELD_ALL & ~(DEM_FIELD_PRINCIPAL | DEM_FIELD_CONTACT | DEM_FIELD_FRAGMENT | DEM_FIELD_DAMAGE)
    return value


FUNCTIONS: dict[str, tuple[Any, list[Any], str]] = {  # result, arguments, text
    "dem_status_name": (c_char_p, [c_int],
        """dem_status_name(status)
        "DEM_OK", "DEM_STOPPED" ...; NULL for a number that is none of them."""),
    "dem_status_message": (c_char_p, [],
        """dem_status_message()
        Text of the last failure in this thread; valid until the next failing call. Never NULL."""),
    "dem_version": (c_char_p, [],
        """dem_version()
        Library version, "MAJOR.MINOR.PATCH"."""),
    "dem_version_sundials": (c_char_p, [],
        """dem_version_sundials()
        Version of the SUNDIALS library in use, "MAJOR.MINOR.PATCH"."""),
    "dem_checkpoint_create": (c_int, [POINTER(POINTER(dem_checkpoint))],
        """dem_checkpoint_create(out)
        An empty one."""),
    "dem_checkpoint_destroy": (None, [POINTER(dem_checkpoint)],
        """dem_checkpoint_destroy(checkpoint)
        Accepts NULL."""),
    "dem_checkpoint_put": (c_int, [POINTER(dem_checkpoint), c_char_p, c_void_p, c_size_t],
        """dem_checkpoint_put(checkpoint, name, data, size)
        Copies `size` bytes into the entry of this name, which is made or replaced.
        name 1 to 31 characters
        Returns DEM_ERROR_MEMORY, then the entry is as it was"""),
    "dem_checkpoint_get": (c_int, [POINTER(dem_checkpoint), c_char_p, c_void_p, c_size_t],
        """dem_checkpoint_get(checkpoint, name, data, size)
        Copies an entry out; the address may be that of any type without pointers.
        Returns DEM_ERROR_IO if there is none of this name, or if it does not have `size` bytes"""),
    "dem_checkpoint_find": (c_void_p, [POINTER(dem_checkpoint), c_char_p, POINTER(c_size_t)],
        """dem_checkpoint_find(checkpoint, name, size)
        The bytes of an entry, aligned for any type, until it is put again; NULL if there is none.
        size their number"""),
    "dem_checkpoint_write": (c_int, [POINTER(dem_checkpoint), c_char_p],
        """dem_checkpoint_write(checkpoint, path)
        Writes a file: a temporary one beside it is synced and read back, the older file of this name becomes
        `path`.prev, and the new one takes its name. Whatever fails, and whenever the process or the machine stops,
        one of both is there and whole.
        Returns DEM_ERROR_IO with the file and the cause"""),
    "dem_checkpoint_read": (c_int, [POINTER(POINTER(dem_checkpoint)), c_char_p],
        """dem_checkpoint_read(out, path)

        Returns DEM_ERROR_IO with the file and the reason: not there, no checkpoint, of another format, damaged"""),
    "dem_publish": (c_int, [c_char_p, c_char_p],
        """dem_publish(part, path)
        Syncs the closed file `part`, renames it to `path` and syncs the folder."""),
    "dem_lattice_free": (None, [POINTER(dem_lattice)],
        """dem_lattice_free(lattice)
        Frees the arrays and leaves an empty lattice. Accepts NULL, and does nothing where there is no struct_size."""),
    "dem_lattice_rectangle": (c_int, [POINTER(dem_lattice), c_double, c_double, c_double],
        """dem_lattice_rectangle(out, width, height, spacing)
        Equilateral triangulation of a rectangle standing on the origin: -width/2 <= x <= width/2, 0 <= y <= height.
        Rows alternate between round(width/spacing) + 1 nodes and one less, so that it is mirror symmetric; the
        spacing is kept and the height rounded to whole rows. Nodes and triangles only: dem_lattice_assemble() makes
        it a solid.
        out from dem_lattice_empty(); overwritten, not freed; caller owns it
        Returns DEM_ERROR_ARGUMENT unless 0 < spacing <= width, height; DEM_ERROR_MEMORY"""),
    "dem_lattice_squares": (c_int, [POINTER(dem_lattice), c_double, c_double, c_double],
        """dem_lattice_squares(out, width, height, spacing)
        The same of square cells: round(width/spacing) x round(height/spacing) of them, each of two triangles, 2 k
        and 2 k + 1, whose common sides turn from cell to cell. dem_lattice_assemble_squares() makes it a solid. What
        cuts it should take both triangles of a cell or none. Otherwise as dem_lattice_rectangle()."""),
    "dem_lattice_disc": (c_int, [POINTER(dem_lattice), c_double, c_double],
        """dem_lattice_disc(out, radius, spacing)
        Equilateral triangulation of a disc about the origin, with a node at its centre. Otherwise as
        dem_lattice_rectangle(), with 0 < spacing <= radius."""),
    "dem_lattice_cut": (c_int, [POINTER(dem_lattice), dem_lattice_cut_keep, c_void_p],
        """dem_lattice_cut(lattice, keep, context)
        Removes the nodes for which `keep` returns false, the triangles that lose a corner, and nodes left without a
        triangle. For triangulations not yet assembled; a lattice that has springs is refused.
        Returns DEM_ERROR_MODEL if nothing is left"""),
    "dem_lattice_trim": (c_int, [POINTER(dem_lattice), POINTER(c_bool)],
        """dem_lattice_trim(lattice, keep)
        Keeps the triangles for which keep[t], and the nodes that have one of them. For triangulations not yet
        assembled; a lattice that has springs is refused.
        keep [n_triangles]
        Returns DEM_ERROR_MODEL if nothing is left"""),
    "dem_lattice_pieces": (c_int, [POINTER(dem_lattice), POINTER(c_int64), POINTER(c_int64)],
        """dem_lattice_pieces(lattice, n_pieces, piece)
        Number of pieces of a triangulation. Triangles that share an edge are of one piece; those that share but a
        node, a hinge, are not.
        piece [n_triangles] the piece of each triangle, numbered by their lowest ones; may be NULL"""),
    "dem_lattice_rims": (c_int, [POINTER(dem_lattice), POINTER(c_int64)],
        """dem_lattice_rims(lattice, n_edges)
        Number of boundary edges at each node: 0 inside and without triangles, 2 on the boundary, more at a hinge.
        n_edges [n_nodes]"""),
    "dem_lattice_assemble": (c_int, [POINTER(dem_lattice), POINTER(dem_material)],
        """dem_lattice_assemble(lattice, material)
        Springs, masses and what triangles have, by the finite-element rule: a triangle of area A gives each edge e
        the stiffness (8/3) G h A/|e|^2 times the edge's length, in N, and each corner a third of its mass; its area
        stiffness is (lambda - G) h. G = E/(2 (1 + nu)) and lambda = E nu/(1 - nu^2) are those of plane stress; a
        solid in plane strain is a plate of E/(1 - nu^2) and nu/(1 - nu). A block of equilateral triangles then has
        exactly E and nu. With coupled springs the triangles that are not equilateral get other stiffnesses, and
        couplings, such that any block of triangles has exactly E and nu. With a damping time each spring gets the
        viscosity damping_time times its stiffness. A strength and a critical stretch are written beside every
        triangle and spring; without a strength those that the lattice has stay. (1) With a compressive strength the
        confinement is what the plane makes it: see dem_lattice.
        Returns DEM_ERROR_ARGUMENT where triangles are too large for their strength and fracture energy: the edge of
        an equilateral one of their mean area may be E G_f/(3.4 strength^2) at most, where their own stress breaks
        them E G_f/(1.64 strength^2)"""),
    "dem_lattice_assemble_squares": (c_int, [POINTER(dem_lattice), POINTER(dem_material), c_double],
        """dem_lattice_assemble_squares(lattice, material, diagonal)
        The same for cells of two triangles each, 2 k and 2 k + 1, that make a convex quadrilateral; both its
        diagonals are springs. A cell gives half of E h/(1 + nu) to each side, `diagonal` times E h/(1 + nu) to both
        diagonals, and each corner of a square a quarter of its mass. A block of squares then has exactly E and nu
        along its sides, and the shear stiffness diagonal E/(1 + nu): 0.5 is isotropic, and nu = diagonal/(1 +
        diagonal) needs no area term.
        diagonal stiffness of a diagonal over that of a side, both in N/m, > 0 and less than (1 + nu)/(2 (1 - nu)),
        or cells warp; usual: 0.5, for nu > 0. Not used with a bond stiffness
        Returns as dem_lattice_assemble(); sides of squares may be E G_f/(3.55 strength^2) at most"""),
    "dem_lattice_assemble_mixed": (c_int, [POINTER(dem_lattice), POINTER(dem_material), c_int64, POINTER(c_int64),
                                           c_double],
        """dem_lattice_assemble_mixed(lattice, materials, n_materials, of, diagonal)
        The same of several materials. Every triangle gives stiffness, mass and damping by its own; so a spring
        between two materials is half of one and half of the other, and they hold together. A bond stiffness is for
        one material only.
        materials [n_materials]
        of [n_triangles] number of each triangle's material, from 0, the same for both triangles of a cell; NULL: the
        first
        diagonal of cells, as in dem_lattice_assemble_squares(); 0: triangles"""),
    "dem_lattice_weibull": (c_int, [POINTER(dem_lattice), POINTER(dem_weibull), c_int64, POINTER(c_int64),
                                    POINTER(c_double), POINTER(c_double)],
        """dem_lattice_weibull(lattice, laws, n_laws, of, triangle_factor, spring_factor)
        Draws factors of strengths and critical stretches for dem_lattice_weaken(), which are the caller's to bound:
        ((V_0/V) (-ln u))^(1/m), with u uniform in (0, 1) by seed, body and number alone, the same bits on every
        machine. V is the volume of a triangle, thickness times area in the rest shape. Each triangle gives its
        volume to the springs that it holds in equal parts; what they have of it is the volume of springs.
        laws [n_laws]
        of [n_triangles] number of each triangle's law, from 0; NULL: the first. A spring between two laws has the
        smaller factor of both
        triangle_factor [n_triangles]; may be NULL
        spring_factor [n_springs]; may be NULL
        Returns DEM_ERROR_ARGUMENT for a law that is none, DEM_ERROR_MODEL where a triangle or a spring has no
        volume; factors are then of no meaning"""),
    "dem_lattice_weaken": (c_int, [POINTER(dem_lattice), POINTER(c_double), POINTER(c_double), POINTER(c_double)],
        """dem_lattice_weaken(lattice, strength_factor, energy_factor, stretch_factor)
        Multiplies strengths, fracture energies and critical stretches by factors > 0, as dem_lattice_weibull() draws
        them. The compressive strength of a triangle has the factor of its strength. Only triangles that soften have
        an energy of their own: with another strength or energy they get another softening. One that would have to be
        stronger than a brittle triangle of its energy is brittle, and as strong as that; one that its own stress
        lets soften does so by 3 at least.
        strength_factor [n_triangles]; NULL: 1
        energy_factor [n_triangles]; NULL: 1
        stretch_factor [n_springs]; NULL: 1
        Returns DEM_ERROR_ARGUMENT; then nothing has changed"""),
    "dem_lattice_jitter": (c_int, [POINTER(dem_lattice), c_double, c_uint64],
        """dem_lattice_jitter(lattice, radius, seed)
        Moves every node that is not on the boundary of the triangles to a random place within `radius`, m, >= 0, of
        it, the same on every machine. Where a triangle would keep less than a tenth of its area, its corners go half
        as far. For triangulations not yet assembled; a lattice that has springs is refused."""),
    "dem_lattice_parts": (c_int, [POINTER(dem_lattice), POINTER(c_int64), POINTER(c_int64)],
        """dem_lattice_parts(lattice, n_parts, part)
        Number of parts that springs do not connect.
        part [n_nodes] the part of each node, numbered by their lowest nodes; may be NULL"""),
    "dem_lattice_select": (c_int, [POINTER(dem_lattice), POINTER(c_bool)],
        """dem_lattice_select(lattice, keep)
        Keeps the nodes for which keep[i], with the springs and triangles among them.
        keep [n_nodes]"""),
    "dem_lattice_move": (None, [POINTER(dem_lattice), c_double, POINTER(c_double)],
        """dem_lattice_move(lattice, angle, offset)
        Turns the lattice by `angle` (radians, about the origin) and shifts it; initial positions and velocities turn
        too."""),
    "dem_lattice_launch": (c_int, [POINTER(dem_lattice), POINTER(c_double)],
        """dem_lattice_launch(lattice, velocity)
        Adds `velocity` (m/s) to the initial velocity of every node."""),
    "dem_lattice_spin": (c_int, [POINTER(dem_lattice), c_double],
        """dem_lattice_spin(lattice, angular_velocity)
        Adds a rigid rotation about the centre of mass, where the nodes start, to the initial velocities. That centre
        is the sum of m_i x_i, in the order of the nodes, times 1/(the sum of m_i).
        angular_velocity rad/s, counter-clockwise
        Returns DEM_ERROR_MODEL without masses: dem_lattice_assemble() comes first"""),
    "dem_lattice_spin_about": (c_int, [POINTER(dem_lattice), c_double, POINTER(c_double)],
        """dem_lattice_spin_about(lattice, angular_velocity, centre)
        The same about a given place, to the same bits where that is the centre of mass: for a part of a body, of
        which the part alone does not know it.
        centre m"""),
    "dem_lattice_exclude": (c_int, [POINTER(dem_lattice), POINTER(c_int64), c_int64],
        """dem_lattice_exclude(lattice, nodes, n)
        Takes nodes from contact: they may not touch obstacles, nor may the edges between them.
        nodes [n]"""),
    "dem_lattice_stiffen": (c_int, [POINTER(dem_lattice), c_int],
        """dem_lattice_stiffen(lattice, guide)
        Makes all bodies of the lattice rigid: their springs and triangles carry nothing, and bound no step. Rigid
        bodies need the option `bodies`, by which they touch other bodies; obstacles they meet with their whole
        surface by the same law, with the obstacles' friction (Coulomb's) and without restitution.
        guide how they may move"""),
    "dem_lattice_edge_shares": (c_int, [POINTER(dem_lattice), POINTER(c_int64), c_int64, POINTER(c_double),
                                        POINTER(c_double)],
        """dem_lattice_edge_shares(lattice, nodes, n, direction, area)
        What each of some nodes has of the boundary edges between them, half of each edge: by its length in the rest
        shape, or, along a unit `direction` [2], by the length of its projection on that, times the thickness of its
        triangle. For tractions: dem_boundary's share.
        nodes [n] distinct
        direction may be NULL
        area [n] m^2, sum over the nodes: area of the edges"""),
    "dem_lattice_append": (c_int, [POINTER(dem_lattice), POINTER(dem_lattice)],
        """dem_lattice_append(lattice, other)
        Appends a copy of `other`; its bodies are numbered after those of `lattice`."""),
    "dem_method_describe": (c_int, [POINTER(dem_method_traits), c_int],
        """dem_method_describe(out, method)

        Returns DEM_ERROR_ARGUMENT for an unknown method, and for one that the installed SUNDIALS does not have"""),
    "dem_method_find": (c_int, [POINTER(c_int), c_char_p],
        """dem_method_find(out, name)
        The method of a name, in this SUNDIALS or not.
        Returns DEM_ERROR_ARGUMENT if there is none"""),
    "dem_method_growth": (c_double, [c_int, c_double],
        """dem_method_growth(method, omega_h)
        Modulus of the largest eigenvalue of a step h of x'' = -omega^2 x; NAN if dem_method_describe() fails."""),
    "dem_motion_field_at": (POINTER(dem_motion_field), [c_int64],
        """dem_motion_field_at(k)
        Field k of those of all ways to move; NULL beyond the last. What an obstacle does in several ways adds up."""),
    "dem_obstacle_moves": (c_bool, [POINTER(dem_obstacle), POINTER(dem_motion_field)],
        """dem_obstacle_moves(obstacle, by)
        Whether an obstacle moves in the way that a field is of, or in any (NULL)."""),
    "dem_obstacle_points": (c_int, [POINTER(dem_obstacle), c_double, POINTER(c_double)],
        """dem_obstacle_points(obstacle, t, points)
        Where the points of an obstacle are at t.
        points [n_points][2], m; may be those of the obstacle"""),
    "dem_obstacle_velocity": (c_int, [POINTER(dem_obstacle), c_double, POINTER(c_double), POINTER(c_double)],
        """dem_obstacle_velocity(obstacle, t, x, velocity)
        Velocity of the point of an obstacle that is at x at t.
        velocity [2] m/s"""),
    "dem_obstacle_check": (c_int, [POINTER(dem_obstacle), POINTER(c_int64)],
        """dem_obstacle_check(obstacle, segments)
        Whether dem_model_create() takes the obstacle: its message otherwise, in which the obstacle has the number 0.
        segments two of it that meet, the second following the first if it goes back over it; else -1"""),
    "dem_model_create": (c_int, [POINTER(POINTER(dem_model)), POINTER(dem_lattice), POINTER(dem_obstacle), c_int64],
        """dem_model_create(out, lattice, obstacles, n_obstacles)
        Validates, copies and compiles. Lattice and obstacles may be freed afterwards. Node order is kept.
        Returns DEM_ERROR_MODEL with the first offending node, spring, triangle or segment named"""),
    "dem_model_create_borrowing": (c_int, [POINTER(POINTER(dem_model)), POINTER(dem_lattice), POINTER(dem_obstacle),
                                           c_int64],
        """dem_model_create_borrowing(out, lattice, obstacles, n_obstacles)
        The same without a copy of the lattice, whose arrays have to outlive the model and to stay as they are, but
        for its velocities, which are copied. Before there is a simulation of the model its nodes may be moved all
        together: what the model says of obstacles does not depend on them.
        Returns as dem_model_create()"""),
    "dem_model_destroy": (None, [POINTER(dem_model)],
        """dem_model_destroy(model)
        Accepts NULL. Destroy its simulations first."""),
    "dem_model_csr": (c_int, [POINTER(dem_model), POINTER(dem_csr)],
        """dem_model_csr(model, out)
        The arrays are made at the first call, for all later ones, too, and take some 200 bytes a node of a lattice
        of triangles. Several threads may ask at once.
        Returns DEM_ERROR_MEMORY"""),
    "dem_model_lattice": (POINTER(dem_lattice), [POINTER(dem_model)],
        """dem_model_lattice(model)
        The lattice as the model holds it; a view, not to be freed or changed. `position` is x itself where the model
        was given none."""),
    "dem_model_obstacle": (POINTER(dem_obstacle), [POINTER(dem_model), c_int64],
        """dem_model_obstacle(model, obstacle)
        An obstacle as the model holds it; a view.
        obstacle 0 <= obstacle < n_obstacles; NULL, and a dem_status_message(), for any other"""),
    "dem_model_part": (c_int, [POINTER(dem_model), POINTER(c_int64), POINTER(POINTER(c_int64)),
                               POINTER(POINTER(c_ubyte))],
        """dem_model_part(model, n_nodes, number, is_own)
        Which nodes are here: node i of dem_model_lattice() and of dem_state. Views into the model.
        n_nodes here, of a model that ranks share (dem/mpi.h) with some nodes of other ranks
        number [n_nodes] in the whole lattice, ascending; NULL: all nodes are here
        is_own [n_nodes] 1: a node of this rank, 0: of another one; each is that of one rank. NULL: all are
        Returns DEM_ERROR_ARGUMENT for a NULL"""),
    "dem_model_sizes": (c_int, [POINTER(dem_model), POINTER(dem_model_size)],
        """dem_model_sizes(model, out)"""),
    "dem_model_spacing": (c_double, [POINTER(dem_model)],
        """dem_model_spacing(model)
        Shortest rest length, m; 0 without springs."""),
    "dem_model_omega_max": (c_double, [POINTER(dem_model)],
        """dem_model_omega_max(model)
        Rigorous upper bound of the highest angular frequency about the rest shape, rad/s; 0 without springs: omega^2
        <= max over nodes of |B_i| / m_i, B_i = 2 sum over springs of (E_ij/d0_ij) n n^T + 3 sum over triangles of
        max(kappa, 0)/A0 g g^T + C_i, g = dA/dx_i, |.| the largest eigenvalue. C_i is what coupled triangles add:
        docs/algorithms.md (The lattice)."""),
    "dem_model_omega": (c_int, [POINTER(dem_model), POINTER(c_double)],
        """dem_model_omega(model, omega)
        The highest angular frequency about the rest shape itself, rad/s, found by iteration from below, to 1e-6 of
        it or better; 0 without springs. It takes some hundred evaluations of the forces.
        Returns DEM_ERROR_MEMORY; DEM_ERROR_MODEL if it is not found in 2000 iterations"""),
    "dem_model_constants": (c_int, [POINTER(dem_model), c_int64, POINTER(dem_constants)],
        """dem_model_constants(model, body, out)
        Measures them by loading: every node on the boundary of the body's triangles, round its holes too, is
        displaced by a uniform strain, the nodes inside find their equilibrium, and the stress is the derivative of
        the energy over the volume of the triangles; three strains give C. It is the material's, not the structure's:
        a porous body is held at the rims of its pores. Exact for regular lattices, where the inside has no cause to
        move. Fixed nodes count as free.
        body 0 <= body < n_bodies
        Returns DEM_ERROR_MODEL for a body without triangles or whose inside is not stable; DEM_ERROR_ARGUMENT also
        for a model that several ranks share; DEM_ERROR_MEMORY"""),
    "dem_model_mass": (c_double, [POINTER(dem_model)],
        """dem_model_mass(model)
        Total mass, kg."""),
    "dem_model_volumes": (POINTER(c_double), [POINTER(dem_model)],
        """dem_model_volumes(model)
        What each node has of the solid's rest volume, m^3: a third of its triangles' areas times their thickness; 0
        where it is in no triangle. [n_nodes], a view, made at the first call; NULL without memory, and a
        dem_status_message()."""),
    "dem_model_gap": (c_double, [POINTER(dem_model), POINTER(c_double)],
        """dem_model_gap(model, x)
        Signed distance of a point to the nearest obstacle, m: > 0 in front, < 0 inside; infinity without obstacles.
        """),
    "dem_kernel_find": (c_int, [POINTER(c_int), c_char_p],
        """dem_kernel_find(out, name)
        The kernel of a name, as in decks: "avx2"; on this machine or not.
        Returns DEM_ERROR_ARGUMENT if there is none"""),
    "dem_kernel_name": (c_char_p, [c_int],
        """dem_kernel_name(kind)
        NULL if there is no such kernel."""),
    "dem_kernel_check": (c_int, [c_int],
        """dem_kernel_check(kind)

        Returns DEM_ERROR_ARGUMENT if this machine, or this build of the library, does not have the kernel"""),
    "dem_simulation_create": (c_int, [POINTER(POINTER(dem_simulation)), POINTER(dem_model), POINTER(dem_options)],
        """dem_simulation_create(out, model, options)
        Starts at t = 0 in the lattice's initial state. Touching an obstacle there is legal, deeper than the
        penetration tolerance is not: DEM_ERROR_MODEL names the node or the vertex. With contact of `bodies` so are
        surfaces that cross or are nearer than a twentieth of the contact thickness, and bodies without triangles.
        The model is borrowed and must outlive the simulation."""),
    "dem_simulation_resume": (c_int, [POINTER(POINTER(dem_simulation)), POINTER(dem_model), POINTER(dem_options),
                                      POINTER(dem_checkpoint)],
        """dem_simulation_resume(out, model, options, checkpoint)
        Goes on from a checkpoint of a simulation of the same model and options, whose further motion is repeated to
        the bit. Where ranks share the model (dem/mpi.h) any number of them may go on.
        checkpoint there on rank 0, and not looked at elsewhere
        Returns DEM_ERROR_IO if the checkpoint is of another model, or damaged"""),
    "dem_simulation_destroy": (None, [POINTER(dem_simulation)],
        """dem_simulation_destroy(simulation)
        Accepts NULL."""),
    "dem_simulation_advance": (c_int, [POINTER(dem_simulation), c_double],
        """dem_simulation_advance(simulation, t_end)
        Integrates (4) to t_end, with (9) and friction at every impact. The state there is interpolated, never
        stepped to, so a run to t1 continued to t2 is a run to t2.
        Returns DEM_STOPPED if an observer asked for it; DEM_ERROR_INTEGRATOR, DEM_ERROR_CONTACT with the last good
        state, and what the external force returned, or DEM_ERROR_INTEGRATOR if it is not finite, with that before
        the step in which it was asked for: another advance goes on from there"""),
    "dem_simulation_set_motion": (c_int, [POINTER(dem_simulation), POINTER(c_double), POINTER(c_double)],
        """dem_simulation_set_motion(simulation, x, v)
        Puts nodes elsewhere, or gives them other velocities, where the last advance has ended: not from an observer.
        Contacts are looked for at the next advance, as at the start, and until then there are none; then observers
        are shown the step, and a checkpoint is taken: an older one is of the motion that was. What it changes of the
        energy counts as put in from outside (`boundary`). Copies both.
        x [n_nodes][2] m, no deeper in obstacles than the penetration tolerance; NULL: as it is
        v [n_nodes][2] m/s; NULL: as it is. Fixed nodes keep both, as do prescribed components.
        Returns DEM_ERROR_ARGUMENT, DEM_ERROR_MODEL inside an obstacle or where surfaces of bodies cross; then
        nothing has changed"""),
    "dem_simulation_break": (c_int, [POINTER(dem_simulation), POINTER(c_int64), c_int64, POINTER(c_int64), c_int64],
        """dem_simulation_break(simulation, triangle, n_triangles, spring, n_springs)
        Breaks elements, for good, where the last advance has ended: not from an observer. A triangle takes along
        what it gave to its springs, so that what is left is the body without it; a spring is broken when all of its
        triangles are. Masses stay. Nodes and edges that come to the surface touch obstacles from then on, and bodies
        with the option `bodies`. The energy of what breaks counts as taken by `fracture`. What is over its limit in
        consequence breaks when the run goes on, at the same instant. Otherwise it goes on as after
        dem_simulation_set_motion(). What is broken already stays so; where all of it is nothing changes.
        triangle [n_triangles] numbers in the lattice; of cells both triangles should break
        spring [n_springs] numbers of springs that no triangle holds
        Returns DEM_ERROR_ARGUMENT for a number that is out of range, an element of a rigid body, or a spring that
        triangles hold, DEM_ERROR_MEMORY; then nothing has changed"""),
    "dem_simulation_checkpoint": (POINTER(dem_checkpoint), [POINTER(dem_simulation)],
        """dem_simulation_checkpoint(simulation)
        The last checkpoint, valid and unchanged until the next advance; NULL before the first, and after
        dem_simulation_set_motion(). Where ranks share the model rank 0 has that of all nodes, and the others have
        none."""),
    "dem_simulation_state": (c_int, [POINTER(dem_simulation), POINTER(dem_state)],
        """dem_simulation_state(simulation, out)
        What is seen of the motion now."""),
    "dem_simulation_progress": (c_int, [POINTER(dem_simulation), POINTER(dem_progress)],
        """dem_simulation_progress(simulation, out)
        The same without positions and velocities."""),
    "dem_simulation_gather": (c_int, [POINTER(dem_simulation), POINTER(c_double), POINTER(c_double)],
        """dem_simulation_gather(simulation, x, v)
        The motion that is seen of all nodes, on rank 0 where ranks share the model (dem/mpi.h); then all ranks call
        it.
        x [nodes of the whole lattice][dim] m; not looked at on other ranks than 0
        v the same, m/s
        Returns also DEM_ERROR_MEMORY"""),
    "dem_simulation_energy": (c_int, [POINTER(dem_simulation), POINTER(dem_energy)],
        """dem_simulation_energy(simulation, out)"""),
    "dem_simulation_strain": (c_int, [POINTER(dem_simulation), POINTER(dem_strain)],
        """dem_simulation_strain(simulation, out)"""),
    "dem_simulation_contact": (c_int, [POINTER(dem_simulation), c_int64, POINTER(dem_contact)],
        """dem_simulation_contact(simulation, contact, out)
        A closed contact.
        contact 0 <= contact < n_contacts of the dem_state of the same instant"""),
    "dem_simulation_strains": (c_int, [POINTER(dem_simulation), POINTER(c_double)],
        """dem_simulation_strains(simulation, strain)
        Strain (d - d0)/d0 of every spring.
        strain [n_springs], in the order of the lattice"""),
    "dem_simulation_forces": (c_int, [POINTER(dem_simulation), POINTER(c_double)],
        """dem_simulation_forces(simulation, force)
        Force (1) along every spring, with what couplings add to it, > 0 in tension; what damping adds is left out.
        force [n_springs] N, in the order of the lattice"""),
    "dem_simulation_force_at": (c_int, [POINTER(dem_simulation), c_int64, POINTER(c_double)],
        """dem_simulation_force_at(simulation, spring, out)
        The same of one spring.
        spring 0 <= spring < n_springs"""),
    "dem_simulation_broken": (c_int, [POINTER(dem_simulation), POINTER(c_ubyte), POINTER(c_ubyte)],
        """dem_simulation_broken(simulation, triangle, spring)
        What is broken; either may be NULL.
        triangle [n_triangles] 1: broken, else 0
        spring [n_springs] 1: none of the triangles that held it is whole, else 0"""),
    "dem_simulation_damage": (c_int, [POINTER(dem_simulation), POINTER(c_double), POINTER(c_double)],
        """dem_simulation_damage(simulation, triangle, node)
        Damage: what is gone of triangles in tension, 0 of one that is whole, 1 of one that is broken, and of nodes,
        the mean of their triangles by rest volume; 0 of a node without triangles. Each may be NULL.
        triangle [n_triangles]
        node [n_nodes]"""),
    "dem_simulation_fragments": (c_int, [POINTER(dem_simulation), POINTER(c_int64), POINTER(c_int64)],
        """dem_simulation_fragments(simulation, n_fragments, fragment)
        Fragments: nodes that springs join which are not broken; a node without such a spring is one of its own.
        Without breaks every connected body is one.
        n_fragments how many there are
        fragment [n_nodes] the lowest node of the fragment of each, whatever broke before"""),
    "dem_simulation_fracture": (c_int, [POINTER(dem_simulation), POINTER(dem_fracture)],
        """dem_simulation_fracture(simulation, out)

        Returns also DEM_ERROR_MEMORY"""),
    "dem_simulation_crack_energy": (c_int, [POINTER(dem_simulation), POINTER(c_double)],
        """dem_simulation_crack_energy(simulation, energy)
        What cracks take by the fracture energies of what is broken, which those of brittle triangles have from their
        strength (docs/fracture.md): the sum over broken triangles of fracture energy times `crack_length` times
        thickness. Beside it `fracture` of dem_energy is what has been taken. Of squares it is that of isotropic
        ones.
        energy J, >= 0; 0 where a triangle is broken that has no strength, or where the lattice has no moduli
        Returns also DEM_ERROR_MEMORY"""),
    "dem_simulation_stress": (c_int, [POINTER(dem_simulation), POINTER(c_double)],
        """dem_simulation_stress(simulation, stress)
        Virial stress of every node in the axes of space: its share of r x f over its share of the rest volume. That
        is the Kirchhoff stress: Cauchy's times the ratio of the volumes now and at rest. Of springs and triangles;
        of neither damping nor motion. Exact where the strain is uniform, on boundaries too; 0 at a node in no
        triangle. What a model needs for stresses is made when they are first asked for.
        stress [n_nodes][dim (dim + 1)/2] Pa, > 0 in tension: xx, yy, xy
        Returns DEM_ERROR_MEMORY"""),
    "dem_simulation_stress_at": (c_int, [POINTER(dem_simulation), c_int64, POINTER(c_double)],
        """dem_simulation_stress_at(simulation, node, stress)
        The same of one node.
        node 0 <= node < n_nodes
        stress [dim (dim + 1)/2]
        Returns DEM_ERROR_MEMORY"""),
    "dem_simulation_overlap": (c_int, [POINTER(dem_simulation), POINTER(dem_overlap)],
        """dem_simulation_overlap(simulation, out)"""),
    "dem_simulation_surfaces": (c_int, [POINTER(dem_simulation), POINTER(dem_surfaces)],
        """dem_simulation_surfaces(simulation, out)"""),
    "dem_simulation_pair": (c_int, [POINTER(dem_simulation), c_int64, POINTER(dem_pair)],
        """dem_simulation_pair(simulation, pair, out)
        A pair of surfaces that push each other.
        pair 0 <= pair < `pushing` of the dem_surfaces of the same instant
        Returns also DEM_ERROR_MEMORY"""),
    "dem_simulation_contact_forces": (c_int, [POINTER(dem_simulation), POINTER(c_double)],
        """dem_simulation_contact_forces(simulation, force)
        Force on every node by contact of bodies with each other and with themselves; obstacles have no part in it.
        The sum over all nodes is 0.
        force [n_nodes][dim] N"""),
    "dem_simulation_contact_pressures": (c_int, [POINTER(dem_simulation), POINTER(c_double)],
        """dem_simulation_contact_pressures(simulation, pressure)
        The pressure that this force means: the part of it along the normals of surfaces, over the node's share of
        the surface of the plate at rest; 0 at nodes that are on none.
        pressure [n_nodes] Pa, >= 0
        Returns also DEM_ERROR_MEMORY"""),
    "dem_simulation_counts": (c_int, [POINTER(dem_simulation), POINTER(dem_counts)],
        """dem_simulation_counts(simulation, out)"""),
    "dem_simulation_body": (c_int, [POINTER(dem_simulation), c_int64, POINTER(dem_body_motion)],
        """dem_simulation_body(simulation, body, out)

        body 0 <= body < n_bodies"""),
    "dem_simulation_inertia": (c_int, [POINTER(dem_simulation), c_int64, POINTER(c_double)],
        """dem_simulation_inertia(simulation, body, inertia)
        Moment of inertia of a body about its centre of mass, the sum of m |x - c|^2 over its nodes: its angular
        momentum over this is its mean angular velocity.
        body 0 <= body < n_bodies
        inertia kg m^2"""),
    "dem_simulation_obstacle": (c_int, [POINTER(dem_simulation), c_int64, POINTER(dem_obstacle_load)],
        """dem_simulation_obstacle(simulation, obstacle, out)

        obstacle 0 <= obstacle < n_obstacles"""),
    "dem_simulation_boundary": (c_int, [POINTER(dem_simulation), c_int64, POINTER(dem_boundary_load)],
        """dem_simulation_boundary(simulation, boundary, out)

        boundary 0 <= boundary < n_boundaries"""),
    "dem_simulation_fastest": (c_double, [POINTER(dem_simulation)],
        """dem_simulation_fastest(simulation)
        The largest |v_x| + |v_y| of a node, m/s."""),
    "dem_simulation_residual": (c_double, [POINTER(dem_simulation)],
        """dem_simulation_residual(simulation)
        How far from equilibrium: the largest force on a node that may move, without drag and with what contacts
        give, over the largest force of a spring; 0 where there is neither. Known after an accepted step without
        contact event, else infinity."""),
    "dem_simulation_ramp_time": (c_double, [POINTER(dem_simulation)],
        """dem_simulation_ramp_time(simulation)
        Time, s, at which the ramps of boundaries are in the state that is seen: with the option `pause` behind that
        of the state by all pauses so far, else the same."""),
    "dem_simulation_model": (POINTER(dem_model), [POINTER(dem_simulation)],
        """dem_simulation_model(simulation)"""),
    "dem_simulation_options": (c_int, [POINTER(dem_simulation), POINTER(dem_options)],
        """dem_simulation_options(simulation, out)
        The options in force: those of dem_simulation_create() with every default replaced by its value, and
        `boundaries` NULL."""),
    "dem_stress_von_mises": (c_double, [POINTER(c_double)],
        """dem_stress_von_mises(stress)
        Von Mises' equivalent of a plane stress xx, yy, xy: sqrt(xx^2 - xx yy + yy^2 + 3 xy^2)."""),
    "dem_stress_principal": (None, [POINTER(c_double), POINTER(c_double), POINTER(c_double)],
        """dem_stress_principal(stress, value, direction)
        Principal values, the larger first, and the unit vector along which the first acts: to the right, or up;
        along x if both are equal."""),
    "dem_simulation_observe": (c_int, [POINTER(dem_simulation), POINTER(dem_observer)],
        """dem_simulation_observe(simulation, observer)
        Copies `observer`. At most 8; to be called before the first advance. One of a resumed simulation is shown the
        frames later than its checkpoint."""),
    "dem_peaks_create": (c_int, [POINTER(POINTER(dem_peaks)), POINTER(dem_model), c_int64],
        """dem_peaks_create(out, model, every)

        every >= 1. A look costs about an eighth of a step; between looks every 4 steps of 0.5/omega_max the fastest
        wave of a lattice passes a third of its period."""),
    "dem_peaks_resume": (c_int, [POINTER(POINTER(dem_peaks)), POINTER(dem_model), c_int64, POINTER(dem_checkpoint)],
        """dem_peaks_resume(out, model, every, checkpoint)
        Peaks as they were when the checkpoint was taken; `every` is the checkpoint's.
        Returns DEM_ERROR_ARGUMENT for another `every`; DEM_ERROR_IO if the checkpoint has none of such a model"""),
    "dem_peaks_destroy": (None, [POINTER(dem_peaks)],
        """dem_peaks_destroy(peaks)
        Accepts NULL."""),
    "dem_peaks_observer": (c_int, [POINTER(dem_peaks), POINTER(dem_observer)],
        """dem_peaks_observer(peaks, out)
        The observer to hand to dem_simulation_observe(), of a simulation of the same model; borrows the peaks."""),
    "dem_peaks_nodes": (POINTER(dem_node_peak), [POINTER(dem_peaks)],
        """dem_peaks_nodes(peaks)
        Peaks so far, [n_nodes] and [n_springs]: views."""),
    "dem_peaks_springs": (POINTER(dem_spring_peak), [POINTER(dem_peaks)],
        """dem_peaks_springs(peaks)"""),
    "dem_peaks_most_stressed_nodes": (c_int64, [POINTER(dem_peaks), c_int64, POINTER(c_int64)],
        """dem_peaks_most_stressed_nodes(peaks, n, nodes)
        The n nodes of the largest stresses so far, the largest first, equal ones in the order of their numbers.
        nodes [n]
        Returns how many there are: less than n where less have been stressed at all"""),
    "dem_peaks_most_strained_springs": (c_int64, [POINTER(dem_peaks), c_int64, POINTER(c_int64)],
        """dem_peaks_most_strained_springs(peaks, n, springs)
        The same of the springs and their strains."""),
    "dem_points_check": (c_int, [POINTER(c_double), c_int64],
        """dem_points_check(points, n)
        Whether points make a polyline: finite ones, n >= 1, with lengths between them that can be computed with.
        points [n][2] m
        Returns DEM_ERROR_ARGUMENT, with points numbered from 1 in its message"""),
    "dem_outline_check": (c_int, [POINTER(dem_outline)],
        """dem_outline_check(outline)
        Whether a figure is one: numbers in their ranges, and a polygon that does not meet itself.
        Returns DEM_ERROR_ARGUMENT, with points and edges numbered from 1 in its message"""),
    "dem_outline_box": (c_int, [POINTER(dem_outline), POINTER(c_double)],
        """dem_outline_box(outline, box)
        The box around a figure.
        box [4] left, bottom, right, top, m"""),
    "dem_outline_distance": (c_int, [POINTER(dem_outline), POINTER(c_double), c_int64, POINTER(c_double)],
        """dem_outline_distance(outline, x, n, distance)
        Signed distances of points from the edge, > 0 outside; of a polygon that meets itself they have no meaning.
        x [n][2] m
        distance [n] m"""),
    "dem_outline_corners": (c_int64, [POINTER(dem_outline)],
        """dem_outline_corners(outline)
        Number of corners; 0 of discs and rings, and of what is no figure."""),
    "dem_outline_corner": (c_int, [POINTER(dem_outline), c_int64, POINTER(c_double)],
        """dem_outline_corner(outline, k, x)
        Where a corner is, in the order of points; of a rectangle counter-clockwise from the lower left before it is
        turned.
        k from 0
        x [2] m"""),
    "dem_shape_lattice": (c_int, [POINTER(dem_lattice), POINTER(dem_shape), POINTER(dem_shape_report)],
        """dem_shape_lattice(out, shape, report)
        Triangulates a shape: nodes and triangles only, as dem_lattice_rectangle() does. Of an outline of triangles
        that is not smooth the nodes are those of an equilateral grid: of a rectangle that is not turned it has rows
        along its lower side and its height is rounded to whole ones, in a disc or a ring a node is at its centre,
        others stand on their lowest points. Nodes on an edge belong to the body. Coordinates are mirror symmetric to
        the bit where the shape is.
        out from dem_lattice_empty(); overwritten, not freed; caller owns it
        report may be NULL
        Returns DEM_ERROR_ARGUMENT for a member outside its range, and where there would be more than 2^40 nodes;
        DEM_ERROR_MODEL where a void lies wholly outside of the body, and where nothing is left of it;
        DEM_ERROR_MEMORY"""),
    "dem_shape_area": (c_int, [POINTER(dem_shape), POINTER(c_double)],
        """dem_shape_area(shape, area)
        True area of a shape without its lattice: exact to rounding where all edges are straight, to 1e-4 of the body
        for others. Takes time of order (n_voids + n_pores)^2.
        area m^2"""),
    "dem_shape_place_pores": (c_int, [POINTER(dem_shape), POINTER(dem_pores), POINTER(c_double), c_int64,
                                      POINTER(c_int64)],
        """dem_shape_place_pores(shape, recipe, pores, capacity, n)
        Draws radii and places the pores in the material of a shape, the largest first, each at the first admissible
        of at most 100,000 random centres. The same recipe gives the same pores on every machine. They become part of
        a shape as its `pores`, where those of further recipes are appended.
        pores [capacity][3] x, y and radius, m, by falling radius
        capacity number of rows; DEM_PORES_MAX are enough for any recipe, `number` of them where that is not 0
        n how many there are; after DEM_ERROR_MODEL how many have found a place, DEM_PORES_MAX where the area needs
        more than these
        Returns DEM_ERROR_ARGUMENT for a number outside its range, where next to no radius lies between the smallest
        and the largest, and where the capacity is too small; DEM_ERROR_MODEL where a pore finds no place or the area
        needs more than DEM_PORES_MAX; DEM_ERROR_MEMORY"""),
    "dem_mesh_lattice": (c_int, [POINTER(dem_lattice), POINTER(dem_mesh)],
        """dem_mesh_lattice(out, mesh)
        Reads a mesh: its nodes, but for those of no triangle, and its triangles, made counter-clockwise, both in the
        order of the mesh. Nodes and triangles only, as of dem_shape_lattice().
        out from dem_lattice_empty(); overwritten, not freed; caller owns it
        Returns DEM_ERROR_MODEL for what is no such mesh, without triangles, or with one that has no area or overlaps
        another on its side of an edge: the message is "PATH:LINE: what is wrong", of a text "the mesh:LINE: ...",
        with the end of a long path only; DEM_ERROR_IO where the file cannot be read; DEM_ERROR_ARGUMENT for a member
        outside its range; DEM_ERROR_MEMORY"""),
    "dem_lattice_inside": (c_int, [POINTER(dem_lattice), POINTER(dem_outline), c_int64, POINTER(c_bool),
                                   POINTER(c_bool)],
        """dem_lattice_inside(lattice, outline, step, triangles, springs)
        Marks triangles whose centres lie in a figure or on its edge, and springs whose middles do, such as those of
        an inclusion of another material.
        step 1; 2: both triangles of a cell of squares go by their common centre
        triangles [n_triangles]; may be NULL
        springs [n_springs]; may be NULL"""),
    "dem_lattice_crossed": (c_int, [POINTER(dem_lattice), POINTER(c_double), c_int64, c_double, POINTER(c_bool),
                                    POINTER(c_bool)],
        """dem_lattice_crossed(lattice, points, n_points, aside, triangles, springs)
        Marks triangles and springs that a polyline crosses. A crack is what is left when these triangles are taken
        out, by dem_lattice_trim(); of cells of squares both go.
        points [n_points][2], m, n_points >= 2, consecutive ones distinct
        aside m, >= 0: how far the polyline is shifted to its left, usually 1e-6 of the spacing: where it runs along
        edges it then crosses the triangles on its left, and nodes on it belong to its right face
        triangles [n_triangles]; may be NULL
        springs [n_springs]; may be NULL"""),
    "dem_lattice_least_angle": (c_int, [POINTER(dem_lattice), POINTER(c_double)],
        """dem_lattice_least_angle(lattice, angle)
        The least angle of all triangles, which tells how sound they are.
        angle radians; 0 if a triangle is turned over, pi/2 without triangles"""),
    "dem_slab_free": (None, [POINTER(dem_slab)],
        """dem_slab_free(slab)
        Frees the arrays and leaves an empty slab. Accepts NULL, and does nothing where there is no struct_size."""),
    "dem_slab_rectangle": (c_int, [POINTER(dem_slab), c_double, c_double, c_double, c_int64, c_int64],
        """dem_slab_rectangle(out, width, height, spacing, part, n_parts)
        Of n_parts slabs of dem_lattice_rectangle(), the lowest first, the one with number `part`. Each has the same
        number of rows, or one more; own nodes are whole rows, and the rim is a row below them and one above. No more
        than these, and for a moment a further row on each side, is made. Assembled by dem_lattice_assemble().
        out from dem_slab_empty(); overwritten, not freed; caller owns it
        part 0 <= part < n_parts
        Returns as dem_lattice_rectangle(); DEM_ERROR_MODEL for more parts than rows of nodes"""),
    "dem_slab_squares": (c_int, [POINTER(dem_slab), c_double, c_double, c_double, c_int64, c_int64],
        """dem_slab_squares(out, width, height, spacing, part, n_parts)
        The same of dem_lattice_squares(). Assembled by dem_lattice_assemble_squares()."""),
    "dem_slab_shape": (c_int, [POINTER(dem_slab), POINTER(dem_shape), c_int64, c_int64],
        """dem_slab_shape(out, shape, part, n_parts)
        The same of dem_shape_lattice(): whole rows of what is left where the outline, voids and pores have cut the
        grid, about as many nodes in each slab. Parts of the body that are not connected stay, as they do there. To
        number its nodes a slab counts what is left of the rows of all: it looks at each place, as cutting the whole
        does, but at some rows at a time. Its own rows it makes from one end of the grid to the other, before they
        are cut. Smooth edges are made in 72 rows more on each side, which tell what becomes of these rows in the
        whole; nodes of its rim are in two rows on each side.
        shape not numbered, as triangles are numbered in the whole
        Returns as dem_shape_lattice(), also where a void lies wholly outside of the body; DEM_ERROR_MODEL for more
        parts than rows in which something is left, and where triangles at a smooth edge depend on what is farther
        off, as in about one of 1000 random shapes with pores that overlap"""),
    "dem_slab_jitter": (c_int, [POINTER(dem_slab), c_double, c_uint64],
        """dem_slab_jitter(slab, radius, seed)
        Moves nodes as dem_lattice_jitter() moves those of the whole. For slabs as they are made.
        radius m, 0 to 0.3 of the shortest side of a triangle
        Returns DEM_ERROR_ARGUMENT, also for a slab that has no place in a whole, or without rim_boundary;
        DEM_ERROR_MODEL for one that has springs, and where a triangle would keep less than a tenth of its area, as
        some at smooth edges do; DEM_ERROR_MEMORY; then nothing has changed"""),
    "dem_reader_open": (c_int, [POINTER(POINTER(dem_reader)), c_char_p],
        """dem_reader_open(out, path)

        Returns DEM_ERROR_IO with the file, dataset and reason; DEM_ERROR_MODEL for an inconsistent lattice. A part
        that is being written at this moment may be refused: then try again"""),
    "dem_reader_close": (None, [POINTER(dem_reader)],
        """dem_reader_close(reader)
        Accepts NULL. Views end with it."""),
    "dem_reader_lattice": (POINTER(dem_lattice), [POINTER(dem_reader)],
        """dem_reader_lattice(reader)
        The lattice at rest, and where and how fast it started; a view."""),
    "dem_reader_n_obstacles": (c_int64, [POINTER(dem_reader)],
        """dem_reader_n_obstacles(reader)
        How many obstacles there are."""),
    "dem_reader_obstacle": (POINTER(dem_obstacle), [POINTER(dem_reader), c_int64],
        """dem_reader_obstacle(reader, obstacle)
        An obstacle; a view.
        obstacle 0 <= obstacle < dem_reader_n_obstacles(); NULL, and a dem_status_message(), for any other"""),
    "dem_reader_times": (POINTER(c_double), [POINTER(dem_reader), POINTER(c_int64)],
        """dem_reader_times(reader, n_frames)
        Times of the frames, s, ascending, [*n_frames]; a view."""),
    "dem_reader_arrays": (POINTER(dem_reader_array), [POINTER(dem_reader), POINTER(c_int64)],
        """dem_reader_arrays(reader, n)
        All of them, those of nodes first, else by name, [*n]; a view. Positions are not among them:
        dem_reader_positions()."""),
    "dem_reader_array_find": (POINTER(dem_reader_array), [POINTER(dem_reader), c_char_p],
        """dem_reader_array_find(reader, name)
        NULL if there is none of this name."""),
    "dem_reader_positions": (c_int, [POINTER(dem_reader), c_int64, POINTER(c_double)],
        """dem_reader_positions(reader, frame, x)

        frame 0 <= frame < n_frames
        x [n_nodes][2] m
        Returns DEM_ERROR_ARGUMENT if there is no such frame; DEM_ERROR_IO with the file, dataset and reason"""),
    "dem_reader_read": (c_int, [POINTER(dem_reader), POINTER(dem_reader_array), c_int64, POINTER(c_double)],
        """dem_reader_read(reader, array, frame, values)

        array one of dem_reader_arrays()
        frame 0 <= frame < n_frames; any, of a constant array
        values [n_nodes or n_springs][components]
        Returns as dem_reader_positions()"""),
    "dem_reader_broken_triangles": (c_int, [POINTER(dem_reader), c_int64, POINTER(c_ubyte)],
        """dem_reader_broken_triangles(reader, frame, triangle)
        Which triangles are broken; springs that are have the array "broken".
        frame 0 <= frame < n_frames
        triangle [n_triangles] 1: broken, else 0; all 0 where the file is of a version that did not write them
        Returns as dem_reader_positions()"""),
    "dem_reader_columns": (POINTER(dem_reader_column), [POINTER(dem_reader), POINTER(c_int64)],
        """dem_reader_columns(reader, n)
        All of them, table by table, "t" first, else by name, [*n]; a view."""),
    "dem_reader_column_find": (POINTER(dem_reader_column), [POINTER(dem_reader), c_char_p, c_char_p],
        """dem_reader_column_find(reader, table, name)
        NULL if there is none."""),
    "dem_reader_fragments": (c_int, [POINTER(dem_reader), c_int64, POINTER(c_int64), POINTER(c_int64)],
        """dem_reader_fragments(reader, frame, first, count)
        Which rows of the table "fragments" are those of a frame, by the ids of fragments.
        frame 0 <= frame < n_frames
        first, count for dem_reader_read_rows(); 0 and 0 where there is no such table
        Returns DEM_ERROR_ARGUMENT if there is no such frame"""),
    "dem_reader_read_column": (c_int, [POINTER(dem_reader), POINTER(dem_reader_column), POINTER(c_double)],
        """dem_reader_read_column(reader, column, values)

        column one of dem_reader_columns()
        values [n_rows][items][components]
        Returns DEM_ERROR_IO with the file, dataset and reason"""),
    "dem_reader_read_rows": (c_int, [POINTER(dem_reader), POINTER(dem_reader_column), c_int64, c_int64,
                                     POINTER(c_double)],
        """dem_reader_read_rows(reader, column, first, count, values)
        A part of it, for tables that are longer than memory.
        first, count rows, 0 <= first, count and first + count <= n_rows, else DEM_ERROR_ARGUMENT
        values [count][items][components]"""),
    "dem_history_row_due": (c_bool, [c_double, c_double, c_double],
        """dem_history_row_due(interval, before, t)
        Whether an accepted step at `t` has a row of /history: at every instant it is but once, and with an interval
        only where a multiple of that lies behind the row before and not behind `t`.
        interval s, as dem_trajectory_options.history_interval
        before s, of the row before; -INFINITY: there is none"""),
    "dem_trajectory_create": (c_int, [POINTER(POINTER(dem_trajectory)), c_char_p, POINTER(dem_simulation),
                                      POINTER(dem_trajectory_options)],
        """dem_trajectory_create(out, path, simulation, options)
        Starts `path`, which must end in ".vtkhdf". Until dem_trajectory_finish() the file is NAME.part.vtkhdf,
        closed after every frame (but see stays_open) so that it can be looked at while the run goes on. As many
        threads deflate it as the simulation has (dem_options.threads), to the same bytes. Writes the lattice group,
        the obstacle file NAME.obstacle.vtkhdf (none without obstacles) and NAME.body.vtkhdf, by which ParaView shows
        triangles (none without triangles or frames). The run starts anew: an older part is overwritten, and segments
        NAME.00001.vtkhdf, ... of an unfinished run are removed, from which only dem_trajectory_resume() goes on. A
        file of such a name that is no segment stays; it stops dem_trajectory_segment() when that comes to it."""),
    "dem_trajectory_resume": (c_int, [POINTER(POINTER(dem_trajectory)), c_char_p, POINTER(dem_simulation),
                                      POINTER(dem_trajectory_options), POINTER(dem_checkpoint)],
        """dem_trajectory_resume(out, path, simulation, options, checkpoint)
        Goes on with the trajectory of a run that was killed or stopped, or that is to be continued: the counterpart
        of dem_trajectory_create(), with the same path and options (deflate, most_stressed and peaks may be others).
        The segments must hold just the rows up to the checkpoint: younger ones are removed, as is the part. Where
        there are no such segments, but a finished NAME.vtkhdf that has these rows, they become the first segment;
        NAME.vtkhdf stays. Notes are not read back.
        checkpoint one that dem_trajectory_segment() was called with; only read
        Returns DEM_ERROR_IO with the segment that is missing or another run's, DEM_ERROR_ARGUMENT with the option
        that differs; then nothing has changed"""),
    "dem_trajectory_observer": (c_int, [POINTER(dem_trajectory), POINTER(dem_observer)],
        """dem_trajectory_observer(trajectory, out)
        The observer to hand to dem_simulation_observe(); borrows the trajectory. Its entries in a checkpoint are
        "trajectory" and "trajectory.probes"."""),
    "dem_trajectory_note": (c_int, [POINTER(dem_trajectory), c_char_p, c_char_p],
        """dem_trajectory_note(trajectory, name, text)
        Stores a string in /provenance under `name`, in the part and in every file that is made from now on."""),
    "dem_trajectory_segment": (c_int, [POINTER(dem_trajectory), POINTER(dem_checkpoint)],
        """dem_trajectory_segment(trajectory, checkpoint)
        Publishes what was seen up to the checkpoint, and is in no segment yet, as the next segment, a file of its
        own that is synced and read back; what is later stays in the part. A checkpoint that is written to disk after
        this loses no row.
        checkpoint of this run, not older than that of the segment before
        Returns DEM_ERROR_IO, then the files are as they were"""),
    "dem_trajectory_finish": (c_int, [POINTER(dem_trajectory)],
        """dem_trajectory_finish(trajectory)
        Writes what is buffered, and the peaks, syncs, and gives the file its final name, replacing a file of that
        name: that is the part, or a new file of all segments and the part, which then are removed."""),
    "dem_trajectory_destroy": (None, [POINTER(dem_trajectory)],
        """dem_trajectory_destroy(trajectory)
        Accepts NULL. Without a finish before it the part file stays as of its last frame."""),
    "dem_trajectory_read_note": (c_int, [c_char_p, c_char_p, POINTER(c_char), c_size_t],
        """dem_trajectory_read_note(path, name, text, size)
        Reads back a string of /provenance into `text`, terminated.
        Returns DEM_ERROR_IO if the file or the string is not there, DEM_ERROR_ARGUMENT if `size` is too small"""),
    "dem_lattice_read": (c_int, [POINTER(dem_lattice), c_char_p],
        """dem_lattice_read(out, path)
        Reads the group /lattice of any HDF5 file into a new lattice: every output file carries one. docs/output.md
        lists its datasets; any other name in it is refused. Numbers may have any width and byte order, integers do
        for reals, and `fixed` may be boolean as h5py stores it; a number that does not fit is an error. Types, ranks
        and extents are checked before anything is allocated; external and soft links, external and virtual storage,
        and filters other than deflate, shuffle and fletcher32 are refused.
        out from dem_lattice_empty(); overwritten, not freed; caller owns it
        Returns DEM_ERROR_IO with the file, dataset and reason; DEM_ERROR_MODEL for inconsistent extents"""),
    "dem_lattice_measure": (c_int, [c_char_p, POINTER(c_int64), POINTER(c_int64)],
        """dem_lattice_measure(path, n_nodes, n_springs)
        How large the lattice of such a file is: the same checks, but for those of its numbers, which are not read.
        Returns as dem_lattice_read()"""),
    "dem_slab_read": (c_int, [POINTER(dem_slab), c_char_p, c_int64, c_int64],
        """dem_slab_read(out, path, part, n_parts)
        Reads what a slab (dem/slab.h) has of the group /lattice, by the checks of dem_lattice_read(). The nodes of
        the file are n_parts ranges, each of as many nodes as the others, or one more; the own nodes of the slab are
        number `part` of these. It has their springs and triangles, and all arrays that the file has, of its rim too:
        it is assembled, and fit for dem_model_create_mpi_slab(). Where the file has no list of contact nodes these
        are known of own nodes only; it has no rim_boundary. All springs and triangles of the file are looked at,
        65536 at a time, or a chunk of a dataset whose deflated chunks are larger; besides that memory is taken for
        the slab, and a list of its nodes, springs and triangles. Each rank reads its slab by itself. Where that
        fails on some, all can go on to dem_model_create_mpi_slab(), which fails on all if a slab is empty.
        out from dem_slab_empty(); overwritten, not freed; caller owns it
        part 0 <= part < n_parts
        Returns as dem_lattice_read(), but numbers that the slab does not have are not looked at, except those of
        nodes; DEM_ERROR_MODEL also for more parts than nodes, and, on all ranks, where springs or triangles are not
        in ascending order of their lowest nodes, with the first one: a model of slabs numbers them in that order.
        All lattices that this library makes have it, but for triangles of meshes by Gmsh"""),
    "dem_hdf5_skip_exit": (None, [],
        """dem_hdf5_skip_exit()
        For a program that uses HDF5 through this library only, as its first call of it: HDF5 then does not clean up
        at the exit of the process, where version 1.10 crashes if a file could not be written or closed. By then all
        are closed."""),
    "dem_version_hdf5": (c_char_p, [],
        """dem_version_hdf5()
        Version of the HDF5 library in use, "MAJOR.MINOR.PATCH"."""),
}

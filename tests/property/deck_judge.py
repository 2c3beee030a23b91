# SPDX-License-Identifier: BSD-3-Clause
"""What a run has written, judged with nothing of the program's but its files: energies, impulses and depths are
computed here again from positions, velocities, masses and springs."""
import math
import re

import h5py
import numpy as np

import deck_motions

LEDGER = {"kinetic": 1, "elastic": 1, "area": 1, "guard": 1, "contact": 1, "gravity": 1, "impact": 1, "friction": 1,
          "damping": 1, "fracture": 1, "projection": -1, "boundary": -1, "obstacle": -1}


class Run:
    """What is read of NAME.vtkhdf."""

    def __init__(self, path):
        with h5py.File(path) as f:
            self.history = {name: column[...] for name, column in f["history"].items()}
            self.rows_each_step = float(f["provenance/history_interval"].asstr()[()]) == 0.0
            self.lattice = {name: column[...] for name, column in f["lattice"].items()}
            frames = f["VTKHDF"]
            self.times = frames["Steps/Values"][...]
            self.x = frames["Points"][...].reshape(len(self.times), -1, 3)[:, :, :2]
            v = frames["PointData"].get("velocity")
            self.v = None if v is None else v[...].reshape(self.x.shape[0], -1, 3)[:, :, :2].astype(float)
            self.energy = {name: frames["FieldData"][name + "_energy"][...] for name in LEDGER}
            self.obstacles = [f[f"obstacles/{k}/points"][...] for k in range(len(f.get("obstacles", [])))]
            self.broken = f["breaks/triangle"][...] if "breaks" in f else np.zeros(0, int)
            self.events = {name: f["events"][name][...] for name in ("t", "node", "other")} if "events" in f else None
            self.arrays = [array[...] for group in ("PointData", "CellData") for array in frames[group].values()]
            self.arrays += [array[...] for probe in f.get("probes", {}).values() for array in probe.values()]


def is_finite(run):
    """Whether all that was written is, but the smallest gap where no pair pushes, which is infinite."""
    gap_min = run.history["gap_min"]
    columns = [*(column for column in run.history.values() if column is not gap_min), *run.energy.values(), *run.arrays, run.x]
    return all(np.isfinite(column).all() for column in columns) and bool((gap_min >= 0).all())


# ---- energy ----

def scale_of(run, deck):
    """The largest energy of motion and strain so far and what was dissipated; and what the tolerance of velocities is
    measured in, where everything is slower than that."""
    h = run.history
    motion = h["kinetic"] + h["elastic"] + h["area"] + h["guard"] + h["contact"]
    slow = 0.5 * run.lattice["mass"].sum() * (1e-3 * deck.sound) ** 2
    return max(np.max(motion), slow)


def closure(run, deck):
    """By how much the ledger is open, at the worst."""
    total = sum(sign * run.history[name] for name, sign in LEDGER.items())
    return np.max(np.abs(total - total[0])) / scale_of(run, deck)


def given_back(run, deck):
    """By how much what is taken for good falls at any step."""
    falls = [-np.diff(run.history[name]) for name in ("impact", "friction", "damping", "fracture")]
    return np.max(falls, initial=0.0) / scale_of(run, deck)


def energy_of_couplings(run):
    """In each frame: of each corner of a triangle its coupling times how much longer the two edges there are."""
    l = run.lattice
    if "coupling" not in l:
        return 0.0
    here, there = l["triangles"], np.roll(l["triangles"], -1, axis=1)
    rest = np.linalg.norm(l["x"][there] - l["x"][here], axis=2)
    stretch = np.linalg.norm(run.x[:, there] - run.x[:, here], axis=3) - rest
    return (l["coupling"] * stretch * np.roll(stretch, 1, axis=2)).sum(axis=(1, 2))


def mistold(run, deck):
    """How far kinetic and elastic energy of frames are from what positions and velocities make them."""
    l = run.lattice
    d = np.linalg.norm(run.x[:, l["ends"][:, 0]] - run.x[:, l["ends"][:, 1]], axis=2)
    elastic = 0.5 * (l["stiffness"] * (d - l["rest_length"]) ** 2 / l["rest_length"]).sum(axis=1) + energy_of_couplings(run)
    whole = run.energy["fracture"] == 0.0  # what breaks and softens has other springs
    worst = np.max(np.abs(elastic - run.energy["elastic"])[whole], initial=0.0)
    if run.v is not None:
        kinetic = 0.5 * (l["mass"] * (run.v ** 2).sum(axis=2)).sum(axis=1)
        worst = max(worst, np.max(np.abs(kinetic - run.energy["kinetic"])))
    return worst / scale_of(run, deck)


def unbalanced(run, deck):
    """How far momentum is from the impulses of weight and obstacles, over mass times speed."""
    h, mass = run.history, run.lattice["mass"]
    body = run.lattice.get("body", np.zeros(len(mass), int))
    masses = np.bincount(body, weights=mass)
    momentum = (masses[None, :, None] * h["body_velocity"]).sum(axis=1)
    impulse = h.get("obstacle_impulse", np.zeros((len(h["t"]), 1, 2))).sum(axis=1) + masses.sum() * h["t"][:, None] * np.array(deck.gravity)
    speed = max(math.sqrt(2.0 * np.max(h["kinetic"]) / masses.sum()), 1e-3 * deck.sound)
    return np.max(np.abs(momentum - momentum[0] - impulse + impulse[0])) / (masses.sum() * speed)


# ---- depth ----

def rim_of(lattice):
    """Ends of the boundary edges of the triangles."""
    t = lattice["triangles"]
    sides = np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
    edges, number = np.unique(sides, axis=0, return_counts=True)
    return edges[number == 1]


def distance(points, a, b):
    """Of each point from the nearest of the segments from a to b."""
    edge = b - a
    r = points[:, None] - a[None]
    along = np.clip((r * edge).sum(axis=2) / (edge ** 2).sum(axis=1), 0.0, 1.0)
    return np.sqrt(((r - along[:, :, None] * edge) ** 2).sum(axis=2)).min(axis=1)


def is_inside(points, corners):
    """By the number of edges that a ray to the right crosses."""
    a, b = corners, np.roll(corners, -1, axis=0)
    x, y = points[:, 0, None], points[:, 1, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        across = a[:, 0] + (y - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
        crossed = ((a[:, 1] > y) != (b[:, 1] > y)) & (x < across)
    return crossed.sum(axis=1) % 2 == 1


def solid_of(deck, k, points):
    """Corners of the solid behind obstacle k."""
    closing = np.array(deck.grounds[k].closing, float).reshape(-1, 2) * deck.spacing
    return np.concatenate([points, closing]) if len(closing) else points[:-1]


def is_beyond(x, line):
    """Whether any of the places is beyond an end of an open line, across the chord between both ends."""
    chord = line[-1] - line[0]
    along = (x - line[0]) @ chord / (chord @ chord)
    return (along < 0.0).any() or (along > 1.0).any()


def beyond_ends(run, deck, k, points):
    """Nodes of rigid bodies that are beyond an end of obstacle k at some time: what passed round it is behind, and the
    history counts no such nodes of rigid bodies (crowd 9063)."""
    closed, body = np.array_equal(points[0], points[-1]), run.lattice["body"]
    rigid = [b for b, group in enumerate(re.findall(r"(?ms)^&body$.*?^/$", deck.text)) if "rigid = .true." in group]
    lines = [deck_motions.place(deck.motions[k], points, t) for t in run.times]
    return [i for b in rigid for i in np.flatnonzero(body == b)
            if not closed and any(is_beyond(x[body == b], line) for x, line in zip(run.x, lines))]


def node_depth(run, deck):
    """How deep a boundary node is in an obstacle in any frame, m."""
    rim, deepest = np.unique(rim_of(run.lattice)), 0.0
    for k, points in enumerate(run.obstacles):
        solid, nodes = solid_of(deck, k, points), np.setdiff1d(rim, beyond_ends(run, deck, k, points))
        for t, x in zip(run.times, run.x):
            corners = deck_motions.place(deck.motions[k], solid, t)
            inside = x[nodes][is_inside(x[nodes], corners) != deck.grounds[k].is_room]
            if len(inside):
                deepest = max(deepest, distance(inside, corners, np.roll(corners, -1, axis=0)).max())
    return deepest


def convex(points):
    """Points at which the polyline turns away from the bodies on its left; the free ends are none."""
    closed = np.array_equal(points[0], points[-1])
    before, here, after = (np.concatenate([points[-2:-1], points[:-2]]), points[:-1], points[1:]) if closed else \
        (points[:-2], points[1:-1], points[2:])
    p, q = here - before, after - here
    return here[p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0] < 0.0]


def covered(points, corners):
    """Which points are in one of the triangles, counter-clockwise."""
    found = np.ones((len(points), len(corners)), bool)
    for k in range(3):
        a, b = corners[:, k], corners[:, (k + 1) % 3]
        r = points[:, None] - a[None]
        found &= (b - a)[:, 0] * r[:, :, 1] - (b - a)[:, 1] * r[:, :, 0] > 0.0
    return found.any(axis=1)


def vertex_depth(run, deck):
    """How deep a convex vertex of an obstacle is in a body in any frame, m."""
    given, rim, deepest = [convex(points) for points in run.obstacles], rim_of(run.lattice), 0.0
    whole = np.delete(run.lattice["triangles"], run.broken[run.broken >= 0], axis=0)
    for t, x in zip(run.times, run.x):
        vertices = np.concatenate([deck_motions.place(keys, points, t) for keys, points in zip(deck.motions, given)])
        inside = vertices[covered(vertices, x[whole])]
        if len(inside):
            deepest = max(deepest, distance(inside, x[rim[:, 0]], x[rim[:, 1]]).max())
    return deepest


# ---- surfaces of bodies ----

def crossed(x, rim):
    """Number of pairs of edges without a common node that cross, of those rim[k] gives the ends of."""
    a, edge = x[rim[:, 0]], x[rim[:, 1]] - x[rim[:, 0]]

    def side(points):
        r = points[None] - a[:, None]
        return edge[:, None, 0] * r[:, :, 1] - edge[:, None, 1] * r[:, :, 0]

    across = side(a) * side(a + edge) < 0.0
    apart = ~(rim[:, None, :, None] == rim[None, :, None, :]).any(axis=(2, 3))
    return np.count_nonzero(across & across.T & apart) // 2


def crossings(run, deck):
    """Edges of surfaces that cross in any frame: those of different bodies, and of one body too if the deck lets it
    touch itself. But a wall one triangle thick that an impact turns inside out crosses itself: that is a matter of the
    lattice."""
    rim, body = rim_of(run.lattice), run.lattice["body"]
    within = deck.contact["bodies"] == "all" and not run.history["inverted"].any()
    worst = 0
    for x in run.x:
        number = crossed(x, rim)
        if number > 0 and not within:
            number -= sum(crossed(x, rim[body[rim[:, 0]] == b]) for b in np.unique(body))
        worst = max(worst, number)
    return worst


# ---- what is right ----

def phase(run):
    """omega h: of the longest step, and about the highest frequency that the springs have."""
    l = run.lattice
    k = l["stiffness"] / l["rest_length"]
    sums = sum(np.bincount(l["ends"][:, end], weights=k, minlength=len(l["mass"])) for end in (0, 1))
    return math.sqrt(np.max(sums / l["mass"])) * np.max(run.history["h"])


def is_prescribed(deck):
    return deck.boundary.get("kind") in ("fix", "velocity", "displacement")


def open_ledger(run, deck):
    """2e-3 is what the paper's bodies are asked to hold at rtol 1e-6; errors grow as its root: in 2,000 decks 6e-4
    was the most at 1e-6 and below, 1.7e-3 at 9e-5. Verlet's method conserves another energy, which differs by a share
    of (omega h)^2 (a quarter of that with half the step): by 0.14 of it at most, by 0.7 where a boundary begins to move
    within a few steps. knothwolke3, without error control too, by 0.07; rk4 by 4e-3 (omega h)^4."""
    least = 2e-3 * max(1.0, math.sqrt(deck.solver.get("rtol", 1e-6) / 1e-6))
    share = {"verlet": 1.0 if is_prescribed(deck) else 0.3, "knothwolke3": 0.2}.get(deck.solver["method"], 0.0)
    limit = max(least, share * phase(run) ** 2)
    return closure(run, deck), max(limit, 0.01 * phase(run) ** 4) if deck.solver["method"] == "rk4" else limit


def dissipation_given_back(run, deck):
    """What friction, impacts and breaks have taken stays taken. But where sliding ends within a step, the work of friction
    has the error of the method: 2e-5 at most by Verlet's, 1.4e-8 by the others, 1.7e-7 at rtol 7e-5. The way
    of friction between bodies, and of a rigid one on its ground, is of second order in the steps: 4.2e-6 in 1,000
    crowds, and 1.04e-5 in one of 1,000 others (crowd 10105), where half, a quarter and an eighth of the longest step
    give 29, 150 and 890 times less."""
    limit = 1e-7 * max(1.0, deck.solver.get("rtol", 1e-6) / 1e-5)
    if deck.rubs:
        limit = max(limit, 2e-5)
    return given_back(run, deck), 1e-4 if deck.solver["method"] == "verlet" else limit


def momentum(run, deck):
    """To rounding, 1.8e-13 at most, but for three cases. Impulses of contacts that last through a break, or a triangle's
    softening, have the error of the method: 2e-9 by heun12, 5e-13 by Fehlberg's pair. Steps that end at events have
    velocities of the dense output there, in which the rounding of positions counts up to 1.9/h times: 5e-10. Verlet's
    forces of damped springs at the end of a step are those at other velocities than the state's, and near events those
    of the state: 8.5e-7."""
    if deck.boundary or "mass_damping" in deck.solver:
        return None
    is_verlet = deck.solver["method"] == "verlet"
    if is_verlet and "damping_time" in deck.text:
        return unbalanced(run, deck), 5e-6
    if deck.contact.get("method") == "exact" and not is_verlet:
        return unbalanced(run, deck), 1e-8
    return unbalanced(run, deck), 2e-8 if run.history["fracture"][-1] > 0.0 else 2e-12


def energies_of_frames(run, deck):
    """Velocities of single precision have half a unit in 2^23, squares twice that."""
    return mistold(run, deck), 1.3e-7


def penetration_tolerance_of(run, deck):
    return deck.contact.get("penetration_tolerance", 1e-6 * run.lattice["rest_length"].min())


def depth_of_nodes(run, deck):
    """In penetration tolerances: one, what rounding adds, and a little more where a frame is interpolated (test_random.c). What is
    prescribed is not stopped by obstacles, and what passed round an end is behind."""
    if is_prescribed(deck) or run.history["behind"].any():
        return None
    return node_depth(run, deck) / penetration_tolerance_of(run, deck), 5.0


def depth_of_vertices(run, deck):
    if is_prescribed(deck) or run.history["behind"].any() or not deck.contact.get("vertices", True):
        return None
    if not run.obstacles:
        return None
    return vertex_depth(run, deck) / penetration_tolerance_of(run, deck), 5.0


def events_per_node(run, deck):
    """Within the time in which sound goes a spacing: 6 at most, 9 where a low `rest_speed` asks for many hops. The
    program's own limit is 10,000 of one node."""
    time = run.history["t"][-1] * deck.sound / deck.spacing
    return run.history["events"][-1] / (len(run.lattice["mass"]) * time), 30.0


def events_in_step(run, deck):
    """The most at one node or edge, of the decks that list them: 50 changes, of which one is up to three events."""
    if run.events is None or not run.rows_each_step:
        return None
    step = np.searchsorted(run.history["t"], run.events["t"])
    places = np.stack([step, run.events["node"], run.events["other"]])
    return np.unique(places, axis=1, return_counts=True)[1].max(initial=0), 150


def rejected(run, deck):
    """Steps that were tried in vain, over those that were not, but for the first few."""
    h = run.history
    return (h["rejected"][-1] + h["retries"][-1]) / (h["steps"][-1] + 20), 0.5


# ---- what is right of a crowd (deck_crowd.py) ----

def open_crowd(run, deck):
    """1e-3 at rtol 1e-6; elsewhere half of what single bodies may have."""
    value, limit = open_ledger(run, deck)
    return value, limit / 2


def momentum_of_crowd(run, deck):
    """To rounding where nothing acts from outside."""
    if run.obstacles or deck.boundary:
        return momentum(run, deck)
    return unbalanced(run, deck), 1e-12


def surfaces_crossed(run, deck):
    return crossings(run, deck), 0.5


def attempts(run, deck):
    """Steps tried, over those that the bound of the highest frequency asks for at least. Contact makes bodies stiffer
    for a while: two blocks at 0.4 of the speed of sound take 2.8 times the steps. The times of events end steps by the
    method 'exact'. Verlet's steps are a part of what is stable, which springs that are damped by zeta = omega T/2
    shorten by sqrt(1 + zeta^2) - zeta."""
    h, l = run.history, run.lattice
    k = l["stiffness"] / l["rest_length"]
    sums = sum(np.bincount(l["ends"][:, end], weights=k, minlength=len(l["mass"])) for end in (0, 1))
    omega = 2.0 * math.sqrt(np.max(sums / l["mass"]))
    zeta = 0.5 * omega * deck.damping_time if deck.solver["method"] == "verlet" else 0.0
    least = h["t"][-1] * omega / (math.hypot(1.0, zeta) - zeta)
    return (h["steps"][-1] + h["rejected"][-1]) / (least + h["events"][-1]), 10.0


# Of a run and its deck: what is found and the largest that is right, or None where it is no question.
MEASURES = [("ledger open by", open_ledger), ("given back", dissipation_given_back), ("momentum off by", momentum),
            ("energies off by", energies_of_frames), ("node penetration tolerances deep", depth_of_nodes),
            ("vertex penetration tolerances deep", depth_of_vertices), ("events per node", events_per_node),
            ("events in a step", events_in_step), ("steps in vain", rejected)]
OF_CROWDS = [("ledger open by", open_crowd), ("momentum off by", momentum_of_crowd),
             ("surfaces crossed", surfaces_crossed), ("attempts", attempts),
             *(one for one in MEASURES if one[1] not in (open_ledger, momentum))]

# SPDX-License-Identifier: BSD-3-Clause
"""Laws that a deck may have besides, by dice of their own, so that the rest of the deck is as without them: what breaks,
rigid bodies, copies, springs of other kinds, quasi-static runs, contact of bodies, and rows of history."""


def of(parts, group):
    return [keys for name, keys in parts if name == group]


def user_of(bodies, name):
    """Bodies of a material."""
    return [body for body in bodies if body.keys.get("material", "solid") == name]


# ---- what breaks ----

def limits(dice, deck, keys, bodies, strain, modulus):
    """Of a material that breaks at about this strain: brittle or softening, by stress or by stretch."""
    strength = modulus * strain
    brittle = 3.4 * strength * strain * deck.spacing  # J/m^2, what a crack takes by strength alone (docs/fracture.md)
    kind = dice.one_of(["strength", "strength", "energy", "both", "both", "stretch"])
    if "bond_stiffness" in keys and kind in ("energy", "both"):
        kind = "strength"
    if kind == "stretch":
        keys.update({"fracture": "stretch", "critical_stretch": strain})
        return
    keys["fracture"] = "stress"
    if kind != "energy":
        keys["strength"] = strength
    if kind != "strength":
        keys["fracture_energy"] = brittle * (1.0 if kind == "energy" else dice.log(2.5, 10.0))
    if kind == "strength" and dice.chance(0.4):
        keys["compressive_strength"] = strength * dice.log(1.0, 10.0)
    if kind == "both" and dice.chance(0.3) and all(body.keys.get("lattice") != "square" for body in bodies):
        keys["stress_average"] = "element"


def scatter(dice, deck, keys):
    if "strength" in keys or "critical_stretch" in keys:
        keys["weibull"] = dice.between(3.0, 20.0)
        keys["weibull_volume"] = deck.spacing ** 2 * keys["thickness"] * dice.log(0.3, 30.0)
        keys["strength_seed"] = dice.whole(0, 1000)


def weaken(dice, deck, parts, bodies):
    body, a = bodies[0], deck.spacing
    keys = {"body": 1, "strength": dice.between(0.3, 1.5), "shape": dice.one_of(["disc", "polyline"])}
    x, y = (a * one for one in body.middle)
    if keys["shape"] == "disc":
        keys.update({"centre": [x, y], "radius": 2.0 * a})
    else:
        keys["points"] = [x - body.reach * a, y, x + body.reach * a, y + 2.0 * a]
    parts.append(("weakness", keys))


def breaks(dice, deck, parts, bodies, modulus, speed):
    """Limits near the strains of the impact or the load, so that much, little or nothing breaks."""
    strain = max(speed / deck.sound, 3e-3 if deck.boundary else 1e-4)
    for keys in of(parts, "material"):
        limits(dice, deck, keys, bodies, strain * dice.log(0.1, 3.0), modulus)
        if dice.chance(0.25):
            scatter(dice, deck, keys)
    if dice.chance(0.2) and user_of(bodies[:1], "solid"):
        weaken(dice, deck, parts, bodies)
    for keys in of(parts, "inclusion"):
        if dice.chance(0.5):
            keys["interface"] = dice.between(0.3, 1.0)
    of(parts, "output")[0].update({"breaks": True, "fragments": dice.chance(0.5)})
    deck.breaks = True


# ---- others ----

def rigid(dice, deck, parts, bodies):
    """The last body, unless something is prescribed to it, clear of all obstacles. Rigid bodies alone have no highest
    frequency that gives steps."""
    if deck.boundary and len(bodies) == 1 or deck.grounds[0].is_room:
        return
    keys = of(parts, "body")[-1]
    keys["rigid"] = True
    keys.pop("clearance", None)  # it has to start outside of the contact thickness
    deck.rubs = True
    solver = of(parts, "solver")[0]
    if len(bodies) == 1 and "fixed_step" not in solver:
        solver.setdefault("max_step", dice.between(0.05, 0.2) * deck.spacing / deck.sound)


def springs(dice, parts, bodies):
    """Independent ones, whose irregular triangles a smaller Poisson's ratio makes unstable; diagonals of squares."""
    for keys in of(parts, "material"):
        has_triangles = any(body.keys.get("lattice") != "square" for body in user_of(bodies, keys["name"]))
        if "bond_stiffness" not in keys and "fracture_energy" not in keys and has_triangles:
            keys["springs"] = "independent"
            keys.pop("poissons_ratio", None)
    for body, keys in zip(bodies, of(parts, "body")):
        equal = any("bond_stiffness" in one for one in of(parts, "material"))
        if body.keys.get("lattice") == "square" and not equal:
            keys["diagonal"] = dice.between(0.3, 1.0)


def copies(dice, deck, parts, bodies):
    """Beside each other, above the same ground, and no wall where they would be."""
    if deck.grounds[0].is_room or len(deck.grounds) + len(bodies) > 2 or deck.boundary or of(parts, "probe"):
        return
    keys = of(parts, "body")[0]
    keys.pop("clearance", None)
    pitch = 2.0 * bodies[0].reach + 0.5
    keys.update({"copies": [2, dice.whole(1, 2)], "pitch": [pitch * deck.spacing] * 2})
    keys["scatter"] = 0.1 * deck.spacing


def surfaces(dice, deck, parts):
    """Contact of bodies, and of a body with itself."""
    keys = of(parts, "contact")[0]
    if dice.chance(0.5):
        keys["thickness"] = deck.spacing * dice.between(0.05, 0.15)
    if dice.chance(0.5):
        keys["stiffness"] = dice.log(0.3, 5.0)
    if dice.chance(0.5):
        keys["friction"] = dice.one_of([0.1, 0.5, 1.0])
        deck.rubs = True


def rest(dice, deck, parts):
    """Quasi-static: ends at rest or fails at its end; ramps stand still after breaks."""
    of(parts, "run")[0].update({"residual": dice.log(1e-4, 1e-1), "pause": deck.breaks and dice.chance(0.7)})
    of(parts, "solver")[0]["mass_damping"] = dice.log(0.03, 0.3) * deck.sound / deck.spacing
    deck.solver = of(parts, "solver")[0]
    deck.rests = True


def add(dice_of, deck, parts, bodies, modulus, speed):
    """`dice_of` makes dice of a seed."""
    dice = dice_of(deck.seed + 0.75)
    if dice.chance(0.06):
        rigid(dice, deck, parts, bodies)
    if dice.chance(0.4):
        breaks(dice, deck, parts, bodies, modulus, speed)
    if dice.chance(0.1):
        springs(dice, parts, bodies)
    if dice.chance(0.06):
        copies(dice, deck, parts, bodies)
    if dice.chance(0.15):
        surfaces(dice, deck, parts)
    if deck.boundary and dice.chance(0.15):
        rest(dice, deck, parts)
    if dice.chance(0.05):
        of(parts, "output")[0]["history_interval"] = of(parts, "run")[0]["t_end"] / 50.0

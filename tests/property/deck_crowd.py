# SPDX-License-Identifier: BSD-3-Clause
"""Random decks of 2 to 12 bodies that run into each other: in free space, above a ground, or in a room whose walls may
move. Lengths are in spacings of the first material, as in deck_maker.py."""
import dataclasses
import math

import deck_bodies
import deck_grounds
import deck_maker
import deck_motions

METHODS = ["fehlberg45", "fehlberg45", "fehlberg45", "dopri45", "cashkarp45", "verner56", "verlet", "verlet"]


@dataclasses.dataclass
class Member:
    """A body of the crowd: `size` is its spacing, in which its own lengths are."""
    body: deck_bodies.Body
    size: float
    place: tuple = (0.0, 0.0)  # of its middle, in the deck's spacings

    def span(self):
        return self.body.span * self.size

    def takes_springs(self, material):
        return self.body.keys["material"] == material and self.body.keys.get("lattice") != "square"


def solver(dice):
    """No lower order than 4 and no fixed step but Verlet's, which needs speeds that are low."""
    keys = {"method": dice.one_of(METHODS)}
    if keys["method"] != "verlet" and dice.chance(0.4):
        keys["rtol"] = dice.log(1e-8, 1e-5)
    if dice.chance(0.1):
        keys["threads"], keys["thread_nodes"] = 2, 1
    if dice.chance(0.3):
        keys["checkpoint_steps"] = dice.one_of([0, 7, 50])
    return keys


def contact(dice, deck):
    keys = {"method": dice.one_of(["local", "local", "local", "exact"]), "bodies": dice.one_of(["all", "all", "others"])}
    if dice.chance(0.3):
        keys["thickness"] = deck.spacing * dice.between(0.05, 0.2)
    if dice.chance(0.3):
        keys["stiffness"] = dice.log(0.3, 5.0)
    return keys


def material(dice, deck, name, members, modulus, density):
    keys = {"name": name, "density": density * dice.log(0.5, 2.0), "thickness": 1.0,
            "youngs_modulus": modulus * dice.log(0.2, 5.0), "plane": dice.one_of(["stress", "strain"])}
    if dice.chance(0.3):
        keys["damping_time"] = dice.log(1e-2, 0.3) * deck.spacing / deck.sound
    if dice.chance(0.3) and any(one.takes_springs(name) for one in members):
        keys["springs"] = "independent"  # a smaller Poisson's ratio makes irregular triangles of them unstable
    else:
        # with less, impacts stretch what hangs on single cells past the limit of their stiffness (docs/limits.md)
        keys["poissons_ratio"] = dice.between(0.2, 0.42)
    return keys


def rub(deck, materials):
    """Friction of bodies with each other, of all or of a material. Dice of its own: the rest of the deck is as without."""
    dice = deck_maker.Dice(deck.seed + 0.5)
    if dice.chance(0.5):
        deck.contact["friction"] = dice.one_of([0.1, 0.3, 0.5, 1.0, dice.log(0.01, 2.0)])
    if dice.chance(0.15):
        materials[0]["friction"] = dice.between(0.0, 0.8)


def rubs(deck, materials, members):
    """Whether surfaces have friction: bodies with each other, or rigid ones with the ground."""
    is_rigid = any("rigid" in one.body.keys for one in members)
    return ("friction" in deck.contact or "friction" in materials[0] or
            is_rigid and any("friction" in ground.keys for ground in deck.grounds))


def stiffen(deck, members):
    """Makes some bodies rigid, but the first one, which boundaries are for. Dice of its own, as those of friction."""
    dice = deck_maker.Dice(deck.seed + 0.25)
    if dice.chance(0.3):
        for one in members[1:]:
            if dice.chance(0.4):
                one.body.keys["rigid"] = True


def member(dice, number, n_materials):
    body = deck_bodies.body(dice, number, False)
    if "file" in body.keys:  # each has one of its own
        name = body.keys["file"]
        body.files = {f"{number}_{name}": body.files[name]}
        body.keys["file"] = f"{number}_{name}"
    body.parts = body.parts[:1]  # more leave no room for pores
    body.keys["material"] = f"matter{dice.whole(1, n_materials)}"
    body.keys["angle"] = dice.between(-180.0, 180.0)
    return Member(body, dice.between(0.7, 1.4))


def gather(dice, members):
    """Each as near to the origin as the circles about those before leave room, in a direction of its own."""
    for k, one in enumerate(members):
        heading, way, gap = dice.between(-3.14, 3.14), 0.0, dice.between(0.3, 1.0)
        while any(math.dist((way * math.cos(heading), way * math.sin(heading)), other.place) <
                  one.span() + other.span() + gap for other in members[:k]):
            way += 0.1
        one.place = (way * math.cos(heading), way * math.sin(heading))


def settle(members):
    """Moves the crowd about the origin. Returns the radius of a circle that holds it."""
    centre = [sum(one.place[c] for one in members) / len(members) for c in (0, 1)]
    for one in members:
        one.place = (one.place[0] - centre[0], one.place[1] - centre[1])
    return max(math.hypot(*one.place) + one.span() for one in members)


def put(dice, one, lift, speed, drop):
    """Keys in metres come later; towards the middle of the crowd, more or less, which moves down at the speed `drop`."""
    turn, (x, y) = math.radians(one.body.keys["angle"]), one.body.middle
    away = [one.size * (y * math.sin(turn) - x * math.cos(turn)), -one.size * (x * math.sin(turn) + y * math.cos(turn))]
    distance = max(math.hypot(*one.place), 1.0)
    keys = {"position": [(one.place[0] + away[0]) / one.size, (one.place[1] + away[1] + lift) / one.size]}
    keys["velocity"] = [speed * (dice.between(-0.6, 0.2) * one.place[c] / distance + dice.between(-0.4, 0.4))
                        for c in (0, 1)]
    keys["velocity"][1] -= drop
    if dice.chance(0.4):
        keys["spin"] = dice.between(-1.0, 1.0) * speed
    return keys


def surroundings(dice, deck, members, radius, speed, t_end):
    """Sets grounds, motions, and a gravity that makes no body much faster. Returns by how much the crowd is lifted, and
    how fast it moves down."""
    if dice.chance(0.4):
        deck.gravity = [0.0, 0.0]
        return 0.0, 0.0
    deck.grounds, clear = deck_grounds.grounds(dice, radius, dice.chance(0.5))
    weight = dice.log(0.01, 1.0) * speed / t_end
    deck.gravity = [weight * dice.between(-0.3, 0.3), -weight]
    is_moving = dice.chance(0.6)
    deck.motions = [deck_motions.motion(dice, deck.spacing, deck.sound, radius) if is_moving else {}
                    for _ in deck.grounds]
    if clear is None:
        return 0.0, 0.0
    lowest = min(one.place[1] - one.span() for one in members)
    return clear - lowest + dice.between(0.01, 0.5), speed * dice.between(0.3, 1.0)


def body_groups(dice, deck, members, lift, speed, drop):
    parts = []
    for one in members:
        a = one.size * deck.spacing
        keys = {**one.body.keys, **put(dice, one, lift, speed, drop)}
        if "spin" in keys:
            keys["spin"] /= one.span() * deck.spacing
        parts.append(("body", deck_maker.scaled(keys, a)))
        parts += [(group, deck_maker.scaled(of, a)) for group, of in one.body.parts]
        deck.files.update(one.body.files)
    return parts


def random_crowd(seed):
    dice = deck_maker.Dice(seed)
    modulus, density, a = dice.log(1e5, 1e11), dice.between(300.0, 8000.0), dice.log(1e-3, 0.03)
    deck = deck_maker.Deck(seed, spacing=a, sound=math.sqrt(modulus / density), is_crowd=True)
    deck.solver, deck.contact = solver(dice), contact(dice, deck)
    n_materials = dice.whole(1, 3)
    members = [member(dice, k + 1, n_materials) for k in range(dice.whole(2, 12))]
    gather(dice, members)
    radius = settle(members)
    speed = deck.sound * dice.log(0.02, 0.05 if deck.solver["method"] == "verlet" else 0.15)
    t_end = dice.between(3.0, 5.0) * a / speed + dice.between(10.0, 40.0) * a / deck.sound
    lift, drop = surroundings(dice, deck, members, radius, speed, t_end)
    parts = [("run", {"title": f"crowd {seed}", "t_end": t_end, "gravity": deck.gravity})]
    materials = [material(dice, deck, f"matter{k + 1}", members, modulus, density) for k in range(n_materials)]
    deck.damping_time = max(keys.get("damping_time", 0.0) for keys in materials)
    rub(deck, materials)
    stiffen(deck, members)
    parts += [("material", keys) for keys in materials]
    parts += body_groups(dice, deck, members, lift, speed, drop)
    for ground, moving in zip(deck.grounds, deck.motions):
        ground.keys.update(deck_maker.laws(dice, False))
        keys = {"points": [x for point in ground.points for x in point], **ground.keys}
        parts.append(("obstacle", {**deck_maker.scaled(keys, a), **moving}))
    deck.rubs = rubs(deck, materials, members)
    if dice.chance(0.15):
        deck.boundary = deck_maker.boundary(dice, deck, 1, members[0].body, modulus)
        parts.append(("boundary", deck.boundary))
    parts += [("contact", deck.contact), ("solver", deck.solver), ("output", deck_maker.output(dice, t_end))]
    deck.text = "\n".join(deck_maker.write(group, keys) for group, keys in parts)
    return deck

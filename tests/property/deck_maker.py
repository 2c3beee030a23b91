# SPDX-License-Identifier: BSD-3-Clause
"""Random decks as text. All lengths are drawn in spacings, all times in spacings over the speed of sound, so that
bodies of steel and of jelly are alike; the scales themselves are drawn, too."""
import dataclasses
import math
import random

import deck_bodies
import deck_grounds
import deck_laws
import deck_motions

METHODS = ["dopri45", "cashkarp45", "zonneveld34", "bs23", "heun12", "sayfyaburub34", "ark23", "ark34", "ark34b",
           "ark45", "ark45b", "verner56", "fehlberg78"]
FIXED = ["knothwolke3", "rk4"]
YOUNG = ["verner67", "verner78", "verner89"]  # not in every SUNDIALS
FINEST = {"heun12": 1e-6, "bs23": 3e-8, "ark23": 3e-8}  # least rtol: of order 2 or 3 a step costs a power of it
FIELDS = ["displacement", "velocity", "stress", "von_mises", "principal", "strain", "force"]


class Dice:
    """Everything comes from random(), which gives the same numbers in every version of Python."""

    def __init__(self, seed):
        self.random = random.Random(seed).random

    def between(self, a, b):
        return a + (b - a) * self.random()

    def log(self, a, b):
        return a * (b / a) ** self.random()

    def chance(self, p):
        return self.random() < p

    def whole(self, a, b):
        return min(b, a + int((b - a + 1) * self.random()))

    def one_of(self, choices):
        return choices[self.whole(0, len(choices) - 1)]


@dataclasses.dataclass
class Deck:
    """What is judged besides what the program has written."""
    seed: int
    text: str = ""
    files: dict = dataclasses.field(default_factory=dict)
    grounds: list = dataclasses.field(default_factory=list)
    spacing: float = 1.0  # m
    sound: float = 1.0  # m/s
    solver: dict = dataclasses.field(default_factory=dict)
    contact: dict = dataclasses.field(default_factory=dict)
    gravity: list = dataclasses.field(default_factory=list)  # m/s^2
    boundary: dict = dataclasses.field(default_factory=dict)
    motions: list = dataclasses.field(default_factory=list)  # keys of each obstacle
    is_crowd: bool = False  # of several bodies that touch each other
    rubs: bool = False  # with friction of surfaces, not only of nodes on obstacles
    breaks: bool = False  # of a material that may break
    rests: bool = False  # quasi-static
    damping_time: float = 0.0  # s, the longest of the materials of a crowd

    def write(self, folder):
        (folder / "deck.nml").write_text(self.text, encoding="ascii")
        for name, text in self.files.items():
            (folder / name).write_text(text, encoding="ascii")


def spell(value):
    if isinstance(value, bool):
        return ".true." if value else ".false."
    if isinstance(value, str):
        return f"'{value}'"
    if isinstance(value, (list, tuple)):
        return ", ".join(spell(one) for one in value)
    return repr(value)


def write(group, keys):
    return f"&{group}\n" + "".join(f"    {key} = {spell(value)}\n" for key, value in keys.items()) + "/\n"


LENGTHS = {"size", "radius", "inner_radius", "points", "spacing", "scale", "position", "centre", "wall", "mean",
           "deviation", "clearance", "resolution", "roughness", "correlation", "box", "place", "displacement"}


def scaled(keys, a):
    """Lengths in metres."""
    return {key: value if key not in LENGTHS else [a * one for one in value] if isinstance(value, list) else a * value
            for key, value in keys.items()}


# ---- groups ----

def material(dice, a, name, modulus, density):
    keys = {"name": name, "density": density, "thickness": dice.log(0.01, 1.0)}
    if dice.chance(0.12):
        keys["bond_stiffness"] = 0.866 * modulus * keys["thickness"] * a
    else:
        keys["youngs_modulus"] = modulus
        keys["plane"] = dice.one_of(["stress", "stress", "strain"])
        if dice.chance(0.5):
            keys["poissons_ratio"] = dice.between(0.1, 0.42)
    if dice.chance(0.3):
        keys["guard"] = dice.one_of([0.0, 0.005, 0.1])
    if dice.chance(0.3):
        keys["damping_time"] = dice.log(1e-3, 0.3) * a / math.sqrt(modulus / density)
    return keys


def solver(dice, deck, harsh):
    time = deck.spacing / deck.sound
    keys = {"method": "verlet" if harsh or dice.chance(0.2) else "fehlberg45" if dice.chance(0.35) else
            dice.one_of(METHODS * 3 + FIXED * 5 + YOUNG[:1 if dice.chance(0.8) else 3])}
    if keys["method"] in YOUNG and dice.chance(0.7):
        keys["method"] = "dopri45"
    if dice.chance(0.5):
        keys["rtol"] = dice.log(FINEST.get(keys["method"], 1e-9), 1e-4)
    if dice.chance(0.15):
        keys["fixed_step"] = dice.between(0.01, 0.08) * time
    elif dice.chance(0.15):
        keys["max_step"] = dice.between(0.03, 0.2) * time
    if dice.chance(0.15):
        keys["v_scale"] = deck.sound * dice.log(1e-3, 1e-1)
    if dice.chance(0.1):
        keys["spacing"] = deck.spacing * dice.between(0.5, 1.0)
    if dice.chance(0.15):
        keys["mass_damping"] = dice.log(1e-3, 0.1) / time
    if dice.chance(0.2):
        keys["kernel"] = dice.one_of(["auto", "portable", "portable", "portable", "avx2"])
    if dice.chance(0.05):
        keys["threads"], keys["thread_nodes"] = 2, 1
    if dice.chance(0.3):
        keys["checkpoint_steps"] = dice.one_of([0, 7, 50])
    return keys


def contact(dice, deck, harsh):
    time = deck.spacing / deck.sound
    keys = {"method": "local" if harsh or dice.chance(0.6) else "exact"}
    if dice.chance(0.25):
        keys["window"] = dice.one_of([0.0, dice.log(1e-3, 0.3) * time])
    if dice.chance(0.2):
        keys["vertices"] = False
    if dice.chance(0.25):
        keys["penetration_tolerance"] = deck.spacing * dice.log(1e-7, 1e-4)
    if dice.chance(0.1):
        keys["rest_speed"] = deck.sound * dice.log(1e-5, 1e-3)  # less makes many hops
    if dice.chance(0.1):
        keys["max_impacts"] = dice.one_of([5000, 10000, 20000])
    if dice.chance(0.03):
        keys["overlap"] = "stop"
    return keys


def laws(dice, harsh):
    keys = {"restitution": dice.one_of([0.0, 0.0, 0.3, 0.5, 0.9, 1.0, dice.between(0.0, 1.0)])}
    if harsh:
        return {**keys, "friction": 1.5}
    if dice.chance(0.15):
        return {**keys, "friction_law": "paper", "friction": dice.one_of([0.0, 1.0, dice.between(0.0, 1.0)])}
    return {**keys, "friction": dice.one_of([0.0, 0.0, 0.1, 0.3, 0.5, 1.0, 1.5])}


def boundary(dice, deck, number, body, modulus):
    """Held, moved or loaded nodes, gently: a node that is prescribed is not stopped by obstacles."""
    time = deck.spacing / deck.sound
    where = dice.one_of(["side", "side", "side", "box", "disc", "list", "all"])
    kind = dice.one_of(["fix", "velocity", "displacement", "force", "force" if where == "list" else "traction"])
    if where == "all" and kind in ("fix", "velocity", "displacement"):
        kind = "force"
    (x, y), a, s = body.middle, deck.spacing, body.reach
    places = {"side": {"side": dice.one_of(["left", "right", "top"])}, "box": {"box": [x - s, y, x + s, y + s]},
              "disc": {"centre": [x, y + s], "radius": 1.2 * s}, "list": {"nodes": [2, 0, 3]}, "all": {}}
    if kind == "traction" and where in ("box", "disc"):
        where = "side"  # an edge needs two nodes
    keys = {"body": number, "where": where, "kind": kind, **scaled(places[where], a)}
    push = [dice.between(-1.0, 1.0), dice.between(-1.0, 1.0)]
    size = {"fix": 0.0, "velocity": 0.01 * deck.sound, "displacement": 0.2 * a, "force": 3e-4 * modulus * a,
            "traction": 3e-3 * modulus}[kind]
    if kind != "fix":
        keys[kind] = [size * p for p in push]
        keys["ramp"] = dice.between(0.5, 5.0) * time if kind == "displacement" or dice.chance(0.6) else 0.0
    if kind in ("fix", "velocity", "displacement") and dice.chance(0.5):
        keys["components"] = dice.one_of(["x", "y"])
    return keys


def output(dice, t_end):
    keys = {"name": "deck", "frame_interval": t_end / dice.between(10.0, 30.0),
            "precision": dice.one_of(["single", "double"]), "deflate": dice.whole(0, 9), "events": dice.chance(0.3),
            "peak_every": dice.one_of([0, 1, 4]), "most_stressed": dice.whole(0, 8)}
    if dice.chance(0.5):
        keys["fields"] = ["velocity"] + [name for name in FIELDS if name != "velocity" and dice.chance(0.5)]
    return keys


def probes(dice, body, a):
    x, y = (a * one for one in body.middle)
    return [{"name": "node", "number": 1}, {"name": "spring", "kind": "spring", "place": [x, y]},
            {"name": "gauge", "kind": "gauge", "place": [x - 2 * a, y, x + 2 * a, y], "every": dice.whole(1, 5)}]


# ---- the deck ----

def place(dice, body, clear, offset):
    """Above all obstacles, or about the middle of a room; `offset` keeps bodies apart."""
    if clear is None:
        turn = math.radians(body.keys["angle"])
        x, y = body.middle
        body.keys["position"] = [y * math.sin(turn) - x * math.cos(turn), -x * math.sin(turn) - y * math.cos(turn)]
    else:
        body.keys["position"] = [dice.between(-2.0, 2.0) + offset, clear + body.reach + dice.between(0.01, 0.1)]


def throw(dice, deck, body, speed, t_end):
    """Towards the obstacles, or any way in a room. From a clearance that it flies in a part of the time."""
    heading = dice.between(-3.14, 3.14) if deck.grounds[0].is_room else dice.between(-2.5, -0.6)
    body.keys["velocity"] = [speed * math.cos(heading), speed * math.sin(heading)]
    if dice.chance(0.4):
        body.keys["spin"] = dice.between(-1.0, 1.0) * speed / (body.reach * deck.spacing)
    if deck.gravity[1] < 0.0 and dice.chance(0.9):
        flight = dice.one_of([0.0, dice.between(0.0, 0.3)]) * t_end
        body.keys["clearance"] = (speed - 0.5 * deck.gravity[1] * flight) * flight / deck.spacing


def motions(deck, width):
    """Of all obstacles, half of the time the same one. Dice of their own: the rest of the deck is as without."""
    dice = Dice(deck.seed + 0.5)
    together = dice.chance(0.5)
    found = [deck_motions.motion(dice, deck.spacing, deck.sound, width) for _ in deck.grounds]
    return [found[0] if together else keys for keys in found]


def random_deck(seed, is_moving=False):
    """`is_moving`: the obstacles are."""
    dice = Dice(seed)
    harsh = dice.chance(0.08)  # Verlet's steps, and bodies that lie on ground of strong friction
    modulus, density, a = dice.log(1e5, 1e11), dice.between(300.0, 8000.0), dice.log(1e-3, 0.03)
    deck = Deck(seed, spacing=a, sound=math.sqrt(modulus / density))
    time = a / deck.sound
    two_materials = dice.chance(0.25)
    bodies = [deck_bodies.body(dice, k + 1, two_materials) for k in range(2 if dice.chance(0.1) else 1)]
    width = max(body.reach for body in bodies) * (3.0 if len(bodies) > 1 else 1.0)
    deck.grounds, clear = deck_grounds.grounds(dice, width, harsh)
    speed = 0.0 if dice.chance(0.5 if harsh else 0.1) else deck.sound * dice.log(3e-4, 0.02 if harsh else 0.1)
    weight = dice.log(*([1e-7, 1e-4] if harsh else [1e-6, 3e-3])) * deck.sound / time
    weight *= not (speed > 0.0 and dice.chance(0.1))
    t_end = time * dice.between(5.0, 25.0) * (4.0 if harsh else 1.0)
    deck.gravity = [weight * dice.between(-0.3, 0.3), -weight]
    deck.solver, deck.contact = solver(dice, deck, harsh), contact(dice, deck, harsh)
    for k, body in enumerate(bodies):
        body.keys["angle"] = 0.0 if dice.chance(0.7 if harsh else 0.3) else dice.between(-180.0, 180.0)
        place(dice, body, clear, 0.0 if len(bodies) == 1 else (2.0 * k - 1.0) * (0.5 * width - 2.5))
        throw(dice, deck, body, speed, t_end)
        deck.files.update(body.files)
    run = {"title": f"deck {seed}", "t_end": t_end, "gravity": deck.gravity}
    parts = [("run", run), ("material", material(dice, a, "solid", modulus, density))]
    if two_materials:
        parts.append(("material", material(dice, a, "soft", modulus * dice.between(0.3, 1.0), density)))
    for body in bodies:
        parts += [("body", scaled(body.keys, a))] + [(group, scaled(keys, a)) for group, keys in body.parts]
    deck.motions = motions(deck, width) if is_moving else [{} for _ in deck.grounds]
    for ground, moving in zip(deck.grounds, deck.motions):
        ground.keys.update(laws(dice, harsh))
        keys = scaled({"points": [x for point in ground.points for x in point], **ground.keys}, a)
        parts.append(("obstacle", {**keys, **moving}))
    if dice.chance(0.25):
        deck.boundary = boundary(dice, deck, 1, bodies[0], modulus)
        parts.append(("boundary", deck.boundary))
    parts += [("contact", deck.contact), ("solver", deck.solver), ("output", output(dice, t_end))]
    if dice.chance(0.2):
        parts += [("probe", keys) for keys in probes(dice, bodies[0], a)]
    deck_laws.add(Dice, deck, parts, bodies, modulus, speed)
    deck.text = "\n".join(write(group, keys) for group, keys in parts)
    return deck

# SPDX-License-Identifier: BSD-3-Clause
"""Random bodies of a deck: their shapes and what is cut out of them. Lengths are in spacings."""
import dataclasses
import math


@dataclasses.dataclass
class Body:
    """Keys of &body in spacings, the groups that belong to it, and the files that it reads."""
    keys: dict
    reach: float  # from the origin
    middle: tuple = (0.0, 0.0)
    room: float = 0.0  # radius of what fits in about the middle
    span: float = 0.0  # radius of what holds it about the middle
    parts: list = dataclasses.field(default_factory=list)  # (group, keys)
    files: dict = dataclasses.field(default_factory=dict)


def rectangle(dice):
    width, height = dice.between(3.0, 14.0), dice.between(3.0, 14.0)
    return Body({"shape": "rectangle", "size": [width, height]}, math.hypot(width / 2, height), (0.0, height / 2),
                min(width, height) / 2, math.hypot(width, height) / 2)


def disc(dice):
    radius = dice.between(2.5, 7.0)
    return Body({"shape": "disc", "radius": radius}, radius, room=radius, span=radius)


def ring(dice):
    radius = dice.between(5.0, 8.0)
    return Body({"shape": "ring", "radius": radius, "inner_radius": radius - dice.between(2.2, 3.5)}, radius,
                span=radius)


def polygon(dice):
    number, turn = dice.whole(3, 7), dice.between(0.0, 6.28)
    points, sense = [], dice.one_of([1.0, -1.0])
    for k in range(number):
        radius, angle = dice.between(4.0, 8.0), turn + sense * 2.0 * math.pi * k / number
        points += [radius * math.cos(angle), radius * math.sin(angle)]
    return Body({"shape": "polygon", "points": points}, 8.0, span=8.0)


def mask(dice):
    width, height = dice.whole(6, 12), dice.whole(6, 12)
    rows = [[0 if dice.chance(0.03) else dice.whole(128, 255) for _ in range(width)] for _ in range(height)]
    text = f"P2\n{width} {height}\n255\n" + "\n".join(" ".join(map(str, row)) for row in rows) + "\n"
    return Body({"shape": "mask", "file": "mask.pgm", "scale": 1.0}, math.hypot(width / 2, height), (0.0, height / 2),
                span=math.hypot(width, height) / 2, files={"mask.pgm": text})


def mesh(dice):
    """A sheared and distorted grid of triangles."""
    columns, rows, shear, rough = dice.whole(3, 10), dice.whole(3, 10), dice.between(0.0, 0.5), dice.between(0.0, 0.2)
    places = [(x + shear * y + dice.between(-rough, rough), 0.9 * y + dice.between(-rough, rough))
              for y in range(rows + 1) for x in range(columns + 1)]
    triangles = []
    for y in range(rows):
        for x in range(columns):
            a = y * (columns + 1) + x + 1
            triangles += [(a, a + 1, a + columns + 1), (a + 1, a + columns + 2, a + columns + 1)]
    n, m = len(places), len(triangles)
    lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$Nodes", f"1 {n} 1 {n}", f"2 1 0 {n}",
             *(str(k + 1) for k in range(n)), *(f"{x!r} {y!r} 0" for x, y in places), "$EndNodes",
             "$Elements", f"1 {m} 1 {m}", f"2 1 2 {m}",
             *(f"{k + 1} {a} {b} {c}" for k, (a, b, c) in enumerate(triangles)), "$EndElements"]
    middle = (columns + shear * rows) / 2, 0.45 * rows
    reach = math.hypot(2 * middle[0], 2 * middle[1]) + 1.0
    return Body({"shape": "mesh", "file": "mesh.msh", "scale": 1.0}, reach, middle, min(columns, rows) / 2.5,
                reach / 2 + 0.5, files={"mesh.msh": "\n".join(lines) + "\n"})


def form(dice, radius):
    """Keys of a shape that fits in a circle of the radius, and takes a node wherever it is."""
    shape = dice.one_of(["disc", "rectangle", "ring", "polygon"])
    if shape == "disc":
        return {"shape": shape, "radius": radius}
    if shape == "ring":
        return {"shape": shape, "radius": radius, "inner_radius": 0.3 * radius}
    keys = {"shape": shape, "angle": dice.between(-90.0, 90.0)}
    if shape == "rectangle":
        return {**keys, "size": [1.4 * radius, 1.4 * radius]}
    return {**keys, "points": [radius * f(2.0 * math.pi * k / 3) for k in range(3) for f in (math.cos, math.sin)]}


def part(dice, body, number, soft):
    """One void, crack, inclusion or set of pores, or of a mesh what may be in one."""
    kind = dice.one_of(["void", "crack", "pores"] + (["inclusion"] if soft else []))
    if body.keys["shape"] == "mesh" and kind != "inclusion":
        kind = "crack"  # a mesh has its voids from the mesher
    turn, way = dice.between(0.0, 6.28), 0.4 * body.room * dice.between(0.0, 1.0)
    at = [body.middle[0] + way * math.cos(turn), body.middle[1] + way * math.sin(turn)]
    if kind == "crack":
        half = dice.between(0.8, 0.5 * body.room + 0.8)
        return kind, {"body": number, "points": [at[0] - half * math.cos(turn), at[1] - half * math.sin(turn),
                                                 at[0] + half * math.cos(turn), at[1] + half * math.sin(turn)]}
    if kind == "pores":
        return kind, pores(dice, number)
    keys = {"body": number, "centre": at, **form(dice, dice.between(1.3, 1.8))}
    return kind, {**keys, "material": "soft"} if kind == "inclusion" else keys


def pores(dice, number):
    least, most = dice.between(0.6, 0.8), dice.between(0.9, 1.2)
    keys = {"body": number, "radius": [least, most], "wall": dice.between(0.8, 1.2), "seed": dice.whole(0, 1000)}
    keys.update({"porosity": dice.between(0.02, 0.06)} if dice.chance(0.3) else {"number": dice.whole(1, 2)})
    distribution = dice.one_of(["uniform", "lognormal", "normal"])
    if distribution != "uniform":
        keys.update({"distribution": distribution, "mean": 0.9, "deviation": 0.2})
    return keys


def body(dice, number, soft):
    """`soft`: whether there is a material of that name."""
    made = dice.one_of([rectangle, rectangle, rectangle, disc, disc, ring, polygon, polygon, mask, mesh])(dice)
    shape = made.keys["shape"]
    if shape != "mesh":
        made.keys["spacing"] = 1.0
        if dice.chance(0.3):
            made.keys.update({"jitter": dice.between(0.0, 0.3), "seed": dice.whole(0, 1000)})
        if dice.chance(0.25):
            made.keys["lattice"] = "square"
        elif shape != "mask" and dice.chance(0.3):
            made.keys["outline"] = "smooth"
    if shape == "mask":
        made.keys["threshold"] = 0.3
    if made.room > 3.5 and dice.chance(0.35):
        made.parts = [part(dice, made, number, soft) for _ in range(dice.whole(1, 2))]
    made.keys["disconnected"] = dice.one_of(["remove", "remove", "keep"])
    if soft and dice.chance(0.3):
        made.keys["material"] = "soft"
    return made

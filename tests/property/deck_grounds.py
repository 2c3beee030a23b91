# SPDX-License-Identifier: BSD-3-Clause
"""Random obstacles, and the solid that each stands for. Lengths are in spacings."""
import dataclasses
import math

FAR = 1000.0  # how deep an open polyline's solid goes


@dataclasses.dataclass
class Ground:
    """An obstacle's points, and the points that close its solid where the polyline is open."""
    points: list
    closing: list = dataclasses.field(default_factory=list)
    is_room: bool = False  # bodies live inside
    keys: dict = dataclasses.field(default_factory=dict)
    lift: float = 0.0  # what a profile may add to the height of its points

    def top(self):
        return max(y for _, y in self.points) + self.lift


def buried(points):
    (left, _), (right, _) = points[0], points[-1]
    return Ground(points, [(right, -FAR), (left, -FAR)])


def flat(_dice, half):
    return buried([(-half, 0.0), (half, 0.0)])


def slope(dice, half):
    rise = dice.between(-0.8, 0.8)
    return buried([(-half, -rise * half), (half, rise * half)])


def step(dice, half):
    edge, height = dice.between(-2.0, 2.0), dice.between(-3.0, 3.0)
    return buried([(-half, 0.0), (edge, 0.0), (edge + dice.one_of([0.0, 0.3, 2.0]), height), (half, height)])


def valley(dice, half):
    bottom, depth = dice.between(-2.0, 2.0), dice.between(0.3, 2.0) * half
    floor = dice.one_of([[(bottom, -depth)], [(bottom - 1.5, -depth), (bottom + 1.5, -depth)]])
    return buried([(-half, 0.0), *floor, (half, 0.0)])


def spikes(dice, half):
    number, tilt = dice.whole(1, 8), dice.between(-0.4, 0.4)
    pitch = 12.0 / number
    width = min(0.8 * pitch, dice.log(0.1, 3.0))
    points = [(-half, -half * tilt)]
    for k in range(number):
        x = -6.0 + k * pitch
        tip = x + width * dice.between(0.0, 1.0)
        points += [(x, tilt * x), (tip, tilt * tip + dice.between(0.2, 3.0)), (x + width, tilt * (x + width))]
    return buried(points + [(half, half * tilt)])


def terrain(dice, half):
    number, steep = dice.whole(2, 12), dice.between(0.0, 1.5)
    points, pitch, y = [], 2.0 * half / number, 0.0
    for k in range(number + 1):
        points.append((pitch * k - half, y))
        y += pitch * dice.between(-steep, steep)
    return buried(points)


def profile(dice, half):
    heights = dice.between(-3.0, 3.0), dice.between(-3.0, 3.0)
    ground = buried([(-half, 0.0), (-0.3 * half, heights[0]), (0.4 * half, heights[1]), (half, 0.0)])
    if dice.chance(0.4):
        ground.keys = {"profile": "smooth", "resolution": half / dice.whole(10, 40)}
        return ground
    length = dice.log(1.0, 6.0)
    height = length * dice.between(0.02, 0.25)
    ground.keys = {"profile": "rough", "roughness": height, "correlation": length,
                   "resolution": length / dice.between(2.5, 6.0), "seed": dice.whole(0, 4294967295)}
    ground.lift = 5.0 * height
    return ground


def star(dice, at, radii, is_room):
    number, turn, sense = dice.whole(3, 8), dice.between(0.0, 6.28), 1.0 if is_room else -1.0
    points = []
    for k in range(number):
        radius, angle = dice.between(*radii), turn + sense * 2.0 * math.pi * k / number
        if is_room:
            radius /= math.cos(math.pi / number)  # the least is that of the circle that fits in
        points.append((at[0] + radius * math.cos(angle), at[1] + radius * math.sin(angle)))
    return Ground(points + points[:1], is_room=is_room)


def block(dice, below, width):
    """Floats above what is below, or is half in it."""
    size = dice.between(0.3, 2.5)
    at = dice.between(-width, width), below + size * dice.one_of([-0.4, 1.1, 1.1])
    return star(dice, at, (size * dice.between(0.3, 1.0), size), False)


def wall(dice, ground, width):
    """Stands on the ground, its solid on the right, which goes on behind the ground."""
    x, lean, height = width * dice.between(1.1, 1.6), dice.between(0.0, 5.0), 4.0 * width
    foot = next(a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1]) for a, b in zip(ground.points, ground.points[1:])
                if a[0] <= x <= b[0])
    back = x - lean / height * FAR
    return Ground([(x, foot), (x + lean, foot + height)], [(FAR, foot + height), (FAR, foot - FAR), (back, foot - FAR)])


def grounds(dice, width, is_plain):
    """Obstacles for a body that is within `width` of its origin, and the height above which it is clear of them, or
    None if it is in a room about the origin. `is_plain`: often flat, never a room."""
    if dice.chance(0.0 if is_plain else 0.15):
        return [star(dice, (0.0, 0.0), (1.1 * width, dice.between(1.2, 1.6) * width), True)], None
    kinds = [flat, slope, step, valley, spikes, spikes, terrain, terrain, profile]
    kind = flat if is_plain and dice.chance(0.5) else dice.one_of(kinds)
    first = kind(dice, 6.0 * width)
    found = [first]
    if dice.chance(0.3):
        found.append(block(dice, first.top(), width))
    if kind is not profile and dice.chance(0.15):
        found.append(wall(dice, first, width))
    return found, max(ground.top() for ground in found[:2])

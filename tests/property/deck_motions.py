# SPDX-License-Identifier: BSD-3-Clause
"""Random motions of obstacles, and where they are at a time by arithmetic of its own. Speeds are drawn in the speed of
sound, times in spacings over it."""
import math

import numpy as np


def motion(dice, spacing, sound, width):
    """Keys of one obstacle; `width` in spacings."""
    time, speed = spacing / sound, sound * dice.log(1e-4, 2e-2)
    kinds = dice.one_of([["translate"], ["oscillate"], ["rotate"], ["oscillate", "rotate"],
                         ["translate", "oscillate", "rotate"]])
    keys = {"motion": kinds}
    heading = dice.between(-3.14, 3.14)
    way = [math.cos(heading), math.sin(heading)]
    if "translate" in kinds:
        keys["velocity"] = [speed * one for one in way]
    if "oscillate" in kinds:
        keys["frequency"] = 1.0 / (time * dice.log(3.0, 30.0))
        keys["amplitude"] = [speed / (2.0 * math.pi * keys["frequency"]) * one for one in way]
        keys["phase"] = dice.between(-180.0, 180.0) if dice.chance(0.5) else 0.0
    if "rotate" in kinds:
        keys["spin"] = dice.one_of([-1.0, 1.0]) * speed / (width * spacing)
        keys["pivot"] = [spacing * width * dice.between(-2.0, 2.0), spacing * width * dice.between(-2.0, 2.0)]
    if dice.chance(0.3):
        keys["ramp"] = time * dice.between(1.0, 10.0)
    return keys


def ramp(keys, t):
    """r, and its integral."""
    length = keys.get("ramp", 0.0)
    s = min(1.0, t / length) if length > 0.0 else 1.0
    value = s ** 3 * (10.0 - 15.0 * s + 6.0 * s * s)
    return value, length * s ** 4 * (2.5 - 3.0 * s + s * s) if s < 1.0 else t - 0.5 * length


def place(keys, points, t):
    """Points of an obstacle at t."""
    value, area = ramp(keys, t)
    swing = math.sin(2.0 * math.pi * keys.get("frequency", 0.0) * t + math.radians(keys.get("phase", 0.0)))
    angle, pivot = keys.get("spin", 0.0) * area, np.array(keys.get("pivot", [0.0, 0.0]))
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    way = area * np.array(keys.get("velocity", [0.0, 0.0])) + value * swing * np.array(keys.get("amplitude", [0.0, 0.0]))
    return (points - pivot) @ turn.T + pivot + way

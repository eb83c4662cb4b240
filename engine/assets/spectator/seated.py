"""Clips of a seated spectator and the ways onto and off the seat."""

from __future__ import annotations

import numpy as np

from .curves import Performance
from .poses import seated, standing


def sit_idle() -> Performance:
    """Breathe, look about, shift the weight: watching a calm game."""
    p = Performance("sit_idle", 7.0, seated())
    p.wave("chest", (-0.020, 0.0, 0.0), 2, 0.25).wave("shrug", -0.018, 2, 0.25)
    p.wave("spine", (0.010, 0.0, 0.006), 2, 0.10)
    p.wave("spine", (0.012, 0.014, 0.016), 1)
    look = ((0.0, (0, 0, 0)), (0.7, (0.0, 0.0, 0.0)), (1.25, (0.02, 0.42, 0.03)))
    back = ((3.0, (0.03, 0.38, 0.02)), (3.7, (-0.02, -0.30, -0.03)), (5.4, (0.01, -0.34, -0.02)))
    p.key("head", *look, *back, (6.3, (0.0, 0.0, 0.0)), (7.0, (0, 0, 0)))
    p.key(
        "neck",
        (0, (0, 0, 0)),
        (0.8, (0, 0, 0)),
        (1.45, (0.02, 0.16, 0.02)),
        (3.1, (0.0, 0.15, 0.0)),
        (4.0, (0.0, -0.14, -0.02)),
        (5.5, (0.0, -0.13, 0.0)),
        (6.6, (0, 0, 0)),
        (7, (0, 0, 0)),
    )
    p.key(
        "chest",
        (0, (0, 0, 0)),
        (0.9, (0, 0, 0)),
        (1.8, (0.0, 0.07, 0.01)),
        (3.2, (0.0, 0.06, 0.0)),
        (4.4, (0.02, -0.06, -0.012)),
        (5.6, (0.01, -0.05, 0.0)),
        (7, (0, 0, 0)),
    )
    p.wave("head", (0.016, 0.02, 0.010), 3, 0.05).wave("head", (0.008, 0.012, 0.01), 5)
    p.key("curl_l", (0, 0), (2.2, 0), (2.5, 0.22), (2.8, 0.02), (3.1, 0.18), (3.6, 0), (7, 0))
    p.key("rest_r", (0, (0, 0, 0)), (3.9, (0, 0, 0)), (4.6, (0.004, -0.002, 0.03)), (7, (0, 0, 0)))
    p.wave("hips_turn", (0.0, 0.0, 0.012), 1)
    return p


def sit_idle_2() -> Performance:
    """Lean forward with the forearms nearer the knees, follow the play, and settle back."""
    p = Performance("sit_idle_2", 8.0, seated())
    p.key(
        "hips_turn",
        (0, (0, 0, 0)),
        (0.5, (-0.03, 0, 0)),
        (1.7, (0.27, 0.01, 0)),
        (5.4, (0.25, -0.01, 0.0)),
        (7.0, (-0.02, 0, 0)),
        (8, (0, 0, 0)),
    )
    p.key(
        "spine",
        (0, (0, 0, 0)),
        (0.6, (-0.03, 0, 0)),
        (1.9, (0.20, 0.02, 0.01)),
        (3.6, (0.17, -0.05, -0.01)),
        (5.5, (0.20, 0.03, 0.0)),
        (7.2, (-0.03, 0, 0)),
        (8, (0, 0, 0)),
    )
    p.key(
        "chest",
        (0, (0, 0, 0)),
        (0.7, (-0.02, 0, 0)),
        (2.1, (0.13, 0.04, 0.01)),
        (3.8, (0.10, -0.10, -0.01)),
        (5.6, (0.12, 0.05, 0.0)),
        (7.3, (-0.02, 0, 0)),
        (8, (0, 0, 0)),
    )
    p.key(
        "neck",
        (0, (0, 0, 0)),
        (0.7, (0.03, 0, 0)),
        (1.8, (-0.26, 0, 0)),
        (5.4, (-0.24, 0, 0)),
        (7.0, (0.02, 0, 0)),
        (8, (0, 0, 0)),
    )
    p.key(
        "head",
        (0, (0, 0, 0)),
        (0.6, (0.04, 0, 0)),
        (1.7, (-0.22, 0.10, 0)),
        (2.6, (-0.20, 0.34, 0.03)),
        (3.5, (-0.18, -0.30, -0.03)),
        (4.4, (-0.21, -0.36, -0.02)),
        (5.3, (-0.20, 0.12, 0.02)),
        (6.9, (0.03, 0.03, 0)),
        (8, (0, 0, 0)),
    )
    slide = ((0, (0, 0, 0)), (0.6, (0, 0.002, -0.015)), (1.9, (-0.02, -0.008, 0.115)))
    p.key("rest_l", *slide, (5.5, (-0.018, -0.008, 0.11)), (7.1, (0, 0, 0)), (8, (0, 0, 0)))
    slide = ((0, (0, 0, 0)), (0.7, (0, 0.002, -0.012)), (2.1, (-0.03, -0.006, 0.10)))
    p.key("rest_r", *slide, (5.6, (-0.03, -0.006, 0.10)), (7.25, (0, 0, 0)), (8, (0, 0, 0)))
    p.wave("chest", (-0.018, 0.0, 0.0), 2, 0.25).wave("shrug", -0.016, 2, 0.25)
    p.wave("spine", (0.010, 0.010, 0.012), 1).wave("head", (0.014, 0.022, 0.012), 3)
    p.wave("head", (0.007, 0.010, 0.008), 5, 0.1)
    return p


def stand_up() -> Performance:
    """Gather, lean over the feet, push off the thighs, rise, overshoot and settle."""
    start, goal = seated(), standing()
    p = Performance("stand_up", 1.9, start, looping=False)
    rise = goal["hips"] - start["hips"]
    p.key(
        "hips",
        (0, (0, 0, 0)),
        (0.18, (0.0, -0.004, -0.012)),
        (0.62, (0.006, 0.012, 0.085)),
        (0.90, (0.012, 0.115, 0.225)),
        (1.16, (0.016, 0.285, 0.350)),
        (1.45, np.add(rise, (0.004, -0.004, 0.020))),
        (1.66, np.add(rise, (0.002, 0.002, 0.006))),
        (1.9, rise),
    )
    p.key(
        "hips_turn",
        (0, (0, 0, 0)),
        (0.20, (-0.05, 0, 0)),
        (0.70, (0.62, 0.01, 0)),
        (0.92, (0.68, 0.02, -0.01)),
        (1.22, (0.42, 0.0, -0.02)),
        (1.52, (0.19, -0.03, -0.022)),
        (1.68, (0.205, -0.03, -0.022)),
        (1.9, goal["hips_turn"] - start["hips_turn"]),
    )
    for name, bend, over in (("spine", 0.20, -0.05), ("chest", 0.16, -0.06)):
        late = 0.04 if name == "spine" else 0.09
        p.key(
            name,
            (0, (0, 0, 0)),
            (0.18 + late, (-0.06, 0, 0)),
            (0.68 + late, (bend, 0.02, 0)),
            (1.12 + late, (bend * 0.3, 0.03, 0.01)),
            (1.48 + late, np.add(goal[name] - start[name], (over, 0, 0))),
            (1.9, goal[name] - start[name]),
        )
    for name, lift, nod in (("neck", -0.30, 0.04), ("head", -0.30, 0.07)):
        p.key(
            name,
            (0, (0, 0, 0)),
            (0.22, (nod, 0, 0)),
            (0.62, (lift, 0.0, 0)),
            (1.0, (lift, 0.02, 0.0)),
            (1.48, np.add(goal[name] - start[name], (nod, 0.0, 0.0))),
            (1.9, goal[name] - start[name]),
        )
    p.key(
        "rest_l",
        (0, (0, 0, 0)),
        (0.18, (0, 0, -0.018)),
        (0.62, (-0.01, 0.0, 0.115)),
        (1.0, (0.04, 0.10, 0.16)),
        (1.3, (0.1, 0.2, 0.12)),
        (1.9, goal["rest_l"] - start["rest_l"]),
    )
    p.key(
        "rest_r",
        (0, (0, 0, 0)),
        (0.20, (0, 0, -0.018)),
        (0.66, (-0.01, 0.0, 0.12)),
        (1.05, (0.04, 0.10, 0.17)),
        (1.35, (0.1, 0.2, 0.12)),
        (1.9, goal["rest_r"] - start["rest_r"]),
    )
    for side, late in (("_l", 0.0), ("_r", 0.06)):
        p.towards(goal, "hold" + side, keys=((0.72 + late, 0), (1.22 + late, 1)))
        p.towards(goal, "wrist" + side, keys=((0.75 + late, 0), (1.25 + late, 1)))
        p.towards(goal, "palm" + side, "finger" + side, keys=((0.78 + late, 0), (1.35 + late, 1)))
        p.towards(goal, "elbow" + side, keys=((0.6, 0), (1.4 + late, 1)))
        p.towards(goal, "curl" + side, keys=((0.9, 0), (1.5 + late, 1.2), (1.9, 1)))
        p.key(
            "hand" + side,
            (0, (0, 0, 0)),
            (0.9, (0.015, 0.03, 0.02)),
            (1.30 + late, (0.03, 0.015, -0.05)),
            (1.58 + late, (0.008, 0.0, 0.030)),
            (1.9, goal["hand" + side] - start["hand" + side]),
        )
    p.towards(goal, "knee", keys=((0.7, 0), (1.5, 1)))
    return p.settle(goal)


def sit_down() -> Performance:
    """Glance at the seat, reach back with the hips, sink, touch down and settle."""
    start, goal = standing(), seated()
    p = Performance("sit_down", 2.05, start, looping=False)
    sink = goal["hips"] - start["hips"]
    p.key(
        "hips",
        (0, (0, 0, 0)),
        (0.22, (-0.008, 0.004, 0.018)),
        (0.60, (-0.012, -0.075, -0.125)),
        (1.00, (-0.012, -0.240, -0.310)),
        (1.38, np.add(sink, (0.0, 0.006, 0.018))),
        (1.52, np.add(sink, (0.0, -0.006, 0.004))),
        (1.72, np.add(sink, (0.0, 0.001, 0.0))),
        (2.05, sink),
    )
    p.key(
        "hips_turn",
        (0, (0, 0, 0)),
        (0.20, (-0.03, 0.01, 0.0)),
        (0.75, (0.40, 0.04, 0.02)),
        (1.15, (0.48, 0.04, 0.02)),
        (1.45, (0.26, 0.03, 0.022)),
        (1.80, (-0.24, 0.03, 0.022)),
        (2.05, goal["hips_turn"] - start["hips_turn"]),
    )
    for name, bend, over in (("spine", 0.24, 0.05), ("chest", 0.20, 0.06)):
        late = 0.03 if name == "spine" else 0.07
        p.key(
            name,
            (0, (0, 0, 0)),
            (0.70 + late, (bend, -0.06, 0)),
            (1.15 + late, (bend * 0.9, -0.03, 0)),
            (1.50 + late, np.add(goal[name] - start[name], (over, 0, 0))),
            (1.80 + late, np.add(goal[name] - start[name], (-0.3 * over, 0, 0))),
            (2.05, goal[name] - start[name]),
        )
    for name, turn in (("neck", -0.22), ("head", -0.46)):
        p.key(
            name,
            (0, (0, 0, 0)),
            (0.30, (0.16, turn, 0.03)),
            (0.55, (0.14, turn, 0.03)),
            (1.05, (-0.16, -0.04, 0.0)),
            (1.45, (-0.12, 0.0, 0)),
            (1.62, np.add(goal[name] - start[name], (0.07, 0, 0))),
            (2.05, goal[name] - start[name]),
        )
    for side, late in (("_l", 0.05), ("_r", 0.0)):
        p.key(
            "hand" + side,
            (0, (0, 0, 0)),
            (0.28, (0.0, 0.0, -0.02)),
            (0.85 + late, (0.02, 0.05, 0.13)),
            (1.6, (0.0, 0.03, 0.05)),
            (2.05, goal["hand" + side] - start["hand" + side]),
        )
        p.towards(goal, "hold" + side, keys=((0.62 + late, 0), (1.18 + late, 1)))
        p.towards(goal, "wrist" + side, keys=((0.55 + late, 0), (1.15 + late, 1)))
        p.towards(goal, "palm" + side, "finger" + side, keys=((0.5 + late, 0), (1.1 + late, 1)))
        p.towards(goal, "elbow" + side, keys=((0.4, 0), (1.25 + late, 1)))
        p.towards(goal, "curl" + side, keys=((0.6, 0), (1.4 + late, 1)))
        reach = (0.02, 0.10, 0.16)
        p.key(
            "rest" + side,
            (0, reach),
            (0.85, reach),
            (1.22 + late, (-0.005, 0.004, 0.10)),
            (1.85, (0, 0, 0)),
        )
        p.towards(goal, "rest" + side, keys=((0, 1), (2.05, 1)))
    p.towards(goal, "knee", keys=((0.3, 0), (1.2, 1)))
    return p.settle(goal)

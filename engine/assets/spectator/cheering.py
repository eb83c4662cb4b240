"""Joy with raised arms: up they go, cheering, single beats of it, swaying, and down again."""

from __future__ import annotations

import numpy as np

from . import gestures as g
from .acting import Acting, Shape
from .curves import Performance, Pose
from .poses import arms_up
from .rotations import Array

_RAISED = {name: arms_up()[name + "_l"] for name in g.FIST_HIGH}
UP_SECONDS, DOWN_SECONDS = 1 / 3, 0.4
"""Ten and twelve pose frames."""


def arm_up(name: str, base: Pose, goal: Pose, style: int = 1) -> Acting:
    """From rest to arms up in ten pose frames.

    Styles: both arms through the front, one after the other, wide through the sides, and fists
    from the chest.
    """
    p = Acting(name, UP_SECONDS, base, looping=False, goal=goal, snap=2.6)
    via: dict[str, Shape] = {
        "_l": {"hand": (0.23, 0.22, 0.40), "finger": (0.0, 0.4, 0.9)},
        "_r": {"hand": (0.23, 0.22, 0.40), "finger": (0.0, 0.4, 0.9)},
    }
    late = {"_l": 0.0, "_r": 0.015}
    if style == 2:
        late = {"_l": 0.03, "_r": 0.0}
    elif style == 3:
        via = {side: {"hand": (0.56, 0.20, 0.12), "finger": (0.9, 0.3, 0.2)} for side in via}
    elif style == 4:
        via = {side: {**g.FIST_LOW, "curl": 1.6} for side in via}
    if p.stands:
        p.move(0.0, 0.10, hips=(0.0, -0.055, -0.02)).move(0.0, 0.10, spine=(0.07, 0, 0))
        p.move(0.0, 0.10, chest=(0.06, 0, 0))
    for side, shape in via.items():
        p.hand(side, late[side], 0.15 + late[side], {**shape, "hold": 0.0})
    p.back(0.08, 0.30)
    return p


def arm_down(name: str, base: Pose, goal: Pose, style: int = 1) -> Acting:
    """From arms up to rest in twelve pose frames; styles as for `arm_up`."""
    p = Acting(name, DOWN_SECONDS, base, looping=False, goal=goal, snap=2.4)
    out = {
        1: (0.30, 0.15, 0.36),
        2: (0.32, 0.10, 0.34),
        3: (0.56, 0.18, 0.12),
        4: (0.24, 0.12, 0.30),
    }
    late = {"_l": 0.0, "_r": 0.02 if style != 2 else 0.07}
    for side in ("_l", "_r"):
        p.hand(
            side, late[side], 0.18 + late[side], {"hand": out[style], "elbow": (0.8, -0.6, -0.6)}
        )
        p.hand(side, late[side], 0.18 + late[side], {"curl": 1.8 if style == 4 else 0.4})
    p.back(0.05, 0.34)
    return p


def cheer(name: str, base: Pose) -> Performance:
    """Bounce with both arms up, hands opening and closing."""
    p = Performance(name, 2.0, base)
    if base["hips"][1] > 0.8:
        p.wave("hips", (0.0, 0.022, 0.0), 4, 0.25).wave("hips", (0.014, 0.0, 0.0), 2)
        p.wave("hips", (0.008, 0.0, 0.006), 1).wave("hips_turn", (0.035, 0.0, 0.0), 4, 0.15)
    p.wave("hips_turn", (0.0, 0.05, 0.03), 1)
    p.wave("spine", (0.030, 0.0, 0.0), 4, 0.05).wave("chest", (0.045, 0.0, 0.0), 4, -0.02)
    p.wave("spine", (0.0, -0.04, -0.035), 1).wave("chest", (0.0, 0.05, -0.03), 1, 0.1)
    p.wave("neck", (0.03, 0.0, 0.0), 4, -0.08).wave("head", (0.07, 0.0, 0.0), 4, -0.14)
    p.wave("head", (0.03, 0.16, 0.05), 1, 0.1)
    p.wave("hand_l", (0.012, 0.040, 0.030), 4, -0.35)
    p.wave("hand_r", (0.014, 0.048, 0.034), 4, -0.43)
    p.wave("hand_l", (0.030, 0.012, 0.03), 1, 0.3).wave("hand_r", (0.040, 0.020, -0.03), 2, 0.15)
    p.wave("curl_l", 0.30, 2, -0.25).wave("curl_r", 0.38, 2, -0.25)
    return p.wave("shrug", 0.05, 4, -0.3)


def cheer_2(name: str, base: Pose) -> Acting:
    """Pull both fists down hard and throw them up again, two times."""
    p = Acting(name, 2.2, base, snap=1.6)
    for begin, deep in ((0.05, 1.0), (1.05, 0.85)):
        for side, late in (("_l", 0.02), ("_r", 0.0)):
            low = {**g.FIST_LOW, "hand": (0.22, 0.64 - 0.44 * deep, 0.27), "wrist": 0.5}
            p.hand(side, begin + late, begin + 0.30 + late, low)
            p.hand(side, begin + 0.40 + late, begin + 0.62 + late, {**_RAISED, "curl": 2.0})
        p.move(begin, begin + 0.30, spine=(0.13 * deep, 0.03, 0), chest=(0.16 * deep, 0.04, 0))
        p.move(begin, begin + 0.30, hips_turn=(0.10, 0, 0), head=(0.08, -0.05, 0))
        p.move(begin + 0.40, begin + 0.62, spine=(-0.02, 0, 0), chest=(-0.03, -0.05, 0))
        p.move(begin + 0.40, begin + 0.62, hips_turn=(0, 0, 0), head=(-0.08, 0.08, 0.03))
        if p.stands:
            p.move(begin, begin + 0.30, hips=(0, -0.07, -0.02))
            p.move(begin + 0.40, begin + 0.60, hips=(0, 0.022, 0.012))
    p.back(1.72, 2.05)
    return p.live(0.4, 0.5)


def cheer_3(name: str, base: Pose) -> Performance:
    """Arms high and wide, shaking the hands, turning from side to side."""
    p = Performance(name, 2.0, base)
    _bounce(p, 5, 0.020)
    p.wave("hips_turn", (0.0, 0.14, 0.02), 1).wave("spine", (0.0, 0.12, 0.05), 1, -0.03)
    p.wave("chest", (0.0, 0.14, 0.06), 1, -0.06).wave("head", (0.02, 0.10, -0.05), 1, -0.1)
    for side, phase in (("_l", 0.0), ("_r", 0.5)):
        p.wave("hand" + side, (0.055, -0.030, 0.02), 1, 0.25 + phase / 2)
        p.wave("hand" + side, (0.022, 0.012, 0.016), 10, 0.1 + phase / 3)
        p.wave("finger" + side, (0.28, 0.0, 0.0), 10, phase / 3)
        p.wave("curl" + side, 0.12, 5, 0.25 + phase)
    return p


def cheer_4(name: str, base: Pose) -> Performance:
    """Both fists pump in turn, right, left, right, left."""
    p = Performance(name, 1.8, base)
    turns = 2
    for side, phase in (("_l", 0.0), ("_r", 0.5)):
        beat = _pulse(p.times / p.duration * turns + phase) - _pulse(np.array([phase]))[0]
        p.add("hand" + side, beat[:, None] * np.array([-0.07, -0.34, 0.17]))
        p.add("elbow" + side, beat[:, None] * np.array([-0.2, -0.7, -0.1]))
        close = 0.5 - 0.5 * np.cos(2 * np.pi * p.times / p.duration)
        p.add("curl" + side, np.minimum(1.9, 4.0 * close)[:, None] * np.ones(1))
    _bounce(p, 4, 0.018)
    p.wave("hips_turn", (0.0, 0.07, 0.02), turns, 0.1).wave("spine", (0.0, 0.10, 0.05), turns, 0.06)
    p.wave("chest", (0.0, 0.16, 0.07), turns, 0.02).wave("head", (0.05, -0.10, 0.0), turns, 0.0)
    p.wave("head", (0.05, 0.0, 0.02), 4, 0.15)
    return p


def cheer_beat(name: str, base: Pose, style: int = 1) -> Performance:
    """One beat with the arms up: a bounce, a reach, a shake, or a double wave of the hands."""
    frames = {1: 10, 2: 12, 3: 10, 4: 14}[style]
    p = Performance(name, frames / 30, base)
    _bounce(p, 1, 0.022 if style != 2 else 0.040)
    p.wave("chest", (0.05, 0.0, 0.0), 1, 0.05).wave("head", (0.06, 0.0, 0.0), 1, 0.12)
    if style == 1:
        p.wave("hand", (0.012, 0.045, 0.03), 1, -0.2)
    elif style == 2:
        p.wave("hand", (-0.04, -0.090, 0.06), 1, -0.25).wave("curl", 0.6, 1, -0.25)
    elif style == 3:
        p.wave("hand_l", (0.045, 0.02, 0.0), 2).wave("hand_r", (0.045, 0.02, 0.0), 2, 0.3)
        p.wave("finger", (0.25, 0.0, 0.0), 2, -0.1)
    else:
        p.wave("hand_l", (0.05, -0.04, 0.02), 1).wave("hand_r", (-0.05, -0.04, 0.02), 1)
        p.wave("spine", (0, 0, 0.05), 1).wave("chest", (0, 0.05, 0.05), 1, 0.05)
    return p


def wave(name: str, base: Pose) -> Performance:
    """Sway from side to side with both arms overhead."""
    p = Performance(name, 2.4, base)
    if base["hips"][1] > 0.8:
        p.wave("hips", (0.040, 0.0, 0.0), 1).wave("hips", (0.0, 0.008, 0.0), 2, 0.25)
    p.wave("hips_turn", (0.0, 0.03, 0.035), 1)
    p.wave("spine", (0.0, 0.03, -0.110), 1, -0.04).wave("chest", (0.0, 0.04, -0.130), 1, -0.08)
    p.wave("neck", (0.0, 0.0, 0.05), 1, -0.10).wave("head", (0.02, 0.04, 0.08), 1, -0.14)
    p.wave("head", (0.03, 0.0, 0.0), 2, 0.1)
    for side, sign, late in (("_l", 1.0, -0.13), ("_r", -1.0, -0.16)):
        p.wave("hand" + side, (sign * 0.110, 0.0, 0.0), 1, late)
        p.wave("hand" + side, (0.0, 0.022, 0.012), 2, late + 0.25)
        p.wave("finger" + side, (sign * 0.35, 0.0, 0.0), 1, late - 0.08)
        p.wave("palm" + side, (0.10, 0.0, 0.0), 1, late)
    return p.wave("curl", 0.12, 2, -0.2)


def wave_over(name: str, base: Pose) -> Performance:
    """Cross and open both raised arms."""
    p = Performance(name, 2.0, base)
    for side, phase in (("_l", 0.0), ("_r", 0.06)):
        beat = 0.5 - 0.5 * np.cos(2 * np.pi * (2 * p.times / p.duration))
        late = 0.5 - 0.5 * np.cos(2 * np.pi * (2 * p.times / p.duration - phase))
        beat = beat if side == "_l" else late - late[0]
        p.add(
            "hand" + side, beat[:, None] * np.array([-0.33, 0.02, 0.06 if side == "_l" else -0.02])
        )
        p.add("finger" + side, beat[:, None] * np.array([-0.65, 0.0, 0.0]))
    _bounce(p, 4, 0.014)
    p.wave("hips", (0.02, 0, 0), 1).wave("chest", (0.0, 0.05, 0.05), 1)
    p.wave("head", (0.02, 0.08, 0.03), 1, 0.1)
    return p


def _bounce(p: Performance, times: int, metres: float) -> None:
    """Bend the knees so often, if there are legs to stand on."""
    if p.base["hips"][1] > 0.8:
        p.wave("hips", (0.0, metres, 0.0), times, 0.25)
        p.wave("hips_turn", (0.03, 0.0, 0.0), times, 0.2)
    p.wave("spine", (0.02, 0.0, 0.0), times, 0.15).wave("head", (0.04, 0.0, 0.0), times, 0.05)


def _pulse(turns: Array) -> Array:
    """0 most of the time, 1 once a turn, quickly there and slower back."""
    u = turns % 1.0
    return np.where(u < 0.35, np.sin(np.pi * u / 0.7) ** 2, np.cos(np.pi * (u - 0.35) / 1.3) ** 2)

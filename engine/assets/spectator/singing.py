"""Joy that takes a while: fists, greetings, chants, scarves, and the wave around the stadium."""

from __future__ import annotations

from . import gestures as g
from .acting import Acting, Shape
from .curves import Pose
from .poses import standing

_AHEAD = (0.28, 0.15, 0.37)
"""Before the chest: where hands go past on their way up and down."""


def fist_pump(name: str, base: Pose, *, low: bool = False, both: bool = False) -> Acting:
    """Wind up, throw a fist up twice, hold it, and let it fall; `low` pumps before the chest."""
    p = Acting(name, 2.2, base, snap=1.5)
    sides = ("_l", "_r") if both else ("_r",)
    top = {**g.FIST_LOW, "hand": (0.20, 0.24, 0.31)} if low else g.FIST_HIGH
    bottom = g.FIST_SIDE if low else g.FIST_LOW
    twist = 0.0 if both else 0.16
    p.move(
        0.05, 0.30, hips_turn=(0.06, -twist, 0), spine=(0.10, -twist, 0), chest=(0.08, -twist, 0)
    )
    p.move(0.05, 0.30, head=(0.06, 0.0, 0))
    if p.stands:
        p.move(0.05, 0.28, hips=(0, -0.055, -0.02)).move(0.30, 0.46, hips=(0, 0.0, 0.012))
        p.move(0.62, 0.80, hips=(0, -0.040, -0.01)).move(0.84, 1.0, hips=(0, 0.0, 0.012))
    for side, late in zip(sides, (0.0, 0.025), strict=False):
        p.hand(side, 0.06 + late, 0.30 + late, {**bottom, "curl": 2.2})
        p.hand(side, 0.30 + late, 0.46 + late, top)
        p.hand(side, 0.62 + late, 0.82 + late, bottom)
        p.hand(side, 0.84 + late, 1.0 + late, top)
    if not both:
        p.hand("_l", 0.15, 0.45, g.FIST_SIDE)
    bend = 0.10 if low else -0.08
    p.move(
        0.30, 0.48, hips_turn=(0, twist, 0), spine=(0.3 * bend, twist, 0), chest=(bend, twist, 0)
    )
    p.move(0.30, 0.48, head=(-0.10, -0.05, 0.03))
    p.move(0.62, 0.82, chest=(0.08, -0.5 * twist, 0), head=(0.05, 0.02, 0))
    p.move(0.84, 1.02, chest=(bend, 1.1 * twist, 0), head=(-0.14, -0.05, 0.02))
    p.move(1.04, 1.25, head=(-0.06, 0.0, 0.0))
    p.back(1.30, 1.9, via=None if low else _AHEAD)
    return p.live(0.5)


def greet(name: str, base: Pose, *, big: bool = False) -> Acting:
    """Wave one hand at somebody far away, the whole arm if `big`."""
    p = Acting(name, 2.6, base, snap=1.2)
    side = "_r"
    p.move(0.10, 0.40, head=(-0.05, -0.14, 0), chest=(-0.04, -0.06, 0.03))
    reach = {**g.HELLO, "hand": (0.26, 0.60, 0.12)} if big else g.HELLO
    p.reach(side, 0.10, 0.55, reach, via=(0.28, 0.10, 0.30))
    x, y, z = g.place(reach)
    width = 0.16 if big else 0.075
    for k, begin in enumerate((0.60, 0.95, 1.30)):
        p.hand(
            side, begin, begin + 0.16, {"hand": (x + width, y - 0.03, z), "finger": (0.5, 0.9, 0)}
        )
        p.hand(
            side,
            begin + 0.18,
            begin + 0.34,
            {"hand": (x - width * (1 - 0.2 * k), y, z + 0.02), "finger": (-0.35, 1, 0)},
        )
    p.shake("chest", (0.0, 0.0, 0.03), 2.9, (0.5, 0.7, 1.3, 1.7))
    if p.stands and big:
        p.move(0.3, 0.6, hips=(-0.02, 0.0, 0.0)).move(1.0, 1.3, hips=(0.02, 0.0, 0.0))
    p.back(1.70, 2.3, via=_AHEAD)
    return p.live(0.1)


def chant(name: str, base: Pose, style: int = 1) -> Acting:
    """Sing with the stand, a beat every 0.6 s for eight beats.

    Styles: a fist thrust at the beat, both arms thrown up, arms swung from side to side, and
    clapping hands overhead at every second beat.
    """
    beat, beats = 0.6, 8
    p = Acting(name, beat * beats, base, snap=1.5)
    last = beats - 1
    if style > 1:
        p.reach("", 0.0, 0.18, {**g.OPEN, "hand": _AHEAD})
    for k in range(1, last):
        # A body is a little later than its goal, and shall be there at the beat.
        t = k * beat - 0.125
        p.move(t - 0.26, t - 0.10, chest=(0.06, 0, 0), head=(0.08, 0, 0))
        p.move(t - 0.10, t + 0.04, chest=(-0.05, 0, 0), head=(-0.14, 0.04 * (-1) ** k, 0))
        if p.stands:
            p.move(t - 0.28, t - 0.12, hips=(0.010 * (-1) ** k, -0.030, 0))
            p.move(t - 0.10, t + 0.06, hips=(0.018 * (-1) ** k, 0.0, 0.008))
        _chant_arms(p, t, k, style)
    p.back(last * beat - 0.20, (last + 1) * beat - 0.14, via=_AHEAD)
    return p.live(0.3, 0.6)


def _chant_arms(p: Acting, t: float, k: int, style: int) -> None:
    if style == 1:
        back = {**g.FIST_LOW, "hand": (0.22, 0.22, 0.22)}
        p.hand("_r", t - 0.26, t - 0.12, back).hand("_r", t - 0.11, t + 0.05, g.PUNCH)
        if k == 1:
            p.hand("_l", t - 0.2, t + 0.1, g.FIST_SIDE)
    elif style == 2:
        for side in ("_l", "_r"):
            low = {**g.HELLO, "hand": (0.24, 0.26, 0.28), "finger": (0.0, 0.9, 0.3)}
            high = {**g.HELLO, "hand": (0.34, 0.60, 0.20), "finger": (0.15, 1.0, 0.2)}
            p.hand(side, t - 0.26, t - 0.10, low).hand(side, t - 0.09, t + 0.06, high)
    elif style == 3:
        lean = 0.13 * (-1) ** k
        p.move(t - 0.25, t + 0.12, spine=(0, 0.05 * (-1) ** k, lean))
        for side, sign in (("_l", 1.0), ("_r", -1.0)):
            out = -0.10 * (-1) ** k * sign
            shape = {**g.HELLO, "hand": (0.27 + out, 0.60, 0.12), "finger": (2.0 * out, 1.0, 0.05)}
            shape["palm"] = (-0.6, 0.0, 0.8)
            p.hand(side, t - 0.25, t + 0.14, shape)
    else:
        wide = {
            **g.HELLO,
            "hand": (0.31, 0.55, 0.17),
            "palm": (-1, 0, 0.1),
            "finger": (0.1, 1, 0.1),
        }
        near = {**wide, "hand": (0.028, 0.60, 0.22), "finger": (0.0, 1.0, 0.2)}
        for side in ("_l", "_r"):
            p.hand(side, t - 0.28, t - 0.13, wide)
            p.hand(side, t - 0.12, t + 0.02, near if k % 2 == 0 else wide)


def scarf_raise(name: str, base: Pose, *, sway: float = 0.10) -> Acting:
    """Stretch a scarf overhead with both hands and sway with it."""
    p = Acting(name, 4.8, base)
    p.move(0.1, 0.4, head=(0.10, 0, 0), chest=(0.05, 0, 0))
    p.reach("", 0.10, 0.50, {**_LOW_SCARF, "hand": (0.30, 0.02, 0.32)})
    p.reach("", 0.55, 1.05, g.SCARF, via=(0.37, 0.36, 0.34))
    p.move(0.6, 1.1, head=(-0.10, 0, 0), chest=(-0.08, 0, 0), neck=(-0.04, 0, 0))
    if p.stands:
        p.move(0.1, 0.5, hips=(0, -0.025, -0.01)).move(0.6, 1.0, hips=(0, 0, 0))
    span = (1.0, 1.6, 3.2, 3.8)
    p.shake("spine", (0, 0, sway), 0.75, span).shake("chest", (0, 0.03, sway), 0.75, span, -0.04)
    p.shake("head", (0.02, 0.04, -0.5 * sway), 0.75, span, -0.1)
    if p.stands:
        p.shake("hips", (0.035, 0, 0), 0.75, span, 0.5).shake("hips_turn", (0, 0, 0.03), 0.75, span)
    p.reach("", 3.7, 4.0, {**_LOW_SCARF, "hand": (0.34, 0.25, 0.36)})
    p.back(4.0, 4.5)
    return p.live(0.6, 0.7)


_LOW_SCARF = {**g.SCARF, "palm": (-0.8, -0.6, 0.1), "finger": (-0.1, 0.4, 0.9)}


def mexican_wave(name: str, base: Pose) -> Acting:
    """Wait for it, throw both arms up, and let them sink."""
    p = Acting(name, 2.0, base, looping=False, snap=1.4)
    p.move(0.0, 0.35, head=(0.06, 0.45, 0), hips=(0, -0.05, -0.03), spine=(0.12, 0.05, 0))
    p.reach("", 0.05, 0.40, {**g.OFFER, "hand": (0.26, -0.12, 0.26)})
    p.reach("", 0.42, 0.80, _HIGH, via=(0.30, 0.30, 0.42))
    p.move(0.42, 0.78, hips=(0, 0.012, 0.01), spine=(-0.05, 0, 0), chest=(-0.10, 0, 0))
    p.move(0.45, 0.80, head=(-0.16, 0, 0), neck=(-0.08, 0, 0))
    p.move(0.50, 0.78, foot_l=(0.22, 0.12), foot_r=(0.22, 0.20))
    p.move(1.00, 1.30, foot_l=(0.0, 0.12), foot_r=(0.0, 0.20))
    p.move(1.05, 1.30, head=(-0.04, -0.35, 0), neck=(0, -0.12, 0))
    p.back(1.10, 1.70, via=_AHEAD)
    return p.live(0.5, 0.5)


_HIGH: Shape = {
    "hand": (0.300, 0.670, 0.110),
    "elbow": (1.0, -0.15, -0.3),
    "palm": (-0.2, 0.0, 1.0),
    "finger": (0.05, 1.0, 0.05),
    "wrist": 0.8,
    "curl": 0.05,
    "hold": 0.0,
    "clasp": 0.0,
}


def sit_mexican_wave(name: str, base: Pose) -> Acting:
    """Get up with the wave, arms thrown high, and drop back onto the seat."""
    p = Acting(name, 2.6, base, looping=False, snap=1.3)
    goal = standing()
    rise = goal["hips"] - base["hips"]
    p.move(0.05, 0.35, head=(0.04, 0.42, 0), hips_turn=(0.30, 0, 0), spine=(0.10, 0, 0))
    p.reach("", 0.10, 0.42, {**g.OFFER, "hand": (0.24, -0.05, 0.28)})
    p.move(0.20, 0.52, hips=(0.0, 0.07, 0.17)).move(0.52, 0.95, hips=rise)
    p.move(0.38, 0.60, hips_turn=(0.62, 0, 0), neck=(-0.2, 0, 0))
    p.move(0.60, 1.0, hips_turn=(0.20, 0, 0), spine=(-0.15, 0, 0), chest=(-0.20, 0, 0))
    p.reach("", 0.55, 0.98, _HIGH, via=(0.30, 0.30, 0.42))
    p.move(0.60, 1.0, head=(-0.12, 0, 0), neck=(-0.16, 0, 0))
    p.move(1.25, 1.50, hips_turn=(0.55, 0, 0), spine=(0.10, 0, 0), chest=(0.05, 0, 0))
    p.move(1.20, 1.50, hips=(0.0, 0.17, 0.15), head=(-0.08, -0.25, 0))
    p.move(1.50, 1.85, hips=(0.0, 0.0, 0.0))
    p.move(1.15, 1.55, hand=(0.30, 0.10, 0.40), elbow=(0.8, -0.6, -0.6))
    p.back(1.55, 2.15, *(c for c in base if c != "hips"))
    return p.live(0.5, 0.4)

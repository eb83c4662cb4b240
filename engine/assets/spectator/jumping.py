"""Jumping for joy: the body's middle flies as bodies fly, the rest swings along.

All jumps start and end with the arms up, so they can follow each other and any cheer.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .curves import Performance, keyed
from .poses import arms_up
from .rotations import Array

GRAVITY = 9.81
_STRETCHED = 0.066
"""How far the hips are above the starting pose when the toes leave the ground, metres."""


@dataclass(frozen=True, slots=True)
class Leap:
    """One way to jump.

    Parameters
    ----------
    crouch
        Metres that the hips sink before.
    crouched, leave, land, end
        Seconds at which the crouch is deepest, the toes leave and touch the ground, and it is over.
    absorb
        Metres that the hips sink on landing.
    tuck
        Metres that the feet are drawn up and back in the air.
    swing
        How far the arms go down before, 1 for all the way to the chest.
    spread
        Metres that the hands go out in the air.
    twist
        Radians that the trunk turns in the air.
    fist
        Whether the left arm stays low and the right fist goes up.
    """

    crouch: float = 0.125
    crouched: float = 0.17
    leave: float = 0.40
    land: float = 0.77
    end: float = 1.2
    absorb: float = 0.085
    tuck: float = 0.04
    swing: float = 1.0
    spread: float = 0.0
    twist: float = 0.0
    fist: bool = False

    @property
    def apex(self) -> float:
        """Seconds at which the body is highest."""
        return (self.leave + self.land) / 2


LEAPS = (
    Leap(),
    Leap(0.150, 0.20, 0.45, 0.89, 1.38, 0.120, tuck=0.13, swing=0.8, spread=0.12),
    Leap(0.050, 0.09, 0.22, 0.48, 0.64, 0.045, tuck=0.02, swing=0.15),
    Leap(0.120, 0.17, 0.40, 0.78, 1.24, 0.090, tuck=0.06, swing=1.0, twist=0.42, fist=True),
)


def jump(name: str, leap: Leap) -> Performance:
    """Crouch, throw the arms up, fly, land on the toes and take it with the knees."""
    p = Performance(name, leap.end, arms_up())
    height = _height(leap, p.times)
    up = np.array([0.0, 1.0, 0.0])
    p.add("hips", height * up)
    # The feet rise with the hips as soon as these are higher than straight legs allow.
    p.add("ball", np.maximum(height - _STRETCHED, 0.0) * up)
    _feet(p, leap)
    _arms(p, leap)
    _trunk(p, leap)
    return p


def _height(leap: Leap, times: Array) -> Array:
    """(F, 1) metres of the hips over the starting pose: a parabola between leaving and landing."""
    half = (leap.land - leap.leave) / 2
    rise = GRAVITY * half * half / 2
    speed = GRAVITY * half
    push = leap.leave - leap.crouched
    before = [(0.0, 0.0), (leap.crouched, -leap.crouch)]
    before += [(leap.leave - 0.35 * push, _STRETCHED - 0.8 * speed * 0.35 * push)]
    flight = [
        (leap.leave + half * k / 6, _STRETCHED + rise * (1 - ((k - 6) / 6) ** 2)) for k in range(13)
    ]
    soft = leap.end - leap.land
    after = [
        (leap.land + 0.18 * soft, _STRETCHED - 0.75 * speed * 0.18 * soft),
        (leap.land + 0.48 * soft, -leap.absorb),
        (leap.end, 0.0),
    ]
    at, metres = np.array(before + flight + after).T
    return keyed(at, metres[:, None], times)


def _feet(p: Performance, leap: Leap) -> None:
    leave, land, end = leap.leave, leap.land, leap.end
    for side, more, late in (("_l", 1.0, 0.0), ("_r", 1.3, 0.012)):
        tuck = leap.tuck * more
        p.key(
            "ball" + side,
            (leave, (0, 0, 0)),
            (leap.apex + late, (0, tuck, -1.1 * tuck)),
            (land, (0, 0, 0)),
        )
        p.key(
            "foot" + side,
            (0.0, (0, 0)),
            (0.6 * leave, (0.03, 0)),
            (leave, (0.62, 0)),
            (leave + 0.1, (0.80, 0)),
            (land - 0.05, (0.56, 0)),
            (land, (0.50, 0)),
            (land + min(0.08 + late, 0.45 * (end - land)), (0.0, 0)),
            (end, (0, 0)),
        )
        p.key(
            "toes" + side,
            (0.0, 0.0),
            (leave, 0.0),
            (leave + 0.06, -0.75),
            (land - 0.07, -0.4),
            (land, 0.0),
            (end, 0),
        )


def _arms(p: Performance, leap: Leap) -> None:
    leave, land, end, s = leap.leave, leap.land, leap.end, leap.swing
    for side, late in (("_l", 0.0), ("_r", 0.015)):
        low = leap.fist and side == "_l"
        top = (-0.07, -0.62, 0.13) if low else (leap.spread, 0.02, -0.02)
        p.key(
            "hand" + side,
            (0.0, (0, 0, 0)),
            (leap.crouched + late, (-0.06 * s, -0.52 * s, 0.20 * s)),
            (leave + 0.04 + late, top),
            (leap.apex + 0.05 + late, tuple(np.multiply(top, 1.0))),
            (land + 0.2 * (end - land), tuple(np.add(np.multiply(top, 0.9), (0.0, -0.05, 0.03)))),
            (land + 0.6 * (end - land), tuple(np.add(np.multiply(top, 0.5), (-0.02, -0.09, 0.06)))),
            (end, (0, 0, 0)),
        )
        p.key(
            "elbow" + side,
            (0.0, (0, 0, 0)),
            (leap.crouched + late, (0.0, -0.55 * s, -0.2 * s)),
            (leave + late, (-0.3, -0.5, -0.4) if low else (0, 0, 0)),
            (land, (-0.3, -0.5, -0.4) if low else (0, 0, 0)),
            (end, (0, 0, 0)),
        )
        fist = 1.9 if leap.fist else 0.6 * s
        p.key("curl" + side, (0, 0), (leap.crouched, fist), (land, fist), (end, 0.0))


def _trunk(p: Performance, leap: Leap) -> None:
    leave, land, end = leap.leave, leap.land, leap.end
    deep = leap.crouch / 0.125
    for name, bend, late in (
        ("hips_turn", 0.22, 0.0),
        ("spine", 0.15, 0.015),
        ("chest", 0.13, 0.03),
    ):
        p.key(
            name,
            (0.0, (0, 0, 0)),
            (leap.crouched + late, (bend * deep, -0.25 * leap.twist, 0)),
            (leave + late, (-0.25 * bend, 0.1 * leap.twist, 0.01)),
            (leap.apex + late, (0.03, 0.4 * leap.twist, 0)),
            (land + 0.45 * (end - land) + late, (0.75 * bend * deep, 0.10 * leap.twist, 0)),
            (end, (0, 0, 0)),
        )
    for name, nod in (("neck", 0.07), ("head", 0.13)):
        p.key(
            name,
            (0.0, (0, 0, 0)),
            (leap.crouched + 0.03, (-nod * deep, 0, 0)),
            (leave + 0.10, (0.2 * nod, 0.05, 0)),
            (land, (-0.3 * nod, 0.04, 0)),
            (land + 0.5 * (end - land), (0.8 * nod, 0, 0)),
            (end, (0, 0, 0)),
        )

"""Spectators and their neighbours: looking, turning, talking, pointing, laughing, drinking, hugs.

Each function acts one motion from a given pose, `seated` or `standing`, and back to it; most are
written for the left and mirrored for the right.
"""

from __future__ import annotations

from . import gestures as g
from .acting import Acting, Shape
from .curves import Pose


def look(name: str, base: Pose, *, far: float = 1.0, lean: float = 0.0) -> Acting:
    """Look to the left, once more a little farther, and back."""
    p = Acting(name, 2.4, base)
    p.move(0.05, 0.20, head=(0.05, -0.05, 0))
    p.move(0.20, 0.55, head=(0.0, 0.62 * far, 0.06)).move(0.24, 0.66, neck=(0, 0.26 * far, 0))
    p.move(0.28, 0.85, chest=(lean, 0.17 * far, 0), spine=(lean, 0.10 * far, -0.3 * lean))
    p.move(1.05, 1.32, head=(-0.04, 0.74 * far, 0.02))
    p.back(1.60, 2.05)
    return p.live(0.3 * far)


def turn(name: str, base: Pose) -> Acting:
    """Turn the whole body to the left, on the feet if standing, watch, and turn back."""
    p = Acting(name, 3.4, base)
    p.move(0.10, 0.45, head=(0.04, 0.55, 0.03), neck=(0, 0.22, 0))
    if not p.stands:
        p.move(0.25, 0.95, hips_turn=(0.02, 0.12, 0), spine=(0, 0.30, -0.02), chest=(0, 0.32, 0))
        p.hand("_r", 0.3, 0.95, {"rest": (-0.02, 0.640, -0.12)})
        p.hand("_l", 0.3, 0.9, {"rest": (0.285, 0.560, -0.42), "finger": (0.4, -0.6, 0.7)})
        p.move(0.5, 1.0, head=(0.0, 0.66, 0.05))
        p.move(1.5, 1.9, head=(-0.05, 0.48, 0.0))
        p.back(2.15, 2.95)
        return p.live(0.5)
    p.move(0.10, 0.32, hips=(-0.035, -0.012, 0.0), chest=(0, -0.05, 0))
    p.step("_l", 0.22, 0.66, (0.045, -0.075), outward=0.85)
    p.move(0.26, 0.80, knee_l=(0.58, 0.0, 0.82)).move(0.64, 1.10, knee_r=(-0.30, 0.0, 0.95))
    p.move(0.30, 0.85, hips_turn=(0, 0.58, 0), spine=(0, 0.12, 0), chest=(0, 0.20, 0))
    p.move(0.40, 0.80, hips=(0.030, -0.014, -0.03))
    p.step("_r", 0.62, 1.06, (-0.055, 0.055), outward=-0.42)
    p.move(0.80, 1.25, hips=(-0.010, -0.004, -0.012))
    p.move(1.0, 1.4, head=(-0.03, 0.30, 0.0), neck=(0, 0.12, 0))
    p.move(1.95, 2.25, head=(0.04, -0.12, 0), neck=(0, -0.06, 0))
    p.move(2.05, 2.28, hips=(0.032, -0.014, -0.02))
    p.step("_r", 2.12, 2.55)
    p.move(2.30, 2.65, hips=(-0.035, -0.012, 0.0))
    p.step("_l", 2.50, 2.94)
    p.back(2.18, 2.60, "knee_r").back(2.52, 2.94, "knee_l")
    p.back(2.20, 3.0, "hips_turn", "spine", "chest").back(2.4, 2.9, "head", "neck")
    p.back(2.72, 3.1, "hips")
    return p.live(0.5)


def talk(name: str, base: Pose) -> Acting:
    """Turn to the left neighbour and explain with one hand, beat by beat."""
    p = _towards(name, base, 4.6)
    p.reach("_r", 0.45, 0.95, g.OPEN)
    for begin, y, z in ((1.05, 0.08, 0.33), (1.65, 0.12, 0.34), (2.40, 0.06, 0.36)):
        p.hand("_r", begin, begin + 0.18, {"hand": (0.17, y, z), "curl": 0.15})
        p.hand("_r", begin + 0.2, begin + 0.42, {"hand": (0.19, -0.04, 0.30), "curl": 0.4})
        p.move(begin + 0.12, begin + 0.30, head=(0.10, 0.60, 0.06))
        p.move(begin + 0.32, begin + 0.55, head=(-0.02, 0.62, 0.04))
    p.reach("_r", 3.0, 3.3, g.OFFER).move(3.05, 3.35, shrug=0.18)
    p.back(3.6, 4.25)
    return p.live(0.2)


def talk_2(name: str, base: Pose) -> Acting:
    """Show the right neighbour what happens on the pitch."""
    p = _towards(name, base, 4.4)
    p.reach("_l", 0.5, 1.0, g.POINT)
    p.move(1.1, 1.5, head=(0.03, 0.05, 0), neck=(0, 0.0, 0), chest=(0.05, 0.02, 0))
    p.hand("_l", 1.25, 1.6, {"hand": (0.20, 0.15, 0.48)})
    p.hand("_l", 1.7, 2.1, {"hand": (0.10, 0.19, 0.49)})
    p.move(2.0, 2.35, head=(0.0, 0.62, 0.05), neck=(0, 0.22, 0), chest=(0.0, 0.14, 0))
    p.reach("_l", 2.3, 2.7, g.OPEN)
    p.move(2.7, 2.9, head=(0.12, 0.60, 0.05)).move(2.95, 3.2, head=(-0.02, 0.60, 0.05))
    p.back(3.4, 4.05)
    return p.mirrored().live(0.6)


def talk_3(name: str, base: Pose) -> Acting:
    """Listen to the left neighbour: an ear nearer, nods, a doubt."""
    p = _towards(name, base, 4.2)
    p.move(0.8, 1.2, spine=(0.06, 0.10, -0.10), chest=(0.05, 0.14, -0.08))
    p.move(0.8, 1.1, head=(0.06, 0.40, -0.16))
    for begin in (1.35, 1.75):
        p.move(begin, begin + 0.15, head=(0.18, 0.42, -0.14))
        p.move(begin + 0.16, begin + 0.34, head=(0.03, 0.42, -0.14))
    p.move(2.3, 2.6, head=(-0.02, 0.58, 0.10)).move(2.3, 2.6, shrug=0.12)
    p.move(2.62, 2.8, head=(0.04, 0.46, -0.05))
    p.back(3.3, 3.9)
    return p.live(0.8)


def talk_4(name: str, base: Pose) -> Acting:
    """Say something behind the hand into the right neighbour's ear."""
    p = _towards(name, base, 4.0)
    p.move(0.5, 0.95, spine=(0.05, 0.12, -0.14), chest=(0.05, 0.14, -0.12))
    p.reach("_r", 0.40, 0.95, g.WHISPER, via=(0.20, 0.04, 0.28))
    p.move(1.3, 1.45, head=(0.10, 0.56, -0.02)).move(1.5, 1.7, head=(0.0, 0.60, 0.02))
    p.move(2.0, 2.15, head=(0.09, 0.56, -0.02)).move(2.2, 2.45, head=(0.0, 0.60, 0.02))
    p.back(2.8, 3.6, via=(0.20, 0.04, 0.28))
    return p.mirrored().live(0.1)


def _towards(name: str, base: Pose, seconds: float) -> Acting:
    """Turn to the neighbour on the left."""
    p = Acting(name, seconds, base)
    p.move(0.08, 0.22, head=(0.04, -0.05, 0))
    p.move(0.22, 0.62, head=(0.0, 0.62, 0.05)).move(0.25, 0.70, neck=(0, 0.22, 0))
    p.move(0.28, 0.50, chest=(0.0, 0.10, 0.0), spine=(0.0, 0.06, 0.0))
    if p.stands:
        p.move(0.25, 0.8, hips=(0.018, -0.002, 0), hips_turn=(0, 0.10, -0.02))
    return p


def point(name: str, base: Pose, shape: Shape = g.POINT) -> Acting:
    """See it, point it out with the left arm, insist, and let the arm sink."""
    p = Acting(name, 2.6, base, snap=1.2)
    p.move(0.05, 0.30, head=(-0.05, 0.10, 0.0), chest=(-0.05, 0.04, 0))
    p.reach("_l", 0.15, 0.30, {**g.CUP, "curl": 0.9})
    p.reach("_l", 0.30, 0.62, shape)
    p.move(0.30, 0.65, chest=(0.06, -0.16, 0.0), spine=(0.05, -0.06, 0.0), hips_turn=(0.05, 0, 0))
    p.move(0.30, 0.65, head=(-0.08, 0.20, 0.0), shrug_l=0.12)
    x, y, z = g.place(shape)
    p.hand("_l", 1.0, 1.12, {"hand": (x + 0.01, y - 0.05, z - 0.06)})
    p.hand("_l", 1.14, 1.28, {"hand": (x, y, z)})
    p.move(1.3, 1.6, head=(-0.02, 0.34, 0.04))
    p.back(1.75, 2.3)
    return p.live(0.4)


def laugh(name: str, base: Pose, *, slap: bool = False) -> Acting:
    """Burst out, bend and shake, with a hand on the belly or slapping the thigh."""
    p = Acting(name, 3.2, base)
    p.move(0.05, 0.35, head=(-0.26, 0.08, 0), neck=(-0.14, 0, 0), chest=(-0.12, 0, 0))
    p.move(0.05, 0.35, shrug=0.14)
    p.move(0.45, 0.95, hips_turn=(0.14, 0, 0), spine=(0.20, 0.03, 0), chest=(0.20, 0.04, 0))
    p.move(0.45, 0.95, head=(0.10, -0.12, 0.06), neck=(0.02, 0, 0))
    if p.stands:
        p.move(0.45, 0.95, hips=(0.0, -0.035, -0.05))
    if slap and not p.stands:
        for begin in (0.9, 1.5):
            p.hand("_r", begin, begin + 0.2, {"rest": (0.145, 0.80, -0.10), "curl": 0.1})
            p.hand("_r", begin + 0.2, begin + 0.32, {"rest": (0.134, 0.622, -0.150)})
    else:
        p.reach("_r", 0.45, 0.95, {**g.HEART, "hand": (0.0, -0.09, 0.19)})
    p.move(1.9, 2.3, head=(-0.12, 0.22, 0.0), chest=(0.02, 0.04, 0), spine=(0.04, 0, 0))
    p.back(2.35, 2.95)
    # The shaking: about five a second, and only while it lasts.
    burst = (0.4, 0.7, 1.8, 2.4)
    p.shake("chest", (0.030, 0.0, 0.0), 4.6, burst).shake("shrug", 0.045, 4.6, burst, 0.1)
    p.shake("head", (0.045, 0.02, 0.0), 4.6, burst, 0.2)
    return p.live(0.7)


def drink(name: str, base: Pose, *, long: float = 0.0) -> Acting:
    """Bring a cup to the mouth, tilt it and the head, swallow, and put it away."""
    p = Acting(name, 3.6 + long, base)
    p.reach("_r", 0.15, 0.75, g.CUP)
    p.move(0.45, 0.85, head=(0.10, -0.05, 0), neck=(0.03, 0, 0))
    p.reach("_r", 0.85, 1.35, g.CUP_AT_MOUTH)
    p.move(1.25, 1.75, head=(-0.20, -0.03, 0), neck=(-0.12, 0, 0), chest=(-0.05, 0, 0))
    p.hand("_r", 1.36, 1.8, {"hand": (0.080, -0.075, 0.185), "finger": (-0.45, 0.75, 0.0)})
    p.move(2.15 + long, 2.5 + long, head=(0.06, 0.03, 0), neck=(0.02, 0, 0), chest=(0, 0, 0))
    p.reach("_r", 2.1 + long, 2.6 + long, g.CUP)
    p.back(2.7 + long, 3.3 + long)
    return p.live(0.9)


def hug(name: str, base: Pose, *, lead: float) -> Acting:
    """Open the arms, close them around somebody 0.55 m ahead, pat, rock, and let go.

    Both of a pair put the right arm over a shoulder and the left one under an arm; `lead` 1 and
    -1 make them rock the same way.
    """
    p = Acting(name, 3.4, base, looping=False)
    p.move(0.08, 0.40, chest=(-0.10, 0, 0), head=(-0.06, 0, 0), hips=(0, -0.008, -0.02))
    p.reach("", 0.10, 0.55, {**g.WIDE, "hand": (0.42, 0.08, 0.24)})
    p.move(0.55, 0.95, hips=(0, -0.014, 0.045), hips_turn=(0.12, 0, 0), spine=(0.08, 0, 0.03))
    p.move(0.55, 0.95, chest=(0.05, 0.04, 0.05))
    p.move(0.50, 0.95, head=(0.04, 0.26, -0.12), neck=(-0.04, 0.10, -0.05))
    p.reach("_r", 0.58, 1.05, g.OVER_SHOULDER).reach("_l", 0.62, 1.10, g.UNDER_ARM)
    pat, shape = ("_r", g.OVER_SHOULDER) if lead > 0 else ("_l", g.UNDER_ARM)
    x, y, z = g.place(shape)
    for begin in (1.30, 1.68, 2.06):
        p.hand(pat, begin, begin + 0.16, {"hand": (x + 0.035, y + 0.01, z + 0.03)})
        p.hand(pat, begin + 0.17, begin + 0.29, {"hand": (x, y, z)})
    p.shake("hips", (0.018 * lead, 0, 0), 1.0, (0.9, 1.2, 2.2, 2.5))
    p.shake("spine", (0, 0, -0.03 * lead), 1.0, (0.9, 1.2, 2.2, 2.5))
    p.move(2.40, 2.70, chest=(-0.02, 0, 0), head=(-0.03, 0.06, 0.03))
    p.reach("", 2.36, 2.70, {**g.WIDE, "hand": (0.36, -0.05, 0.27)})
    p.back(2.78, 3.2)
    return p.live(0.2)

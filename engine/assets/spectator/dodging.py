"""Getting out of the way, being hit, reaching for something, and letting others pass."""

from __future__ import annotations

from . import gestures as g
from .acting import Acting, Shape
from .curves import Pose


def hit_by_ball(name: str, base: Pose, style: int = 1) -> Acting:
    """A ball comes in from the front: too late with the hands, the head is thrown back, rub it.

    In the second style it hits the chest and doubles the body up.
    """
    p = Acting(name, 2.8, base, looping=False, snap=1.7)
    p.move(0.02, 0.16, head=(-0.05, 0, 0), shrug=0.25)
    p.reach("", 0.06, 0.24, {**g.SHIELD, "hand": (0.14, -0.06, 0.28)})
    if style == 1:
        p.move(
            0.20,
            0.30,
            head=(-0.40, 0.22, 0.14),
            neck=(-0.22, 0.08, 0.06),
            chest=(-0.12, 0.08, 0.03),
        )
        p.move(0.22, 0.36, spine=(-0.10, 0.04, 0.03))
        p.move(0.55, 0.95, head=(0.24, 0.10, 0.08), neck=(0.12, 0, 0), chest=(0.14, 0.05, 0))
        p.move(0.55, 0.95, spine=(0.12, 0, 0))
        p.reach("_r", 0.45, 0.85, g.ON_FACE)
        p.back(
            0.60,
            1.20,
            "hand_l",
            "palm_l",
            "finger_l",
            "elbow_l",
            "wrist_l",
            "curl_l",
            "clasp_l",
            "hold_l",
        )
        for begin in (1.0, 1.35):
            p.hand("_r", begin, begin + 0.16, {"hand": (0.09, 0.0, 0.155)})
            p.hand("_r", begin + 0.17, begin + 0.33, {"hand": (0.062, -0.04, 0.16)})
    else:
        p.move(0.20, 0.32, hips_turn=(0.16, 0, 0), spine=(0.30, 0.03, 0), chest=(0.22, 0.05, 0))
        p.move(0.24, 0.42, head=(0.18, 0, 0), neck=(0.10, 0, 0))
        p.reach("_l", 0.28, 0.52, {**g.HEART, "hand": (0.035, -0.11, 0.180)})
        p.reach("_r", 0.30, 0.55, {**g.HEART, "hand": (0.035, -0.02, 0.195)})
        p.move(1.0, 1.5, hips_turn=(0.06, 0, 0), spine=(0.10, 0, 0), chest=(0.06, 0, 0))
        p.move(1.0, 1.45, head=(-0.08, 0.12, 0), neck=(0, 0, 0))
    if p.stands:
        p.move(0.18, 0.34, hips=(0.0, -0.015, -0.075 if style == 1 else -0.110))
        p.step("_r", 0.22, 0.48, (0.02, -0.20), height=0.04)
        p.move(0.60, 1.0, hips=(-0.01, -0.03, -0.05))
        p.step("_r", 1.55, 1.95)
        p.move(1.45, 1.7, hips=(0.03, -0.012, -0.02))
        p.back(1.8, 2.25, "hips")
    p.move(0.34, 0.60, shrug=0.10)
    p.back(1.75, 2.4, *(c for c in p.base if c != "hips" or not p.stands))
    return p.live(0.4, 0.6)


def duck(name: str, base: Pose, style: int = 1) -> Acting:
    """Pull the head in, arms over it, go down, peek, and come up again."""
    p = Acting(name, 2.2, base, looping=False, snap=1.7)
    aside = 0.0 if style == 1 else 0.30
    p.move(0.0, 0.12, shrug=0.16, head=(0.02, 0, 0))
    p.reach("", 0.06, 0.34, g.OVER_HEAD, via=(0.25, 0.24, 0.30))
    p.move(0.06, 0.36, hips_turn=(0.30, 0, 0.3 * aside), spine=(0.28, 0, 0.5 * aside))
    p.move(0.08, 0.36, chest=(0.28, 0, 0.6 * aside), neck=(0.16, 0, 0), head=(0.26, 0.5 * aside, 0))
    if p.stands:
        p.move(0.06, 0.38, hips=(0.0, -0.34, -0.17))
        p.move(0.10, 0.36, foot_l=(0.42, 0.12), foot_r=(0.50, 0.20))
        p.move(1.15, 1.6, foot_l=(0.0, 0.12), foot_r=(0.0, 0.20))
    p.move(0.85, 1.1, head=(-0.10, 0.10, 0), neck=(-0.10, 0, 0), chest=(0.20, 0, 0))
    p.back(1.15, 1.80, *_but_feet(p.base), via=(0.25, 0.08, 0.30))
    return p.live(0.2, 0.4)


def side_step(name: str, base: Pose) -> Acting:
    """One step to the left and back again: making room for a moment."""
    p = Acting(name, 2.6, base, looping=False)
    far = 0.27
    p.move(0.05, 0.40, head=(0.16, 0.40, 0.02), neck=(0.05, 0.14, 0))
    p.move(0.06, 0.26, hips=(-0.045, -0.026, 0.0))
    p.step("_l", 0.20, 0.56, (far, 0.0), height=0.05)
    p.move(0.30, 0.72, hips=(far - 0.04, -0.034, 0.0), hips_turn=(0, 0, 0.03), spine=(0, 0, -0.03))
    p.step("_r", 0.56, 0.92, (-far, 0.0), height=0.05)
    p.move(0.80, 1.10, hips=(far - 0.005, -0.004, 0), hips_turn=(0, 0, 0), spine=(0, 0, 0))
    p.move(0.80, 1.15, head=(0.05, -0.25, 0), neck=(0, -0.1, 0))
    p.reach("", 0.25, 0.65, {**g.HANG, "hand": (0.30, -0.27, 0.10)})
    p.move(1.30, 1.50, hips=(far + 0.025, -0.026, 0.0))
    p.step("_r", 1.42, 1.78)
    p.move(1.52, 1.94, hips=(0.04, -0.034, 0.0))
    p.step("_l", 1.78, 2.14)
    p.back(1.94, 2.25, "hips").back(1.5, 2.2, "head", "neck")
    p.back(1.6, 2.2, *g.HANG)
    return p.live(0.3, 0.5)


def let_pass(name: str, base: Pose) -> Acting:
    """Make oneself thin and let somebody pass in front, from the left to the right.

    Standing, the body leans back with a hand before the belly; seated, the knees go aside.
    """
    p = Acting(name, 3.4, base, looping=False)
    p.move(0.10, 0.50, head=(0.12, 0.50, 0.02), neck=(0.04, 0.18, 0))
    p.move(1.0, 1.9, head=(0.12, -0.45, 0.0), neck=(0.04, -0.16, 0))
    if p.stands:
        p.move(0.35, 0.80, hips=(0.0, -0.012, -0.065), hips_turn=(0.06, -0.10, 0))
        p.move(0.35, 0.85, spine=(-0.04, -0.05, 0), chest=(-0.10, -0.05, 0), shrug=0.12)
        p.reach("_l", 0.35, 0.85, {**g.CROSSED_UNDER, "hand": (0.02, -0.05, 0.170)})
        p.reach("_r", 0.40, 0.90, {**g.HANG, "hand": (0.215, -0.30, -0.02)})
        p.step("_l", 0.45, 0.80, (-0.015, -0.075), height=0.03)
        p.step("_r", 0.85, 1.20, (-0.01, -0.085), height=0.03)
        p.step("_l", 2.15, 2.50, height=0.03).step("_r", 2.45, 2.80, height=0.03)
        p.back(2.2, 2.95, *_but_feet(p.base))
        return p.live(0.6, 0.6)
    p.move(0.35, 0.85, hips=(0.015, 0.0, -0.035), hips_turn=(-0.04, -0.30, 0))
    p.move(0.35, 0.90, spine=(-0.04, 0.10, 0), chest=(-0.06, 0.16, 0))
    p.move(0.35, 0.85, knee_l=(-0.20, 0.0, 1.0), knee_r=(0.62, 0.0, 1.0))
    p.step("_l", 0.28, 0.60, (-0.12, -0.10), outward=-0.20, height=0.03)
    p.step("_r", 0.60, 0.92, (0.13, -0.12), outward=0.50, height=0.03)
    for side, x in (("_l", 0.03), ("_r", 0.215)):
        p.hand(side, 0.35, 0.85, {"rest": (x, 0.635, -0.185)})
    p.step("_r", 2.10, 2.42, height=0.03).step("_l", 2.42, 2.74, height=0.03)
    p.back(2.2, 2.95, *_but_feet(p.base))
    return p.live(0.6, 0.6)


def reach(name: str, base: Pose, *, high: bool = False) -> Acting:
    """Stretch for something with the right arm, grasp it, and bring it to the chest.

    Ahead and down by default, as for something handed along the row; `high` up in the air.
    """
    p = Acting(name, 2.4, base, looping=False, snap=1.1)
    goal: Shape = {**g.OFFER, "hand": (0.14, 0.06, 0.53), "palm": (-0.75, 0.5, 0.0), "curl": 0.1}
    if high:
        goal = {**g.HELLO, "hand": (0.20, 0.70, 0.22), "palm": (-0.3, 0.2, 1.0), "curl": 0.1}
    p.move(0.05, 0.30, head=(-0.22 if high else 0.10, -0.08, 0), chest=(0.05, -0.10, 0))
    p.reach("_r", 0.10, 0.35, {**g.CUP, "curl": 0.4}).reach("_r", 0.35, 0.78, goal)
    lean = -0.05 if high else 0.16
    p.move(0.35, 0.80, hips_turn=(lean + 0.04, 0.08, 0), spine=(lean, 0.10, 0.06 if high else 0))
    p.move(0.35, 0.80, chest=(lean * 0.7, 0.20, 0.06 if high else 0), shrug_r=0.22)
    p.move(0.35, 0.78, head=(-0.30 if high else -0.10, -0.14, 0), neck=(-0.10, 0, 0))
    if p.stands:
        p.move(0.35, 0.80, hips=(0.015, 0.018 if high else -0.02, 0.03 if high else -0.035))
        if high:
            p.move(0.40, 0.78, foot_l=(0.42, 0.12), foot_r=(0.50, 0.20))
            p.move(1.10, 1.42, foot_l=(0.0, 0.12), foot_r=(0.0, 0.20))
    p.hand("_r", 0.86, 1.02, {"curl": 1.3})
    p.reach("_r", 1.10, 1.50, {**g.CUP, "curl": 1.3})
    p.back(1.08, 1.60, "hips", "hips_turn", "spine", "chest", "shrug")
    p.move(1.1, 1.5, head=(0.12, -0.05, 0), neck=(0.06, 0, 0))
    p.back(1.60, 2.10, *(n + "_r" for n in g.CUP), "head", "neck")
    return p.live(0.8)


def _but_feet(base: Pose) -> list[str]:
    """Channels other than the feet's."""
    return [name for name in base if name.partition("_")[0] not in ("ball", "foot")]

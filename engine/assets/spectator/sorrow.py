"""Tension, disappointment and anger."""

from __future__ import annotations

from . import gestures as g
from .acting import Acting, Shape
from .curves import Performance, Pose
from .poses import hands_on_head


def anticipate(name: str, base: Pose, style: int = 1) -> Acting:
    """See a chance come, rise into it, hold the breath, and ease off again.

    Styles: fists before the chest, hands spread ready to rise, hands before the face, and hands
    to the head.
    """
    p = Acting(name, 3.2, base)
    p.move(0.05, 0.25, head=(0.04, 0, 0))
    lean = 0.10 if style != 3 else 0.02
    p.move(
        0.20, 0.75, hips_turn=(0.5 * lean + 0.08, 0, 0), spine=(lean, 0.02, 0), chest=(lean, 0, 0)
    )
    p.move(0.20, 0.70, head=(-0.16, 0.05, 0), neck=(-0.12, 0, 0))
    p.move(0.20, 0.70, shrug=0.16 if style < 4 else 0.0)
    if p.stands:
        p.move(0.20, 0.70, hips=(0, -0.045, -0.055))
        p.move(1.05, 1.50, hips=(0, 0.010, 0.015))
        p.move(1.05, 1.45, foot_l=(0.30, 0.12), foot_r=(0.32, 0.20))
        p.move(1.75, 2.10, foot_l=(0.0, 0.12), foot_r=(0.0, 0.20)).move(1.75, 2.15, hips=(0, 0, 0))
    else:
        p.move(1.0, 1.45, hips_turn=(0.34, 0, 0), neck=(-0.24, 0, 0), head=(-0.30, 0, 0))
    shapes: dict[int, Shape] = {
        1: {**g.FIST_LOW, "hand": (0.14, 0.08, 0.25)},
        2: {**g.WIDE, "hand": (0.32, 0.02, 0.30), "palm": (-0.5, -0.5, 0.6)},
        3: {**g.ON_FACE, "hand": (0.075, -0.11, 0.165)},
        4: {**g.ON_HEAD, "hand": (0.185, 0.175, 0.065)},
    }
    p.reach("", 0.30, 0.95, shapes[style], via=_AHEAD if style > 2 else None)
    x, y, z = g.place(shapes[style])
    up = {
        1: (x, y + 0.09, z + 0.02),
        2: (x + 0.04, y + 0.16, z),
        3: (x, y + 0.03, z),
        4: g.place(g.ON_HEAD),
    }
    p.move(1.05, 1.45, hand=up[style])
    p.shake("head", (0.015, 0.02, 0.0), 4.0, (1.0, 1.2, 1.6, 1.9))
    p.back(2.05, 2.8, via=_AHEAD if style > 2 else None)
    return p.live(0.2 * style)


def disappointed(name: str, base: Pose, style: int = 1) -> Acting:
    """It did not go in.

    Styles: hands onto the head, the face into the hands, a turn away with hands behind the neck,
    and hands thrown down with a slump.
    """
    p = Acting(name, 3.8, base)
    p.move(0.03, 0.22, head=(-0.12, 0, 0), chest=(-0.06, 0, 0), shrug=0.12)
    p.move(0.05, 0.25, **({"hips": (0, 0.008, 0.012)} if p.stands else {"spine": (-0.04, 0, 0)}))
    if style == 1:
        p.reach("", 0.20, 0.72, g.ON_HEAD, via=_AHEAD)
        p.move(0.40, 1.0, hips_turn=(0.10, 0, 0), spine=(0.12, 0, 0), chest=(0.10, 0.02, 0))
        p.move(0.45, 1.0, head=(0.20, 0.0, 0), neck=(0.05, 0, 0), shrug=0.0)
        p.move(1.2, 1.5, head=(0.18, 0.18, 0)).move(1.6, 1.9, head=(0.16, -0.16, 0))
        p.move(1.95, 2.3, head=(0.02, 0.02, 0), chest=(0.0, 0, 0), spine=(0.02, 0, 0))
    elif style == 2:
        p.reach("", 0.25, 0.85, g.ON_FACE, via=(0.20, 0.08, 0.28))
        p.move(0.45, 1.1, hips_turn=(0.18, 0, 0), spine=(0.20, 0, 0), chest=(0.20, 0, 0))
        p.move(0.50, 1.1, head=(0.26, 0.03, 0), neck=(0.16, 0, 0), shrug=0.10)
        p.shake("head", (0.0, 0.13, 0.0), 1.6, (1.1, 1.4, 2.0, 2.4))
    elif style == 3:
        p.reach("", 0.22, 0.55, _BESIDE_HEAD).reach("", 0.55, 0.90, g.BEHIND_NECK)
        p.reach("", 2.35, 2.62, _BESIDE_HEAD)
        p.move(0.40, 1.05, chest=(0.04, 0.24, 0), spine=(0.06, 0.16, 0))
        p.move(0.45, 1.1, head=(0.30, 0.14, 0), neck=(0.16, 0.10, 0), shrug=0.06)
        p.move(1.5, 2.0, head=(-0.28, -0.06, 0), neck=(-0.14, 0, 0), chest=(-0.10, 0.06, 0))
    else:
        p.reach("", 0.12, 0.42, {**g.WIDE, "hand": (0.34, 0.34, 0.24), "palm": (-0.4, 0.2, 0.9)})
        low: Shape = {**g.HANG, "hand": (0.27, -0.29, 0.14)}
        if p.stands:
            p.reach("", 0.45, 0.78, low)
        else:
            p.back(0.45, 0.80, *(name for name in low))
        p.move(0.50, 1.05, hips_turn=(0.06, 0, 0), spine=(0.20, 0, 0), chest=(0.22, 0, 0))
        p.move(0.55, 1.1, head=(0.34, 0.0, 0), neck=(0.22, 0, 0), shrug=-0.06)
        p.shake("head", (0.0, 0.16, 0.02), 1.1, (1.1, 1.4, 2.2, 2.6))
    if p.stands:
        p.move(0.40, 1.0, hips=(0.0, -0.030, -0.030)).move(1.6, 2.3, hips=(-0.03, -0.012, -0.01))
    p.back(2.55 if style != 3 else 2.69, 3.35, via=_AHEAD if style < 3 else None)
    return p.live(0.15 * style)


def boo(name: str, base: Pose, *, thumbs: bool = False) -> Acting:
    """Boo through the hands, twice; or with a thumb turned down."""
    p = Acting(name, 3.4, base, snap=1.1)
    p.move(0.05, 0.35, head=(-0.10, 0, 0), chest=(-0.10, 0, 0), shrug=0.10)
    if thumbs:
        p.reach("_r", 0.20, 0.65, g.THUMB_DOWN, via=(0.20, 0.22, 0.28))
        for begin in (0.85, 1.45, 2.05):
            p.hand("_r", begin, begin + 0.14, {"hand": (0.27, 0.25, 0.38)})
            p.hand("_r", begin + 0.16, begin + 0.32, {"hand": (0.27, 0.13, 0.40)})
        p.reach("_l", 0.25, 0.75, g.ON_HIP if p.stands else g.FIST_SIDE)
        p.shake("head", (0.0, 0.11, 0.0), 1.4, (0.7, 0.9, 2.0, 2.5))
    else:
        p.reach("", 0.15, 0.65, g.MOUTH, via=_NEAR)
    for begin in (0.60, 1.55):
        p.move(
            begin, begin + 0.22, hips_turn=(0.12, 0, 0), spine=(0.12, 0.03, 0), chest=(0.10, 0, 0)
        )
        p.move(begin, begin + 0.22, head=(-0.16, 0, 0), neck=(-0.12, 0, 0))
        p.move(
            begin + 0.60,
            begin + 0.88,
            hips_turn=(0.0, 0, 0),
            spine=(0, -0.02, 0),
            chest=(-0.04, 0, 0),
        )
        p.move(begin + 0.60, begin + 0.88, head=(-0.02, 0, 0), neck=(0, 0, 0))
    p.back(2.45, 3.05, via=None if thumbs else _NEAR)
    return p.live(0.4)


def protest(name: str, base: Pose, style: int = 1) -> Acting:
    """Appeal to the referee with both arms; or wave it all away."""
    p = Acting(name, 2.8, base, snap=1.35)
    p.move(0.04, 0.22, head=(0.06, 0, 0), chest=(0.07, 0, 0))
    if style == 1:
        p.reach("", 0.12, 0.45, g.WIDE, via=(0.26, 0.0, 0.30))
        p.move(0.22, 0.50, chest=(-0.08, 0.05, 0), head=(-0.10, 0.10, 0.04), shrug=0.22)
        for begin, high in ((0.75, 0.14), (1.25, 0.20)):
            p.move(begin, begin + 0.16, hand=(0.42, high, 0.20), head=(-0.14, -0.08, -0.03))
            p.move(begin + 0.18, begin + 0.38, hand=(0.43, 0.0, 0.20), head=(-0.04, 0.08, 0.03))
            p.move(begin, begin + 0.16, shrug=0.26).move(begin + 0.18, begin + 0.38, shrug=0.12)
        if p.stands:
            p.move(0.25, 0.55, hips=(0.0, -0.01, 0.02)).move(1.2, 1.5, hips=(0.03, -0.006, 0.02))
        p.back(1.85, 2.4)
        return p.live(0.3)
    p.move(0.22, 0.50, chest=(0.02, 0.12, 0), spine=(0, 0.06, 0))
    p.reach("_r", 0.10, 0.40, {**g.OPEN, "hand": (0.10, 0.26, 0.30), "palm": (-0.4, 0, -0.9)})
    p.hand("_r", 0.42, 0.66, {**g.WIDE, "hand": (0.44, 0.05, 0.30), "palm": (0.1, -0.9, 0.3)})
    p.move(0.40, 0.66, chest=(0.04, -0.16, 0), spine=(0, -0.08, 0), head=(0.05, 0.16, 0.05))
    p.hand("_r", 0.95, 1.20, {**g.OPEN, "hand": (0.10, 0.24, 0.30), "palm": (-0.4, 0, -0.9)})
    p.hand("_r", 1.22, 1.46, {**g.WIDE, "hand": (0.44, 0.02, 0.28), "palm": (0.1, -0.9, 0.3)})
    p.move(0.95, 1.2, chest=(0.02, 0.08, 0)).move(1.22, 1.46, chest=(0.05, -0.18, 0))
    p.move(1.4, 1.8, head=(0.10, 0.34, 0.04), neck=(0, 0.1, 0))
    p.back(1.9, 2.45)
    return p.live(0.7)


def angry(name: str, base: Pose, style: int = 1) -> Acting:
    """Shake a fist and shout; or hammer both fists down."""
    p = Acting(name, 2.9, base, snap=1.35)
    p.move(0.05, 0.30, shrug=0.14)
    p.move(0.32, 0.60, hips_turn=(0.12, 0, 0), spine=(0.12, -0.03, 0), neck=(-0.10, 0, 0))
    if style == 1:
        p.move(0.05, 0.30, chest=(-0.06, 0.10, 0), head=(-0.05, 0, 0))
        p.move(0.32, 0.60, chest=(0.10, -0.10, 0), head=(-0.20, 0.08, 0))
        high: Shape = {**g.PUNCH, "hand": (0.25, 0.46, 0.30)}
        p.reach("_r", 0.10, 0.40, {**g.FIST_LOW, "hand": (0.29, 0.26, 0.16)})
        p.hand("_r", 0.42, 0.60, high)
        p.reach("_l", 0.15, 0.50, g.FIST_SIDE)
        for begin in (0.70, 1.02, 1.34, 1.66):
            p.hand("_r", begin, begin + 0.13, {"hand": (0.28, 0.38, 0.20)})
            p.hand("_r", begin + 0.14, begin + 0.27, {"hand": (0.25, 0.46, 0.30)})
            p.move(begin + 0.12, begin + 0.26, head=(-0.12, 0.02, 0))
            p.move(begin + 0.27, begin + 0.31, head=(-0.16, 0.04, 0))
    else:
        for begin in (0.20, 0.85, 1.50):
            late = begin + 0.24
            p.reach("", begin, late, {**g.FIST_LOW, "hand": (0.20, 0.34, 0.22)})
            p.reach("", late + 0.08, late + 0.26, {**g.FIST_SIDE, "hand": (0.22, -0.06, 0.30)})
            p.move(begin, late + 0.06, chest=(-0.06, 0, 0), head=(-0.10, 0, 0))
            p.move(late + 0.08, late + 0.24, chest=(0.16, 0, 0), head=(-0.04, 0, 0))
            if p.stands:
                p.move(begin, late, hips=(0, 0.006, 0.012)).move(
                    late + 0.08, late + 0.24, hips=(0, -0.04, -0.02)
                )
    if p.stands and style == 1:
        p.move(0.30, 0.62, hips=(0.0, -0.015, 0.02))
        p.step("_l", 0.30, 0.62, (0.0, 0.13)).step("_l", 2.05, 2.42)
    p.back(2.1, 2.6)
    return p.live(0.9, 0.6)


_AHEAD = (0.30, 0.20, 0.41)
"""Before the chest: where hands go past on their way to the head and back."""
_NEAR = (0.24, 0.06, 0.31)
"""The same for hands that only go to the mouth."""

_BESIDE_HEAD: Shape = {**g.HELLO, "hand": (0.35, 0.32, 0.12), "palm": (-0.7, 0.0, 0.7)}


def dismay() -> Performance:
    """Hands on the head, bent, slowly shaking it in disbelief, as long as it takes."""
    p = Performance("dismay", 3.0, hands_on_head())
    p.wave("head", (0.0, 0.17, 0.02), 2).wave("head", (0.05, 0.05, 0.03), 1, 0.1)
    p.wave("neck", (0.03, 0.07, 0.0), 2, -0.05).wave("chest", (0.03, 0.04, 0.015), 1)
    p.wave("spine", (0.035, 0.02, 0.012), 1, 0.07).wave("hips_turn", (0.03, 0.02, 0.012), 1, 0.12)
    p.wave("hips", (0.014, -0.003, 0.008), 1).wave("shrug", 0.03, 2, 0.25)
    p.wave("elbow_l", (0.0, 0.12, 0.14), 2, 0.1).wave("elbow_r", (0.0, 0.14, 0.10), 2, 0.0)
    return p

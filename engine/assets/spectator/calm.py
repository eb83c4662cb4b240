"""More ways to wait: sitting and standing spectators to whom nothing happens."""

from __future__ import annotations

from . import gestures as g
from .acting import Acting
from .curves import Performance
from .poses import seated, standing


def sit() -> Acting:
    """Just sit and breathe."""
    return Acting("sit", 3.6, seated()).live(0.4, 0.7)


def sit_idle_3() -> Acting:
    """Fold the arms, lean back, look around, and unfold them again."""
    p = Acting("sit_idle_3", 7.2, seated())
    p.move(0.3, 0.8, hips_turn=(-0.06, 0, 0), spine=(-0.03, 0, 0), chest=(-0.04, 0.02, 0))
    p.reach("_l", 0.35, 1.35, g.CROSSED_UNDER, via=(0.09, -0.02, 0.25))
    p.reach("_r", 0.45, 1.50, g.CROSSED_OVER, via=(0.14, 0.00, 0.28))
    p.move(1.6, 2.1, head=(0.03, 0.40, 0.05), neck=(0, 0.15, 0))
    p.move(3.0, 3.5, head=(-0.02, -0.36, -0.03), neck=(0, -0.14, 0), chest=(-0.04, -0.05, 0))
    p.move(4.4, 4.8, head=(0.12, -0.05, 0.0), neck=(0.05, 0, 0))
    _unfold(p)
    p.back(5.8, 6.7)
    return p.live(0.2)


def sit_idle_4() -> Acting:
    """Lean on the knees with the hands clasped, rock, look up, and sit back."""
    p = Acting("sit_idle_4", 7.4, seated())
    p.move(0.2, 0.45, hips_turn=(-0.03, 0, 0))
    p.move(0.45, 1.3, hips_turn=(0.30, 0, 0), spine=(0.18, 0, 0), chest=(0.14, 0.02, 0))
    p.move(0.5, 1.3, neck=(-0.28, 0, 0), head=(-0.22, 0, 0))
    for side, x, y in (("_l", 0.050, 0.585), ("_r", 0.054, 0.605)):
        p.hand(side, 0.5, 1.35, {"rest": (x, y, 0.075), "finger": (-0.55, -0.45, 0.70)})
        p.hand(
            side, 0.6, 1.3, {"palm": (-0.75, -0.45, -0.5), "elbow": (0.8, -0.7, -0.4), "curl": 0.7}
        )
    p.move(2.2, 2.7, head=(-0.20, 0.30, 0.03)).move(3.4, 3.9, head=(-0.24, -0.26, -0.02))
    p.move(3.6, 4.4, spine=(0.21, -0.03, 0.01), hips_turn=(0.33, 0, 0.01))
    p.move(4.6, 5.0, head=(0.02, -0.05, 0.0))
    p.back(5.5, 6.7)
    return p.live(0.6, 0.8)


def sit_idle_5() -> Acting:
    """Rub the chin, think, and scratch behind the ear."""
    p = Acting("sit_idle_5", 6.6, seated())
    p.move(0.3, 1.0, hips_turn=(0.10, 0, -0.03), spine=(0.10, 0, -0.03), chest=(0.06, -0.04, -0.02))
    p.reach("_r", 0.35, 1.15, g.ON_CHIN, via=(0.20, 0.02, 0.28))
    p.move(0.6, 1.2, head=(0.06, 0.08, 0.04), neck=(-0.08, 0, 0))
    p.hand("_r", 1.6, 1.9, {"curl": 0.75}).hand("_r", 2.0, 2.3, {"curl": 1.15})
    p.move(2.2, 2.7, head=(0.0, 0.30, 0.06)).move(3.1, 3.6, head=(0.04, -0.25, 0.02))
    p.hand("_r", 2.6, 2.9, {"curl": 0.8}).hand("_r", 3.0, 3.3, {"curl": 1.1})
    p.back(4.5, 5.5, via=(0.20, 0.02, 0.28))
    return p.live(0.9)


def stand_idle_3() -> Acting:
    """Fold the arms, shift the weight from leg to leg, and let them hang again."""
    p = Acting("stand_idle_3", 7.2, standing())
    p.reach("_l", 0.30, 1.30, g.CROSSED_UNDER, via=(0.13, -0.06, 0.26))
    p.reach("_r", 0.40, 1.45, g.CROSSED_OVER, via=(0.17, -0.03, 0.29))
    p.move(0.4, 1.2, chest=(-0.05, 0, 0), spine=(-0.02, 0, 0))
    p.move(1.6, 2.4, hips=(-0.045, -0.004, 0.0), hips_turn=(0, 0.05, 0.055))
    p.move(1.7, 2.5, spine=(-0.02, -0.03, -0.04), chest=(-0.05, 0.0, -0.02))
    p.move(2.3, 2.8, head=(0.02, 0.36, 0.04), neck=(0, 0.14, 0))
    p.move(3.7, 4.2, head=(0.0, -0.28, -0.02), neck=(0, -0.10, 0))
    _unfold(p)
    p.back(5.8, 6.7)
    return p.live(0.3)


def stand_idle_4() -> Acting:
    """Hands on the hips, look up at the board, lean, and let go."""
    p = Acting("stand_idle_4", 6.8, standing())
    p.reach("", 0.30, 0.95, g.ON_HIP)
    p.move(0.4, 1.1, chest=(-0.06, 0, 0), shrug=0.05)
    p.move(
        1.3, 2.0, hips=(0.030, -0.003, 0.006), hips_turn=(0.02, -0.03, -0.04), spine=(0, 0, 0.03)
    )
    p.move(1.9, 2.5, head=(-0.20, -0.20, -0.03), neck=(-0.10, -0.1, 0))
    p.move(3.4, 3.9, head=(0.05, 0.20, 0.03), neck=(0.02, 0.1, 0))
    p.move(3.6, 4.4, hips=(-0.030, -0.003, 0.0), hips_turn=(0.0, 0.04, 0.04), spine=(0, 0, -0.03))
    p.back(5.0, 6.0)
    return p.live(0.1)


def stand_idle_5() -> Acting:
    """Hands clasped behind the back, up on the toes, and back."""
    p = Acting("stand_idle_5", 6.4, standing())
    p.reach("_l", 0.30, 1.15, g.BEHIND, via=(0.27, -0.27, -0.06))
    above = {**g.BEHIND, "hand": (0.05, -0.205, -0.195)}
    p.reach("_r", 0.36, 1.21, above, via=(0.27, -0.27, -0.06))
    p.move(0.5, 1.2, chest=(-0.07, 0, 0), head=(0.03, 0, 0))
    p.move(1.5, 2.0, head=(0.0, 0.32, 0.04), neck=(0, 0.12, 0))
    for begin in (2.5, 3.4):
        p.move(
            begin, begin + 0.35, hips=(0, 0.040, 0.028), foot_l=(0.30, 0.12), foot_r=(0.30, 0.20)
        )
        p.move(begin + 0.4, begin + 0.8, hips=(0, 0, 0), foot_l=(0, 0.12), foot_r=(0, 0.20))
    p.move(3.0, 3.5, head=(-0.03, -0.2, 0), neck=(0, -0.08, 0))
    for side in ("_l", "_r"):
        p.hand(side, 4.7, 5.1, {"hand": (0.27, -0.29, -0.06)})
    p.back(5.1, 5.8)
    return p.live(0.8)


def _unfold(p: Acting) -> None:
    """The upper arm of two that are folded goes first."""
    p.hand("_r", 5.2, 5.6, {"hand": (0.20, 0.03, 0.32)})
    p.hand("_l", 5.4, 5.8, {"hand": (0.15, -0.06, 0.25)})


def performances() -> list[Performance]:
    """All clips of this kind."""
    return [
        make()
        for make in (
            sit,
            sit_idle_3,
            sit_idle_4,
            sit_idle_5,
            stand_idle_3,
            stand_idle_4,
            stand_idle_5,
        )
    ]

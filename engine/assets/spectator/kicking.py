"""Kicking a ball: a full swing, and a short pass."""

from __future__ import annotations

from . import gestures as g
from .acting import Acting
from .curves import Pose


def kick(name: str, base: Pose, style: int = 1) -> Acting:
    """Put the weight on the left leg, swing the right one back and through, and step down.

    The second style is a pass with the inside of the foot.
    """
    p = Acting(name, 2.0, base, looping=False, snap=1.3)
    hard = 1.0 if style == 1 else 0.55
    met = 0.60 if style == 1 else 0.62
    p.move(0.02, 0.30, hips=(0.055, -0.025, 0.0), head=(0.14, 0, 0), neck=(0.05, 0, 0))
    p.move(0.10, 0.42, hips_turn=(0.16 * hard, -0.34 * hard, 0.03), chest=(0.0, 0.25 * hard, 0))
    p.move(0.10, 0.42, spine=(0.03, 0.12 * hard, -0.03))
    p.move(
        0.42, met + 0.12, hips_turn=(-0.10 * hard, 0.30 * hard, 0.05), chest=(0.10, -0.24 * hard, 0)
    )
    p.move(0.42, met + 0.12, spine=(0.14 * hard, -0.12 * hard, -0.03), hips=(0.058, -0.03, 0.05))
    p.key(
        "ball_r",
        (0.0, (0, 0, 0)),
        (0.10, (0.0, 0.0, 0.0)),
        (0.42, (-0.01, 0.06 + 0.17 * hard, -0.20 - 0.26 * hard)),
        (met, (-0.06, 0.04, 0.24 + 0.08 * hard)),
        (met + 0.18, (-0.12, 0.06 + 0.38 * hard, 0.34 + 0.24 * hard)),
        (met + 0.55, (-0.04, 0.08, 0.10)),
        (1.45, (0.0, 0.0, 0.0)),
    )
    p.key(
        "foot_r",
        (0.0, (0, 0)),
        (0.26, (0.55, 0.0)),
        (0.44, (0.55 + 0.55 * hard, 0.05)),
        (met, (0.55 if style == 1 else 0.0, -0.10 if style == 1 else 0.60)),
        (met + 0.22, (0.05 if style == 1 else -0.05, 0.0 if style == 1 else 0.50)),
        (met + 0.55, (0.10, 0.0)),
        (1.50, (0, 0)),
    )
    p.key("toes_r", (0.0, 0.0), (0.2, 0.0), (0.40, -0.9), (met + 0.4, -0.9), (1.4, 0.0))
    p.hand("_l", 0.10, 0.45, {**g.HANG, "hand": (0.46, 0.0, 0.16), "elbow": (0.4, -0.2, -1.0)})
    p.hand("_r", 0.10, 0.45, {**g.HANG, "hand": (0.30, -0.24, 0.20)})
    p.hand("_l", 0.46, met + 0.16, {**g.HANG, "hand": (0.26, -0.10, 0.30)})
    p.hand("_r", 0.46, met + 0.16, {**g.HANG, "hand": (0.40, -0.14, -0.16)})
    p.move(0.72, 1.05, head=(-0.05, -0.04, 0), neck=(-0.04, 0, 0))
    p.back(0.85, 1.65, *(c for c in base if c.partition("_")[0] not in ("ball", "foot", "toes")))
    return p.live(0.5, 0.5)

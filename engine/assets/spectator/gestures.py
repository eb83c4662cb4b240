"""Where a hand goes and how it is held, in mirrored coordinates: x is outward on both sides.

Places are wrists relative to the chest joint in the chest's frame, or relative to the head joint
in the head's where `clasp` is 1. The chest's front is at z = 0.12, its shoulders at x = 0.17 and
y = 0.19; the head's middle is 0.08 above its joint, its mouth at y = 0.03 and z = 0.12.
"""

from __future__ import annotations

import numpy as np

from .acting import Shape
from .curves import Value

Vector = tuple[float, float, float]


def _shape(
    hand: Vector,
    palm: Vector,
    finger: Vector,
    elbow: Vector = (0.7, -0.8, -0.5),
    *,
    wrist: float = 1.0,
    curl: float = 0.3,
    clasp: float = 0.0,
) -> Shape:
    made: dict[str, Value] = {
        "hand": hand,
        "palm": palm,
        "finger": finger,
        "elbow": elbow,
        "wrist": wrist,
        "curl": curl,
        "clasp": clasp,
        "hold": 0.0,
    }
    return made


def place(shape: Shape) -> Vector:
    """Where a shape holds the wrist."""
    x, y, z = np.asarray(shape["hand"], dtype=np.float64).tolist()
    return x, y, z


HANG = _shape((0.245, -0.31, 0.06), (-1.0, 0.0, -0.25), (0.0, 0.0, 1.0), (0.4, 0.0, -1.0), wrist=0)
CROSSED_UNDER = _shape((-0.085, -0.035, 0.175), (0.0, -0.3, -1.0), (-1.0, 0.12, 0.05), (1, -0.8, 0))
CROSSED_OVER = _shape(
    (-0.055, 0.005, 0.225), (0.05, -0.4, -1.0), (-1.0, 0.10, -0.25), (1, -0.8, 0.1)
)
ON_HIP = _shape(
    (0.232, -0.205, 0.015), (-0.9, -0.1, -0.4), (-0.30, -0.45, 0.85), (1.0, 0.0, -0.45), curl=0.5
)
CLASPED = _shape((0.040, -0.275, 0.185), (-0.6, 0.1, -0.8), (-0.75, -0.65, 0.15), (0.9, -0.2, -0.6))
BEHIND = _shape((0.05, -0.27, -0.185), (-0.1, 0.1, -1.0), (-0.8, -0.55, -0.05), (0.9, 0.0, -0.7))
OPEN = _shape((0.185, -0.02, 0.300), (-0.6, 0.75, 0.05), (-0.05, 0.15, 1.0), curl=0.35)
OFFER = _shape((0.245, 0.02, 0.360), (-0.6, 0.75, 0.1), (0.25, 0.05, 1.0), curl=0.25)
PALM_DOWN = _shape((0.170, -0.04, 0.330), (-0.3, -0.95, 0.1), (-0.05, 0.1, 1.0), curl=0.25)
WIDE = _shape(
    (0.420, 0.02, 0.200), (-0.05, 0.85, 0.5), (0.80, 0.05, 0.60), (0.3, -1.0, -0.4), curl=0.2
)
FIST_HIGH = _shape(
    (0.235, 0.690, 0.120),
    (-1.0, 0.0, 0.15),
    (0.0, 1.0, 0.1),
    (0.85, -0.3, 0.1),
    wrist=0.3,
    curl=2.2,
)
FIST_LOW = _shape(
    (0.235, 0.190, 0.290),
    (-1.0, 0.0, 0.15),
    (-0.1, 0.9, 0.3),
    (0.6, -1.0, -0.4),
    wrist=0.4,
    curl=2.2,
)
FIST_SIDE = _shape(
    (0.270, -0.10, 0.190),
    (-1.0, 0.0, 0.0),
    (-0.1, 0.25, 1.0),
    (0.6, -0.3, -1.0),
    wrist=0.4,
    curl=2.1,
)
POINT = _shape((0.120, 0.270, 0.465), (-0.5, -0.85, 0.0), (-0.05, 0.10, 1.0), curl=0.1)
POINT_SIDE = _shape((0.480, 0.200, 0.240), (-0.1, -0.9, 0.5), (0.9, 0.08, 0.45), curl=0.1)
POINT_HIGH = _shape((0.260, 0.560, 0.330), (-0.6, -0.3, 0.7), (0.1, 0.85, 0.5), curl=0.1)
HELLO = _shape(
    (0.300, 0.440, 0.190), (-0.15, 0.0, 1.0), (0.10, 1.0, 0.05), (1, -0.7, -0.1), curl=0.1
)
SCARF = _shape(
    (0.355, 0.645, 0.070), (-0.4, 0.0, 0.9), (0.1, 0.95, 0.15), (1, -0.1, -0.4), wrist=0.5, curl=2.0
)
THUMB_DOWN = _shape(
    (0.270, 0.210, 0.390), (0.75, -0.65, 0.1), (-0.2, 0.05, 1.0), (1, 0.1, -0.2), curl=2
)
MOUTH = _shape(
    (0.100, -0.035, 0.140),
    (-0.95, 0.1, -0.35),
    (-0.25, 0.75, 0.35),
    (0.9, -0.8, 0.2),
    curl=0.45,
    clasp=1,
)
WHISPER = _shape(
    (0.105, -0.105, 0.115),
    (-0.9, 0.1, -0.4),
    (-0.10, 1.0, 0.15),
    (0.5, -1.0, 0.1),
    curl=0.15,
    clasp=1,
)
ON_HEAD = _shape(
    (0.153, 0.155, 0.005),
    (-0.85, -0.75, 0.0),
    (-0.72, 0.72, -0.22),
    (1, -0.3, 0.55),
    curl=0.5,
    clasp=1,
)
ON_FACE = _shape(
    (0.062, -0.050, 0.160),
    (-0.25, 0.1, -1.0),
    (-0.28, 0.95, 0.0),
    (0.7, -0.9, 0.3),
    curl=0.2,
    clasp=1,
)
BEHIND_NECK = _shape(
    (0.165, 0.115, -0.055),
    (-0.7, -0.1, 0.7),
    (-0.75, 0.25, -0.6),
    (0.8, 0.0, 0.9),
    curl=0.5,
    clasp=1,
)
ON_CHIN = _shape(
    (0.055, -0.150, 0.150),
    (-0.5, 0.3, -0.8),
    (-0.45, 0.75, -0.1),
    (0.7, -1.0, 0.0),
    curl=1.1,
    clasp=1,
)
OVER_HEAD = _shape(
    (0.130, 0.235, 0.075),
    (-0.45, -0.9, -0.1),
    (-0.85, 0.40, -0.35),
    (0.75, -0.2, 1.0),
    curl=0.3,
    clasp=1,
)
SHIELD = _shape(
    (0.100, 0.080, 0.260),
    (-0.6, 0.1, 0.75),
    (-0.30, 0.95, 0.0),
    (0.9, -0.7, 0.1),
    curl=0.15,
    clasp=1,
)
CUP = _shape((0.140, 0.000, 0.285), (-1.0, 0.05, -0.15), (-0.35, 0.30, 0.90), curl=1.0)
CUP_AT_MOUTH = _shape(
    (0.085, -0.105, 0.165),
    (-0.9, 0.0, -0.45),
    (-0.40, 0.60, 0.30),
    (0.6, -1.0, 0.1),
    curl=1.0,
    clasp=1,
)
OVER_SHOULDER = _shape(
    (0.085, 0.260, 0.420), (-0.7, -0.55, -0.3), (-0.6, -0.2, 0.75), (0.9, -0.6, -0.1)
)
UNDER_ARM = _shape(
    (0.130, -0.050, 0.420), (-0.85, -0.1, -0.45), (-0.6, 0.25, 0.75), (0.7, -1, -0.3)
)
PUNCH = _shape((0.185, 0.430, 0.370), (-0.8, -0.4, 0.0), (-0.05, 0.5, 0.9), wrist=0.5, curl=2.2)
HEART = _shape(
    (0.000, 0.02, 0.175), (0.0, 0.0, -1.0), (-0.9, 0.35, 0.0), (0.9, -0.8, 0.0), curl=0.2
)

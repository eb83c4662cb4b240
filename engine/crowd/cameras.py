"""Places from which a stadium is worth looking at."""

from __future__ import annotations

import numpy as np

from .seating import EYE_HEIGHT, SeatPlan
from .stadium_mesh import UP

Point = tuple[float, float, float]

HALF_WIDTH, HALF_HEIGHT = 0.70, 0.42
"""Tangents of half the field of view that the presets are framed for (45 degrees high, 16:9)."""


def camera_presets(plan: SeatPlan) -> dict[str, tuple[Point, Point]]:
    """Eye and target of the cameras ``tv``, ``close`` and ``bowl``, metres.

    ``tv`` looks across the pitch to the far stand from high in the main stand (at a single stand:
    at the whole stand from the pitch), ``close`` into the faces of a block of spectators from a
    few metres, ``bowl`` down on everything. They suit a vertical field of view of 40 to 55 degrees.
    """
    tv = _television(plan) if plan.structure.outline else _front(plan, lift=0.15)
    return {"tv": tv, "close": _close(plan), "bowl": _above(plan)}


def _close(plan: SeatPlan) -> tuple[Point, Point]:
    """Before the middle of a row in the lower third of the far or only stand."""
    tier = plan.structure.tiers[0]
    rows = len(tier.offsets)
    # A low stand fits the picture whole, so its first row shows its feet.
    row = 0 if rows <= 4 else round(0.3 * rows)
    in_row = np.flatnonzero(plan.row == row)
    if not len(in_row):
        in_row = np.flatnonzero(plan.row == plan.row.min())
    if plan.structure.outline is None:
        wanted = plan.position[0, in_row].mean()
        seat = in_row[np.argmin(np.abs(plan.position[0, in_row] - wanted))]
    else:
        off = np.hypot(plan.position[0, in_row], 100.0 * (plan.position[2, in_row] > 0.0))
        seat = in_row[np.argmin(off)]
    feet = plan.position[:, seat].astype(np.float64)
    ahead = np.array([np.sin(plan.yaw[seat]), 0.0, np.cos(plan.yaw[seat])])
    away = 5.0 * float(np.clip(plan.structure.tread / 0.8, 1.0, 1.8))
    target = feet + (EYE_HEIGHT - 0.3) * UP - ahead
    eye = feet + away * ahead + (EYE_HEIGHT + 0.18 * away) * UP
    return _point(eye), _point(target)


def _television(plan: SeatPlan) -> tuple[Point, Point]:
    """Above the front of the main stand's last tier, or above the whole of a lower stand."""
    outline = plan.structure.outline
    assert outline is not None
    last = plan.structure.tiers[-1]
    far = np.flatnonzero(plan.position[2] < -outline.half_z)
    if not plan.structure.complete and len(far):
        x, y, z = plan.position[:, far]
        away = max(8.0, 1.15 * float(np.abs(x).max()) / HALF_WIDTH)
        eye = (0.0, float(y.max()) + 2.0 + 0.12 * away, min(float(z.max()) + away, 34.0))
        return eye, (0.0, 0.5 * float(y.max()), float(z.mean()))
    if len(plan.structure.tiers) > 1:
        offset, height = float(last.offsets[0]), float(last.heights[0]) + 5.0
    else:
        offset = max(20.0, float(last.offsets[-1]) + 6.0)
        height = max(16.0, float(last.heights[-1]) + 6.0)
    depth = outline.half_z + outline.radius
    top, back = float(plan.position[1].max()), float(plan.position[2].min())
    target = (0.0, 0.25 * top, 0.6 * back)
    return (0.0, height, depth + offset), target


def _front(plan: SeatPlan, lift: float) -> tuple[Point, Point]:
    """All of a single stand from before it."""
    low, high = plan.position.min(axis=1), plan.position.max(axis=1) + 1.6 * UP
    middle = 0.5 * (low + high)
    size = high - low
    away = max(
        (0.5 * size[0] + 1.5) / HALF_WIDTH,
        (0.5 * size[1] + 1.5) / HALF_HEIGHT,
        6.0,
    )
    eye = [middle[0], middle[1] + lift * away + 1.0, high[2] + away]
    return _point(eye), _point(middle)


def _above(plan: SeatPlan) -> tuple[Point, Point]:
    """Three-quarter view from above of everything there is."""
    low, high = plan.position.min(axis=1), plan.position.max(axis=1)
    if plan.structure.outline is None:
        centre, direction = 0.5 * (low + high), np.array([0.5, 0.75, 1.0])
        radius = 0.5 * float(np.linalg.norm(high - low)) + 3.0
    else:
        direction = np.array([0.55, 1.2, 1.0])
        radius = max(85.0, float(np.hypot(plan.position[0], plan.position[2]).max()) + 10.0)
        centre = np.array([0.0, 0.15 * float(high[1]), 0.06 * radius])
    direction = direction / np.linalg.norm(direction)
    eye = centre + radius / HALF_HEIGHT * direction
    return _point(eye), _point(centre)


def _point(values: object) -> Point:
    x, y, z = np.asarray(values, dtype=np.float64).tolist()
    return x, y, z

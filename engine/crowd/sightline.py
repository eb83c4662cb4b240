"""Whether everybody sees the pitch: C-values, and rows that rise so that they are good enough.

The C-value is the height by which a spectator's line of sight to the point of focus clears the
eye of the spectator in front (Guide to Safety at Sports Grounds; EN 13200-1):

    C = D (N + R) / (D + T) - R

D and R are the horizontal and vertical distance from the *front* spectator's eye to the point of
focus, N is the riser and T the tread. Solved for the riser that gives a wanted C:

    N = (R + C) (D + T) / D - R
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .seating import EYE_BEHIND, EYE_HEIGHT, SeatPlan

F64 = NDArray[np.float64]

PITCH_HALF_X, PITCH_HALF_Z = 52.5, 34.0
"""Half length and width of the pitch, metres; its outer line is the point of focus."""

C_LEAST, C_GOOD, C_IDEAL = 0.06, 0.09, 0.12
"""Metres: what is accepted, what is aimed at, what more than is not needed."""
MAX_RAKE = float(np.radians(34.0))
"""Steepest slope of a row allowed."""
STAND_FOCUS = 6.0
"""Point of focus of a single stand, metres before the feet of its first row."""


def c_value(distance: ArrayLike, height: ArrayLike, riser: ArrayLike, tread: ArrayLike) -> F64:
    """C-value in metres of arrays that broadcast together.

    Example: the front eye 10 m from the line and 3 m above it, riser 0.4 m, tread 0.8 m:
    10 * 3.4 / 10.8 - 3 = 0.148 m.
    """
    d, r, n, t = (np.asarray(v, dtype=np.float64) for v in (distance, height, riser, tread))
    return np.asarray(d * (n + r) / (d + t) - r)


def riser_for(c: ArrayLike, distance: ArrayLike, height: ArrayLike, tread: ArrayLike) -> F64:
    """Riser in metres that gives the C-value `c`; the inverse of `c_value`."""
    want, d, r, t = (np.asarray(v, dtype=np.float64) for v in (c, distance, height, tread))
    return np.asarray((r + want) * (d + t) / d - r)


def distance_to_pitch(x: ArrayLike, z: ArrayLike) -> F64:
    """Horizontal distance to the nearest point of the touch and goal lines; 0 on the pitch."""
    out_x = np.maximum(np.abs(np.asarray(x, dtype=np.float64)) - PITCH_HALF_X, 0.0)
    out_z = np.maximum(np.abs(np.asarray(z, dtype=np.float64)) - PITCH_HALF_Z, 0.0)
    return np.asarray(np.hypot(out_x, out_z))


def climb(
    distances: Sequence[F64], c: float, *, first_height: float, raises: float, tread: float
) -> list[F64]:
    """Tread heights of all tiers such that every row has the C-value `c`.

    Parameters
    ----------
    distances
        For each tier (R,) float64: from the eyes of a row to the point of focus, metres.
    c
        Wanted C-value, metres.
    first_height
        Of the first tread above the pitch.
    raises
        How far the first tread of a tier lies above the last of the tier before.
    tread
        Row depth.

    Returns
    -------
    For each tier (R,) float64 heights, metres. A riser is never below 0.1 m.
    """
    heights: list[F64] = []
    height = first_height
    for tier in distances:
        levels = np.empty(len(tier))
        for i, distance in enumerate(tier):
            levels[i] = height
            height += max(0.1, float(riser_for(c, distance, height + EYE_HEIGHT, tread)))
        heights.append(levels)
        height = float(levels[-1]) + raises
    return heights


def steepest(heights: Sequence[F64], tread: float) -> float:
    """Steepest rake within a tier, radians; 0 where no tier has two rows."""
    risers = [float(np.diff(levels).max()) for levels in heights if len(levels) > 1]
    return float(np.arctan2(max(risers, default=0.0), tread))


def c_values(plan: SeatPlan) -> F64:
    """(N,) float64 C-value of each seat, metres; infinite in the first row of a tier.

    The point of focus is the point of the pitch's outer line that is nearest to the seat, at pitch
    level. For a single stand the pitch is taken to begin 6 m before the first row.
    """
    structure = plan.structure
    riser = np.full(int(plan.row.max()) + 1, np.inf)
    for tier in structure.tiers:
        riser[tier.first_row + 1 : tier.first_row + len(tier.heights)] = np.diff(tier.heights)
    x, y, z = plan.position.astype(np.float64)
    ahead_x, ahead_z = np.sin(plan.yaw, dtype=np.float64), np.cos(plan.yaw, dtype=np.float64)
    step = structure.tread - EYE_BEHIND
    if structure.outline is None:
        distance = STAND_FOCUS - (z + step)
    else:
        distance = distance_to_pitch(x + step * ahead_x, z + step * ahead_z)
    rise = riser[plan.row]
    inside = np.isfinite(rise)
    result = np.full(plan.count, np.inf)
    height = (y - rise + EYE_HEIGHT)[inside]
    result[inside] = c_value(distance[inside], height, rise[inside], structure.tread)
    return result

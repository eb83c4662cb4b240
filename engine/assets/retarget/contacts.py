"""When the feet of a body stand on the floor, from their speed and height.

Two points of each sole are watched, the heel and the ball. A point is planted while it is slow and
near the floor. Weights are soft: a foot that rolls from the heel to the ball hands over smoothly.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .humanoid import SIDES
from .motion import BodyMotion
from .turns import Array

SLOW, FAST = 0.3, 0.7
"""Speeds in leg lengths a second below which a point stands and above which it moves: about 0.25
and 0.6 m/s for an adult. A swinging foot does 3 m/s, noise of captures 0.1."""

LOW, HIGH = 0.045, 0.1
"""Heights over the floor in leg lengths at which a point is on it, and off it."""

SPEED_SPAN = 0.025
"""Seconds to either side over which speeds are measured."""

SHORTEST, GAP = 0.05, 0.04
"""Seconds of the shortest stance, and of a gap that does not part two."""


@dataclass(frozen=True, slots=True, eq=False)
class Contacts:
    """Where the floor is and when the soles stand on it.

    Parameters
    ----------
    floor
        Height of the balls of the feet when they stand, metres in the body's world.
    planted
        (F, 2) from 0 to 1 for heel and ball of each side.
    stances
        Spans of moments (first, behind the last) in which a side stands.
    """

    floor: float
    planted: Mapping[str, Array]
    stances: Mapping[str, list[tuple[int, int]]]


def sole_points(motion: BodyMotion, side: str) -> Array:
    """(F, 2, 3) places of heel and ball."""
    soles = motion.figure.soles[side]
    frames = motion.frames[f"{side}_foot"]
    return np.asarray(motion.ankles[side][:, None] + np.einsum("fij,pj->fpi", frames, soles))


def find_contacts(motion: BodyMotion) -> Contacts:
    """Find the floor and the contacts of a motion.

    The floor is where the skeleton stands by itself, or else the height below which the slow
    moments of the soles are 5 % of the time.
    """
    leg = motion.figure.leg
    points = {side: sole_points(motion, side) for side in SIDES}
    speeds = {side: _speeds(points[side], motion.step) / leg for side in SIDES}
    if motion.own_floor:
        figure = motion.figure
        floor = float(np.mean([figure.height(f"{s}_foot") for s in SIDES])) - figure.sole
    else:
        heights = np.concatenate([points[side][..., 1].ravel() for side in SIDES])
        slow = np.concatenate([speeds[side].ravel() for side in SIDES]) < SLOW
        floor = float(np.percentile(heights[slow] if slow.sum() > 3 else heights, 5))
    planted: dict[str, Array] = {}
    stances: dict[str, list[tuple[int, int]]] = {}
    for side in SIDES:
        height = (points[side][..., 1] - floor) / leg
        planted[side] = _falling(height, LOW, HIGH) * _falling(speeds[side], SLOW, FAST)
        stances[side] = spans(planted[side].max(axis=1) > 0.5, motion.step)
    return Contacts(floor, planted, stances)


def spans(standing: NDArray[np.bool_], step: float) -> list[tuple[int, int]]:
    """Stretches of moments in which a foot stands, short gaps filled and short stances dropped."""
    edges = np.diff(np.concatenate([[0], standing.astype(np.int8), [0]]))
    found = list(
        zip(np.flatnonzero(edges > 0).tolist(), np.flatnonzero(edges < 0).tolist(), strict=True)
    )
    joined: list[tuple[int, int]] = []
    for start, stop in found:
        if joined and (start - joined[-1][1]) * step < GAP:
            joined[-1] = (joined[-1][0], stop)
        else:
            joined.append((start, stop))
    whole = len(standing)
    return [(a, b) for a, b in joined if (b - a) * step >= SHORTEST or b - a == whole]


def _speeds(points: Array, step: float) -> Array:
    """(F, 2) metres a second, measured over `SPEED_SPAN` to either side."""
    count = len(points)
    if count < 2:
        return np.zeros(points.shape[:2])
    reach = max(round(SPEED_SPAN / step), 1)
    at = np.arange(count)
    before, after = np.maximum(at - reach, 0), np.minimum(at + reach, count - 1)
    way = np.linalg.norm(points[after] - points[before], axis=-1)
    return np.asarray(way / ((after - before) * step)[:, None])


def _falling(values: Array, full: float, none: float) -> Array:
    """1 up to `full`, 0 from `none` on, smooth between."""
    share = np.clip((none - values) / (none - full), 0.0, 1.0)
    return np.asarray(share * share * (3 - 2 * share))

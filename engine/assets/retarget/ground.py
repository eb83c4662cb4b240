"""Keeps the feet of a retargeted body on the floor.

The same leg directions on legs of other proportions put feet elsewhere, so they would slide, sink
or float. While the source's sole is planted, the target's is held: the correction of a foot changes
so that the planted point does not move, point by point as the foot rolls from the heel to the ball.
Between stances the correction passes smoothly from one to the next. Then the legs are bent to reach
the corrected feet, the hips are lowered where they don't, and toes that would dip into the floor
are lifted.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .contacts import Contacts
from .figure import Figure
from .humanoid import SIDES
from .legs import Legs, lowered
from .turns import Array, arc

EASE = 0.3
"""Seconds in which a correction fades before and after long stays in the air."""

HIP_EASE = 0.12
"""Seconds to either side over which the lowering of the hips is spread."""

TOE_LENGTH = 0.5
"""Length of the toes in distances from the ankle to the ball."""


def floor_of(target: Figure) -> float:
    """Height at which the balls of the target's feet stand, metres.

    Where they are in the reference pose if that stands on y = 0; otherwise 3 % of the leg.
    """
    low = float(np.mean([target.height(f"{side}_foot") for side in SIDES])) - target.sole
    return low if -0.05 * target.leg < low < 0.25 * target.leg else 0.03 * target.leg


def keep_on_ground(
    legs: Legs, middle: Array, contacts: Contacts, step: float, *, looping: bool
) -> Array:
    """Bend the legs so that planted feet stand.

    Parameters
    ----------
    legs
        The posed body; its turns are changed.
    middle
        (F, 3) middle between its hip joints in model space.
    contacts
        Of the source, moment by moment.
    step
        Seconds between moments.
    looping
        Whether the last moment continues into the first.

    Returns
    -------
    (F, 3) float64
        The middle between the hip joints, lowered where a planted foot is out of reach.
    """
    floor = floor_of(legs.figure)
    hip_joints = {side: middle - legs.middle() + legs.place(f"{side}_upper_leg") for side in SIDES}
    goals: dict[str, Array] = {}
    drop = np.zeros(len(middle))
    for side in SIDES:
        ankle = middle - legs.middle() + legs.place(f"{side}_foot")
        soles = np.einsum("fij,pj->fpi", legs.frame(f"{side}_foot"), legs.figure.soles[side])
        points = ankle[:, None] + soles
        fix = _correction(points, contacts.planted[side], contacts.stances[side], step, looping)
        low = points[..., 1].min(axis=1) - floor
        weight = contacts.planted[side].max(axis=1)
        fix[:, 1] = np.maximum(-low * weight, -low)
        goals[side] = ankle + fix
        flat = np.hypot(*(goals[side] - hip_joints[side])[:, [0, 2]].T)
        length = np.maximum(legs.reach(side), np.linalg.norm(ankle - hip_joints[side], axis=1))
        highest = goals[side][:, 1] + np.sqrt(np.maximum(length**2 - flat**2, 0.0))
        drop = np.minimum(drop, highest - hip_joints[side][:, 1])
    drop = lowered(drop, round(HIP_EASE / step) if step > 0 else 0)
    moved = middle.copy()
    moved[:, 1] += drop
    for side in SIDES:
        start = hip_joints[side].copy()
        start[:, 1] += drop
        legs.bend(side, goals[side] - start)
        _lift_toes(legs, side, moved, floor)
    return moved


def _correction(
    points: Array,
    planted: Array,
    stances: list[tuple[int, int]],
    step: float,
    looping: bool,
) -> Array:
    """(F, 3) horizontal shifts of a foot that hold its planted points still."""
    count = len(points)
    shift = np.zeros((count, 3))
    if not stances or count < 2:
        return shift
    cycle = count - 1
    free = np.flatnonzero(planted[:cycle].max(axis=1) <= 0.5)
    if looping and len(free):
        # A loop is read from a moment in the air, so that no stance is cut at its seam.
        order = (np.arange(cycle) + free[0]) % cycle
        inside = np.zeros(count, dtype=np.bool_)
        for first, last in stances:
            inside[first:last] = True
        edges = np.diff(np.concatenate([[0], inside[order].astype(np.int8), [0]]))
        rolled = list(zip(np.flatnonzero(edges > 0), np.flatnonzero(edges < 0), strict=True))
        held = _held(points[order], planted[order], [(int(a), int(b)) for a, b in rolled], step)
        shift[order] = held
        shift[-1] = shift[0]
        return shift
    return _held(points, planted, stances, step)


def _held(points: Array, planted: Array, stances: list[tuple[int, int]], step: float) -> Array:
    count = len(points)
    shift = np.zeros((count, 3))
    moves = np.diff(points, axis=0)
    moves[..., 1] = 0.0
    between = 0.5 * (planted[1:] + planted[:-1]) + 1e-9
    slide = (moves * between[..., None]).sum(axis=1) / between.sum(axis=1)[:, None]
    for first, last in stances:
        way = np.zeros((last - first, 3))
        way[1:] = -np.cumsum(slide[first : last - 1], axis=0)
        shift[first:last] = way - way.mean(axis=0)
    ease = max(round(EASE / step), 1)
    ends = [(-1, np.zeros(3)), *((last - 1, shift[last - 1].copy()) for _, last in stances)]
    starts = [*((first, shift[first].copy()) for first, _ in stances), (count, np.zeros(3))]
    for (last, leaving), (first, arriving) in zip(ends, starts, strict=True):
        gap = np.arange(last + 1, first)
        if not len(gap):
            continue
        if last >= 0 and first < count and len(gap) <= 2 * ease:
            share = _smooth((gap - last) / (first - last))[:, None]
            shift[gap] = leaving * (1 - share) + arriving * share
        else:
            away = _smooth((gap - last) / ease)[:, None]
            back = _smooth((first - gap) / ease)[:, None]
            shift[gap] = leaving * (1 - away) + arriving * (1 - back)
    return shift


def _smooth(share: NDArray[np.float64]) -> Array:
    share = np.clip(share, 0.0, 1.0)
    return np.asarray(share * share * (3 - 2 * share))


def _lift_toes(legs: Legs, side: str, middle: Array, floor: float) -> None:
    """Turn toes up where their tips would be below the floor."""
    figure = legs.figure
    part = f"{side}_toe"
    if part not in figure.joints:
        return
    ball = (middle - legs.middle() + legs.place(part))[:, 1]
    length = TOE_LENGTH * float(np.linalg.norm(figure.soles[side][1]))
    ahead = legs.frame(part)[:, :, 2]
    least = np.clip((floor - ball) / length, -1.0, 0.9)
    dips = ahead[:, 1] < least
    flat = np.hypot(ahead[:, 0], ahead[:, 2])
    keep = np.sqrt(1 - least**2) / np.where(flat > 1e-6, flat, 1.0)
    lifted = np.stack([ahead[:, 0] * keep, least, ahead[:, 2] * keep], axis=-1)
    dips &= flat > 1e-6
    turn = arc(ahead, np.where(dips[:, None], lifted, ahead))
    joint = figure.joints[part]
    legs.turns[:, joint] = np.matmul(turn, legs.turns[:, joint])

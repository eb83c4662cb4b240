"""How arms beat the drum: a controller that turns shoulders, elbows and wrists, hit by hit.

Each wrist follows a path above the drum's skin, down at its hits and up between them; the arm gets
there by the law of cosines, its elbow down and aside. It is laid over the arms of whoever drums.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...animation.controllers.custom import Custom, StreamContext
from ..retarget.turns import quaternions_of
from ..spectator.skeleton import ARM, LOWER_ARM, SHOULDER, UPPER_ARM
from .prop import Array

PERIOD = 2.0
"""Seconds of the rhythm: one, two, three-and-four."""
HITS = {"r": (0.0, 1.0, 1.5), "l": (0.5, 1.25)}
"""Seconds at which each hand hits."""
DOWN = np.array([0.205, 1.111, 0.215])
"""The left wrist at a hit, in the agent's frame, metres."""
UP = np.array([0.245, 1.260, 0.200])
"""The left wrist at the highest."""
_ELBOW = np.array([0.55, -0.75, -0.45])
"""Where the left elbow points."""
_FLICK = 0.35
"""Radians by which the wrist goes up with the arm."""
_LONG = 0.5
"""Seconds between two hits after which the hand goes up all the way."""


def lift(side: str, time: float) -> float:
    """How far a hand is up, 0 at a hit to 1."""
    hits = np.array(HITS[side])
    since = float(np.min((time - hits) % PERIOD))
    until = float(np.min((hits - time) % PERIOD))
    gap = since + until
    if gap <= 0.0:
        return 0.0
    # Later in the gap it is highest, so the way down is the quicker one.
    share = (since / gap) ** 1.35
    return min(1.0, gap / _LONG) * float(np.sin(np.pi * share))


def arm_turns(side: str, up: float) -> tuple[Array, Array, Array]:
    """(3, 3) local rotations of upper arm, lower arm and hand, for a hand that is up by a share."""
    mirror = np.array([1.0 if side == "l" else -1.0, 1.0, 1.0])
    goal = (DOWN + up * (UP - DOWN)) - SHOULDER
    reach = float(np.linalg.norm(goal))
    towards = goal / reach
    bend = _ELBOW - (_ELBOW @ towards) * towards
    bend /= np.linalg.norm(bend)
    cosine = (UPPER_ARM**2 + reach**2 - LOWER_ARM**2) / (2.0 * UPPER_ARM * reach)
    sine = np.sqrt(max(1.0 - cosine**2, 0.0))
    elbow = UPPER_ARM * (cosine * towards + sine * bend)
    upper, lower = elbow / UPPER_ARM, (goal - elbow) / LOWER_ARM
    # The hinge of the elbow; bent arms have their thumbs towards the bend.
    hinge = np.cross(upper, lower)
    hinge /= np.linalg.norm(hinge)
    rest = _frame(ARM, np.cross(ARM, [0.0, 0.0, 1.0]))
    first, second = (_frame(way, hinge) @ rest.T for way in (upper, lower))
    flick = _FLICK * up
    axis = np.cross(ARM, [0.0, 0.0, 1.0])
    third = _about(axis, flick)
    flip = np.diag(mirror)
    one, two = flip @ first @ flip, flip @ second @ flip
    return one, one.T @ two, flip @ third @ flip


def drumming(start: float = 0.0) -> Custom:
    """The controller; it starts `start` seconds after a first hit of the right hand."""
    return Custom(_Drummer(start))


class _Drummer:
    """Turns the arms of the built-in spectator's skeleton."""

    def __init__(self, start: float) -> None:
        self._start = start

    def evaluate_stream(self, context: StreamContext) -> None:
        """Write the arms' rotations, and leave everything else at rest."""
        for side in ("l", "r"):
            turns = arm_turns(side, lift(side, (self._start + context.time) % PERIOD))
            for name, turn in zip(("upper_arm", "lower_arm", "hand"), turns, strict=True):
                joint = context.skeleton.index(f"{name}_{side}")
                context.out[:4, joint] = quaternions_of(turn)


def _frame(along: NDArray[np.float64], hinge: NDArray[np.float64]) -> Array:
    """(3, 3) columns: a bone's direction, its hinge, and what is at right angles to both."""
    return np.stack([along, hinge, np.cross(along, hinge)], axis=1)


def _about(axis: NDArray[np.float64], angle: float) -> Array:
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turn: Array = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
    return turn

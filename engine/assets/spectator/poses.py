"""The poses that clips share: where they start, where they end, and where they join each other."""

from __future__ import annotations

from collections.abc import Callable

from .curves import Pose, Value, pose
from .rig import channels
from .rotations import Array

SEAT_HEIGHT = 0.44
"""Metres above the feet at which the buttocks rest, from z = -0.25 to z = -0.65."""

TOUCH = 0.0225
"""Half the distance of the wrists, metres, when the palms meet."""


def standing() -> dict[str, Array]:
    """At ease, the weight a little on the left leg, arms hanging."""
    at_ease = pose(
        channels(),
        hips=(0.014, 0.9505, -0.004),
        hips_turn=(0.02, -0.03, -0.022),
        spine=(-0.02, 0.02, 0.018),
        chest=(0.03, 0.02, 0.012),
        neck=(0.10, 0.0, -0.004),
        head=(-0.10, 0.01, -0.008),
        hand_l=(0.248, -0.315, 0.045),
        hand_r=(0.238, -0.312, 0.062),
        curl_l=0.38,
        curl_r=0.48,
        foot_l=(0.0, 0.12),
        foot_r=(0.0, 0.20),
        ball_l=(0.128, 0.028, 0.098),
        ball_r=(0.142, 0.028, 0.112),
    )
    return at_ease


def seated() -> dict[str, Array]:
    """On a seat with the hands on the thighs, feet where they are when standing."""
    return pose(
        standing(),
        hips=(0.0, 0.612, -0.420),
        hips_turn=(-0.20, 0.0, 0.0),
        spine=(0.10, 0.0, 0.0),
        chest=(0.12, 0.0, 0.0),
        neck=(0.12, 0.0, 0.0),
        head=(-0.14, 0.0, 0.0),
        rest_l=(0.128, 0.622, -0.150),
        rest_r=(0.134, 0.622, -0.170),
        hold=1.0,
        elbow=(0.85, -0.2, -0.75),
        palm=(-0.22, -1.0, 0.12),
        finger=(-0.22, -0.16, 1.0),
        wrist=1.0,
        curl_l=0.22,
        curl_r=0.30,
        knee=(0.22, 0.0, 1.0),
    )


def arms_up() -> dict[str, Array]:
    """Standing with both arms raised, knees a little bent."""
    return pose(
        standing(),
        hips=(0.0, 0.925, -0.015),
        hips_turn=(-0.02, 0.0, 0.0),
        spine=(-0.05, 0.0, 0.0),
        chest=(-0.08, 0.0, 0.0),
        neck=(-0.02, 0.0, 0.0),
        head=(-0.14, 0.0, 0.0),
        hand=(0.345, 0.640, 0.075),
        elbow=(1.0, -0.15, -0.35),
        palm=(-0.30, 0.0, 1.0),
        finger=(0.12, 1.0, 0.1),
        wrist=0.6,
        curl=0.15,
    )


def seated_arms_up() -> dict[str, Array]:
    """On the seat with both arms raised."""
    return pose(
        seated(),
        hips_turn=(-0.10, 0.0, 0.0),
        spine=(0.02, 0.0, 0.0),
        chest=(-0.04, 0.0, 0.0),
        neck=(0.02, 0.0, 0.0),
        head=(-0.12, 0.0, 0.0),
        hand=(0.345, 0.625, 0.100),
        hold=0.0,
        elbow=(1.0, -0.15, -0.35),
        palm=(-0.30, 0.0, 1.0),
        finger=(0.12, 1.0, 0.1),
        wrist=0.6,
        curl=0.15,
    )


_PALMS_TOGETHER: dict[str, Value] = {
    "finger": (0.02, 0.80, 0.62),
    "palm": (-1.0, -0.05, 0.10),
    "elbow": (0.75, -0.75, -0.45),
    "wrist": 1.0,
    "curl": -0.03,
}


def clapping() -> dict[str, Array]:
    """Standing with the palms together before the chest."""
    return pose(
        standing(),
        hips=(0.0, 0.943, -0.008),
        chest=(0.05, 0.03, 0.012),
        neck=(0.06, 0.0, 0.0),
        head=(-0.12, 0.0, 0.0),
        hand_l=(TOUCH, 0.105, 0.305),
        hand_r=(TOUCH, 0.111, 0.309),
        **_PALMS_TOGETHER,
    )


def seated_clapping() -> dict[str, Array]:
    """On the seat with the palms together, leaning forward a little."""
    return pose(
        seated(),
        hold=0.0,
        hips_turn=(-0.10, 0.0, 0.0),
        spine=(0.12, 0.02, 0.0),
        chest=(0.12, 0.03, 0.01),
        neck=(0.02, -0.02, 0.0),
        head=(-0.12, -0.02, 0.0),
        hand_l=(TOUCH, 0.085, 0.305),
        hand_r=(TOUCH, 0.091, 0.309),
        **_PALMS_TOGETHER,
    )


def hands_on_head() -> dict[str, Array]:
    """Standing bent with both hands on the head."""
    return pose(
        standing(),
        hips=(0.006, 0.935, -0.030),
        hips_turn=(0.10, -0.02, -0.01),
        spine=(0.09, 0.0, 0.0),
        chest=(0.08, 0.02, 0.0),
        neck=(0.12, 0.0, 0.0),
        head=(0.10, 0.0, 0.0),
        clasp=1.0,
        hand_l=(0.150, 0.148, 0.000),
        hand_r=(0.152, 0.142, 0.012),
        elbow=(1.0, -0.30, 0.55),
        palm=(-0.85, -0.75, 0.0),
        finger=(-0.72, 0.72, -0.22),
        wrist=1.0,
        curl_l=0.50,
        curl_r=0.55,
    )


POSES: dict[str, Callable[[], Pose]] = {
    "sitting": seated,
    "standing": standing,
    "arms_up": arms_up,
    "sit_arms_up": seated_arms_up,
    "clapping": clapping,
    "sit_clapping": seated_clapping,
    "hands_on_head": hands_on_head,
}
"""The shared poses by name."""

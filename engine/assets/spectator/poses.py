"""The two poses that the spectator's clips start from and come back to."""

from __future__ import annotations

from .curves import pose
from .rig import channels
from .rotations import Array

SEAT_HEIGHT = 0.44
"""Metres above the feet at which the buttocks rest, from z = -0.25 to z = -0.65."""


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

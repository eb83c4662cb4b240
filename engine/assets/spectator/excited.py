"""Clips of a standing spectator whom the game moves: cheering, jumping, waving, despair."""

from __future__ import annotations

import numpy as np

from .curves import Performance, keyed, pose
from .poses import standing
from .rotations import Array

GRAVITY = 9.81


def _arms_up() -> dict[str, Array]:
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


def cheer() -> Performance:
    """Both arms up, bouncing on the knees, fists opening and closing."""
    p = Performance("cheer", 2.0, _arms_up())
    p.swing("hips", (0.0, 0.024, 0.0), 4, -0.25)
    p.swing("hips", (0.014, 0.0, 0.0), 2).swing("hips", (0.008, 0.0, 0.006), 1)
    p.swing("hips_turn", (0.035, 0.0, 0.0), 4, 0.15).swing("hips_turn", (0.0, 0.05, 0.03), 1)
    p.swing("spine", (0.030, 0.0, 0.0), 4, 0.05).swing("chest", (0.045, 0.0, 0.0), 4, -0.02)
    p.swing("spine", (0.0, -0.04, -0.035), 1).swing("chest", (0.0, 0.05, -0.03), 1, 0.1)
    p.swing("neck", (0.03, 0.0, 0.0), 4, -0.08).swing("head", (0.07, 0.0, 0.0), 4, -0.14)
    p.swing("head", (0.03, 0.16, 0.05), 1, 0.1)
    p.swing("hand_l", (0.012, 0.040, 0.030), 4, -0.35).swing(
        "hand_r", (0.014, 0.048, 0.034), 4, -0.43
    )
    p.swing("hand_l", (0.030, 0.012, 0.03), 1, 0.3).swing("hand_r", (0.040, 0.020, -0.03), 2, 0.15)
    p.swing("curl_l", 0.30, 2, -0.25).swing("curl_r", 0.38, 2, -0.15)
    p.swing("shrug", 0.05, 4, -0.3)
    return p


def cheer_2() -> Performance:
    """Pump one fist: pull down hard, throw it up, two times, the other arm for balance."""
    base = pose(
        _arms_up(),
        hips_turn=(0.0, 0.06, 0.0),
        chest=(-0.03, 0.10, 0.0),
        hand_r=(0.235, 0.690, 0.120),
        elbow_r=(0.85, -0.30, 0.10),
        palm_r=(-1.0, 0.0, 0.15),
        finger_r=(0.0, 1.0, 0.1),
        wrist_r=0.3,
        curl_r=2.25,
        hand_l=(0.285, -0.130, 0.190),
        elbow_l=(0.6, -0.2, -1.0),
        palm_l=(-1.0, -0.1, 0.0),
        finger_l=(-0.2, 0.1, 1.0),
        wrist_l=0.2,
        curl_l=2.10,
    )
    p = Performance("cheer_2", 2.0, base)
    up, cocked, low = (0, 0, 0), (0.03, -0.05, -0.02), (0.00, -0.50, 0.17)
    p.key(
        "hand_r",
        (0, up),
        (0.14, (0.0, 0.012, -0.03)),
        (0.34, low),
        (0.46, (0.01, -0.47, 0.16)),
        (0.68, cocked),
        (0.86, (0, 0.01, 0.01)),
        (1.0, up),
        (1.12, (0.0, 0.012, -0.03)),
        (1.30, (-0.01, -0.46, 0.19)),
        (1.42, (0.01, -0.46, 0.16)),
        (1.66, cocked),
        (1.86, (0, 0.008, 0.01)),
        (2.0, up),
    )
    p.key(
        "elbow_r",
        (0, (0, 0, 0)),
        (0.36, (-0.25, -0.7, -0.5)),
        (0.70, (0, 0, 0)),
        (1.0, (0, 0, 0)),
        (1.34, (-0.25, -0.7, -0.5)),
        (1.68, (0, 0, 0)),
        (2.0, (0, 0, 0)),
    )
    p.swing("hand_l", (0.02, 0.05, -0.04), 2, 0.1).swing("hand_l", (0.01, 0.03, 0.02), 1)
    p.swing("hips", (0.0, 0.016, 0.0), 2, 0.25).swing("hips", (0.0, 0.006, 0.0), 4, 0.25)
    p.swing("hips", (0.016, 0.0, 0.010), 1)
    p.swing("hips_turn", (-0.05, 0.09, -0.03), 2, 0.22).swing(
        "spine", (-0.07, 0.06, -0.04), 2, 0.17
    )
    p.swing("chest", (-0.09, 0.09, -0.06), 2, 0.12).swing("neck", (-0.03, -0.06, 0.02), 2, 0.08)
    p.swing("head", (-0.10, -0.14, 0.05), 2, 0.03).swing("head", (0.02, 0.06, 0.02), 1)
    p.swing("shrug_r", 0.10, 2, 0.15).swing("shrug_l", 0.05, 2, 0.3)
    return p


def jump() -> Performance:
    """Crouch, throw the arms up, leave the ground for 0.37 s, land and take it with the knees."""
    p = Performance("jump", 1.1, pose(_arms_up(), hand=(0.300, 0.300, 0.270), wrist=0.35, curl=0.7))
    leave, land = 0.40, 0.77
    stretched, half = 0.066, (land - leave) / 2
    top = GRAVITY * half * half / 2
    flight = [(leave + half * k / 4, stretched + top * (1 - ((k - 4) / 4) ** 2)) for k in range(9)]
    before = [(0.0, -0.055), (0.16, -0.105), (0.30, -0.015)]
    after = [(0.86, -0.02), (0.98, -0.065), (1.1, -0.055)]
    times, heights = np.array(before + flight + after).T
    height = keyed(times, heights[:, None], p.times)
    up = np.array([0.0, 1.0, 0.0])
    p.add("hips", height * up)
    # The feet rise with the hips as soon as these are higher than straight legs allow.
    p.add("ball", np.maximum(height - stretched, 0.0) * up)
    for side, tuck, late in (("_l", 0.035, 0.0), ("_r", 0.05, 0.01)):
        middle = (leave + land) / 2 + late
        p.key("ball" + side, (leave, (0, 0, 0)), (middle, (0, tuck, -tuck)), (land, (0, 0, 0)))
        p.key(
            "foot" + side,
            (0.0, (0, 0)),
            (0.26, (0.02, 0)),
            (leave, (0.62, 0)),
            (leave + 0.10, (0.80, 0)),
            (land - 0.05, (0.56, 0)),
            (land, (0.50, 0)),
            (land + 0.07 + late, (0.0, 0)),
            (1.1, (0, 0)),
        )
        p.key(
            "toes" + side,
            (0.0, 0.0),
            (leave, 0.0),
            (leave + 0.06, -0.75),
            (land - 0.08, -0.4),
            (land, 0.0),
            (1.1, 0),
        )
        p.key(
            "hand" + side,
            (0.0, (0, 0, 0)),
            (0.15 + late, (0.02, -0.20, -0.05)),
            (0.42, (0.03, 0.30, -0.17)),
            (0.56 + late, (0.05, 0.27, -0.20)),
            (0.80, (0.03, 0.13, -0.08)),
            (0.95 + late, (0.01, -0.03, 0.01)),
            (1.1, (0, 0, 0)),
        )
    for name, amount, late in (
        ("hips_turn", 0.22, 0.0),
        ("spine", 0.16, 0.02),
        ("chest", 0.14, 0.04),
    ):
        p.key(
            name,
            (0.0, (0.5 * amount, 0, 0)),
            (0.15 + late, (amount, 0.02, 0)),
            (0.42 + late, (-0.25 * amount, 0, 0.01)),
            (0.66 + late, (0.05 * amount, -0.02, 0)),
            (0.88 + late, (0.72 * amount, 0, 0)),
            (1.1, (0.5 * amount, 0, 0)),
        )
    for name, amount in (("neck", 0.08), ("head", 0.15)):
        p.key(
            name,
            (0.0, (-0.4 * amount, 0, 0)),
            (0.22, (-amount, 0, 0)),
            (0.50, (0.2 * amount, 0.05, 0)),
            (0.72, (-0.2 * amount, 0.04, 0)),
            (0.90, (0.9 * amount, 0, 0)),
            (1.1, (-0.4 * amount, 0, 0)),
        )
    p.swing("hips", (0.006, 0.0, 0.0), 1)
    return p


def wave() -> Performance:
    """Sway from side to side with both arms overhead."""
    base = pose(
        _arms_up(),
        hand=(0.270, 0.620, 0.060),
        palm=(-0.25, 0.0, 1.0),
        finger=(0.0, 1.0, 0.05),
        wrist=0.45,
        hips=(0.0, 0.932, -0.012),
    )
    p = Performance("wave", 2.4, base)
    p.swing("hips", (0.040, 0.0, 0.0), 1).swing("hips", (0.0, 0.008, 0.0), 2, 0.25)
    p.swing("hips_turn", (0.0, 0.03, 0.035), 1, 0.0)
    p.swing("spine", (0.0, 0.03, -0.110), 1, -0.04).swing("chest", (0.0, 0.04, -0.130), 1, -0.08)
    p.swing("neck", (0.0, 0.0, 0.05), 1, -0.10).swing("head", (0.02, 0.04, 0.08), 1, -0.14)
    p.swing("head", (0.03, 0.0, 0.0), 2, 0.1)
    for side, sign, late in (("_l", 1.0, -0.13), ("_r", -1.0, -0.16)):
        p.swing("hand" + side, (sign * 0.110, 0.0, 0.0), 1, late)
        p.swing("hand" + side, (0.0, 0.022, 0.012), 2, late + 0.25)
        p.swing("finger" + side, (sign * 0.35, 0.0, 0.0), 1, late - 0.08)
        p.swing("palm" + side, (0.10, 0.0, 0.0), 1, late)
    p.swing("curl", 0.12, 2, -0.2)
    return p


def dismay() -> Performance:
    """Hands on the head, bent, slowly shaking it in disbelief."""
    base = pose(
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
    p = Performance("dismay", 3.0, base)
    p.swing("head", (0.0, 0.17, 0.02), 2).swing("head", (0.05, 0.05, 0.03), 1, 0.1)
    p.swing("neck", (0.03, 0.07, 0.0), 2, -0.05).swing("chest", (0.03, 0.04, 0.015), 1)
    p.swing("spine", (0.035, 0.02, 0.012), 1, 0.07).swing("hips_turn", (0.03, 0.02, 0.012), 1, 0.12)
    p.swing("hips", (0.014, -0.003, 0.008), 1).swing("shrug", 0.03, 2, 0.25)
    p.swing("elbow_l", (0.0, 0.12, 0.14), 2, 0.1).swing("elbow_r", (0.0, 0.14, 0.10), 2, 0.0)
    return p

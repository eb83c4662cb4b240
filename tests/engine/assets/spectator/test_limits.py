"""No joint of the built-in spectator goes where a human's can't."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from joint_motion import Array, JointMotion

from tifo.engine.assets.spectator.rotations import from_matrix, twist_angle
from tifo.engine.assets.spectator.skeleton import ARM

# Degrees. AAOS: American Academy of Orthopaedic Surgeons, Joint Motion (1965), active ranges of
# adults. Where a motion here is passive or bears weight, another source is named.
LIMITS: dict[str, tuple[float, float, str]] = {
    "neck flexion": (-75, 60, "Youdas et al. 1992: extension 76, flexion 60 (AAOS 45, 45)"),
    "neck rotation": (-75, 75, "Youdas et al. 1992: 72 to 75 (AAOS 60)"),
    "neck side": (-45, 45, "AAOS 45"),
    "trunk flexion": (-30, 80, "AAOS thoracolumbar 30, 80"),
    "trunk rotation": (-45, 45, "AAOS 45"),
    "trunk side": (-35, 35, "AAOS 35"),
    "collar bone lift": (-10, 45, "Kapandji, The Physiology of the Joints: elevation 45, down 10"),
    "collar bone forward": (-30, 30, "Kapandji: 30 to the front and back"),
    "arm behind": (-60, 90, "AAOS shoulder extension 60"),
    "arm across": (-45, 90, "AAOS horizontal adduction 135 from the side"),
    "arm twist": (-135, 90, "AAOS internal 70, external 90; overhead the shoulder blade adds 45"),
    "elbow": (0, 150, "AAOS 150"),
    "forearm twist": (-102, 90, "AAOS 80 each way, wrist adds some 20: Kapandji"),
    "wrist": (0, 82, "AAOS flexion 80, extension 70"),
    "hip flexion": (-30, 125, "AAOS extension 30, flexion 120"),
    "hip side": (-30, 45, "AAOS adduction 30, abduction 45"),
    "hip twist": (-45, 45, "AAOS 45"),
    "knee": (0, 150, "heel to buttock 150 (AAOS 135)"),
    "ankle": (-40, 55, "Bennell et al. 1998, bearing weight: 40; AAOS plantar flexion 50"),
    "ankle side": (-30, 35, "AAOS eversion 15, inversion 35, mirrored at will"),
    "ankle twist": (-40, 40, "Kapandji: 35 to 45 with the knee bent"),
    "toes": (-70, 45, "AAOS great toe extension 70, flexion 45"),
}


def angles(turn: Array) -> tuple[Array, Array, Array]:
    """Pitch, yaw and roll in degrees of (F, 3, 3) turns, rolled first and yawed last."""
    pitch = np.arcsin(np.clip(-turn[:, 1, 2], -1, 1))
    yaw = np.arctan2(turn[:, 0, 2], turn[:, 2, 2])
    roll = np.arctan2(turn[:, 1, 0], turn[:, 1, 1])
    return np.degrees(pitch), np.degrees(yaw), np.degrees(roll)


def twist(turn: Array, axis: Array) -> Array:
    """Degrees that (F, 3, 3) turns turn about an axis."""
    return np.degrees(twist_angle(from_matrix(turn), axis))


def between(one: Array, other: Array) -> Array:
    """Degrees between unit vectors."""
    return np.degrees(np.arccos(np.clip(np.einsum("...i,...i->...", one, other), -1, 1)))


def central(m: JointMotion) -> dict[str, Array]:
    neck, trunk = angles(m.within("head", "chest")), angles(m.within("chest", "hips"))
    found = {}
    for part, values in (("neck", neck), ("trunk", trunk)):
        for kind, value in zip(("flexion", "rotation", "side"), values, strict=True):
            found[f"{part} {kind}"] = value
    return found


def sided(m: JointMotion, side: str) -> dict[str, Array]:
    sign = 1.0 if side == "_l" else -1.0
    mirror = np.array([sign, 1.0, 1.0])
    arm = ARM * mirror
    upper = m.along("upper_arm" + side, "lower_arm" + side, "chest") * mirror
    _, collar_forward, collar_lift = angles(m.within("shoulder" + side, "chest"))
    wrist = m.within("hand" + side, "lower_arm" + side)
    below_elbow = twist(m.within("lower_arm" + side, "upper_arm" + side), arm)
    thigh = m.along("upper_leg" + side, "lower_leg" + side, "hips") * mirror
    shin = m.along("lower_leg" + side, "foot" + side, "hips") * mirror
    ankle, ankle_twist, ankle_side = angles(m.within("foot" + side, "lower_leg" + side))
    return {
        "collar bone lift": sign * collar_lift,
        "collar bone forward": -sign * collar_forward,
        "arm behind": np.degrees(np.arcsin(np.clip(upper[:, 2], -1, 1))),
        "arm across": np.degrees(np.arcsin(np.clip(upper[:, 0], -1, 1))),
        "arm twist": sign * twist(m.within("upper_arm" + side, "chest"), arm),
        "elbow": between(m.along("lower_arm" + side, "hand" + side, "upper_arm" + side), arm),
        "forearm twist": sign * (below_elbow + twist(wrist, arm)),
        "wrist": between(wrist @ arm, arm),
        "hip flexion": np.degrees(np.arctan2(thigh[:, 2], -thigh[:, 1])),
        "hip side": np.degrees(np.arcsin(np.clip(thigh[:, 0], -1, 1))),
        "hip twist": sign * twist(m.within("upper_leg" + side, "hips"), np.array([0.0, -1.0, 0.0])),
        "knee": between(thigh, shin),
        "ankle": ankle,
        "ankle side": sign * ankle_side,
        "ankle twist": sign * ankle_twist,
        "toes": angles(m.within("toe" + side, "foot" + side))[0],
    }


def test_no_joint_goes_past_human_limits(motions: dict[str, JointMotion]) -> None:
    wrong = []
    for name, motion in motions.items():
        for found in (central(motion), sided(motion, "_l"), sided(motion, "_r")):
            for joint, values in found.items():
                low, high, _ = LIMITS[joint]
                if values.min() < low - 0.1 or values.max() > high + 0.1:
                    wrong.append(f"{name}: {joint} {values.min():.0f} to {values.max():.0f}")
    assert not wrong


@pytest.mark.parametrize("joint", ["lower_leg", "lower_arm"])
def test_knees_and_elbows_bend_one_way(motions: dict[str, JointMotion], joint: str) -> None:
    above, below = ("upper_leg", "foot") if joint == "lower_leg" else ("upper_arm", "hand")
    for motion in motions.values():
        for side in ("_l", "_r"):
            upper = motion.along(above + side, joint + side, above + side)
            lower = motion.along(joint + side, below + side, above + side)
            # In the frame of the upper bone the knee's shin goes back, the elbow's forearm forward.
            way = (lower - upper)[:, 2] * (-1 if joint == "lower_leg" else 1)
            assert way.min() > -2e-3, f"{motion.name} {joint + side}"


def test_the_measured_angles_are_the_ones_that_they_are_called(
    motions: dict[str, JointMotion], variants: Callable[..., object]
) -> None:
    """Angles of poses that everybody knows."""
    seated = sided(motions["sit"], "_l")
    assert seated["hip flexion"][0] == pytest.approx(70, abs=10)  # The trunk leans back.
    assert seated["knee"][0] == pytest.approx(85, abs=15)
    cheering = sided(motions["cheer"], "_r")
    assert cheering["collar bone lift"][0] > 15
    assert cheering["elbow"][0] < 80
    looking = central(motions["look_left"])
    assert 40 < looking["neck rotation"].max() < 70
    assert central(motions["look_right"])["neck rotation"].min() < -40
    assert central(motions["disappointed_4"])["neck flexion"].max() > 25
    assert sided(motions["run"], "_l")["knee"].max() > 90
    assert sided(motions["duck"], "_r")["ankle"].min() < 0

"""Hands do not go through the head or the trunk, and meet where they clap."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest
from joint_motion import Array, JointMotion

from tifo.engine.assets.spectator.skeleton import ARM

Trunk = tuple[tuple[str, float, float, float, float], ...]

# Capsules and ellipsoids a little inside the skin, measured on the mesh: the head's half axes are
# 0.098, 0.135 and 0.122 m; a hand is 0.03 m thick.
HEAD_MIDDLE, HEAD = np.array([0.0, 0.080, 0.003]), np.array([0.095, 0.130, 0.115])
TRUNK = (
    # Joint, from and to what height, half width, half depth.
    ("chest", 0.00, 0.14, 0.165, 0.115),
    ("spine", -0.02, 0.12, 0.145, 0.100),
    ("hips", -0.05, 0.07, 0.155, 0.110),
)
WIDER = (
    # Over those of all bodies: women's hips with a skirt, a sweater's waist.
    ("chest", 0.00, 0.14, 0.168, 0.115),
    ("spine", -0.02, 0.12, 0.158, 0.106),
    ("hips", -0.05, 0.07, 0.172, 0.115),
)


def arm_points(motion: JointMotion, side: str) -> dict[str, Array]:
    """(F, 3) points along forearm and hand."""
    arm = ARM * np.array([1.0 if side == "_l" else -1.0, 1.0, 1.0])
    elbow, wrist = motion.place("lower_arm" + side), motion.place("hand" + side)
    return {
        "forearm": 0.4 * elbow + 0.6 * wrist,
        "wrist": wrist,
        "hand": motion.point("hand" + side, 0.05 * arm),
        "fingers": motion.point("fingers" + side, 0.03 * arm),
    }


def seen_from(motion: JointMotion, joint: str, point: Array) -> Array:
    """(F, 3) a point in the frame of a joint."""
    local: Array = np.einsum("fba,fb->fa", motion.turn(joint), point - motion.place(joint))
    return local


def depths(motion: JointMotion, point: Array, trunk: Trunk = TRUNK) -> tuple[float, float]:
    """How far out a point stays, in half axes of the head and the trunk: below 1 inside."""
    head = seen_from(motion, "head", point) - HEAD_MIDDLE
    nearest_head = float(np.linalg.norm(head / HEAD, axis=1).min())
    nearest_trunk = np.inf
    for joint, low, high, width, depth in trunk:
        local = seen_from(motion, joint, point)
        inside = (local[:, 1] > low) & (local[:, 1] < high)
        out = np.hypot(local[:, 0] / width, (local[:, 2] + 0.012) / depth)
        nearest_trunk = min(nearest_trunk, float(np.where(inside, out, np.inf).min()))
    return nearest_head, nearest_trunk


@pytest.mark.parametrize("trunk", [TRUNK, WIDER])
def test_hands_do_not_go_through_the_body(motions: dict[str, JointMotion], trunk: Trunk) -> None:
    wrong = []
    for name, motion in motions.items():
        for side in ("_l", "_r"):
            for part, point in arm_points(motion, side).items():
                head, body = depths(motion, point, trunk)
                if head < 1.0 or body < 1.0:
                    wrong.append(f"{name} {part}{side}: head {head:.2f}, trunk {body:.2f}")
    assert not wrong


def test_the_depths_are_below_one_inside() -> None:
    """Of a body that stands straight: the middle of the head, and a hand's breadth before it."""

    class Still:
        def turn(self, joint: str) -> Array:
            return np.eye(3)[None]

        def place(self, joint: str) -> Array:
            heights = {"head": 1.54, "chest": 1.21, "spine": 1.06, "hips": 0.955}
            return np.array([[0.0, heights[joint], 0.0]])

    still: JointMotion = Still()  # type: ignore[assignment]
    assert depths(still, np.array([[0.0, 1.62, 0.0]]))[0] < 0.1
    assert depths(still, np.array([[0.0, 1.62, 0.25]]))[0] > 2.0
    assert depths(still, np.array([[0.0, 1.28, 0.05]]))[1] < 0.6
    assert depths(still, np.array([[0.0, 1.28, 0.20]]))[1] > 1.6


def test_hands_do_not_go_through_each_other(motions: dict[str, JointMotion]) -> None:
    for name, motion in motions.items():
        left, right = arm_points(motion, "_l"), arm_points(motion, "_r")
        for part in ("wrist", "hand"):
            apart = np.linalg.norm(left[part] - right[part], axis=1).min()
            # Palms that clap or clasp are 4 cm apart in the middle.
            assert apart > 0.035, f"{name} {part} {apart:.3f}"


def test_hands_that_touch_the_head_are_there(
    variants: Callable[..., Iterator[JointMotion]],
) -> None:
    for motion in variants("dismay", "sit_disappointed", "disappointed", "duck", "hit_by_ball"):
        if motion.name.endswith(("disappointed_4", "hit_by_ball_2")):
            continue
        near = min(
            depths(motion, point)[0]
            for side in ("_l", "_r")
            for point in arm_points(motion, side).values()
        )
        assert 1.0 <= near < 1.45, f"{motion.name} {near:.2f}"


def test_who_hugs_reaches_around_somebody_ahead(motions: dict[str, JointMotion]) -> None:
    """Two who face each other 0.55 m apart get their hands behind the other's back."""
    for name in ("hug_a", "hug_b"):
        motion = motions[name]
        middle = motion.clip.frame_count // 2
        for side in ("_l", "_r"):
            wrist = motion.place("hand" + side)[middle]
            assert 0.35 < wrist[2] < 0.60
            assert abs(wrist[0]) < 0.22
    assert motions["hug_a"].clip.duration == motions["hug_b"].clip.duration

"""What a body does in a clip, free of the skeleton that it was recorded on.

The world of a file is turned so that +Y is up and, for a relative motion, so that the body begins
at the origin and faces +Z. What is kept of it is the turn of every part's anatomical frame, the
way of the middle of the hips, and the feet.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...animation.clip import Clip
from .figure import Figure, tip_of
from .humanoid import SIDES
from .turns import Array, about_y, arc, forward, matrices_of, transposed, turned, unit

FAR = 1.0
"""Leg lengths from its root beyond which a body counts as placed in the world of the file."""

TURNED_AWAY = np.radians(60.0)
"""Angle to its root's +Z beyond which a body does."""


@dataclass(frozen=True, slots=True, eq=False)
class BodyMotion:
    """F moments of a body.

    Parameters
    ----------
    figure
        Whose body.
    step
        Seconds between moments; 0 for a single one.
    frames
        (F, 3, 3) turn of each part's anatomical frame in the world.
    hips
        (F, 3) middle between the hip joints, metres.
    ankles
        (F, 3) of each side.
    own_floor
        Whether the skeleton stands on y = 0 of the world by itself.
    """

    figure: Figure
    step: float
    frames: Mapping[str, Array]
    hips: Array
    ankles: Mapping[str, Array]
    own_floor: bool


def body_motion(clip: Clip, figure: Figure, *, absolute: bool) -> BodyMotion:
    """Read what the body of `figure` does in `clip`.

    Relative, a body whose hips are the root of its skeleton is brought to the origin and made to
    face +Z at its first moment. One whose hips hang below a root or armature is relative to that
    already and stays as it is, unless it begins more than `FAR` from it or is `TURNED_AWAY`.
    Absolute, the place and heading of the file are kept, in its own metres.

    Raises
    ------
    ValueError
        If the clip has another number of joints, or its numbers are not usable.
    """
    skeleton = figure.humanoid.skeleton
    if clip.joint_count != skeleton.joint_count:
        raise ValueError(
            f"clip '{clip.name}' has {clip.joint_count} joints, its skeleton {skeleton.joint_count}"
        )
    rotation = clip.rotation.astype(np.float64)
    if (np.linalg.norm(rotation, axis=-1) < 1e-6).any():
        raise ValueError(f"clip '{clip.name}' has rotations of length zero")
    turns, _, positions = forward(
        skeleton,
        matrices_of(rotation),
        _offsets(clip, figure),
        clip.scale.astype(np.float64),
    )
    if not np.isfinite(positions).all():
        raise ValueError(f"clip '{clip.name}' has transforms too large to compute with")
    upright = _upright(figure, positions)
    turns, positions = np.matmul(upright, turns), turned(upright, positions)
    frames = {
        part: np.matmul(turns[:, joint], figure.offset(part))
        for part, joint in figure.joints.items()
    }
    _follow_bones(figure, frames, positions)
    middle = 0.5 * sum(
        (positions[:, figure.joints[f"{side}_upper_leg"]] for side in SIDES), np.zeros(3)
    )
    ankles = {side: positions[:, figure.joints[f"{side}_foot"]] for side in SIDES}
    has_root = bool(skeleton.parents[figure.joints["hips"]] >= 0)
    if not absolute:
        turn, origin = _own_frame(figure, frames, middle, has_root)
        frames = {part: np.matmul(turn, frame) for part, frame in frames.items()}
        middle = turned(turn, middle - origin)
        ankles = {side: turned(turn, place - origin) for side, place in ankles.items()}
    low = min(figure.height(f"{side}_foot") for side in SIDES) - figure.sole
    own_floor = has_root and -0.05 * figure.leg < low < 0.25 * figure.leg
    step = clip.duration / max(clip.frame_count - 1, 1)
    return BodyMotion(figure, step, frames, np.asarray(middle), ankles, own_floor)


def _offsets(clip: Clip, figure: Figure) -> Array:
    """(F, J, 3) translations; those of rest where a file's put the limbs onto one another.

    Some files with position channels on all joints mean displacements, where the format's other
    reading has places: taken as places, the body collapses into a point.
    """
    skeleton = figure.humanoid.skeleton
    moved = clip.translation.astype(np.float64)
    limbs = [joint for part, joint in figure.joints.items() if part.endswith(("_leg", "_foot"))]
    rest = skeleton.rest_translation.astype(np.float64)
    lengths = np.linalg.norm(rest[limbs], axis=1)
    collapsed = np.median(np.linalg.norm(moved[:, limbs], axis=2), axis=0) < 0.1 * lengths
    if collapsed.mean() <= 0.5:
        return moved
    inner = skeleton.parents >= 0
    moved[:, inner] = rest[inner]
    return moved


def _upright(figure: Figure, positions: Array) -> Array:
    """Turn from the world of the file to one with +Y up.

    +Y is up already, unless both the reference pose and the body in motion stand along another
    axis of the file.
    """
    up = figure.axes[:, 1]
    if up[1] > 0.7:
        return np.eye(3)
    joints = figure.joints
    top = joints.get("head", joints["hips"])
    legs = [joints[f"{side}_upper_leg"] for side in SIDES]
    bodies = unit(positions[:, top] - positions[:, legs].mean(axis=1))
    mean = bodies.mean(axis=0)
    return arc(up, np.array([0.0, 1.0, 0.0])) if float(mean @ up) > 0.6 else np.eye(3)


def _follow_bones(figure: Figure, frames: dict[str, Array], positions: Array) -> None:
    """Turn limbs to where their next joint is, in files that move joints and not only turn them."""
    for part in frames:
        tip = tip_of(part, figure.joints)
        if tip is None:
            continue
        bone = figure.place(tip) - figure.place(part)
        if np.linalg.norm(bone) < 1e-3 * figure.leg:
            continue
        expected = turned(frames[part], transposed(figure.frames[part]) @ figure.axes.T @ bone)
        actual = positions[:, figure.joints[tip]] - positions[:, figure.joints[part]]
        here = np.linalg.norm(actual, axis=1, keepdims=True) > 0.1 * np.linalg.norm(bone)
        correction = arc(expected, np.where(here, actual, expected))
        frames[part] = np.matmul(correction, frames[part])


def _own_frame(
    figure: Figure, frames: Mapping[str, Array], middle: Array, has_root: bool
) -> tuple[Array, Array]:
    """Turn and origin that bring the first moment to the origin, facing +Z."""
    ahead = frames["hips"][0, :, 2].copy()
    chest = figure.humanoid.chain("spine")
    if chest:
        ahead = unit(ahead) + unit(frames[f"spine_{len(chest)}"][0, :, 2])
    heading = float(np.arctan2(ahead[0], ahead[2])) if np.hypot(ahead[0], ahead[2]) > 0.2 else 0.0
    start = np.array([middle[0, 0], 0.0, middle[0, 2]])
    if has_root:
        here = 0.5 * (figure.place("left_upper_leg") + figure.place("right_upper_leg"))
        near = float(np.hypot(*(start - here)[[0, 2]])) < FAR * figure.leg
        if near and abs(heading) < TURNED_AWAY:
            return np.eye(3), np.zeros(3)
    return about_y(np.array(-heading)), start

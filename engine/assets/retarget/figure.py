"""A humanoid's reference pose in terms of anatomy: axes of the body, and a frame on every bone.

Two skeletons agree on nothing: rest poses are T, A or arms down, joint axes point anywhere, figures
face anywhere. What they share is the body. So every bone gets an *anatomical frame*: in a T-pose
that faces +Z all frames are parallel to the model's axes (+X the body's left, +Y up, +Z forward),
and in any other reference pose a limb's frame is turned by the shortest arc from the T-pose's
direction of the bone to the actual one, parents first. An A-pose with thumbs forward and a T-pose
with palms down come out as the same body with lowered arms, and no twist is made up.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from .humanoid import FINGERS, SIDES, Humanoid
from .rest import reference_pose
from .turns import Array, about_y, across, arc, transposed, turned, unit

LEAN = np.cos(np.radians(35.0))
"""A body whose up direction is nearer to an axis of the file than 35 degrees stands along it."""

FLAT_FOOT = np.radians(75.0)
"""A foot that points down less steeply stands flat in the reference pose; others hang."""

FOOT_LENGTH, FOOT_HEIGHT = 0.16, 0.06
"""Ankle to ball of the foot, forward and down, in leg lengths, where a skeleton has no toes."""

X, Y, Z = np.eye(3)


@dataclass(frozen=True, slots=True, eq=False)
class Figure:
    """A humanoid with its axes.

    Parameters
    ----------
    humanoid
        The skeleton and its parts.
    turns, positions
        (J, 3, 3) and (J, 3) float64 model space of the reference pose.
    axes
        (3, 3) columns left, up and forward of the body in the reference pose.
    frames
        (3, 3) anatomical frame of each part, in the body's axes.
    leg
        Length of thigh and shin, metres, the mean of both sides.
    soles
        For ``left`` and ``right`` (2, 3): from the ankle to the heel and to the ball of the foot,
        in the foot's frame; both are as far below the ankle as the toe joint.
    """

    humanoid: Humanoid
    turns: Array
    positions: Array
    axes: Array
    frames: Mapping[str, Array]
    leg: float
    soles: Mapping[str, Array]

    @property
    def joints(self) -> Mapping[str, int]:
        """Part to joint."""
        return self.humanoid.joints

    def place(self, part: str) -> Array:
        """(3,) where a part is in the reference pose."""
        return np.asarray(self.positions[self.joints[part]])

    def height(self, part: str) -> float:
        """How high a part is in the reference pose, along the body's up axis."""
        return float(self.place(part) @ self.axes[:, 1])

    def offset(self, part: str) -> Array:
        """(3, 3) from a part's joint frame to its anatomical frame, the same in every pose."""
        return np.asarray(self.turns[self.joints[part]].T @ self.axes @ self.frames[part])

    @property
    def sole(self) -> float:
        """How far the balls of the feet are below the ankles, metres, mean of both sides."""
        return float(-np.mean([self.soles[side][1, 1] for side in SIDES]))


def figure_of(humanoid: Humanoid) -> Figure:
    """The figure of a humanoid.

    Raises
    ------
    ValueError
        If the legs have no length or the body no direction, or a joint of it is mirrored or scaled
        unevenly at rest.
    """
    _check_scales(humanoid)
    turns, positions = reference_pose(humanoid.skeleton)
    at = {part: positions[joint] for part, joint in humanoid.joints.items()}
    leg = float(np.mean([_leg_length(at, side) for side in SIDES]))
    if leg < 1e-6:
        raise ValueError("the legs of the skeleton have no length")
    axes = _axes(at, leg)
    local = {part: axes.T @ place for part, place in at.items()}
    frames = _frames(local, leg)
    soles = {side: _sole(local, frames, side, leg) for side in SIDES}
    return Figure(humanoid, turns, positions, axes, frames, leg, soles)


def tip_of(part: str, joints: Mapping[str, object]) -> str | None:
    """The part that the bone of `part` points to, None where a limb ends."""
    side, _, rest = part.partition("_")
    follow = {
        "upper_leg": ("lower_leg",),
        "lower_leg": ("foot",),
        "upper_arm": ("lower_arm",),
        "lower_arm": ("hand",),
        "hand": ("middle_1", "fingers", "index_1", "ring_1"),
    }
    if rest[:-2] in FINGERS and rest[-1] in "12":
        follow[rest] = (f"{rest[:-1]}{int(rest[-1]) + 1}",)
    return next(
        (f"{side}_{tip}" for tip in follow.get(rest, ()) if f"{side}_{tip}" in joints), None
    )


def _check_scales(humanoid: Humanoid) -> None:
    skeleton = humanoid.skeleton
    for joint in humanoid.joints.values():
        while joint >= 0:
            scale = skeleton.rest_scale[joint]
            if scale.min() <= 0 or scale.max() > 1.01 * scale.min():
                raise ValueError(
                    f"joint '{skeleton.names[joint]}' is mirrored, flat or unevenly scaled at "
                    f"rest ({scale[0]:g}, {scale[1]:g}, {scale[2]:g}), which can't be retargeted"
                )
            joint = int(skeleton.parents[joint])


def _leg_length(at: Mapping[str, Array], side: str) -> float:
    upper, lower, foot = (at[f"{side}_{part}"] for part in ("upper_leg", "lower_leg", "foot"))
    return float(np.linalg.norm(lower - upper) + np.linalg.norm(foot - lower))


def _axes(at: Mapping[str, Array], leg: float) -> Array:
    """Columns left, up and forward of the body."""
    hips = 0.5 * (at["left_upper_leg"] + at["right_upper_leg"])
    tops = [
        *(["head"] if "head" in at else []),
        *(["left_upper_arm", "right_upper_arm"] if "left_upper_arm" in at else []),
    ]
    top = np.mean([at[part] for part in tops], axis=0) if tops else hips
    feet = 0.5 * (at["left_foot"] + at["right_foot"])
    up = unit(top - hips) if np.linalg.norm(top - hips) > 0.1 * leg else unit(hips - feet)
    nearest = int(np.argmax(np.abs(up)))
    if abs(up[nearest]) > LEAN:
        up = np.sign(up[nearest]) * np.eye(3)[nearest]
    for pair in ("upper_leg", "upper_arm", "foot"):
        if f"left_{pair}" in at:
            left = across(at[f"left_{pair}"] - at[f"right_{pair}"], up)
            if np.linalg.norm(left) > 0.01 * leg:
                left = unit(left)
                return np.stack([left, up, np.cross(left, up)], axis=-1)
    raise ValueError("the skeleton has no width: left and right legs are at the same place")


def _frames(at: Mapping[str, Array], leg: float) -> dict[str, Array]:
    """Anatomical frame of each part, from places in the body's axes."""
    frames = {part: np.eye(3) for part in at}
    for side in SIDES:
        out = X if side == "left" else -X
        limbs: list[tuple[str, str | None, Array]] = [
            ("upper_leg", None, -Y),
            ("lower_leg", "upper_leg", -Y),
            ("upper_arm", None, out),
            ("lower_arm", "upper_arm", out),
            ("hand", "lower_arm", out),
            ("fingers", "hand", out),
        ]
        for finger in FINGERS:
            for k, root in enumerate(("hand", f"{finger}_1", f"{finger}_2"), 1):
                limbs.append((f"{finger}_{k}", root, out))
        for part, above, direction in limbs:
            name = f"{side}_{part}"
            if name not in at:
                continue
            start = frames.get(f"{side}_{above}", np.eye(3)) if above else np.eye(3)
            tip = tip_of(name, at)
            bone = at[tip] - at[name] if tip else np.zeros(3)
            known = np.linalg.norm(bone) > 1e-3 * leg
            frames[name] = arc(start @ direction, bone) @ start if known else start
        frames[f"{side}_foot"] = _foot_frame(at, side, leg)
        if f"{side}_toe" in at:
            frames[f"{side}_toe"] = frames[f"{side}_foot"]
    return frames


def _foot_frame(at: Mapping[str, Array], side: str, leg: float) -> Array:
    """A foot stands flat and points where its toes are; one that hangs points down."""
    if f"{side}_toe" not in at:
        return np.eye(3)
    bone = at[f"{side}_toe"] - at[f"{side}_foot"]
    if np.linalg.norm(bone) < 0.01 * leg:
        return np.eye(3)
    if np.arctan2(-bone[1], np.hypot(bone[0], bone[2])) > FLAT_FOOT:
        return arc(Z, bone)
    return about_y(np.arctan2(bone[0], bone[2]))


def _sole(at: Mapping[str, Array], frames: Mapping[str, Array], side: str, leg: float) -> Array:
    ball = np.array([0.0, -FOOT_HEIGHT, FOOT_LENGTH]) * leg
    if f"{side}_toe" in at:
        bone = at[f"{side}_toe"] - at[f"{side}_foot"]
        if np.linalg.norm(bone) >= 0.01 * leg:
            ball = turned(transposed(frames[f"{side}_foot"]), bone)
    return np.stack([[0.0, ball[1], -0.3 * ball[2]], ball])

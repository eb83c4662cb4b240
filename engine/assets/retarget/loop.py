"""Finds the part of a motion that repeats, and closes it.

Two moments match if the body is posed alike and moves alike: the distance compares where head,
hands, feet and knees are, seen from the hips, and how fast they move there (after Kovar, Gleicher
and Pighin, "Motion Graphs", 2002, whose point clouds over a window hold both). The seam is put
where it is least.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...animation.clip import Clip, continuous_hemisphere
from ...animation.skeleton import Skeleton
from ..rotations import multiply
from .cut import trim_clip
from .figure import Figure, figure_of
from .humanoid import Humanoid, humanoid
from .turns import Array, about_y, forward, matrices_of, quaternions_of, transposed, turned

MOST_MOMENTS = 600
"""Moments that are compared; longer clips are compared at every second, third, ... key."""

VELOCITY_SPAN = 0.1
"""Seconds by which velocities count against distances: 1 m/s is as much as 0.1 m."""

_FEATURES = (
    "head",
    *(f"{side}_{part}" for side in ("left", "right") for part in ("hand", "foot", "lower_leg")),
)


@dataclass(frozen=True, slots=True)
class Loop:
    """Where a motion repeats.

    Parameters
    ----------
    start, end
        Seconds; the pose at the end continues into that at the start.
    distance
        How far the seam is from perfect: root mean square of the features' distances and of
        `VELOCITY_SPAN` times their differences in velocity, metres.
    """

    start: float
    end: float
    distance: float


def find_loop(
    clip: Clip,
    skeleton: Skeleton | Humanoid,
    *,
    shortest: float = 0.5,
    longest: float | None = None,
) -> Loop:
    """The best place to close a clip.

    Parameters
    ----------
    clip
        The motion; a walk may cross the room and turn, since bodies are compared from their hips.
    skeleton
        Its skeleton, a human body.
    shortest, longest
        Seconds that the loop may last.

    Raises
    ------
    ValueError
        If the clip has no loop of that length, being too short, or the skeleton is no human body.
    """
    figure = figure_of(skeleton if isinstance(skeleton, Humanoid) else humanoid(skeleton))
    longest = clip.duration if longest is None else min(longest, clip.duration)
    if not 0 < shortest <= longest:
        raise ValueError(
            f"shortest {shortest:g} s and longest {longest:g} s of a loop in clip '{clip.name}' of "
            f"{clip.duration:g} s, expected 0 < shortest <= longest <= its length"
        )
    stride = -(-clip.frame_count // MOST_MOMENTS)
    step = clip.duration / (clip.frame_count - 1)
    features = _features(clip, figure)
    velocities = np.gradient(features, step, axis=0) if clip.frame_count > 1 else 0 * features
    rows = np.concatenate([features, VELOCITY_SPAN * velocities], axis=1)[::stride]
    rows = rows / np.sqrt(features.shape[1] / 3)
    squares = (rows**2).sum(axis=1)
    distance = squares[:, None] + squares[None] - 2 * rows @ rows.T
    at = np.arange(len(rows)) * stride * step
    length = at[None] - at[:, None]
    allowed = (length >= shortest - 1e-9) & (length <= longest + 1e-9)
    if not allowed.any():
        raise ValueError(f"clip '{clip.name}' has too few keys for a loop of {shortest:g} s")
    # Of equal seams the longer loop is taken: it repeats less.
    cost = np.where(allowed, distance - 1e-9 * length, np.inf)
    first, last = np.unravel_index(int(np.argmin(cost)), cost.shape)
    seam = float(np.sqrt(max(distance[first, last], 0.0)))
    return Loop(float(at[first]), float(min(at[last], clip.duration)), seam)


def loop_clip(
    clip: Clip,
    skeleton: Skeleton | Humanoid,
    loop: Loop | None = None,
    *,
    blend: float = 0.25,
) -> Clip:
    """A clip that repeats without a jump, in place.

    The part is cut out, what the body travels and turns in it is taken out evenly, so that it
    stays where it is, and what is left of the difference between the last pose and the first is
    blended in over the last `blend` seconds.

    Raises
    ------
    ValueError
        As `find_loop`, or if `blend` is negative.
    """
    if blend < 0:
        raise ValueError(f"blend is {blend}, expected seconds, 0 or more")
    body = skeleton if isinstance(skeleton, Humanoid) else humanoid(skeleton)
    figure = figure_of(body)
    found = find_loop(clip, body) if loop is None else loop
    part = trim_clip(clip, found.start, found.end)
    rotation, translation = _in_place(part, figure)
    share = np.linspace(0.0, part.duration, part.frame_count)
    share = 1 - (part.duration - share) / min(max(blend, 1e-9), part.duration)
    share = np.clip(share, 0.0, 1.0)
    share = share * share * (3 - 2 * share)
    translation += share[:, None, None] * (translation[0] - translation[-1])
    inverse = rotation[-1] * np.array([-1.0, -1.0, -1.0, 1.0])
    missing = multiply(inverse, rotation[0])
    missing = np.where(missing[:, 3:] < 0, -missing, missing)
    half = np.arctan2(np.linalg.norm(missing[:, :3], axis=1), missing[:, 3])
    sine = np.sin(half)
    axis = missing[:, :3] / np.where(sine > 1e-9, sine, 1.0)[:, None]
    angle = share[:, None] * half
    turn = np.concatenate([axis * np.sin(angle)[..., None], np.cos(angle)[..., None]], axis=-1)
    rotation = continuous_hemisphere(multiply(rotation, turn))
    scale = part.scale + share[:, None, None].astype(np.float32) * (part.scale[0] - part.scale[-1])
    return replace(
        part,
        rotation=rotation.astype(np.float32),
        translation=translation.astype(np.float32),
        scale=scale.astype(np.float32),
        looping=True,
    )


def _model(clip: Clip, figure: Figure) -> tuple[Array, Array]:
    """Turns and places of all joints, model space."""
    turns, _, positions = forward(
        figure.humanoid.skeleton,
        matrices_of(clip.rotation.astype(np.float64)),
        clip.translation.astype(np.float64),
        clip.scale.astype(np.float64),
    )
    return turns, positions


def _heading(turns: Array, figure: Figure) -> Array:
    """(F,) angle of the hips' forward direction about the body's up axis, unwrapped."""
    ahead = np.matmul(turns[:, figure.joints["hips"]], figure.offset("hips"))[:, :, 2]
    ahead = ahead @ figure.axes
    return np.asarray(np.unwrap(np.arctan2(ahead[:, 0], ahead[:, 2])))


def _features(clip: Clip, figure: Figure) -> Array:
    """(F, 3 N) places seen from the hips, facing forward, and the height of the hips."""
    turns, positions = _model(clip, figure)
    facing = about_y(-_heading(turns, figure))
    hips = positions[:, figure.joints["hips"]]
    seen = [
        turned(facing, (positions[:, figure.joints[part]] - hips) @ figure.axes)
        for part in _FEATURES
        if part in figure.joints
    ]
    height = np.zeros_like(hips)
    height[:, 1] = hips @ figure.axes[:, 1]
    return np.concatenate([*seen, height], axis=1)


def _in_place(clip: Clip, figure: Figure) -> tuple[Array, Array]:
    """Local rotations and translations with the travel and the turn of the hips taken out."""
    skeleton, hips = figure.humanoid.skeleton, figure.joints["hips"]
    turns, positions = _model(clip, figure)
    share = np.linspace(0.0, 1.0, clip.frame_count)
    heading = _heading(turns, figure)
    back = figure.axes @ about_y(-share * (heading[-1] - heading[0])) @ figure.axes.T
    # Turned about the hips at every moment, so that the way stays a way.
    place = positions[:, hips]
    steps = np.einsum("fij,fj->fi", back[1:], np.diff(place, axis=0))
    way = np.concatenate([[place[0]], place[0] + np.cumsum(steps, axis=0)])
    level = np.eye(3) - np.outer(figure.axes[:, 1], figure.axes[:, 1])
    way = way - share[:, None] * (level @ (way[-1] - way[0]))
    way -= np.outer((way - place) @ figure.axes[:, 1], figure.axes[:, 1])
    parent = int(skeleton.parents[hips])
    rotation = clip.rotation.astype(np.float64)
    translation = clip.translation.astype(np.float64)
    wanted = np.matmul(back, turns[:, hips])
    if parent >= 0:
        linear = _linear(clip, figure, parent)
        wanted = np.matmul(transposed(turns[:, parent]), wanted)
        way = np.linalg.solve(linear, (way - positions[:, parent])[..., None])[..., 0]
    rotation[:, hips] = quaternions_of(wanted)
    translation[:, hips] = way
    return continuous_hemisphere(rotation), translation


def _linear(clip: Clip, figure: Figure, joint: int) -> Array:
    """(F, 3, 3) model-space turn and scale of a joint."""
    _, linear, _ = forward(
        figure.humanoid.skeleton,
        matrices_of(clip.rotation.astype(np.float64)),
        clip.translation.astype(np.float64),
        clip.scale.astype(np.float64),
    )
    return np.asarray(linear[:, joint])

"""The mirror image of a motion: what the left side did, the right side does."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...animation.clip import Clip, ClipEvent, continuous_hemisphere
from ...animation.skeleton import Skeleton
from .figure import figure_of
from .humanoid import Humanoid, humanoid
from .names import read_name
from .turns import Array, forward, matrices_of, quaternions_of, transposed, turned

MIRROR = np.diag([-1.0, 1.0, 1.0])
"""Reflection at the plane between left and right, in the body's axes."""

_SIDED = re.compile(r"(?<![A-Za-z])(left|right|l|r)(?![A-Za-z])")
_OTHER = {"left": "right", "right": "left", "l": "r", "r": "l"}


def mirror_clip(clip: Clip, skeleton: Skeleton | Humanoid, name: str | None = None) -> Clip:
    """Exchange left and right.

    Parameters
    ----------
    clip
        The motion.
    skeleton
        Its skeleton, a human body; it need not be symmetric.
    name
        Of the new clip; by default ``"NAME mirrored"``.

    Returns
    -------
    Clip
        The sides of events called ``foot_left``, ``clap_r`` and the like are exchanged too.
        Mirrored twice, a motion is what it was.

    Raises
    ------
    ValueError
        If the skeleton is no human body or the clip is of another.
    """
    body = skeleton if isinstance(skeleton, Humanoid) else humanoid(skeleton)
    figure, bones = figure_of(body), body.skeleton
    if clip.joint_count != bones.joint_count:
        raise ValueError(
            f"clip '{clip.name}' has {clip.joint_count} joints, its skeleton {bones.joint_count}"
        )
    partner = _partners(body)
    parts = {joint: part for part, joint in body.joints.items()}
    still = np.eye(3)
    offsets = np.stack(
        [
            figure.turns[joint].T @ figure.axes @ figure.frames.get(parts.get(joint, ""), still)
            for joint in range(bones.joint_count)
        ]
    )
    turns, _, _ = forward(
        bones,
        matrices_of(clip.rotation.astype(np.float64)),
        clip.translation.astype(np.float64),
        clip.scale.astype(np.float64),
    )
    # The world is reflected at the plane x = 0 of a body that faces +Z, else along its own axes.
    world = figure.axes @ MIRROR @ figure.axes.T
    frames = np.matmul(turns, offsets)[:, partner]
    mirrored = np.matmul(np.matmul(world @ frames, MIRROR), transposed(offsets))
    local = mirrored.copy()
    below = np.flatnonzero(bones.parents >= 0)
    local[:, below] = np.matmul(transposed(mirrored[:, bones.parents[below]]), mirrored[:, below])
    return replace(
        clip,
        name=f"{clip.name} mirrored" if name is None else name,
        rotation=continuous_hemisphere(quaternions_of(local)).astype(np.float32),
        translation=_translation(clip, bones, figure.turns, world, partner).astype(np.float32),
        scale=clip.scale[:, partner],
        events=tuple(ClipEvent(event.time, _other_side(event.name)) for event in clip.events),
    )


def _translation(
    clip: Clip, bones: Skeleton, turns: Array, world: Array, partner: NDArray[np.int64]
) -> Array:
    """Displacements from rest of the partners, reflected."""
    rest = bones.rest_translation.astype(np.float64)
    moved = clip.translation.astype(np.float64) - rest
    still = np.eye(3)
    above = np.stack([still if p < 0 else turns[p] for p in bones.parents.tolist()])
    reflected = turned(world, turned(above[partner], moved[:, partner]))
    return np.asarray(rest + turned(transposed(above), reflected))


def _partners(body: Humanoid) -> NDArray[np.int64]:
    """(J,) joint on the other side, or the joint itself."""
    names = body.skeleton.names
    partner = np.arange(len(names))
    for part, joint in body.joints.items():
        side, _, rest = part.partition("_")
        if side in ("left", "right"):
            partner[joint] = body.joints.get(f"{_OTHER[side]}_{rest}", joint)
    used = set(body.joints.values())
    readings = {k: read_name(name) for k, name in enumerate(names) if k not in used}
    by_reading = {(r.side, r.part, r.numbers): k for k, r in readings.items() if r.side}
    for joint, r in readings.items():
        if r.side:
            partner[joint] = by_reading.get((_OTHER[r.side], r.part, r.numbers), joint)
    return np.asarray(partner, dtype=np.int64)


def _other_side(name: str) -> str:
    return _SIDED.sub(lambda match: _OTHER[match[0]], name)

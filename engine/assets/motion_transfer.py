"""Moves a clip to another skeleton of the same build.

This is not retargeting: local rotations are taken as they are, which is right only if both
skeletons have the same bones in the same local frames. That is checked, so that a motion of
another skeleton is refused and not shown as a twisted body.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..animation.clip import Clip
from ..animation.skeleton import Skeleton
from ..errors import AssetError

BONE_TOLERANCE = 0.01
"""Largest difference of two offsets, in the length of the bone plus a tenth of the longest's."""

_SAME_SKELETON = "motions must be made for the same skeleton"

Array = NDArray[np.float64]


def transfer_clip(path: str | Path, clip: Clip, source: Skeleton, target: Skeleton) -> Clip:
    """`clip` of `source` as a clip of `target`.

    Joints that both have follow the clip, the others of `target` stay at rest. Translations are
    multiplied by the ratio of the skeletons' sizes.

    Parameters
    ----------
    path
        The motion's file, for error messages.
    clip, source
        The motion and its skeleton.
    target
        The skeleton that gets it.

    Raises
    ------
    AssetError
        If `target` lacks a joint that moves, or a joint hangs elsewhere or at another offset.
    """
    places = {name: joint for joint, name in enumerate(target.names)}
    moving = _moving(clip, source)
    shared: list[int] = []
    for joint, name in enumerate(source.names):
        if name in places:
            shared.append(joint)
        elif moving[joint]:
            raise AssetError(
                path, "", f"moves joint '{name}', which the character lacks; {_SAME_SKELETON}"
            )
    if not shared:
        raise AssetError(path, "", f"has no joint of the character; {_SAME_SKELETON}")
    kept = np.array(shared)
    at = np.array([places[source.names[joint]] for joint in shared])
    ratio = _check_bones(path, source, target, kept, at)

    frames = clip.frame_count
    rotation = np.tile(target.rest_rotation, (frames, 1, 1))
    translation = np.tile(target.rest_translation, (frames, 1, 1))
    scale = np.tile(target.rest_scale, (frames, 1, 1))
    rotation[:, at] = clip.rotation[:, kept]
    translation[:, at] = clip.translation[:, kept] * np.float32(ratio)
    scale[:, at] = clip.scale[:, kept]
    return replace(
        clip,
        rotation=rotation,
        translation=translation,
        scale=scale,
        resampling_error=clip.resampling_error * ratio,
    )


def _moving(clip: Clip, skeleton: Skeleton) -> NDArray[np.bool_]:
    """(J,) whether a joint leaves its rest pose somewhere in the clip."""
    cosine = np.abs(np.einsum("fjk,jk->fj", clip.rotation, skeleton.rest_rotation))
    turned = (cosine < 1.0 - 1e-6).any(axis=0)
    size = 1e-4 * float(np.abs(skeleton.rest_translation).max(initial=0.0)) + 1e-7
    moved = (np.abs(clip.translation - skeleton.rest_translation) > size).any(axis=(0, 2))
    scaled = (np.abs(clip.scale - skeleton.rest_scale) > 1e-4).any(axis=(0, 2))
    return np.asarray(turned | moved | scaled)


def _check_bones(
    path: str | Path,
    source: Skeleton,
    target: Skeleton,
    kept: NDArray[np.int64],
    at: NDArray[np.int64],
) -> float:
    """Size of `target` over that of `source`, when joints `kept` and `at` have the same bones."""
    bones: list[tuple[int, int]] = []
    for joint, place in zip(kept.tolist(), at.tolist(), strict=True):
        name = source.names[joint]
        above, over = int(source.parents[joint]), int(target.parents[place])
        if above < 0:
            _check_stand(path, name, target, over)
            continue
        if over < 0 or source.names[above] != target.names[over]:
            here = f"below '{target.names[over]}'" if over >= 0 else "at the root"
            raise AssetError(
                path,
                "",
                f"joint '{name}' hangs below '{source.names[above]}', in the character {here}; "
                f"{_SAME_SKELETON}",
            )
        bones.append((joint, place))
    if not bones:
        return 1.0
    theirs = source.rest_translation[[joint for joint, _ in bones]].astype(np.float64)
    ours = target.rest_translation[[place for _, place in bones]].astype(np.float64)
    their_lengths, our_lengths = np.linalg.norm(theirs, axis=1), np.linalg.norm(ours, axis=1)
    both = (their_lengths > 1e-9) & (our_lengths > 1e-9)
    # The median leaves a single wrong bone as the one that stands out.
    ratio = float(np.median(our_lengths[both] / their_lengths[both])) if both.any() else 1.0
    allowed = BONE_TOLERANCE * (our_lengths + 0.1 * float(our_lengths.max()))
    excess = np.linalg.norm(ours - ratio * theirs, axis=1) - allowed
    worst = int(np.argmax(excess))
    if excess[worst] > 0:
        raise AssetError(
            path,
            "",
            f"joint '{source.names[bones[worst][0]]}' lies at {_metres(ratio * theirs[worst])} m "
            f"from its parent, in the character at {_metres(ours[worst])} m; {_SAME_SKELETON}",
        )
    return ratio


def _check_stand(path: str | Path, name: str, target: Skeleton, joint: int) -> None:
    """Refuse a root of the motion whose joints above it in the character turn or scale it."""
    while joint >= 0:
        turned = abs(float(target.rest_rotation[joint, 3])) < 1.0 - 1e-6
        if turned or not np.allclose(target.rest_scale[joint], 1.0, atol=1e-4):
            raise AssetError(
                path,
                "",
                f"root '{name}' hangs below '{target.names[joint]}' in the character, which is "
                f"turned or scaled at rest; {_SAME_SKELETON}",
            )
        joint = int(target.parents[joint])


def _metres(offset: Array) -> str:
    return "(" + ", ".join(f"{value:.4f}" for value in offset) + ")"

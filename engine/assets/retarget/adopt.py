"""Gives the clips of a file to a character, by the way that fits their skeletons."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...animation.clip import Clip
from ...animation.skeleton import Skeleton
from ...errors import AssetError
from .humanoid import NotHumanoidError, humanoid
from .transfer import retarget

SAME = 1e-4
"""Largest difference of rest poses of one skeleton: of rotations, and of offsets in sizes of it."""


def adopt_clips(
    path: str | Path, clips: Sequence[Clip], source: Skeleton, target: Skeleton
) -> list[Clip]:
    """The clips of a file for the skeleton of a character.

    Between human bodies motions are retargeted. Clips of the very same skeleton are taken as they
    are where there is nothing to retarget: where it is no human body, or where its hips hang below
    a root, so that the clips are relative to that root already.

    Raises
    ------
    AssetError
        If the file or the character is no human body and the skeletons differ, or if a clip can't
        be used.
    """
    same = same_skeleton(source, target)
    try:
        body = humanoid(source)
    except ValueError as error:
        if same:
            return list(clips)
        raise AssetError(path, "", f"{error}; other motions must be of the same skeleton") from None
    if same and source.parents[body.joints["hips"]] >= 0:
        return list(clips)
    try:
        goal = humanoid(target)
    except NotHumanoidError as error:
        raise AssetError(path, "", f"can't be given to this character, which {error}") from None
    adopted = []
    for clip in clips:
        try:
            adopted.append(retarget(clip, body, goal))
        except ValueError as error:
            raise AssetError(path, "", str(error)) from None
    return adopted


def same_skeleton(first: Skeleton, second: Skeleton) -> bool:
    """Whether two skeletons have the same joints, tree and rest pose."""
    if first.names != second.names or not np.array_equal(first.parents, second.parents):
        return False
    turns = np.abs(np.sum(first.rest_rotation * second.rest_rotation, axis=1))
    size = float(np.abs(first.rest_translation).max(initial=1e-9))
    return bool(
        turns.min() > 1 - SAME
        and np.allclose(first.rest_translation, second.rest_translation, atol=SAME * size)
        and np.allclose(first.rest_scale, second.rest_scale, rtol=SAME)
    )

"""Girth and head size as morph targets, so that agents of any build share one mesh.

The crowd's rule (`tifo.engine.crowd.morphs`) moves a vertex p with normal n by girth g and head
growth h to ``q + h b (q - c)`` with ``q = p + g a n'``. Multiplied out that is linear in g, h and
g h, so three targets show it exactly.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..assets.character import SkinnedMesh
from ..crowd.morphs import UPWARD
from .recording import Recording

GIRTH_UNIT = 0.05
"""Girth at weight 1, as a share of the character's height."""
HEAD_UNIT = 0.1
"""Growth of the head at weight 1."""
_NOTHING = 1e-7


@dataclass(frozen=True, slots=True, eq=False)
class MorphTargets:
    """Targets of all meshes of a level.

    Parameters
    ----------
    names
        ``girth``, ``head`` and where both meet, ``girth_head``; empty if nobody is morphed.
    offsets
        For each mesh, for each name, (V, 3) float32 what weight 1 adds to the bind pose.
    weights
        (K, names) float32 of the agents.
    """

    names: tuple[str, ...]
    offsets: tuple[tuple[NDArray[np.float32], ...], ...]
    weights: NDArray[np.float32]


def morph_targets(recording: Recording, meshes: Sequence[SkinnedMesh]) -> MorphTargets:
    """Find the targets and what each agent has of them."""
    morphs = recording.morphs
    if morphs is None or not (recording.girth.any() or recording.head.any()):
        none = np.zeros((len(recording), 0), np.float32)
        return MorphTargets((), ((),) * len(meshes), none)
    unit = GIRTH_UNIT * recording.height
    offsets = []
    for mesh in meshes:
        share = morphs.of(mesh)
        girth = unit * share[:, :1] * mesh.normals * np.array([1.0, UPWARD, 1.0], np.float32)
        head = HEAD_UNIT * share[:, 1:] * (mesh.positions - morphs.head_centre)
        offsets.append([girth, head, HEAD_UNIT * share[:, 1:] * girth])
    weights = np.stack([recording.girth / unit, recording.head / HEAD_UNIT], axis=1)
    weights = np.concatenate([weights, weights[:, :1] * weights[:, 1:]], axis=1)
    names = ["girth", "head", "girth_head"]
    kept = [
        number
        for number in range(3)
        if weights[:, number].any()
        and any(np.abs(own[number]).max(initial=0.0) > _NOTHING for own in offsets)
    ]
    return MorphTargets(
        names=tuple(names[number] for number in kept),
        offsets=tuple(tuple(own[number].astype(np.float32) for number in kept) for own in offsets),
        weights=weights[:, kept].astype(np.float32),
    )

"""Bind-pose morphs: girth and head size, from a character's joint tree and skin weights.

Proportions can't vary on shared palettes, but the mesh that they move can. A vertex has two
weights: how far girth moves it outward, and how much of the head's growth it takes part in. They
follow from the joints that move it, so any humanoid has them and no file needs to carry them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..animation.skeleton import Skeleton
from ..assets.character import SkinnedMesh
from ..streams.pool import bind_positions
from .figure import MARKERS, Figure

TAPER = 0.55
"""Share of the girth of a joint's parent that it has itself, outside the trunk."""
UPWARD = 0.2
"""Share of the upward part of a normal that girth follows: people grow wide, not tall."""


@dataclass(frozen=True, slots=True, eq=False)
class MorphWeights:
    """How much each joint's skin takes part in the morphs.

    Parameters
    ----------
    girth, head
        (J,) float32, 0 to 1.
    head_centre
        (3,) float32 model-space point of the bind pose from which the head grows.
    """

    girth: NDArray[np.float32]
    head: NDArray[np.float32]
    head_centre: NDArray[np.float32]

    def of(self, mesh: SkinnedMesh) -> NDArray[np.float32]:
        """(V, 2) float32 weights of a mesh's vertices: girth, head."""
        joint = np.stack([self.girth, self.head], axis=1)
        weights: NDArray[np.float32] = np.einsum(
            "vk,vkm->vm", mesh.weights, joint[mesh.joints], dtype=np.float32
        )
        return np.clip(weights, 0.0, 1.0)


def morph_weights(skeleton: Skeleton, figure: Figure) -> MorphWeights:
    """Trunk joints have all of the girth, limbs less by every joint; hands, feet, head none."""
    marked = dict(zip(MARKERS, (int(joint) for joint in figure.joints), strict=True))
    trunk = _above(skeleton, marked["chest"])
    count = skeleton.joint_count
    girth, head = np.zeros(count, np.float32), np.zeros(count, np.float32)
    ends = {marked[name] for name in MARKERS if name not in ("hips", "chest")}
    ended = np.zeros(count, np.bool_)
    for joint, parent in enumerate(skeleton.parents):  # parents come before children
        ended[joint] = joint in ends or (parent >= 0 and ended[parent])
        if joint in trunk:
            girth[joint] = 1.0
        elif not ended[joint] and parent >= 0:
            girth[joint] = TAPER * girth[parent]
        head[joint] = joint == marked["head"] or (parent >= 0 and head[parent])
    return MorphWeights(girth, head, bind_positions(skeleton)[marked["head"]])


def morphed_positions(
    mesh: SkinnedMesh, weights: MorphWeights, girth: float, head: float
) -> NDArray[np.float32]:
    """(V, 3) float32 bind pose of a mesh with a girth and a head size, as the shader has it."""
    share = weights.of(mesh)
    outward = mesh.normals * np.array([1.0, UPWARD, 1.0], np.float32)
    moved = mesh.positions + girth * share[:, :1] * outward
    grown = moved + head * share[:, 1:] * (moved - weights.head_centre)
    return grown.astype(np.float32, copy=False)


def _above(skeleton: Skeleton, joint: int) -> set[int]:
    """A joint and all above it."""
    found = {joint}
    while (parent := int(skeleton.parents[joint])) >= 0:
        found.add(parent)
        joint = parent
    return found

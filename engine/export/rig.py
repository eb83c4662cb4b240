"""Bones that move a mesh exactly as palettes do, in formats that know only turns and scales.

What agents show is mixed from poses, and a mix of two turns is a turn with a little stretch in some
direction, which no chain of translations, turns and scales passes on. So bones are rigid: a place,
a turn and one factor that stays. Where the rest would be seen, the skin hangs on two further joints
below the bone: one turns into the direction of the stretch and stretches, one turns back.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import DTypeLike, NDArray

from ..animation.skeleton import Skeleton
from ..assets.character import SkinnedMesh

F64 = NDArray[np.float64]

STRETCH, SKIN = "_stretch", "_skin"
"""Endings of the names of the two further joints."""


@dataclass(frozen=True, slots=True, eq=False)
class Rig:
    """The joints of a file: those of the skeleton under their own numbers, then the further ones.

    Parameters
    ----------
    names
        R names, unique.
    parents
        (R,) int32; parents come before children.
    skin
        (J,) int64 the joint that moves what each joint of the skeleton moves.
    stretched
        (J,) bool which have further joints.
    """

    names: tuple[str, ...]
    parents: NDArray[np.int32]
    skin: NDArray[np.int64]
    stretched: NDArray[np.bool_]

    def __len__(self) -> int:
        """Number of joints R."""
        return len(self.names)

    def part(self, other: Rig) -> NDArray[np.int64]:
        """(R,) where the joints of a rig in which fewer joints can stretch are in this one."""
        further = self.skin[other.stretched, None] + np.array([-1, 0])
        return np.concatenate([np.arange(len(self.skin)), further.ravel()])


def make_rig(skeleton: Skeleton, stretched: NDArray[np.bool_]) -> Rig:
    """The rig in which the joints `stretched` (J,) bool can stretch what they move."""
    names, parents = list(skeleton.names), list(skeleton.parents)
    skin = np.arange(skeleton.joint_count)
    taken = set(names)
    for joint in np.flatnonzero(stretched):
        above = int(joint)
        for ending in (STRETCH, SKIN):
            name = skeleton.names[joint] + ending
            while name in taken:
                name += "_"
            taken.add(name)
            names.append(name)
            parents.append(np.int32(above))
            above = len(names) - 1
        skin[joint] = above
    return Rig(tuple(names), np.array(parents, np.int32), skin, stretched.copy())


def reach(skeleton: Skeleton, meshes: tuple[SkinnedMesh, ...]) -> F64:
    """(J,) how far from each joint what it moves lies in the bind pose, times its weight there."""
    places = bind_matrices(skeleton)[:, :3, 3]
    far = np.zeros(skeleton.joint_count)
    for mesh in meshes:
        for slot in range(mesh.joints.shape[1]):
            joint = mesh.joints[:, slot]
            distance = np.linalg.norm(mesh.positions - places[joint], axis=1)
            np.maximum.at(far, joint, mesh.weights[:, slot] * distance)
    return far


def levers(skeleton: Skeleton, far: F64) -> F64:
    """(J,) length over which a turn of each joint is seen: its `reach` or its longest bone."""
    places = bind_matrices(skeleton)[:, :3, 3]
    longest = far.copy()
    for joint, parent in enumerate(skeleton.parents):
        if parent >= 0:
            bone = float(np.linalg.norm(places[joint] - places[parent]))
            longest[parent] = max(longest[parent], bone)
    return longest


def bind_matrices(skeleton: Skeleton) -> F64:
    """(J, 4, 4) joint space to model space of the bind pose."""
    inverse = np.zeros((skeleton.joint_count, 4, 4))
    inverse[:, :3], inverse[:, 3, 3] = skeleton.inverse_bind, 1.0
    return np.linalg.inv(inverse).astype(np.float64)


@dataclass(frozen=True, slots=True, eq=False)
class Factors:
    """Model matrices (T, K, J) as place, turn and stretch, times a factor that stays.

    ``M = [turn axes diag(size stretch) axes^T | place]``

    Parameters
    ----------
    place
        (T, K, J, 3).
    turn, axes
        (T, K, J, 3, 3) rotations.
    size
        (K, J) factor of the bone.
    stretch
        (T, K, J, 3) factors along `axes`, about 1.
    """

    place: F64
    turn: F64
    axes: F64
    size: F64
    stretch: F64

    def of(self, agents: NDArray[np.int64]) -> Factors:
        """Those of some of the agents, by their places."""
        return Factors(
            self.place[:, agents],
            self.turn[:, agents],
            self.axes[:, agents],
            self.size[agents],
            self.stretch[:, agents],
        )

    def deviation(self, far: F64) -> F64:
        """(K, J) metres by which leaving the stretch out moves skin, for the `reach` of joints."""
        off: F64 = np.abs(self.stretch - 1.0).max(axis=(0, 3)) * far
        return off


def factors(
    skeleton: Skeleton, palettes: NDArray[np.float32], scales: DTypeLike = np.float32
) -> Factors:
    """Split what palettes (T, K, J, 3, 4) make of the bind pose.

    Bones have sizes that a file with scales of type `scales` can hold; the rest is stretch.
    """
    matrices = palettes.astype(np.float64) @ bind_matrices(skeleton)
    left, values, right = np.linalg.svd(matrices[..., :3])
    # Two rotations, with a mirroring as a negative stretch.
    for side, index in ((left, (..., slice(None), 2)), (right, (..., 2, slice(None)))):
        flip = np.where(np.linalg.det(side) < 0, -1.0, 1.0)
        side[index] *= flip[..., None]
        values[..., 2] *= flip
    size = np.round(np.median(values[..., 0], axis=0), 5)
    # A joint that shrinks its skin to nothing still carries its children.
    size = np.where(size > 1e-4, size, 1.0)
    for joint, parent in enumerate(skeleton.parents):
        above = size[:, parent] if parent >= 0 else np.ones(len(size))
        size[:, joint] = above * (size[:, joint] / above).astype(scales).astype(np.float64)
    return Factors(
        place=matrices[..., 3],
        turn=left @ right,
        axes=np.swapaxes(right, -1, -2),
        size=size,
        stretch=values / size[..., None],
    )

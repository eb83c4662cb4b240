"""The pose in which skeletons are compared: the bind pose where it is known, else the rest pose.

The bind pose is the one that the mesh was modelled in, upright with spread limbs; the rest pose of
a file may be any frame of a motion. A skeleton without meshes has only its rest pose.
"""

from __future__ import annotations

import numpy as np

from ...animation.skeleton import Skeleton
from .turns import Array, forward, matrices_of, nearest_rotation

BONE_TOLERANCE = 0.05
"""Largest share of a bone's length by which bind and rest pose may differ, to be of one body."""

_NO_BIND = np.eye(3, 4)


def rest_pose(skeleton: Skeleton) -> tuple[Array, Array]:
    """Model-space turns (J, 3, 3) and places (J, 3) of the rest pose, float64."""
    turns, _, positions = forward(
        skeleton,
        matrices_of(skeleton.rest_rotation.astype(np.float64))[None],
        skeleton.rest_translation.astype(np.float64)[None],
        skeleton.rest_scale.astype(np.float64)[None],
    )
    return turns[0], positions[0]


def reference_pose(skeleton: Skeleton) -> tuple[Array, Array]:
    """Model-space turns (J, 3, 3) and places (J, 3) of the reference pose, float64.

    A joint that skins nothing lies to its parent as at rest. If the bones of the bind pose are not
    those of the rest pose, the rest pose is taken.
    """
    turns, positions = rest_pose(skeleton)
    inverse = skeleton.inverse_bind.astype(np.float64)
    parents = skeleton.parents.tolist()
    bind_turns, bind_positions = turns.copy(), positions.copy()
    known = np.zeros(len(parents), dtype=np.bool_)
    for joint, parent in enumerate(parents):
        linear = inverse[joint, :, :3]
        skins = not np.array_equal(inverse[joint], _NO_BIND)
        if skins and abs(np.linalg.det(linear)) > 1e-12:
            there = np.asarray(np.linalg.inv(linear), dtype=np.float64)
            bind_turns[joint] = nearest_rotation(there)
            bind_positions[joint] = -there @ inverse[joint, :, 3]
            known[joint] = True
        elif parent >= 0:
            change = bind_turns[parent] @ turns[parent].T
            bind_turns[joint] = change @ turns[joint]
            offset = positions[joint] - positions[parent]
            bind_positions[joint] = bind_positions[parent] + change @ offset
    children = [j for j, parent in enumerate(parents) if parent >= 0 and known[j] and known[parent]]
    above = [parents[j] for j in children]
    ours = np.linalg.norm(positions[children] - positions[above], axis=1)
    theirs = np.linalg.norm(bind_positions[children] - bind_positions[above], axis=1)
    size = float(ours.max(initial=0.0))
    if (np.abs(ours - theirs) > BONE_TOLERANCE * np.maximum(ours, 0.2 * size)).any():
        return turns, positions
    return bind_turns, bind_positions

"""The joint tree that clips, poses and meshes of one character share.

Joints are stored breadth first: sorted by depth, so every level of the tree is one contiguous
slice and forward kinematics can take a whole level of all streams at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float32]
IntArray = NDArray[np.int32]


def breadth_first_order(parents: Sequence[int]) -> IntArray:
    """Order that sorts joints by depth and keeps the given order within a level.

    Parameters
    ----------
    parents
        Index of each joint's parent in any order, -1 for a root.

    Returns
    -------
    (J,) int32
        ``order[k]`` is the old index of new joint ``k``; for parents ``[2, -1, 1]`` it is
        ``[1, 2, 0]``.

    Raises
    ------
    ValueError
        If the parents form a cycle or point outside the list.
    """
    count = len(parents)
    depth = np.full(count, -1, dtype=np.int32)
    for start in range(count):
        chain: list[int] = []
        joint = start
        while joint != -1 and depth[joint] < 0:
            if not -1 <= parents[joint] < count:
                raise ValueError(
                    f"parents[{joint}] is {parents[joint]}, but there are {count} joints"
                )
            if len(chain) > count:
                raise ValueError(f"parents: joint {start} is its own ancestor")
            chain.append(joint)
            joint = parents[joint]
        base = -1 if joint == -1 else int(depth[joint])
        for step, member in enumerate(reversed(chain), start=1):
            depth[member] = base + step
    return np.argsort(depth, kind="stable").astype(np.int32)


@dataclass(frozen=True, slots=True, eq=False)
class Skeleton:
    """A tree of joints with its rest pose and its bind pose.

    Model space is right-handed, +Y up, metres; characters face +Z.

    Parameters
    ----------
    names
        J joint names, unique.
    parents
        (J,) int32, -1 for a root, sorted by depth (see `breadth_first_order`).
    rest_rotation, rest_translation, rest_scale
        (J, 4) xyzw, (J, 3) and (J, 3) float32: local transforms of joints that a clip leaves alone.
    inverse_bind
        (J, 3, 4) float32: model space of the bind pose to joint space, the affine part of a
        column-vector matrix. A joint that skins nothing has the identity.

    Raises
    ------
    ValueError
        For wrong shapes, no joints, duplicate names or joints not sorted by depth.
    """

    names: tuple[str, ...]
    parents: IntArray
    rest_rotation: FloatArray
    rest_translation: FloatArray
    rest_scale: FloatArray
    inverse_bind: FloatArray
    levels: tuple[slice, ...] = field(init=False)

    def __post_init__(self) -> None:
        """Check the shapes and find the levels."""
        count = len(self.names)
        if count == 0:
            raise ValueError("names: a skeleton needs at least one joint")
        if len(set(self.names)) != count:
            twice = next(name for name in self.names if self.names.count(name) > 1)
            raise ValueError(f"names: joint '{twice}' occurs more than once")
        for name, shape in (
            ("parents", (count,)),
            ("rest_rotation", (count, 4)),
            ("rest_translation", (count, 3)),
            ("rest_scale", (count, 3)),
            ("inverse_bind", (count, 3, 4)),
        ):
            found = getattr(self, name).shape
            if found != shape:
                raise ValueError(f"{name} has shape {found}, expected {shape}")
        order = breadth_first_order([int(p) for p in self.parents])
        if not np.array_equal(order, np.arange(count)):
            raise ValueError("parents: joints are not sorted by depth")
        object.__setattr__(self, "levels", _levels(self.parents))

    @property
    def joint_count(self) -> int:
        """Number of joints J."""
        return len(self.names)

    def index(self, name: str) -> int:
        """Index of the joint called `name`; ValueError names near matches if there is none."""
        try:
            return self.names.index(name)
        except ValueError:
            from difflib import get_close_matches

            near = get_close_matches(name, self.names) or list(self.names[:5])
            raise ValueError(f"no joint '{name}'; near: {', '.join(near)}") from None


def _levels(parents: IntArray) -> tuple[slice, ...]:
    depth = np.zeros(len(parents), dtype=np.int32)
    for joint, parent in enumerate(parents):
        depth[joint] = 0 if parent < 0 else depth[parent] + 1
    edges = np.searchsorted(depth, np.arange(int(depth[-1]) + 2))
    return tuple(slice(int(a), int(b)) for a, b in pairwise(edges))

"""Questions about a joint tree: who is above whom, where branches meet, where joints are."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ...animation.skeleton import Skeleton
from .rest import reference_pose
from .turns import Array


@dataclass(frozen=True, slots=True, eq=False)
class Tree:
    """A skeleton's parents and children, and the model-space places of its reference pose.

    Parameters
    ----------
    skeleton
        The joints.
    parents
        Parent of each joint, -1 for a root.
    children
        Children of each joint.
    positions
        (J, 3) float64 metres.
    """

    skeleton: Skeleton
    parents: tuple[int, ...]
    children: tuple[tuple[int, ...], ...]
    positions: Array

    @classmethod
    def of(cls, skeleton: Skeleton) -> Tree:
        """The tree of a skeleton."""
        parents = tuple(int(parent) for parent in skeleton.parents)
        children: list[list[int]] = [[] for _ in parents]
        for joint, parent in enumerate(parents):
            if parent >= 0:
                children[parent].append(joint)
        positions = reference_pose(skeleton)[1]
        return cls(skeleton, parents, tuple(tuple(below) for below in children), positions)

    def ancestors(self, joint: int) -> list[int]:
        """Joints above `joint`, nearest first."""
        found = []
        joint = self.parents[joint]
        while joint >= 0:
            found.append(joint)
            joint = self.parents[joint]
        return found

    def is_below(self, joint: int, top: int) -> bool:
        """Whether `joint` hangs somewhere below `top`."""
        return top in self.ancestors(joint)

    def common(self, joints: Iterable[int]) -> int:
        """Lowest joint that all of `joints` hang below; -1 if there is none."""
        chains = [self.ancestors(joint) for joint in joints]
        if not chains:
            return -1
        shared = set(chains[0]).intersection(*chains[1:])
        return next((joint for joint in chains[0] if joint in shared), -1)

    def path(self, top: int, joint: int) -> list[int]:
        """Joints from below `top` down to `joint`, it included; empty if it is not below."""
        chain = [joint, *self.ancestors(joint)]
        return chain[: chain.index(top)][::-1] if top in chain else []

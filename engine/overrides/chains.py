"""Which overrides reach which joint: steps from the top of the tree down."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..animation.skeleton import Skeleton
from .override import JointOverride


class Step(NamedTuple):
    """One override at one joint: the override's number, and which of its joints this is."""

    joint: int
    override: int
    order: int


def find_steps(skeleton: Skeleton, overrides: Sequence[JointOverride]) -> tuple[Step, ...]:
    """All steps, joints from the top of the tree, overrides of a joint in their own order."""
    steps = [
        Step(skeleton.index(name), number, order)
        for number, override in enumerate(overrides)
        for order, name in enumerate(override.joints)
    ]
    # Joints are stored breadth first, so that every joint comes after those above it.
    return tuple(sorted(steps))


def find_chains(skeleton: Skeleton, steps: Sequence[Step]) -> tuple[tuple[int, ...], ...]:
    """For each joint the numbers of the steps at it and above it, in order; J tuples.

    With a step at the neck, one at the head and one at the left shoulder, the head's are 0 and 1,
    the left hand's 2, the right hand's none.
    """
    own: list[list[int]] = [[] for _ in skeleton.names]
    for number, step in enumerate(steps):
        own[step.joint].append(number)
    chains: list[tuple[int, ...]] = []
    for joint, parent in enumerate(skeleton.parents):
        above = chains[parent] if parent >= 0 else ()
        chains.append((*above, *own[joint]))
    return tuple(chains)


def bind_pivots(skeleton: Skeleton, steps: Sequence[Step]) -> NDArray[np.float32]:
    """(steps, 3) float32: where each step's joint is in the bind pose.

    Raises
    ------
    ValueError
        For a joint whose bind matrix has no inverse.
    """
    out = np.zeros((len(steps), 3), np.float32)
    for number, step in enumerate(steps):
        matrix = skeleton.inverse_bind[step.joint].astype(np.float64)
        try:
            out[number] = -np.linalg.solve(matrix[:, :3], matrix[:, 3])
        except np.linalg.LinAlgError:
            name = skeleton.names[step.joint]
            raise ValueError(f"joint '{name}' has a flat bind pose and can't be posed") from None
    return out

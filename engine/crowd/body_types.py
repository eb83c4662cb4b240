"""The body types of a crowd of humanoids: adults as the character is, children, and old people.

Factors after growth charts: at seven years a head has nearly its final size on a body of 1.2 m, and
legs are a smaller share of the height than at twenty; later the spine shortens.
"""

from __future__ import annotations

import numpy as np

from ..animation.body_type import BodyType
from ..animation.skeleton import Skeleton
from .figure import MARKERS, Figure

ADULT, CHILD, OLD = 0, 1, 2

_PROPORTIONS = {
    "child": {"legs": 0.91, "arms": 0.93, "spine": 0.97, "head": 1.24},
    "old": {"legs": 0.985, "arms": 1.02, "spine": 0.94, "head": 1.02},
}


def make_body_types(skeleton: Skeleton, figure: Figure) -> tuple[BodyType, ...]:
    """Children and old people; none if the character's markers are not those of a humanoid."""
    if not is_humanoid(skeleton, figure):
        return ()
    chains = {
        name: _chain(skeleton, int(joint))
        for name, joint in zip(MARKERS, figure.joints, strict=True)
    }
    hips = int(figure.joints[MARKERS.index("hips")])
    types = []
    for name, factor in _PROPORTIONS.items():
        bones = np.ones(skeleton.joint_count, np.float32)
        flesh = np.ones(skeleton.joint_count, np.float32)
        for part, ends in (("legs", ("foot_l", "foot_r")), ("arms", ("hand_l", "hand_r"))):
            for end in ends:
                own = [joint for joint in chains[end] if joint not in chains["head"]]
                # The first joint of a limb is its socket: the bones begin there.
                bones[own[1:]] = factor[part]
                flesh[own] = factor[part]
        spine = [joint for joint in chains["head"] if joint not in chains["foot_l"]]
        bones[spine] = factor["spine"]
        flesh[spine[:-1]] = factor["spine"]
        # The hips' height above the ground is the legs' length.
        bones[_above_hips(skeleton, hips)] = factor["legs"]
        for joint, parent in enumerate(skeleton.parents):  # parents come before children
            named = any(joint in chain for chain in chains.values())
            if parent >= 0 and not named:
                flesh[joint] = flesh[parent]
                bones[joint] = flesh[parent]
        flesh[spine[-1]] = factor["head"]
        below = [j for j in range(skeleton.joint_count) if spine[-1] in _chain(skeleton, j)[:-1]]
        flesh[below] = bones[below] = factor["head"]
        types.append(BodyType(name, bones, flesh))
    return tuple(types)


def leg_factors(types: tuple[BodyType, ...], figure: Figure) -> np.ndarray:
    """(1 + T,) float32 height of the hips of each body type, as a factor."""
    hips = int(figure.joints[MARKERS.index("hips")])
    return np.array([1.0, *(kind.bones[hips] for kind in types)], np.float32)


def is_humanoid(skeleton: Skeleton, figure: Figure) -> bool:
    """Whether hands, feet and head end five different branches of one trunk."""
    ends = [int(j) for name, j in zip(MARKERS, figure.joints, strict=True) if "_" in name]
    ends.append(int(figure.joints[MARKERS.index("head")]))
    if len(set(ends)) < 5:
        return False
    chains = [_chain(skeleton, end) for end in ends]
    apart = all(a not in chain for a in ends for chain in chains if chain[-1] != a)
    hips = int(figure.joints[MARKERS.index("hips")])
    return apart and all(hips in chain[:-1] for chain in chains)


def _chain(skeleton: Skeleton, joint: int) -> list[int]:
    """All joints from the root to this one."""
    chain = [joint]
    while (parent := int(skeleton.parents[chain[0]])) >= 0:
        chain.insert(0, parent)
    return chain


def _above_hips(skeleton: Skeleton, hips: int) -> list[int]:
    return _chain(skeleton, hips)

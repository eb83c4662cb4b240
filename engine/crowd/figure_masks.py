"""Masks that every character with a head and two hands has, found from its joint tree."""

from __future__ import annotations

from ..animation.controllers import Mask
from ..animation.skeleton import Skeleton
from .figure import MARKERS, Figure

WAIST = 0.5
"""Weight of the joint below the shoulders' common one, so that the upper body bends there."""


def figure_masks(skeleton: Skeleton, figure: Figure) -> dict[str, Mask]:
    """Masks ``upper_body``, ``arms``, ``arm_l``, ``arm_r`` and ``head``, as far as they exist.

    Arms and head begin where they leave the common root of the others. Joints that bear the feet
    are in none of them. A character whose markers lie on one chain has no masks.
    """
    joints = dict(zip(MARKERS, (int(joint) for joint in figure.joints), strict=True))
    chains = {name: _chain(skeleton, joint) for name, joint in joints.items()}
    head, left, right = chains["head"], chains["hand_l"], chains["hand_r"]
    bearing = {*chains["foot_l"], *chains["foot_r"]}
    common = [joint for joint in head if joint in left and joint in right]
    roots = {
        "head": _branch(head, common),
        "arm_l": _branch(left, common),
        "arm_r": _branch(right, common),
    }
    masks: dict[str, Mask] = {}
    if not common or None in roots.values() or bearing & {*roots.values()}:
        return masks
    for name, root in roots.items():
        assert root is not None
        masks[name] = Mask({skeleton.names[root]: 1.0})
    arms = [
        skeleton.names[joint] for joint in (roots["arm_l"], roots["arm_r"]) if joint is not None
    ]
    masks["arms"] = Mask(dict.fromkeys(arms, 1.0))
    shoulders = common[0]
    if shoulders not in bearing:
        weights = {skeleton.names[shoulders]: 1.0}
        below = int(skeleton.parents[shoulders])
        if below >= 0 and below not in bearing:
            weights[skeleton.names[below]] = WAIST
        masks["upper_body"] = Mask(weights)
    return masks


def _chain(skeleton: Skeleton, joint: int) -> list[int]:
    """A joint and all above it, upwards."""
    chain = [joint]
    while skeleton.parents[chain[-1]] >= 0:
        chain.append(int(skeleton.parents[chain[-1]]))
    return chain


def _branch(chain: list[int], common: list[int]) -> int | None:
    """The highest joint of a chain that is not common to all."""
    own = [joint for joint in chain if joint not in common]
    return own[-1] if own else None

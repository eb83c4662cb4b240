"""Puts the turns of one body's parts onto another skeleton.

In model space, part by part: the target's anatomical frame becomes the source's, so limbs point the
same way whatever the rest poses are. Only turns are transferred; bones keep their lengths.
"""

from __future__ import annotations

import numpy as np

from .figure import Figure
from .motion import BodyMotion
from .turns import Array, between, transposed


def posed_turns(motion: BodyMotion, target: Figure) -> Array:
    """(F, J, 3, 3) model-space turns of the target's joints.

    A part that only the target has lies to its parent as in the reference pose, and so do joints
    that are no part. Spines and necks of different counts of joints are matched by the share of
    the way along them.
    """
    wanted = _wanted(motion, target)
    skeleton = target.humanoid.skeleton
    frames = len(motion.hips)
    turns = np.empty((frames, skeleton.joint_count, 3, 3))
    part_of = {joint: part for part, joint in target.joints.items()}
    hips = target.joints["hips"]
    above_hips = set()
    joint = hips
    while joint >= 0:
        above_hips.add(joint)
        joint = int(skeleton.parents[joint])
    for joint, parent in enumerate(skeleton.parents.tolist()):
        part = part_of.get(joint)
        if part in wanted and joint not in above_hips - {hips}:
            turns[:, joint] = np.matmul(wanted[part], target.offset(part).T)
        elif parent < 0:
            turns[:, joint] = target.turns[joint]
        else:
            turns[:, joint] = np.matmul(
                turns[:, parent], target.turns[parent].T @ target.turns[joint]
            )
    return turns


def local_turns(target: Figure, turns: Array) -> Array:
    """(F, J, 3, 3) turns in each joint's parent space."""
    local = turns.copy()
    parents = target.humanoid.skeleton.parents
    below = np.flatnonzero(parents >= 0)
    local[:, below] = np.matmul(transposed(turns[:, parents[below]]), turns[:, below])
    return local


def _wanted(motion: BodyMotion, target: Figure) -> dict[str, Array]:
    """Anatomical frames of the target's parts."""
    source = motion.figure.humanoid
    wanted = {part: motion.frames[part] for part in target.joints if part in motion.frames}
    spine = [motion.frames["hips"]]
    spine += [motion.frames[f"spine_{k}"] for k in range(1, len(source.chain("spine")) + 1)]
    neck = [spine[-1]]
    neck += [motion.frames[f"neck_{k}"] for k in range(1, len(source.chain("neck")) + 1)]
    if "head" in motion.frames:
        neck.append(motion.frames["head"])
    spines, necks = len(target.humanoid.chain("spine")), len(target.humanoid.chain("neck"))
    for k in range(1, spines + 1):
        wanted[f"spine_{k}"] = _along(spine, k / spines)
    has_head = "head" in target.joints
    for k in range(1, necks + 1):
        wanted[f"neck_{k}"] = _along(neck, k / (necks + has_head))
    for side in ("left", "right"):
        for mitten, finger in (("fingers", "middle_1"), ("middle_1", "fingers")):
            one, other = f"{side}_{mitten}", f"{side}_{finger}"
            if one in target.joints and one not in wanted and other in motion.frames:
                wanted[one] = motion.frames[other]
    return wanted


def _along(chain: list[Array], share: float) -> Array:
    """Turn at a share of the way along a chain of turns: 0 the first, 1 the last."""
    place = share * (len(chain) - 1)
    before = min(int(place + 1e-9), len(chain) - 1)
    after = min(before + 1, len(chain) - 1)
    fraction = place - before
    return between(chain[before], chain[after], 0.0 if fraction < 1e-6 else fraction)

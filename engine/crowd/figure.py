"""The few joints that stand for a whole body far away.

At a few pixels a spectator is a head, a torso, two arms and two legs. The farthest level of detail
draws just these as strokes between seven joints, so it needs seven points of a pose and no mesh.
Humanoids are recognised by joint names; anything else gets the joints that reach farthest out.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..animation.skeleton import Skeleton
from ..assets.character import Character
from ..assets.variants import one_look
from ..streams.pool import bind_positions

MARKERS = ("head", "chest", "hips", "hand_l", "hand_r", "foot_l", "foot_r")
_NAMES = {
    "head": (r"^head$", r"head$", r"head"),
    "chest": (r"^(upper_?chest|chest|spine_?0?3|spine2|torso)$", r"chest|spine|torso|abdomen"),
    "hips": (r"^(hips?|pelvis)$", r"hips?|pelvis"),
    "hand": (r"^(hand|wrist)$", r"hand(?!slot)|wrist|palm"),
    "foot": (r"^(foot|ankle)$", r"foot|ankle"),
}
_SIDES = {
    "_l": r"(^|[._ -])[lL](?=[._ -]|$)|[Ll]eft|LEFT|(?<=[a-z0-9])L$|^[lL](?=[A-Z][a-z])",
    "_r": r"(^|[._ -])[rR](?=[._ -]|$)|[Rr]ight|RIGHT|(?<=[a-z0-9])R$|^[rR](?=[A-Z][a-z])",
}


@dataclass(frozen=True, slots=True, eq=False)
class Figure:
    """Joints and proportions of a character seen from far away.

    Parameters
    ----------
    joints
        (7,) int64 joints in the order of `MARKERS`.
    height
        Height of the bind pose in metres (model space, before an agent's scale).
    """

    joints: NDArray[np.int64]
    height: float


def make_figure(character: Character) -> Figure:
    """Find a character's markers and height; never fails, see the module's docstring."""
    skeleton = character.skeleton
    bind = bind_positions(skeleton)
    meshes = one_look(character).meshes
    points = np.concatenate([mesh.positions for mesh in meshes])
    height = max(float(np.ptp(points[:, 1])), 1e-6)
    skins = np.zeros(skeleton.joint_count, np.bool_)
    for mesh in meshes:
        skins[mesh.joints[mesh.weights > 0]] = True
    extreme = _extremes(bind, skins)
    found = []
    for marker in MARKERS:
        base = marker.split("_")[0]
        side = next((s for s in _SIDES if marker.endswith(s)), None)
        joint = _by_name(skeleton, base, side)
        found.append(extreme[marker] if joint is None else joint)
    return Figure(np.array(found, np.int64), height)


def _by_name(skeleton: Skeleton, base: str, side: str | None) -> int | None:
    for pattern in _NAMES[base]:
        for joint, name in enumerate(skeleton.names):
            bare = name.rpartition(":")[2]
            if side is not None:
                bare, found = re.subn(_SIDES[side], "", bare)
                if not found:
                    continue
            if re.search(pattern, bare.strip("._ -"), re.IGNORECASE):
                return joint
    return None


def _extremes(bind: NDArray[np.float32], skins: NDArray[np.bool_]) -> dict[str, int]:
    """Joints of any body by where they are: highest, widest, lowest, central."""
    joints = np.flatnonzero(skins) if skins.any() else np.arange(len(bind))
    x, y, _ = bind[joints].T
    middle = bind[joints].mean(axis=0)
    central = joints[np.argsort(np.linalg.norm(bind[joints] - middle, axis=1))]
    low = y - y.min() + 1e-3
    return {
        "head": int(joints[np.argmax(y)]),
        "chest": int(central[min(1, len(central) - 1)]),
        "hips": int(central[0]),
        "hand_l": int(joints[np.argmax(x)]),
        "hand_r": int(joints[np.argmin(x)]),
        "foot_l": int(joints[np.argmax((x - x.mean()) / low)]),
        "foot_r": int(joints[np.argmin((x - x.mean()) / low)]),
    }

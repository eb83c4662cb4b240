"""Masks of one crowd: which joints an overlay moves, and from where it is hung up again.

A masked subtree that follows another motion must stay attached to the body. So each of its joints
is *re-rooted* at its anchor p, the nearest joint above that the mask leaves alone: with palettes B
of the body and O of the overlay, ``P'_j = B_p O_p^-1 O_j``. Palettes suffice, since both share the
bind pose. Where everything up to the root is masked there is no anchor, and ``P'_j = O_j``.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ..animation.controllers import Mask
from ..animation.skeleton import Skeleton

MAX_MASKS = 256


class MaskTable:
    """Named masks over the joints of one skeleton.

    Parameters
    ----------
    skeleton
        Whose joints they weigh.

    Attributes
    ----------
    names
        M names, in the order in which they came.
    weights
        (M, J) float32, 0 to 1.
    anchors
        (M, J) int32 the joint that a masked joint is re-rooted at, -1 where there is none.
    """

    __slots__ = ("anchors", "names", "skeleton", "weights")

    def __init__(self, skeleton: Skeleton) -> None:
        self.skeleton = skeleton
        self.names: tuple[str, ...] = ()
        self.weights = np.zeros((0, skeleton.joint_count), np.float32)
        self.anchors = np.zeros((0, skeleton.joint_count), np.int32)

    def add(self, name: str, mask: Mask | Mapping[str, float]) -> int:
        """Add a mask and return its number.

        Raises
        ------
        ValueError
            For a joint that the skeleton doesn't have, weights outside 0 to 1, a mask without any
            weight, a name that is taken, or more than 256 masks.
        """
        if name in self.names:
            raise ValueError(f"there is a mask '{name}' already")
        if len(self.names) == MAX_MASKS:
            raise ValueError(f"there are {MAX_MASKS} masks already, which is the most")
        made = mask if isinstance(mask, Mask) else Mask(mask)
        try:
            weights = made.of(self.skeleton)
        except ValueError as error:
            raise ValueError(f"mask '{name}': {error}") from error
        if not weights.any():
            raise ValueError(f"mask '{name}' gives no joint a weight above 0")
        anchors = np.full(len(weights), -1, np.int32)
        for joint, parent in enumerate(self.skeleton.parents):  # parents come before children
            if parent >= 0:
                anchors[joint] = parent if weights[parent] == 0 else anchors[parent]
        self.weights = np.concatenate([self.weights, weights[None]])
        self.anchors = np.concatenate([self.anchors, anchors[None]])
        self.names = (*self.names, name)
        return len(self.names) - 1

    def index(self, name: str) -> int:
        """Number of a mask; ValueError names the known ones if there is none of the name."""
        if name not in self.names:
            known = ", ".join(self.names) or "none"
            raise ValueError(f"there is no mask '{name}'; known: {known}")
        return self.names.index(name)


def lay_over(
    body: NDArray[np.float32],
    overlay: NDArray[np.float32],
    weights: NDArray[np.float32],
    anchors: NDArray[np.int32],
) -> NDArray[np.float32]:
    """Palettes of bodies some of whose joints follow another motion.

    Parameters
    ----------
    body, overlay
        (K, J, 3, 4) float32 palettes B and O.
    weights
        (K, J) float32 how much of each joint follows the overlay.
    anchors
        (K, J) int32 joints that they are re-rooted at, or -1.

    Returns
    -------
    (K, J, 3, 4) float32
    """
    out = body.copy()
    agent, joint = np.nonzero(weights)
    anchor = anchors[agent, joint]
    laid = overlay[agent, joint].astype(np.float64)
    hung = np.flatnonzero(anchor >= 0)
    at = (agent[hung], anchor[hung])
    laid[hung] = _after(body[at].astype(np.float64), _undone(overlay[at], laid[hung]))
    share = weights[agent, joint][:, None, None]
    out[agent, joint] += (share * (laid - out[agent, joint])).astype(np.float32)
    return out


def _after(second: NDArray[np.float64], first: NDArray[np.float64]) -> NDArray[np.float64]:
    """Affine ``second first``, (n, 3, 4) each."""
    out = second[..., :3] @ first
    out[..., 3] += second[..., 3]
    return out


def _undone(motion: NDArray[np.float32], first: NDArray[np.float64]) -> NDArray[np.float64]:
    """Affine ``motion^-1 first``, (n, 3, 4) each."""
    moved = first.copy()
    moved[..., 3] -= motion[..., 3]
    undone = np.linalg.solve(motion[..., :3].astype(np.float64), moved)
    return undone.astype(np.float64, copy=False)

"""Where on a character trousers end and the head begins: its parts by height.

*Algorithms* 3 binds every vertex to one of three sets of textures by its height: below the waist
trousers, up to the neck the upper body, above it the head. The height is that of the bind pose,
before bodies are made larger, wider or otherwise different, so that borders stay where they are on
everybody. Characters whose materials say what they are (`skin`, `shirt`, ...) need no such guess.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..animation.skeleton import Skeleton
from ..assets.character import Character, SkinnedMesh
from ..streams.pool import bind_positions
from .figure import MARKERS, Figure

SURFACES = ("skin", "hair", "shirt", "trousers", "shoes")
"""Materials of these names take the agent's colour; the order is that of the looks table."""

TROUSERS, UPPER_BODY, HEAD = 0, 1, 2

_NECK, _NECK_RANGE = 0.86, (0.3, 0.95)
"""A grown human's share of the height below the neck, and what is believed."""
_WAIST, _WAIST_RANGE = 0.63, (0.2, 0.85)
"""The same for the waist, as a share of the height of the neck."""


@dataclass(frozen=True, slots=True, eq=False)
class Regions:
    """The parts of one character, and the frame that patterns of its shirt lie in.

    Parameters
    ----------
    waist, neck
        Heights in the bind pose, model space.
    across
        (2,) float32 unit vector (x, z): from the trunk's middle to the wearer's left.
    middle
        Where the trunk's middle is on it.
    parted
        Whether materials are divided by height, because none has a name of its own meaning.
    held
        (J,) bool joints of what is held in a hand, which keeps its colours.
    tint
        How much of the agents' colours such materials take on, 0 to 1.
    """

    waist: float
    neck: float
    across: NDArray[np.float32]
    middle: float
    parted: bool
    held: NDArray[np.bool_]
    tint: float = 1.0

    @property
    def trunk(self) -> float:
        """From the waist to the neck."""
        return self.neck - self.waist

    def on_trunk(self, positions: NDArray[np.float32]) -> NDArray[np.float64]:
        """(V, 2) where positions (V, 3) of the bind pose are in the frame of patterns.

        In heights of the trunk: from its middle to the wearer's left, and from the waist.
        """
        across = positions[:, [0, 2]].astype(np.float64) @ self.across - self.middle
        return np.stack([across, positions[:, 1] - self.waist], axis=1) / self.trunk

    def part_of(self, heights: NDArray[np.float32]) -> NDArray[np.uint8]:
        """(V,) `TROUSERS`, `UPPER_BODY` or `HEAD` of heights (V,) in the bind pose."""
        return ((heights >= self.waist).astype(np.uint8)) + (heights >= self.neck)

    def keeps_colours(self, mesh: SkinnedMesh) -> bool:
        """Whether a mesh is a thing in a hand: it moves with one joint that such things have."""
        moving = np.unique(mesh.joints[mesh.weights > 0.0])
        return len(moving) == 1 and bool(self.held[moving[0]])


def find_regions(character: Character, figure: Figure, *, tint: float = 1.0) -> Regions:
    """Find a character's parts; never fails.

    The waist is at the hips' joint and the neck at the head's, if these are at heights that a body
    could have. Otherwise the neck is where the skin begins that the head moves, or as high as on a
    grown human, and the waist as high below it.

    Parameters
    ----------
    character, figure
        Whose, and its markers.
    tint
        See `Regions`.
    """
    skeleton = character.skeleton
    points = np.concatenate([mesh.positions for mesh in character.meshes])
    low, high = float(points[:, 1].min()), float(points[:, 1].max())
    bind = bind_positions(skeleton)
    marked = dict(zip(MARKERS, (int(joint) for joint in figure.joints), strict=True))
    neck = _first_within(
        low + _NECK_RANGE[0] * (high - low),
        low + _NECK_RANGE[1] * (high - low),
        (float(bind[marked["head"], 1]), _under_head(character, marked["head"])),
        low + _NECK * (high - low),
    )
    waist = _first_within(
        low + _WAIST_RANGE[0] * (neck - low),
        low + _WAIST_RANGE[1] * (neck - low),
        (float(bind[marked["hips"], 1]),),
        low + _WAIST * (neck - low),
    )
    between = (points[:, 1] >= waist) & (points[:, 1] < neck)
    trunk = points[between] if between.any() else points
    wide = np.ptp(trunk[:, [0, 2]], axis=0)
    # Characters face +Z, so +X is their left; some are bound facing +X, and -Z is their left.
    across = np.array([1.0, 0.0] if wide[0] >= wide[1] else [0.0, -1.0], np.float32)
    ends = np.quantile(trunk[:, [0, 2]] @ across, [0.0, 1.0])
    return Regions(
        waist=waist,
        neck=neck,
        across=across,
        middle=float(ends.mean()),
        parted=not any(material.name in SURFACES for material in character.materials),
        held=_below(skeleton, [marked["hand_l"], marked["hand_r"]]),
        tint=tint,
    )


def _first_within(least: float, most: float, heights: tuple[float, ...], otherwise: float) -> float:
    return next((height for height in heights if least <= height <= most), otherwise)


def _under_head(character: Character, head: int) -> float:
    """Where the skin that the head moves begins; NaN if it moves none."""
    joints = _below(character.skeleton, [head])
    joints[head] = True
    heights = []
    for mesh in character.meshes:
        mover = np.take_along_axis(mesh.joints, mesh.weights.argmax(axis=1)[:, None], axis=1)
        heights.append(mesh.positions[joints[mover[:, 0]], 1])
    found = np.concatenate(heights)
    return float(np.quantile(found, 0.05)) if len(found) else float("nan")


def _below(skeleton: Skeleton, joints: Sequence[int]) -> NDArray[np.bool_]:
    """(J,) joints that hang on some of these, without these themselves."""
    found = np.zeros(skeleton.joint_count, np.bool_)
    for joint, parent in enumerate(skeleton.parents):  # parents come before children
        found[joint] = parent >= 0 and (parent in joints or found[parent])
    return found

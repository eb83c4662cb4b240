"""Makes a skeleton and a clip of a BVH file, in metres and at uniform keys.

Conventions. A joint's rotation is the product of its rotation channels in the order in which the
file lists them, so ``Zrotation Xrotation Yrotation`` is ``Rz Rx Ry`` for column vectors. A
position channel *replaces* that component of the joint's OFFSET, at the root and elsewhere, as in
MotionBuilder and Blender; the other convention in use adds it to the OFFSET, which is the same
where a root's OFFSET is zero; a note is given where a file seems to mean it. Axes are taken as
they stand: +Y up, facing +Z.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..animation.clip import MIN_KEY_RATE, Clip, continuous_hemisphere
from ..animation.skeleton import Skeleton, breadth_first_order
from ..errors import AssetError
from .bvh_cleaning import (
    glitch_notes,
    guess_scale,
    leading_glitch,
    loops,
    rest_notes,
    rest_positions,
)
from .bvh_document import BvhDocument, parse_bvh
from .bvh_hierarchy import EndSite
from .rotations import from_euler, slerp

MAX_JOINT_KEYS = 2**24
"""Keys times joints that are loaded: 39 minutes of 60 joints at 120 Hz."""

RATE_TOLERANCE = 0.002
"""Frame times are rounded (0.016667) and video runs at 59.94 Hz: both count as 60."""


@dataclass(frozen=True, slots=True, eq=False)
class BvhMotion:
    """What a BVH file holds: a skeleton without a mesh and one clip.

    Parameters
    ----------
    skeleton
        Breadth first, in metres; rest and bind pose are the OFFSETs with no rotation.
    clip
        Named after the file.
    end_sites
        Tips of the last bones, in metres, by joint of `skeleton`.
    scale
        Metres a file unit.
    notes
        The guessed unit and what was dropped or looks damaged, one sentence each.
    """

    skeleton: Skeleton
    clip: Clip
    end_sites: tuple[EndSite, ...]
    scale: float
    notes: tuple[str, ...]


def load_bvh(path: str | Path, scale: float | None = None) -> BvhMotion:
    """Read a BVH file as a skeleton and a clip.

    Files of 60 frames a second or more keep their own frames. Slower ones get whole steps between
    their frames (30 becomes 60, 24 becomes 72 a second), rotations on the shortest arc and
    positions on the line, so that every frame of the file is a key.

    Parameters
    ----------
    path
        The file.
    scale
        Metres a file unit; by default guessed from the height of the skeleton (`guess_scale`).

    Raises
    ------
    AssetError
        If the file can't be read or is damaged.
    ValueError
        If `scale` is not between a millionth and a million.
    """
    if scale is not None and not 1e-6 <= scale <= 1e6:
        raise ValueError(f"scale is {scale}, expected metres a file unit from 1e-6 to 1e6")
    document = parse_bvh(path)
    step = _intermediate_steps(document.frame_time)
    joint_keys = len(document.values) * step * len(document.names)
    if joint_keys > MAX_JOINT_KEYS:
        raise AssetError(
            path,
            "",
            f"{len(document.values) * step} keys of {len(document.names)} joints are more than "
            f"the {MAX_JOINT_KEYS} joint keys that can be loaded; cut the file",
        )
    notes = list(document.notes)
    if scale is None:
        scale, note = guess_scale(document)
        notes.append(note)
    notes += rest_notes(document)
    rotation, translation = local_transforms(document)
    translation *= scale
    roots = [joint for joint, parent in enumerate(document.parents) if parent < 0]
    first = leading_glitch(rotation, translation[:, roots], document.frame_time)
    notes += glitch_notes(rotation, translation[:, roots], document.frame_time, first)
    rotation, translation = rotation[first:], translation[first:]
    looping = loops(rotation, translation[:, roots])
    duration = (len(rotation) - 1) * document.frame_time
    rotation = continuous_hemisphere(rotation)
    if step > 1 and len(rotation) > 1:
        rotation, translation = _upsample(rotation, translation, step)

    order = breadth_first_order(document.parents)
    clip = Clip(
        name=Path(path).stem,
        duration=duration,
        rotation=rotation[:, order].astype(np.float32),
        translation=translation[:, order].astype(np.float32),
        scale=np.ones((*rotation.shape[:2], 3), dtype=np.float32),
        looping=looping,
    )
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    ends = tuple(
        EndSite(int(place[end.joint]), (x * scale, y * scale, z * scale))
        for end in document.end_sites
        for x, y, z in (end.offset,)
    )
    return BvhMotion(_skeleton(document, order, place, scale), clip, ends, scale, tuple(notes))


def local_transforms(
    document: BvhDocument,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Local rotations and translations of every row of a file.

    Returns
    -------
    rotation
        (F, J, 4) float64 xyzw in the file's joint order.
    translation
        (F, J, 3) float64 in the file's unit.
    """
    frames = len(document.values)
    joints = len(document.names)
    rotation = np.zeros((frames, joints, 4))
    rotation[..., 3] = 1.0
    translation = np.tile(document.offsets, (frames, 1, 1))
    # Joints that share a rotation order are turned together: a file has few orders, many joints.
    turning: dict[tuple[int, ...], list[tuple[int, list[int]]]] = defaultdict(list)
    column = 0
    for joint, names in enumerate(document.channels):
        axes: list[int] = []
        columns: list[int] = []
        for name in names:
            axis = "xyz".index(name[0])
            if name.endswith("position"):
                translation[:, joint, axis] = document.values[:, column]
            else:
                axes.append(axis)
                columns.append(column)
            column += 1
        if axes:
            turning[tuple(axes)].append((joint, columns))
    for order, members in turning.items():
        angles = np.radians(document.values[:, [columns for _, columns in members]])
        rotation[:, [joint for joint, _ in members]] = from_euler(order, angles)
    return rotation, translation


def _intermediate_steps(frame_time: float) -> int:
    """Keys a frame that reach the least key rate: 1 at 120 or 60 Hz, 2 at 30 Hz, 3 at 24 Hz."""
    return max(int(np.ceil(MIN_KEY_RATE * frame_time * (1.0 - RATE_TOLERANCE))), 1)


def _upsample(
    rotation: NDArray[np.float64], translation: NDArray[np.float64], step: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Put `step` - 1 keys between neighbouring frames; the frames themselves stay as they are."""
    keys = (len(rotation) - 1) * step + 1
    turned = np.empty((keys, *rotation.shape[1:]))
    moved = np.empty((keys, *translation.shape[1:]))
    turned[::step] = rotation
    moved[::step] = translation
    for part in range(1, step):
        fraction = part / step
        turned[part::step] = slerp(rotation[:-1], rotation[1:], fraction)
        moved[part::step] = translation[:-1] * (1.0 - fraction) + translation[1:] * fraction
    return turned, moved


def _skeleton(
    document: BvhDocument, order: NDArray[np.int32], place: NDArray[np.int32], scale: float
) -> Skeleton:
    """The joints in breadth-first order; the bind pose is the rest pose."""
    count = len(order)
    parents = np.array(document.parents, dtype=np.int32)[order]
    inverse_bind = np.zeros((count, 3, 4), dtype=np.float32)
    inverse_bind[:, :, :3] = np.eye(3)
    inverse_bind[:, :, 3] = -scale * rest_positions(document)[order]
    return Skeleton(
        names=tuple(document.names[joint] for joint in order),
        parents=np.where(parents < 0, -1, place[parents]).astype(np.int32),
        rest_rotation=np.tile(np.array([0, 0, 0, 1], dtype=np.float32), (count, 1)),
        rest_translation=(scale * document.offsets[order]).astype(np.float32),
        rest_scale=np.ones((count, 3), dtype=np.float32),
        inverse_bind=inverse_bind,
    )

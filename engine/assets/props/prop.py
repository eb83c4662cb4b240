"""What a prop is, and what the makers of props share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ...animation.clip import Clip
from ...animation.skeleton import Skeleton
from ..character import Character, Material, SkinnedMesh
from ..gltf_mesh import vertex_normals
from ..rotations import from_euler

Array = NDArray[np.float64]
Faces = NDArray[np.int64]

KEY_RATE = 60
"""Keys a second of the clips."""
WHITE = Material("white", (0.82, 0.82, 0.80, 1.0), double_sided=True)
TEAM = Material("shirt", double_sided=True)
"""Takes the agent's colour, which for a prop is usually that of its side."""


@dataclass(frozen=True, slots=True, eq=False)
class Prop:
    """A character, and where it hangs on the built-in spectator.

    Parameters
    ----------
    character
        Meshes, skeleton and clips.
    hook
        Joint of the spectator; None if the prop is skinned with several.
    transform
        (4, 4) from the prop's model space to that joint's frame; None without a hook.
    motion
        Whose poses it shows, as `tifo.add_part` takes it.
    """

    character: Character
    hook: str | None
    transform: Array | None
    motion: Literal["own", "body"] = "own"


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """Triangles of one material.

    Parameters
    ----------
    points
        (V, 3) metres.
    faces
        (T, 3), counter-clockwise seen from outside.
    weights
        (V, J) that sum to 1, at most four of a row not 0.
    material
        Index.
    """

    points: Array
    faces: Faces
    weights: Array
    material: int


def joint_tree(names: Sequence[str], parents: Sequence[int], places: Array) -> Skeleton:
    """Joints at (J, 3) places, their frames parallel to the prop's; rest and bind pose agree."""
    count = len(names)
    local = places.copy()
    for joint, parent in enumerate(parents):
        if parent >= 0:
            local[joint] -= places[parent]
    inverse_bind = np.tile(np.eye(3, 4), (count, 1, 1))
    inverse_bind[:, :, 3] = -places
    return Skeleton(
        names=tuple(names),
        parents=np.array(parents, np.int32),
        rest_rotation=np.tile(np.array([0, 0, 0, 1], np.float32), (count, 1)),
        rest_translation=local.astype(np.float32),
        rest_scale=np.ones((count, 3), np.float32),
        inverse_bind=inverse_bind.astype(np.float32),
    )


def turning_clip(name: str, duration: float, skeleton: Skeleton, angles: Array) -> Clip:
    """A loop in which joints only turn.

    Parameters
    ----------
    name, duration, skeleton
        Of the clip; seconds.
    angles
        (F, J, 3) radians about X, then Z, then Y of the turning joint, the last key equal to the
        first.
    """
    frames, joints = angles.shape[:2]
    rotation = from_euler((0, 2, 1), angles)
    return Clip(
        name,
        duration,
        rotation.astype(np.float32),
        np.tile(skeleton.rest_translation, (frames, 1, 1)),
        np.ones((frames, joints, 3), np.float32),
    )


def loop_times(duration: float) -> Array:
    """(F,) times of the keys of a loop as shares of it, 0 to 1."""
    return np.linspace(0.0, 1.0, round(duration * KEY_RATE) + 1)


def make_meshes(surfaces: Sequence[Surface], level: int) -> tuple[SkinnedMesh, ...]:
    """Meshes of one level of detail."""
    meshes = []
    for number, surface in enumerate(surfaces):
        count = len(surface.points)
        joints = np.argsort(-surface.weights, axis=1, kind="stable")[:, :4]
        weights = np.take_along_axis(surface.weights, joints, axis=1)
        padded = np.zeros((2, count, 4))
        padded[0, :, : joints.shape[1]] = np.where(weights > 0, joints, 0)
        padded[1, :, : joints.shape[1]] = weights / weights.sum(axis=1, keepdims=True)
        meshes.append(
            SkinnedMesh(
                name=f"surface {number}" + (f"_LOD{level}" if level else ""),
                positions=surface.points.astype(np.float32),
                normals=vertex_normals(surface.points, surface.faces).astype(np.float32),
                uvs=np.zeros((count, 2), np.float32),
                colors=np.ones((count, 4), np.float32),
                joints=padded[0].astype(np.uint16),
                weights=padded[1].astype(np.float32),
                triangles=surface.faces.astype(np.uint32),
                material=surface.material,
            )
        )
    return tuple(meshes)


def grid_faces(rows: int, columns: int, *, closed: bool = False) -> Faces:
    """Two triangles for each cell of (rows, columns) points; `closed` joins the last column."""
    index = np.arange(rows * columns).reshape(rows, columns)
    if closed:
        index = np.concatenate([index, index[:, :1]], axis=1)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    return np.concatenate(
        [np.stack([a, b, c], axis=-1).reshape(-1, 3), np.stack([a, c, d], axis=-1).reshape(-1, 3)]
    )


def smooth_curve(knots: Array, count: int) -> Array:
    """`count` points (count, D) of the Catmull-Rom curve through (K, D) knots, ends included."""
    ends = np.concatenate([2 * knots[:1] - knots[1:2], knots, 2 * knots[-1:] - knots[-2:-1]])
    position = np.linspace(0.0, len(knots) - 1.0, count)
    first = np.minimum(position.astype(int), len(knots) - 2)
    t = (position - first)[:, None]
    a, b, c, d = (ends[first + k] for k in range(4))
    points: Array = 0.5 * (
        2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * b - a - 3 * c + d) * t**3
    )
    return points


def rigid(points: Array, joint: int, joints: int) -> Array:
    """(V, J) weights of points that one joint moves."""
    weights = np.zeros((len(points), joints))
    weights[:, joint] = 1.0
    return weights

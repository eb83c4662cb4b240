"""A visible body for a skeleton that has none: a bone for every joint pair, a ball for every joint.

Motion files such as BVH hold no mesh. With this figure they can be watched, in a viewer or as a
crowd, before they are put on a real body.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..animation.clip import Clip
from ..animation.skeleton import Skeleton
from .bvh_hierarchy import EndSite
from .character import Character, Material, SkinnedMesh

BONE_COLOR = (0.72, 0.66, 0.52, 1.0)
BALL_COLOR = (0.80, 0.18, 0.05, 1.0)
"""Linear RGBA: ivory bones, orange joints."""

BONE_THICKNESS = 0.1
"""Radius of a bone at its thick end, in its lengths."""

_BONE_PROFILE = ((0.0, 0.0), (0.6, 0.03), (1.0, 0.14), (0.5, 0.94), (0.0, 1.0))
"""Radius and height of a bone of length 1 from joint to tip, thick near the joint that turns it."""

Array = NDArray[np.float64]


def bone_figure(
    skeleton: Skeleton,
    name: str,
    clips: Sequence[Clip] = (),
    end_sites: Sequence[EndSite] = (),
    notes: Sequence[str] = (),
) -> Character:
    """A stick figure that is rigidly bound to a skeleton.

    A tapered bone runs from every joint to each of its children and end sites and turns with that
    joint; a ball sits at every joint. Thickness follows the bones' lengths, so the figure fits a
    skeleton of any size.

    Parameters
    ----------
    skeleton
        The joints; the figure is laid out along the rest offsets, in the bind pose.
    name
        Of the character.
    clips
        Motions of `skeleton`.
    end_sites
        Tips of bones that end in no joint, metres.
    notes
        Handed to the character.

    Returns
    -------
    Character
        One mesh of one material, coloured by vertex.

    Raises
    ------
    ValueError
        If an end site or a clip does not belong to `skeleton`, or a joint's inverse bind matrix
        can't be inverted.
    """
    count = skeleton.joint_count
    for end in end_sites:
        if not 0 <= end.joint < count:
            raise ValueError(f"end_sites: joint {end.joint} of a skeleton of {count} joints")
    for clip in clips:
        if clip.joint_count != count:
            raise ValueError(
                f"clips: '{clip.name}' has {clip.joint_count} joints, expected {count}"
            )
    owners, tips, radii, balls = _layout(skeleton, end_sites)
    bone, bone_faces = _bone_shape()
    ball, ball_faces = _ball_shape()
    lengths = np.linalg.norm(tips, axis=1)
    # (bones, vertices, 3) in the space of the joint that turns the bone.
    bones = np.einsum(
        "nij,nvj->nvi",
        _frames(tips),
        bone[None] * np.stack([radii, radii, lengths], axis=-1)[:, None],
    ).reshape(-1, 3)
    spheres = (ball[None] * balls[:, None, None]).reshape(-1, 3)
    joints = np.concatenate([np.repeat(owners, len(bone)), np.repeat(np.arange(count), len(ball))])
    triangles = np.concatenate(
        [
            _repeat_faces(bone_faces, len(owners), len(bone)),
            _repeat_faces(ball_faces, count, len(ball)) + len(bones),
        ]
    )
    positions = _to_bind_pose(skeleton, joints, np.concatenate([bones, spheres]))
    vertices = len(positions)
    weights = np.zeros((vertices, 4), dtype=np.float32)
    weights[:, 0] = 1.0
    indices = np.zeros((vertices, 4), dtype=np.uint16)
    indices[:, 0] = joints
    colors = np.empty((vertices, 4), dtype=np.float32)
    colors[: len(bones)] = BONE_COLOR
    colors[len(bones) :] = BALL_COLOR
    mesh = SkinnedMesh(
        name="bones",
        positions=positions.astype(np.float32),
        normals=_normals(positions, triangles).astype(np.float32),
        uvs=np.zeros((vertices, 2), dtype=np.float32),
        colors=colors,
        joints=indices,
        weights=weights,
        triangles=triangles.astype(np.uint32),
    )
    return Character(
        name=name,
        skeleton=skeleton,
        meshes=(mesh,),
        materials=(Material(name="bones"),),
        clips=tuple(clips),
        notes=tuple(notes),
    )


def _layout(
    skeleton: Skeleton, end_sites: Sequence[EndSite]
) -> tuple[NDArray[np.int64], Array, Array, Array]:
    """Joint, tip in that joint's space and radius of N bones; radius of the ball of J joints."""
    children = np.flatnonzero(skeleton.parents >= 0)
    owners = np.concatenate([skeleton.parents[children], [end.joint for end in end_sites]])
    owners = owners.astype(np.int64)
    offsets = np.reshape([end.offset for end in end_sites], (-1, 3))
    tips = np.concatenate([skeleton.rest_translation[children].astype(np.float64), offsets])
    lengths = np.linalg.norm(tips, axis=1)
    real = lengths > 1e-6 * float(lengths.max(initial=0.0))
    children, owners, tips = children[real[: len(children)]], owners[real], tips[real]
    lengths = lengths[real]
    # A pole from the floor to the hips must not become a trunk, nor a fingertip vanish.
    usual = float(np.percentile(lengths, 90)) if len(lengths) else 0.5
    radii = BONE_THICKNESS * np.clip(lengths, 0.1 * usual, usual)
    balls = np.full(skeleton.joint_count, 0.02 * usual)
    np.maximum.at(balls, owners, 0.75 * radii)
    np.maximum.at(balls, children, 0.75 * radii[: len(children)])
    return owners, tips, radii, balls


def _bone_shape() -> tuple[Array, NDArray[np.int64]]:
    """Vertices and faces of a bone of length 1 and radius 1 along +Z."""
    from trimesh.creation import revolve

    mesh = revolve(np.array(_BONE_PROFILE), sections=8)
    return np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces, dtype=np.int64)


def _ball_shape() -> tuple[Array, NDArray[np.int64]]:
    """Vertices and faces of a ball of radius 1."""
    from trimesh.creation import icosphere

    mesh = icosphere(subdivisions=1)
    return np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces, dtype=np.int64)


def _frames(tips: Array) -> Array:
    """(N, 3, 3) rotations whose third column points to the (N, 3) tips."""
    along = tips / np.linalg.norm(tips, axis=1, keepdims=True)
    # The axis that a direction leans on least is never parallel to it.
    helper = np.eye(3)[np.argmin(np.abs(along), axis=1)]
    side = np.cross(helper, along)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    return np.stack([side, np.cross(along, side), along], axis=-1)


def _repeat_faces(faces: NDArray[np.int64], copies: int, vertices: int) -> NDArray[np.int64]:
    """(copies * T, 3) indices of (T, 3) faces of a shape of `vertices` that is laid down often."""
    start = vertices * np.arange(copies, dtype=np.int64)
    return (faces[None] + start[:, None, None]).reshape(-1, 3)


def _to_bind_pose(skeleton: Skeleton, joints: NDArray[np.int64], local: Array) -> Array:
    """Model-space positions of the bind pose, from (V, 3) points in the spaces of (V,) joints."""
    inverse = skeleton.inverse_bind.astype(np.float64)
    turned = np.linalg.inv(inverse[:, :, :3])
    return np.asarray(np.einsum("vij,vj->vi", turned[joints], local - inverse[joints, :, 3]))


def _normals(positions: Array, triangles: NDArray[np.int64]) -> Array:
    """(V, 3) unit normals, the area-weighted mean of the triangles around a vertex."""
    a, b, c = (positions[triangles[:, corner]] for corner in range(3))
    faces = np.cross(b - a, c - a)
    normals = np.zeros_like(positions)
    for corner in range(3):
        np.add.at(normals, triangles[:, corner], faces)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.where(lengths > 0, normals / np.where(lengths > 0, lengths, 1.0), [0.0, 1.0, 0.0])

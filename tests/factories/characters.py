"""Small characters, clips and oracles that tests of several folders build on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from tifo.engine.animation import Clip, Skeleton
from tifo.engine.assets.character import Character, Material, SkinnedMesh

Array = NDArray[Any]

JOINTS = ("hips", "chest", "foot_l", "foot_r", "head", "hand_l", "hand_r")
PARENTS = (-1, 0, 0, 0, 1, 1, 1)
OFFSETS = (
    (0.0, 0.9, 0.0),
    (0.0, 0.4, 0.0),
    (0.1, -0.8, 0.05),
    (-0.1, -0.8, 0.05),
    (0.0, 0.3, 0.0),
    (0.6, 0.1, 0.0),
    (-0.6, 0.1, 0.0),
)
CLIPS = (
    *("walk", "sit_idle", "sit_idle_2", "stand_idle", "clap", "cheer", "cheer_2", "dismay"),
    "wave",
)
"""The first is for nothing that spectators do, so motions and clips are numbered differently."""


def reference_models(parents: Sequence[int], q: Array, t: Array, s: Array) -> Array:
    """(J, 4, 4) float64 model matrices of one pose, joint by joint."""
    models = np.empty((len(parents), 4, 4))
    for joint, parent in enumerate(parents):
        local = np.eye(4)
        turn = Rotation.from_quat(np.asarray(q[joint], float)).as_matrix()
        local[:3, :3] = turn @ np.diag(np.asarray(s[joint], float))
        local[:3, 3] = t[joint]
        models[joint] = local if parent < 0 else models[parent] @ local
    return models


def reference_palettes(skeleton: Skeleton, q: Array, t: Array, s: Array) -> Array:
    """(J, 3, 4) float64 palettes of one pose, joint by joint."""
    models = reference_models([int(p) for p in skeleton.parents], q, t, s)
    inverse = np.zeros_like(models)
    inverse[:, :3] = skeleton.inverse_bind
    inverse[:, 3, 3] = 1.0
    return np.array([(m @ i)[:3] for m, i in zip(models, inverse, strict=True)])


def make_skeleton(
    parents: Sequence[int],
    translation: Array,
    rotation: Array | None = None,
    scale: Array | None = None,
    names: Sequence[str] | None = None,
) -> Skeleton:
    """A skeleton whose bind pose is its rest pose."""
    count = len(parents)
    q = np.tile([0.0, 0.0, 0.0, 1.0], (count, 1)) if rotation is None else rotation
    s = np.ones((count, 3)) if scale is None else scale
    bind = reference_models(parents, q, translation, s)
    return Skeleton(
        names=tuple(names) if names else tuple(f"joint {k}" for k in range(count)),
        parents=np.array(parents, np.int32),
        rest_rotation=np.asarray(q, np.float32),
        rest_translation=np.asarray(translation, np.float32),
        rest_scale=np.asarray(s, np.float32),
        inverse_bind=np.linalg.inv(bind)[:, :3].astype(np.float32),
    )


def make_body(names: Sequence[str] = JOINTS) -> Skeleton:
    """Seven joints of a person 1.75 m tall: hips, chest, feet, head and hands."""
    return make_skeleton(PARENTS, np.array(OFFSETS), names=names)


def make_clip(
    skeleton: Skeleton, name: str, duration: float, *, looping: bool = True, reach: float = 1.0
) -> Clip:
    """Every joint turns about X in a sine of its own, the root bobs; ends where it begins."""
    count = skeleton.joint_count
    phase = np.linspace(0.0, 2.0 * np.pi, max(round(duration * 60), 1) + 1)
    joint = np.arange(count)
    angle = reach * np.sin(phase[:, None] + joint) * (1 + joint % 3) / 3
    rotation = np.zeros((len(phase), count, 4))
    rotation[..., 0], rotation[..., 3] = np.sin(angle / 2), np.cos(angle / 2)
    translation = np.tile(skeleton.rest_translation, (len(phase), 1, 1)).astype(float)
    translation[:, 0, 1] += 0.1 * reach * np.sin(phase)
    return Clip(
        name,
        duration,
        rotation.astype(np.float32),
        translation.astype(np.float32),
        np.ones((len(phase), count, 3), np.float32),
        looping,
    )


def make_still(skeleton: Skeleton, name: str, *, looping: bool = True) -> Clip:
    """One key: the rest pose."""
    return Clip(
        name,
        0.0,
        skeleton.rest_rotation[None],
        skeleton.rest_translation[None],
        skeleton.rest_scale[None],
        looping,
    )


def make_slide(seconds: float = 100.0, base: float = 0.0) -> tuple[Skeleton, Clip]:
    """One joint whose X is `base` plus 30 times the clip's time: one a pose tick at speed 1."""
    skeleton = make_skeleton([-1], np.zeros((1, 3)))
    translation = np.zeros((2, 1, 3), np.float32)
    translation[:, 0, 0] = base, base + 30.0 * seconds
    rotation = np.tile(np.array([0, 0, 0, 1], np.float32), (2, 1, 1))
    ones = np.ones((2, 1, 3), np.float32)
    return skeleton, Clip(f"slide {base:g}", seconds, rotation, translation, ones, looping=False)


def make_box(skeleton: Skeleton, low: Array, high: Array, joint: int = 0) -> SkinnedMesh:
    """The eight corners of a box, moved by one joint."""
    corner = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)])
    positions = np.where(corner, high, low).astype(np.float32)
    normals = (2.0 * corner - 1.0) / np.sqrt(3.0)
    faces = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
    joints = np.zeros((8, 4), np.uint16)
    joints[:, 0] = joint
    return SkinnedMesh(
        name="box",
        positions=positions,
        normals=normals.astype(np.float32),
        uvs=np.zeros((8, 2), np.float32),
        colors=np.ones((8, 4), np.float32),
        joints=joints,
        weights=np.tile(np.array([1, 0, 0, 0], np.float32), (8, 1)),
        triangles=np.array(triangles, np.uint32),
    )


def make_character(
    clips: Sequence[str] = CLIPS, *, size: float = 1.0, names: Sequence[str] = JOINTS
) -> Character:
    """A person whose body is a box 1.75 * `size` units tall; clips last 1 to 2 seconds."""
    body = make_skeleton(PARENTS, np.array(OFFSETS) * size, names=names)
    low, high = np.array([-0.3, 0.0, -0.2]), np.array([0.3, 1.75, 0.2])
    moves = [
        make_clip(body, name, 1.0 + (k % 5) / 4, looping=name not in ("stand_up", "sit_down"))
        for k, name in enumerate(clips)
    ]
    return Character(
        name="box person",
        skeleton=body,
        meshes=(make_box(body, low * size, high * size),),
        materials=(Material("shirt"),),
        clips=tuple(moves),
    )

"""A human of any number of joints, moving in all of them, for benchmarks.

Twelve levels deep like a full game skeleton with fingers and a face; every joint has rotation,
translation and scale keys, and no two joints share a value, so nothing can be skipped. The bind
pose is rotated at every joint, as exporters leave it.
"""

from __future__ import annotations

import numpy as np

from ..engine.animation.clip import Clip, ClipEvent
from ..engine.animation.skeleton import Skeleton
from ..engine.assets.character import Character, Material, SkinnedMesh

LEVELS = 12
CLIPS = (
    "sit_idle",
    "sit_idle_2",
    "sit_clap",
    "stand_idle",
    "stand_idle_2",
    "clap",
    "cheer",
    "cheer_2",
    "jump",
    "wave",
    "dismay",
    "dismay_2",
)


def synthetic_character(joints: int, rng: np.random.Generator) -> Character:
    """A character with `joints` joints, twelve clips of 4 to 8 s, and a box for a body.

    Raises
    ------
    ValueError
        If `joints` is not between 1 and 4096.
    """
    if not 1 <= joints <= 4096:
        raise ValueError(f"joints is {joints}, expected 1 to 4096")
    skeleton = _skeleton(joints, rng)
    clips = tuple(_clip(name, joints, rng) for name in CLIPS)
    return Character("synthetic", skeleton, (_box(),), (Material("body"),), clips)


def _skeleton(joints: int, rng: np.random.Generator) -> Skeleton:
    depth = np.concatenate([[0], np.sort(np.arange(joints - 1) % (LEVELS - 1)) + 1])
    depth = np.minimum(depth, np.arange(joints))
    parents = np.full(joints, -1, np.int32)
    for joint in range(1, joints):
        above = np.flatnonzero(depth[:joint] == depth[joint] - 1)
        parents[joint] = rng.choice(above)
    inverse_bind = np.zeros((joints, 3, 4), np.float32)
    inverse_bind[:, :, :3] = np.linalg.qr(rng.normal(size=(joints, 3, 3)))[0]
    inverse_bind[:, :, 3] = rng.normal(0.0, 0.3, (joints, 3))
    rotation = np.tile(np.array([0, 0, 0, 1], np.float32), (joints, 1))
    return Skeleton(
        tuple(f"joint_{number}" for number in range(joints)),
        parents,
        rotation,
        rng.normal(0.0, 0.1, (joints, 3)).astype(np.float32),
        np.ones((joints, 3), np.float32),
        inverse_bind,
    )


def _clip(name: str, joints: int, rng: np.random.Generator) -> Clip:
    duration = float(rng.uniform(4.0, 8.0))
    frames = round(duration * 60) + 1
    swing = 2 * np.pi * np.linspace(0.0, 1.0, frames)[:, None, None]

    def wave(width: int, size: float) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
        turns = rng.integers(1, 4, (1, joints, width))
        return size * np.sin(turns * swing + rng.uniform(0, 6.28, (1, joints, width)))

    rotation = wave(4, 0.3)
    rotation[..., 3] += 1.0
    rotation /= np.linalg.norm(rotation, axis=2, keepdims=True)
    return Clip(
        name,
        duration,
        rotation.astype(np.float32),
        (rng.normal(0, 0.1, (1, joints, 3)) + wave(3, 0.01)).astype(np.float32),
        (1.0 + wave(3, 0.02)).astype(np.float32),
        events=_events(name, duration),
    )


def _events(name: str, duration: float) -> tuple[ClipEvent, ...]:
    """Every clip has a tag a second; claps have as many as clapping hands."""
    every, event = (0.3, "clap_contact") if "clap" in name else (1.0, "beat")
    return tuple(ClipEvent(float(time), event) for time in np.arange(0.0, duration, every))


def _box() -> SkinnedMesh:
    import trimesh

    box = trimesh.creation.box((0.5, 1.75, 0.3))
    count = len(box.vertices)
    joints, weights = np.zeros((count, 4), np.uint16), np.zeros((count, 4), np.float32)
    weights[:, 0] = 1.0
    return SkinnedMesh(
        "box",
        (box.vertices + np.array([0, 0.875, 0])).astype(np.float32),
        (box.vertices / np.linalg.norm(box.vertices, axis=1, keepdims=True)).astype(np.float32),
        np.zeros((count, 2), np.float32),
        np.ones((count, 4), np.float32),
        joints,
        weights,
        box.faces.astype(np.uint32),
    )

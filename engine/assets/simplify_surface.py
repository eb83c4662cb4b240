"""The meshes of a character as one surface, for reducing it.

Files split vertices where normals, picture coordinates or materials differ; the surface has the
same vertices, and beside them which of them are one place.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .character import Character, Material, SkinnedMesh

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_GRID = 1e-5
"""Vertices closer than this share of the character's size are one place."""


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """All triangles of a character's finest level.

    Parameters
    ----------
    joints, weights
        (V, 4) uint16 and float32 of the V vertices of all meshes.
    colors
        (V, 4) float64 linear RGBA: vertex colours times the picture where there is one.
    triangles
        (T, 3) int64 vertices.
    material
        (T,) int64.
    weld
        (V,) int64: the place of each vertex. Vertices at one place that joints move differently,
        as where two rigid parts touch, are two places.
    points
        (W, 3) float64 of the places.
    patch
        (V,) int64: vertices whose colours flow into each other have the same number.
    """

    joints: NDArray[np.uint16]
    weights: NDArray[np.float32]
    colors: Floats
    triangles: Ints
    material: Ints
    weld: Ints
    points: Floats
    patch: Ints


def join_surface(character: Character) -> Surface:
    """Join the meshes of a character's finest level."""
    meshes, materials = character.meshes, character.materials
    counts = [len(mesh.positions) for mesh in meshes]
    firsts = np.concatenate([[0], np.cumsum(counts)[:-1]])
    joints = np.concatenate([mesh.joints for mesh in meshes])
    weights = np.concatenate([mesh.weights for mesh in meshes])
    positions = np.concatenate([mesh.positions for mesh in meshes]).astype(np.float64)
    uvs = np.concatenate([mesh.uvs for mesh in meshes])
    triangles = np.concatenate(
        [
            mesh.triangles.astype(np.int64) + first
            for mesh, first in zip(meshes, firsts, strict=True)
        ]
    )
    size = max(float(np.ptp(positions, axis=0).max()), 1e-9)
    cells = np.round(positions / (_GRID * size)).astype(np.int64)
    moved = np.concatenate([joints, np.round(weights * 256.0)], axis=1).astype(np.int64)
    moved[:, :4][moved[:, 4:] == 0] = 0
    weld = _same_rows(np.concatenate([cells, moved], axis=1))
    points = np.empty((int(weld.max(initial=-1)) + 1, 3))
    points[weld] = positions
    colors = np.concatenate([_colors(mesh, materials[mesh.material]) for mesh in meshes])
    owner = np.repeat([mesh.material for mesh in meshes], counts)
    looks = np.concatenate(
        [weld[:, None], owner[:, None], np.round(uvs * 8192.0), np.round(colors * 64.0)], axis=1
    )
    return Surface(
        joints=joints,
        weights=weights,
        colors=colors,
        triangles=triangles,
        material=np.repeat([mesh.material for mesh in meshes], [len(m.triangles) for m in meshes]),
        weld=weld,
        points=points,
        patch=connected(_same_rows(looks.astype(np.int64)), triangles),
    )


def _same_rows(rows: Ints) -> Ints:
    """(N,) number of each of (N, K) rows, the same for equal rows."""
    numbers: Ints = np.unique(rows, axis=0, return_inverse=True)[1].reshape(-1)
    return numbers


def connected(numbers: Ints, triangles: Ints) -> Ints:
    """(N,) smallest number that each of N vertices reaches over triangles and equal numbers."""
    label = np.arange(int(numbers.max(initial=-1)) + 1)
    corners = numbers[triangles]
    while True:
        lowest = label[corners].min(axis=1)
        further = label.copy()
        for corner in range(3):
            np.minimum.at(further, corners[:, corner], lowest)
        further = further[further]
        if np.array_equal(further, label):
            reached: Ints = label[numbers]
            return reached
        label = further


def _colors(mesh: SkinnedMesh, material: Material) -> Floats:
    """(V, 4) linear colours with the picture's texel at each vertex, repeated beyond its edges."""
    colors = mesh.colors.astype(np.float64)
    if material.image is None:
        return colors
    height, width = material.image.shape[:2]
    uvs = mesh.uvs.astype(np.float64)
    column = np.floor(np.mod(uvs[:, 0], 1.0) * width).astype(np.int64) % width
    row = np.floor(np.mod(uvs[:, 1], 1.0) * height).astype(np.int64) % height
    texels = material.image[row, column] / 255.0
    texels[:, :3] = _to_linear(texels[:, :3])
    sampled: Floats = colors * texels
    return sampled


def _to_linear(srgb: Floats) -> Floats:
    """Linear light of sRGB values in 0..1, IEC 61966-2-1."""
    linear: Floats = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    return linear

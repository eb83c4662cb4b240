"""Eyes, brows and mouth: small closed lenses that sit in the surface of the head.

Painted on vertices of the head they would blur over whole triangles; as solids of their own they
stay crisp at any size and cost about a hundred triangles.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .meshing import Triangles, Vertices


@dataclass(frozen=True, slots=True)
class Feature:
    """One lens: the material that it belongs to and its COLOR_0 factor (linear RGB)."""

    material: str
    color: tuple[float, float, float]
    vertices: Vertices
    normals: NDArray[np.float64]
    triangles: Triangles


def _lens(
    centre: tuple[float, float, float],
    radii: tuple[float, float, float],
    roll: float,
    yaw: float,
    segments: int,
) -> tuple[Vertices, NDArray[np.float64], Triangles]:
    """A closed ellipsoid of two rings about +Z, turned by `roll` about Z, then `yaw` about Y."""
    angle = 2 * np.pi * np.arange(segments) / segments
    flat = np.stack([np.cos(angle), np.sin(angle), np.zeros(segments)], axis=1)
    front = 0.62 * flat + np.array([0.0, 0.0, 0.78])
    sphere = np.concatenate([[[0.0, 0.0, 1.0]], front, flat, [[0.0, 0.0, -1.0]]])
    turn = _about_y(yaw) @ _about_z(roll)
    size = np.array(radii)
    normals = (sphere / size) @ turn.T
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    faces = []
    last = 2 * segments + 1
    for k in range(segments):
        n = (k + 1) % segments
        a, b = 1 + k, 1 + n
        c, d = a + segments, b + segments
        faces += [(0, a, b), (a, c, d), (a, d, b), (c, last, d)]
    return (sphere * size) @ turn.T + np.array(centre), normals, np.array(faces, dtype=np.int64)


def _about_y(angle: float) -> NDArray[np.float64]:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def _about_z(angle: float) -> NDArray[np.float64]:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def face_features(segments: int) -> tuple[Feature, ...]:
    """The face for one level of detail, both sides.

    Parameters
    ----------
    segments
        Corners of each outline; 8 gives about 160 triangles. Below 6 only the eyes are made.
    """
    features: list[Feature] = []
    for side in (1.0, -1.0):
        eye = _lens(
            (side * 0.0320, 1.6220, 0.0880), (0.0082, 0.0118, 0.0085), 0.0, side * 0.30, segments
        )
        features.append(Feature("skin", (0.035, 0.03, 0.04), *eye))
        if segments >= 6:
            brow = _lens(
                (side * 0.0330, 1.6480, 0.0905),
                (0.0175, 0.0044, 0.0075),
                side * -0.04,
                side * 0.36,
                6,
            )
            features.append(Feature("hair", (0.9, 0.9, 0.9), *brow))
    if segments >= 6:
        mouth = _lens((0.0, 1.5650, 0.0925), (0.0230, 0.0046, 0.0110), 0.0, 0.0, segments)
        features.append(Feature("skin", (0.50, 0.22, 0.22), *mouth))
    return tuple(features)

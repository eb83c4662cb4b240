"""Rebuild the shipped spectator from code, as ``tifo assets build`` does.

Needs the `build` extra (marching cubes and mesh reduction); running tifo only needs the file.
"""

from __future__ import annotations

from itertools import zip_longest
from pathlib import Path

import numpy as np

from ...errors import TifoError
from ..character import Character, SkinnedMesh
from ..gltf_writer import write_glb
from .clips import spectator_clips
from .skeleton import spectator_skeleton
from .surface import MATERIALS, spectator_meshes

SHIPPED = Path(__file__).with_name("spectator.glb")
_NEAR = 24
"""Triangles, by their centroids, that are looked at for the one nearest to a point."""


def build_spectator() -> Character:
    """Make skeleton, meshes at three levels of detail, and all clips; takes about three minutes."""
    skeleton = spectator_skeleton()
    meshes, *lower = spectator_meshes(skeleton)
    return Character(
        name="spectator",
        skeleton=skeleton,
        meshes=meshes,
        materials=MATERIALS,
        clips=spectator_clips(skeleton),
        lower_levels=tuple(lower),
    )


def write_spectator(path: Path = SHIPPED) -> None:
    """Build the spectator and write it to a .glb file.

    Raises
    ------
    TifoError
        If the libraries of the `build` extra are missing.
    AssetError
        If the file can't be written.
    """
    try:
        made = build_spectator()
    except ModuleNotFoundError as error:
        raise TifoError(f"{error.name} is missing: pip install 'tifo[build]'") from error
    write_glb(made, path, compact=True)


def surfaces_apart(made: Character, kept: Character) -> float:
    """Metres from any vertex of one character to the other's mesh of the same name; both ways.

    Infinite if one has meshes that the other hasn't.
    """
    farthest = 0.0
    levels = zip_longest(
        (made.meshes, *made.lower_levels), (kept.meshes, *kept.lower_levels), fillvalue=()
    )
    for new, old in levels:
        if [mesh.name for mesh in new] != [mesh.name for mesh in old]:
            return float("inf")
        for a, b in zip(new, old, strict=True):
            farthest = max(farthest, _away(a, b), _away(b, a))
    return farthest


def _away(points: SkinnedMesh, surface: SkinnedMesh) -> float:
    """Metres from the farthest vertex of one mesh to the triangles of another."""
    from scipy.spatial import cKDTree
    from trimesh.triangles import closest_point

    corners = surface.positions[surface.triangles].astype(np.float64)
    near = min(_NEAR, len(corners))
    _, which = cKDTree(corners.mean(axis=1)).query(points.positions, k=near)
    which = np.reshape(which, (len(points.positions), near))
    at = np.repeat(points.positions.astype(np.float64), near, axis=0)
    found = closest_point(corners[which.ravel()], at)
    away = np.linalg.norm(found - at, axis=1).reshape(which.shape).min(axis=1)
    return float(away.max())

"""A character's meshes as the skinning pass draws them.

Materials without a picture differ only in colour, so their meshes are joined into one batch with
the colour in the vertices; each picture needs a batch of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..assets.character import Material, SkinnedMesh
from ..crowd.morphs import MorphWeights
from ..crowd.regions import SURFACES, Regions

PARTED = 254
"""The surface of what is coloured by its height in the bind pose."""
NO_SURFACE = 255

NORMALISED = ("color", "morph")
"""Fields of `VERTEX` whose integers mean 0 to 1."""

VERTEX = np.dtype(
    [
        ("position", np.float32, 3),
        ("normal", np.float32, 3),
        ("uv", np.float32, 2),
        ("weights", np.float32, 4),
        ("joints", np.uint16, 4),
        ("color", np.uint8, 4),
        ("surface", np.uint8),
        ("morph", np.uint8, 2),
        ("padding", np.uint8, 1),
    ]
)


@dataclass(frozen=True, slots=True, eq=False)
class Batch:
    """Triangles that one call draws.

    Parameters
    ----------
    vertices
        (V,) of `VERTEX`.
    indices
        (3 T,) uint32.
    image
        (H, W, 4) uint8 sRGB picture, or None.
    double_sided
        Whether back faces are drawn.
    """

    vertices: NDArray[np.void]
    indices: NDArray[np.uint32]
    image: NDArray[np.uint8] | None
    double_sided: bool


def make_batches(
    meshes: Sequence[SkinnedMesh],
    materials: Sequence[Material],
    morphs: MorphWeights | None = None,
    regions: Regions | None = None,
) -> tuple[Batch, ...]:
    """Join meshes into as few batches as their pictures and sidedness allow.

    Parameters
    ----------
    meshes, materials
        Of a character.
    morphs
        How their vertices take part in the morphs; not at all if None.
    regions
        Of the character; None if materials without a name of a surface keep their colours.
    """
    groups: dict[tuple[int, bool], list[SkinnedMesh]] = {}
    for mesh in meshes:
        material = materials[mesh.material]
        key = (-1 if material.image is None else mesh.material, material.double_sided)
        groups.setdefault(key, []).append(mesh)
    return tuple(
        Batch(
            vertices=np.concatenate(
                [_vertices(mesh, materials[mesh.material], morphs, regions) for mesh in group]
            ),
            indices=_indices(group),
            image=None if picture < 0 else materials[picture].image,
            double_sided=double_sided,
        )
        for (picture, double_sided), group in groups.items()
    )


def split_batch(batch: Batch, joints: NDArray[np.bool_]) -> tuple[Batch, Batch]:
    """The triangles of a batch that move with none of some joints, and those that do.

    Parameters
    ----------
    batch
        What is split; both parts keep all of its vertices.
    joints
        (J,) which joints.
    """
    vertices = batch.vertices
    moved = ((vertices["weights"] > 0.0) & joints[vertices["joints"]]).any(axis=1)
    triangles = batch.indices.reshape(-1, 3)
    there = moved[triangles].any(axis=1)
    apart, with_them = triangles[~there].ravel(), triangles[there].ravel()
    return replace(batch, indices=apart), replace(batch, indices=with_them)


def _vertices(
    mesh: SkinnedMesh,
    material: Material,
    morphs: MorphWeights | None,
    regions: Regions | None,
) -> NDArray[np.void]:
    out = np.zeros(len(mesh.positions), VERTEX)
    out["position"], out["normal"], out["uv"] = mesh.positions, mesh.normals, mesh.uvs
    out["weights"], out["joints"] = mesh.weights, mesh.joints
    if morphs is not None:
        out["morph"] = np.round(255.0 * morphs.of(mesh)).astype(np.uint8)
    varies = material.name in SURFACES
    out["surface"] = SURFACES.index(material.name) if varies else NO_SURFACE
    if regions is not None and regions.parted and not regions.keeps_colours(mesh):
        out["surface"] = PARTED
    base = np.ones(4) if varies else np.array(material.base_color, np.float64)
    linear: NDArray[np.float64] = np.clip(mesh.colors * base, 0.0, 1.0)
    out["color"] = np.round(255.0 * _to_srgb(linear)).astype(np.uint8)
    return out


def _indices(meshes: Sequence[SkinnedMesh]) -> NDArray[np.uint32]:
    firsts = np.concatenate([[0], np.cumsum([len(mesh.positions) for mesh in meshes])[:-1]])
    return np.concatenate(
        [mesh.triangles.ravel() + first for mesh, first in zip(meshes, firsts, strict=True)]
    ).astype(np.uint32)


def _to_srgb(linear: NDArray[np.float64]) -> NDArray[np.float64]:
    """RGB of (V, 4) to sRGB, IEC 61966-2-1; alpha stays."""
    out = linear.copy()
    rgb = linear[:, :3]
    out[:, :3] = np.where(rgb <= 0.0031308, 12.92 * rgb, 1.055 * rgb ** (1 / 2.4) - 0.055)
    return out

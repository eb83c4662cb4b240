"""The spectator's meshes: one per material and level of detail."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...animation.kinematics import Kinematics
from ...animation.pose import pack_poses
from ...animation.skeleton import Skeleton
from ..character import Material, SkinnedMesh
from ..gltf_mesh import vertex_normals
from ..levels import level_name
from .applause import ORDINARY, applaud
from .body import REGIONS, occlusion, region_fields, surface_normals
from .borders import cut
from .decimation import reduce_surface
from .face import face_features
from .meshing import Triangles, Vertices, half_surface, mirrored, rim_vertices, thin_out
from .poses import seated_clapping
from .skinning import SurfaceWeights

MATERIALS = (
    Material("skin", (0.60, 0.34, 0.215, 1.0)),
    Material("hair", (0.060, 0.034, 0.020, 1.0)),
    Material("shirt", (0.58, 0.035, 0.045, 1.0)),
    Material("trousers", (0.045, 0.065, 0.150, 1.0)),
    Material("shoes", (0.050, 0.050, 0.055, 1.0)),
)
"""Base colours in linear light; all five are meant to be replaced per spectator."""

MESH_STEP = 0.006
DARKEST = 0.55
"""COLOR_0 of fully enclosed surface."""


@dataclass(frozen=True, slots=True)
class _Level:
    triangles: int
    """Wanted before the borders are cut, which adds a few."""
    snap: float
    face_segments: int
    """Corners of the eyes' outline; 0 leaves the face out."""


_LEVELS = (_Level(2380, 0.28, 8), _Level(640, 0.22, 4), _Level(168, 0.16, 0))


def _names(level: int) -> list[str]:
    return [level_name(material.name, level) for material in MATERIALS]


def _half(
    vertices: Vertices, triangles: Triangles, snap: float
) -> tuple[Vertices, Triangles, NDArray[np.int64]]:
    """The left half of a surface, cut along the borders, and each triangle's material."""
    vertices, triangles, inside, _ = cut(vertices, triangles, -vertices[:, 0], snap / 2)
    used, faces = np.unique(triangles[inside], return_inverse=True)
    vertices, triangles = vertices[used], faces.reshape(-1, 3)
    vertices[rim_vertices(triangles), 0] = 0.0
    names = _names(0)
    material = np.full(len(triangles), -1)
    for name in REGIONS:
        field = region_fields(vertices)[name]
        vertices, triangles, inside, source = cut(vertices, triangles, field, snap)
        material = material[source]
        material[inside & (material < 0)] = names.index(name)
    material[material < 0] = names.index("skin")
    return vertices, triangles, material


def _level_meshes(
    level: int, vertices: Vertices, triangles: Triangles, weights: SurfaceWeights, head: int
) -> tuple[SkinnedMesh, ...]:
    vertices, triangles, material = _half(vertices, triangles, _LEVELS[level].snap)
    vertices, triangles = mirrored(vertices, triangles)
    material = np.concatenate([material, material])
    # A coarse surface cuts corners, where the normals of the smooth body would point anywhere.
    normals = surface_normals(vertices)
    if level > 0:
        normals = vertex_normals(vertices, triangles).astype(np.float32)
    shade = DARKEST + (1 - DARKEST) * occlusion(vertices, normals)
    joint_weights = weights.at(vertices)
    segments = _LEVELS[level].face_segments
    features = face_features(segments) if segments else ()
    meshes = []
    for index, name in enumerate(_names(level)):
        used, faces = np.unique(triangles[material == index], return_inverse=True)
        parts = [(vertices[used], normals[used], np.repeat(shade[used, None], 3, axis=1))]
        part_weights = [joint_weights[used]]
        part_faces = [faces.reshape(-1, 3)]
        count = len(used)
        for feature in features:
            if feature.material == MATERIALS[index].name:
                rows = len(feature.vertices)
                parts.append(
                    (feature.vertices, feature.normals, np.tile(np.array(feature.color), (rows, 1)))
                )
                rigid = np.zeros((rows, joint_weights.shape[1]))
                rigid[:, head] = 1.0
                part_weights.append(rigid)
                part_faces.append(feature.triangles + count)
                count += rows
        positions, mesh_normals, colors = (np.concatenate(c) for c in zip(*parts, strict=True))
        joints, four = _four_influences(np.concatenate(part_weights))
        meshes.append(
            SkinnedMesh(
                name=name,
                positions=positions.astype(np.float32),
                normals=mesh_normals.astype(np.float32),
                uvs=np.zeros((count, 2), dtype=np.float32),
                colors=np.concatenate([colors, np.ones((count, 1))], axis=1).astype(np.float32),
                joints=joints,
                weights=four,
                triangles=np.concatenate(part_faces).astype(np.uint32),
                material=index,
            )
        )
    return tuple(meshes)


def _four_influences(
    weights: NDArray[np.float64],
) -> tuple[NDArray[np.uint16], NDArray[np.float32]]:
    """(N, J) weights with at most four non-zero to joint indices and weights, largest first."""
    joints = np.argsort(-weights, axis=1, kind="stable")[:, :4]
    four = np.take_along_axis(weights, joints, axis=1)
    four /= four.sum(axis=1, keepdims=True)
    return np.where(four > 0, joints, 0).astype(np.uint16), four.astype(np.float32)


def _clapping(skeleton: Skeleton, vertices: Vertices, weights: NDArray[np.float64]) -> Vertices:
    """Vertices (V, 3) in a pose that bends hips, knees and elbows: seated, clapping."""
    clip = applaud("sit_clap", ORDINARY, seated_clapping()).clip(skeleton)
    kinematics = Kinematics(skeleton, 1)
    palettes = np.empty((1, skeleton.joint_count, 3, 4), dtype=np.float32)
    first = (part[:1] for part in (clip.rotation, clip.translation, clip.scale))
    kinematics.evaluate(pack_poses(*first), palettes)
    turn = np.einsum("vj,jab->vab", weights, palettes[0].astype(np.float64))
    posed: Vertices = np.einsum("vab,vb->va", turn[:, :, :3], vertices) + turn[:, :, 3]
    return posed


def spectator_meshes(skeleton: Skeleton) -> tuple[tuple[SkinnedMesh, ...], ...]:
    """Mesh the body at all levels of detail, finest first; needs the `build` extra.

    Each level has one mesh per material, named after it, with ``_LOD1`` and ``_LOD2`` added at the
    lower levels. Meshes of a level share the vertices of their borders, so together they are
    closed.
    """
    weights = SurfaceWeights(skeleton.names)
    vertices, triangles = thin_out(*mirrored(*half_surface(MESH_STEP)), 6000)
    bent = _clapping(skeleton, vertices, weights.at(vertices))
    counts = tuple(level.triangles for level in _LEVELS)
    levels = reduce_surface(vertices, bent, triangles, counts)
    return tuple(
        _level_meshes(index, *surface, weights, skeleton.index("head"))
        for index, surface in enumerate(levels)
    )

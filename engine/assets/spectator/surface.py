"""The spectator's meshes: one per material and level of detail."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...animation.kinematics import Kinematics
from ...animation.pose import pack_poses
from ...animation.skeleton import Skeleton
from ..character import Material, SkinnedMesh, Variant
from ..gltf_mesh import vertex_normals
from ..levels import level_name
from .applause import ORDINARY, applaud
from .body import REGIONS, Body
from .borders import cut
from .decimation import reduce_surface
from .face import face_features
from .hair import STYLES, Style
from .meshing import (
    BODY_BOX,
    HEAD_BOX,
    Triangles,
    Vertices,
    half_surface,
    mirrored,
    rim_vertices,
    thin_out,
)
from .poses import seated_clapping
from .skinning import SurfaceWeights, strongest
from .solids import Distance, occlusion, surface_normals
from .wardrobe import OUTFITS, Outfit

MATERIALS = (
    Material("skin", (0.60, 0.34, 0.215, 1.0)),
    Material("hair", (0.060, 0.034, 0.020, 1.0)),
    Material("shirt", (0.58, 0.035, 0.045, 1.0)),
    Material("trousers", (0.045, 0.065, 0.150, 1.0)),
    Material("shoes", (0.050, 0.050, 0.055, 1.0)),
)
"""Base colours in linear light; all five are meant to be replaced per spectator."""

MESH_STEP = 0.006
HAIR_STEP = 0.004
DARKEST = 0.55
"""COLOR_0 of fully enclosed surface."""
HEM_SHADE = 0.88
"""Least COLOR_0 at a hem."""


@dataclass(frozen=True, slots=True)
class _Level:
    triangles: int
    """Wanted before the borders are cut, which adds a few."""
    snap: float
    face_segments: int
    """Corners of the eyes' outline; 0 leaves the face out."""


_LEVELS = (_Level(2160, 0.28, 8), _Level(600, 0.22, 4), _Level(156, 0.16, 0))
_NAMES = [material.name for material in MATERIALS]
_PROUD = (0.0, 0.003, 0.007)
"""Metres by which hair stands farther out at coarser levels, so that no coarse head shows."""


def _left_half(vertices: Vertices, triangles: Triangles, snap: float) -> tuple[Vertices, Triangles]:
    vertices, triangles, inside, _ = cut(vertices, triangles, -vertices[:, 0], snap / 2)
    used, faces = np.unique(triangles[inside], return_inverse=True)
    vertices, triangles = vertices[used], faces.reshape(-1, 3)
    vertices[rim_vertices(triangles), 0] = 0.0
    return vertices, triangles


def _materials(
    body: Body, vertices: Vertices, triangles: Triangles, snap: float
) -> tuple[Vertices, Triangles, NDArray[np.int64]]:
    """The left half of a body, cut along the borders, and each triangle's material."""
    material = np.full(len(triangles), -1)
    for name in REGIONS:
        field = body.regions(vertices)[name]
        vertices, triangles, inside, source = cut(vertices, triangles, field, snap)
        material = material[source]
        material[inside & (material < 0)] = _NAMES.index(name)
    material[material < 0] = _NAMES.index("skin")
    return vertices, triangles, material


@dataclass(frozen=True, slots=True, eq=False)
class _Shell:
    """Vertices of one mesh before they are packed."""

    vertices: Vertices
    normals: NDArray[np.floating]
    colors: NDArray[np.floating]
    weights: NDArray[np.float64]
    triangles: Triangles


def _shaded(
    distance: Distance, level: int, vertices: Vertices, triangles: Triangles
) -> tuple[NDArray[np.float32], NDArray[np.floating]]:
    """Normals and colours of a surface."""
    # A coarse surface cuts corners, where the normals of the smooth body would point anywhere.
    normals = surface_normals(distance, vertices)
    if level > 0:
        normals = vertex_normals(vertices, triangles).astype(np.float32)
    shade = DARKEST + (1 - DARKEST) * occlusion(distance, vertices, normals)
    return normals, np.repeat(shade[:, None], 3, axis=1)


def _packed(shells: list[_Shell], material: int, level: int, variant: Variant) -> SkinnedMesh:
    """One mesh of several shells."""
    starts = np.cumsum([0, *(len(shell.vertices) for shell in shells)])
    colors = np.concatenate([shell.colors for shell in shells])
    joints, four = _four_influences(np.concatenate([shell.weights for shell in shells]))
    faces = [shell.triangles + start for shell, start in zip(shells, starts[:-1], strict=True)]
    return SkinnedMesh(
        name=level_name(f"{variant.choice}.{_NAMES[material]}", level),
        positions=np.concatenate([shell.vertices for shell in shells]).astype(np.float32),
        normals=np.concatenate([shell.normals for shell in shells]).astype(np.float32),
        uvs=np.zeros((len(colors), 2), dtype=np.float32),
        colors=np.concatenate([colors, np.ones((len(colors), 1))], axis=1).astype(np.float32),
        joints=joints,
        weights=four,
        triangles=np.concatenate(faces).astype(np.uint32),
        material=material,
        variant=variant,
    )


def _body_meshes(outfit: Outfit, skeleton: Skeleton) -> list[list[SkinnedMesh]]:
    """One body at all levels of detail."""
    body = Body(outfit)
    surface_weights = SurfaceWeights(body, skeleton.names)
    vertices, triangles = thin_out(
        *mirrored(*half_surface(body.distance, MESH_STEP, BODY_BOX)), 6000
    )
    bent = _clapping(skeleton, vertices, surface_weights.at(vertices))
    counts = tuple(level.triangles for level in _LEVELS)
    variant = Variant("body", outfit.name, outfit.shares)
    head = skeleton.index("head")
    levels = []
    for number, surface in enumerate(reduce_surface(vertices, bent, triangles, counts)):
        level = _LEVELS[number]
        half = _materials(body, *_left_half(*surface, level.snap), level.snap)
        vertices, triangles = mirrored(*half[:2])
        material = np.concatenate([half[2], half[2]])
        normals, colors = _shaded(body.distance, number, vertices, triangles)
        # What looks down under a hem would run up the cloth as stains, so there the cloth's normals
        # are those a little higher.
        for hem in (outfit.shirt_hem, outfit.hem) if outfit.bare_leg else (outfit.shirt_hem,):
            near = np.abs(vertices[:, 1] - hem) < 0.025
            higher = vertices[near].copy()
            higher[:, 1] = hem + 0.035
            normals[near] = surface_normals(body.distance, higher)
            colors[near] = np.maximum(colors[near], HEM_SHADE)
        weights = surface_weights.at(vertices)
        features = face_features(level.face_segments) if level.face_segments else ()
        meshes = []
        for index, name in enumerate(_NAMES):
            used, faces = np.unique(triangles[material == index], return_inverse=True)
            shells = (
                [
                    _Shell(
                        vertices[used],
                        normals[used],
                        colors[used],
                        weights[used],
                        faces.reshape(-1, 3),
                    )
                ]
                if len(used)
                else []
            )
            for feature in features:
                if feature.material == name:
                    rows = len(feature.vertices)
                    color = np.tile(np.array(feature.color), (rows, 1))
                    rigid = np.zeros((rows, len(skeleton.names)))
                    rigid[:, head] = 1.0
                    shells.append(
                        _Shell(feature.vertices, feature.normals, color, rigid, feature.triangles)
                    )
            if shells:
                meshes.append(_packed(shells, index, number, variant))
        levels.append(meshes)
    return levels


def _hair_meshes(style: Style, skeleton: Skeleton) -> list[list[SkinnedMesh]]:
    """One hair or beard at all levels of detail."""
    surface = mirrored(*half_surface(style.distance, HAIR_STEP, HEAD_BOX))
    vertices, triangles = thin_out(*surface, 3000)
    variant = Variant(style.group, style.name, style.shares)
    levels: list[list[SkinnedMesh]] = []
    for number, reduced in enumerate(
        reduce_surface(vertices, vertices, triangles, style.triangles)
    ):
        vertices, triangles = mirrored(*_left_half(*reduced, _LEVELS[number].snap))
        if not style.triangles[number]:
            levels.append([])
            continue
        normals, colors = _shaded(style.distance, number, vertices, triangles)
        vertices = vertices + _PROUD[number] * normals
        vertices[np.abs(vertices[:, 0]) < 1e-9, 0] = 0.0
        weights = _hair_weights(style, vertices, skeleton)
        shell = _Shell(vertices, normals, colors, weights, triangles)
        levels.append([_packed([shell], _NAMES.index("hair"), number, variant)])
    return levels


def _hair_weights(style: Style, vertices: Vertices, skeleton: Skeleton) -> NDArray[np.float64]:
    """(N, J): hair is the head's; what hangs down becomes the neck's and then the chest's."""
    weights = np.zeros((len(vertices), len(skeleton.names)))
    weights[:, skeleton.index("head")] = 1.0
    if style.hangs:
        y = vertices[:, 1]
        head = np.clip((y - 1.44) / 0.10, 0.0, 1.0)
        chest = np.clip((1.46 - y) / 0.10, 0.0, 1.0)
        for name, share in (
            ("head", head),
            ("neck", 1 - np.maximum(head, chest)),
            ("chest", chest),
        ):
            weights[:, skeleton.index(name)] = np.maximum(share, 0.0)
        weights = strongest(weights / weights.sum(axis=1, keepdims=True))
    return weights


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
    """Mesh all bodies, hair and beards at all levels of detail; needs the `build` extra.

    Returns
    -------
    The levels, finest first. Each has one mesh per variant and material, named after both, with
    ``_LOD1`` and ``_LOD2`` added at the lower levels. Meshes of one body share the vertices of
    their borders, so together they are closed, as every hair and beard is by itself.
    """
    levels: list[list[SkinnedMesh]] = [[] for _ in _LEVELS]
    made = [_body_meshes(outfit, skeleton) for outfit in OUTFITS]
    made += [_hair_meshes(style, skeleton) for style in STYLES]
    for variant in made:
        for level, meshes in zip(levels, variant, strict=True):
            level += meshes
    return tuple(tuple(level) for level in levels)

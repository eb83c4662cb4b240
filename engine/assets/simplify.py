"""Coarser meshes for characters that come without any.

A stadium shows most spectators at a height of a few dozen pixels, and files rarely hold meshes for
that. Here all meshes of a character are reduced together by quadric error (M. Garland and
P. Heckbert, "Surface simplification using quadric error metrics", 1997), so that triangles go where
the body has shape, not where its modeller happened to cut it into pieces.

Edges are collapsed on the surface with its seams closed, and every triangle that is left is one of
the original's, with its corners moved. So materials need no guessing, and what a corner takes over
comes from the vertices that were drawn together in it: never from another limb that is just near.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .character import Character, Material, SkinnedMesh
from .edge_collapse import collapse_edges
from .levels import level_name
from .simplify_surface import Surface, connected, join_surface
from .variants import one_look

LEVEL_TRIANGLES = (800, 200)
"""Triangles of the second and third mesh: what is still seen at 110 and at 42 pixels."""

_LEAST_EXTENT = 0.6
"""A level whose height or diagonal falls below this share of the original's is no body any more."""

_PART_EXTENT, _LEAST_AREA, _PART_TRIANGLES = 0.07, 0.5, 10
"""A part this share of the body's size that keeps less than this share of its area, in fewer
triangles, gets so many."""

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def with_lower_levels(character: Character, targets: Sequence[int] = LEVEL_TRIANGLES) -> Character:
    """Give a character coarser meshes, unless it has some.

    Level k + 1 has about ``targets[k]`` triangles; where the level before has no more than that, or
    where nothing usable is left, it is that level again. Variants are reduced apart, and the
    targets are for one look. Pictures are sampled into vertex colours,
    and the meshes refer to copies of their materials without picture, which are appended. A
    character with as few triangles as the last target comes back as it is.

    Parameters
    ----------
    character
        Unchanged. 7,000 triangles take about a tenth of a second.
    targets
        Triangles wanted at each coarser level, falling.

    Raises
    ------
    ValueError
        If a target is below 4 or `targets` don't fall.
    """
    if any(target < 4 for target in targets) or list(targets) != sorted(set(targets))[::-1]:
        raise ValueError(f"targets is {tuple(targets)}, expected falling numbers of at least 4")
    if character.lower_levels or not targets:
        return character
    if any(mesh.variant is not None for mesh in character.meshes):
        return _with_lower_variants(character, targets)
    if character.triangle_count <= targets[-1]:
        return character
    surface = join_surface(character)
    materials, plain = _plain_materials(character.materials)
    levels: list[tuple[SkinnedMesh, ...]] = [character.meshes]
    for number, target in enumerate(targets, start=1):
        finer = sum(len(mesh.triangles) for mesh in levels[-1])
        made = _reduce(surface, target) if finer > target else None
        if made is None or not 0 < len(made.triangles) < finer:
            levels.append(levels[-1])
            continue
        levels.append(_meshes(character, surface, made, plain, number))
    if all(level is character.meshes for level in levels):
        return character
    return replace(character, materials=materials, lower_levels=tuple(levels[1:]))


def _with_lower_variants(character: Character, targets: Sequence[int]) -> Character:
    """`with_lower_levels` for every variant by itself, each with its share of the targets."""
    look = one_look(character).triangle_count
    pieces: dict[tuple[str, str], list[SkinnedMesh]] = {}
    for mesh in character.meshes:
        variant = mesh.variant
        key = ("", "") if variant is None else (variant.group, variant.choice)
        pieces.setdefault(key, []).append(mesh)
    materials = character.materials
    levels: list[list[SkinnedMesh]] = [[] for _ in targets]
    for meshes in pieces.values():
        count = sum(len(mesh.triangles) for mesh in meshes)
        share = min(count / max(look, 1), 1.0)
        wanted = sorted({max(round(target * share), 4) for target in targets}, reverse=True)
        plain = tuple(replace(mesh, variant=None) for mesh in meshes)
        made = with_lower_levels(replace(character, meshes=plain), wanted)
        # Copies of materials are always the same, so the longest list serves all pieces.
        materials = max(materials, made.materials, key=len)
        found = (plain, *made.lower_levels)
        for number, level in enumerate(levels, start=1):
            coarse = found[min(number, len(found) - 1)]
            level += [replace(mesh, variant=meshes[0].variant) for mesh in coarse]
    lower = tuple(tuple(level) for level in levels)
    return replace(character, materials=materials, lower_levels=lower)


@dataclass(frozen=True, slots=True, eq=False)
class _Reduced:
    """What is left of a surface.

    Parameters
    ----------
    points
        (P, 3) float64 places.
    cluster
        (W,) int64: the point into which each welded vertex was drawn, -1 for those that vanished.
    triangles
        (T, 3) int64 points of the triangles left.
    origin
        (T,) int64: which triangle of the surface each of them was.
    """

    points: Floats
    cluster: Ints
    triangles: Ints
    origin: Ints


def _reduce(surface: Surface, target: int) -> _Reduced | None:
    """Reduce a surface to about `target` triangles; None if it can't be or loses its shape."""
    corners = surface.weld[surface.triangles]
    origin = np.flatnonzero(_distinct(corners))
    corners = corners[origin]
    if len(origin) <= target:
        return None
    into, places = collapse_edges(surface.points, corners, target)
    _restore_parts(surface.points, corners, into, places)
    moved = into[corners]
    left = _distinct(moved)
    names, triangles = np.unique(moved[left], return_inverse=True)
    if not _keeps_shape(surface.points, places[names]):
        return None
    number = np.full(len(into), -1, np.int64)
    number[names] = np.arange(len(names))
    return _Reduced(places[names], number[into], triangles.reshape(-1, 3), origin[left])


def _restore_parts(points: Floats, triangles: Ints, into: Ints, places: Floats) -> None:
    """Give parts that were lost or flattened, but are big enough to be missed, a few triangles.

    The error that chooses what to collapse is the same all over the body, so a thin leg that is a
    part of its own would vanish before a broad chest loses any of its shape.
    """
    part = connected(np.arange(len(points)), triangles)[triangles[:, 0]]
    left = _distinct(into[triangles])
    before, after = _areas(points, triangles), _areas(places, into[triangles])
    whole = float(np.linalg.norm(np.ptp(points, axis=0)))
    for number in np.unique(part):
        faces = np.flatnonzero(part == number)
        if (
            np.count_nonzero(left[faces]) >= _PART_TRIANGLES
            or after[faces].sum() >= _LEAST_AREA * before[faces].sum()
        ):
            continue
        members, local = np.unique(triangles[faces], return_inverse=True)
        if np.linalg.norm(np.ptp(points[members], axis=0)) < _PART_EXTENT * whole:
            continue
        inner, moved = collapse_edges(points[members], local.reshape(-1, 3), _PART_TRIANGLES)
        into[members], places[members] = members[inner], moved


def _areas(points: Floats, triangles: Ints) -> Floats:
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    areas: Floats = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return areas


def _keeps_shape(before: Floats, after: Floats) -> bool:
    """Whether points still reach about as high and as far as they did."""
    if not len(after) or not np.isfinite(after).all():
        return False
    old, new = np.ptp(before, axis=0), np.ptp(after, axis=0)
    high: bool = bool(new[1] >= _LEAST_EXTENT * old[1])
    return high and bool(np.linalg.norm(new) >= _LEAST_EXTENT * np.linalg.norm(old))


def _distinct(triangles: Ints) -> NDArray[np.bool_]:
    """Which of (T, 3) triangles have three different corners."""
    a, b, c = triangles.T
    kept: NDArray[np.bool_] = (a != b) & (b != c) & (c != a)
    return kept


def _meshes(
    character: Character, surface: Surface, made: _Reduced, plain: Sequence[int], level: int
) -> tuple[SkinnedMesh, ...]:
    """One mesh for each material that has triangles left."""
    normals = _normals(made)
    nearest = _nearest_member(surface, made)
    # A corner takes its colour from the part of its cluster that its own patch of colour covers.
    patch = surface.patch[surface.triangles[made.origin, 0]]
    colours = _cluster_means(surface, made)
    material = surface.material[made.origin]
    meshes = []
    for number in np.unique(material):
        chosen = np.flatnonzero(material == number)
        keys = np.stack([made.triangles[chosen], np.repeat(patch[chosen, None], 3, axis=1)], axis=2)
        corners, triangles = np.unique(keys.reshape(-1, 2), axis=0, return_inverse=True)
        point = corners[:, 0]
        source = nearest[point]
        first = next(mesh for mesh in character.meshes if mesh.material == number)
        meshes.append(
            SkinnedMesh(
                name=level_name(first.name, level),
                positions=made.points[point].astype(np.float32),
                normals=normals[point].astype(np.float32),
                uvs=np.zeros((len(point), 2), np.float32),
                colors=np.array([colours[int(p), int(k)] for p, k in corners], np.float32),
                joints=surface.joints[source],
                weights=surface.weights[source],
                triangles=triangles.reshape(-1, 3).astype(np.uint32),
                material=plain[number],
            )
        )
    return tuple(meshes)


def _nearest_member(surface: Surface, made: _Reduced) -> Ints:
    """(P,) original vertex of each cluster that lies nearest to where the cluster's point is."""
    cluster = made.cluster[surface.weld]
    inside = np.flatnonzero(cluster >= 0)
    offset = surface.points[surface.weld[inside]] - made.points[cluster[inside]]
    order = np.lexsort((np.einsum("ij,ij->i", offset, offset), cluster[inside]))
    _, first = np.unique(cluster[inside][order], return_index=True)
    nearest: Ints = inside[order[first]]
    return nearest


def _cluster_means(surface: Surface, made: _Reduced) -> dict[tuple[int, int], Floats]:
    """Mean colour of every cluster's share of every patch, by (point, patch).

    See-through texels hardly count: their colour is whatever the painter left there.
    """
    cluster = made.cluster[surface.weld]
    inside = np.flatnonzero(cluster >= 0)
    keys = np.stack([cluster[inside], surface.patch[inside]], axis=1)
    pairs, group = np.unique(keys, axis=0, return_inverse=True)
    group = group.reshape(-1)
    colours = surface.colors[inside]
    weight = np.maximum(colours[:, 3], 1e-3)
    total = np.bincount(group, weight, len(pairs))
    means = np.ones((len(pairs), 4))
    for channel in range(3):
        means[:, channel] = np.bincount(group, weight * colours[:, channel], len(pairs)) / total
    return {(int(p), int(k)): mean for (p, k), mean in zip(pairs, means, strict=True)}


def _normals(made: _Reduced) -> Floats:
    """(P, 3) unit normals, the area-weighted mean of the triangles around a point."""
    a, b, c = (made.points[made.triangles[:, corner]] for corner in range(3))
    faces = np.cross(b - a, c - a)
    normals = np.zeros_like(made.points)
    for corner in range(3):
        np.add.at(normals, made.triangles[:, corner], faces)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    safe = np.where(lengths > 0, lengths, 1.0)
    unit: Floats = np.where(lengths > 0, normals / safe, [0.0, 1.0, 0.0])
    return unit


def _plain_materials(
    materials: tuple[Material, ...],
) -> tuple[tuple[Material, ...], tuple[int, ...]]:
    """All materials with copies that have no picture behind them, and the plain one of each."""
    extended = list(materials)
    plain = []
    for number, material in enumerate(materials):
        if material.image is not None:
            number = len(extended)
            extended.append(replace(material, image=None))
        plain.append(number)
    return tuple(extended), tuple(plain)

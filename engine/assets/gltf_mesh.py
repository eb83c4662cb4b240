"""Primitives of a glTF file as plain arrays: triangles, attributes and influences.

glTF 2.0 specification, section 3.7. Positions stay in the space that the file stores them in;
`gltf_binding` brings them to the bind pose of the whole character.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .gltf_accessor import read_floats, read_integers
from .gltf_document import GltfDocument
from .gltf_fields import Fields
from .gltf_material import TextureCoordinates

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

INFLUENCES = 4
"""Joints that a vertex keeps."""

POINT_AND_LINE_MODES = (0, 1, 2, 3)
TRIANGLES, STRIP, FAN = 4, 5, 6


@dataclass(frozen=True, slots=True, eq=False)
class Primitive:
    """One primitive, V vertices and T triangles, every vertex used.

    Parameters
    ----------
    positions, normals
        (V, 3) float64; normals have unit length.
    uvs
        (V, 2) float64, transformed as the material asks.
    colors
        (V, 4) float64.
    joints, weights
        (V, 4) indices into the skin's joint list and weights that sum to 1, the largest first; a
        weight of 0 repeats the first joint. None where the file has no influences.
    triangles
        (T, 3) int64.
    """

    positions: FloatArray
    normals: FloatArray
    uvs: FloatArray
    colors: FloatArray
    joints: IntArray | None
    weights: FloatArray | None
    triangles: IntArray


def read_primitive(
    document: GltfDocument, fields: Fields, coordinates: TextureCoordinates, notes: list[str]
) -> Primitive | None:
    """Read one primitive.

    Parameters
    ----------
    document
        The file.
    fields
        The primitive's JSON.
    coordinates
        How its material uses texture coordinates.
    notes
        Takes what was dropped.

    Returns
    -------
    Primitive or None
        None, with a note, if there is nothing to draw: points, lines, no positions, no triangle.

    Raises
    ------
    AssetError
        For anything that contradicts the format.
    """
    mode = fields.integer("mode", TRIANGLES, high=FAN)
    attributes = _attributes(document, fields)
    if mode in POINT_AND_LINE_MODES or "POSITION" not in attributes:
        what = "no positions" if "POSITION" not in attributes else "points or lines"
        notes.append(f"{fields.place} has {what} and is left out.")
        return None
    if fields.children("targets"):
        notes.append(f"{fields.place}: its morph targets are left out.")
    positions = read_floats(document, attributes["POSITION"], "VEC3")
    count = len(positions)
    triangles = _triangles(document, fields, mode, count, notes)
    if not len(triangles):
        notes.append(f"{fields.place} has no triangle and is left out.")
        return None

    def attribute(name: str, *kinds: str) -> FloatArray | None:
        if name not in attributes:
            return None
        values = read_floats(document, attributes[name], *kinds)
        if len(values) != count:
            fields.fail(
                f"attributes.{name}", f"has {len(values)} elements, but POSITION has {count}"
            )
        return values

    uvs = attribute(f"TEXCOORD_{coordinates.number}", "VEC2")
    colors = attribute("COLOR_0", "VEC3", "VEC4")
    turn, offset = coordinates.transform[:, :2], coordinates.transform[:, 2]
    joints, weights = _influences(document, fields, attributes, count, notes)
    whole = Primitive(
        positions=positions,
        normals=_unit_normals(positions, triangles, attribute("NORMAL", "VEC3")),
        uvs=np.zeros((count, 2)) if uvs is None else uvs @ turn.T + offset,
        colors=np.ones((count, 4)) if colors is None else _with_alpha(colors),
        joints=joints,
        weights=weights,
        triangles=triangles,
    )
    return _without_unused(whole)


def vertex_normals(positions: FloatArray, triangles: IntArray) -> FloatArray:
    """Average the face normals around each vertex by area.

    Parameters
    ----------
    positions
        (V, 3) float64.
    triangles
        (T, 3) indices, counter-clockwise seen from the front.

    Returns
    -------
    (V, 3) float64
        Unit vectors; +Y where all faces around a vertex are flat or cancel out.
    """
    corners = positions[triangles]
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sums = np.zeros_like(positions)
    for corner in range(3):
        for axis in range(3):
            sums[:, axis] += np.bincount(
                triangles[:, corner], weights=faces[:, axis], minlength=len(positions)
            )
    largest = np.abs(sums).max(axis=1, keepdims=True)
    sums = sums / np.where(largest > 0, largest, 1.0)
    length = np.linalg.norm(sums, axis=1, keepdims=True)
    return np.where(length > 0, sums / np.where(length > 0, length, 1.0), (0.0, 1.0, 0.0))


def _attributes(document: GltfDocument, fields: Fields) -> dict[str, int]:
    attributes = fields.child("attributes")
    count = len(document.items("accessors"))
    found = {}
    for name in attributes.values:
        index = attributes.index(name, count)
        if index is not None:
            found[name] = index
    return found


def _triangles(
    document: GltfDocument, fields: Fields, mode: int, count: int, notes: list[str]
) -> IntArray:
    """Corner indices (T, 3) of a list, a strip or a fan."""
    accessor = fields.index("indices", len(document.items("accessors")))
    if accessor is None:
        corners = np.arange(count, dtype=np.int64)
    else:
        corners = read_integers(document, accessor, "SCALAR")[:, 0]
        if corners.min() < 0 or corners.max() >= count:
            fields.fail(
                "indices", f"refer to vertex {corners.max()}, but the primitive has {count}"
            )
    if mode == TRIANGLES:
        if len(corners) % 3:
            notes.append(f"{fields.place}: its last triangle is incomplete and left out.")
        return corners[: len(corners) // 3 * 3].reshape(-1, 3)
    result: IntArray
    if mode == STRIP:
        result = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
        result[1::2] = result[1::2][:, [1, 0, 2]]
    else:
        result = np.stack(
            [corners[1:-1], corners[2:], np.full(max(len(corners) - 2, 0), corners[0])], axis=1
        )
    distinct: IntArray = result[(result != np.roll(result, 1, axis=1)).all(axis=1)]
    return distinct


def _influences(
    document: GltfDocument,
    fields: Fields,
    attributes: dict[str, int],
    count: int,
    notes: list[str],
) -> tuple[IntArray | None, FloatArray | None]:
    """Read all influences and keep the four largest of each vertex, renormalised."""
    sets = 0
    while f"JOINTS_{sets}" in attributes and f"WEIGHTS_{sets}" in attributes:
        sets += 1
    named = [name for name in attributes if name.startswith(("JOINTS_", "WEIGHTS_"))]
    if len(named) != 2 * sets:
        fields.fail("attributes", f"has {', '.join(sorted(named))[:80]}, which are not in pairs")
    if not sets:
        return None, None
    joints = np.hstack(
        [read_integers(document, attributes[f"JOINTS_{n}"], "VEC4") for n in range(sets)]
    )
    weights = np.hstack(
        [read_floats(document, attributes[f"WEIGHTS_{n}"], "VEC4") for n in range(sets)]
    )
    if len(joints) != count or len(weights) != count:
        fields.fail(
            "attributes",
            f"have {len(joints)} joints and {len(weights)} weights, but "
            f"POSITION has {count} elements",
        )
    if weights.min() < 0:
        row = int(np.argmin(weights.min(axis=1)))
        fields.fail("attributes", f"vertex {row} has a negative weight")
    many = int((np.count_nonzero(weights, axis=1) > INFLUENCES).sum())
    if many:
        notes.append(
            f"{fields.place}: {many} vertices have more than {INFLUENCES} influences; "
            "the largest are kept."
        )
    order = np.argsort(-weights, axis=1, kind="stable")[:, :INFLUENCES]
    joints = np.take_along_axis(joints, order, axis=1)
    weights = np.take_along_axis(weights, order, axis=1)
    total = weights.sum(axis=1, keepdims=True)
    nothing = total[:, 0] <= 0
    if nothing.any():
        notes.append(
            f"{fields.place}: {int(nothing.sum())} vertices have no weight; they follow the first "
            "joint that they name."
        )
    weights = np.where(total > 0, weights / np.where(total > 0, total, 1.0), (1.0, 0.0, 0.0, 0.0))
    joints = np.where(weights > 0, joints, joints[:, :1])
    return joints, weights


def _unit_normals(
    positions: FloatArray, triangles: IntArray, normals: FloatArray | None
) -> FloatArray:
    """Normals of unit length; absent and zero ones are computed."""
    if normals is None:
        return vertex_normals(positions, triangles)
    length: FloatArray = np.linalg.norm(normals, axis=1, keepdims=True)
    if (length > 0).all():
        return normals / length
    computed = vertex_normals(positions, triangles)
    return np.where(length > 0, normals / np.where(length > 0, length, 1.0), computed)


def _with_alpha(colors: FloatArray) -> FloatArray:
    if colors.shape[1] == 4:
        return colors
    return np.column_stack([colors, np.ones(len(colors))])


def _without_unused(primitive: Primitive) -> Primitive:
    """Drop vertices that no triangle uses: files often share one array among primitives."""
    used = np.zeros(len(primitive.positions), dtype=bool)
    used[primitive.triangles] = True
    if used.all():
        return primitive
    row = np.cumsum(used) - 1
    return Primitive(
        positions=primitive.positions[used],
        normals=primitive.normals[used],
        uvs=primitive.uvs[used],
        colors=primitive.colors[used],
        joints=None if primitive.joints is None else primitive.joints[used],
        weights=None if primitive.weights is None else primitive.weights[used],
        triangles=row[primitive.triangles],
    )

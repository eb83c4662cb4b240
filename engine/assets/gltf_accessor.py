"""Numbers out of buffers: stride, component types, normalised integers and sparse values.

glTF 2.0 specification, sections 3.6.2 (accessors) and 3.11 (normalised integers).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .gltf_document import GltfDocument
from .gltf_fields import Fields

COMPONENT_TYPES: dict[int, np.dtype[np.generic]] = {
    5120: np.dtype("i1"),
    5121: np.dtype("u1"),
    5122: np.dtype("<i2"),
    5123: np.dtype("<u2"),
    5125: np.dtype("<u4"),
    5126: np.dtype("<f4"),
}

WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}

MOST_VALUES = 2**27
"""Values of one accessor beyond which the file is refused: its count is surely wrong."""


def read_floats(document: GltfDocument, index: int, *kinds: str) -> NDArray[np.float64]:
    """Decode an accessor as numbers.

    Parameters
    ----------
    document
        The file.
    index
        Which accessor, already checked to exist.
    kinds
        The types that are allowed here, such as ``"VEC3"``.

    Returns
    -------
    (count, width) float64
        Normalised integers lie in [-1, 1]; a 4x4 matrix is 16 numbers, column by column.

    Raises
    ------
    AssetError
        If the accessor has another type, leaves its buffer or has values that are not finite.
    """
    fields = document.items("accessors")[index]
    raw = _decode(document, fields, kinds)
    values = raw.astype(np.float64)
    if raw.dtype.kind == "f":
        if not np.isfinite(values).all():
            row = int(np.flatnonzero(~np.isfinite(values).all(axis=1))[0])
            fields.fail("", f"element {row} is not finite")
    elif fields.flag("normalized"):
        values = np.maximum(values / np.iinfo(raw.dtype.str).max, -1.0)
    return values


def read_integers(document: GltfDocument, index: int, *kinds: str) -> NDArray[np.int64]:
    """Decode an accessor as (count, width) int64: vertex indices or joints.

    Raises
    ------
    AssetError
        As `read_floats`, and for floats or normalised integers.
    """
    fields = document.items("accessors")[index]
    raw = _decode(document, fields, kinds)
    if raw.dtype.kind == "f" or fields.flag("normalized"):
        fields.fail("componentType", "is not a plain integer type, but indices are needed here")
    return raw.astype(np.int64)


def _decode(document: GltfDocument, fields: Fields, kinds: tuple[str, ...]) -> NDArray[np.generic]:
    kind = fields.text("type")
    if kind not in WIDTHS:
        fields.fail("type", f"is '{kind[:20]}', which is no accessor type")
    if kind not in kinds:
        fields.fail("type", f"is {kind}, expected {' or '.join(kinds)}")
    dtype = _component_type(fields)
    count, width = fields.integer("count", low=1), WIDTHS[kind]
    if count * width > MOST_VALUES:
        fields.fail("count", f"is {count}, more than this reader accepts")
    view = fields.index("bufferView", len(document.items("bufferViews")))
    values: NDArray[np.generic]
    if view is None:
        values = np.zeros((count, width), dtype)
    else:
        values = _strided(document, fields, view, dtype, count, width)
    if "sparse" in fields:
        values = _with_sparse(document, fields.child("sparse"), values)
    return values


def _component_type(fields: Fields) -> np.dtype[np.generic]:
    number = fields.integer("componentType")
    if number not in COMPONENT_TYPES:
        fields.fail("componentType", f"is {number}, which is no component type")
    return COMPONENT_TYPES[number]


def _strided(
    document: GltfDocument,
    fields: Fields,
    view: int,
    dtype: np.dtype[np.generic],
    count: int,
    width: int,
) -> NDArray[np.generic]:
    """Return `count` rows of `width` values of a buffer view, without a copy."""
    data = document.view(view)
    start = fields.integer("byteOffset", 0)
    row = dtype.itemsize * width
    stride = document.items("bufferViews")[view].integer("byteStride", row, high=252)
    if stride < row:
        fields.fail("", f"has rows of {row} bytes, but buffer view {view} has a stride of {stride}")
    end = start + stride * (count - 1) + row
    if end > len(data):
        fields.fail("", f"ends at byte {end}, but buffer view {view} has {len(data)} bytes")
    return np.ndarray((count, width), dtype, data, start, (stride, dtype.itemsize))


def _with_sparse(
    document: GltfDocument, sparse: Fields, values: NDArray[np.generic]
) -> NDArray[np.generic]:
    """Replace the rows that a sparse accessor lists."""
    count = sparse.integer("count", low=1, high=len(values))
    parts = {}
    for name in ("indices", "values"):
        part = sparse.child(name)
        view = part.index("bufferView", len(document.items("bufferViews")))
        if view is None:
            part.fail("bufferView", "is missing")
        dtype = _component_type(part) if name == "indices" else values.dtype
        width = 1 if name == "indices" else values.shape[1]
        parts[name] = _strided(document, part, view, dtype, count, width)
    if parts["indices"].dtype.kind != "u":
        sparse.fail("indices.componentType", "is not an unsigned integer type")
    rows = parts["indices"][:, 0].astype(np.int64)
    if rows.max() >= len(values):
        sparse.fail("indices", f"refer to row {rows.max()}, but there are {len(values)}")
    changed = values.copy()
    changed[rows] = parts["values"]
    return changed

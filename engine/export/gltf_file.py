"""A glTF 2.0 file that is being put together: its tables and its binary chunk.

Buffer views are few: one for each attribute of a mesh and one for all keys, because a crowd has
tens of thousands of channels.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..assets.character import Material
from .paints import Paint
from .pixels import png, png_of_palette
from .shirts import Sheet, Shirt
from .targets import check_size, replacing

KINDS = (".glb", ".gltf")
ARRAY_BUFFER, ELEMENT_BUFFER = 34962, 34963
_COMPONENT = {"float32": 5126, "uint32": 5125, "uint16": 5123, "int16": 5122, "uint8": 5121}
_SHAPE = {(): "SCALAR", (2,): "VEC2", (3,): "VEC3", (4,): "VEC4", (4, 4): "MAT4"}
_KEYS = -1
_SMALLEST_ALPHA = 128
_TO_THE_EDGE = {"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071}
"""Linear, with mipmaps; what is beyond the edge is as the edge."""


class GltfFile:
    """Tables of a file, and the arrays that they refer to.

    Attributes
    ----------
    nodes, meshes, skins, animations
        As in the file.
    roots
        Nodes of the scene.
    """

    def __init__(self, name: str) -> None:
        self.nodes: list[dict[str, Any]] = []
        self.meshes: list[dict[str, Any]] = []
        self.skins: list[dict[str, Any]] = []
        self.animations: list[dict[str, Any]] = []
        self.roots: list[int] = []
        self._name = name
        self._tables: dict[str, list[dict[str, Any]]] = {}
        self._accessors: list[dict[str, Any]] = []
        self._views: list[dict[str, Any]] = []
        self._data, self._keys = bytearray(), bytearray()

    def __len__(self) -> int:
        """Bytes of the arrays so far."""
        return len(self._data) + len(self._keys)

    def add_node(self, node: dict[str, Any]) -> int:
        """Append a node; its index."""
        self.nodes.append(node)
        return len(self.nodes) - 1

    def add(
        self,
        values: NDArray[Any],
        *,
        target: int | None = ARRAY_BUFFER,
        bounds: bool = False,
        normalized: bool = False,
    ) -> int:
        """Append an array (N, ...) in a view of its own; the index of its accessor."""
        packed = _little(values)
        view = self._add_view(packed.tobytes())
        if target is not None:
            self._views[view]["target"] = target
        return self._add_accessor(packed, view, 0, bounds=bounds, normalized=normalized)

    def add_keys(self, values: NDArray[Any], *, bounds: bool = False) -> int:
        """Append times or values of an animation, 16-bit integers normalised; their accessor."""
        packed = _little(values)
        place = len(self._keys)
        self._keys += packed.tobytes()
        whole = packed.dtype.kind == "i"
        return self._add_accessor(packed, _KEYS, place, bounds=bounds, normalized=whole)

    def add_materials(
        self, paints: Sequence[Paint], materials: Sequence[Material], sheet: Sheet | None
    ) -> None:
        """Write all paints, in their order, with the pictures that they show.

        Those of patterned shirts lie on `sheet`.
        """
        pictures: dict[int | Shirt, int] = {}
        for paint in paints:
            material = materials[paint.material]
            surface: dict[str, Any] = {
                "baseColorFactor": list(paint.color),
                "metallicFactor": 0.0,
                "roughnessFactor": 0.9,
            }
            entry: dict[str, Any] = {"name": paint.name, "pbrMetallicRoughness": surface}
            if material.image is not None:
                if paint.material not in pictures:
                    pictures[paint.material] = self._add_picture(png(material.image))
                surface["baseColorTexture"] = {"index": pictures[paint.material]}
                if material.image[..., 3].min() < _SMALLEST_ALPHA:
                    entry["alphaMode"] = "MASK"
            elif paint.shirt is not None and sheet is not None:
                if paint.shirt not in pictures:
                    content = png_of_palette(*sheet.picture(paint.shirt))
                    pictures[paint.shirt] = self._add_picture(content, sampler=_TO_THE_EDGE)
                surface["baseColorTexture"] = {"index": pictures[paint.shirt]}
                if paint.coordinates:
                    surface["baseColorTexture"]["texCoord"] = paint.coordinates
            if material.double_sided:
                entry["doubleSided"] = True
            self._table("materials").append(entry)

    def write(self, path: Path) -> int:
        """Write a ``.glb``, or a ``.gltf`` with its ``.bin`` beside it; bytes written.

        Raises
        ------
        AssetError
            If it would be too large, or can't be written.
        """
        if self._keys:
            view = self._add_view(bytes(self._keys))
            for accessor in self._accessors:
                if accessor["bufferView"] == _KEYS:
                    accessor["bufferView"] = view
        self._data += b"\0" * (-len(self._data) % 4)
        advice = "export fewer agents, a shorter time, or a coarser level"
        check_size(path, len(self._data), advice)
        buffer: dict[str, Any] = {"byteLength": len(self._data)}
        split = path.suffix.lower() == ".gltf"
        beside = path.with_suffix(".bin")
        if split:
            buffer["uri"] = beside.name
        text = json.dumps(self._document(buffer), separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        if split:
            with replacing(beside) as part:
                part.write_bytes(self._data)
            with replacing(path) as part:
                part.write_bytes(text)
            return len(text) + len(self._data)
        size = 28 + len(text) + len(self._data)
        check_size(path, size, advice)
        with replacing(path) as part, part.open("wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, size))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", len(self._data), b"BIN\0"))
            file.write(self._data)
        return size

    def _document(self, buffer: dict[str, Any]) -> dict[str, Any]:
        document: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "tifo"},
            "scene": 0,
            "scenes": [{"name": self._name, "nodes": self.roots}],
            "buffers": [buffer],
        }
        tables = {
            "nodes": self.nodes,
            "meshes": self.meshes,
            "skins": self.skins,
            "animations": self.animations,
            "accessors": self._accessors,
            "bufferViews": self._views,
            **self._tables,
        }
        # Empty lists are not allowed.
        return document | {name: table for name, table in tables.items() if table}

    def _table(self, name: str) -> list[dict[str, Any]]:
        return self._tables.setdefault(name, [])

    def _add_picture(self, content: bytes, *, sampler: dict[str, int] | None = None) -> int:
        """Write a PNG file and how it is read; the index of its texture."""
        view = self._add_view(content)
        self._table("images").append({"bufferView": view, "mimeType": "image/png"})
        texture = {"source": len(self._table("images")) - 1}
        if sampler is not None:
            samplers = self._table("samplers")
            if sampler not in samplers:
                samplers.append(sampler)
            texture["sampler"] = samplers.index(sampler)
        self._table("textures").append(texture)
        return len(self._table("textures")) - 1

    def _add_view(self, content: bytes) -> int:
        self._data += b"\0" * (-len(self._data) % 4)
        self._views.append({"buffer": 0, "byteOffset": len(self._data), "byteLength": len(content)})
        self._data += content
        return len(self._views) - 1

    def _add_accessor(
        self, values: NDArray[Any], view: int, place: int, *, bounds: bool, normalized: bool
    ) -> int:
        accessor: dict[str, Any] = {
            "bufferView": view,
            "componentType": _COMPONENT[values.dtype.name],
            "count": len(values),
            "type": _SHAPE[values.shape[1:]],
        }
        if place:
            accessor["byteOffset"] = place
        if normalized:
            accessor["normalized"] = True
        if bounds:
            accessor["min"] = np.atleast_1d(values.min(axis=0)).tolist()
            accessor["max"] = np.atleast_1d(values.max(axis=0)).tolist()
        self._accessors.append(accessor)
        return len(self._accessors) - 1


def exact(values: ArrayLike) -> list[float]:
    """float32 numbers as the shortest text that reads back as the same."""
    return [float(str(value)) for value in np.asarray(values, np.float32)]


def _little(values: NDArray[Any]) -> NDArray[Any]:
    packed = np.ascontiguousarray(values)
    return packed.astype(packed.dtype.newbyteorder("<"), copy=False)

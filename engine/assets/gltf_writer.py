"""Write a character as a binary glTF 2.0 file: skinned meshes, materials and animations.

Used to ship the built-in spectator and to export characters. Levels of detail are written as
further meshes whose names end in ``_LOD1``, ``_LOD2`` and so on, as most tools expect; each level
has a skin of its own over the same joints, so that readers which merge the meshes of a skin keep
the levels apart. `levels.grouped_by_level` is the way back.
"""

from __future__ import annotations

import io
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..animation.clip import Clip
from ..animation.skeleton import Skeleton
from .character import Character, Material, SkinnedMesh
from .levels import level_name
from .variants import variant_extras

THINNING = 0.003
"""Radians and metres by which a key may lie off the way between its neighbours to be left out."""

THINNED_SECONDS = 1.5
"""Shorter clips keep all keys: they are quick motions, and small."""

_REST_TOLERANCE = 1e-6
_KEYS = -1
"""Stands for the view of all keys until the file is finished."""
_ARRAY_BUFFER, _ELEMENT_BUFFER = 34962, 34963
_COMPONENT = {"float32": 5126, "uint32": 5125, "uint16": 5123, "int16": 5122, "uint8": 5121}
_SHAPE = {(): "SCALAR", (2,): "VEC2", (3,): "VEC3", (4,): "VEC4", (4, 4): "MAT4"}


class _Buffer:
    """The file's binary chunk and the accessors into it."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.keys = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def add(
        self,
        values: NDArray[Any],
        *,
        target: int | None = None,
        bounds: bool = False,
        normalized: bool = False,
    ) -> int:
        """Append an array (N, ...) and return the index of its accessor."""
        packed = np.ascontiguousarray(values)
        if packed.dtype.byteorder == ">":
            packed = packed.astype(packed.dtype.newbyteorder("<"))
        self.data += b"\0" * (-len(self.data) % 4)
        view: dict[str, Any] = {
            "buffer": 0,
            "byteOffset": len(self.data),
            "byteLength": packed.nbytes,
        }
        if target is not None:
            view["target"] = target
        self.data += packed.tobytes()
        accessor: dict[str, Any] = {
            "bufferView": len(self.views),
            "componentType": _COMPONENT[packed.dtype.name],
            "count": len(packed),
            "type": _SHAPE[packed.shape[1:]],
        }
        if normalized:
            accessor["normalized"] = True
        if bounds:
            accessor["min"] = np.atleast_1d(packed.min(axis=0)).tolist()
            accessor["max"] = np.atleast_1d(packed.max(axis=0)).tolist()
        self.views.append(view)
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def add_keys(self, values: NDArray[Any], *, normalized: bool = False) -> int:
        """Append an array (N, ...) to a view that all keys share, and return its accessor.

        One view for thousands of channels keeps the file's text short.
        """
        packed = np.ascontiguousarray(values)
        accessor: dict[str, Any] = {
            "bufferView": _KEYS,
            "byteOffset": len(self.keys),
            "componentType": _COMPONENT[packed.dtype.name],
            "count": len(packed),
            "type": _SHAPE[packed.shape[1:]],
        }
        if normalized:
            accessor["normalized"] = True
        if packed.ndim == 1:
            accessor["min"], accessor["max"] = [float(packed[0])], [float(packed[-1])]
        self.keys += packed.astype(packed.dtype.newbyteorder("<")).tobytes()
        self.keys += b"\0" * (-len(self.keys) % 4)
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def finish(self) -> None:
        """Append the view of the keys, if there are any."""
        if not self.keys:
            return
        view = self.add_bytes(bytes(self.keys))
        for accessor in self.accessors:
            if accessor["bufferView"] == _KEYS:
                accessor["bufferView"] = view

    def add_bytes(self, content: bytes) -> int:
        """Append a file, such as an image, and return the index of its view."""
        self.data += b"\0" * (-len(self.data) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(content)})
        self.data += content
        return len(self.views) - 1


def character_to_glb(character: Character, *, compact: bool = False) -> bytes:
    """Encode a character as a .glb file.

    Parameters
    ----------
    character
        Its meshes get one glTF mesh and node each, with one skin per level. Colours are stored as
        normalised bytes where that loses nothing above 1, joints as bytes where they fit.
        Animation channels are left out where a clip keeps a joint at its rest transform; clips
        that do not loop get ``extras: {"looping": false}``, meshes of variants theirs; see
        `variants`.
    compact
        Whether turns are stored as normalised 16-bit integers (off by 0.002 degrees at most), and
        of channels that lose less than `THINNING` by it only every second key, in clips of
        `THINNED_SECONDS` and more.

    Returns
    -------
    bytes
        The whole file, version 2.0, little endian.
    """
    buffer = _Buffer()
    skeleton = character.skeleton
    nodes = _joint_nodes(skeleton)
    document: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": "tifo"},
        "scene": 0,
    }
    roots = [index for index, parent in enumerate(skeleton.parents) if parent < 0]
    meshes: list[dict[str, Any]] = []
    for level, members in enumerate((character.meshes, *character.lower_levels)):
        for mesh in members:
            name = level_name(mesh.name, level)
            roots.append(len(nodes))
            node = {"name": name, "mesh": len(meshes), "skin": level}
            if mesh.variant is not None:
                node["extras"] = variant_extras(mesh.variant)
            nodes.append(node)
            meshes.append({"name": name, "primitives": [_primitive(buffer, mesh)]})
    document["scenes"] = [{"name": character.name, "nodes": roots}]
    document["nodes"] = nodes
    if meshes:
        document["meshes"] = meshes
    skin = _skin(buffer, skeleton)
    document["skins"] = [
        {"name": level_name(character.name, level), **skin}
        for level in range(1 + len(character.lower_levels))
    ]
    if character.materials:
        _write_materials(buffer, document, character.materials)
    if character.clips:
        document["animations"] = [
            _animation(buffer, clip, skeleton, compact=compact) for clip in character.clips
        ]
    buffer.finish()
    document["accessors"] = buffer.accessors
    document["bufferViews"] = buffer.views
    document["buffers"] = [{"byteLength": len(buffer.data)}]
    return _pack(document, bytes(buffer.data))


def write_glb(character: Character, path: str | Path, *, compact: bool = False) -> None:
    """Write a character to a .glb file; see `character_to_glb`."""
    Path(path).write_bytes(character_to_glb(character, compact=compact))


def _pack(document: dict[str, Any], binary: bytes) -> bytes:
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    if binary:
        chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _joint_nodes(skeleton: Skeleton) -> list[dict[str, Any]]:
    nodes: list[dict[str, Any]] = []
    for joint, name in enumerate(skeleton.names):
        node: dict[str, Any] = {"name": name}
        for key, value, neutral in (
            ("translation", skeleton.rest_translation[joint], (0, 0, 0)),
            ("rotation", skeleton.rest_rotation[joint], (0, 0, 0, 1)),
            ("scale", skeleton.rest_scale[joint], (1, 1, 1)),
        ):
            if not np.array_equal(value, neutral):
                node[key] = value.tolist()
        children = np.flatnonzero(skeleton.parents == joint).tolist()
        if children:
            node["children"] = children
        nodes.append(node)
    return nodes


def _skin(buffer: _Buffer, skeleton: Skeleton) -> dict[str, Any]:
    inverse_bind = np.tile(np.eye(4, dtype=np.float32), (skeleton.joint_count, 1, 1))
    inverse_bind[:, :3] = skeleton.inverse_bind
    columns = buffer.add(inverse_bind.transpose(0, 2, 1))
    joints = list(range(skeleton.joint_count))
    return {"joints": joints, "inverseBindMatrices": columns}


def _primitive(buffer: _Buffer, mesh: SkinnedMesh) -> dict[str, Any]:
    def vertices(values: NDArray[Any], **options: bool) -> int:
        return buffer.add(values, target=_ARRAY_BUFFER, **options)

    attributes = {
        "POSITION": vertices(mesh.positions.astype(np.float32), bounds=True),
        "NORMAL": vertices(mesh.normals.astype(np.float32)),
    }
    if mesh.uvs.any():
        attributes["TEXCOORD_0"] = vertices(mesh.uvs.astype(np.float32))
    if not (mesh.colors == 1).all():
        if mesh.colors.min() >= 0 and mesh.colors.max() <= 1:
            bytes_ = np.rint(mesh.colors * 255).astype(np.uint8)
            attributes["COLOR_0"] = vertices(bytes_, normalized=True)
        else:
            attributes["COLOR_0"] = vertices(mesh.colors.astype(np.float32))
    few = mesh.joints.size == 0 or mesh.joints.max() < 256
    attributes["JOINTS_0"] = vertices(mesh.joints.astype(np.uint8 if few else np.uint16))
    attributes["WEIGHTS_0"] = vertices(mesh.weights.astype(np.float32))
    # 0xFFFF would restart the primitive, so it is not used as an index.
    small = len(mesh.positions) <= 0xFFFF
    indices = mesh.triangles.reshape(-1).astype(np.uint16 if small else np.uint32)
    return {
        "attributes": attributes,
        "indices": buffer.add(indices, target=_ELEMENT_BUFFER),
        "material": mesh.material,
    }


def _write_materials(
    buffer: _Buffer, document: dict[str, Any], materials: tuple[Material, ...]
) -> None:
    written: list[dict[str, Any]] = []
    images: list[dict[str, Any]] = []
    for material in materials:
        surface: dict[str, Any] = {
            "baseColorFactor": list(material.base_color),
            "metallicFactor": 0.0,
            "roughnessFactor": 0.9,
        }
        if material.image is not None:
            surface["baseColorTexture"] = {"index": len(images)}
            view = buffer.add_bytes(_png(material.image))
            images.append({"bufferView": view, "mimeType": "image/png"})
        entry: dict[str, Any] = {"name": material.name, "pbrMetallicRoughness": surface}
        if material.double_sided:
            entry["doubleSided"] = True
        written.append(entry)
    document["materials"] = written
    if images:
        document["images"] = images
        document["textures"] = [{"source": index} for index in range(len(images))]


def _png(image: NDArray[np.uint8]) -> bytes:
    from PIL import Image

    content = io.BytesIO()
    Image.fromarray(image, "RGBA").save(content, "PNG")
    return content.getvalue()


def _animation(buffer: _Buffer, clip: Clip, skeleton: Skeleton, *, compact: bool) -> dict[str, Any]:
    times = np.linspace(0.0, clip.duration, clip.frame_count).astype(np.float32)
    clocks = {0: buffer.add_keys(times[:1]), 1: buffer.add_keys(times)}
    thinned = compact and clip.duration >= THINNED_SECONDS
    if thinned:
        clocks[2] = buffer.add_keys(times[::2])
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []
    for path, values, rest in (
        ("rotation", clip.rotation, skeleton.rest_rotation),
        ("translation", clip.translation, skeleton.rest_translation),
        ("scale", clip.scale, skeleton.rest_scale),
    ):
        small = compact and path == "rotation"
        for joint in range(skeleton.joint_count):
            keys = values[:, joint].astype(np.float32)
            if np.abs(keys - rest[joint]).max() <= _REST_TOLERANCE:
                continue
            # A single key, every second one, or all.
            every = 1
            if np.ptp(keys, axis=0).max() <= _REST_TOLERANCE:
                keys, every = keys[:1], 0
            elif thinned and _is_thinnable(keys, THINNING / 2 if small else THINNING):
                keys, every = keys[::2], 2
            output = buffer.add_keys(_as_shorts(keys) if small else keys, normalized=small)
            channels.append({"sampler": len(samplers), "target": {"node": joint, "path": path}})
            samplers.append({"input": clocks[every], "output": output})
    if not channels:
        # A file needs a channel; the root at rest keeps the clip and its duration.
        root = np.repeat(skeleton.rest_translation[:1], len(times), axis=0)
        samplers.append({"input": clocks[1], "output": buffer.add_keys(root)})
        channels.append({"sampler": 0, "target": {"node": 0, "path": "translation"}})
    animation: dict[str, Any] = {"name": clip.name, "samplers": samplers, "channels": channels}
    if not clip.looping:
        animation["extras"] = {"looping": False}
    return animation


def _as_shorts(keys: NDArray[np.float32]) -> NDArray[np.int16]:
    """Unit quaternions (K, 4) as normalised 16-bit integers."""
    result: NDArray[np.int16] = np.rint(np.clip(keys, -1.0, 1.0) * 32767).astype(np.int16)
    return result


def _is_thinnable(keys: NDArray[np.float32], limit: float) -> bool:
    """Whether every second of (F, n) keys lies so near the middle of its neighbours.

    The limit for quaternions is half of the angle, which is what they differ by.
    """
    if len(keys) < 5 or len(keys) % 2 == 0:
        return False
    exact = keys.astype(np.float64)
    middle = (exact[:-2:2] + exact[2::2]) / 2
    return bool(np.linalg.norm(middle - exact[1::2], axis=-1).max() <= limit)

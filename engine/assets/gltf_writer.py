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

_REST_TOLERANCE = 1e-6
_ARRAY_BUFFER, _ELEMENT_BUFFER = 34962, 34963
_COMPONENT = {"float32": 5126, "uint32": 5125, "uint16": 5123, "uint8": 5121}
_SHAPE = {(): "SCALAR", (2,): "VEC2", (3,): "VEC3", (4,): "VEC4", (4, 4): "MAT4"}


class _Buffer:
    """The file's binary chunk and the accessors into it."""

    def __init__(self) -> None:
        self.data = bytearray()
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

    def add_bytes(self, content: bytes) -> int:
        """Append a file, such as an image, and return the index of its view."""
        self.data += b"\0" * (-len(self.data) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(content)})
        self.data += content
        return len(self.views) - 1


def character_to_glb(character: Character) -> bytes:
    """Encode a character as a .glb file.

    Parameters
    ----------
    character
        Its meshes get one glTF mesh and node each, with one skin per level. Colours are stored as
        normalised bytes where that loses nothing above 1, joints as bytes where they fit.
        Animation channels are left out where a clip keeps a joint at its rest transform; clips
        that do not loop get ``extras: {"looping": false}``.

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
            nodes.append({"name": name, "mesh": len(meshes), "skin": level})
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
        document["animations"] = [_animation(buffer, clip, skeleton) for clip in character.clips]
    document["accessors"] = buffer.accessors
    document["bufferViews"] = buffer.views
    document["buffers"] = [{"byteLength": len(buffer.data)}]
    return _pack(document, bytes(buffer.data))


def write_glb(character: Character, path: str | Path) -> None:
    """Write a character to a .glb file; see `character_to_glb`."""
    Path(path).write_bytes(character_to_glb(character))


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


def _animation(buffer: _Buffer, clip: Clip, skeleton: Skeleton) -> dict[str, Any]:
    times = np.linspace(0.0, clip.duration, clip.frame_count).astype(np.float32)
    clock = buffer.add(times, bounds=True)
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []
    for path, values, rest in (
        ("rotation", clip.rotation, skeleton.rest_rotation),
        ("translation", clip.translation, skeleton.rest_translation),
        ("scale", clip.scale, skeleton.rest_scale),
    ):
        for joint in range(skeleton.joint_count):
            keys = values[:, joint].astype(np.float32)
            if np.abs(keys - rest[joint]).max() <= _REST_TOLERANCE:
                continue
            if np.ptp(keys, axis=0).max() <= _REST_TOLERANCE:
                source = {
                    "input": buffer.add(times[:1], bounds=True),
                    "output": buffer.add(keys[:1]),
                }
            else:
                source = {"input": clock, "output": buffer.add(keys)}
            channels.append({"sampler": len(samplers), "target": {"node": joint, "path": path}})
            samplers.append({**source, "interpolation": "LINEAR"})
    if not channels:
        # A file needs a channel; the root at rest keeps the clip and its duration.
        still = np.repeat(skeleton.rest_translation[:1], clip.frame_count, axis=0)
        samplers.append({"input": clock, "output": buffer.add(still), "interpolation": "LINEAR"})
        channels.append({"sampler": 0, "target": {"node": 0, "path": "translation"}})
    animation: dict[str, Any] = {"name": clip.name, "samplers": samplers, "channels": channels}
    if not clip.looping:
        animation["extras"] = {"looping": False}
    return animation

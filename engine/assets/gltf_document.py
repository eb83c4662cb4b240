"""The container of a glTF 2.0 file: GLB or JSON, its buffers and its references.

glTF 2.0 specification, sections 3.2 (JSON), 3.6.1 (buffers and views) and 4 (GLB). What the
accessors in the buffers mean is the business of `gltf_accessor`.
"""

from __future__ import annotations

import base64
import binascii
import json
import struct
from functools import cached_property
from pathlib import Path
from typing import NoReturn
from urllib.parse import unquote, unquote_to_bytes

from ..errors import AssetError
from .gltf_fields import Fields

GLB_MAGIC = b"glTF"
JSON_CHUNK = 0x4E4F534A
BINARY_CHUNK = 0x004E4942

HARMLESS_EXTENSIONS = frozenset(
    {"KHR_lights_punctual", "KHR_mesh_quantization", "KHR_texture_transform", "KHR_xmp_json_ld"}
)
"""Extensions beside the KHR_materials_* family that a file may require of this reader."""


class GltfDocument:
    """A glTF file with its buffers in memory.

    Parameters
    ----------
    path
        A .glb or .gltf file; which one it is shows from its first bytes, not from its name.

    Raises
    ------
    AssetError
        If the file can't be read, is cut off, is no glTF 2.0 or requires an extension that this
        reader doesn't have.
    """

    def __init__(self, path: str | Path) -> None:
        """Read the file and all of its buffers."""
        self.path = Path(path)
        text, self._binary = _split_container(self.path, _read_file(self.path, self.path, ""))
        self.root = Fields(self.path, "", _parse(self.path, text))
        self._lists: dict[str, list[Fields]] = {}
        self._views: dict[int, memoryview] = {}
        self._check_version()
        self._check_extensions()
        self.buffers: list[memoryview | None] = [
            self._load_buffer(k, fields) for k, fields in enumerate(self.items("buffers"))
        ]

    def items(self, name: str) -> list[Fields]:
        """Return the objects of a top-level list such as ``"nodes"``."""
        if name not in self._lists:
            self._lists[name] = self.root.children(name)
        return self._lists[name]

    def fail(self, place: str, cause: str) -> NoReturn:
        """Raise an AssetError at a place of this file."""
        raise AssetError(self.path, place, cause)

    def view(self, index: int) -> memoryview:
        """Return the bytes of buffer view `index`."""
        if index not in self._views:
            fields = self.items("bufferViews")[index]
            number = fields.index("buffer", len(self.buffers))
            if number is None:
                fields.fail("buffer", "is missing")
            data = self.buffers[number]
            if data is None:
                self.fail(f"buffers[{number}]", "has no data: neither a uri nor a binary chunk")
            start = fields.integer("byteOffset", 0)
            stop = start + fields.integer("byteLength")
            if stop > len(data):
                fields.fail("", f"ends at byte {stop}, but buffer {number} has {len(data)} bytes")
            self._views[index] = data[start:stop]
        return self._views[index]

    def resource(self, uri: str, place: str) -> bytes:
        """Read what a URI names: inline data or a file beside this one.

        Raises
        ------
        AssetError
            For an absolute or remote address, a missing file or broken inline data.
        """
        if uri[:5].lower() == "data:":
            return self._inline(uri, place)
        name = unquote(uri)
        if ":" in name.split("/")[0] or name.startswith(("/", "\\")):
            self.fail(place, f"'{name[:60]}' is not an address relative to the file")
        return _read_file(self.path, self.path.parent / name, place)

    @cached_property
    def scene_roots(self) -> list[int]:
        """Nodes at the top of the scene that a viewer shows; all roots where none is named."""
        nodes, scenes = self.items("nodes"), self.items("scenes")
        index = self.root.index("scene", len(scenes))
        if scenes:
            return scenes[index or 0].indices("nodes", len(nodes))
        below = {child for node in nodes for child in node.indices("children", len(nodes))}
        return [k for k in range(len(nodes)) if k not in below]

    def _inline(self, uri: str, place: str) -> bytes:
        header, comma, data = uri.partition(",")
        if not comma:
            self.fail(place, "inline data has no comma")
        if not header.lower().endswith(";base64"):
            return unquote_to_bytes(data)
        try:
            return base64.b64decode(unquote(data), validate=True)
        except (binascii.Error, ValueError):
            self.fail(place, "inline data is not valid base64")

    def _load_buffer(self, index: int, fields: Fields) -> memoryview | None:
        length = fields.integer("byteLength")
        if "uri" in fields:
            data = self.resource(fields.text("uri"), fields.at("uri"))
        elif index == 0 and self._binary is not None:
            data = self._binary
        else:
            return None
        if len(data) < length:
            fields.fail("byteLength", f"is {length}, but there are {len(data)} bytes")
        return memoryview(data)[:length]

    def _check_version(self) -> None:
        asset = self.root.child("asset")
        version, least = asset.text("version"), asset.text("minVersion", "2.0")
        if not version:
            self.fail("asset.version", "is missing, so this is not a glTF 2.0 file")
        if not version.startswith("2.") or least != "2.0":
            self.fail("asset.version", f"is {version[:20]}, but only glTF 2.0 can be read")

    def _check_extensions(self) -> None:
        for name in self.root.texts("extensionsRequired"):
            if name not in HARMLESS_EXTENSIONS and not name.startswith("KHR_materials_"):
                self.fail(
                    "extensionsRequired",
                    f"the extension {name[:80]} is not supported; export the file without it",
                )


def _read_file(document: Path, path: Path, place: str) -> bytes:
    """Read a regular file whole; a device or a pipe could keep the reader waiting for ever."""
    try:
        if not path.is_file():
            cause = "is not a file" if path.exists() else "there is no such file"
            raise AssetError(document, place, f"'{path.name}': {cause}" if place else cause)
        return path.read_bytes()
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise AssetError(document, place, f"can't be read: {reason}") from None


def _split_container(path: Path, data: bytes) -> tuple[bytes, bytes | None]:
    """Return the JSON text and, of a GLB, the binary chunk."""
    if not data:
        raise AssetError(path, "", "is empty")
    if data[:4] != GLB_MAGIC:
        return data, None
    if len(data) < 12:
        raise AssetError(path, "header", "is cut off")
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2:
        raise AssetError(path, "header", f"is GLB version {version}, but only 2 can be read")
    if length > len(data):
        raise AssetError(path, "header", f"says {length} bytes, but the file has {len(data)}")
    text: bytes | None = None
    binary: bytes | None = None
    start = 12
    while start < length:
        if start + 8 > length:
            raise AssetError(path, f"byte {start}", "a chunk header is cut off")
        size, kind = struct.unpack_from("<II", data, start)
        start += 8
        if start + size > length:
            raise AssetError(path, f"byte {start - 8}", f"a chunk of {size} bytes is cut off")
        if text is None and kind != JSON_CHUNK:
            raise AssetError(path, f"byte {start - 8}", "the first chunk is not JSON")
        if text is None:
            text = data[start : start + size]
        elif kind == BINARY_CHUNK and binary is None:
            binary = data[start : start + size]
        start += size
    if text is None:
        raise AssetError(path, "", "has no JSON chunk")
    return text, binary


def _parse(path: Path, text: bytes) -> object:
    try:
        return json.loads(text.decode("utf-8-sig"), parse_constant=_no_constant)
    except json.JSONDecodeError as error:
        raise AssetError(path, f"line {error.lineno}", f"is not valid JSON: {error.msg}") from None
    except UnicodeDecodeError:
        raise AssetError(path, "", "is neither a GLB file nor JSON in UTF-8") from None
    except (ValueError, RecursionError) as error:
        cause = "nested too deeply" if isinstance(error, RecursionError) else str(error)
        raise AssetError(path, "", f"is not valid JSON: {cause}") from None


def _no_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is not a JSON number")

"""Materials of a glTF file: the base colour and its texture.

Only what `Material` holds is read. Pillow is imported when the first image is decoded.
"""

from __future__ import annotations

import io
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .character import Material
from .gltf_document import GltfDocument
from .gltf_fields import Fields

MOST_PIXELS = 2**26
"""Pixels of one image beyond which it is dropped: 8192 x 8192."""


@dataclass(frozen=True, slots=True, eq=False)
class TextureCoordinates:
    """Which texture coordinates a material uses, and how KHR_texture_transform changes them.

    Parameters
    ----------
    number
        n of ``TEXCOORD_n``.
    transform
        (2, 3) float64: the affine map from the file's coordinates to those of the image.
    """

    number: int = 0
    transform: NDArray[np.float64] = field(default_factory=lambda: np.eye(2, 3))


class MaterialReader:
    """Reads the materials that are used, each once, and decodes each image once.

    Parameters
    ----------
    document
        The file.
    """

    def __init__(self, document: GltfDocument) -> None:
        """Start with no material."""
        self._document = document
        self._rows: dict[int | None, int] = {}
        self._images: dict[int, NDArray[np.uint8] | None] = {}
        self.materials: list[Material] = []
        self.notes: list[str] = []

    def row(self, index: int | None) -> int:
        """Row in `materials` of the file's material `index`, or of the default for None."""
        if index not in self._rows:
            self._rows[index] = len(self.materials)
            self.materials.append(Material("default") if index is None else self._read(index))
        return self._rows[index]

    def coordinates(self, index: int | None) -> TextureCoordinates:
        """Find out how the file's material `index` uses texture coordinates."""
        if index is None:
            return TextureCoordinates()
        texture = self._texture(self._document.items("materials")[index])
        number = texture.integer("texCoord", 0)
        extension = texture.child("extensions").child("KHR_texture_transform")
        number = extension.integer("texCoord", number)
        angle = extension.number("rotation", 0.0)
        cos, sin = np.cos(angle), np.sin(angle)
        scale = extension.numbers("scale", (1, 1))
        turn = np.array([[cos, sin], [-sin, cos]]) * scale
        offset = extension.numbers("offset", (0, 0))
        return TextureCoordinates(number, np.column_stack([turn, offset]))

    def _read(self, index: int) -> Material:
        fields = self._document.items("materials")[index]
        name = fields.text("name") or f"material {index}"
        surface = fields.child("pbrMetallicRoughness")
        red, green, blue, alpha = surface.numbers("baseColorFactor", (1, 1, 1, 1)).tolist()
        mode = fields.text("alphaMode", "OPAQUE")
        if mode != "OPAQUE":
            self.notes.append(f"Material '{name}': its alpha mode {mode[:20]} is not kept.")
        return Material(
            name=name,
            base_color=(red, green, blue, alpha),
            image=self._base_image(name, self._texture(fields)),
            double_sided=fields.flag("doubleSided"),
        )

    def _texture(self, material: Fields) -> Fields:
        return material.child("pbrMetallicRoughness").child("baseColorTexture")

    def _base_image(self, name: str, reference: Fields) -> NDArray[np.uint8] | None:
        textures, images = self._document.items("textures"), self._document.items("images")
        texture = reference.index("index", len(textures))
        if texture is None:
            return None
        source = textures[texture].index("source", len(images))
        if source is None:
            self.notes.append(f"Material '{name}': its texture has no image that can be read.")
            return None
        if source not in self._images:
            self._images[source] = self._decode(source, images[source])
        return self._images[source]

    def _decode(self, index: int, fields: Fields) -> NDArray[np.uint8] | None:
        """Decode an image; one that can't be is noted and leaves the plain factor."""
        view = fields.index("bufferView", len(self._document.items("bufferViews")))
        if view is not None:
            data = bytes(self._document.view(view))
        else:
            data = self._document.resource(fields.text("uri"), fields.at("uri"))
        from PIL import Image

        try:
            with Image.open(io.BytesIO(data)) as image:
                if image.width * image.height > MOST_PIXELS:
                    raise ValueError(f"{image.width} x {image.height} pixels are too many")
                return np.array(image.convert("RGBA"), dtype=np.uint8)
        # Pillow's decoders raise whatever their format's parser does: OSError, SyntaxError,
        # struct.error, IndexError and more. A broken picture must not cost the character.
        except Exception as error:
            self.notes.append(f"Image {index} can't be decoded and is left out: {error}.")
            return None

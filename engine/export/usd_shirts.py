"""Patterned shirts in USD: a picture for each pattern, and a material for each pair of colours."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..assets.character import SkinnedMesh
from ..crowd.kits import PATTERNS
from ..crowd.regions import SURFACES
from .pixels import png, to_linear
from .recording import Recording
from .shirts import Sheet, lay_sheet
from .targets import replacing
from .usd_body import add_reader, add_surface_shader
from .usd_layer import Layer

COORDINATES = "shirtSt"
"""Primvar of where a vertex is on the pictures."""


class ShirtMaterials:
    """Materials of patterned shirts of one file, made when they are first needed.

    A preview surface reads the share of the second colour from a picture, and as texture scale and
    bias turn it into the two colours, in linear light.

    Parameters
    ----------
    layer, folder
        Where materials are written.
    recording, meshes
        Who wears what.
    path
        The file, beside which the pictures are written.

    Attributes
    ----------
    images
        Names of these pictures, by number of the pattern.
    """

    def __init__(
        self,
        layer: Layer,
        folder: str,
        recording: Recording,
        meshes: tuple[SkinnedMesh, ...],
        path: Path,
    ) -> None:
        self._layer, self._folder, self._recording = layer, folder, recording
        self._sheet = lay_sheet(recording, meshes)
        self._made: set[str] = set()
        self.images: dict[int, str] = {}
        if self._sheet is None:
            return
        for pattern in np.unique(recording.pattern[recording.patterned]).tolist():
            self.images[pattern] = _write_mask(path, self._sheet, pattern)

    def covers(self, mesh: SkinnedMesh) -> bool:
        """Whether a mesh shows patterns on those who have one."""
        return self._sheet is not None and self._sheet.covers(mesh)

    def add_coordinates(self, prim: Any, mesh: SkinnedMesh) -> None:
        """Author where the vertices of a mesh are on the pictures, if it shows patterns."""
        if self._sheet is not None and self._sheet.covers(mesh):
            places = self._layer.vectors(self._sheet.coordinates(mesh))
            self._layer.primvar(prim, COORDINATES, "texCoord2f[]", places, "vertex")

    def material(self, k: int) -> str:
        """Path of the material of the k-th agent, whose shirt has a pattern."""
        recording, layer = self._recording, self._layer
        first, second = recording.colors[k, SURFACES.index("shirt")], recording.second[k]
        pattern = int(recording.pattern[k])
        name = f"{PATTERNS[pattern]}_{bytes(first).hex()}_{bytes(second).hex()}"
        path = f"{self._folder}/{name}"
        if path in self._made:
            return path
        if not self._made:
            layer.prim(self._folder, "Scope")
        self._made.add(path)
        lights = to_linear(first), to_linear(second)
        shader = add_surface_shader(layer, path)
        texture = add_reader(layer, path, self.images[pattern], COORDINATES)
        layer.set(texture, "inputs:sourceColorSpace", "token", "raw")
        layer.set(texture, "inputs:wrapS", "token", "clamp")
        layer.set(texture, "inputs:wrapT", "token", "clamp")
        layer.set(texture, "inputs:bias", "float4", _vector(layer, lights[0], 0.0))
        layer.set(texture, "inputs:scale", "float4", _vector(layer, lights[1] - lights[0], 1.0))
        layer.connect(shader, "inputs:diffuseColor", "color3f", f"{path}/Texture.outputs:rgb")
        return path


def _vector(layer: Layer, rgb: Any, alpha: float) -> Any:
    return layer.pxr.Gf.Vec4f(*map(float, rgb), alpha)


def _write_mask(path: Path, sheet: Sheet, pattern: int) -> str:
    share = np.rint(255.0 * sheet.share(pattern)).astype(np.uint8)
    name = f"{path.stem}_{PATTERNS[pattern]}.png"
    with replacing(path.with_name(name)) as part:
        part.write_bytes(png(np.dstack([share, share, share, np.full_like(share, 255)])))
    return f"./{name}"

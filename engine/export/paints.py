"""Materials of exported agents: each surface in the colours that its agent wears."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..assets.character import Material, SkinnedMesh
from ..crowd.kits import PATTERNS
from ..crowd.regions import SURFACES
from .pixels import to_linear
from .recording import Recording
from .shirts import Shirt, parted_colours, shows_patterns

RGB = NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class Paint:
    """One material of a file.

    Parameters
    ----------
    name
        Of the character's material, with the colours where agents differ: ``"shirt #c61e2d"``,
        ``"shirt #2454b0 #f0f0f0 hoops"``.
    color
        RGBA factor in linear light.
    material
        Index of the character's material, for its picture and sides.
    shirt
        What the picture of a patterned shirt shows.
    coordinates
        Which texture coordinates of the mesh that picture lies on.
    """

    name: str
    color: tuple[float, float, float, float]
    material: int
    shirt: Shirt | None = None
    coordinates: int = 0


def mix_paints(
    recording: Recording, meshes: Sequence[SkinnedMesh]
) -> tuple[list[Paint], NDArray[np.int64]]:
    """All paints, and (K, meshes) which of them covers each mesh of each agent.

    Agents with the same colours share a paint. It is -1 for meshes that an agent doesn't wear.
    """
    paints: list[Paint] = []
    known: dict[tuple[int, bytes], int] = {}
    chosen = np.full((len(recording), len(meshes)), -1)
    worn = recording.worn(meshes)
    for number, mesh in enumerate(meshes):
        material = recording.character.materials[mesh.material]
        own = material.name in SURFACES
        patterned = recording.patterned & shows_patterns(material)
        coordinates = int(has_coordinates(mesh))
        for k in np.flatnonzero(worn[:, number]):
            rgb = recording.colors[k, SURFACES.index(material.name)] if own else None
            look = b"" if rgb is None else rgb.tobytes()
            if patterned[k]:
                look += recording.second[k].tobytes() + bytes([recording.pattern[k], coordinates])
            key = (mesh.material, look)
            if key not in known:
                known[key] = len(paints)
                if rgb is not None and patterned[k]:
                    second, pattern = recording.second[k], int(recording.pattern[k])
                    paint = _patterned(mesh.material, rgb, second, pattern, coordinates)
                else:
                    paint = _paint(material, mesh.material, rgb)
                paints.append(paint)
            chosen[k, number] = known[key]
    return paints, chosen


def has_coordinates(mesh: SkinnedMesh) -> bool:
    """Whether a mesh has texture coordinates of its own."""
    return bool(mesh.uvs.any())


def _paint(material: Material, number: int, rgb: RGB | None) -> Paint:
    if rgb is None:
        return Paint(material.name, material.base_color, number)
    return Paint(f"{material.name} #{bytes(rgb).hex()}", _factor(to_linear(rgb)), number)


def _patterned(number: int, first: RGB, second: RGB, pattern: int, coordinates: int) -> Paint:
    factor, *left = parted_colours(first, second)
    name = f"shirt #{bytes(first).hex()} #{bytes(second).hex()} {PATTERNS[pattern]}"
    return Paint(name, _factor(factor), number, Shirt(pattern, *left), coordinates)


def _factor(light: NDArray[np.float64]) -> tuple[float, float, float, float]:
    red, green, blue = light.tolist()
    return (round(red, 7), round(green, 7), round(blue, 7), 1.0)

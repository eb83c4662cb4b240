"""Materials of exported agents: each surface in the colour that its agent wears."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..assets.character import Material, SkinnedMesh
from .recording import SURFACES, Recording


@dataclass(frozen=True, slots=True)
class Paint:
    """One material of a file.

    Parameters
    ----------
    name
        Of the character's material, with the colour where agents differ: ``"shirt #c61e2d"``.
    color
        RGBA factor in linear light.
    material
        Index of the character's material, for its picture and sides.
    """

    name: str
    color: tuple[float, float, float, float]
    material: int


def mix_paints(
    recording: Recording, meshes: Sequence[SkinnedMesh]
) -> tuple[list[Paint], NDArray[np.int64]]:
    """All paints, and (K, meshes) which of them covers each mesh of each agent.

    Agents with the same colour share a paint. It is -1 for meshes that an agent doesn't wear.
    """
    paints: list[Paint] = []
    known: dict[tuple[int, bytes], int] = {}
    chosen = np.full((len(recording), len(meshes)), -1)
    worn = recording.worn(meshes)
    for number, mesh in enumerate(meshes):
        material = recording.character.materials[mesh.material]
        own = material.name in SURFACES
        for k in np.flatnonzero(worn[:, number]):
            rgb = recording.colors[k, SURFACES.index(material.name)] if own else None
            key = (mesh.material, b"" if rgb is None else rgb.tobytes())
            if key not in known:
                known[key] = len(paints)
                paints.append(_paint(material, mesh.material, rgb))
            chosen[k, number] = known[key]
    return paints, chosen


def _paint(material: Material, number: int, rgb: NDArray[np.uint8] | None) -> Paint:
    if rgb is None:
        return Paint(material.name, material.base_color, number)
    red, green, blue = to_linear(rgb).tolist()
    name = f"{material.name} #{bytes(rgb).hex()}"
    return Paint(name, (round(red, 7), round(green, 7), round(blue, 7), 1.0), number)


def to_linear(srgb: NDArray[np.uint8]) -> NDArray[np.float64]:
    """Linear light 0 to 1 of 8-bit sRGB (IEC 61966-2-1)."""
    share = srgb / 255.0
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def png(image: NDArray[np.uint8]) -> bytes:
    """A picture (H, W, 4) as a PNG file."""
    from PIL import Image

    content = io.BytesIO()
    Image.fromarray(image, "RGBA").save(content, "PNG")
    return content.getvalue()

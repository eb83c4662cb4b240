"""Patterns of team shirts as pictures, and where on them each vertex of a shirt lies.

The pictures' shader decides for every pixel by where on the trunk it is in the bind pose; other
programs have texture coordinates. So shirts get coordinates on a sheet that is laid flat over the
trunk, as wide and high as all shirts of a file, and a picture of the sheet shows a pattern by the
same rule (`tifo.engine.crowd.kits`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..assets.character import Material, SkinnedMesh
from ..crowd.kits import second_share
from ..crowd.regions import Regions
from .pixels import to_linear, to_srgb
from .recording import Recording

TEXEL = 0.0125
"""Largest width of a texel, in heights of the trunk: a twelfth of a stripe."""
LARGEST = 512
"""Texels of a picture in each direction, at most."""
STEP = 5
"""Of the 8-bit sRGB of pictures, so that many shirts share one and differ by a factor."""


@dataclass(frozen=True, slots=True)
class Shirt:
    """What is on one picture.

    Parameters
    ----------
    pattern
        Its number.
    first, second
        8-bit sRGB.
    """

    pattern: int
    first: tuple[int, ...]
    second: tuple[int, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Sheet:
    """Where pictures of patterns lie on the trunk.

    Parameters
    ----------
    regions
        The frame of the patterns.
    corner, extent
        (2,) float64 lower right corner (to the wearer) and what is covered to the left and
        upwards, in heights of the trunk.
    materials
        Numbers of those that show patterns.
    """

    regions: Regions
    corner: NDArray[np.float64]
    extent: NDArray[np.float64]
    materials: frozenset[int]
    _levels: dict[int, tuple[NDArray[np.float64], NDArray[np.uint8]]] = field(default_factory=dict)

    @property
    def texels(self) -> tuple[int, int]:
        """Width and height of pictures: powers of two."""
        width, height = (
            min(2 ** int(np.ceil(np.log2(max(length / TEXEL, 2.0)))), LARGEST)
            for length in self.extent.tolist()
        )
        return width, height

    def covers(self, mesh: SkinnedMesh) -> bool:
        """Whether a mesh shows patterns."""
        return mesh.material in self.materials

    def coordinates(self, mesh: SkinnedMesh) -> NDArray[np.float32]:
        """(V, 2) coordinates of a mesh's vertices, 0 to 1 to the wearer's left and upwards."""
        places = (self.regions.on_trunk(mesh.positions) - self.corner) / self.extent
        return places.astype(np.float32)

    def share(self, pattern: int) -> NDArray[np.float64]:
        """(H, W) how much of the second colour a picture's texels show, the highest row first."""
        width, height = self.texels
        across = self.corner[0] + (np.arange(width) + 0.5) / width * self.extent[0]
        up = self.corner[1] + (np.arange(height)[::-1, None] + 0.5) / height * self.extent[1]
        return second_share(pattern, across, up, self.extent / self.texels)

    def picture(self, shirt: Shirt) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
        """A palette (n, 3) sRGB and (H, W) which of its colours each texel has.

        The two colours mix in linear light, as they do in the shader.
        """
        if shirt.pattern not in self._levels:
            share = np.rint(255.0 * self.share(shirt.pattern)) / 255.0
            levels, number = np.unique(share, return_inverse=True)
            self._levels[shirt.pattern] = levels, number.reshape(share.shape).astype(np.uint8)
        shares, texels = self._levels[shirt.pattern]
        first, second = (to_linear(np.array(rgb)) for rgb in (shirt.first, shirt.second))
        return to_srgb(first + (second - first) * shares[:, None]), texels


def shows_patterns(material: Material) -> bool:
    """Whether a material is a shirt's; one with a picture of its own has no room for another."""
    return material.name == "shirt" and material.image is None


def lay_sheet(recording: Recording, meshes: Sequence[SkinnedMesh]) -> Sheet | None:
    """The sheet for the shirts among some meshes; None if nobody's shirt shows a pattern."""
    materials = recording.character.materials
    shirts = np.array([shows_patterns(materials[mesh.material]) for mesh in meshes], np.bool_)
    regions = recording.regions
    if regions is None or not recording.worn(meshes)[recording.patterned][:, shirts].any():
        return None
    own = [mesh for mesh, shirt in zip(meshes, shirts, strict=True) if shirt]
    places = np.concatenate([regions.on_trunk(mesh.positions) for mesh in own])
    low, high = places.min(axis=0), places.max(axis=0)
    return Sheet(
        regions, low, np.maximum(high - low, 1e-6), frozenset(mesh.material for mesh in own)
    )


def parted_colours(
    first: NDArray[np.uint8], second: NDArray[np.uint8]
) -> tuple[NDArray[np.float64], tuple[int, ...], tuple[int, ...]]:
    """Two sRGB colours (3,) as a factor (3,) in linear light of two others.

    Shirts of a team fade, and few of them alike. Without the factor one of the two colours is white
    in each channel, and about a hundred pairs are left, however many shirts there are.
    """
    lights = np.stack([to_linear(first), to_linear(second)])
    factor = lights.max(axis=0)
    left = to_srgb(np.where(factor > 0.0, lights / np.where(factor > 0.0, factor, 1.0), 1.0))
    one, other = (STEP * np.rint(left / STEP).astype(np.int64)).tolist()
    return factor, tuple(one), tuple(other)

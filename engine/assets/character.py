"""What the readers return: a skeleton, the meshes that it deforms, the clips that move it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..animation.clip import Clip
from ..animation.skeleton import Skeleton


@dataclass(frozen=True, slots=True, eq=False)
class Material:
    """How a surface looks.

    Parameters
    ----------
    name
        The file's name for it. The names ``skin``, ``hair``, ``shirt``, ``trousers`` and ``shoes``
        mark surfaces whose colour is chosen per spectator.
    base_color
        RGBA factor in linear light.
    image
        (H, W, 4) uint8 sRGB base-colour texture, first row at v = 0, or None.
    double_sided
        Whether back faces are drawn.
    """

    name: str
    base_color: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    image: NDArray[np.uint8] | None = None
    double_sided: bool = False


@dataclass(frozen=True, slots=True)
class Variant:
    """Meshes that only some agents of a crowd have: one choice out of a group.

    Parameters
    ----------
    group
        What is chosen, such as ``hair``. Every agent has one choice of each group, or none.
    choice
        Which one this is; all meshes of a choice are drawn together.
    shares
        How many of which people have it: ``man``, ``woman``, ``boy``, ``girl``, ``old man``,
        ``old woman``, or ``everyone`` for all that are not named. If the shares of a group add up
        to less than 1, the rest of these people have none of it; if to more, they are divided by
        their sum.
    """

    group: str
    choice: str
    shares: Mapping[str, float] = field(default_factory=lambda: {"everyone": 1.0})


@dataclass(frozen=True, slots=True, eq=False)
class SkinnedMesh:
    """Triangles of one material, in the bind pose of the character's skeleton.

    Parameters
    ----------
    name
        The file's name for it.
    positions, normals
        (V, 3) float32 in model space of the bind pose, metres.
    uvs
        (V, 2) float32, v = 0 at the first image row.
    colors
        (V, 4) float32 linear RGBA factors, ones where the file has none.
    joints, weights
        (V, 4) uint16 joint indices of the character's skeleton and float32 weights that sum to 1.
    triangles
        (T, 3) uint32, counter-clockwise seen from the front.
    material
        Index into `Character.materials`.
    variant
        Whom it is drawn on; on everybody if None.
    """

    name: str
    positions: NDArray[np.float32]
    normals: NDArray[np.float32]
    uvs: NDArray[np.float32]
    colors: NDArray[np.float32]
    joints: NDArray[np.uint16]
    weights: NDArray[np.float32]
    triangles: NDArray[np.uint32]
    material: int = 0
    variant: Variant | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Character:
    """One skeleton, its meshes at one or more levels of detail, and its clips.

    Parameters
    ----------
    name
        Usually the file's stem.
    skeleton
        The joints.
    meshes
        The most detailed level, with all variants.
    materials
        Referred to by `SkinnedMesh.material`.
    clips
        All for `skeleton`, in the file's order; names are unique.
    lower_levels
        Coarser meshes over the same skeleton and materials, finest first; may be empty.
    notes
        What the reader dropped or changed, one sentence each.
    """

    name: str
    skeleton: Skeleton
    meshes: tuple[SkinnedMesh, ...]
    materials: tuple[Material, ...]
    clips: tuple[Clip, ...]
    lower_levels: tuple[tuple[SkinnedMesh, ...], ...] = ()
    notes: tuple[str, ...] = field(default=())

    @property
    def triangle_count(self) -> int:
        """Triangles of the most detailed level, of all variants together."""
        return sum(len(mesh.triangles) for mesh in self.meshes)

    def clip(self, name: str) -> Clip:
        """The clip called `name`; ValueError lists the known names if there is none."""
        for clip in self.clips:
            if clip.name == name:
                return clip
        known = ", ".join(clip.name for clip in self.clips) or "none"
        raise ValueError(f"character '{self.name}' has no clip '{name}'; known: {known}")

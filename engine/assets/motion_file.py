"""Opens a file for its motions: a skeleton and clips, with or without a mesh to show them on."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..animation.clip import Clip
from ..animation.skeleton import Skeleton
from ..errors import AssetError
from .bvh import load_bvh
from .file_kind import suffix_of


@dataclass(frozen=True, slots=True, eq=False)
class Motions:
    """The motions of a file.

    Parameters
    ----------
    skeleton
        The joints that they move.
    clips
        At least one.
    notes
        What the reader guessed, dropped or changed, one sentence each.
    """

    skeleton: Skeleton
    clips: tuple[Clip, ...]
    notes: tuple[str, ...]


def load_motions(path: str | Path, scale: float | None = None) -> Motions:
    """Read the skeleton and the clips of a .bvh, .glb or .gltf file.

    A glTF file needs no mesh: a library of animations will do. If it has a skinned mesh, the
    skeleton's bind pose is that of the mesh, otherwise its rest pose.

    Parameters
    ----------
    path
        The file.
    scale
        Metres a unit of a BVH file; guessed by default.

    Raises
    ------
    AssetError
        If the file is missing, damaged, of another kind or holds no motion.
    ValueError
        If `scale` is out of range.
    """
    if suffix_of(path) == ".bvh":
        motion = load_bvh(path, scale)
        return Motions(motion.skeleton, (motion.clip,), motion.notes)
    # Only who opens glTF pays for its reader.
    from .gltf import load_gltf
    from .gltf_motion import has_skinned_mesh, load_gltf_motion

    if has_skinned_mesh(path):
        character = load_gltf(path)
        found = Motions(character.skeleton, character.clips, character.notes)
    else:
        found = Motions(*load_gltf_motion(path))
    if not found.clips:
        raise AssetError(path, "", "holds no motion")
    return found

"""Opens a character by the kind of its file, and gives it the motions of other files.

The one place that knows the kinds of file: programs and the command line ask here.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from ..animation.clip import Clip
from ..errors import AssetError
from .bone_figure import bone_figure
from .bvh import load_bvh
from .character import Character
from .motion_transfer import transfer_clip

GLTF_SUFFIXES = (".glb", ".gltf")
SUFFIXES = (*GLTF_SUFFIXES, ".bvh")
"""Lower-case suffixes of the files that can be opened."""


def load_character(path: str | Path, scale: float | None = None) -> Character:
    """Open a file as a character.

    Parameters
    ----------
    path
        A .glb or .gltf file, or a .bvh file, which becomes a figure of bones with one clip.
    scale
        Metres a unit of a BVH file; guessed by default. glTF is in metres.

    Raises
    ------
    AssetError
        If the file is missing, can't be read, is damaged or of an unknown kind, or if a scale is
        given for a glTF file.
    ValueError
        If `scale` is out of range.
    """
    if _suffix(path) == ".bvh":
        motion = load_bvh(path, scale)
        return bone_figure(
            motion.skeleton, Path(path).stem, (motion.clip,), motion.end_sites, motion.notes
        )
    if scale is not None:
        raise AssetError(path, "", "glTF files are in metres; a scale is for BVH files only")
    return _load_gltf(path)


def add_motions(
    character: Character, paths: Iterable[str | Path], scale: float | None = None
) -> Character:
    """Give a character the clips of other files that were made for the same skeleton.

    Joints are matched by name, case included. The character may have joints that a motion lacks;
    they stay at rest. The bones of both must agree but for one factor of size, by which the
    motion is scaled to the character (see `motion_transfer`). A clip whose name is taken is
    called ``stem.name`` after its file, or gets a number.

    Parameters
    ----------
    character
        Unchanged.
    paths
        .bvh, .glb and .gltf files.
    scale
        Metres a unit of the BVH files among them; guessed by default. Since a motion is scaled to
        the character's bones, it matters only where the skeletons have no bones in common.

    Returns
    -------
    Character
        With the clips behind the ones it had, and the notes of the files.

    Raises
    ------
    AssetError
        If a file can't be used or was made for another skeleton; says which joint differs.
    """
    clips = list(character.clips)
    notes = list(character.notes)
    for path in paths:
        if _suffix(path) == ".bvh":
            motion = load_bvh(path, scale)
            source, said = motion.skeleton, motion.notes
            found: tuple[Clip, ...] = (motion.clip,)
        else:
            other = _load_gltf(path)
            source, found, said = other.skeleton, other.clips, other.notes
        if not found:
            raise AssetError(path, "", "holds no motion")
        taken = {clip.name for clip in clips}
        for clip in found:
            name = _free_name(clip.name, Path(path).stem, taken)
            taken.add(name)
            clips.append(replace(transfer_clip(path, clip, source, character.skeleton), name=name))
        notes += [f"{Path(path).name}: {note}" for note in said]
    return replace(character, clips=tuple(clips), notes=tuple(notes))


def _load_gltf(path: str | Path) -> Character:
    # Only who opens glTF pays for its reader.
    from .gltf import load_gltf

    return load_gltf(path)


def _suffix(path: str | Path) -> str:
    """Lower-case suffix of a file that is there, can be opened and is of a known kind."""
    try:
        if not Path(path).exists():
            raise AssetError(path, "", "there is no such file")
        if Path(path).is_dir():
            raise AssetError(path, "", f"is a folder, expected a file ({', '.join(SUFFIXES)})")
        if not Path(path).is_file():
            raise AssetError(path, "", "is not a regular file")
        suffix = Path(path).suffix.lower()
        if suffix not in SUFFIXES:
            kind = f"'{suffix}' files" if suffix else "files without a suffix"
            raise AssetError(path, "", f"{kind} can't be read, only {', '.join(SUFFIXES)}")
        with Path(path).open("rb"):
            return suffix
    except OSError as error:
        raise AssetError(path, "", f"can't be read: {error.strerror or error}") from error


def _free_name(name: str, stem: str, taken: set[str]) -> str:
    if name in taken and name != stem:
        name = f"{stem}.{name}"
    free, number = name, 1
    while free in taken:
        number += 1
        free = f"{name} {number}"
    return free

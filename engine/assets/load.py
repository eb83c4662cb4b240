"""Opens a character by the kind of its file, and gives it the motions of other files.

The one place that knows the kinds of file: programs and the command line ask here.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from ..errors import AssetError
from .bone_figure import bone_figure
from .bvh import load_bvh
from .character import Character
from .file_kind import suffix_of
from .motion_file import load_motions
from .retarget.adopt import adopt_clips


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
    if suffix_of(path) == ".bvh":
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
    """Give a character the motions of other files, whatever skeleton they were made for.

    Motions of human bodies are retargeted (see `retarget`): they begin at the character's origin
    and face +Z, feet on the ground. Motions of the character's very own skeleton below a root of
    its own are taken over as they are, human or not. A clip whose name is taken is called
    ``stem.name`` after its file, or gets a number.

    Parameters
    ----------
    character
        Unchanged.
    paths
        .bvh, .glb and .gltf files; they need no mesh.
    scale
        Metres a unit of the BVH files among them; guessed by default. Since a motion is scaled to
        the character, it matters only for notes.

    Returns
    -------
    Character
        With the clips behind the ones it had, and the notes of the files.

    Raises
    ------
    AssetError
        If a file can't be used, or if it or the character is no human body and the skeletons
        differ.
    """
    clips = list(character.clips)
    notes = list(character.notes)
    for path in paths:
        motions = load_motions(path, scale)
        taken = {clip.name for clip in clips}
        for clip in adopt_clips(path, motions.clips, motions.skeleton, character.skeleton):
            name = _free_name(clip.name, Path(path).stem, taken)
            taken.add(name)
            clips.append(replace(clip, name=name))
        notes += [f"{Path(path).name}: {note}" for note in motions.notes]
    return replace(character, clips=tuple(clips), notes=tuple(notes))


def _load_gltf(path: str | Path) -> Character:
    # Only who opens glTF pays for its reader.
    from .gltf import load_gltf

    return load_gltf(path)


def _free_name(name: str, stem: str, taken: set[str]) -> str:
    if name in taken and name != stem:
        name = f"{stem}.{name}"
    free, number = name, 1
    while free in taken:
        number += 1
        free = f"{name} {number}"
    return free

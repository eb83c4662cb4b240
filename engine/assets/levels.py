"""Levels of detail by name: meshes called ``..._LOD1``, ``..._LOD2`` are coarser versions.

Model files have no common way to say it otherwise, and most tools write such names.
"""

from __future__ import annotations

import re
from dataclasses import replace

from .character import Character, SkinnedMesh

_SUFFIX = re.compile(r"_LOD(\d+)$", re.IGNORECASE)


def level_name(name: str, level: int) -> str:
    """The name of a mesh at a level: ``level_name("shirt", 2)`` is ``"shirt_LOD2"``.

    The finest level, 0, has no suffix; a suffix that the name has already is replaced.
    """
    stem = _SUFFIX.sub("", name)
    return f"{stem}_LOD{level}" if level else stem


def grouped_by_level(character: Character) -> Character:
    """Move meshes whose names end in ``_LOD1`` and so on to the character's lower levels.

    ``_LOD0`` counts as the finest. Levels that the numbering leaves out are closed up. A character
    without such names, or with nothing but coarse levels, comes back as its finest meshes stand.
    """
    levels: dict[int, list[SkinnedMesh]] = {}
    for mesh in character.meshes:
        found = _SUFFIX.search(mesh.name)
        levels.setdefault(int(found[1]) if found else 0, []).append(mesh)
    finest, *lower = (tuple(levels[level]) for level in sorted(levels))
    return replace(character, meshes=finest, lower_levels=(*lower, *character.lower_levels))

"""The built-in spectator: a stylised human made entirely by this package's own code.

`builtin_spectator` loads the file that ships with the package; `build.build_spectator` makes it.
"""

from __future__ import annotations

from dataclasses import replace
from importlib.resources import as_file, files

from ..character import Character
from ..gltf import load_gltf
from ..levels import grouped_by_level
from .tags import EVENTS

__all__ = ["builtin_spectator"]

_ONE_SHOTS = ("stand_up", "sit_down")
"""Clips that don't loop, which the file format has no word for."""


def builtin_spectator() -> Character:
    """Load the spectator that ships with the package.

    Returns
    -------
    Character
        24 joints, 13 clips, and three levels of detail of about 2,800, 780 and 260 triangles (the
        lower two in `Character.lower_levels`). Its materials are ``skin``, ``hair``, ``shirt``,
        ``trousers`` and ``shoes``. It stands 1.75 m tall at the origin and faces +Z; when seated,
        its feet stay there and the seat is 0.44 m high from z = -0.25 to -0.65. Its claps are
        tagged with ``clap_contact``, its jump with ``jump_apex`` and ``landing``.
    """
    with as_file(files(__package__) / "spectator.glb") as path:
        character = grouped_by_level(load_gltf(path))
    clips = (
        replace(clip, looping=clip.name not in _ONE_SHOTS, events=EVENTS.get(clip.name, ()))
        for clip in character.clips
    )
    return replace(character, name="spectator", clips=tuple(clips))

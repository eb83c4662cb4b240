"""The built-in spectator: a stylised human made entirely by this package's own code.

`builtin_spectator` loads the file that ships with the package; `build.build_spectator` makes it;
`MOTIONS` says in which shared poses its clips begin and end, and how fast its gaits are.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from importlib.resources import as_file, files

from ..character import Character
from ..gltf import load_gltf
from ..levels import grouped_by_level
from .repertoire import MOTIONS, Motion

__all__ = ["MOTIONS", "Motion", "builtin_spectator"]


@cache
def builtin_spectator() -> Character:
    """Load the spectator that ships with the package; loaded once, so treat it as read-only.

    Returns
    -------
    Character
        24 joints, about 190 clips, and three levels of detail of about 2,900, 950 and 320 triangles
        (the lower two in `Character.lower_levels`). Its meshes are variants of ``body``, ``hair``
        and ``beard``: see `variant_groups`, and `one_look` for a single person. Its materials are
        ``skin``, ``hair``, ``shirt``, ``trousers`` and ``shoes``. It stands 1.75 m tall at the
        origin and faces +Z; when seated, its feet stay there and the seat is 0.44 m high from
        z = -0.25 to -0.65. What its clips are is in `MOTIONS`.
    """
    with as_file(files(__package__) / "spectator.glb") as path:
        character = grouped_by_level(load_gltf(path))
    clips = []
    for clip in character.clips:
        motion = MOTIONS[clip.name]
        clips.append(replace(clip, looping=motion.looping, events=motion.events))
    return replace(character, name="spectator", clips=tuple(clips))

"""Rebuild the shipped spectator from code: ``python -m tifo.engine.assets.spectator.build [OUT]``.

Needs the `build` extra (marching cubes and mesh reduction); running tifo only needs the file.
"""

from __future__ import annotations

import sys
from pathlib import Path

from ..character import Character
from ..gltf_writer import write_glb
from .clips import spectator_clips
from .skeleton import spectator_skeleton
from .surface import MATERIALS, spectator_meshes

SHIPPED = Path(__file__).with_name("spectator.glb")


def build_spectator() -> Character:
    """Make skeleton, meshes at three levels of detail, and all clips; takes about three minutes."""
    skeleton = spectator_skeleton()
    meshes, *lower = spectator_meshes(skeleton)
    return Character(
        name="spectator",
        skeleton=skeleton,
        meshes=meshes,
        materials=MATERIALS,
        clips=spectator_clips(skeleton),
        lower_levels=tuple(lower),
    )


def main(arguments: list[str]) -> None:
    """Write the spectator to the given path, or over the shipped file."""
    write_glb(build_spectator(), arguments[0] if arguments else SHIPPED, compact=True)


if __name__ == "__main__":
    main(sys.argv[1:])

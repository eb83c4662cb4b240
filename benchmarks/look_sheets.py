"""Contact sheets of a character's variants, to be looked at: every body with every hair.

``python -m tifo.benchmarks.look_sheets FOLDER`` draws the built-in spectator at its three levels of
detail, from before and from behind, heads close up, and beards.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..components import AgentAnimID, Appearance, Body, Detail, Placement, Transition
from ..engine.animation.clip_bank import ClipBank
from ..engine.assets.character import Character
from ..engine.assets.variants import variant_groups
from ..engine.crowd.figure import make_figure
from ..engine.gl.context import create_offscreen_context
from ..engine.gl.framebuffer import Framebuffer
from ..engine.render.crowd_inputs import CrowdColumns
from ..engine.render.crowd_renderer import CrowdRenderer
from ..engine.render.frame import Frame
from ..engine.streams.pool import StreamPool
from ..scripting.camera import look_at, perspective

BACKGROUND = (0.55, 0.57, 0.60)
COLOURS = ((205, 150, 120), (74, 46, 26), (190, 45, 40), (50, 60, 95), (230, 230, 230))
"""Skin, hair, shirt, trousers and shoes."""

Picture = NDArray[np.uint8]
Choice = tuple[int, ...]
"""One number for each group of variants."""


def draw_looks(
    character: Character,
    looks: Sequence[Choice],
    *,
    clip: str,
    time: float = 0.0,
    level: int = 0,
    yaw: float = 0.5,
    heights: tuple[float, float] = (-0.05, 1.85),
    cell: tuple[int, int] = (110, 220),
) -> Picture:
    """Draw a character side by side, each time with other variants; needs a GL context.

    Parameters
    ----------
    character
        Its meshes.
    looks
        The choices of each figure, from the left.
    clip, time
        What everybody does, and when, in seconds.
    level
        Of detail.
    yaw
        Radians that everybody is turned; 0 faces the viewer.
    heights
        Metres from and to which a figure is shown.
    cell
        Pixels of one figure.
    """
    count = len(looks)
    figure = make_figure(character)
    pool = StreamPool(
        character.skeleton,
        ClipBank(character.skeleton, character.clips),
        capacity=1,
        history=4,
        markers=figure.joints,
    )
    stream = pool.add(0)
    pool.play(stream, clip, time=time)
    for tick in (1, 2, 3):
        pool.speed[:] = 0.0
        pool.evaluate(tick)
        pool.commit(tick)
    low, high = heights
    position = np.zeros((3, count), np.float32)
    position[0] = (np.arange(count) - (count - 1) / 2) * cell[0] * (high - low) / cell[1]
    place = Placement(position, np.full(count, yaw, np.float32), np.ones(count, np.float32))
    painted = [np.tile(np.array([*rgb, 255], np.uint8), (count, 1)) for rgb in COLOURS]
    nobody = np.zeros(0, np.uint32)
    shown = [nobody] * 4
    shown[level] = np.arange(count, dtype=np.uint32)
    body = Body.allocate(count)
    body.choice = np.array(looks, np.uint8).T.reshape(-1, count)
    columns = CrowdColumns(
        place,
        Appearance(painted[0], painted[1], painted[2], painted[3], painted[4]),
        Detail(tuple(shown)),
        (pool, AgentAnimID.allocate(1, count, 0), Transition.allocate(1, count)),
        body=body,
    )
    size = (count * cell[0], cell[1])
    renderer = CrowdRenderer(character, figure.height, columns)
    target = Framebuffer(size, samples=4)
    middle, away = (low + high) / 2, 60.0
    view = look_at(np.array([0.0, middle + 5.0, away]), np.array([0.0, middle, 0.0]))
    field = 2 * np.arctan((high - low) / 2 / float(np.hypot(away, 5.0)))
    projection = perspective(field, size[0] / size[1], 1.0, 200.0)
    with target:
        target.clear((*BACKGROUND, 1.0))
        renderer.update(3)
        renderer.draw(Frame(view, projection, size, 3, 1.0))
    picture: Picture = target.resolve().read_pixels()[..., :3].copy()
    renderer.delete()
    target.delete()
    return picture


def draw_sheets(character: Character, folder: Path) -> list[Path]:
    """Draw the sheets of a character with the groups ``body``, ``hair`` and ``beard``.

    Parameters
    ----------
    character
        Such as the built-in spectator.
    folder
        Receives the PNG files; made if it is missing.
    """
    from PIL import Image

    groups = variant_groups(character)
    bodies, hairs, beards = (range(len(groups[name])) for name in ("body", "hair", "beard"))
    folder.mkdir(parents=True, exist_ok=True)
    stand = "stand_idle"
    sheets = {
        f"bodies_{level}": [
            draw_looks(
                character,
                [(body, hair, 255) for hair in hairs],
                clip=stand,
                level=level,
                yaw=0.5 if body % 2 == 0 else 0.5 + np.pi,
            )
            for body in bodies
        ]
        for level in range(1 + len(character.lower_levels))
    }
    sheets["heads"] = [
        draw_looks(
            character,
            [(0, hair, beard) for hair in hairs],
            clip=stand,
            level=level,
            yaw=yaw,
            heights=(1.25, 1.85),
            cell=(170, 190),
        )
        for level in range(1 + len(character.lower_levels))
        for yaw, beard in ((0.6, 255), (1.6, 255), (3.6, 255), (0.4, level % len(beards)))
    ]
    paths = []
    for name, rows in sheets.items():
        paths.append(folder / f"{name}.png")
        Image.fromarray(np.concatenate(rows)).save(paths[-1], optimize=True)
    return paths


def main(arguments: list[str]) -> None:
    """Draw the built-in spectator's sheets into the folder that the first argument names."""
    from ..engine.assets.spectator import builtin_spectator

    create_offscreen_context()
    for path in draw_sheets(builtin_spectator(), Path(arguments[0])):
        print(path)


if __name__ == "__main__":
    main(sys.argv[1:])

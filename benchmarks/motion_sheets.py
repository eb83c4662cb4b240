"""Contact sheets of a character's motions: each clip as a strip of frames, to be looked at.

``python -m tifo.benchmarks.motion_sheets FOLDER [WORD...]`` draws the built-in spectator's clips
whose names begin with one of the words, or all, a dozen strips a sheet. Blue ticks under a strip
are clip events; the line is the ground, the block the seat.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..components import AgentAnimID, Appearance, Detail, Placement, Transition
from ..engine.animation.clip import Clip
from ..engine.animation.clip_bank import ClipBank
from ..engine.assets.character import Character
from ..engine.crowd.figure import make_figure
from ..engine.gl.context import create_offscreen_context
from ..engine.gl.framebuffer import Framebuffer
from ..engine.render.crowd_inputs import CrowdColumns
from ..engine.render.crowd_renderer import CrowdRenderer
from ..engine.render.frame import Frame
from ..engine.streams.pool import StreamPool
from ..scripting.camera import look_at, perspective

FRAMES = 6
CELL = (118, 214)
"""Pixels of one frame."""
LOW, HIGH = -0.12, 2.42
"""Metres of height that a frame shows."""
BACKGROUND = (0.55, 0.57, 0.60)
COLOURS = ((205, 150, 120), (60, 40, 25), (190, 45, 40), (50, 60, 95), (30, 30, 30))
"""Skin, hair, shirt, trousers and shoes."""

Picture = NDArray[np.uint8]


class PoseStrip:
    """Draws one character several times side by side, each time in another pose of a clip.

    Needs a GL context.

    Parameters
    ----------
    character
        Its meshes are drawn at the finest level.
    frames, cell
        How many poses, and pixels (width, height) of each.
    yaw
        Radians that everybody is turned; 0 faces the viewer.
    """

    def __init__(
        self,
        character: Character,
        *,
        frames: int = FRAMES,
        cell: tuple[int, int] = CELL,
        yaw: float = 0.6,
    ) -> None:
        self.size = (frames * cell[0], cell[1])
        figure = make_figure(character)
        bank = ClipBank(character.skeleton, character.clips)
        self._pool = StreamPool(
            character.skeleton, bank, capacity=frames, history=4, markers=figure.joints
        )
        self._streams = [self._pool.add(0) for _ in range(frames)]
        self._tick = 0
        position = np.zeros((3, frames), np.float32)
        self._metre = cell[1] / (HIGH - LOW)
        position[0] = (np.arange(frames) - (frames - 1) / 2) * cell[0] / self._metre
        place = Placement(position, np.full(frames, yaw, np.float32), np.ones(frames, np.float32))
        painted = [np.tile(np.array([*rgb, 255], np.uint8), (frames, 1)) for rgb in COLOURS]
        looks = Appearance(painted[0], painted[1], painted[2], painted[3], painted[4])
        nobody = np.zeros(0, np.uint32)
        detail = Detail((np.arange(frames, dtype=np.uint32), nobody, nobody, nobody))
        anim = AgentAnimID.allocate(1, frames, 0)
        anim.row[0] = np.arange(frames)
        columns = CrowdColumns(
            place, looks, detail, (self._pool, anim, Transition.allocate(1, frames))
        )
        self._renderer = CrowdRenderer(character, figure.height, columns)
        self._target = Framebuffer(self.size, samples=4)

    def draw(self, clip: str, times: Sequence[float]) -> Picture:
        """(H, W, 3) picture of a clip at as many seconds as the strip has frames."""
        for stream, time in zip(self._streams, times, strict=True):
            self._pool.play(stream, clip, time=float(time))
        for _ in range(3):
            self._tick += 1
            self._pool.speed[:] = 0.0
            self._pool.evaluate(self._tick)
            self._pool.commit(self._tick)
        middle, away = (LOW + HIGH) / 2, 60.0
        view = look_at(np.array([0.0, middle + 6.0, away]), np.array([0.0, middle, 0.0]))
        field = 2 * np.arctan((HIGH - LOW) / 2 / float(np.hypot(away, 6.0)))
        projection = perspective(field, self.size[0] / self.size[1], 1.0, 200.0)
        with self._target:
            self._target.clear((*BACKGROUND, 1.0))
            self._renderer.update(self._tick)
            self._renderer.draw(Frame(view, projection, self.size, self._tick, 1.0))
        picture: Picture = self._target.resolve().read_pixels()[..., :3]
        return np.ascontiguousarray(picture)

    def delete(self) -> None:
        """Delete everything on the GPU."""
        self._renderer.delete()
        self._target.delete()


def strip_times(clip: Clip, frames: int = FRAMES) -> list[float]:
    """Seconds of a strip's frames: all of the clip, or one and a half beats of a rhythmic one."""
    beats = sorted({event.time for event in clip.events})
    if len(beats) > 3:
        return [beats[0] + 1.5 * (beats[1] - beats[0]) * k / frames for k in range(frames)]
    # A loop's end is its beginning, so it is left out there.
    steps = frames if clip.looping else frames - 1
    return [clip.duration * k / steps for k in range(frames)]


def labelled(picture: Picture, clip: Clip) -> Any:
    """A strip with ground, name, seconds and events, as a Pillow image."""
    from PIL import Image, ImageDraw

    height, width = picture.shape[:2]
    image = Image.new("RGB", (width, height + 16), (250, 250, 250))
    ground = round(height * HIGH / (HIGH - LOW))
    floor = picture[0, 0]
    picture = picture.copy()
    line = picture[ground : ground + 2]
    line[(line == floor).all(axis=2)] = 90
    image.paste(Image.fromarray(picture), (0, 0))
    draw = ImageDraw.Draw(image)
    kind = "loop" if clip.looping else "once"
    draw.text((4, 2), f"{clip.name}   {clip.duration:.2f} s   {kind}", fill=(0, 0, 0))
    for event in clip.events:
        x = round(width * event.time / max(clip.duration, 1e-9))
        draw.line((x, height, x, height + 6), fill=(0, 60, 220), width=2)
        draw.text((x + 2, height + 2), event.name[:12], fill=(0, 60, 220))
    for k in range(1, FRAMES):
        draw.line((k * width // FRAMES, 14, k * width // FRAMES, height), fill=(150, 150, 150))
    return image


def draw_sheets(
    character: Character, folder: Path, words: Sequence[str] = (), *, rows: int = 5
) -> list[Path]:
    """Draw strips of a character's clips in sheets of two columns.

    Parameters
    ----------
    character
        With clips.
    folder
        Gets ``motions-1.png`` and so on; it is made if it does not exist.
    words
        Clips whose names begin with one of them are drawn; all if there are none.
    rows
        Strips below each other.

    Returns
    -------
    list of Path
        The files.
    """
    from PIL import Image

    chosen = [clip for clip in character.clips if not words or clip.name.startswith(tuple(words))]
    create_offscreen_context()
    strip = PoseStrip(character)
    images = [labelled(strip.draw(clip.name, strip_times(clip)), clip) for clip in chosen]
    strip.delete()
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for number, start in enumerate(range(0, len(images), 2 * rows), 1):
        part = images[start : start + 2 * rows]
        width, height = part[0].size
        columns = 2 if len(part) > rows else 1
        sheet = Image.new("RGB", (columns * (width + 6), min(rows, len(part)) * (height + 4)))
        for k, image in enumerate(part):
            sheet.paste(image, ((k // rows) * (width + 6), (k % rows) * (height + 4)))
        path = folder / f"motions-{number}.png"
        sheet.save(path, optimize=True)
        written.append(path)
    return written


def main(arguments: Sequence[str]) -> None:
    """Draw the built-in spectator's sheets into the folder that the first argument names."""
    from ..engine.assets.spectator import builtin_spectator

    for path in draw_sheets(builtin_spectator(), Path(arguments[0]), arguments[1:]):
        sys.stdout.write(f"{path}\n")


if __name__ == "__main__":
    main(sys.argv[1:])

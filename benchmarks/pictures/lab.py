"""The lab of the demo, as ``tifo demo --scene lab`` draws it; needs OpenGL."""

from __future__ import annotations

from PIL import Image

from ...demo_game.captions import draw_captions, place_captions
from ...demo_game.lab import Lab
from ...scripting.stage import Stage

SIZE = (1600, 900)
SECONDS = 6


def draw_lab(size: tuple[int, int] = SIZE) -> Image.Image:
    """The picture, `SECONDS` after the lab began."""
    lab = Lab()
    for _ in range(30 * SECONDS):
        lab.simulation.run(seconds=1 / 30)
        lab.advance(1 / 30)
    stage = Stage.offscreen(lab.simulation, size)
    camera = lab.camera("tv", size)
    stage.draw(camera)
    placed = place_captions(lab.captions(), camera, size)
    picture = Image.fromarray(draw_captions(stage.pixels(), placed))
    stage.close()
    lab.simulation.close()
    return picture

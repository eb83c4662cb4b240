"""How a crowd reacts, as figures 19 to 21 of the *Thesis* show it; needs OpenGL.

Frames are pose frames, 30 a second, and the shares are those of the crowd in the picture.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from ...engine.behaviour.events import Goal
from ...engine.crowd.spec import CrowdSpec
from ...engine.streams.pool import bind_positions
from ...scripting.camera import FreeCamera
from ...scripting.stage import Stage
from ...systems.recording import Recorder
from ...systems.simulation import Simulation
from .canvas import BLUE, FAINT, GOLD, GREEN, GROUND, INK, ORANGE, PALE, PURPLE, Canvas, Colour
from .figures import HEAD_HEIGHT

SIZE = (960, 340)
EVENT = 120
"""Frame at which a goal falls: the announcer shouts."""
WEIGHT = 0.5
BEFORE, AFTER = 118, 205
LATER = 240
"""Frame at which cheering of long and short is compared."""
LEVELS = (0.0, 0.25, 0.5, 0.75, 1.0)
FRAMES = 300
_CAPTION = 34


def make_stand(**fields: Any) -> Simulation:
    """A stand of supporters of home, or of both sides, in which everybody makes something of it."""
    stand: dict[str, Any] = {"layout": "stand", "rows": 8, "columns": 26, "step": 0.62}
    stand |= {"depth": 0.85, "rise": 0.5, "occupancy": 1.0, "neutrals": 0.0, "ultras": 0.0}
    return Simulation(CrowdSpec(**{**stand, "embarrassment": 0.0, "seed": 11, **fields}))


def cheering(simulation: Simulation) -> NDArray[np.bool_]:
    """(N,) who claps, cheers or jumps."""
    crowd = simulation.crowd
    found: NDArray[np.bool_] = np.any(
        [crowd.in_state(name) for name in ("clap", "cheer", "jump")], axis=0
    )
    return found & crowd.seat.occupied


def run_to(simulation: Simulation, frame: int) -> list[float]:
    """Let time pass until pose frame `frame`; the share that cheers in each frame passed."""
    shares = []
    while simulation.clock.pose_tick < frame:
        if simulation.clock.pose_tick == EVENT:
            simulation.send(Goal(0, weight=WEIGHT))
        simulation.run(seconds=1 / 30)
        there = simulation.crowd.seat.occupied
        shares.append(float(cheering(simulation)[there].mean()))
    return shares


def draw_before_and_after() -> Image.Image:
    """Figure 19: nobody cheers before an event, and nearly everybody does after it."""
    simulation = make_stand()
    pictures = []
    for frame in (BEFORE, AFTER):
        run_to(simulation, frame)
        share = cheering(simulation)[simulation.crowd.seat.occupied].mean()
        words = f"Frame {frame}, {'before' if frame < EVENT else 'after'} the goal of frame {EVENT}"
        pictures.append(_captioned(_photograph(simulation), f"{words}: {share:.0%} cheer"))
    simulation.close()
    return _stacked(pictures)


def draw_long_and_short() -> Image.Image:
    """Figure 20: the more embarrassed a crowd, the sooner it stops cheering."""
    pictures, curves = [], []
    for level in LEVELS:
        simulation = make_stand(embarrassment=level)
        curve = run_to(simulation, LATER)
        if level in (LEVELS[0], LEVELS[-1]):
            words = f"Frame {LATER}, embarrassment {level:g}: {curve[-1]:.0%} cheer"
            pictures.append(_captioned(_photograph(simulation), words))
        curves.append(curve + run_to(simulation, FRAMES))
        simulation.close()
    return _stacked([*pictures, _draw_curves(curves)])


def draw_one_side() -> Image.Image:
    """Figure 21: supporters of both sides sit mixed, and only the winners cheer."""
    simulation = make_stand(sides=2, fans="mixed", rows=7, columns=22)
    run_to(simulation, AFTER)
    crowd = simulation.crowd
    camera = _camera(simulation)
    picture = _photograph(simulation)
    away = np.flatnonzero((crowd.team.side == 1) & crowd.seat.occupied)
    clip = camera.projection(SIZE) @ camera.view()
    points = np.column_stack([head_places(simulation, away), np.ones(len(away))])
    points = points @ clip.T.astype(float)
    draw = ImageDraw.Draw(picture)
    across = 0.5 * SIZE[1] * float(camera.projection(SIZE)[1, 1])
    for x, y, _, w in points:
        px, py = (x / w + 1) / 2 * SIZE[0], (1 - y / w) / 2 * SIZE[1]
        radius = 0.2 * across / w
        draw.ellipse((px - radius, py - radius, px + radius, py + radius), outline=GOLD, width=3)
    happy = cheering(simulation)
    home = (crowd.team.side == 0) & crowd.seat.occupied
    words = (
        f"A goal for home: {happy[home].mean():.0%} of its supporters cheer, and "
        f"{happy[away].mean():.0%} of the others, in circles"
    )
    simulation.close()
    return _captioned(picture, words)


def head_places(simulation: Simulation, agents: NDArray[np.int64]) -> NDArray[np.float64]:
    """(K, 3) metres: the middles of agents' heads in the poses that they show."""
    crowd = simulation.crowd
    recorder = Recorder(crowd, agents, frames=1, fps=30.0)
    recorder.take(simulation.clock.pose_tick)
    shown = recorder.finish()
    head = crowd.character.skeleton.index("head")
    middle = np.append(bind_positions(crowd.character.skeleton)[head] + (0.0, HEAD_HEIGHT, 0.0), 1)
    x, y, z = shown.scale[0] * (shown.palettes[0, :, head] @ middle).T
    c, s = np.cos(shown.yaw[0]), np.sin(shown.yaw[0])
    found: NDArray[np.float64] = shown.position[0] + np.stack([c * x + s * z, y, c * z - s * x], 1)
    return found


def _camera(simulation: Simulation) -> FreeCamera:
    """In front of the stand, as far away as it takes to see its whole width."""
    place = simulation.crowd.placement.position
    low, high = place.min(axis=1), place.max(axis=1)
    middle = 0.5 * (low + high)
    fov = 0.42
    wide = np.tan(0.5 * fov) * SIZE[0] / SIZE[1]
    away = 0.5 * float(high[0] - low[0] + 1.4) / wide
    eye = (float(middle[0]), float(middle[1]) + 0.3 * away + 0.6, float(high[2]) + away)
    camera = FreeCamera.looking(eye, (eye[0], float(middle[1]) + 0.75, float(middle[2]) + 0.4))
    camera.fov = fov
    return camera


def _photograph(simulation: Simulation) -> Image.Image:
    stage = Stage.offscreen(simulation, SIZE)
    stage.draw(_camera(simulation))
    picture = Image.fromarray(stage.pixels())
    stage.close()
    return picture


def _captioned(picture: Image.Image, words: str) -> Image.Image:
    whole = Image.new("RGB", (picture.width, picture.height + _CAPTION), GROUND)
    whole.paste(picture, (0, 0))
    place = (picture.width / 2, picture.height + _CAPTION / 2)
    ImageDraw.Draw(whole).text(place, words, INK, ImageFont.load_default(17), "mm")
    return whole


def _stacked(pictures: Sequence[Image.Image]) -> Image.Image:
    whole = Image.new("RGB", (SIZE[0], sum(picture.height for picture in pictures)), GROUND)
    top = 0
    for picture in pictures:
        whole.paste(picture, (0, top))
        top += picture.height
    return whole


def _draw_curves(curves: Sequence[Sequence[float]]) -> Image.Image:
    """Shares that cheer over frames, a line for each embarrassment."""
    left, right, top, bottom = 80.0, SIZE[0] - 30.0, 44.0, 216.0
    canvas = Canvas(SIZE[0], 270)

    def place(frame: float, share: float) -> tuple[float, float]:
        along = (frame - 100) / (FRAMES - 100)
        return left + along * (right - left), bottom - share * (bottom - top)

    for share in (0.0, 0.5, 1.0):
        canvas.line([place(100, share), place(FRAMES, share)], PALE, 1.0)
        canvas.text((left - 8, place(0, share)[1]), f"{share:.0%}", 13, FAINT, "rm")
    for frame in range(100, FRAMES + 1, 20):
        canvas.text((place(frame, 0)[0], bottom + 14), str(frame), 13, FAINT)
    for frame, words in ((EVENT, "goal"), (LATER, "pictures above")):
        canvas.line([place(frame, 0.0), place(frame, 1.06)], FAINT, 1.2, dashed=True)
        canvas.text((place(frame, 1.06)[0] + 5, place(0, 1.06)[1]), words, 13, FAINT, "lm")
    colours: tuple[Colour, ...] = (BLUE, GREEN, GOLD, ORANGE, PURPLE)
    for curve, level, colour in zip(curves, LEVELS, colours, strict=True):
        points = [place(k + 1, share) for k, share in enumerate(curve) if k + 1 >= 100]
        canvas.line(points, colour, 2.2)
        x = left + 170.0 + 128.0 * LEVELS.index(level)
        canvas.line([(x, 18), (x + 22, 18)], colour, 3.0)
        canvas.text((x + 28, 18), f"{level:g}", 14, INK, "lm")
    canvas.text((left, 18), "embarrassment", 14, INK, "lm")
    canvas.text(((left + right) / 2, bottom + 38), "pose frame; share of the crowd that cheers", 14)
    return canvas.finish()

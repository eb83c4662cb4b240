"""An overlay: the body's motion, the motion laid over it, the mask, and what is shown."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ...engine.crowd.spec import CrowdSpec
from ...systems.simulation import Simulation
from .canvas import BLUE, FAINT, INK, ORANGE, PALE, Canvas, mixed
from .figures import draw_figure

MASK = "upper_body"
BODY, OVER = "sit_idle", "wave"
_SIZE = (900, 400)
_GROUND = 300.0


def make_poses() -> tuple[Simulation, NDArray[np.float32], NDArray[np.float32]]:
    """A crowd, palettes (3, J, 3, 4) of three agents, and the weights (J,) of the mask.

    Agent 0 shows the body's motion, agent 1 the motion that is laid over it, agent 2 both.
    """
    spec = CrowdSpec(
        layout="stand",
        rows=1,
        columns=3,
        occupancy=1.0,
        streams=30,
        spare_streams=2,
        children=0.0,
        old=0.0,
        props=0.0,
    )
    simulation = Simulation(spec)
    crowd = simulation.crowd
    assert crowd.pool is not None
    assert crowd.overlays is not None
    crowd.guide(motion=BODY)
    simulation.run(seconds=3.0)
    body, over = crowd.pool.add(BODY), crowd.pool.add(OVER)
    crowd.transition_to_streamed([0, 2], body, duration=0.0, offset=0.0)
    crowd.transition_to_streamed(1, over, duration=0.0, offset=0.0)
    crowd.overlay(2, over, MASK, duration=0.0, offset=0.0)
    simulation.run(seconds=1.0)
    palettes = crowd.palettes(np.arange(3), simulation.clock.pose_tick)
    masks = crowd.overlays.masks
    return simulation, palettes, masks.weights[masks.index(MASK)]


def draw_overlay() -> Image.Image:
    """The picture."""
    simulation, palettes, weights = make_poses()
    skeleton = simulation.crowd.character.skeleton
    canvas = Canvas(*_SIZE)
    by_weight = [mixed(PALE, ORANGE, float(weight)) for weight in weights]
    shown = [mixed(BLUE, ORANGE, float(weight)) for weight in weights]
    columns = (
        (f"body: {BODY}", "B", palettes[0], [BLUE] * len(weights)),
        (f"overlay: {OVER}", "O", palettes[1], [ORANGE] * len(weights)),
        (f"mask: {MASK}", "weights of joints", palettes[1], by_weight),
        ("shown", "limbs hung up on the body", palettes[2], shown),
    )
    for number, (title, text, pose, colours) in enumerate(columns):
        x = _SIZE[0] * (number + 0.5) / len(columns)
        canvas.line([(x - 62, _GROUND), (x + 62, _GROUND)], PALE, 1.5)
        draw_figure(canvas, skeleton, pose, (x, _GROUND), 104, colours)
        canvas.text((x, _GROUND + 26), title, 16, INK)
        canvas.text((x, _GROUND + 50), text, 14, FAINT)
        if number:
            sign = ("+", "·", "=")[number - 1]
            canvas.text((x - 0.5 * _SIZE[0] / len(columns), _GROUND - 100), sign, 30, FAINT)
    canvas.text((_SIZE[0] / 2, 28), "Some joints follow another motion", 20)
    values = sorted({round(float(weight), 2) for weight in weights})
    for number, value in enumerate(values):
        x = _SIZE[0] / 2 + 92 * (number - 0.5 * (len(values) - 1))
        canvas.disc((x - 26, 376), 7, mixed(PALE, ORANGE, value))
        canvas.text((x - 12, 376), f"{value:g}", 13, FAINT, "lm")
    return canvas.finish()

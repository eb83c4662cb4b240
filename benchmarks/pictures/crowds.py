"""Spectators in their seats: a mixed block close up, and one clip as relative and as absolute."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from PIL import Image

from ...engine.animation.clip import Clip
from ...engine.animation.skeleton import Skeleton
from ...engine.assets.character import Character
from ...engine.assets.retarget import retarget
from ...engine.assets.rotations import from_euler, multiply
from ...engine.assets.spectator import builtin_spectator
from ...engine.behaviour.events import Goal
from ...engine.crowd.body_types import ADULT, CHILD, OLD
from ...engine.crowd.spec import CrowdSpec
from ...scripting.camera import FreeCamera
from ...scripting.stage import Stage
from ...systems.simulation import Simulation
from .sheet import FAINT, Sheet, with_few_colours
from .studio import TWINS

ROWS, COLUMNS = 10, 20
STEP, RISE, DEPTH = 0.66, 0.46, 0.86

RECORDED = (0.45, 0.30, math.radians(50.0))
"""Metres to the left and to the front, and radians, of the place where a motion was recorded."""
CLIP, MOMENT = "wave", 0.55
BODIES = (
    (ADULT, 1.0, 0.0, "man_shirt", "short"),
    (CHILD, 0.70, 0.0, "child_shirt", "ponytail"),
    (ADULT, 0.94, 0.08, "woman_shirt", "bob"),
    (OLD, 0.95, 0.02, "man_sweater", "ring"),
)
"""Body type, size, girth, body and hair of those who show it, in two rows."""


def draw_block(scale: float = 1.0) -> Image.Image:
    """200 mixed spectators, two seconds after a goal."""
    spec = CrowdSpec(
        layout="stand",
        rows=ROWS,
        columns=COLUMNS,
        step=STEP,
        rise=RISE,
        depth=DEPTH,
        occupancy=1.0,
        sides=2,
        fans="mixed",
        neutrals=0.12,
        children=0.12,
        old=0.14,
        women=0.45,
        ultras=0.3,
        props=0.5,
        lod=False,
        seed=11,
    )
    simulation = Simulation(spec)
    simulation.run(seconds=2.0)
    simulation.send(Goal(side=0))
    simulation.run(seconds=2.4)
    size = (round(1800 * scale), round(1060 * scale))
    middle = np.array([STEP * (COLUMNS - 1) / 2, RISE * 4.5 + 0.8, -DEPTH * 3.0])
    eye = middle + np.array([0.0, 3.0, 14.0])
    camera = FreeCamera.looking(tuple(eye), tuple(middle))
    camera.fov = math.radians(30.5)
    pixels = _picture(simulation, camera, size)
    return with_few_colours(pixels)


def recorded(character: Character, name: str) -> tuple[Skeleton, Clip]:
    """A clip of the character as if it had been captured: without a root, in `RECORDED`."""
    skeleton, clip = character.skeleton, character.clip(name)
    assert skeleton.names[0] == "root"
    body = Skeleton(
        names=skeleton.names[1:],
        parents=np.maximum(skeleton.parents[1:] - 1, -1),
        rest_rotation=skeleton.rest_rotation[1:],
        rest_translation=skeleton.rest_translation[1:],
        rest_scale=skeleton.rest_scale[1:],
        inverse_bind=skeleton.inverse_bind[1:],
    )
    x, z, turn = RECORDED
    quaternion = from_euler((1,), np.array([turn]))
    rotation, translation = clip.rotation[:, 1:].copy(), clip.translation[:, 1:].copy()
    hips = clip.translation[:, 1].astype(np.float64)
    translation[:, 0, 0] = np.cos(turn) * hips[:, 0] + np.sin(turn) * hips[:, 2] + x
    translation[:, 0, 2] = np.cos(turn) * hips[:, 2] - np.sin(turn) * hips[:, 0] + z
    own = clip.rotation[:, 1].astype(np.float64)
    rotation[:, 0] = multiply(np.broadcast_to(quaternion, own.shape), own)
    return body, replace(clip, rotation=rotation, translation=translation, scale=clip.scale[:, 1:])


def draw_relative(scale: float = 1.0) -> Image.Image:
    """One captured clip in eight seats: relative to each agent, and absolute."""
    half = (round(900 * scale), round(900 * scale))
    head = round(92 * scale)
    sheet = Sheet((2 * half[0] + round(8 * scale), head + half[1]), scale=scale)
    for number, (title, words) in enumerate(
        (
            ("relative", "from each one's own seat, on each one's own bones"),
            ("absolute", "with the place, the heading and the bones of the one who was recorded"),
        )
    ):
        x = number * (half[0] + round(8 * scale))
        simulation = relative_crowd(absolute=number == 1)
        camera = relative_camera(absolute=number == 1)
        sheet.paste(_picture(simulation, camera, half), (x, head))
        sheet.text((x + half[0] / 2, 30 * scale), title, 26)
        sheet.text((x + half[0] / 2, 66 * scale), words, 18, FAINT)
    return sheet.finish()


def relative_camera(*, absolute: bool) -> FreeCamera:
    """Before the crowd; absolute motion leads away to one side."""
    middle = (1.5 * 1.15 + (0.30 if absolute else 0.05), 1.85, -0.5)
    camera = FreeCamera.looking((middle[0], middle[1] + 5.0, 24.0), middle)
    camera.fov = math.radians(12.0)
    return camera


def relative_crowd(*, absolute: bool) -> Simulation:
    """Eight different people in two rows who all show one captured clip at one moment."""
    character = builtin_spectator()
    skeleton, clip = recorded(character, CLIP)
    given = replace(
        retarget(clip, skeleton, character.skeleton, absolute=absolute), name="captured"
    )
    spec = CrowdSpec(
        layout="stand",
        rows=2,
        columns=len(BODIES),
        step=1.15,
        rise=2.0,
        depth=1.5,
        occupancy=1.0,
        streams=30,
        spare_streams=3,
        history=4,
        children=0.0,
        old=0.0,
        neutrals=0.0,
        props=0.0,
        casting=False,
        lod=False,
        seed=4,
    )
    simulation = Simulation(spec, replace(character, clips=(*character.clips, given)))
    crowd, pool = simulation.crowd, simulation.crowd.pool
    assert pool is not None
    crowd.guide(motion="stand_idle")
    simulation.run(seconds=0.2)
    stream = pool.add("captured", time=MOMENT, speed=0.0)
    for name in () if absolute else TWINS.values():
        pool.add_twin(stream, name)
    for agent in range(len(crowd)):
        row, column = int(crowd.seat.row[agent]), int(crowd.seat.column[agent])
        kind, size, girth, body, hair = BODIES[(column + 2 * row) % len(BODIES)]
        crowd.body.kind[agent], crowd.body.girth[agent], crowd.body.head[agent] = kind, girth, 0.0
        crowd.placement.scale[agent] = 1.0 if absolute else size
        crowd.dress(agent, body=body, hair=hair, beard=None)
        crowd.transition_to_streamed(agent, stream, duration=0.0, offset=0.0)
    crowd.placement.yaw[:] = 0.0
    crowd.body.version += 1
    crowd.placement.version += 1
    simulation.run(seconds=0.3)
    return simulation


def _picture(simulation: Simulation, camera: FreeCamera, size: tuple[int, int]) -> Image.Image:
    """What a stage shows, and the end of the simulation."""
    stage = Stage.offscreen(simulation, size)
    stage.draw(camera)
    picture = Image.fromarray(stage.pixels())
    stage.close()
    simulation.close()
    return picture

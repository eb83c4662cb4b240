"""A studio: spectators one by one, each with a body, clothes, a pose and a place in the picture.

They are the agents of a small crowd, drawn by the passes that draw every crowd; only who stands
where, who shows which level of detail, and the ground behind them are the studio's.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import esper
import numpy as np
from numpy.typing import NDArray

from ...components import Detail, PartBits
from ...engine.assets.character import Character
from ...engine.assets.props import builtin_prop, drumming
from ...engine.assets.spectator import builtin_spectator
from ...engine.crowd.body_types import ADULT, CHILD, OLD
from ...engine.crowd.detail import MESH_PIXELS, select_part
from ...engine.crowd.kits import Kit
from ...engine.crowd.spec import CrowdSpec
from ...engine.gl.context import create_offscreen_context
from ...engine.gl.framebuffer import Framebuffer
from ...engine.streams.pool import bind_positions
from ...scripting.camera import FreeCamera
from ...systems.render import RenderSystem
from ...systems.simulation import Simulation

Array = NDArray[np.float64]
RGB = tuple[int, int, int]

AWAY = 58.0
"""Metres to the camera: all are seen from the same side, and air does not yet make them pale."""
SHARPER = 2
"""Pictures are drawn so many times as large and scaled down."""
TWINS = {CHILD: "child", OLD: "old"}

SKINS: tuple[RGB, ...] = ((226, 178, 148), (150, 98, 66), (240, 200, 172), (96, 62, 44))
HAIRS: tuple[RGB, ...] = ((88, 56, 32), (34, 26, 22), (196, 150, 84), (140, 66, 34))
GREY: RGB = (190, 190, 192)


@dataclass(frozen=True, slots=True, kw_only=True)
class Model:
    """One spectator in a picture.

    Parameters
    ----------
    at
        Pixels from the left and the top, where it stands.
    clip, time
        What it shows: a clip's name, and seconds into it.
    yaw
        Radians; 0 faces the viewer, positive turns to the viewer's right.
    kind, scale, girth
        Body type, size, and metres of girth.
    wears
        Its choices by group of variants.
    colours
        sRGB by column of `Appearance`.
    kit
        The shirt, if it is a team's.
    props
        Names of what it has with it, and the clip that each of them plays, or "" for its first; of
        a drum the second of its rhythm.
    level
        Of detail, 0 the finest and 3 the far figure; None leaves it to the size in the picture.
    """

    at: tuple[float, float]
    clip: str = "stand_idle"
    time: float = 0.0
    yaw: float = 0.0
    kind: int = ADULT
    scale: float = 1.0
    girth: float = 0.0
    wears: Mapping[str, str | None] = field(default_factory=dict)
    colours: Mapping[str, RGB] = field(default_factory=dict)
    kit: Kit | None = None
    props: Mapping[str, str] = field(default_factory=dict)
    level: int | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Shot:
    """What the studio saw.

    Parameters
    ----------
    light
        (H, W, 3) linear light, times `cover`.
    cover
        (H, W) how much of a pixel the spectators cover, 0 to 1.
    joints
        (N, J, 2) pixels where the models' joints are.
    ground
        (N, J, 2) pixels straight below them on the ground that the model stands on.
    height
        (N, J) metres of the joints above it.
    """

    light: Array
    cover: Array
    joints: Array
    ground: Array
    height: Array


def take(
    models: Sequence[Model],
    size: tuple[int, int],
    metre: float,
    *,
    elevation: float = 0.10,
    character: Character | None = None,
) -> Shot:
    """Draw models; needs OpenGL.

    Parameters
    ----------
    models
        Who is in the picture.
    size
        Pixels (width, height).
    metre
        Pixels of a metre.
    elevation
        Radians by which they are seen from above.
    character
        Their meshes and clips: the built-in spectator's, or some with its variants and joints.
    """
    simulation = _crowd_of(models, character or builtin_spectator())
    crowd = simulation.crowd
    _dress(simulation, models)
    crowd.placement.position[:] = _places(models, size, metre, elevation).T
    crowd.placement.yaw[:] = [model.yaw for model in models]
    crowd.placement.scale[:] *= [model.scale for model in models]
    crowd.placement.version += 1
    _give(simulation, models)
    _pose(simulation, models)
    camera = _camera(size, metre, elevation)
    shot = _draw(simulation, models, camera, size, metre)
    simulation.close()
    return shot


def _crowd_of(models: Sequence[Model], character: Character) -> Simulation:
    """A simulation with an adult of the character's own size for every model."""
    poses = {(model.clip, model.time) for model in models}
    twins = {(model.clip, model.time, model.kind) for model in models if model.kind in TWINS}
    spec = CrowdSpec(
        layout="stand",
        rows=1,
        columns=len(models),
        occupancy=1.0,
        streams=30,
        spare_streams=len(poses) + len(twins),
        history=4,
        children=0.0,
        old=0.0,
        women=0.0,
        props=0.0,
        casting=False,
    )
    simulation = Simulation(spec, character)
    simulation.crowd.guide(motion="stand_idle")
    simulation.run(seconds=0.2)
    crowd = simulation.crowd
    crowd.body.girth[:], crowd.body.head[:] = 0.0, 0.0
    crowd.placement.scale[:] = 1.0
    return simulation


def _dress(simulation: Simulation, models: Sequence[Model]) -> None:
    crowd = simulation.crowd
    looks = crowd.appearance
    for agent, model in enumerate(models):
        crowd.body.kind[agent], crowd.body.girth[agent] = model.kind, model.girth
        wears = {"body": "man_shirt", "hair": "short", "beard": None, **model.wears}
        crowd.dress(agent, **wears)
        colours = {
            "skin": SKINS[0],
            "hair": HAIRS[0],
            "shirt": (198, 42, 50),
            "trousers": (62, 78, 116),
            "shoes": (225, 225, 222),
            **model.colours,
        }
        for column, colour in colours.items():
            getattr(looks, column)[agent, :3] = colour
        looks.pattern[agent] = 0
        looks.second[agent] = looks.shirt[agent]
        if model.kit is not None:
            model.kit.put_on(looks, agent)
    crowd.body.version += 1
    looks.version += 1


def _give(simulation: Simulation, models: Sequence[Model]) -> None:
    """Parts for those who have them, in the colours of their shirts."""
    crowd = simulation.crowd
    assert crowd.pool is not None
    looks = copy.deepcopy(crowd.appearance)
    looks.pattern[:] = 0
    for name in dict.fromkeys(name for model in models for name in model.props):
        prop = builtin_prop(name)
        who = [agent for agent, model in enumerate(models) if name in model.props]
        part = simulation.add_part(
            name,
            prop.character,
            hook=prop.hook,
            transform=prop.transform,
            motion=prop.motion,
            streams=8,
            agents=who,
            appearance=looks,
        )
        for agent in who:
            clip = models[agent].props[name]
            if name == "drum":
                # Its clip is the rhythm's second at which it is seen.
                beat = crowd.uniques.add(drumming(float(clip or 0.0)), speed=0.0)
                crowd.overlay(agent, beat, "arms", duration=0.0)
            elif clip:
                part.transition_to_streamed(agent, part.streams(clip)[agent % 2], duration=0.0)


def _pose(simulation: Simulation, models: Sequence[Model]) -> None:
    """Streams that stand still, one for each pose, with twins for the bodies that need them."""
    crowd = simulation.crowd
    pool = crowd.pool
    assert pool is not None
    streams = {}
    for agent, model in enumerate(models):
        key = (model.clip, model.time)
        if key not in streams:
            streams[key] = pool.add(model.clip, time=model.time, speed=0.0)
        base = streams[key]
        if model.kind in TWINS and pool.twins.table[model.kind, base.row] < 0:
            pool.add_twin(base, TWINS[model.kind])
        crowd.transition_to_streamed(agent, base, duration=0.0, offset=0.0)
    simulation.run(seconds=0.3)


def _places(
    models: Sequence[Model], size: tuple[int, int], metre: float, elevation: float
) -> Array:
    """(N, 3) metres of the models' feet: in the plane that is seen as the picture."""
    pixels = np.array([model.at for model in models])
    middle = np.array(size) / 2
    across, up = ((pixels - middle) / metre * (1.0, -1.0)).T
    return np.stack([across, up / math.cos(elevation), np.zeros(len(models))], axis=1)


def _camera(size: tuple[int, int], metre: float, elevation: float) -> FreeCamera:
    eye = (0.0, AWAY * math.sin(elevation), AWAY * math.cos(elevation))
    camera = FreeCamera.looking(eye, (0.0, 0.0, 0.0))
    camera.fov = 2.0 * math.atan(0.5 * size[1] / metre / AWAY)
    return camera


def _draw(
    simulation: Simulation,
    models: Sequence[Model],
    camera: FreeCamera,
    size: tuple[int, int],
    metre: float,
) -> Shot:
    create_offscreen_context()
    large = (SHARPER * size[0], SHARPER * size[1])
    crowd = simulation.crowd
    by_size = sum(1.75 * metre < least for least in MESH_PIXELS)
    levels = np.array([by_size if m.level is None else m.level for m in models])
    crowd.detail.agents = tuple(np.flatnonzero(levels == k).astype(np.uint32) for k in range(4))
    system, target = RenderSystem(large), Framebuffer(large, samples=4)
    simulation.look(camera.view(), camera.projection(large), large[1])
    with simulation.active(), target:
        bits = esper.try_component(crowd.entity, PartBits)
        for part in crowd.parts.values():
            assert bits is not None
            detail = esper.component_for_entity(part.entity, Detail)
            select_part(detail, crowd.detail, bits, part.attachment.bit)
        target.clear((0.0, 0.0, 0.0, 0.0))
        system.process(simulation.clock)
    pixels = target.resolve().read_pixels()
    system.delete()
    target.delete()
    mean = np.empty(pixels.shape, np.float32)
    mean[..., :3] = to_linear(np.arange(256) / 255.0).astype(np.float32)[pixels[..., :3]]
    mean[..., 3] = pixels[..., 3] / np.float32(255.0)
    mean = mean.reshape(size[1], SHARPER, size[0], SHARPER, 4)
    small = mean.mean(axis=(1, 3)).astype(np.float64)
    return Shot(small[..., :3], small[..., 3], *_joints(simulation, camera, size))


def _joints(
    simulation: Simulation, camera: FreeCamera, size: tuple[int, int]
) -> tuple[Array, Array, Array]:
    crowd, clock = simulation.crowd, simulation.clock
    palettes = crowd.palettes(np.arange(len(crowd)), clock.pose_tick, clock.alpha).astype(float)
    bind = np.ones((crowd.character.skeleton.joint_count, 4))
    bind[:, :3] = bind_positions(crowd.character.skeleton)
    model = np.einsum("njrc,jc->njr", palettes, bind) * crowd.placement.scale[:, None, None]
    yaw = crowd.placement.yaw.astype(float)[:, None]
    turned = model.copy()
    turned[..., 0] = np.cos(yaw) * model[..., 0] + np.sin(yaw) * model[..., 2]
    turned[..., 2] = np.cos(yaw) * model[..., 2] - np.sin(yaw) * model[..., 0]
    world = turned + crowd.placement.position.T.astype(float)[:, None]
    below = world.copy()
    below[..., 1] = crowd.placement.position[1][:, None]
    matrix = camera.projection(size).astype(float) @ camera.view().astype(float)
    return _pixels(world, matrix, size), _pixels(below, matrix, size), turned[..., 1]


def _pixels(points: Array, matrix: Array, size: tuple[int, int]) -> Array:
    clip = np.concatenate([points, np.ones((*points.shape[:-1], 1))], axis=-1) @ matrix.T
    flat = clip[..., :2] / clip[..., 3:]
    pixels: Array = (flat * (1.0, -1.0) + 1.0) / 2.0 * np.array(size)
    return pixels


def to_linear(srgb: Array) -> Array:
    """IEC 61966-2-1, 0 to 1."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def to_srgb(linear: Array) -> Array:
    """The way back from `to_linear`."""
    light = np.clip(linear, 0.0, 1.0)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)

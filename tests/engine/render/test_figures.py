"""Agents of a few pixels: where the shader puts them, and what the picture shows."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.components import AgentAnimID, Appearance, Detail, Placement, Transition
from tifo.engine.animation import ClipBank
from tifo.engine.assets.spectator import builtin_spectator
from tifo.engine.crowd.figure import make_figure
from tifo.engine.streams import StreamPool
from tifo.engine.streams.blending import agent_palettes
from tifo.engine.streams.pool import bind_positions
from tifo.scripting.camera import look_at, perspective

pytestmark = pytest.mark.gl

Array = NDArray[Any]
ARMS_UP = ("cheer", 0.9)
STANDING = ("stand_idle", 0.0)
SITTING = ("sit_idle", 0.0)


class Figures:
    """Spectators in a row, each on a stream of its own, all drawn as figures of strokes."""

    def __init__(self, shown: list[tuple[str, float]], spacing: float = 1.2) -> None:
        self.character = builtin_spectator()
        self.figure = make_figure(self.character)
        bank = ClipBank(self.character.skeleton, self.character.clips)
        self.pool = StreamPool(
            self.character.skeleton,
            bank,
            capacity=len(shown),
            history=14,
            markers=self.figure.joints,
        )
        for clip, time in shown:
            self.pool.add(clip, time=time - 4 / 30)
        for tick in range(5):
            self.pool.evaluate(tick)
            self.pool.commit(tick)
        count = len(shown)
        self.anim = AgentAnimID.allocate(1, count, 0)
        self.anim.row[0] = np.arange(count)
        self.transition = Transition.allocate(1, count)
        position = np.zeros((3, count), np.float32)
        position[0] = (np.arange(count) - (count - 1) / 2) * spacing
        zeros = np.zeros(count, np.float32)
        self.placement = Placement(position, zeros.copy(), zeros + np.float32(1.0))
        colour = np.full((count, 4), 255, np.uint8)
        self.appearance = Appearance(
            *(colour * np.array([*rgb, 1.0]) for rgb in np.zeros((5, 3)))  # set below
        )
        for name, rgb in (
            ("skin", (205, 150, 120)),
            ("hair", (60, 40, 25)),
            ("shirt", (200, 20, 30)),
            ("trousers", (30, 40, 90)),
            ("shoes", (20, 20, 20)),
        ):
            setattr(self.appearance, name, np.tile(np.array([*rgb, 255], np.uint8), (count, 1)))

    def joints(self, tick: int, alpha: float) -> NDArray[np.float64]:
        """(N, 7, 3) markers in the stadium, from the palettes of the CPU."""
        agents = np.arange(len(self.placement.yaw))
        palettes = agent_palettes(
            self.pool, self.anim, self.transition, 0, agents, tick, alpha
        ).astype(float)
        chosen = self.figure.joints
        bind = bind_positions(self.character.skeleton)[chosen].astype(float)
        model = np.einsum("akij,kj->aki", palettes[:, chosen, :, :3], bind)
        model += palettes[:, chosen, :, 3]
        sin, cos = np.sin(self.placement.yaw), np.cos(self.placement.yaw)
        x, y, z = np.moveaxis(model, 2, 0)
        turned = np.stack(
            [cos[:, None] * x + sin[:, None] * z, y, cos[:, None] * z - sin[:, None] * x], axis=2
        )
        return self.placement.position.T[:, None] + self.placement.scale[:, None, None] * turned

    def renderer(self) -> Any:
        """The real renderer, with everybody at the farthest level."""
        from tifo.engine.render.crowd_renderer import CrowdColumns, CrowdRenderer

        nobody = np.zeros(0, np.uint32)
        detail = Detail(
            (nobody, nobody, nobody, np.arange(len(self.placement.yaw), dtype=np.uint32))
        )
        poses = (self.pool, self.anim, self.transition)
        columns = CrowdColumns(self.placement, self.appearance, detail, poses)
        return CrowdRenderer(self.character, self.figure.height, columns)


def camera(
    eye: tuple[float, float, float], size: tuple[int, int], high: float
) -> tuple[Array, Array]:
    """View and projection from `eye` to the middle of a standing body, `high` metres in view."""
    target = np.array([0.0, 0.9, 0.0])
    away = float(np.linalg.norm(np.array(eye) - target))
    field = 2.0 * np.arctan(high / 2.0 / away)
    return look_at(np.array(eye), target), perspective(field, size[0] / size[1], 0.5, 500.0)

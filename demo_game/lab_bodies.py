"""Stations of the lab about single agents: overlays, parts, heads that follow a ball, bodies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

import tifo

from .lab_station import TWINS, Station

BALL_RADIUS = 0.13
BALL_PERIOD = 4.0


class OverlayStation(Station):
    """Agents who sit, each with something else laid over it."""

    title = "Overlays"
    OVER = (("wave", "arm_r"), ("clap", "arms"), ("dismay", "upper_body"))

    def __init__(self, simulation: tifo.Simulation, agents: NDArray[np.int64]) -> None:
        super().__init__(simulation, agents)
        self.stand(agents, seated=True)
        for agent, (clip, mask) in zip(agents, self.OVER, strict=True):
            self.crowd.overlay(int(agent), self.pool.add(clip), mask, offset=0.0)

    @property
    def text(self) -> str:
        """What goes on beneath."""
        over = ", ".join(clip for clip, _ in self.OVER)
        return f"all sit; {over} over it"

    def labels(self) -> Sequence[str]:
        """Which joints follow it."""
        return [mask for _, mask in self.OVER]


class PartStation(Station):
    """A cap, a scarf, and a flag on a skeleton of its own."""

    title = "Parts"

    def __init__(self, simulation: tifo.Simulation, agents: NDArray[np.int64]) -> None:
        super().__init__(simulation, agents)
        self.stand(agents[:2])
        self.stand(agents[2:], seated=True)
        self.parts = []
        for agent, name in zip(agents, ("cap", "scarf", "flag"), strict=True):
            prop = tifo.builtin_prop(name)
            part = simulation.add_part(
                name, prop.character, hook=prop.hook, transform=prop.transform, agents=int(agent)
            )
            self.parts.append(part)
        flag = self.parts[2]
        flag.transition_to_streamed(int(agents[2]), flag.streams("wave")[0], duration=0.0)

    @property
    def text(self) -> str:
        """What they have."""
        counts = [part.character.skeleton.joint_count for part in self.parts]
        return f"with {', '.join(map(str, counts[:-1]))} and {counts[-1]} joints of their own"

    def labels(self) -> Sequence[str]:
        """Their names."""
        return [part.name for part in self.parts]


class LookStation(Station):
    """Heads that follow a ball, which is a part of the first agent with a live motion."""

    title = "Joint override"

    def __init__(self, simulation: tifo.Simulation, agents: NDArray[np.int64]) -> None:
        super().__init__(simulation, agents)
        self.stand(agents)
        everybody = np.arange(len(self.crowd))
        self.look = tifo.look_at()
        self.crowd.add_override(self.look)
        self.crowd.override_values(self.look.name, everybody, (0.0, 0.0, 0.0, 0.0))
        self.crowd.override_values(self.look.name, agents, (1.0, 0.05, 0.0, 0.0))
        self._part = simulation.add_part(
            "ball", _ball(BALL_RADIUS), uniques=1, agents=int(agents[0])
        )
        self._live = self._part.uniques.add()
        self._part.transition_to_unique(int(agents[0]), self._live, duration=0.0)
        self.advance(0.0)

    def advance(self, time: float) -> None:
        """Move the ball to and fro before the agents."""
        places = self.crowd.placement.position[:, self.agents].astype(float)
        share = 0.5 - 0.5 * np.cos(2.0 * np.pi * time / BALL_PERIOD + 1.75)
        self.ball = places[:, 0] + share * (places[:, -1] - places[:, 0])
        self.ball += (0.0, 0.95 + 0.35 * np.sin(4.0 * np.pi * time / BALL_PERIOD), 1.3)
        pose = np.zeros((10, 1), np.float32)
        pose[3], pose[7:] = 1.0, 1.0
        pose[4:7, 0] = (self.ball - places[:, 0]) / self.crowd.placement.scale[self.agents[0]]
        self._part.uniques.write(self._live, pose)
        self.look.aim(self.ball, max(time - self._time, 0.0))
        super().advance(time)

    def turns(self) -> NDArray[np.float64]:
        """(K,) radians that the heads are turned to the agents' left."""
        clock, head = self.simulation.clock, self.crowd.character.skeleton.index("head")
        palettes = self.crowd.palettes(self.agents, clock.pose_tick, clock.alpha)
        return np.arctan2(palettes[:, head, 0, 2], palettes[:, head, 2, 2]).astype(np.float64)

    @property
    def text(self) -> str:
        """What heads do."""
        return "heads turn to the ball, by GLSL in the shader"

    def labels(self) -> Sequence[str]:
        """How far the heads are turned."""
        return [f"{abs(np.degrees(turn)):.0f}°" for turn in self.turns()]


class BodyStation(Station):
    """A child, an old person, and slim and wide ones, on the same streams."""

    title = "Bodies"
    BUILDS = (
        ("adult", 0, 0.0, 1.0),
        ("child", 1, 0.0, 0.72),
        ("old", 2, 0.02, 0.97),
        ("slim", 0, -0.025, 1.04),
        ("wide", 0, 0.09, 1.0),
    )
    """What they are called, body type, girth in metres, scale."""

    def __init__(self, simulation: tifo.Simulation, agents: NDArray[np.int64]) -> None:
        super().__init__(simulation, agents)
        crowd = self.crowd
        for agent, (_, kind, girth, scale) in zip(agents, self.BUILDS, strict=True):
            crowd.body.kind[agent], crowd.body.girth[agent] = kind, girth
            crowd.placement.scale[agent] *= scale
        crowd.body.version += 1
        crowd.placement.version += 1
        stream = self.pool.add("stand_idle")
        for name in TWINS:
            self.pool.add_twin(stream, name)
        for agent in agents:
            self.play(int(agent), stream)

    @property
    def text(self) -> str:
        """What differs."""
        return "one stream; bones, girth and size differ"

    def labels(self) -> Sequence[str]:
        """What they are."""
        return [name for name, *_ in self.BUILDS]


def _ball(radius: float) -> tifo.Character:
    """A football on the single joint of the cap."""
    rings, corners = 24, 32
    polar = np.linspace(0.0, np.pi, rings + 1)[:, None]
    angle = np.linspace(0.0, 2.0 * np.pi, corners + 1)[None]
    normals = np.stack(
        [np.sin(polar) * np.cos(angle), np.cos(polar) + 0 * angle, np.sin(polar) * np.sin(angle)],
        axis=-1,
    ).reshape(-1, 3)
    index = np.arange((rings + 1) * (corners + 1)).reshape(rings + 1, corners + 1)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    faces = np.concatenate([np.stack(three, -1).reshape(-1, 3) for three in ((a, b, c), (a, c, d))])
    # Dark patches round the corners of an icosahedron.
    golden = 0.5 * (1.0 + np.sqrt(5.0))
    corner = np.array([(0, s, t * golden) for s in (-1, 1) for t in (-1, 1)])
    spots = np.concatenate([np.roll(corner, k, axis=1) for k in range(3)]) / np.hypot(1, golden)
    near = np.clip(((normals @ spots.T).max(axis=1) - 0.90) / 0.04, 0.0, 1.0)[:, None]
    shade = 0.92 + near * (0.02 - 0.92)
    count = len(normals)
    mesh = tifo.SkinnedMesh(
        name="ball",
        positions=(radius * normals).astype(np.float32),
        normals=normals.astype(np.float32),
        uvs=np.zeros((count, 2), np.float32),
        colors=np.concatenate([np.repeat(shade, 3, 1), np.ones((count, 1))], 1).astype(np.float32),
        joints=np.zeros((count, 4), np.uint16),
        weights=np.tile(np.array([1, 0, 0, 0], np.float32), (count, 1)),
        triangles=faces.astype(np.uint32),
    )
    cap = tifo.builtin_prop("cap").character
    return replace(
        cap, name="ball", meshes=(mesh,), materials=(tifo.Material("ball"),), lower_levels=()
    )

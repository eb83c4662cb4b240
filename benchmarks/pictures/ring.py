"""The ring of a stream's last poses, and where the agents of a real crowd are on it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ...engine.crowd.spec import CrowdSpec
from ...engine.streams.displayed import offset_at
from ...engine.streams.pool import Stream
from ...systems.simulation import Simulation
from .canvas import BLUE, FAINT, GROUND, INK, ORANGE, PALE, Canvas, Place, mixed
from .figures import draw_figure

HISTORY, CLIP = 60, "jump"
DRIFTER, DRIFT_FROM, DRIFT_TO, DRIFT_SECONDS = 0, 20.0, 44.0, 4.0
"""The agent that is dilated, its offsets before and after, and how long that may take."""
_SIZE = (900, 830)
_MIDDLE = (450.0, 445.0)
_INNER, _OUTER = 215.0, 250.0
_DOT = 5.5


def make_crowd() -> tuple[Simulation, Stream]:
    """A crowd of which everybody plays one stream; one agent's offset is on its way elsewhere."""
    spec = CrowdSpec(
        layout="stand",
        rows=6,
        columns=6,
        occupancy=1.0,
        streams=39,
        spare_streams=1,
        history=HISTORY,
        children=0.0,
        old=0.0,
        props=0.0,
        seed=5,
    )
    simulation = Simulation(spec)
    crowd = simulation.crowd
    assert crowd.pool is not None
    crowd.guide(motion="stand_idle")  # so that nobody goes elsewhere
    stream = crowd.pool.add(CLIP)
    simulation.run(seconds=max(HISTORY / 30, 4.0))
    crowd.transition_to_streamed(np.arange(len(crowd)), stream, duration=0.0)
    crowd.transition_to_streamed(DRIFTER, stream, duration=0.0, offset=DRIFT_FROM)
    simulation.run(seconds=0.2)
    crowd.dilate(np.array([DRIFTER]), np.array([DRIFT_TO], np.float32), DRIFT_SECONDS)
    simulation.run(seconds=0.8)
    return simulation, stream


def offsets(
    simulation: Simulation, stream: Stream
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Agents (K,) on the stream, and how many poses behind its head they play now."""
    anim = simulation.crowd.anim
    assert anim is not None
    agents = np.flatnonzero(anim.row[0] == stream.row)
    start, target, rate = (column[0, agents] for column in (anim.start, anim.target, anim.rate))
    since = simulation.clock.pose_tick - anim.t0[0, agents].astype(float)
    return agents, offset_at(start, target, rate, since)


def draw_ring() -> Image.Image:
    """The picture."""
    simulation, stream = make_crowd()
    crowd = simulation.crowd
    pool = crowd.pool
    assert pool is not None
    store, row = pool.store, stream.row
    head, valid = int(pool.head[row]), int(pool.valid[row])
    canvas = Canvas(*_SIZE)
    for age in range(store.capacity):
        corners = ((_INNER, 0.44), (_INNER, -0.44), (_OUTER, -0.44), (_OUTER, 0.44))
        cell = [_polar(radius, age + aside, store.capacity) for radius, aside in corners]
        if age >= valid:
            canvas.line([*cell, cell[0]], PALE, 1.2)
            continue
        canvas.polygon(cell, mixed(BLUE, GROUND, 0.1 + 0.72 * age / valid))
        if age % 4 == 0:
            x, y = _polar(_OUTER + 56, age, store.capacity)
            pose = store.ring[store.slice_of(head - age), row]
            shade = mixed(INK, GROUND, 0.6 * age / valid)
            draw_figure(canvas, pool.skeleton, pose, (x, y + 38), 42, shade)
    _draw_agents(canvas, simulation, stream, store.capacity)
    canvas.text((_MIDDLE[0], 26), "One stream's ring, and the agents on it", 20)
    words = f"stream {row}: {CLIP}\nM = {int(pool.history[row])} poses, a ring of {store.capacity}"
    canvas.text((_MIDDLE[0], _MIDDLE[1] - 66), words, 16)
    canvas.text(
        (_MIDDLE[0], _MIDDLE[1] - 14), "a dot is an agent,\no poses behind the head", 14, FAINT
    )
    x, y = _polar(_OUTER + 132, 0.0, store.capacity)
    canvas.text((x, y), f"head, pose tick {head}", 15, BLUE)
    x, y = _polar(_OUTER + 34, store.capacity - 2.5, store.capacity)
    canvas.text((x, y), "the next poses\nare written here", 13, FAINT, "lm")
    return canvas.finish()


def _draw_agents(canvas: Canvas, simulation: Simulation, stream: Stream, capacity: int) -> None:
    """Dots inside the ring, farther in where they would overlap."""
    agents, behind = offsets(simulation, stream)
    taken: list[Place] = []
    for agent, offset in sorted(zip(agents, behind, strict=True), key=lambda pair: pair[1]):
        radius = _INNER - 12.0
        place = _polar(radius, offset, capacity)
        while any(math.dist(place, other) < 2.1 * _DOT for other in taken):
            radius -= 2.0
            place = _polar(radius, offset, capacity)
        taken.append(place)
        canvas.disc(place, _DOT, ORANGE if agent == DRIFTER else INK)
        if agent == DRIFTER:
            inner = radius - 34.0
            steps = np.linspace(offset, DRIFT_TO, 30)
            canvas.arrow([_polar(inner, float(step), capacity) for step in steps], ORANGE, 2.0)
            canvas.line([place, _polar(inner, offset, capacity)], ORANGE, 1.5)
            label = _polar(inner - 62, 0.5 * (offset + DRIFT_TO), capacity)
            words = f"dilates from {DRIFT_FROM:.0f}\nto {DRIFT_TO:.0f}, now {offset:.1f}"
            canvas.text(label, words, 13, ORANGE)


def _polar(radius: float, age: float, capacity: int) -> Place:
    """The head is at the top; older poses lie to its left."""
    angle = -2.0 * math.pi * age / capacity
    return _MIDDLE[0] + radius * math.sin(angle), _MIDDLE[1] - radius * math.cos(angle)

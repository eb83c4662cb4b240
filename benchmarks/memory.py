"""What the poses of a crowd take: bytes a pose and a clip, streamed and baked, and copied a tick.

*Streams 2017*, section 5, asks how many clips fit into 520 MB of graphics memory. Every figure here
is the size of an array that a crowd really has, or of what a tick really marked for copying.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..engine.animation.clip_bank import ClipBank
from ..engine.behaviour.events import Goal
from ..engine.crowd.spec import CrowdSpec
from ..engine.streams.baked import BakedPoses
from ..engine.streams.store import DirtyPoses, PoseStore
from ..systems.crowd import Crowd
from ..systems.simulation import Simulation
from .measure import environment
from .synthetic import synthetic_character

BUDGET = 520 * 2**20
"""Bytes of graphics memory for poses, as in the paper."""
AGENT_BYTES = 48
"""What one agent takes in the animation table that shaders read."""


def memory(
    *,
    agents: int,
    streams: int,
    joints: int,
    history: int,
    slots: int = 800,
    runs: int = 60,
    seed: int = 1,
) -> dict[str, Any]:
    """Measure the buffers of a crowd.

    Parameters
    ----------
    agents, streams, joints, history, slots
        Size of the crowd; every seat is taken.
    runs
        Quiet pose ticks whose copies are counted, and as many after a goal.
    seed
        Of crowd and character.
    """
    spec = CrowdSpec(
        seats=agents,
        occupancy=1.0,
        sides=2,
        streams=streams,
        history=history,
        slots=slots,
        seed=seed,
    )
    character = synthetic_character(joints, np.random.default_rng(seed))
    baked = BakedPoses(character.skeleton, ClipBank(character.skeleton, character.clips))
    simulation = Simulation(spec, character)
    crowd = simulation.crowd
    assert crowd.pool is not None
    store = crowd.pool.store
    copied = _Copied(crowd)
    quiet = [copied.tick(simulation) for _ in range(runs)]
    simulation.send(Goal(side=0))
    goal = [copied.tick(simulation) for _ in range(runs)]
    simulation.close()
    streamed_clip = store.ring[:, 0].nbytes
    baked_clip = baked.nbytes // len(baked.frames)
    return {
        "benchmark": "memory",
        "agents": agents,
        "streams": streams,
        "joints": joints,
        "history_poses": history,
        "ring_poses": store.capacity,
        "pose_bytes": store.ring[0, 0].nbytes,
        "clip_streamed_bytes": streamed_clip,
        "clip_baked_bytes": baked_clip,
        "clip_baked_frames": float(np.mean(baked.frames)),
        "budget_bytes": BUDGET,
        "clips_streamed": BUDGET // streamed_clip,
        "clips_baked": BUDGET // baked_clip,
        "ring_bytes": store.ring.nbytes,
        "unique_bytes": store.static[1 : 1 + 2 * store.uniques].nbytes,
        "slot_bytes": store.static[1 + 2 * store.uniques :].nbytes,
        "marker_bytes": store.ring_markers.nbytes + store.static_markers.nbytes,
        "copied_bytes_quiet_tick": int(np.median(quiet)),
        "copied_bytes_goal_tick": int(np.max(goal)),
        "environment": environment(),
    }


class _Copied:
    """Counts what drawing would copy after each pose tick."""

    def __init__(self, crowd: Crowd) -> None:
        assert crowd.pool is not None
        assert crowd.anim is not None
        self._store, self._anim = crowd.pool.store, crowd.anim
        self._table = AGENT_BYTES * len(crowd)
        self._version = self._anim.version
        self._dirty = self._store.mirror()
        self._dirty.take()

    def tick(self, simulation: Simulation) -> int:
        """Bytes after one more pose tick."""
        simulation.run(seconds=2 / 60)
        changed = self._anim.version != self._version
        self._version = self._anim.version
        return _pose_bytes(self._store, self._dirty.take()) + changed * self._table


def _pose_bytes(store: PoseStore, dirty: DirtyPoses) -> int:
    """Slices and static rows that changed, and the table of heads, which goes with every tick."""
    total = 16 * (store.stream_rows + store.uniques)
    for array, markers, rows in (
        (store.ring, store.ring_markers, dirty.slices),
        (store.static, store.static_markers, dirty.static_rows),
    ):
        total += len(rows) * (array[0].nbytes + markers[0].nbytes)
    return total

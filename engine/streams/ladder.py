"""The blend ladder: how an agent that is asked for another motion gets there.

*Streams 2017*, 4.3, and *Techniques 2022*, 4.3, with what happens when there is too much to do:

1. An agent that rests blends from its motion to the wanted one. Any number may do so at once.
2. An agent in the middle of a blend has what it shows written into a slot, and blends from there.
3. If no slot is free, the request waits; the running blend hurries to its end, and then it begins.
4. Far from the focus, a request that has waited too long begins with a jump.

A later request replaces one that waits, so every agent ends on its last request. Nothing here
fails: counters say which rung was used.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.animation import AgentAnimID, Transition
from ...components.placement import Placement
from .blend_counts import BlendCounts, LadderCounts
from .blending import (
    agent_palettes,
    begin_blend,
    blend_progress,
    come_from_slots,
    end_finished,
    hurry,
    source_palettes,
)
from .pool import StreamPool
from .slots import SlotPool
from .uniques import UniquePool

HURRIED = 6.0
"""Pose ticks that a whole blend takes when a request waits for its end."""
PATIENCE = 3
"""Pose ticks that a request may wait before an agent far from the focus jumps."""
AFTER_CUT = 12.0
"""Pose ticks in which agents blend from what their stream showed before a cut."""
_AT_ONCE = 64
"""Snapshots that are evaluated together: about as much as a core's cache holds."""


@dataclass(frozen=True, slots=True)
class Focus:
    """Where people look, metres, and the distance from there up to which nobody ever jumps."""

    place: tuple[float, float, float]
    radius: float


class BlendLadder:
    """Requests of one crowd for other motions, and how they are met.

    Parameters
    ----------
    pool, uniques, slots
        Motions, and snapshots to blend from.
    anim, transition
        Columns that are changed.
    placement
        Where the agents are.
    kind
        (N,) their body types; all are built like the skeleton if None.

    Attributes
    ----------
    counts
        Which rungs were used.
    focus
        None lets nobody jump. An input: what is set is used from the next pose tick on.
    """

    def __init__(
        self,
        pool: StreamPool,
        uniques: UniquePool,
        slots: SlotPool,
        anim: AgentAnimID,
        transition: Transition,
        placement: Placement,
        kind: NDArray[np.uint8] | None = None,
    ) -> None:
        self.pool = pool
        self.uniques = uniques
        self.slots = slots
        self.anim = anim
        self.transition = transition
        self.placement = placement
        self.kind = kind
        self.counts = LadderCounts()
        self.focus: Focus | None = None
        self._tick = 0
        pool.before_cut.append(self.before_cut)
        uniques.before_cut.append(self.before_cut)

    def own_rows(
        self, agents: NDArray[np.int64], row: NDArray[np.int32] | int
    ) -> NDArray[np.int32] | int:
        """Rows that show motions on the body types of agents (K,), as far as there are any."""
        if self.kind is None:
            return row
        return self.pool.twins.resolve(row, self.kind[agents])

    def ask(
        self,
        part: int,
        agents: NDArray[np.int64],
        row: NDArray[np.int32] | int,
        offset: NDArray[np.float32] | float,
        duration: NDArray[np.float32] | float,
    ) -> None:
        """Ask agents for another motion; it begins at the next `step`, or later.

        Parameters
        ----------
        part, agents
            Part, and (K,) ids.
        row, offset, duration
            (K,) each, or one for all: unified pose index, offset in poses (NaN is drawn when the
            blend begins) and pose ticks of the blend (0 jumps).
        """
        transition, at = self.transition, (part, agents)
        transition.next_since[part, agents[transition.next_row[at] < 0]] = -1
        transition.next_row[at] = row
        transition.next_offset[at] = offset
        transition.next_duration[at] = duration
        transition.asked[at] = True

    def step(self, tick: int, rng: np.random.Generator) -> None:
        """Meet the requests at pose tick `tick`, before its poses are evaluated.

        Pictures so far have shown times up to ``tick - 1``, so that is where blends begin.

        Parameters
        ----------
        tick
            Pose tick.
        rng
            Where offsets come from that nobody chose.
        """
        self._tick = tick
        self.counts.tick = BlendCounts()
        end_finished(self.anim, self.transition, tick, self.slots)
        for part, wanted in enumerate(self.transition.next_row):
            # Mostly nobody wants anything, and a maximum is quicker than a mask.
            if wanted.max(initial=-1) >= 0:
                self._answer(part, np.flatnonzero(wanted >= 0), tick, rng)

    def _answer(
        self, part: int, agents: NDArray[np.int64], tick: int, rng: np.random.Generator
    ) -> None:
        transition = self.transition
        transition.asked[part, agents] = False
        jumps = transition.next_duration[part, agents] == 0
        self._jump(part, agents[jumps], tick, rng)
        agents = agents[~jumps]
        blending = transition.duration[part, agents] > 0
        resting, busy = agents[~blending], agents[blending]
        if len(resting):
            self._begin(part, resting, tick, rng)
            self._count("two_source", len(resting))
        # Who waits longest is first.
        since = transition.next_since[part, busy]
        busy = busy[np.argsort(np.where(since < 0, tick, since), kind="stable")]
        kept, slots = self._take(part, busy)
        if len(kept):
            self._snapshot(part, kept, slots, tick)
            self._begin(part, kept, tick, rng)
            come_from_slots(transition, part, kept, slots)
            self._count("snapshot", len(kept))
        if len(kept) < len(busy):
            self._defer(part, np.setdiff1d(busy, kept), tick, rng)

    def _defer(
        self, part: int, agents: NDArray[np.int64], tick: int, rng: np.random.Generator
    ) -> None:
        since = self.transition.next_since
        new = agents[since[part, agents] < 0]
        since[part, new] = tick
        self._count("deferred", len(new))
        late = (tick - since[part, agents] >= PATIENCE) & self._is_far(agents)
        self._jump(part, agents[late], tick, rng)
        waiting = agents[~late]
        slow = waiting[self.transition.duration[part, waiting] > 1.1 * HURRIED]
        if len(slow):
            hurry(self.anim, self.transition, part, slow, tick - 1, HURRIED)

    def _begin(
        self, part: int, agents: NDArray[np.int64], tick: int, rng: np.random.Generator
    ) -> None:
        """Turn requests into blends that leave what `anim` says."""
        transition, at = self.transition, (part, agents)
        row, offset = transition.next_row[at], transition.next_offset[at]
        drawn = np.flatnonzero(np.isnan(offset))
        if len(drawn):
            stream = row[drawn] < self.pool.store.stream_rows
            longest = np.where(stream, self.pool.room(np.where(stream, row[drawn], 0)), 0)
            offset[drawn] = rng.random(len(drawn)) * longest
        duration = transition.next_duration[at]
        begin_blend(self.anim, transition, part, agents, row, offset, tick - 1, duration)
        # Clip events know by it that the agent entered in this tick.
        self.anim.t0[at] = tick
        transition.next_row[at] = -1

    def _jump(
        self, part: int, agents: NDArray[np.int64], tick: int, rng: np.random.Generator
    ) -> None:
        if not len(agents):
            return
        blending = agents[self.transition.duration[part, agents] > 0]
        self.slots.release(self.transition.row[part, blending])
        self._begin(part, agents, tick, rng)
        self.transition.duration[part, agents] = 0.0
        self._count("cut", len(agents))

    def _take(
        self, part: int, agents: NDArray[np.int64]
    ) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
        """Agents that get a slot, and which: their own, if their blend comes from one."""
        rows = self.transition.row[part, agents]
        own = self.slots.holds(rows) & (self.transition.duration[part, agents] > 0)
        others = agents[~own]
        new = self.slots.take(len(others))
        return (
            np.concatenate([agents[own], others[: len(new)]]),
            np.concatenate([rows[own], new]),
        )

    def _snapshot(
        self,
        part: int,
        agents: NDArray[np.int64],
        rows: NDArray[np.int32],
        tick: int,
        *,
        source: bool = False,
    ) -> None:
        """Write what agents show at ``tick - 1``, or the source of their blends, into slots."""
        store = self.pool.store
        for first in range(0, len(agents), _AT_ONCE):
            some = agents[first : first + _AT_ONCE]
            if source:
                poses = source_palettes(self.pool, self.transition, part, some, tick, 0.0)
            else:
                poses = agent_palettes(self.pool, self.anim, self.transition, part, some, tick, 0.0)
            static = rows[first : first + _AT_ONCE].astype(np.int64) - store.stream_rows
            store.write_static(static, poses, self.pool.markers.places(poses))

    def close(self) -> None:
        """Give the slots of running blends back, and heed a pool that stays no more."""
        blending = self.transition.duration > 0
        self.slots.release(self.transition.row[blending])
        self.pool.before_cut.remove(self.before_cut)
        self.uniques.before_cut.remove(self.before_cut)

    def before_cut(self, row: int, removed: bool) -> None:
        """Save what agents show of a stream or unique whose poses are about to be lost.

        Agents on it blend from a snapshot to what comes after the cut, or to the bind pose if it
        is removed. Blends that leave it go on from a snapshot. Where no slot is free, agents jump.

        Parameters
        ----------
        row
            Unified index of the stream or unique.
        removed
            Whether nothing comes after. Requests for it that wait are dropped.
        """
        for part in range(len(self.anim.row)):
            self._leave(part, row, removed)

    def _leave(self, part: int, row: int, removed: bool) -> None:
        anim, transition, now = self.anim, self.transition, self._tick
        blending = transition.duration[part] > 0
        agents = np.flatnonzero(anim.row[part] == row)
        leaving = np.flatnonzero(blending & (transition.row[part] == row) & (anim.row[part] != row))
        if self._has_poses(row):
            kept, slots = self._take(part, agents)
            self._snapshot(part, kept, slots, now + 1)
            at = (part, kept)
            done = blend_progress(transition.begin[at], transition.duration[at], now)
            left = np.maximum((1.0 - done) * transition.duration[at], HURRIED)
            transition.duration[at] = np.where(blending[kept], left, AFTER_CUT)
            transition.begin[at] = now
            come_from_slots(transition, part, kept, slots)
            leavers, slots = self._take(part, leaving)
            self._snapshot(part, leavers, slots, now + 1, source=True)
            come_from_slots(transition, part, leavers, slots)
            self._count("snapshot", len(kept) + len(leavers))
            self._count("cut", len(agents) - len(kept) + len(leaving) - len(leavers))
            transition.duration[part, np.setdiff1d(leaving, leavers)] = 0.0
        else:
            transition.duration[part, leaving] = 0.0
        if removed:
            anim.row[part, agents] = self.pool.store.bind_row
            waiting = transition.next_row[part] == row
            transition.next_row[part, waiting] = -1
        anim.version += len(agents) + len(leaving) > 0

    def _has_poses(self, row: int) -> bool:
        store = self.pool.store
        if row < store.stream_rows:
            return bool(self.pool.valid[row] > 0)
        return bool(store.unique_valid[(row - store.first_unique) // 2] > 0)

    def _is_far(self, agents: NDArray[np.int64]) -> NDArray[np.bool_]:
        if self.focus is None:
            return np.zeros(len(agents), np.bool_)
        apart = self.placement.position[:, agents] - np.array(self.focus.place)[:, None]
        far: NDArray[np.bool_] = np.sqrt((apart**2).sum(axis=0)) > self.focus.radius
        return far

    def _count(self, name: str, count: int) -> None:
        if count:
            more = BlendCounts(**{name: count})
            self.counts.tick.add(more)
            self.counts.total.add(more)

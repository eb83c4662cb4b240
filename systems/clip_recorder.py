"""Takes down which clips agents play from when to when, pose tick by pose tick."""

from __future__ import annotations

from typing import Any, NamedTuple

import esper
import numpy as np
from numpy.typing import NDArray

from ..engine.animation.clip import rest_clip
from ..engine.crowd.ways import Ways
from ..engine.export.clip_schedule import ClipSchedule
from ..engine.streams.displayed import offset_at
from ..engine.streams.pool import POSE_RATE
from .crowd import Crowd
from .observing import CrowdObserver, Observers
from .recording import Agents, present_agents

JUMP = 0.15
"""Seconds by which a place in a clip must differ from where it should be to be another instance."""
_HELD = 1e-6


class _Playing(NamedTuple):
    """What A agents play in one pose tick.

    `clip` is an index in the crowd's clips, or their number + the row of a stream that plays no
    clip; `row` tells motions apart; `place` and `pace` are seconds in the clip, and those that pass
    in a pose tick; `period` is the length of a clip that loops, else infinite.
    """

    row: NDArray[np.int64]
    clip: NDArray[np.int64]
    place: NDArray[np.float64]
    pace: NDArray[np.float64]
    period: NDArray[np.float64]


class ClipRecorder(CrowdObserver):
    """Clip instances of some agents' bodies; `Crowd.watch_clips` makes one.

    Overlays and parts are motions of their own and are not in it.

    Parameters
    ----------
    crowd, agents
        Whose clips; agents as for `present_agents`.
    observers
        Where it was added, for `finish`.

    Raises
    ------
    ValueError
        For agents that don't exist, or nobody.
    """

    def __init__(
        self, crowd: Crowd, agents: Agents = None, *, observers: Observers | None = None
    ) -> None:
        self._crowd, self._observers = crowd, observers
        self._ids = present_agents(crowd, agents)
        bank = None if crowd.pool is None else crowd.pool.bank.clips
        self._clips = bank or crowd.character.clips or (rest_clip(crowd.character.skeleton),)
        lengths = [clip.duration if clip.looping else 0.0 for clip in self._clips]
        self._periods = np.array([length if length > 0 else np.inf for length in lengths])
        self._lead = self._leads()
        self._began = self._tick = crowd.behaviour.tick
        count = len(self._ids)
        self._now = self._playing(self._tick)
        self._start = np.full(count, self._tick, np.int64)
        self._from = self._now.place.copy()
        self._played = np.zeros(count)
        self._blend = np.zeros(count)
        self._state = crowd.behaviour.state[0, self._ids].astype(np.int64)
        self._done: list[tuple[NDArray[np.float64], ...]] = []

    def see(self, tick: int) -> None:
        """Take down pose tick `tick`."""
        if tick <= self._tick:
            return
        before, now = self._now, self._playing(tick)
        passed = (tick - self._tick) * before.pace
        off = now.place - before.place - passed
        off -= np.where(np.isfinite(before.period), before.period, 0.0) * np.round(
            off / before.period
        )
        other = (now.row != before.row) | (now.clip != before.clip) | (np.abs(off) > JUMP)
        self._played += np.where(other, passed, passed + off)
        self._tick = tick
        new = np.flatnonzero(other)
        if len(new):
            self._close(new, tick)
            ids = self._ids[new]
            self._start[new], self._from[new], self._played[new] = tick, now.place[new], 0.0
            self._state[new] = self._crowd.behaviour.state[0, ids]
            self._blend[new] = 0.0
            if self._crowd.transition is not None:
                self._blend[new] = self._crowd.transition.duration[0, ids] / POSE_RATE
        self._now = now

    def finish(self) -> ClipSchedule:
        """What was played until now; sees no more.

        Raises
        ------
        ValueError
            If no pose tick has passed.
        """
        if self._tick == self._began:
            raise ValueError("no pose tick has passed, so nothing was played")
        if self._observers is not None:
            self._observers.remove(self)
        # What only just began has not lasted yet.
        self._close(np.flatnonzero(self._start < self._tick), self._tick)
        parts = [np.concatenate(parts) for parts in zip(*self._done, strict=True)]
        order = np.lexsort((parts[3], parts[0]))
        agent, code, state, start, end, source, played, blend, period = (p[order] for p in parts)
        clip, names, durations, looping = self._describe(code.astype(np.int64))
        length = (end - start) / POSE_RATE
        holds = played < _HELD
        cycles = np.where(holds, 1.0, np.maximum(played / period, 1.0))
        crowd, ids = self._crowd, self._ids
        return ClipSchedule(
            seconds=(self._tick - self._began) / POSE_RATE,
            agents=ids,
            labels=tuple(crowd.plan.label(int(k)) for k in ids),
            position=crowd.placement.position[:, ids].T.copy(),
            yaw=crowd.placement.yaw[ids],
            size=crowd.placement.scale[ids],
            clips=names,
            durations=durations,
            looping=looping,
            states=crowd.table.names,
            agent=agent.astype(np.int64),
            clip=clip,
            state=state.astype(np.int64),
            start=(start - self._began) / POSE_RATE,
            end=(end - self._began) / POSE_RATE,
            source_start=source,
            source_end=source + np.where(holds, 0.0, played / cycles),
            cycles=cycles,
            scale=np.where(holds, 1.0, length / np.where(holds, 1.0, played)),
            blend=blend,
            relative=np.ones(len(agent), np.bool_),
        )

    def _close(self, which: NDArray[np.int64], tick: int) -> None:
        """End the instances of agents `which` at `tick`."""
        now = self._now
        ends = np.full(len(self._ids), tick)
        columns: tuple[NDArray[Any], ...] = (self._ids, now.clip, self._state, self._start, ends)
        columns += (self._from, self._played, self._blend, now.period)
        self._done.append(tuple(column[which].astype(np.float64) for column in columns))

    def _playing(self, tick: int) -> _Playing:
        crowd, ids = self._crowd, self._ids
        if crowd.pool is not None and crowd.anim is not None:
            pool, anim = crowd.pool, crowd.anim
            row = anim.row[0, ids].astype(np.int64)
            streams = len(pool.clip)
            at = np.minimum(row, streams - 1)
            on_stream = row < streams
            head = np.minimum(tick, pool.head[at])
            start, target, rate = (c[0, ids] for c in (anim.start, anim.target, anim.rate))
            behind = offset_at(start, target, rate, head - anim.t0[0, ids].astype(np.float64))
            behind = np.minimum(behind, np.maximum(pool.valid[at] - 1, 0))
            pace = np.where(on_stream & pool.running[at], pool.speed[at] / POSE_RATE, 0.0)
            played = pool.clip[at].astype(np.int64)
            is_clip = on_stream & (played >= 0)
            clip = np.where(is_clip, played, len(pool.bank.clips) + row)
            loops = is_clip & pool.looping[at] & (pool.bank.duration[played] > 0)
            period = np.where(loops, pool.bank.duration[played], np.inf)
            place = np.where(on_stream, pool.time[at] - behind * pool.speed[at] / POSE_RATE, 0.0)
            place = _wrapped(place, period)
            lead = self._lead[np.where(is_clip, played, 0)] * is_clip
            return _Playing(row, clip, place - lead, pace, period)
        if crowd.baked is not None:
            _, anim_ = crowd.baked
            clip = anim_.clip[ids].astype(np.int64)
            period = self._periods[clip]
            pace = anim_.speed[ids].astype(np.float64) / POSE_RATE
            place = _wrapped((tick - anim_.began[ids]) * pace, period)
            return _Playing(crowd.motion.shown[ids].astype(np.int64), clip, place, pace, period)
        # Nobody has poses: a motion begins with the state that it shows.
        clip = crowd.library.clips[crowd.motion.shown[ids]]
        period = self._periods[clip]
        since = (tick - crowd.behaviour.entered[0, ids].astype(np.float64)) / POSE_RATE
        pace = np.full(len(ids), 1.0 / POSE_RATE)
        return _Playing(clip, clip, _wrapped(since, period), pace, period)

    def _leads(self) -> NDArray[np.float64]:
        """(clips,) seconds for which clips that are made of others hold their first pose."""
        crowd = self._crowd
        lead = np.zeros(len(self._clips))
        before = esper.current_world
        esper.switch_world(crowd.world)
        ways = esper.try_component(crowd.entity, Ways)
        esper.switch_world(before)
        if ways is not None:
            for motion, plan in zip((ways.up, ways.down), ways.plans, strict=True):
                lead[crowd.library.clips[motion]] = plan.begin * plan.loop.duration
        return lead

    def _describe(
        self, codes: NDArray[np.int64]
    ) -> tuple[NDArray[np.int64], tuple[str, ...], NDArray[np.float64], NDArray[np.bool_]]:
        """For (K,) codes of clips: (K,) indices of names; the names, durations, and who loops."""
        kinds, which = np.unique(codes, return_inverse=True)
        streams = 0 if self._crowd.pool is None else self._crowd.pool.store.stream_rows
        said = []
        for kind in kinds:
            row = int(kind) - len(self._clips)
            other = f"stream {row}" if row < streams else "live motion"
            said.append(self._clips[int(kind)].name if row < 0 else other)
        names = tuple(dict.fromkeys(said))
        # Clips that are made of others have their names; the first of a name is the character's.
        own = {clip.name: clip for clip in reversed(self._clips)}
        durations = [own[name].duration if name in own else 0.0 for name in names]
        looping = [name in own and own[name].looping for name in names]
        index = np.array([names.index(name) for name in said], np.int64)
        return index[which], names, np.array(durations), np.array(looping, np.bool_)


def _wrapped(place: NDArray[np.float64], period: NDArray[np.float64]) -> NDArray[np.float64]:
    loops = np.isfinite(period)
    wrapped: NDArray[np.float64] = np.where(
        loops, np.mod(place, np.where(loops, period, 1.0)), place
    )
    return wrapped

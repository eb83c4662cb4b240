"""The ways between sitting and standing: motions that play once, on shared streams.

A spectator who sits and wants to cheer gets up first. The clips for that don't loop; here they run
on streams as loops with a pause, and agents enter them at the clip's start by phase and go on when
it is over.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...components.motion import MotionState
from ..animation.clip import Clip
from ..animation.one_shot import with_pauses
from ..streams.phase import entry_offset
from ..streams.pool import POSE_RATE, StreamPool
from .motions import MotionLibrary, MotionStreams, start_staggered

_UP = re.compile(r"^(sit\w*)?stand_?up$", re.IGNORECASE)
_DOWN = re.compile(r"^sit\w*down$", re.IGNORECASE)
_SEATED = re.compile(r"^sit", re.IGNORECASE)

UP_SPEED = 1.4
"""Getting up for a goal is quicker than the clip, which was made for a calm moment."""
DOWN_SPEED = 1.0
LEAST_STREAMS = 3
"""Streams of each way, staggered."""
LARGEST_SHARE = 1 / 8
"""Of a crowd's streams that ways may take; with fewer streams nobody uses them."""
LEAD = 6.0
"""Pose ticks before a way's end at which the next motion begins to blend in."""
JITTER = 4.0
"""Pose ticks by which agents that enter a way together differ."""
BLEND_IN, BLEND_OUT = 9.0, 15.0
"""Longest blends into and out of a way, pose ticks."""
URGENT = 7.0
"""An agent whose change of motion must not take longer than this doesn't get up for it."""


@dataclass(frozen=True, slots=True)
class Way:
    """One motion that plays once, as a loop with pauses.

    Parameters
    ----------
    clip
        The clip without pauses.
    loop
        The same with pauses.
    speed
        Of its streams.
    begin, end
        Phases of `loop` at which the clip begins and ends.
    """

    clip: Clip
    loop: Clip
    speed: float
    begin: float
    end: float

    def streams(self, history: int) -> int:
        """How many staggered streams hold every phase, with a pose to spare."""
        poses = self.loop.duration / self.speed * POSE_RATE
        return max(LEAST_STREAMS, int(np.ceil(poses / max(history - 4, 1))))


@dataclass(frozen=True, slots=True, eq=False)
class Ways:
    """How agents of one crowd get from sitting to standing and back.

    Parameters
    ----------
    up, down
        Motions of the library.
    plans
        Of `up` and `down`.
    rows
        Stream rows that play `up` and `down`.
    begins_seated, ends_seated
        (K,) bool of the library's motions.
    """

    up: int
    down: int
    plans: tuple[Way, Way]
    rows: tuple[NDArray[np.int32], NDArray[np.int32]]
    begins_seated: NDArray[np.bool_]
    ends_seated: NDArray[np.bool_]

    def enter(
        self,
        pool: StreamPool,
        state: MotionState,
        agents: NDArray[np.int64],
        motion: NDArray[np.int16],
        row: NDArray[np.int32],
        offset: NDArray[np.float32],
        blend: NDArray[np.float32],
        tick: int,
        rng: np.random.Generator,
    ) -> int:
        """Send agents that must get up or sit down first on their way there.

        Parameters
        ----------
        pool
            Plays the ways.
        state
            `busy_until` is set for those who are sent.
        agents
            (K,) ids that are about to change motion; none is busy.
        motion, row, offset, blend
            (K,) what they are about to do: motions, stream rows, offsets in poses, and pose ticks
            of the blend; changed in place for those who are sent.
        tick, rng
            The pose tick about to be evaluated, and where choices come from.

        Returns
        -------
        int
            How many entered at another phase than the way's start, since no history holds it.
        """
        now = self.ends_seated[state.shown[agents]]
        then = self.begins_seated[motion]
        calm = blend > URGENT
        leaving = (state.shown[agents] == self.up) | (state.shown[agents] == self.down)
        np.minimum(blend, BLEND_OUT, out=blend, where=leaving)
        missed = 0
        sent = ((self.up, now & ~then & calm), (self.down, ~now & then & calm))
        for (way, who), plan, rows in zip(sent, self.plans, self.rows, strict=True):
            k = np.flatnonzero(who)
            if not len(k):
                continue
            place = entry_offset(pool, rows, len(k), tick, rng, phase=plan.begin, jitter=JITTER)
            motion[k], row[k], offset[k] = way, place.row, place.offset
            blend[k] = np.minimum(blend[k], BLEND_IN)
            left = (plan.end - place.phase) / np.maximum(place.step, 1e-6)
            state.busy_until[agents[k]] = tick + np.maximum(left - LEAD, 1.0).astype(np.int32)
            missed += 0 if place.matched else len(k)
        return missed


def find_ways(
    clips: Sequence[Clip], library: MotionLibrary, streams: int, history: int
) -> tuple[Way, Way] | None:
    """Ways up and down among a character's clips, or None if a crowd can't or needn't use them.

    It takes a clip for each that doesn't loop, motions of both postures, and enough streams.

    Parameters
    ----------
    clips, library
        The character's clips and the motions that were found among them.
    streams, history
        Of the crowd.
    """
    up = next((clip for clip in clips if _UP.match(clip.name) and not clip.looping), None)
    down = next((clip for clip in clips if _DOWN.match(clip.name) and not clip.looping), None)
    seated = seated_motions(library.names)
    if up is None or down is None or seated.all() or not seated.any():
        return None
    if min(up.duration, down.duration) * POSE_RATE < 2 * LEAD:
        return None
    plans = (_way(up, UP_SPEED), _way(down, DOWN_SPEED))
    if sum(plan.streams(history) for plan in plans) > streams * LARGEST_SHARE:
        return None
    return plans


def add_ways(library: MotionLibrary, plans: tuple[Way, Way], first_clip: int) -> MotionLibrary:
    """The library with the ways as its last two motions, which nobody wants for their own sake.

    Parameters
    ----------
    first_clip
        Index in the pool's bank of the way up's loop; the way down's is the next.
    """
    return replace(
        library,
        names=(*library.names, *(plan.clip.name for plan in plans)),
        clips=np.append(library.clips, [first_clip, first_clip + 1]),
        innate=np.append(library.innate, [0.0, 0.0]),
    )


def start_ways(
    pool: StreamPool,
    library: MotionLibrary,
    plans: tuple[Way, Way],
    streams: MotionStreams,
    history: int,
) -> tuple[Ways, MotionStreams]:
    """Start the staggered streams of the ways, and say where all motions are played.

    Parameters
    ----------
    pool
        Gets the streams.
    library
        With the ways as its last two motions.
    plans, streams, history
        The ways, the streams of the other motions, and M.
    """
    up_rows, down_rows = (
        start_staggered(pool, int(clip), plan.streams(history), plan.speed)
        for plan, clip in zip(plans, library.clips[-2:], strict=True)
    )
    seated = seated_motions(library.names)
    up, down = len(library.names) - 2, len(library.names) - 1
    begins, ends = seated.copy(), seated.copy()
    begins[[up, down]], ends[[up, down]] = (True, False), (False, True)
    ways = Ways(up, down, plans, (up_rows, down_rows), begins, ends)
    return ways, streams.followed_by(ways.rows)


def _way(clip: Clip, speed: float) -> Way:
    before = (JITTER + 2.0) / POSE_RATE * speed
    after = (BLEND_OUT + 4.0) / POSE_RATE * speed
    loop = with_pauses(clip, before, after)
    key = clip.duration / (clip.frame_count - 1)
    begin = np.ceil(before / key - 1e-6) * key / loop.duration
    return Way(clip, loop, speed, float(begin), float(begin + clip.duration / loop.duration))


def seated_motions(names: Sequence[str]) -> NDArray[np.bool_]:
    """(K,) which motions are those of people who sit, by their names."""
    return np.array([bool(_SEATED.match(name)) for name in names], np.bool_)

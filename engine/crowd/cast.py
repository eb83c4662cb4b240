"""The motions that a crowd can show, chosen by what its behaviour asks for and by its streams.

Streams are dear: each motion needs at least one, and one more for each body type. So a crowd shows
the ways between sitting and standing, what its table asks for, one motion of each kind for every
role, and variants as long as there is room.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..animation.clip import Clip
from ..streams.pool import StreamPool
from .motions import MotionLibrary, MotionStreams, closes, sort_motions, start_streams
from .once import OnceStreams, add_once, start_once, streams_for
from .twin_streams import affordable_streams, start_twins
from .ways import Way, Ways, add_ways, find_ways, start_ways

FOR_A_MOTION = 1.5
"""Streams of the character's own body that a motion should have at least, where there are types."""
ONCE_SHARE = 1 / 4
"""Of a crowd's streams that motions which play once may take, twins included."""


@dataclass(frozen=True, slots=True, eq=False)
class Cast:
    """The motions of a crowd.

    Parameters
    ----------
    library
        All of them: those that loop, those that play once, and the ways.
    loops
        The first part of it.
    once
        How many play once.
    ways
        Between sitting and standing, or None.
    clips
        For the pool's bank: the character's, and loops of those that play once.
    types
        Body types that all motions are shown on, beside the character's own.
    """

    library: MotionLibrary
    loops: MotionLibrary
    once: int
    ways: tuple[Way, Way] | None
    clips: tuple[Clip, ...]
    types: int


@dataclass(frozen=True, slots=True, eq=False)
class CastStreams:
    """Which streams play the motions of a cast; `kept` (R,) bool are those that must never rest."""

    streams: MotionStreams
    once: OnceStreams
    ways: Ways | None
    kept: np.typing.NDArray[np.bool_]


def choose_cast(
    clips: Sequence[Clip],
    wanted: Sequence[Sequence[str]],
    *,
    streams: int,
    history: int,
    types: int,
    baked: bool = False,
) -> Cast:
    """Choose the motions of a crowd.

    Parameters
    ----------
    clips
        The character's.
    wanted
        Clips that the behaviour table asks for; see `sort_motions`.
    streams, history
        Of the crowd.
    types
        Body types beside the character's own that have streams.
    baked
        Whether there are no streams at all, so that nothing can be entered at its beginning.
    """
    everything = sort_motions(clips)
    plans = None if baked else find_ways(clips, everything, streams, history)
    whole = 0 if plans is None else sum(plan.streams(history) for plan in plans)
    once: list[Clip] = []
    if not baked:
        by_name = {clip.name: clip for clip in clips if not clip.looping and closes(clip)}
        room = int(streams * ONCE_SHARE) // (1 + types)
        for name in dict.fromkeys(names[0] for names in wanted if names):
            need = streams_for(by_name[name].duration, history) if name in by_name else 0
            if 0 < need <= room and by_name[name].duration > 0:
                once.append(by_name[name])
                room -= need
                whole += need
    left = streams - whole * (1 + types)
    most = int(left / (FOR_A_MOTION + types) if types else left / 2)
    loops = sort_motions(clips, max(most, 1), wanted)
    library = add_once(loops, [clip.name for clip in once], len(clips))
    bank = (*clips, *(replace(clip, looping=True) for clip in once))
    if plans is not None:
        library = add_ways(library, plans, len(bank))
        bank = (*bank, *(plan.loop for plan in plans))
    return Cast(library, loops, len(once), plans, bank, types)


def start_cast(
    pool: StreamPool, cast: Cast, capacity: int, history: int, rng: np.random.Generator
) -> CastStreams:
    """Start the streams of a cast, on `capacity` rows of the pool; the others stay free.

    `history` is M, and `rng` is where phases and speeds come from.
    """
    loops, plans = len(cast.loops.names), cast.ways
    once = range(loops, loops + cast.once)
    whole = 0 if plans is None else sum(plan.streams(history) for plan in plans)
    durations = pool.bank.duration[cast.library.clips[loops : loops + cast.once]]
    whole += sum(streams_for(float(duration), history) for duration in durations)
    types = len(pool.twins.types) if cast.types else 0
    own = affordable_streams(capacity, loops, whole, types)
    has_twins = types > 0 and own > 0
    streams = start_streams(pool, cast.loops, own or capacity - whole, rng)
    kept = np.ones(len(pool.alive), np.bool_)
    kept[:capacity] = False
    once_streams, streams = start_once(pool, cast.library, once, streams, history)
    for rows in once_streams.rows.values():
        kept[rows] = True
    ways = None
    if plans is not None:
        ways, streams = start_ways(pool, cast.library, plans, streams, history)
        kept[np.concatenate(ways.rows)] = True
    if has_twins:
        whole_motions = np.arange(len(cast.library.names)) >= loops
        streams = start_twins(pool, streams, whole_motions, len(kept) - capacity)
        twins = pool.twins.table[1:, kept]
        kept[twins[twins >= 0]] = True
    return CastStreams(streams, once_streams, ways, kept)

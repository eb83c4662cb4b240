"""Clip events reach the agents: each when it plays the pose at which its stream passed it.

An agent's time is ``u = n - o(n)`` at pose tick n. A stream's event of tick e reaches it at the
first n with u >= e, once, also while o changes; only events at or after its entry. An agent that
leaves a stream drops what is pending; a stopped stream holds it; a cut drops it.

Nothing is kept per agent. An offset is a linear function of time that `dilate` continues exactly
where it is, so what an agent passes in a tick follows from the function alone, at n - 1 and at n.
Offsets are rounded to float32 wherever they are compared with whole ticks, as they are when
`dilate` stores them, so no event falls into a gap between two functions.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...components.animation import AgentAnimID, Transition
from .blending import blend_weight
from .displayed import offset_at
from .pool import StreamPool

_BLOCK = 16384
"""Agents that are worked on at once: their temporary columns stay in the processor's cache."""


class Delivered(NamedTuple):
    """Events of one pose tick and part, ordered by agent.

    Attributes
    ----------
    agents
        (K,) int64 ids; an agent that passes two tagged poses, or one name twice, is there twice,
        and once for each name that it passes at a pose of a tree.
    bits
        (K,) uint64 names, as in `StreamEvents`.
    weights
        (K,) float32: the share that the motion has in the agent's picture at this tick, 1 without
        a blend; in a tree, times the share that the clip had in the pose.
    """

    agents: NDArray[np.int64]
    bits: NDArray[np.uint64]
    weights: NDArray[np.float32]


class _Hits(NamedTuple):
    """Agents that pass poses with tags: (K,) ids, the bits, and which pose (`ClipShares.pose`)."""

    agents: NDArray[np.int64]
    bits: NDArray[np.uint64]
    pose: NDArray[np.int64]


def nothing_delivered() -> Delivered:
    """No events."""
    return Delivered(np.zeros(0, np.int64), np.zeros(0, np.uint64), np.zeros(0, np.float32))


def deliver(
    pool: StreamPool, anim: AgentAnimID, transition: Transition, part: int, tick: int
) -> Delivered:
    """Events that the agents' `part` plays past in pose tick `tick`.

    Called once a pose tick, after the pool's commit. In a cross-fade both motions count, each with
    its weight.

    Parameters
    ----------
    pool, anim, transition
        The crowd's streams and columns.
    part, tick
        Part, and the pose tick that was just committed.
    """
    fading = np.flatnonzero(transition.duration[part] > 0)
    begin, duration = transition.begin[part, fading], transition.duration[part, fading]
    share = blend_weight(begin, duration, float(tick))
    planes, shares = pool.clip_events.planes, pool.clip_events.shares
    table = _by_age(pool, tick, planes[0])
    special = np.flatnonzero((anim.rate[part] != 0) | (anim.t0[part] == tick))
    own = [_passed_at_rest(pool, table, anim.row[part], anim.start[part], None, special, tick)]
    own += _passed(pool, anim, part, special, tick, 0)
    leaving = fading[share < 1.0]
    moving = np.flatnonzero(transition.rate[part, leaving])
    row, start = transition.row[part, leaving], transition.start[part, leaving]
    left = [_passed_at_rest(pool, table, row, start, leaving, moving, tick)]
    left += _passed(pool, transition, part, leaving[moving], tick, 0)
    # Whoever passed a name more than once passed it once.
    for plane in range(1, len(planes)):
        if planes[plane].any():
            again = np.unique(np.concatenate([hits.agents for hits in own]))
            own += _passed(pool, anim, part, again, tick, plane)
            left += _passed(pool, transition, part, leaving, tick, plane)
    agents, bits, pose = (np.concatenate(column) for column in zip(*own, *left, strict=True))
    mine = sum(len(hits.agents) for hits in own)
    # Ids ascend, so a place in `fading` is found by bisection.
    weights = np.ones(len(agents), np.float32)
    if len(fading):
        place = np.minimum(np.searchsorted(fading, agents), len(fading) - 1)
        blends = fading[place] == agents
        weights[blends] = share[place[blends]]
        weights[mine:] = np.float32(1.0) - weights[mine:]
    if len(shares):
        place, bit, share = shares.find(pose)
        plain = np.ones(len(agents), np.bool_)
        plain[place] = False
        agents = np.concatenate([agents[plain], agents[place]])
        bits = np.concatenate([bits[plain], bit])
        weights = np.concatenate([weights[plain], weights[place] * share])
    order = np.argsort(agents, kind="stable")
    return Delivered(agents[order], bits[order], weights[order])


def _passed_at_rest(
    pool: StreamPool,
    table: NDArray[np.bool_],
    row: NDArray[np.int32],
    offset: NDArray[np.float32],
    agents: NDArray[np.int64] | None,
    but: NDArray[np.int64],
    tick: int,
) -> _Hits:
    """What agents at rest on (K,) rows and offsets pass, without the places in `but`.

    They pass exactly one pose a tick, ``ceil(o)`` behind the head: one gather.
    """
    width = np.int32(table.shape[1])
    hit = np.empty(len(row), np.bool_)
    for first in range(0, len(row), _BLOCK):
        block = slice(first, first + _BLOCK)
        place = np.ceil(offset[block]).astype(np.int32)
        np.maximum(place, 0, out=place)
        place *= width
        place += np.minimum(row[block], width - 1)
        # An offset beyond the ring falls on the table's last column, which is empty.
        table.take(place, mode="clip", out=hit[block])
    hit[but] = False
    hits = np.flatnonzero(hit)
    column = row.take(hits).astype(np.int64)
    age = np.maximum(np.ceil(offset.take(hits)).astype(np.int64), 0)
    # Everyone on a stream sees its first pose when it comes.
    age[pool.valid[column] == 1] = 0
    events = pool.clip_events
    plane = events.planes[0]
    bits = plane[(tick - age) % len(plane), column]
    who = hits if agents is None else agents.take(hits)
    return _Hits(who, bits, events.shares.pose(tick - age, column, 0))


def _by_age(pool: StreamPool, tick: int, plane: NDArray[np.uint64]) -> NDArray[np.bool_]:
    """(capacity, R + 1): whether the pose of each age that a resting agent reaches has bits.

    While a history fills up, agents farther behind than it reaches wait at its first pose: they all
    got that pose's events when it came, and don't get them again when they leave it.
    """
    capacity, rows = plane.shape
    age = np.arange(capacity)
    table = np.zeros((capacity, rows + 1), np.bool_)
    moves = pool.head == tick
    # Streams that rest reach nothing.
    oldest = np.where(moves, pool.valid - 2, -1)
    tagged = plane != 0
    np.logical_and(tagged[(tick - age) % capacity], age[:, None] <= oldest, out=table[:, :rows])
    starts = np.flatnonzero(moves & (pool.valid == 1))
    table[:, starts] = tagged[tick % capacity, starts]
    return table


def _passed(
    pool: StreamPool,
    columns: AgentAnimID | Transition,
    part: int,
    agents: NDArray[np.int64],
    tick: int,
    plane: int,
) -> list[_Hits]:
    """What some agents with any offsets pass of a plane: none, one or two poses each."""
    if not len(agents):
        return []
    row = columns.row[part, agents].astype(np.int64)
    live = row < len(pool.head)
    live[live] = (pool.head[row[live]] == tick) & (pool.valid[row[live]] > 0)
    agents, row = agents[live], row[live]
    if not len(agents):
        return []
    at = (part, agents)
    line = (columns.start[at], columns.target[at], columns.rate[at])
    t0 = columns.t0[at].astype(np.float64)
    now = offset_at(*line, tick - t0).astype(np.float32)
    then = offset_at(*line, tick - 1 - t0).astype(np.float32)
    first = tick - pool.valid[row].astype(np.int64) + 1
    last = np.maximum(tick - np.ceil(now).astype(np.int64), first)
    before = np.maximum(tick - 1 - np.ceil(then).astype(np.int64), first)
    # Everyone on a stream sees its first pose when it comes.
    before[first == tick] = tick - 1
    entered = columns.t0[at] == tick
    at_entry = np.maximum(tick - np.floor(now).astype(np.int64), first) - 1
    before = np.where(entered, at_entry, before)
    events = pool.clip_events
    bits_of = events.planes[plane]
    result = []
    for step in range(1, int((last - before).max()) + 1):
        some = np.flatnonzero(before + step <= last)
        when, where = before[some] + step, row[some]
        bits = bits_of[when % len(bits_of), where]
        hits = np.flatnonzero(bits)
        pose = events.shares.pose(when[hits], where[hits], plane)
        result.append(_Hits(agents[some[hits]], bits[hits], pose))
    return result

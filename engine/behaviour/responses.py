"""Who answers an event, how hard and for how long.

People react if the benefit outweighs their embarrassment (Lupyan & Rifkin 2003: ``b > c1 + c2``):
the benefit `b` of an event is its weight times the person's fervour, `c1` falls with how easily a
person is moved, and `c2`, the effort of going on, grows with time, so that ``(b - c1) / effort`` is
how long they go on.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...components.behaviour import Behaviour
from ...components.emotion import Emotion
from ...components.placement import Placement
from ...components.team import MOST_SIDES, NEUTRAL, Team
from ..streams.pool import POSE_RATE
from .compiled import CompiledTable
from .emotion import shift
from .events import KINDS, PLACED, Event
from .table import PIECE, Relation, Response

HIT_RADIUS = 1.2
"""Metres from where the ball lands within which it hits."""
WITNESS_RADIUS = 7.0
"""Metres within which people notice what happened."""
COST_OF_SHYNESS = 0.25
"""Benefit that being wholly embarrassed costs: it makes 130 frames of cheering 50 to 80."""
FERVOUR_COUNTS = 1.05
"""More fervour than this makes nobody go on longer."""

BLOCK = 32_600
"""Agents that are worked on at once: few calls, and temporary columns below 128 KiB, so that they
stay in the processor's cache."""


def respond(
    event: Event,
    compiled: CompiledTable,
    behaviour: Behaviour,
    emotion: Emotion,
    team: Team,
    placement: Placement,
    present: NDArray[np.bool_],
    tick: int,
    rng: np.random.Generator,
    part: slice | None = None,
) -> NDArray[np.int64]:
    """Let an event move the crowd.

    Parameters
    ----------
    event
        What happened.
    compiled
        The table, for its responses and for who has a rule to react by.
    behaviour, emotion
        Changed in place.
    team, placement, present
        Sides, places, and who is there.
    tick
        Pose tick of the event.
    rng
        Where reaction times come from.
    part
        Agents, from start to stop, whom it may move; everybody by default.

    Returns
    -------
    (K,) int64 ids of those who will react, ascending
    """
    effect = _Effect(event, compiled)
    groups = _groups(event, team, placement, present, part or slice(0, len(present)))
    moved = [
        _move(effect, agents, relation, behaviour, emotion, team, tick, rng)
        for agents, relation in groups
    ]
    return np.concatenate(moved) if moved else np.zeros(0, np.int64)


class _Effect:
    """What an event does, by relation (R + 1,); the last is of those whom it doesn't concern."""

    def __init__(self, event: Event, compiled: CompiledTable) -> None:
        kind = KINDS.index(event.kind)
        responses = [*(compiled.responses.get((kind, k), Response()) for k in Relation), Response()]

        def column(name: str) -> NDArray[np.float32]:
            return np.array([getattr(response, name) for response in responses], np.float32)

        self.kind = np.int8(kind)
        self.weight = np.float32(event.weight or 0.0)
        self.gain = column("gain")
        self.ticks = column("seconds") * np.float32(POSE_RATE)
        self.delay = column("delay") * np.float32(POSE_RATE)
        self.feelings = [(name, column(name)) for name in _FEELINGS if column(name).any()]
        # Of machines and states: 0 no rule for the event, 1 a robust one, 2 a rapid one.
        urgency = np.zeros((len(responses), len(compiled.names)), np.int8)
        urgency[:-1] += compiled.wakes[:, kind].T
        urgency[:-1] += compiled.wakes_rapidly[:, kind].T
        self.urgency = urgency
        self.wakes = [
            machine
            for machine in range(len(compiled.starts))
            if urgency[:, compiled.machine == machine].any()
        ]


def _move(
    effect: _Effect,
    agents: NDArray[np.int64] | slice,
    relation: NDArray[np.int8],
    behaviour: Behaviour,
    emotion: Emotion,
    team: Team,
    tick: int,
    rng: np.random.Generator,
) -> NDArray[np.int64]:
    """`respond` for some of the crowd, of whom `relation` says what the event is to each."""
    by_relation = _ByRelation(relation)
    weight = effect.weight
    fervour = team.fervour[agents]
    impact = weight * fervour
    embarrassment = emotion.embarrassment[agents].copy()
    for feeling, shares in effect.feelings:
        by = by_relation.column(shares)
        by *= impact
        shift(getattr(emotion, feeling), agents, by, -1.0 if feeling == "mood" else 0.0)
    if not effect.gain.any():
        return np.zeros(0, np.int64)
    # The benefit outweighs the threshold of the person, the higher the more embarrassed.
    fresh = np.float32(0.5) * emotion.fatigue[agents]
    np.subtract(np.float32(1.0), fresh, out=fresh)
    benefit = by_relation.column(effect.gain)
    benefit *= impact
    benefit *= fresh
    threshold = np.float32(1.0) - emotion.susceptibility[agents]
    threshold *= embarrassment + np.float32(0.5)
    moved = benefit > threshold
    lasting = np.minimum(fervour, np.float32(FERVOUR_COUNTS))
    lasting *= weight
    lasting *= fresh
    embarrassment *= np.float32(COST_OF_SHYNESS)
    lasting -= embarrassment
    lasting *= by_relation.column(effect.ticks)
    moved &= lasting >= 1.0
    left = behaviour.stirred_until[agents] - np.int32(tick)
    if (left > 0).any():
        # Something bigger that is going on isn't interrupted.
        whole = behaviour.stirred_until[agents] - behaviour.stirred_from[agents]
        rest = (left / np.maximum(whole, 1)).clip(0.0, 1.0)
        moved &= benefit >= behaviour.strength[agents] * rest
    low, high = effect.delay.T
    delay = rng.random(len(relation), np.float32)
    delay *= by_relation.column(high - low)
    delay += by_relation.column(low)
    begin = delay.astype(np.int32)
    begin += np.int32(tick + 1)
    end = lasting.astype(np.int32)
    end += np.int32(tick)
    np.maximum(end, begin + np.int32(1), out=end)
    some = _Some(agents, moved)
    for target, value in (
        (behaviour.event, effect.kind),
        (behaviour.relation, relation),
        (behaviour.impact, weight),
        (behaviour.strength, benefit),
        (behaviour.stirred_from, begin),
        (behaviour.stirred_until, end),
    ):
        some.write(target, value)
    _wake(effect, behaviour, agents, by_relation, begin, moved)
    return agents[some.places] if isinstance(agents, np.ndarray) else some.places + agents.start


_NOBODY = len(Relation)
_FEELINGS = ("excitement", "embarrassment", "mood", "fatigue")


class _ByRelation:
    """Who of some agents is what to an event: columns with one value a relation.

    Most people in a block are the same to an event, so a column is one value and a few others:
    that is quicker than looking everyone's up.
    """

    def __init__(self, relation: NDArray[np.int8]) -> None:
        groups: list[tuple[int, NDArray[np.bool_], int]] = []
        missing = len(relation)
        for k in range(_NOBODY + 1):
            here = relation == k
            count = int(np.count_nonzero(here))
            if count:
                groups.append((k, here, count))
            missing -= count
            if not missing:
                break
        self.usual = max(groups, key=lambda group: group[2])[0]
        self.others = [(k, np.flatnonzero(here)) for k, here, _ in groups if k != self.usual]
        self._count = len(relation)

    def column(self, values: NDArray[np.float32]) -> NDArray[np.float32]:
        """(K,) float32 of one value for each relation."""
        column = np.full(self._count, values[self.usual], np.float32)
        for k, places in self.others:
            column[places] = values[k]
        return column


class _Some:
    """Those of some agents whom a mask names: `places` (K,) among the agents, and what they get."""

    def __init__(self, agents: NDArray[np.int64] | slice, mask: NDArray[np.bool_]) -> None:
        self.places = np.flatnonzero(mask)
        self._agents = agents
        # Of a block, it is quicker to write everyone and restore the others if those are fewer.
        self._others = None
        if isinstance(agents, slice) and 2 * len(self.places) > len(mask):
            self._others = np.flatnonzero(~mask)

    def write(self, column: NDArray[Any], values: Any) -> None:
        """Write values, one for all or one for each of the agents, into a column (N,)."""
        agents = self._agents
        if self._others is not None:
            part = column[agents]
            before = part.take(self._others)
            part[:] = values
            part[self._others] = before
            return
        chosen = values.take(self.places) if isinstance(values, np.ndarray) else values
        if isinstance(agents, slice):
            column[agents][self.places] = chosen
        else:
            column[agents[self.places]] = chosen


def _wake(
    effect: _Effect,
    behaviour: Behaviour,
    agents: NDArray[np.int64] | slice,
    relation: _ByRelation,
    begin: NDArray[np.int32],
    moved: NDArray[np.bool_],
) -> None:
    """End the stays of those who are moved and have a rule for the event; as `machine.wake`."""
    for machine in effect.wakes:
        state = behaviour.state[machine][agents]
        how = effect.urgency[relation.usual].take(state)
        for k, places in relation.others:
            how[places] = effect.urgency[k].take(state.take(places))
        until = behaviour.until[machine][agents]
        # What is left of the piece after `begin` is waited for unless a rule is rapid.
        rest = until - begin
        rest -= rest // np.int32(PIECE) * np.int32(PIECE)
        rest *= how == 1
        rest += begin
        np.minimum(rest, until, out=rest)
        _Some(agents, moved & (how > 0)).write(behaviour.until[machine], rest)


def relations_of(event: Event) -> NDArray[np.int8]:
    """(sides + 1,) what an event without a place is to each side.

    The last side is the neutral one, so that -1 is a place in it like any other, with
    ``take(side, mode="wrap")``.
    """
    # What is nobody's is everybody's own.
    usual = Relation.OWN if event.side is None else Relation.OTHER
    of_side = np.full(MOST_SIDES + 1, usual, np.int8)
    of_side[NEUTRAL] = Relation.NEUTRAL
    if event.side is not None:
        of_side[event.side] = Relation.OWN
    return of_side


def _groups(
    event: Event, team: Team, placement: Placement, present: NDArray[np.bool_], part: slice
) -> Iterator[tuple[NDArray[np.int64] | slice, NDArray[np.int8]]]:
    """Whom an event may concern, block by block, and what it is to each."""
    if event.kind in PLACED:
        assert event.place is not None
        distance = distance_to(placement, event.place)
        agents = np.flatnonzero(present & (distance <= WITNESS_RADIUS))
        if not len(agents):
            return
        is_hit = (distance[agents] <= HIT_RADIUS) & (event.kind == "ball_in_crowd")
        yield agents, np.where(is_hit, np.int8(Relation.HIT), np.int8(Relation.NEAR))
        return
    of_side = relations_of(event)
    for start in range(part.start, part.stop, BLOCK):
        block = slice(start, min(start + BLOCK, part.stop))
        relation = of_side.take(team.side[block], mode="wrap")
        if not present[block].all():
            relation[~present[block]] = _NOBODY
        yield block, relation


def distance_to(placement: Placement, place: tuple[float, float, float]) -> NDArray[np.float32]:
    """(N,) metres from each agent's chest to a place."""
    x, y, z = (np.float32(value) for value in place)
    px, py, pz = placement.position
    distance: NDArray[np.float32] = np.sqrt((px - x) ** 2 + (py + 1.0 - y) ** 2 + (pz - z) ** 2)
    return distance

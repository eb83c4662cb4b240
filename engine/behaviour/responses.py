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
from .machine import piece_end
from .table import Relation, Response

HIT_RADIUS = 1.2
"""Metres from where the ball lands within which it hits."""
WITNESS_RADIUS = 7.0
"""Metres within which people notice what happened."""
COST_OF_SHYNESS = 0.25
"""Benefit that being wholly embarrassed costs: it makes 130 frames of cheering 50 to 80."""
FERVOUR_COUNTS = 1.05
"""More fervour than this makes nobody go on longer."""

BLOCK = 16384
"""Agents that are worked on at once: their temporary columns stay in the processor's cache."""


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

    Returns
    -------
    (K,) int64 ids of those who will react, ascending
    """
    groups = _groups(event, team, placement, present)
    moved = [
        _move(event, agents, relation, compiled, behaviour, emotion, team, tick, rng)
        for agents, relation in groups
    ]
    return np.concatenate(moved) if moved else np.zeros(0, np.int64)


def _move(
    event: Event,
    agents: NDArray[np.int64] | slice,
    relation: NDArray[np.int8],
    compiled: CompiledTable,
    behaviour: Behaviour,
    emotion: Emotion,
    team: Team,
    tick: int,
    rng: np.random.Generator,
) -> NDArray[np.int64]:
    """`respond` for some of the crowd, of whom `relation` says what the event is to each."""
    kind = KINDS.index(event.kind)
    weight = np.float32(event.weight or 0.0)
    place = relation.astype(np.intp)
    responses = [*(compiled.responses.get((kind, k), _NOTHING) for k in Relation), _NOTHING]
    column = {
        name: np.array(values, np.float32).take(place, mode="clip")
        for name in _NUMBERS
        if any(values := [getattr(response, name) for response in responses])
    }
    fervour = team.fervour[agents]
    impact = weight * fervour
    embarrassment = emotion.embarrassment[agents].copy()
    for feeling in _FEELINGS:
        if feeling in column:
            least = -1.0 if feeling == "mood" else 0.0
            shift(getattr(emotion, feeling), agents, column[feeling] * impact, least)
    if "gain" not in column:
        return np.zeros(0, np.int64)
    # The benefit outweighs the threshold of the person, the higher the more embarrassed.
    fresh = np.float32(1.0) - np.float32(0.5) * emotion.fatigue[agents]
    benefit = column["gain"] * impact * fresh
    threshold = np.float32(1.0) - emotion.susceptibility[agents]
    moved = benefit > threshold * (embarrassment + np.float32(0.5))
    lasting = np.minimum(fervour, np.float32(FERVOUR_COUNTS)) * weight * fresh
    lasting -= np.float32(COST_OF_SHYNESS) * embarrassment
    lasting *= column.get("seconds", np.float32(0.0)) * np.float32(POSE_RATE)
    moved &= lasting >= 1.0
    left = behaviour.stirred_until[agents] - np.int32(tick)
    if (left > 0).any():
        # Something bigger that is going on isn't interrupted.
        whole = behaviour.stirred_until[agents] - behaviour.stirred_from[agents]
        rest = (left / np.maximum(whole, 1)).clip(0.0, 1.0)
        moved &= benefit >= behaviour.strength[agents] * rest
    low, high = np.array([response.delay for response in responses], np.float32).T * POSE_RATE
    delay = rng.random(len(relation), np.float32)
    delay *= (high - low).take(place, mode="clip")
    delay += low.take(place, mode="clip")
    begin = delay.astype(np.int32)
    begin += np.int32(tick + 1)
    end = np.maximum(lasting.astype(np.int32) + np.int32(tick), begin + np.int32(1))
    for target, value in (
        (behaviour.event, np.int8(kind)),
        (behaviour.relation, relation),
        (behaviour.impact, weight),
        (behaviour.strength, benefit),
        (behaviour.stirred_from, begin),
        (behaviour.stirred_until, end),
    ):
        _set(target, agents, moved, value)
    _wake(compiled, behaviour, kind, agents, place, begin, moved)
    first = np.flatnonzero(moved)
    return agents[first] if isinstance(agents, np.ndarray) else first + agents.start


_NOTHING = Response()
_NOBODY = len(Relation)
_FEELINGS = ("excitement", "embarrassment", "mood", "fatigue")
_NUMBERS = ("gain", "seconds", *_FEELINGS)


def _set(
    column: NDArray[Any], agents: NDArray[np.int64] | slice, moved: NDArray[np.bool_], values: Any
) -> None:
    """Write values for those of the agents who are moved."""
    if isinstance(agents, slice):
        np.copyto(column[agents], values, where=moved, casting="same_kind")
    else:
        column[agents[moved]] = values[moved] if isinstance(values, np.ndarray) else values


def _wake(
    compiled: CompiledTable,
    behaviour: Behaviour,
    kind: int,
    agents: NDArray[np.int64] | slice,
    relation: NDArray[np.intp],
    begin: NDArray[np.int32],
    moved: NDArray[np.bool_],
) -> None:
    """End the stays of those who are moved and have a rule for the event; as `machine.wake`."""
    urgency = compiled.wakes[:, kind].astype(np.int8) + compiled.wakes_rapidly[:, kind]
    relations = urgency.shape[1]
    for machine in range(len(behaviour.state)):
        if not urgency[compiled.machine == machine].any():
            continue
        key = behaviour.state[machine][agents] * np.intp(relations)
        key += relation
        how = urgency.ravel().take(key, mode="clip")
        until = behaviour.until[machine][agents]
        end = piece_end(until, begin)
        np.copyto(end, begin, where=how == 2)
        np.minimum(end, until, out=end)
        _set(behaviour.until[machine], agents, moved & (how > 0), end)


def _groups(
    event: Event, team: Team, placement: Placement, present: NDArray[np.bool_]
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
    # What is nobody's is everybody's own.
    usual = Relation.OWN if event.side is None else Relation.OTHER
    of_side = np.full(MOST_SIDES + 1, usual, np.int8)
    of_side[NEUTRAL] = Relation.NEUTRAL
    if event.side is not None:
        of_side[event.side] = Relation.OWN
    for start in range(0, len(present), BLOCK):
        block = slice(start, min(start + BLOCK, len(present)))
        relation = of_side[team.side[block]]
        np.copyto(relation, np.int8(_NOBODY), where=~present[block])
        yield block, relation


def distance_to(placement: Placement, place: tuple[float, float, float]) -> NDArray[np.float32]:
    """(N,) metres from each agent's chest to a place."""
    x, y, z = (np.float32(value) for value in place)
    px, py, pz = placement.position
    distance: NDArray[np.float32] = np.sqrt((px - x) ** 2 + (py + 1.0 - y) ** 2 + (pz - z) ** 2)
    return distance

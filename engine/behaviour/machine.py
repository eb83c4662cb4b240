"""The crowd's state machine: only agents whose stay ends are looked at, all of them at once.

*Thesis* 3.2.1: an agent is in a state for some pieces of 10 pose frames and then takes one of the
ways that are open, by effort. Time is an integer and each agent may have its own, so that a crowd
can be brought to the mix of states that it has in the long run before the first tick.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...components.behaviour import Behaviour
from .choices import CALM, Choice
from .compiled import CompiledTable
from .looks import KEEP
from .table import PIECE, Relation

Columns = Mapping[str, NDArray[Any]]
"""What rules may ask for, (N,) each: emotions, ``fervour``, and signals."""
LIMIT_BLEND = 9.0
"""Pose ticks of the blend out of a state whose time is up."""
_SETTLING = 90 * 30
"""Pose ticks before the first one that a crowd lives through."""


def begin(
    compiled: CompiledTable, behaviour: Behaviour, columns: Columns, rng: np.random.Generator
) -> None:
    """Put everyone into the first state of each machine, to be left at pose tick 1."""
    for machine, start in enumerate(compiled.starts):
        agents = np.arange(behaviour.state.shape[1])
        at, when = np.full(len(agents), start, np.int16), np.zeros(len(agents), np.int32)
        _enter(compiled, behaviour, machine, agents, at, when, columns, rng)
    behaviour.until[:] = 1


def settle(
    compiled: CompiledTable,
    behaviour: Behaviour,
    columns: Columns,
    rng: np.random.Generator,
    agents: NDArray[np.int64] | None = None,
) -> None:
    """Let a calm minute and a half pass: a crowd is found in the middle of things.

    Afterwards stays end after pose tick 0, and each began before.

    Parameters
    ----------
    compiled, behaviour, columns, rng
        As for `step`.
    agents
        (K,) ids of those for whom it passes; for everyone if None.
    """
    who = np.arange(behaviour.state.shape[1]) if agents is None else agents
    for machine, start in enumerate(compiled.starts):
        until = _beat(machine, who) - _SETTLING
        behaviour.until[machine, who] = until
        behaviour.entered[machine, who] = until - PIECE
        behaviour.state[machine, who] = start
        behaviour.ahead[machine, who] = -1
        late = who
        while len(late):
            when = behaviour.until[machine, late].copy()
            _move_on(compiled, behaviour, machine, late, when, columns, rng)
            late = late[behaviour.until[machine, late] <= 0]


def step(
    compiled: CompiledTable,
    behaviour: Behaviour,
    columns: Columns,
    tick: int,
    rng: np.random.Generator,
    *,
    held_until: NDArray[np.int32] | None = None,
    blend: NDArray[np.float32] | None = None,
) -> NDArray[np.int64]:
    """Let the agents whose stay ends at `tick` choose what to do next.

    Parameters
    ----------
    compiled, behaviour
        The table, and the columns that are changed in place.
    columns
        What rules may ask for.
    tick
        Pose tick.
    rng
        Where choices come from.
    held_until
        (N,) pose ticks before which the body does something that it has to finish.
    blend
        (N,) pose ticks that the next change of motion may take; set for those who change.

    Returns
    -------
    (K,) int64 ids of agents that may look different now, ascending
    """
    behaviour.tick = tick
    np.less_equal(behaviour.stirred_from, tick, out=behaviour.reacting)
    behaviour.reacting &= behaviour.stirred_until > tick
    changed: list[NDArray[np.int64]] = []
    for machine in range(len(behaviour.state)):
        due = np.flatnonzero(behaviour.until[machine] <= tick)
        if machine == 0 and held_until is not None and len(due):
            held = held_until[due] > tick
            behaviour.until[0, due[held]] = held_until[due[held]]
            due = due[~held]
        if len(due):
            when = np.full(len(due), tick, np.int32)
            changed.append(_move_on(compiled, behaviour, machine, due, when, columns, rng, blend))
    return union(changed, behaviour.state.shape[1])


def union(parts: list[NDArray[np.int64]], count: int) -> NDArray[np.int64]:
    """Ascending ids below `count` that are in any of the parts; for many it beats sorting."""
    found = np.zeros(count, np.bool_)
    for part in parts:
        found[part] = True
    return np.flatnonzero(found)


def wake(
    behaviour: Behaviour,
    machine: int,
    agents: NDArray[np.int64],
    when: NDArray[np.int32] | int,
    rapid: bool = False,
) -> None:
    """End the current stays of agents early, so that they look for a way out.

    Parameters
    ----------
    agents
        (K,) ids.
    when
        Pose ticks, for all or (K,), at the earliest.
    rapid
        Whether at `when`; else at the next end of a piece (*Thesis* 3.3.3), which is less than
        10 pose frames later and 4.5 on average.
    """
    until = behaviour.until[machine, agents]
    end = when if rapid else piece_end(until, when)
    behaviour.until[machine, agents] = np.minimum(end, until)


def piece_end(until: NDArray[np.int32], when: NDArray[np.int32] | int) -> NDArray[np.int32]:
    """First end of a piece from `when` on, of stays that end at `until`."""
    left = until - when
    left //= np.int32(PIECE)
    left *= np.int32(PIECE)
    return until - left


def _move_on(
    compiled: CompiledTable,
    behaviour: Behaviour,
    machine: int,
    agents: NDArray[np.int64],
    when: NDArray[np.int32],
    columns: Columns,
    rng: np.random.Generator,
    blend: NDArray[np.float32] | None = None,
) -> NDArray[np.int64]:
    """Next states of agents whose stays end; ids of those who changed state."""
    b = behaviour
    state = b.state[machine].take(agents)
    target = b.ahead[machine].take(agents)
    length = np.zeros(len(agents), np.float32)
    free = np.flatnonzero(target < 0)
    if len(free):
        who, now, at = agents.take(free), when.take(free), state.take(free)
        choice, stay = _choose(compiled, b, machine, at, who, now, columns, rng)
        target[free], length[free] = choice.target, choice.blend
        stays = np.flatnonzero(choice.target == at)
        who, now, at = who.take(stays), now.take(stays), at.take(stays)
        ready = _awake(compiled, b, who, at, now + stay.take(stays))
        end = b.entered[machine].take(who) + compiled.limit.take(at)
        b.until[machine][who] = np.minimum(ready, end)
    changes = np.flatnonzero(target != state)
    moving: NDArray[np.int64] = agents.take(changes)
    if len(moving):
        if blend is not None and machine == 0:
            length = length.take(changes)
            blend[moving] = np.where(length > 0, length, blend.take(moving))
        _enter(compiled, b, machine, moving, target.take(changes), when.take(changes), columns, rng)
    return moving


def _beat(machine: int, agents: NDArray[np.int64]) -> NDArray[np.int32]:
    """(K,) pose tick, 0 to 9, of each ten at which an agent's stays end if nothing rapid happens.

    A machine's work is cheaper at few ticks for many agents than at all for few; so there are three
    ticks for bodies, and one, apart from those, for whatever else people have.
    """
    if machine:
        return np.full(len(agents), 8, np.int32)
    beat = agents.astype(np.int32)
    beat %= np.int32(3)
    beat *= np.int32(3)
    return beat


def _awake(
    compiled: CompiledTable,
    behaviour: Behaviour,
    agents: NDArray[np.int64],
    state: NDArray[np.int16],
    when: NDArray[np.int32],
) -> NDArray[np.int32]:
    """When to look again at agents that are to be looked at at `when`, which may be pieces later.

    As long as an event moves an agent in a state that no rule leaves under it, there is nothing to
    decide. Changes `when`.
    """
    left = behaviour.stirred_until.take(agents) - when
    moved, at = _moved(behaviour, agents, state, left > 0)
    if len(moved):
        sleeping = moved[compiled.sleeps.ravel().take(at)]
        when[sleeping] += -(-left.take(sleeping) // np.int32(PIECE)) * np.int32(PIECE)
    return when


def _moved(
    behaviour: Behaviour,
    agents: NDArray[np.int64],
    state: NDArray[np.int16],
    will_be: NDArray[np.bool_],
) -> tuple[NDArray[np.int64], NDArray[np.intp]]:
    """Which of some agents (K,) `will_be` moved, and their places in (S, kinds, relations).

    Whoever no event ever moved is not among them.
    """
    moved = np.flatnonzero(will_be)
    if not len(moved):
        return moved, moved
    pair = _pairs(behaviour, agents.take(moved))
    if pair.min() < 0:
        moved, pair = moved[pair >= 0], pair[pair >= 0]
    pair += state.take(moved).astype(np.intp) * CALM
    return moved, pair


def _pairs(behaviour: Behaviour, agents: NDArray[np.int64]) -> NDArray[np.intp]:
    """(K,) kind and relation of the events that moved agents as one number, below 0 if none did."""
    pair = behaviour.event.take(agents).astype(np.intp)
    pair *= len(Relation)
    pair += behaviour.relation.take(agents)
    return pair


def _choose(
    compiled: CompiledTable,
    behaviour: Behaviour,
    machine: int,
    state: NDArray[np.int16],
    agents: NDArray[np.int64],
    when: NDArray[np.int32],
    columns: Columns,
    rng: np.random.Generator,
) -> tuple[Choice, NDArray[np.int32]]:
    """Where agents go, and how many pose ticks those stay who do."""
    since = when - behaviour.entered[machine].take(agents)
    asked = _Asked(behaviour, agents, since, when, columns)
    choice = compiled.choices.draw(state, asked.pair, asked.number, rng)
    stay = choice.least
    several = np.flatnonzero((choice.most > stay) & (choice.target == state))
    if len(several):
        stay[several] = rng.integers(stay[several], choice.most[several] + 1)
    stay *= np.int32(PIECE)
    over = np.flatnonzero((since >= compiled.limit.take(state)) & (choice.target == state))
    if len(over):
        choice.target[over] = compiled.leave_to.take(state.take(over))
        choice.blend[over] = LIMIT_BLEND
    return choice, stay


class _Asked:
    """What rules ask of some agents, gathered once."""

    def __init__(
        self,
        behaviour: Behaviour,
        agents: NDArray[np.int64],
        since: NDArray[np.int32],
        when: NDArray[np.int32],
        columns: Columns,
    ) -> None:
        self.agents, self.since, self.columns = agents, since, columns
        self.behaviour = behaviour
        self.active = behaviour.stirred_from.take(agents) <= when
        self.active &= behaviour.stirred_until.take(agents) > when
        self.pair = np.full(len(agents), CALM, np.intp)
        active = np.flatnonzero(self.active)
        if len(active):
            self.pair[active] = _pairs(behaviour, agents.take(active))
        self.values: dict[str, NDArray[Any]] = {}

    def number(self, name: str) -> NDArray[Any]:
        """A number that rules may ask for, 0 where nobody supplies it."""
        if name not in self.values:
            if name == "time":
                self.values[name] = self.since // PIECE
            elif name == "weight":
                impact = self.behaviour.impact.take(self.agents)
                self.values[name] = np.where(self.active, impact, np.float32(0.0))
            elif name in self.columns:
                self.values[name] = self.columns[name].take(self.agents)
            else:
                self.values[name] = np.zeros(len(self.agents), np.float32)
        return self.values[name]


def _enter(
    compiled: CompiledTable,
    behaviour: Behaviour,
    machine: int,
    agents: NDArray[np.int64],
    state: NDArray[np.int16],
    when: NDArray[np.int32],
    columns: Columns,
    rng: np.random.Generator,
) -> None:
    """Put agents into states: how they look there, for how long, and what the channels say."""
    b = behaviour
    excitement = columns["excitement"].take(agents)
    variant, motion = compiled.looks.draw(state, excitement, rng)
    planned = np.flatnonzero(b.ahead[machine].take(agents) == state)
    if len(planned):
        who = agents.take(planned)
        variant[planned] = b.ahead_variant[machine].take(who)
        motion[planned] = b.ahead_motion[machine].take(who)
        b.ahead[machine][who] = -1
    if machine == 0:
        # What a body shows goes on where a state has nothing of its own.
        keeps = np.flatnonzero(motion == KEEP)
        motion[keeps] = b.motion[0].take(agents.take(keeps))
    b.state[machine][agents] = state
    b.variant[machine][agents] = variant
    b.motion[machine][agents] = motion
    b.entered[machine][agents] = when
    b.until[machine][agents] = _end_of_stay(compiled, b, machine, state, agents, when, rng)
    for channel, values in (
        (b.posture, compiled.posture),
        (b.arms, compiled.arms),
        (b.head, compiled.head),
    ):
        value = values.take(state)
        named = np.flatnonzero(value != KEEP)
        channel[agents.take(named)] = value.take(named)
    bridges = np.flatnonzero(compiled.is_bridge.take(state))
    if len(bridges):
        who, at = agents.take(bridges), state.take(bridges)
        then = when.take(bridges) + np.int32(PIECE)
        after = _choose(compiled, b, machine, at, who, then, columns, rng)[0].target
        goes = np.flatnonzero(after != at)
        who, after = who.take(goes), after.take(goes)
        variant, motion = compiled.looks.draw(after, columns["excitement"].take(who), rng)
        b.ahead[machine][who], b.ahead_variant[machine][who] = after, variant
        b.ahead_motion[machine][who] = b.motion[machine][who] = motion


def _end_of_stay(
    compiled: CompiledTable,
    b: Behaviour,
    machine: int,
    state: NDArray[np.int16],
    agents: NDArray[np.int64],
    when: NDArray[np.int32],
    rng: np.random.Generator,
) -> NDArray[np.int32]:
    """When stays end that begin at `when`; those of drawn length end on the beat next to it."""
    least, most = compiled.pieces[:, 0].take(state), compiled.pieces[:, 1].take(state)
    stay: NDArray[np.int32] = least
    several = np.flatnonzero(most > least)
    if len(several):
        stay[several] = rng.integers(least.take(several), most.take(several) + 1)
    stay *= np.int32(PIECE)
    late = when.take(several) - _beat(machine, agents.take(several))
    late += np.int32(PIECE // 2)
    late %= np.int32(PIECE)
    stay[several] -= late - np.int32(PIECE // 2)
    # Whoever comes here on the way to somewhere else, for an event, goes on after a piece.
    moved, at = _moved(b, agents, state, b.stirred_until.take(agents) > when)
    if len(moved):
        stay[moved[compiled.wakes.ravel().take(at)]] = PIECE
    stay += when
    ready = _awake(compiled, b, agents, state, stay)
    end: NDArray[np.int32] = np.minimum(ready, when + compiled.limit.take(state))
    return end

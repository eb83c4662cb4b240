"""The crowd's state machine: only agents whose stay ends are looked at, all of them at once.

*Thesis* 3.2.1: an agent is in a state for some pieces of 10 pose frames and then takes one of the
ways that are open, by effort. Time is an integer and each agent may have its own, so that a crowd
can be brought to the mix of states that it has in the long run before the first tick.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...components.behaviour import Behaviour
from .compiled import KEEP, CompiledRule, CompiledTable
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
        _enter(compiled, behaviour, machine, agents, start, agents * 0, columns, rng)
    behaviour.until[:] = 1


def settle(
    compiled: CompiledTable, behaviour: Behaviour, columns: Columns, rng: np.random.Generator
) -> None:
    """Let a calm minute and a half pass for everyone: a crowd is found in the middle of things.

    Afterwards stays end after pose tick 0, and each began before.
    """
    behaviour.until[:] = 1 - _SETTLING
    behaviour.entered[:] = 1 - _SETTLING - PIECE
    for machine, start in enumerate(compiled.starts):
        behaviour.state[machine] = start
        late = np.arange(behaviour.state.shape[1])
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
    free = np.where(target < 0, state, np.int16(len(compiled.names)))
    for number in _present(free, len(compiled.names)):
        k = np.flatnonzero(free == number)
        if len(k):
            who, now = agents.take(k), when.take(k)
            target[k], length[k], stay = _choose(
                compiled, b, machine, number, who, now, columns, rng
            )
            stays = target[k] == number
            if stays.any():
                who, now, stay = who[stays], now[stays], stay[stays]
                ready = _awake(compiled, b, who, number, now + stay)
                end = b.entered[machine].take(who) + compiled.limit[number]
                b.until[machine][who] = np.minimum(ready, end)
    changes = np.flatnonzero(target != state)
    moving: NDArray[np.int64] = agents.take(changes)
    to, at = target.take(changes), when.take(changes)
    if blend is not None and machine == 0:
        length = length.take(changes)
        blend[moving] = np.where(length > 0, length, blend.take(moving))
    for number in _present(to, len(compiled.names)):
        k = np.flatnonzero(to == number)
        _enter(compiled, b, machine, moving.take(k), number, at.take(k), columns, rng)
    return moving


def _present(states: NDArray[np.int16], count: int) -> list[int]:
    """The states below `count` that occur, ascending."""
    return [int(k) for k in np.flatnonzero(np.bincount(states, minlength=count)[:count])]


def _awake(
    compiled: CompiledTable,
    behaviour: Behaviour,
    agents: NDArray[np.int64],
    state: int,
    when: NDArray[Any],
) -> NDArray[Any]:
    """When to look again at agents that are to be looked at at `when`, which may be pieces later.

    As long as an event moves an agent in a state that no rule leaves under it, there is nothing to
    decide.
    """
    sleeps = compiled.sleeps[state]
    if not sleeps.any():
        return when
    left = behaviour.stirred_until.take(agents) - when
    moved = np.flatnonzero(left > 0)
    if not len(moved):
        return when
    who = agents.take(moved)
    sleeping = moved[sleeps[behaviour.event.take(who), behaviour.relation.take(who)]]
    ready: NDArray[Any] = when.copy()
    ready[sleeping] += -(-left[sleeping] // PIECE) * PIECE
    return ready


def _choose(
    compiled: CompiledTable,
    behaviour: Behaviour,
    machine: int,
    state: int,
    agents: NDArray[np.int64],
    when: NDArray[np.int32],
    columns: Columns,
    rng: np.random.Generator,
) -> tuple[NDArray[np.int16], NDArray[np.float32], NDArray[np.int32]]:
    """Where agents of one state go, blends, and how long those stay who do, all in pose ticks."""
    rules = compiled.rules[state]
    since = when - behaviour.entered[machine].take(agents)
    asked = _Asked(behaviour, agents, since, when, columns)
    is_open = [(rule, good) for rule in rules if (good := asked.meets(rule)) is not None]
    targets = np.full(len(agents), state, np.int16)
    blends = np.zeros(len(agents), np.float32)
    stays = np.full(len(agents), PIECE, np.int32)
    chosen: list[slice | NDArray[np.int64]] = []
    if len(is_open) == 1:
        good = is_open[0][1]
        chosen = [slice(None) if good.all() else np.flatnonzero(good)]
    elif is_open:
        edges = np.empty((len(is_open), len(agents)), np.float32)
        total = np.zeros(len(agents), np.float32)
        for row, (rule, good) in zip(edges, is_open, strict=True):
            np.multiply(good, np.float32(1.0 / rule.effort), out=row)
            row += total
            total = row
        draw = rng.random(len(agents), np.float32) * edges[-1]
        np.minimum(draw, np.nextafter(edges[-1], np.float32(0.0)), out=draw)
        pick = _count_passed(edges, draw)
        chosen = [np.flatnonzero(pick == number) for number in range(len(is_open))]
    for (rule, _), k in zip(is_open, chosen, strict=True):
        targets[k], blends[k] = rule.target, rule.blend
        if rule.target == state and rule.pieces != (1, 1):
            some = stays[k]
            stays[k] = PIECE * rng.integers(rule.pieces[0], rule.pieces[1] + 1, len(some))
    over = since >= compiled.limit[state]
    if over.any():
        over &= targets == state
        targets[over] = compiled.leave_to[state]
        blends[over] = LIMIT_BLEND
    return targets, blends, stays


def _count_passed(
    edges: NDArray[Any] | Sequence[Any], draw: NDArray[np.floating[Any]]
) -> NDArray[np.int8]:
    """(K,) how many of some ascending edges, numbers or (K,) each, lie at or below a draw (K,)."""
    passed = np.zeros(len(draw), np.int8)
    for edge in edges:
        passed += edge <= draw
    return passed


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
        self.any_active = bool(self.active.any())
        if self.any_active:
            # Both as one number, by which the pairs of rules are looked up.
            self.pair = behaviour.event.take(agents).astype(np.intp)
            self.pair *= len(Relation)
            self.pair += behaviour.relation.take(agents)
        self.values: dict[str, NDArray[Any]] = {}

    def meets(self, rule: CompiledRule) -> NDArray[np.bool_] | None:
        """Who meets a rule's conditions; None if nobody does."""
        if rule.pairs is not None:
            if not self.any_active:
                return None
            # Whoever no event ever moved has no pair, and is not active.
            good = rule.pairs.ravel().take(self.pair, mode="clip")
            good &= self.active
        elif rule.calm:
            good = ~self.active
        else:
            good = np.ones(len(self.agents), np.bool_)
        for name, least, below in rule.limits:
            value = self.number(name)
            if np.isfinite(least):
                good &= value >= least
            if np.isfinite(below):
                good &= value < below
        for name, wanted in rule.signals:
            if name in self.columns:
                good &= self.columns[name].take(self.agents).astype(np.bool_) == wanted
            elif wanted:
                return None
        return good if good.any() else None

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
    state: int,
    when: NDArray[Any],
    columns: Columns,
    rng: np.random.Generator,
) -> None:
    """Put agents into a state: how they look there, for how long, and what the channels say."""
    b = behaviour
    variant, motion = _draw_look(compiled, state, agents, columns, rng)
    planned = b.ahead[machine].take(agents) == state
    if planned.any():
        variant = np.where(planned, b.ahead_variant[machine].take(agents), variant)
        motion = np.where(planned, b.ahead_motion[machine].take(agents), motion)
        b.ahead[machine][agents] = -1
    if machine == 0:
        # What a body shows goes on where a state has nothing of its own.
        keeps = np.flatnonzero(motion == KEEP)
        motion[keeps] = b.motion[0].take(agents.take(keeps))
    b.state[machine][agents] = state
    b.variant[machine][agents] = variant
    b.motion[machine][agents] = motion
    b.entered[machine][agents] = when
    b.until[machine][agents] = _end_of_stay(compiled, b, state, agents, when, rng)
    for channel, values in (
        (b.posture, compiled.posture),
        (b.arms, compiled.arms),
        (b.head, compiled.head),
    ):
        if values[state] != KEEP:
            channel[agents] = values[state]
    if compiled.is_bridge[state]:
        after, _, _ = _choose(
            compiled, behaviour, machine, state, agents, when + PIECE, columns, rng
        )
        for number in _present(after, len(compiled.names)):
            if number == state:
                continue
            k = agents[after == number]
            variant, motion = _draw_look(compiled, number, k, columns, rng)
            b.ahead[machine, k], b.ahead_variant[machine, k] = number, variant
            b.ahead_motion[machine, k] = b.motion[machine, k] = motion


def _end_of_stay(
    compiled: CompiledTable,
    b: Behaviour,
    state: int,
    agents: NDArray[np.int64],
    when: NDArray[Any],
    rng: np.random.Generator,
) -> NDArray[Any]:
    least, most = compiled.pieces[state]
    stay = np.full(len(agents), PIECE * least, np.int64)
    if most > least:
        stay = PIECE * rng.integers(least, most + 1, len(agents))
    wakes = compiled.wakes[state]
    if wakes.any():
        # Whoever comes here on the way to somewhere else, for an event, goes on after a piece.
        moved = np.flatnonzero(b.stirred_until.take(agents) > when)
        who = agents.take(moved)
        stay[moved[wakes[b.event.take(who), b.relation.take(who)]]] = PIECE
    ready = _awake(compiled, b, agents, state, when + stay)
    end: NDArray[Any] = np.minimum(ready, when + compiled.limit[state])
    return end


def _draw_look(
    compiled: CompiledTable,
    state: int,
    agents: NDArray[np.int64],
    columns: Columns,
    rng: np.random.Generator,
) -> tuple[NDArray[np.int16], NDArray[np.int16]]:
    """Variants and motions for agents that enter a state, by effort, the more the more excited."""
    look = compiled.looks[state]
    if len(look.motion) == 1:
        return (
            np.full(len(agents), look.variant[0], np.int16),
            np.full(len(agents), look.motion[0], np.int16),
        )
    least = look.excitement.min()
    edges: NDArray[Any] | list[Any]
    if (look.excitement == least).all():
        # Everyone has the same choice.
        edges = np.cumsum(look.chance)
    else:
        excitement = np.maximum(columns["excitement"].take(agents), least)
        edges = [np.where(look.excitement[0] <= excitement, look.chance[0], 0.0)]
        for from_, chance in zip(look.excitement[1:], look.chance[1:], strict=True):
            edges.append(edges[-1] + chance * (from_ <= excitement))
    draw = rng.random(len(agents))
    draw *= edges[-1]
    np.minimum(draw, np.nextafter(edges[-1], 0.0), out=draw)
    pick = np.minimum(_count_passed(edges, draw), len(look.motion) - 1)
    return look.variant.take(pick), look.motion.take(pick)

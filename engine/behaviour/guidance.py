"""Orders from outside and scripts of groups: what agents shall show, or shall not, for a time.

An order says what one channel shows, or what must not be shown; nothing else about the agent stops:
its states go on beneath, and come to light when the order ends. Where orders of the same priority
contradict each other, the latest that still lasts counts; when it ends, the one before does again.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from ...components.behaviour import Behaviour
from ...components.motion import NEVER
from ..crowd.motions import MotionLibrary, Role
from ..streams.pool import POSE_RATE
from .compiled import CompiledTable
from .machine import union
from .table import POSTURES

CHANNELS = ("body", "posture", "arms", "head")
"""What an order may be about; ``body`` is all of the others."""
BODY, POSTURE, ARMS, HEAD = range(4)
NOTHING = -1


class Priority(IntEnum):
    """Orders that events override, orders that override everything, and what a body has to do."""

    SCRIPTED = 0
    GUIDED = 1
    BOUND = 2


@dataclass(slots=True, eq=False)
class Order:
    """What some agents were told.

    Parameters
    ----------
    agents
        (K,) ids.
    priority, channel
        How it ranks, and what it is about (an index of `CHANNELS`).
    motions
        (K,) int16 motions of the library; None demands none.
    value
        What the channel's column says: a posture, a value of the table's arms or head, or -1.
    state
        State of the table that is demanded, or -1.
    forbidden
        (S,) bool states that must not be shown.
    ticks
        Pose ticks that it lasts.
    end
        Pose tick at which it is over; None before it began.
    """

    agents: NDArray[np.int64]
    priority: Priority
    channel: int
    motions: NDArray[np.int16] | None
    value: int
    state: int
    forbidden: NDArray[np.bool_]
    ticks: int
    end: int | None = None


class Guidance:
    """The orders of a crowd, and what they come to for each agent.

    Parameters
    ----------
    agents, states
        Agents of the crowd and states of its table.
    rng
        Draws among the motions that an order leaves open.

    Attributes
    ----------
    motion
        (3, 4, N) int16 motion demanded, by priority and channel; -1 none.
    value
        (3, 4, N) int8 what the channel's column says.
    forbidden
        (3, N) int64 bits of the states that must not be shown.
    """

    def __init__(self, agents: int, states: int, rng: np.random.Generator) -> None:
        if states > 63:
            raise ValueError(f"states is {states}, expected at most 63")
        shape = (len(Priority), len(CHANNELS), agents)
        self.motion = np.full(shape, NOTHING, np.int16)
        self.value = np.full(shape, NOTHING, np.int8)
        self.forbidden = np.zeros((len(Priority), agents), np.int64)
        self.orders: list[Order] = []
        self.rng = rng
        self._changed: list[NDArray[np.int64]] = []
        self._is_told = np.zeros(agents, np.bool_)
        self._reacted = np.zeros(agents, np.bool_)

    def give(self, order: Order) -> None:
        """Add an order; it counts from the next pose tick on."""
        if len(order.agents):
            self.orders.append(order)
            self._changed.append(order.agents)

    def end(self, order: Order) -> None:
        """Withdraw an order; nothing happens if it is over."""
        if any(other is order for other in self.orders):
            self.orders = [other for other in self.orders if other is not order]
            self._changed.append(order.agents)

    def revise(self, order: Order, agents: NDArray[np.int64], motions: NDArray[np.int16]) -> None:
        """Change to whom an order speaks, ascending ids (K,), and which motions (K,) it demands.

        It keeps its place among the others, and is withdrawn while it speaks to nobody.
        """
        assert order.motions is not None
        before, after = _among(order.agents, agents), _among(agents, order.agents)
        same = np.zeros(len(agents), np.bool_)
        same[after] = order.motions[before] == motions[after]
        for some in (order.agents[~before], agents[~same]):
            if len(some):
                self._changed.append(some)
        order.agents, order.motions = agents, motions
        listed = any(other is order for other in self.orders)
        if listed and not len(agents):
            self.orders = [other for other in self.orders if other is not order]
        elif len(agents) and not listed:
            order.end = None
            self.orders.append(order)

    def step(self, tick: int, behaviour: Behaviour) -> NDArray[np.int64]:
        """Begin and end orders at pose tick `tick`; ids of whom a change concerns, ascending.

        Those who have orders and begin or cease to react to an event are among them.
        """
        for order in self.orders.copy():
            if order.end is None:
                order.end = min(tick + order.ticks, NEVER)
            elif order.end <= tick:
                self.end(order)
        if self.orders:
            told = np.flatnonzero(self._is_told)
            flips = told[behaviour.reacting[told] != self._reacted[told]]
            self._reacted[told] = behaviour.reacting[told]
            if len(flips):
                self._changed.append(flips)
        if not self._changed:
            return np.zeros(0, np.int64)
        concerned = union(self._changed, len(self._is_told))
        self._changed = []
        self._apply(concerned)
        return concerned

    def demanded(self, agents: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Which of the agents any order concerns."""
        return self._is_told[agents]

    def _apply(self, agents: NDArray[np.int64]) -> None:
        chosen = np.zeros(len(self._is_told), np.bool_)
        chosen[agents] = True
        self.motion[:, :, agents] = NOTHING
        self.value[:, :, agents] = NOTHING
        self.forbidden[:, agents] = 0
        self._is_told[agents] = False
        states = np.full(self.motion.shape, NOTHING, np.int16) if self.orders else None
        for order in self.orders:
            assert states is not None
            mine = chosen[order.agents]
            ids = order.agents[mine]
            if not len(ids):
                continue
            self._is_told[ids] = True
            level, channel = order.priority, order.channel
            banned = np.flatnonzero(order.forbidden)
            if len(banned):
                self.forbidden[level, ids] |= _bits(order.forbidden)
                for earlier in range(len(CHANNELS)):
                    void = ids[np.isin(states[level, earlier, ids], banned)]
                    self.motion[level, earlier, void] = NOTHING
                    self.value[level, earlier, void] = NOTHING
            if order.motions is not None or order.value != NOTHING:
                if channel == BODY:
                    self.motion[level, :, ids] = NOTHING
                    self.value[level, :, ids] = NOTHING
                elif channel == ARMS:
                    # A later word on the arms ends an earlier one on the whole body.
                    self.motion[level, BODY, ids] = self.value[level, BODY, ids] = NOTHING
                if order.motions is not None:
                    self.motion[level, channel, ids] = order.motions[mine]
                self.value[level, channel, ids] = order.value
                states[level, channel, ids] = order.state
                if order.state != NOTHING:
                    self.forbidden[level, ids] &= ~(np.int64(1) << np.int64(order.state))


def make_order(
    compiled: CompiledTable,
    library: MotionLibrary,
    agents: NDArray[np.int64],
    *,
    motion: str | None,
    channel: str,
    seconds: float | None,
    forbid: tuple[str, ...],
    priority: Priority,
    rng: np.random.Generator,
) -> Order:
    """Check what a caller wants and turn names into numbers.

    Parameters
    ----------
    motion
        A state of the table, a motion of the library, a role, or a value of the channel; None
        demands nothing.
    channel
        One of `CHANNELS`.
    seconds
        How long it lasts; None until it is withdrawn.
    forbid
        States, roles, or values of the channels arms and head that must not be shown.
    rng
        Draws among several motions.

    Raises
    ------
    ValueError
        For unknown names, an order that demands what it forbids or says nothing, or a time that is
        not finite or not above 0.
    """
    if channel not in CHANNELS:
        raise ValueError(f"channel is {channel!r}, expected one of {', '.join(CHANNELS)}")
    if seconds is not None and not 0.0 < seconds < float("inf"):
        raise ValueError(f"seconds is {seconds!r}, expected a finite time above 0, or None")
    if motion is None and not forbid:
        raise ValueError("motion is None and forbid is empty: the order says nothing")
    number = CHANNELS.index(channel)
    banned = np.zeros(len(compiled.names), np.bool_)
    for name in forbid:
        banned |= _forbidden(name, compiled)
    motions, value, state = None, NOTHING, NOTHING
    if motion is not None:
        motions, value, state = _demand(motion, number, compiled, library, len(agents), rng)
        if state != NOTHING and banned[state]:
            raise ValueError(f"motion is {motion!r}, which forbid rules out")
    ticks = NEVER if seconds is None else min(max(1, round(seconds * POSE_RATE)), NEVER)
    return Order(agents, priority, number, motions, value, state, banned, ticks)


def _demand(
    name: str,
    channel: int,
    compiled: CompiledTable,
    library: MotionLibrary,
    count: int,
    rng: np.random.Generator,
) -> tuple[NDArray[np.int16] | None, int, int]:
    """Motions, value of the channel's column, and state that a name stands for."""
    if channel == POSTURE:
        if name not in POSTURES:
            raise ValueError(f"motion is {name!r}, expected a posture: {' or '.join(POSTURES)}")
        return None, POSTURES.index(name), NOTHING
    names, column = {
        ARMS: (compiled.arms_names, compiled.arms),
        HEAD: (compiled.head_names, compiled.head),
    }.get(channel, ((), compiled.arms))
    if name in compiled.names:
        state = compiled.names.index(name)
        return _of_state(compiled, state, count, rng), int(column[state]), state
    if name in names:
        value = names.index(name)
        fitting = np.flatnonzero(column == value)
        if value == 0 or not len(fitting):
            return None, value, NOTHING
        state = int(fitting[0])
        return _of_state(compiled, state, count, rng), value, state
    roles = {role.value: role for role in Role}
    if name in roles:
        return library.draw(roles[name], count, rng), NOTHING, NOTHING
    if name in library.names:
        return np.full(count, library.names.index(name), np.int16), NOTHING, NOTHING
    known = dict.fromkeys((*compiled.names, *names, *roles, *library.names))
    raise ValueError(f"motion is {name!r}, expected one of {', '.join(known)}")


def _of_state(
    compiled: CompiledTable, state: int, count: int, rng: np.random.Generator
) -> NDArray[np.int16] | None:
    look = compiled.looks[state]
    if (look.motion < 0).all():
        return None
    drawn: NDArray[np.int16] = rng.choice(look.motion, count, p=look.chance / look.chance.sum())
    return drawn


def _forbidden(name: str, compiled: CompiledTable) -> NDArray[np.bool_]:
    states = compiled.table.states
    banned = np.array(
        [
            name in (state.name, state.arms, state.head)
            or (state.role is not None and name == state.role.value)
            for state in states
        ]
    )
    if not banned.any():
        known = dict.fromkeys(
            word
            for state in states
            for word in (state.name, state.arms, state.head, state.role and state.role.value)
            if word
        )
        raise ValueError(f"forbid has {name!r}, expected some of {', '.join(known)}")
    return banned


def _bits(mask: NDArray[np.bool_]) -> np.int64:
    return np.int64(sum(1 << int(k) for k in np.flatnonzero(mask)))


def _among(ids: NDArray[np.int64], others: NDArray[np.int64]) -> NDArray[np.bool_]:
    """(K,) which of some ids are among others; both ascend."""
    if not len(others):
        return np.zeros(len(ids), np.bool_)
    found: NDArray[np.bool_] = (
        others[np.minimum(np.searchsorted(others, ids), len(others) - 1)] == ids
    )
    return found

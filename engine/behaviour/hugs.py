"""Pairs who hug after a goal, on two clips that match and begin together.

Who hugs whom is settled by who came with whom (`Party.partner`). In the seconds after the event
pairs who are both on their feet and celebrating fall into each other's arms, each pair at its own
moment: a constant hazard. Both enter their clips at the beginning in the same pose tick, and so
stay in phase; both turn to each other while they do.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components.behaviour import Behaviour
from ...components.body import Body
from ...components.party import Party
from ...components.placement import Placement
from ..crowd.seating import SeatPlan
from ..streams.pool import POSE_RATE
from .compiled import CompiledTable
from .events import KINDS, Event
from .facing import Facing
from .machine import wake
from .parties import turn_towards
from .table import PIECE, Relation

HUGGED = ("goal", "final_whistle")
"""Events after which people hug, if they are good for their side."""
LEAST_WEIGHT = 0.6
"""Of such an event."""
WINDOW = (1.2, 7.0)
"""Seconds after the event between which hugs begin."""
HAZARD = 0.16
"""Chance that a pair begins to hug, a second, while both could."""
REACH = 0.75
"""Metres between partners, at most."""
ALIKE = 0.14
"""By how much partners' sizes may differ, as a share."""
STATES = ("hug_a", "hug_b")
"""States of a table in which the two of a pair are."""


class Hugs:
    """The pairs of one crowd.

    Parameters
    ----------
    plan, party, body, placement, facing
        Seats, who came with whom, their bodies, where they stand, and what turns them.
    rng
        Where moments come from.

    Attributes
    ----------
    signals
        ``hug_first`` and ``hug_second`` (N,) bool: the agent shall begin now, as one or the other.
    """

    def __init__(
        self,
        plan: SeatPlan,
        party: Party,
        body: Body,
        placement: Placement,
        facing: Facing,
        rng: np.random.Generator,
    ) -> None:
        self._rng, self._facing = rng, facing
        first = np.flatnonzero(party.partner > np.arange(plan.count))
        second = party.partner[first].astype(np.int64)
        apart = np.linalg.norm(plan.position[:, first] - plan.position[:, second], axis=0)
        ratio = placement.scale[first] / placement.scale[second]
        fits = (apart <= REACH) & (body.kind[first] == body.kind[second])
        fits &= np.abs(np.log(ratio)) <= ALIKE
        self._pairs = np.stack([first[fits], second[fits]])
        turn = [turn_towards(plan, self._pairs[k], self._pairs[1 - k]) for k in (0, 1)]
        # Seen from where the agent looks, not from its seat.
        own = placement.yaw[self._pairs] - plan.yaw[self._pairs]
        self._turn = (np.stack(turn) - own).astype(np.float32)
        self.signals: dict[str, NDArray[np.bool_]] = {
            name: np.zeros(plan.count, np.bool_) for name in ("hug_first", "hug_second")
        }
        self._opens, self._closes = 0, -1
        self._told = self._pairs[:, :0]
        self._until = np.zeros(self._pairs.shape[1], np.int32)

    def see(self, event: Event, tick: int) -> None:
        """Let an event open the time in which pairs hug."""
        if event.kind in HUGGED and (event.weight or 0.0) >= LEAST_WEIGHT:
            self._opens = tick + round(WINDOW[0] * POSE_RATE)
            self._closes = tick + round(WINDOW[1] * POSE_RATE)

    def step(
        self,
        compiled: CompiledTable,
        behaviour: Behaviour,
        busy_until: NDArray[np.int32],
        away: NDArray[np.bool_],
        tick: int,
    ) -> None:
        """Choose the pairs that begin in this pose tick, and wake them; none who is `away`."""
        for signal, told in zip(self.signals.values(), self._told, strict=True):
            signal[told] = False
        self._told = self._pairs[:, :0]
        if not self._opens <= tick < self._closes or not set(STATES) <= set(compiled.names):
            return
        ready = (self._until <= tick) & (self._rng.random(len(self._until)) < HAZARD / POSE_RATE)
        ready &= ~self._facing.turning[self._pairs].any(axis=0)
        pair = np.flatnonzero(ready)
        both = self._pairs[:, pair]
        kinds = [KINDS.index(kind) for kind in HUGGED]
        able = behaviour.reacting[both] & ~away[both] & (behaviour.relation[both] == Relation.OWN)
        able &= np.isin(behaviour.event[both], kinds) & (busy_until[both] <= tick)
        for k, name in enumerate(STATES):
            ways = [
                any(rule.target == compiled.number(name) for rule in out) for out in compiled.rules
            ]
            able[k] &= np.array(ways)[behaviour.state[0, both[k]]]
        pair = pair[able.all(axis=0)]
        self._told = self._pairs[:, pair]
        for signal, told in zip(self.signals.values(), self._told, strict=True):
            signal[told] = True
            wake(behaviour, 0, told, tick, rapid=True)
        stay = int(compiled.pieces[compiled.number(STATES[0]), 0]) * PIECE
        self._until[pair] = tick + stay
        for told, turn in zip(self._told, self._turn[:, pair], strict=True):
            self._facing.turn(told, turn, tick, stay / POSE_RATE)

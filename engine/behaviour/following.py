"""Parties that follow somebody: they get up and sit down with him, and are moved by what moves him.

*Thesis* 2.2.1: a group follows its leader or only shares a label. Who follows looks at the leader
three times a second, an agent at one of ten pose ticks, so that a party moves within a third of a
second of him and not as one. Nobody is held back: somebody who is moved and whose leader isn't
cheers by himself, and something bigger isn't interrupted.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components.behaviour import Behaviour
from ...components.party import Party
from ...components.team import Team
from .machine import wake
from .table import PIECE, SEATED, Relation

_SHARED = int(Relation.NEUTRAL)
"""Relations up to this one hold for a whole side; the ball hits one alone."""


class Following:
    """Who follows whom in one crowd.

    Parameters
    ----------
    party, team
        Columns of the crowd. Events are followed by who is of the leader's side.

    Attributes
    ----------
    stands
        (N,) bool: the agent follows somebody who is on his feet, at his seat.
    """

    __slots__ = ("_followers", "_leaders", "_team", "stands")

    def __init__(self, party: Party, team: Team) -> None:
        ids = np.arange(len(party.leader))
        self._followers = np.flatnonzero((party.leader >= 0) & (party.leader != ids))
        self._leaders = party.leader[self._followers].astype(np.int64)
        self._team = team
        self.stands = np.zeros(len(ids), np.bool_)

    def of(self, leaders: NDArray[np.int64]) -> NDArray[np.int64]:
        """(K,) int64 ids of those who follow any of some agents, ascending."""
        return self._followers[np.isin(self._leaders, leaders)]

    def leader_of(self, followers: NDArray[np.int64]) -> NDArray[np.int64]:
        """(K,) int64 ids of the leaders of some who follow."""
        return self._leaders[np.searchsorted(self._followers, followers)]

    def begin(self, behaviour: Behaviour) -> NDArray[np.int64]:
        """Let everybody know what the leaders do; ids of those whose leader stands."""
        self.stands[self._followers] = behaviour.posture[self._leaders] != SEATED
        return np.flatnonzero(self.stands)

    def step(self, tick: int, behaviour: Behaviour, away: NDArray[np.bool_]) -> None:
        """Let a tenth of those who follow look at their leaders.

        Parameters
        ----------
        tick
            Pose tick.
        behaviour
            Changed in place.
        away
            (N,) who isn't at the seat; nobody follows him there.
        """
        count, turn = len(self._followers), tick % PIECE
        part = slice(turn * count // PIECE, (turn + 1) * count // PIECE)
        who, leader = self._followers[part], self._leaders[part]
        there = ~(away[leader] | away[who])
        self._stand(tick, behaviour, who, (behaviour.posture[leader] != SEATED) & there)
        same = behaviour.stirred_until[who] == behaviour.stirred_until[leader]
        some = np.flatnonzero(there & ~same)
        who, leader = who[some], leader[some]
        some = np.flatnonzero(self._team.side[who] == self._team.side[leader])
        if len(some):
            self._share(tick, behaviour, who[some], leader[some])

    def _stand(
        self, tick: int, b: Behaviour, who: NDArray[np.int64], stands: NDArray[np.bool_]
    ) -> None:
        """Let those know whose leader got up or sat down; who is moved has other reasons."""
        news = np.flatnonzero(self.stands[who] != stands)
        who, stands = who[news], stands[news]
        self.stands[who] = stands
        woken = who[((b.posture[who] != SEATED) != stands) & ~b.reacting[who]]
        wake(b, 0, woken, tick + 1)

    @staticmethod
    def _share(tick: int, b: Behaviour, who: NDArray[np.int64], leader: NDArray[np.int64]) -> None:
        """Let what moves leaders move those who follow, and end with them."""
        event, relation = b.event[leader], b.relation[leader]
        begin, end = b.stirred_from[leader], b.stirred_until[leader]
        alike = (b.event[who] == event) & (b.relation[who] == relation)
        until = b.stirred_until[who]
        moved = until > tick
        # The same moves both: they stop together, wherever one of them would have gone on.
        both = alike & moved & (b.stirred_from[who] < end)
        b.stirred_until[who[both]] = np.maximum(end[both], tick)
        calls = (begin <= tick) & (end > tick) & (relation <= _SHARED) & ~both
        left = until - np.int32(tick)
        whole = np.maximum(until - b.stirred_from[who], 1)
        calls &= b.strength[leader] >= b.strength[who] * (left / whole).clip(0.0, 1.0)
        who, leader = who[calls], leader[calls]
        for column in (b.event, b.relation, b.impact, b.strength, b.stirred_until):
            column[who] = column[leader]
        b.stirred_from[who] = tick + 1
        wake(b, 0, who, tick + 1)

"""How an application lets people come and go."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..components.behaviour import Behaviour
from ..components.seat import Seat
from ..components.walk import Errand, Walk
from ..engine.behaviour.company import Company
from ..engine.behaviour.walkers import Walkers
from ..engine.streams.pool import POSE_RATE
from .guiding import Chosen

MOST_SECONDS = 86_400.0
BEHIND, AFTER = 4, 0.4
"""Who goes along does so up to so many times so many seconds later."""


class Coming:
    """People who walk to their seats and away; a part of `Crowd`."""

    __slots__ = ()

    if TYPE_CHECKING:
        seat: Seat
        company: Company
        behaviour: Behaviour
        walkers: Walkers | None
        select: Callable[..., NDArray[np.int64]]

    @property
    def walk(self) -> Walk:
        """Columns of those on their way; ValueError where nobody can walk."""
        return self._walkers().walk

    def arrive(
        self, agents: Chosen, *, team: int | None = None, seconds: float = 0.0
    ) -> NDArray[np.int64]:
        """Let people come through the doors and walk to their seats; who follows them comes along.

        Parameters
        ----------
        agents, team
            As for `select`.
        seconds
            Within which they come, at even chances; a door lets in one after the other in any case.

        Returns
        -------
        (K,) int64 ids of those who come, ascending: their seats are empty, and nobody is on the way
        to or from them.

        Raises
        ------
        ValueError
            Where nobody can walk, for unknown agents, or a time outside 0 to 86,400 s.
        """
        return self._send(agents, team, Errand.ARRIVE, seconds)

    def leave(
        self, agents: Chosen, *, team: int | None = None, seconds: float = 0.0
    ) -> NDArray[np.int64]:
        """Let people get up, walk to a door and be gone; who follows them goes along.

        Parameters and errors are as for `arrive`.

        Returns
        -------
        (K,) int64 ids of those who leave, ascending: they sit or stand at their seats
        """
        return self._send(agents, team, Errand.LEAVE, seconds)

    def _send(
        self, agents: Chosen, team: int | None, errand: Errand, seconds: float
    ) -> NDArray[np.int64]:
        walkers = self._walkers()
        if not 0.0 <= seconds <= MOST_SECONDS:
            raise ValueError(f"seconds is {seconds!r}, expected 0 to {MOST_SECONDS:,.0f}")
        led = self.company.following
        ids = self._fit(self.select(agents, team=team), errand)
        along = np.setdiff1d(self._fit(led.of(ids), errand), ids)
        after = np.zeros(len(self.seat.occupied))
        after[ids] = walkers.draw_times(len(ids), seconds)
        # One behind the other, so that a party doesn't get up as one.
        after[along] = after[led.leader_of(along)] + np.arange(len(along)) % BEHIND * AFTER
        ids = np.union1d(ids, along)
        ticks = self.behaviour.tick + 1 + np.rint(after[ids] * POSE_RATE).astype(np.int64)
        self.company.excuse(ids, away=True)
        walkers.send(ids, errand, ticks)
        return ids

    def _fit(self, ids: NDArray[np.int64], errand: Errand) -> NDArray[np.int64]:
        """Those of some agents who can be sent on an errand."""
        walkers, there = self._walkers(), self.seat.occupied[ids]
        fit = there & ~walkers.away[ids] if errand is Errand.LEAVE else ~there
        return ids[fit & ~walkers.is_expected(ids)]

    def _walkers(self) -> Walkers:
        if self.walkers is None:
            raise ValueError("nobody walks in this crowd; make it with CrowdSpec(walking=True)")
        return self.walkers

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
        """Let people come through the doors and walk to their seats.

        Parameters
        ----------
        agents, team
            As for `select`.
        seconds
            Within which they come, at even chances; a door lets in one after the other in any case.

        Returns
        -------
        (K,) int64 ids of those who come: their seats are empty, and nobody is on the way to or from
        them.

        Raises
        ------
        ValueError
            Where nobody can walk, for unknown agents, or a time outside 0 to 86,400 s.
        """
        return self._send(agents, team, Errand.ARRIVE, seconds)

    def leave(
        self, agents: Chosen, *, team: int | None = None, seconds: float = 0.0
    ) -> NDArray[np.int64]:
        """Let people get up, walk to a door and be gone.

        Parameters and errors are as for `arrive`.

        Returns
        -------
        (K,) int64 ids of those who leave: they sit or stand at their seats
        """
        return self._send(agents, team, Errand.LEAVE, seconds)

    def _send(
        self, agents: Chosen, team: int | None, errand: Errand, seconds: float
    ) -> NDArray[np.int64]:
        walkers = self._walkers()
        if not 0.0 <= seconds <= MOST_SECONDS:
            raise ValueError(f"seconds is {seconds!r}, expected 0 to {MOST_SECONDS:,.0f}")
        ids: NDArray[np.int64] = self.select(agents, team=team)
        leaves = errand is Errand.LEAVE
        there = self.seat.occupied[ids]
        fit = there & ~walkers.away[ids] if leaves else ~there
        ids = ids[fit & ~walkers.is_expected(ids)]
        after = walkers.draw_times(len(ids), seconds)
        ticks = self.behaviour.tick + 1 + np.rint(after * POSE_RATE).astype(np.int64)
        self.company.excuse(ids, away=True)
        walkers.send(ids, errand, ticks)
        return ids

    def _walkers(self) -> Walkers:
        if self.walkers is None:
            raise ValueError("nobody walks in this crowd; make it with CrowdSpec(walking=True)")
        return self.walkers

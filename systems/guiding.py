"""How an application tells parts of a crowd what to do: selections and orders."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..components.behaviour import Behaviour
from ..components.emotion import Emotion
from ..components.team import MOST_SIDES, NEUTRAL, Team
from ..engine.behaviour.company import Company
from ..engine.behaviour.compiled import CompiledTable
from ..engine.behaviour.display import channel_values
from ..engine.behaviour.emotion import set_embarrassment
from ..engine.behaviour.facing import Facing
from ..engine.behaviour.guidance import Guidance, Order, Priority, make_order
from ..engine.behaviour.machine import wake
from ..engine.behaviour.table import POSTURES
from ..engine.crowd.agents import agent_ids
from ..engine.crowd.motions import MotionLibrary
from ..engine.crowd.occupancy import select
from ..engine.crowd.seating import SeatPlan

Chosen = int | str | Sequence[str] | ArrayLike | Callable[["Guiding"], ArrayLike]
"""Agents: an id, ids, a (N,) mask, one or several texts that name seats (``"section 5"``,
``"rows 2-4 columns 10-20"``), or a function of the crowd that gives ids or a mask."""


class Guiding:
    """Selections of agents, and orders to them; a part of `Crowd`."""

    __slots__ = ()

    if TYPE_CHECKING:
        plan: SeatPlan
        team: Team
        library: MotionLibrary
        emotion: Emotion
        behaviour: Behaviour
        table: CompiledTable
        company: Company
        guidance: Guidance
        facing: Facing

    def select(self, agents: Chosen | None = None, *, team: int | None = None) -> NDArray[np.int64]:
        """Ids of agents, for the calls that take agents.

        Parameters
        ----------
        agents
            See `Chosen`; everybody if None.
        team
            Only supporters of that side; -1 neutrals.

        Raises
        ------
        ValueError
            For agents or seats that don't exist, or no such side.
        """
        count = len(self.team.side)
        if callable(agents):
            agents = agents(self)
        if agents is None:
            ids = np.arange(count)
        elif isinstance(agents, str):
            ids = np.flatnonzero(select(self.plan, [agents]))
        elif isinstance(agents, (list, tuple)) and any(isinstance(a, str) for a in agents):
            if not all(isinstance(text, str) for text in agents):
                raise ValueError(f"agents is {agents!r}, expected texts or ids, not both")
            ids = np.flatnonzero(select(self.plan, [str(text) for text in agents]))
        else:
            ids = np.unique(agent_ids(agents, count))
        if team is None:
            return ids
        if team not in range(NEUTRAL, MOST_SIDES):
            raise ValueError(f"team is {team!r}, expected -1 (neutral) to {MOST_SIDES - 1}")
        mine: NDArray[np.int64] = ids[self.team.side[ids] == team]
        return mine

    def guide(
        self,
        agents: Chosen | None = None,
        *,
        team: int | None = None,
        motion: str | None = None,
        channel: str = "body",
        seconds: float | None = None,
        forbid: str | Sequence[str] = (),
    ) -> Order:
        """Order agents to show something, or not to, from the next pose tick on.

        It goes before everything else for the channel that it is about, and the other channels go
        on. Of contradictory orders the latest counts as long as it lasts. An empty selection is an
        order to nobody.

        Parameters
        ----------
        agents, team
            As for `select`.
        motion
            A state of the table, a motion of the library, a role, or a value of the channel, such
            as ``"standing"`` of ``"posture"``; None demands nothing.
        channel
            ``"body"`` (all of it), ``"posture"``, ``"arms"`` or ``"head"``.
        seconds
            How long; None until `release`.
        forbid
            States, roles or values of a channel that must not be shown: ``"clap"``.

        Returns
        -------
        Order
            For `release`.

        Raises
        ------
        ValueError
            For unknown names, an order that says nothing or demands what it forbids, or a time that
            isn't finite and above 0.
        """
        return self._order(Priority.GUIDED, agents, team, motion, channel, seconds, forbid)

    def script(
        self,
        agents: Chosen | None = None,
        *,
        team: int | None = None,
        motion: str | None = None,
        channel: str = "body",
        seconds: float | None = None,
        forbid: str | Sequence[str] = (),
    ) -> Order:
        """What a group does unless an event moves its people; otherwise as `guide`."""
        return self._order(Priority.SCRIPTED, agents, team, motion, channel, seconds, forbid)

    def face(
        self,
        agents: Chosen | None = None,
        place: tuple[float, float, float] | None = None,
        *,
        team: int | None = None,
        seconds: float | None = None,
    ) -> NDArray[np.int64]:
        """Let agents turn to a place, as far as they can, and do there whatever they do.

        Together with an order it makes them clap, wave or point towards somebody (*Thesis* 6.2).

        Parameters
        ----------
        agents, team
            As for `select`.
        place
            (x, y, z) metres in the stadium's frame; None lets them turn back.
        seconds
            After which they face ahead again; None until they are told otherwise.

        Returns
        -------
        (K,) int64 their ids; without those who are away or on their way

        Raises
        ------
        ValueError
            For agents that don't exist, or a place or time that isn't finite, or no time at all.
        """
        ids = self.select(agents, team=team)
        ids = ids[~self.company.away[ids]]
        tick = self.behaviour.tick + 1
        if place is None:
            self.facing.turn_back(ids, tick)
            return ids
        point = np.asarray(place, np.float64)
        if point.shape != (3,) or not np.isfinite(point).all():
            raise ValueError(f"place is {place!r}, expected three finite coordinates in metres")
        if seconds is not None and not 0.0 < seconds < 1e6:
            raise ValueError(f"seconds is {seconds!r}, expected a number above 0, or None")
        self.facing.turn_to(ids, (point[0], point[1], point[2]), tick, seconds)
        return ids

    def release(self, order: Order) -> None:
        """End an order before its time; nothing happens if it is over."""
        self.guidance.end(order)

    def set_embarrassment(self, level: float) -> None:
        """Make the whole crowd as embarrassed as that, 0 to 1; ValueError for anything else."""
        set_embarrassment(self.emotion, level)

    def wake(self, agents: Chosen, *, rapid: bool = False) -> None:
        """Let agents look for a way out of their state now, or at the end of the current piece.

        For mechanisms that change what rules ask for (`Behaviour.signals`) and want it noticed.
        """
        ids = self.select(agents)
        for machine in range(len(self.behaviour.state)):
            wake(self.behaviour, machine, ids, self.behaviour.tick + 1, rapid)

    def state_names(self, agents: Chosen | None = None, machine: int = 0) -> list[str]:
        """Names of the states that agents are in, whatever orders hide them."""
        ids = self.select(agents)
        return [self.table.names[k] for k in self.behaviour.state[machine, ids]]

    def in_state(self, name: str) -> NDArray[np.bool_]:
        """(N,) who is in a state of the table; ValueError for an unknown one."""
        number = self.table.number(name)
        found: NDArray[np.bool_] = self.behaviour.state[self.table.machine[number]] == number
        return found

    def channels(self, agents: Chosen | None = None) -> dict[str, list[str]]:
        """What agents do by channel, orders included: posture, arms and head by name."""
        ids = self.select(agents)
        values = channel_values(self.table, self.behaviour, self.guidance, ids)
        names = (POSTURES, self.table.arms_names, self.table.head_names)
        return {
            channel: [(*known, "")[k] for k in column]
            for channel, column, known in zip(
                ("posture", "arms", "head"), values, names, strict=True
            )
        }

    def _order(
        self,
        priority: Priority,
        agents: Chosen | None,
        team: int | None,
        motion: str | None,
        channel: str,
        seconds: float | None,
        forbid: str | Sequence[str],
    ) -> Order:
        order = make_order(
            self.table,
            self.library,
            self.select(agents, team=team),
            motion=motion,
            channel=channel,
            seconds=seconds,
            forbid=(forbid,) if isinstance(forbid, str) else tuple(forbid),
            priority=priority,
            rng=self.guidance.rng,
        )
        self.guidance.give(order)
        return order

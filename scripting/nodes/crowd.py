"""The crowd of a stadium as a node: queries, events, signals."""

from __future__ import annotations

from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from ...engine.behaviour.events import BallHit, Event, Goal
from ...engine.overrides import LookAt, look_at
from ...engine.streams.pool import POSE_RATE
from ...systems.crowd import Crowd as CrowdColumns
from ...systems.crowd_queries import Question
from ...systems.simulation import Simulation
from ..exports import export
from ..node import Node
from ..node3d import Node3D
from ..reports import report
from ..signals import Signal
from ..vectors import Vector3
from .agent import Agent
from .stadium import Stadium, above

Ids = NDArray[np.int64]


class Crowd(Node):
    """The crowd of the stadium above.

    Attributes
    ----------
    watches
        What heads follow, if the character has a neck and a head.
    event, goal, ball_hit
        Emitted in the tick in which the crowd hears of an event, whoever sent it: the event, the
        side that scored, the place where the ball landed.
    clip_event
        Emitted when agents play past a tag on a clip: its name, (K,) ids and (K,) weights.
    """

    event = Signal[Event]()
    goal = Signal[int]()
    ball_hit = Signal[Vector3]()
    clip_event = Signal[str, Ids, NDArray[np.float32]]()

    watches: Node3D | None = export(default=None)

    def _prepare(self) -> None:
        super()._prepare()
        self._listening_to: Stadium | None = None
        self._look: tuple[CrowdColumns, LookAt] | None = None
        self._borrowed: dict[int, Agent] = {}

    @property
    def stadium(self) -> Stadium:
        """The stadium above; ValueError if there is none."""
        return above(self, Stadium)

    @property
    def data(self) -> CrowdColumns:
        """The entity and its columns, to read and to write."""
        return self.stadium.simulation.crowd

    @property
    def count(self) -> int:
        """Number of agents, absent ones included."""
        return len(self.data)

    def where(self, **question: Unpack[Question]) -> Ids:
        """Agents of whom everything holds that is asked for; see `tifo.Crowd.where`."""
        return self.data.where(**question)

    def send(self, event: Event) -> None:
        """Let the crowd see an event at the next tick."""
        self.stadium.send(event)

    def agent(self, agent: int | str) -> Agent:
        """One spectator as a node below this one: the same node at every call.

        Parameters
        ----------
        agent
            An id, or the label of a seat: ``"12|345"``.

        Raises
        ------
        ValueError
            If there is no such agent or seat.
        """
        number = self.data.plan.find(agent) if isinstance(agent, str) else agent
        if not 0 <= number < self.count:
            raise ValueError(f"agent is {agent!r}, expected 0 to {self.count - 1}")
        known = self._borrowed.get(number)
        if known is None or known._freed or known.parent is not self:
            known = self._borrowed[number] = Agent(name=f"Agent{number}", agent=number)
            self.add_child(known)
        return known

    def _entered(self) -> None:
        for one in self._above():
            one._listeners[self] = None
            self._listening_to = one

    def _has_left(self, *, freed: bool) -> None:
        if self._listening_to is not None:
            self._listening_to._listeners.pop(self, None)
            self._listening_to = None

    def _above(self) -> list[Stadium]:
        try:
            return [self.stadium]
        except ValueError:
            return []

    def _pose_tick(self, simulation: Simulation) -> None:
        crowd = simulation.crowd
        self._watch(crowd)
        for event in crowd.events.heard:
            self._emit("event", event)
            if isinstance(event, Goal):
                self._emit("goal", event.side)
            elif isinstance(event, BallHit):
                self._emit("ball_hit", Vector3.of(event.place))
        signal = self.__dict__.get("clip_event")
        if signal is None or not signal.connections or crowd.clip_feed is None:
            return
        for name in crowd.clip_feed.names:
            agents, weights = crowd.clip_feed.passed(name)
            if len(agents):
                signal.emit(name, agents, weights)

    def _emit(self, name: str, *args: Any) -> None:
        if name in self.__dict__:
            self.__dict__[name].emit(*args)

    def _watch(self, crowd: CrowdColumns) -> None:
        target = self.watches
        if target is None or target._freed:
            if self._look is not None:
                if self._look[0] is crowd:
                    crowd.remove_override(self._look[1].name)
                self._look = None
            return
        if self._look is None or self._look[0] is not crowd:
            look = look_at(name="watches")
            try:
                crowd.add_override(look)
            except ValueError as error:
                self.watches = None
                report(error, Crowd._watch, "turning heads", self)
                return
            rng = np.random.default_rng([crowd.spec.seed, 0x6EAD])
            crowd.override_values(
                look.name, np.arange(len(crowd)), look.draw_attention(len(crowd), rng)
            )
            self._look = (crowd, look)
        place = self.stadium.to_local(target.global_position)
        self._look[1].aim(place, 1.0 / POSE_RATE)

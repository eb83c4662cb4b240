"""Stations of the lab about time: in step, drifted apart, entering a motion, being interrupted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

import tifo

from .lab_station import JUMP_TIME, Station

DRIFT_PERIOD, DRIFT_SECONDS = 16.0, 3.0
ENTRY_PERIOD, STANDING_SECONDS = 6.0, 3.0
TOLD = (5.75, 5.25, 4.75)
"""When each agent is told to get up, seconds in a period."""
BLEND_SECONDS, BLEND_PERIOD = 1.4, 2.0
ASKED = (1.80, 1.55, 1.30, 1.05, 0.80)
"""When each agent's first request of a period comes; the second one follows in the middle of it."""


class InStepStation(Station):
    """Agents at the head of one stream."""

    title = "One stream"
    stream: tifo.Stream

    def __init__(self, simulation: tifo.Simulation, agents: NDArray[np.int64]) -> None:
        super().__init__(simulation, agents)
        self.stream = self.pool.add("jump", time=JUMP_TIME)
        for agent in agents:
            self.play(agent, self.stream)

    @property
    def text(self) -> str:
        """Why they are in step."""
        return "all at its head: in step"

    def labels(self) -> Sequence[str]:
        """Offsets."""
        return [f"{offset:.0f}" for offset in self.offsets()]

    def offsets(self) -> NDArray[np.float32]:
        """(K,) how many poses behind the stream's head the agents play now."""
        anim = self.crowd.anim
        assert anim is not None
        start, target = anim.start[0, self.agents], anim.target[0, self.agents]
        ticks = self.simulation.clock.pose_tick - anim.t0[0, self.agents]
        moved = start + anim.rate[0, self.agents] * ticks.astype(np.float32)
        offsets: NDArray[np.float32] = np.clip(
            moved, np.minimum(start, target), np.maximum(start, target)
        )
        return offsets


class DilatedStation(InStepStation):
    """The same, after time dilation; they come together again and drift apart again."""

    title = "Time dilation"

    def __init__(
        self, simulation: tifo.Simulation, agents: NDArray[np.int64], spread: Sequence[float]
    ) -> None:
        super().__init__(simulation, agents)
        self.spread = np.array(spread, np.float32)

    def advance(self, time: float) -> None:
        """Begin to drift apart, or back together."""
        if self.passed(time, 0.0, DRIFT_PERIOD):
            self.crowd.dilate(self.agents, self.spread, DRIFT_SECONDS)
        if self.passed(time, 0.7 * DRIFT_PERIOD, DRIFT_PERIOD):
            self.crowd.dilate(self.agents, np.zeros_like(self.spread), DRIFT_SECONDS)
        super().advance(time)

    @property
    def text(self) -> str:
        """What the numbers are."""
        return "drifted apart, by so many poses"


class EntryStation(Station):
    """Agents who sit are told to get up one after the other, and sit down again."""

    title = "Entering at a phase"

    def __init__(self, simulation: tifo.Simulation, agents: NDArray[np.int64]) -> None:
        super().__init__(simulation, agents)
        self._orders = [self.crowd.guide([int(agent)], motion="sit_idle") for agent in agents]
        self._told: list[float | None] = [None] * len(agents)

    def advance(self, time: float) -> None:
        """Tell those whose time it is to get up or to sit down."""
        for number, at in enumerate(TOLD):
            if self.passed(time, at, ENTRY_PERIOD):
                self._tell(number, "stand_idle")
                self._told[number] = time
            if self.passed(time, at + STANDING_SECONDS, ENTRY_PERIOD):
                self._tell(number, "sit_idle")
                self._told[number] = None
        super().advance(time)

    def _tell(self, number: int, motion: str) -> None:
        self.crowd.release(self._orders[number])
        self._orders[number] = self.crowd.guide([int(self.agents[number])], motion=motion)

    @property
    def text(self) -> str:
        """What happens."""
        return "stand_up began when asked for"

    def labels(self) -> Sequence[str]:
        """How long ago each was told."""
        return ["sits" if told is None else f"{self._time - told:.1f} s ago" for told in self._told]


class InterruptedStation(Station):
    """Agents who are asked for another motion in the middle of a blend."""

    title = "Slots"

    def __init__(self, simulation: tifo.Simulation, agents: NDArray[np.int64]) -> None:
        super().__init__(simulation, agents)
        self.streams = [self.pool.add(clip) for clip in ("stand_idle", "cheer")]
        for agent in agents:
            self.play(agent, self.streams[0])

    def advance(self, time: float) -> None:
        """Ask for motions; each request but the first interrupts a blend."""
        for number, (agent, at) in enumerate(zip(self.agents, ASKED, strict=True)):
            for turn, delay in enumerate((0.0, 0.5 * BLEND_SECONDS)):
                if self.passed(time, at - delay, BLEND_PERIOD):
                    stream = self.streams[1 - turn]
                    self.crowd.transition_to_streamed(
                        int(agent), stream, duration=BLEND_SECONDS, offset=6.0 * number
                    )
        super().advance(time)

    def shares(self) -> NDArray[np.float64]:
        """(K,) how far the running blends are, 0 to 1; 1 where none runs."""
        blend, clock = self.crowd.transition, self.simulation.clock
        assert blend is not None
        duration = blend.duration[0, self.agents].astype(np.float64)
        passed = clock.pose_tick - 1 + clock.alpha - blend.begin[0, self.agents]
        running = duration > 0
        return np.where(running, np.clip(passed / np.where(running, duration, 1.0), 0, 1), 1.0)

    @property
    def text(self) -> str:
        """How many snapshots it took."""
        taken = self.crowd.blend_counts.total.snapshot
        return f"interrupted mid-blend; {taken} snapshots"

    def labels(self) -> Sequence[str]:
        """How far the blends are."""
        return [f"{100 * share:.0f} %" for share in self.shares()]

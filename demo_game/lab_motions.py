"""Stations of the lab that show controllers: a blend space, masks and a state machine."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

import tifo
from tifo import controllers as tree

from .lab_station import JUMP_TIME, Station

CHANGE_SECONDS = 2.2
"""Between two changes of state."""


class BlendSpaceStation(Station):
    """Agents at even steps from one motion to another."""

    title = "Blend space"

    def __init__(self, simulation: tifo.Simulation, agents: NDArray[np.int64]) -> None:
        super().__init__(simulation, agents)
        motions = ((0.0, tree.ClipNode("stand_idle")), (1.0, tree.ClipNode("cheer")))
        self.streams = []
        for agent, position in zip(agents, np.linspace(0.0, 1.0, len(agents)), strict=True):
            stream = self.pool.add(tree.BlendSpace1D(motions, position=float(position)))
            self.play(agent, stream)
            self.streams.append(stream)

    @property
    def text(self) -> str:
        """From where to where."""
        return "stand_idle at 0, cheer at 1, and between"

    def labels(self) -> Sequence[str]:
        """Positions, as the streams have them."""
        return [f"{self.pool.get(stream, 'position'):.2f}" for stream in self.streams]


class MaskStation(Station):
    """One motion of the legs under several of the upper body."""

    title = "Masks"
    OVER = ("", "wave", "clap", "dismay", "stand_idle")

    def __init__(self, simulation: tifo.Simulation, agents: NDArray[np.int64]) -> None:
        super().__init__(simulation, agents)
        upper_body = tree.Mask({"spine": 1.0})
        self.streams = []
        for agent, over in zip(agents, self.OVER, strict=True):
            node: tree.Controller = tree.ClipNode("jump")
            if over:
                node = tree.Masked(node, tree.Overlay(tree.ClipNode(over), upper_body))
            stream = self.pool.add(node, time=JUMP_TIME)
            self.play(agent, stream)
            self.streams.append(stream)

    @property
    def text(self) -> str:
        """Whose legs and whose upper bodies."""
        return "the same legs under five upper bodies"

    def labels(self) -> Sequence[str]:
        """What is over the legs."""
        return [f"+ {over.removeprefix('stand_')}" if over else "jump" for over in self.OVER]


class MachineStation(Station):
    """The same state machine on several streams, each in another state."""

    title = "State machine"
    STATES = (
        ("sit", "sit_idle"),
        ("rise", "stand_up"),
        ("stand", "stand_idle"),
        ("cheer", "cheer"),
        ("clap", "clap"),
        ("sit down", "sit_down"),
    )

    def __init__(self, simulation: tifo.Simulation, agents: NDArray[np.int64]) -> None:
        super().__init__(simulation, agents)
        names = [name for name, _ in self.STATES]
        ways = [
            tree.Transition(one, other, trigger="next", duration=0.3)
            for one, other in zip(names, (*names[1:], names[0]), strict=True)
        ]
        self.streams = []
        for agent, start in zip(agents, names, strict=True):
            states = {name: tree.ClipNode(clip) for name, clip in self.STATES}
            stream = self.pool.add(tree.StateMachine(states, ways, start=start))
            self.play(agent, stream)
            self.streams.append(stream)

    def advance(self, time: float) -> None:
        """Let all go on to the next state now and then."""
        if self.passed(time, 0.5, CHANGE_SECONDS):
            self.pool.set_many([stream.row for stream in self.streams], "next", 1.0)
        super().advance(time)

    @property
    def text(self) -> str:
        """What makes them change."""
        return "one machine on six streams; a trigger moves each on"

    def labels(self) -> Sequence[str]:
        """The states that the machines are in."""
        return [str(self.pool.get(stream, "current")) for stream in self.streams]

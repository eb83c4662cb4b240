"""The stadium of the demo, in which people watch a ball and sides score."""

from __future__ import annotations

from collections.abc import Sequence

import tifo

from .attention import Attention
from .captions import Caption


class Match:
    """A stadium and what its crowd watches.

    Parameters
    ----------
    spec
        Stadium and crowd.
    scale
        Metres a unit of BVH files; guessed if None.

    Raises
    ------
    AssetError
        If a file can't be used.
    """

    keys = "G / H  goal for home / away        click or B  ball into the crowd\n"

    def __init__(self, spec: tifo.CrowdSpec, scale: float | None = None) -> None:
        self.simulation = tifo.Simulation(spec, tifo.character_of(spec, scale))
        self.attention = Attention(self.simulation)

    def camera(self, name: str, size: tuple[int, int]) -> tifo.FreeCamera:
        """One of the stadium's presets; they suit pictures of any usual shape."""
        return tifo.FreeCamera.looking(*tifo.camera_presets(self.simulation.plan)[name])

    def advance(self, seconds: float) -> None:
        """The ball rolls on."""
        self.attention.advance(seconds)

    def captions(self) -> Sequence[Caption]:
        """None."""
        return ()

    def goal(self, side: int) -> str:
        """The ball goes into the net, and the crowd sees it."""
        self.simulation.send(tifo.Goal(side=side))
        self.attention.goal(side)
        return f"GOAL for the {('home', 'away')[side]} side!"

    def shoot(self, seat: int) -> str:
        """The ball flies among those who sit there."""
        x, y, z = (float(value) for value in self.simulation.plan.position[:, seat])
        self.simulation.send(tifo.BallHit(place=(x, y + 1.0, z)))
        self.attention.stare((x, y + 1.0, z))
        return f"the ball hits seat {self.simulation.plan.label(seat)}"

"""The stadium of the demo, in which people watch a ball and sides score."""

from __future__ import annotations

from collections.abc import Sequence

import tifo

from .attention import Attention
from .captions import Caption
from .keys import MATCH_KEYS, MESSAGES, SIDELESS


class Match:
    """A stadium and what its crowd watches.

    Parameters
    ----------
    spec
        Stadium and crowd.
    scale
        Metres a unit of BVH files; guessed if None.
    events
        File with what happens, or None.

    Raises
    ------
    AssetError
        If a file can't be used.
    """

    keys = MATCH_KEYS

    def __init__(
        self, spec: tifo.CrowdSpec, scale: float | None = None, events: str | None = None
    ) -> None:
        self.simulation = tifo.Simulation(spec, tifo.character_of(spec, scale))
        self.attention = Attention(self.simulation)
        self._coming: list[tifo.Event] = []
        if events is not None:
            self._coming = tifo.load_events(events, self.simulation.plan)
        for event in self._coming:
            self.simulation.send(event)

    def camera(self, name: str, size: tuple[int, int]) -> tifo.FreeCamera:
        """One of the stadium's presets; they suit pictures of any usual shape."""
        return tifo.FreeCamera.looking(*tifo.camera_presets(self.simulation.plan)[name])

    def advance(self, seconds: float) -> None:
        """The ball rolls on, to where something happens."""
        now = self.simulation.clock.tick / 60
        while self._coming and (self._coming[0].time or 0.0) <= now:
            self.attention.follow(self._coming.pop(0))
        self.attention.advance(seconds)

    def captions(self) -> Sequence[Caption]:
        """None."""
        return ()

    def happen(self, kind: str, side: int, seat: int | None = None) -> str:
        """The crowd sees it, and the ball goes there if it is one of the ball's events."""
        place, label = None, ""
        if seat is not None:
            x, y, z = (float(value) for value in self.simulation.plan.position[:, seat])
            place, label = (x, y + 1.0, z), self.simulation.plan.label(seat)
        owner = None if kind in SIDELESS or place is not None else side
        if kind == "goal":
            place = self.attention.celebration(side)
        event = tifo.Event(kind, owner, place=place)
        self.simulation.send(event)
        self.attention.follow(event)
        return MESSAGES[kind].format(side=("home", "away")[side], seat=label)

"""The demo: what is shown, and whether in a window or offscreen."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

import tifo

from .captions import Caption
from .recording import check_writable

SceneName = Literal["stadium", "lab"]
HAND_OVER = "no display here, so the demo is rendered offscreen"


@dataclass(frozen=True, slots=True)
class Show:
    """What the demo shows and where it goes.

    Parameters
    ----------
    spec
        Stadium and crowd; of the lab only the seed.
    scale
        Metres a unit of BVH files; guessed if None.
    size
        Pixels (width, height).
    camera
        ``"tv"``, ``"close"`` or ``"bowl"``.
    seconds
        When to stop; None for a window that stays, and 6 s offscreen.
    screenshot, record
        Files for the last picture and for a clip, or None.
    events
        File with what happens, or None.
    fullscreen, vsync
        Of the window.
    scene
        What is shown: a match in the stadium, or the lab.
    """

    spec: tifo.CrowdSpec
    scale: float | None
    size: tuple[int, int]
    camera: str
    seconds: float | None
    screenshot: str | None
    record: str | None
    events: str | None = None
    fullscreen: bool = False
    vsync: bool = True
    scene: SceneName = "stadium"


class Scene(Protocol):
    """What the demo can show."""

    keys: str
    """Lines that say which keys are the scene's own."""

    @property
    def simulation(self) -> tifo.Simulation:
        """Its stand and crowd."""

    def camera(self, name: str, size: tuple[int, int]) -> tifo.FreeCamera:
        """The camera ``tv``, ``close`` or ``bowl``, for a picture of `size` pixels."""

    def advance(self, seconds: float) -> None:
        """Let happen what is no part of the simulation itself."""

    def captions(self) -> Sequence[Caption]:
        """Words in the picture."""

    def happen(self, kind: str, side: int, seat: int | None = None) -> str:
        """Let an event of a side happen, some kinds of it at a seat; what is said of it."""


def play(show: Show, *, headless: bool) -> int:
    """Run the demo; the exit code."""
    from rich.console import Console

    for path in (show.screenshot, show.record):
        if path is not None:
            check_writable(path)
    console = Console(stderr=True, highlight=False)
    if not headless and not has_display():
        console.print(f"[yellow]tifo:[/] {HAND_OVER}.")
        headless = True
    if headless:
        from .offscreen import render

        return render(show, console)
    from .interactive import run_window

    return run_window(show, console)


def make_scene(show: Show) -> Scene:
    """What a show shows.

    Raises
    ------
    AssetError
        If a file can't be used.
    ValueError
        If the lab is asked for with a character, motions or events of the user's.
    """
    if show.scene == "lab":
        from .lab import Lab

        if show.spec.character or show.spec.motions:
            raise ValueError("the lab shows the built-in spectator and its motions only")
        if show.events is not None:
            raise ValueError("nothing of an events file happens in the lab")
        return Lab(show.spec.seed)
    from .match import Match

    return Match(show.spec, show.scale, show.events)


def plan_events(show: Show, simulation: tifo.Simulation) -> list[tifo.Event]:
    """Send what the show's file says to the crowd, each event for its time, and return it.

    Raises
    ------
    AssetError
        If the file can't be used.
    """
    if show.events is None:
        return []
    events = tifo.load_events(show.events, simulation.plan)
    for event in events:
        simulation.send(event)
    return events


def has_display() -> bool:
    """Whether a window could be opened."""
    if sys.platform.startswith("linux"):
        return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
    return True

"""The demo: what is shown, and whether in a window or offscreen."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass

import tifo

from .recording import check_writable

HAND_OVER = "no display here, so the demo is rendered offscreen"


@dataclass(frozen=True, slots=True)
class Show:
    """What the demo shows and where it goes.

    Parameters
    ----------
    spec
        Stadium and crowd.
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


def make_simulation(show: Show) -> tuple[tifo.Simulation, tifo.FreeCamera]:
    """The stadium of a show, and a camera where the show begins.

    Raises
    ------
    AssetError
        If a file can't be used.
    """
    character = tifo.character_of(show.spec, show.scale)
    simulation = tifo.Simulation(show.spec, character)
    presets = tifo.camera_presets(simulation.plan)
    return simulation, tifo.FreeCamera.looking(*presets[show.camera])


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

"""The demo without a display: a picture and a clip of a few seconds around a goal."""

from __future__ import annotations

from contextlib import ExitStack
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeRemainingColumn,
)

import tifo

from .app import Scene, Show, make_scene
from .captions import draw_captions, place_captions
from .recording import Clip, write_png

PICTURES_A_SECOND = 30
SOFTWARE_PICTURES_A_SECOND = 12
DEFAULT_SECONDS = 6.0
GOAL_AT = 0.25
"""When the goal falls, as a share of the clip."""


def render(show: Show, console: Console) -> int:
    """Render a show to files; the exit code.

    Without ``--screenshot`` and ``--record`` it writes ``tifo.png``, and ``tifo.mp4`` where clips
    can be written.
    """
    with console.status("building the stadium"):
        scene = make_scene(show)
        stage = tifo.Stage.offscreen(scene.simulation, show.size)
    for note in scene.simulation.crowd.character.notes:
        console.print(f"[dim]note:[/] {note}")
    picture, clip = _targets(show, console)
    rate = SOFTWARE_PICTURES_A_SECOND if stage.is_software else PICTURES_A_SECOND
    pixels = _film(show, scene, stage, rate, clip, console)
    if picture is not None:
        write_png(picture, pixels)
    stage.close()
    for path in (picture, clip):
        if path is not None:
            console.print(f"wrote [bold]{path.resolve()}[/] ({path.stat().st_size / 1e6:.1f} MB)")
    return 0


def _targets(show: Show, console: Console) -> tuple[Path | None, Path | None]:
    if show.screenshot or show.record:
        return (
            Path(show.screenshot) if show.screenshot else None,
            Path(show.record) if show.record else None,
        )
    if find_spec("av") is None:
        console.print("[yellow]tifo:[/] no clip, as PyAV is missing: pip install 'tifo\\[demo]'")
        return Path("tifo.png"), None
    return Path("tifo.png"), Path("tifo.mp4")


def _film(
    show: Show,
    scene: Scene,
    stage: tifo.Stage,
    rate: int,
    clip: Path | None,
    console: Console,
) -> NDArray[np.uint8]:
    """Let the show run and draw it: every picture for a clip, else only the last; the last one."""
    seconds = DEFAULT_SECONDS if show.seconds is None else show.seconds
    camera = scene.camera(show.camera, show.size)
    pictures = max(round(seconds * rate), 1)
    goal = int(GOAL_AT * pictures) if show.events is None else None
    ticks = np.diff(np.round(np.linspace(0, seconds * 60, pictures + 1)).astype(int))
    columns = (
        TextColumn("[progress.description]{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
    )
    simulation = scene.simulation
    with ExitStack() as stack:
        progress = stack.enter_context(Progress(*columns, console=console))
        recorder = stack.enter_context(Clip(clip, stage.size, rate)) if clip else None
        task = progress.add_task(f"{len(simulation.crowd):,} spectators", total=pictures)
        for number, due in enumerate(ticks):
            if number == goal:
                scene.happen("goal", 0)
            simulation.run(seconds=due / 60)
            scene.advance(due / 60)
            if recorder is not None:
                recorder.add(_picture(scene, stage, camera))
            progress.advance(task)
        return _picture(scene, stage, camera)


def _picture(scene: Scene, stage: tifo.Stage, camera: tifo.FreeCamera) -> NDArray[np.uint8]:
    """What the camera sees now, with the words in it."""
    stage.draw(camera)
    pixels, words = stage.pixels(), scene.captions()
    return draw_captions(pixels, place_captions(words, camera, stage.size)) if words else pixels

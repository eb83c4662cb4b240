"""The demo in a real window on a virtual display, driven by the events that a person makes."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.gl

DRIVER = """
import sys
import numpy as np
from rich.console import Console
import tifo
from tifo.demo_game.app import Show
from tifo.demo_game.interactive import Game


def main():
    show = Show(tifo.CrowdSpec(seats=400, sides=2, away_share=0.3), None, (320, 200), "close", None,
                sys.argv[1], None, vsync=False)
    game = Game(show, Console(stderr=True))
    from pyglet.window import key, mouse

    def frames(count):
        for _ in range(count):
            game.window.switch_to()
            game.window.dispatch_events()
            game.window.dispatch_pending_events()
            game.on_draw()
            game.window.flip()

    def ticks(count):
        end = game.simulation.clock.tick + count
        while game.simulation.clock.tick < end:
            frames(1)

    crowd = game.simulation.crowd

    def reacting(side):
        will = crowd.behaviour.stirred_until[crowd.team.side == side]
        return float((will > crowd.behaviour.tick).mean())

    ticks(3)
    assert reacting(0) == reacting(1) == 0
    game.window.dispatch_event("on_key_press", key.G, 0)
    ticks(3)
    assert reacting(0) > 0.85 and 0.3 < reacting(1) < 0.8, (reacting(0), reacting(1))

    before = crowd.behaviour.event.copy()
    game.window.dispatch_event("on_mouse_press", 160, 100, mouse.LEFT, 0)
    game.window.dispatch_event("on_mouse_release", 160, 100, mouse.LEFT, 0)
    ticks(3)
    changed = np.flatnonzero(crowd.behaviour.event != before)
    places = crowd.placement.position[:, changed]
    assert 1 <= len(changed) < 200 and np.ptp(places[0]) < 15, len(changed)

    eye = game.camera.eye.copy()
    game.window.dispatch_event("on_mouse_drag", 160, 100, 30, 10, mouse.LEFT, 0)
    game.window.dispatch_event("on_mouse_scroll", 160, 100, 0, 2)
    frames(1)
    assert np.linalg.norm(game.camera.eye - eye) > 0.3
    for symbol in (key._1, key._3, key.C, key.V, key.F1, key._2):
        game.window.dispatch_event("on_key_press", symbol, 0)
        frames(1)
    assert game.camera.mode is tifo.CameraMode.ORBIT

    tick = game.simulation.clock.tick
    game.window.dispatch_event("on_key_press", key.P, 0)
    frames(2)
    assert game.simulation.clock.tick == tick
    game.window.dispatch_event("on_key_press", key.P, 0)

    game.window.set_size(400, 240)
    frames(3)
    assert game.stage.size == tuple(game.window.get_framebuffer_size()) == (400, 240)
    picture = game.stage.pixels()
    from pyglet.gl import glReadPixels, GL_RGB, GL_UNSIGNED_BYTE, glGetError
    assert picture.shape == (240, 400, 3) and picture.std() > 20
    from tifo.engine.gl import live_objects, collect, gl_errors
    assert not gl_errors()
    game.window.dispatch_event("on_close")
    game.window.dispatch_pending_events()
    collect()
    print({kind: count for kind, count in live_objects().items() if count})

main()
"""


def run(display: str, *words: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "DISPLAY": display, "PYGLET_HEADLESS": ""}
    return subprocess.run(
        [sys.executable, *words], capture_output=True, text=True, env=environment, timeout=120
    )


def test_keys_mouse_resize_and_closing(display: str, tmp_path: Path) -> None:
    picture = tmp_path / "last.png"
    done = run(display, "-c", DRIVER, str(picture))
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == "{}", "objects are left on the GPU"
    assert picture.stat().st_size > 10_000


def test_the_command_opens_a_window_and_ends_by_itself(display: str, tmp_path: Path) -> None:
    picture = tmp_path / "a.png"
    words = ("demo", "--seats", "300", "--size", "320x200", "--seconds", "1.5")
    done = run(display, "-m", "tifo", *words, "--screenshot", str(picture))
    assert done.returncode == 0, done.stderr
    assert picture.stat().st_size > 10_000


def test_no_such_display_is_one_sentence(tmp_path: Path) -> None:
    done = run(":4711", "-m", "tifo", "demo", "--seats", "50", "--seconds", "1")
    assert done.returncode == 1
    assert "Traceback" not in done.stderr
    assert done.stderr.strip().splitlines()[-1].startswith("tifo: ")


def test_the_lab_in_a_window(display: str, tmp_path: Path) -> None:
    picture = tmp_path / "lab.png"
    words = ("demo", "--scene", "lab", "--size", "480x270", "--seconds", "1.5")
    done = run(display, "-m", "tifo", *words, "--screenshot", str(picture))
    assert done.returncode == 0, done.stderr
    assert picture.stat().st_size > 10_000

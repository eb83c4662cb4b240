"""The demo in a window."""

from __future__ import annotations

from datetime import datetime
from time import perf_counter
from typing import Any

from rich.console import Console

import tifo

from .app import Show, make_scene
from .captions import draw_captions, place_captions
from .keys import EVENT_KEYS, VIEW_KEYS
from .overlay import Overlay
from .recording import Clip, write_png
from .signs import Signs

RECORDED_RATE = 30
FLY_SPEED = 12.0
"""Metres a second; five times that with Shift held."""


class Game:
    """The running demo: a window, a camera, and what the keys do.

    Parameters
    ----------
    show
        What to show.
    console
        Where notes go.
    """

    def __init__(self, show: Show, console: Console) -> None:
        self.console = console
        self.show = show
        with console.status("building the stadium"):
            self.scene = make_scene(show)
        self.simulation = self.scene.simulation
        self.camera = self.scene.camera(show.camera, show.size)
        self.window: Any = tifo.open_window(
            show.size, "tifo", vsync=show.vsync, fullscreen=show.fullscreen
        )
        import pyglet

        self._pyglet: Any = pyglet
        self._key: Any = pyglet.window.key
        self._mouse: Any = pyglet.window.mouse
        self.keys: Any = pyglet.window.key.KeyStateHandler()
        self.stage = tifo.Stage(self.simulation, self.window.get_framebuffer_size())
        greet = not self.scene.captions()
        self.overlay = Overlay(self.window, self.scene.keys + VIEW_KEYS, greet=greet)
        self.signs = Signs(self.window)
        self.overlay.listen(self.simulation.crowd)
        self.paused = False
        self._pointer = (show.size[0] // 2, show.size[1] // 2)
        self._dragged = False
        self._before = perf_counter()
        self._clip = Clip(show.record, self.stage.size, RECORDED_RATE) if show.record else None
        # One by one: handlers of one push replace each other where both have a method.
        self.window.push_handlers(self.keys)
        self.window.push_handlers(self)
        if show.seconds is not None:
            pyglet.clock.schedule_once(
                lambda _: self.window.dispatch_event("on_close"), show.seconds
            )

    def run(self) -> None:
        """Play until the window closes."""
        self._before = perf_counter()
        self._pyglet.app.run(1 / 60 if self.show.vsync else 0)

    def on_draw(self) -> None:
        """One frame."""
        now = perf_counter()
        real = now - self._before
        self._before = now
        # A clip shows even steps of time however long a picture took.
        delta = real if self._clip is None else 1 / RECORDED_RATE
        self._steer(real)
        passed = 0.0 if self.paused else delta
        self.scene.advance(passed)
        self.stage.draw(self.camera, passed)
        if self._clip is not None:
            self._clip.add(self._pixels())
        self.stage.present(self.window.get_framebuffer_size())
        size = self.window.get_size()
        self.signs.draw(place_captions(self.scene.captions(), self.camera, size))
        self.overlay.draw(real, self.simulation, self.stage.counts, paused=self.paused)

    def on_resize(self, width: int, height: int) -> None:
        """Draw pictures of the window's new size; a clip keeps the size that it began with."""
        if self._clip is None and width > 0 and height > 0:
            self.stage.resize(self.window.get_framebuffer_size())

    def on_key_press(self, symbol: int, modifiers: int) -> None:
        """What single keys do."""
        key = self._key
        presets = {key._1: "tv", key._2: "close", key._3: "bowl"}
        if (kind := EVENT_KEYS.get(chr(symbol).upper()) if symbol < 128 else None) is not None:
            self._happen(kind, int(bool(modifiers & key.MOD_SHIFT)))
        elif symbol == key.H:
            self._happen("goal", 1)
        elif symbol in presets:
            self.camera = self.scene.camera(presets[symbol], self.stage.size)
        elif symbol == key.C:
            fly = self.camera.mode is tifo.CameraMode.ORBIT
            self.camera.mode = tifo.CameraMode.FLY if fly else tifo.CameraMode.ORBIT
            self.overlay.say(f"camera: {self.camera.mode.value}")
        elif symbol == key.P:
            self.paused = not self.paused
        elif symbol == key.F:
            self.window.set_fullscreen(not self.window.fullscreen)
        elif symbol == key.V:
            self.window.set_vsync(not self.window.vsync)
            self.overlay.say(f"vsync {'on' if self.window.vsync else 'off'}")
        elif symbol == key.F1:
            self.overlay.help_shown = not self.overlay.help_shown
        elif symbol == key.F12:
            name = f"tifo-{datetime.now():%Y%m%d-%H%M%S}.png"
            write_png(name, self._pixels())
            self.overlay.say(f"wrote {name}")

    def on_mouse_motion(self, x: int, y: int, dx: int, dy: int) -> None:
        """Remember where the mouse points."""
        self._pointer = (x, y)

    def on_mouse_drag(self, x: int, y: int, dx: int, dy: int, buttons: int, mods: int) -> None:
        """Look about, or shift with the right or middle button."""
        self._pointer = (x, y)
        self._dragged = self._dragged or abs(dx) + abs(dy) > 1
        if buttons & self._mouse.LEFT:
            self.camera.drag(dx, dy)
        else:
            self.camera.pan(dx, dy)

    def on_mouse_press(self, x: int, y: int, button: int, modifiers: int) -> None:
        """A click begins."""
        self._dragged = False

    def on_mouse_release(self, x: int, y: int, button: int, modifiers: int) -> None:
        """A click without a drag shoots the ball there."""
        if button == self._mouse.LEFT and not self._dragged:
            self._shoot(x, y)

    def on_mouse_scroll(self, x: int, y: int, scroll_x: float, scroll_y: float) -> None:
        """Move nearer or farther."""
        self.camera.zoom(scroll_y)
        self.camera.keep_above(0.4)

    def on_close(self) -> None:
        """Write what was asked for and free everything on the GPU; the window closes after."""
        if self._clip is not None:
            self._clip.close()
            self.console.print(f"wrote [bold]{self.show.record}[/]")
        self.window.switch_to()
        if self.show.screenshot:
            write_png(self.show.screenshot, self._pixels())
            self.console.print(f"wrote [bold]{self.show.screenshot}[/]")
        self.stage.close()

    def _steer(self, delta: float) -> None:
        key = self._key
        speed = FLY_SPEED * (5.0 if self.keys[key.LSHIFT] else 1.0) * min(delta, 0.1)

        def axis(positive: int, negative: int) -> float:
            return speed * (float(self.keys[positive]) - float(self.keys[negative]))

        moves = (axis(key.D, key.A), axis(key.E, key.Q), axis(key.W, key.S))
        if any(moves):
            self.camera.fly(*moves)
            self.camera.keep_above(0.4)

    def _pixels(self) -> Any:
        """The last picture with the words in it."""
        placed = place_captions(self.scene.captions(), self.camera, self.stage.size)
        return draw_captions(self.stage.pixels(), placed) if placed else self.stage.pixels()

    def _happen(self, kind: str, side: int) -> None:
        """Let something happen, where the mouse points if it needs a place."""
        seat = None
        if kind in tifo.PLACED:
            origin, direction = self.camera.ray(*self._pointer, self.window.get_size())
            seat = tifo.pick_seat(self.simulation.plan.position, origin, direction)
            if seat is None:
                self.overlay.say("the mouse points at no seat")
                return
        self.overlay.say(self.scene.happen(kind, side, seat))

    def _shoot(self, x: int, y: int) -> None:
        self._pointer = (x, y)
        self._happen("ball_in_crowd", 0)


def run_window(show: Show, console: Console) -> int:
    """Play the demo in a window; the exit code."""
    game = Game(show, console)
    game.run()
    return 0

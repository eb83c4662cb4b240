"""Two crowds in an existing pyglet game, which owns its windows, cameras and esper world.

The home stand is shown in one window, both stands in another. The game has a component and a
processor of its own on the crowds' entities, and draws a label over them with pyglet.

Run with ``python examples/in_pyglet.py``: Space is a goal, Escape closes a window, and the second
window can be opened again with W.
"""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass

import esper
import pyglet
from pyglet.math import Mat4, Vec3

import tifo

FOV = 45.0


@dataclass
class Noise:
    """How loud a crowd is; a component of this game."""

    level: float = 0.0


class NoiseSystem(esper.Processor):
    """Counts whom something moves; a processor of this game, on the crowds' own columns."""

    def process(self, delta: float) -> None:
        for _, (noise, behaviour) in esper.get_components(Noise, tifo.Behaviour):
            busy = float(behaviour.reacting.mean())
            noise.level += (busy - noise.level) * min(4.0 * delta, 1.0)


class Game:
    """An ordinary pyglet game."""

    def __init__(self) -> None:
        esper.switch_world("my game")
        self.stands: list[tuple[tifo.Crowd, Mat4]] = []
        for seed, place in ((1, Mat4()), (2, opposite(30.0))):
            spec = tifo.CrowdSpec(layout="stand", rows=5, columns=14, streams=48, seed=seed)
            crowd = tifo.spawn_crowd(spec, tifo.build_seats(spec), tifo.builtin_spectator())
            esper.add_component(crowd.entity, Noise())
            for system in crowd.systems():  # one Schedule, which runs both crowds
                esper.add_processor(system, priority=1)
            self.stands.append((crowd, place))
        esper.add_processor(NoiseSystem())
        self.windows: list[pyglet.window.Window] = []
        self.open("home", self.stands[:1])
        self.open("both", self.stands)
        pyglet.clock.schedule_interval(self.update, 1 / 60)

    def open(self, caption: str, stands: list[tuple[tifo.Crowd, Mat4]]) -> None:
        """One more window, which shows some of the stands."""
        config = pyglet.gl.Config(major_version=3, minor_version=3, depth_size=24)
        window = pyglet.window.Window(320, 240, caption=caption, config=config, vsync=False)
        label = pyglet.text.Label("", x=8, y=8, color=(255, 255, 255, 255))

        @window.event
        def on_draw() -> None:
            pyglet.gl.glClearColor(0.55, 0.68, 0.82, 1.0)
            window.clear()
            width, height = window.get_framebuffer_size()
            projection = Mat4.perspective_projection(width / height, 0.1, 500.0, FOV)
            view = Mat4.look_at(Vec3(10.0, 12.0, 34.0), Vec3(10.0, 3.0, 0.0), Vec3(0.0, 1.0, 0.0))
            for crowd, place in stands:
                crowd.draw(view, projection, world_from_crowd=place)
            noise = [esper.component_for_entity(crowd.entity, Noise).level for crowd, _ in stands]
            label.text = f"{caption}: {max(noise):.0%} are up"
            label.draw()

        @window.event
        def on_key_press(symbol: int, modifiers: int) -> None:
            if symbol == pyglet.window.key.SPACE:
                self.goal()
            elif symbol == pyglet.window.key.W and len(self.windows) == 1:
                self.open("both", self.stands)

        @window.event
        def on_close() -> None:
            self.windows.remove(window)

        self.windows.append(window)

    def goal(self) -> None:
        """The home side scores."""
        for crowd, _ in self.stands:
            crowd.send(tifo.Goal(side=0))

    def update(self, delta: float) -> None:
        """One frame of the game."""
        esper.process(delta)


def opposite(metres: float) -> Mat4:
    """The place of a stand that faces the first one, so many metres away."""
    turned = Mat4.from_rotation(math.pi, Vec3(0.0, 1.0, 0.0))
    return Mat4.from_translation(Vec3(21.0, 0.0, metres)) @ turned


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument(
        "--seconds",
        type=float,
        help="end after so many seconds, in which the second window is closed and opened again",
    )
    seconds = parser.parse_args().seconds
    game = Game()
    if seconds is not None:
        game.goal()
        later = pyglet.clock.schedule_once
        later(lambda _: game.windows[1].dispatch_event("on_close"), 0.4 * seconds)
        later(lambda _: game.open("both", game.stands), 0.6 * seconds)
        later(lambda _: pyglet.app.exit(), seconds)
    pyglet.app.run()
    for crowd, _ in game.stands:
        noise = esper.component_for_entity(crowd.entity, Noise).level
        print(f"stand {crowd.entity}: {noise:.0%} are up")
        crowd.release_graphics()
    for window in game.windows:
        window.close()


if __name__ == "__main__":
    main()

"""A scene that tifo runs: a stand, a ball that is kicked into it, a camera, a script.

Run with ``python examples/run_scene.py``: Space kicks, drag looks around, Escape quits. With
``--headless`` it runs for two seconds and writes a picture, run_scene.png.
"""

from __future__ import annotations

import argparse

import tifo


class Match(tifo.Node3D):
    """The scene's root: kicks the ball, and tells the crowd where it comes down."""

    async def _ready(self) -> None:
        ball = self.get_node("Stadium/Ball", tifo.Ball)
        crowd = self.get_node("Stadium/Crowd", tifo.nodes.Crowd)
        crowd.ball_hit.connect(self.told)
        while True:
            await self.tree.create_timer(0.5, process_in_physics=True).timeout
            seat = crowd.agent("3|8")
            ball.kick_to(seat.position + tifo.Vector3(0.0, 1.0, 0.0), 1.0)
            await self.tree.create_timer(1.0, process_in_physics=True).timeout
            crowd.send(tifo.BallHit(ball.position))
            ball.velocity = tifo.Vector3()
            ball.position = tifo.Vector3(12.0, 0.11, 16.0)

    def told(self, place: tifo.Vector3) -> None:
        print(f"the ball comes down at x = {place.x:.1f}, {place.y:.1f} m high")

    def _unhandled_input(self, event: tifo.InputEvent) -> None:
        camera = self.get_node("Stadium/Camera", tifo.Camera)
        if isinstance(event, tifo.InputEventMouseMotion) and "LEFT" in event.buttons:
            camera.drag(event.dx, event.dy)


def scene() -> Match:
    """The nodes, as a scene file would have them."""
    match = Match(name="Match")
    stadium = match.add_child(
        tifo.Stadium(name="Stadium", layout="stand", rows=8, columns=16, streams=48, seed=5)
    )
    ball = stadium.add_child(tifo.Ball(name="Ball", position=tifo.Vector3(12.0, 0.11, 16.0)))
    stadium.add_child(tifo.nodes.Crowd(name="Crowd", watches=ball))
    stadium.add_child(tifo.Camera(name="Camera", preset="close"))
    return match


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--headless", action="store_true")
    if parser.parse_args().headless:
        tifo.run(scene(), size=(480, 270), headless=True, seconds=2.0, screenshot="run_scene.png")
    else:
        tifo.run(scene())


if __name__ == "__main__":
    main()

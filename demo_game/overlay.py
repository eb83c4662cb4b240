"""Text over the picture: frames a second, what just happened, and the keys."""

from __future__ import annotations

from typing import Any

import tifo

MESSAGE_SECONDS = 3.0
HINT_SECONDS = 8.0
CLAP = "clap_contact"
CLAP_SECONDS = 0.7
"""Over which claps are averaged."""


class Overlay:
    """Labels drawn over each frame.

    Parameters
    ----------
    window
        The pyglet window.
    hint
        The keys; shown while F1 is on.
    greet
        Whether they are shown for a few seconds at first, too.
    """

    def __init__(self, window: Any, hint: str, *, greet: bool = True) -> None:
        try:
            import pyglet.text.layout
        except ImportError as error:
            raise tifo.GraphicsError(
                f"windows need a system library for text ({error}); on Debian or Ubuntu install "
                "libfontconfig1, or draw off screen with --headless"
            ) from None

        self._window = window
        self.help_shown = False
        self._hint_left = HINT_SECONDS if greet else 0.0
        self._message_left = 0.0
        self._smooth = 1 / 60
        self._claps = 0.0
        self._claps_a_second: float | None = None

        def label(size: int, **options: Any) -> Any:
            return pyglet.text.Label(
                "", font_size=size, color=(255, 255, 255, 235), weight="bold", **options
            )

        self._status = label(11, anchor_y="top")
        self._message = label(20, anchor_x="center", anchor_y="top")
        self._hint = label(11, anchor_y="bottom", multiline=True, width=1200)
        self._hint.text = hint
        self._shade = pyglet.shapes.Rectangle(0, 0, 1, 1, color=(8, 12, 18, 130))

    def listen(self, crowd: tifo.Crowd) -> None:
        """Show how many claps a second the crowd makes, if its clips say when hands meet."""
        if crowd.clip_feed is not None and CLAP in crowd.clip_feed.names:
            self._claps_a_second = 0.0
            crowd.on_clip_event(CLAP, self._hear)

    def _hear(self, agents: Any, weights: Any) -> None:
        self._claps += float(weights.sum())

    def say(self, text: str) -> None:
        """Show a message for a few seconds; nothing for an empty one."""
        self._message.text = text
        self._message_left = MESSAGE_SECONDS if text else 0.0

    def draw(self, delta: float, simulation: tifo.Simulation, counts: Any, *, paused: bool) -> None:
        """Draw the labels; `delta` is the time since the last frame in seconds."""
        width, height = self._window.get_size()
        self._smooth += 0.1 * (delta - self._smooth)
        self._message_left -= delta
        self._hint_left -= delta
        present = int(simulation.crowd.seat.occupied.sum())
        state = "paused  ·  " if paused else ""
        self._status.text = (
            f"{state}{1.0 / max(self._smooth, 1e-6):.0f} fps  ·  {present:,} spectators  ·  "
            f"{counts.triangles:,} triangles  ·  {self._applause(delta)}F1 keys"
        )
        self._box(0, height - 26, self._status.content_width + 24, 26)
        self._status.x, self._status.y = 12, height - 7
        self._status.draw()
        if self._message_left > 0:
            content = self._message.content_width + 40
            self._box((width - content) / 2, height - 76, content, 42)
            self._message.x, self._message.y = width // 2, height - 43
            self._message.draw()
        if self.help_shown or self._hint_left > 0:
            self._box(0, 0, width, self._hint.content_height + 20)
            self._hint.x, self._hint.y = 12, 10
            self._hint.draw()

    def _applause(self, delta: float) -> str:
        if self._claps_a_second is None:
            return ""
        share = min(delta / CLAP_SECONDS, 1.0)
        self._claps_a_second += self._claps / CLAP_SECONDS - share * self._claps_a_second
        self._claps = 0.0
        return f"{self._claps_a_second:,.0f} claps/s  ·  "

    def _box(self, x: float, y: float, width: float, height: float) -> None:
        self._shade.position = (x, y)
        self._shade.width, self._shade.height = width, height
        self._shade.draw()

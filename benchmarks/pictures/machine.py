"""A state machine as a graph: its states with a pose of their clips, its transitions with rules."""

from __future__ import annotations

from PIL import Image

from ...engine.animation.clip_bank import ClipBank
from ...engine.animation.controllers import ClipNode, StateMachine, Transition
from ...engine.assets.spectator import builtin_spectator
from ...engine.streams.pool import StreamPool
from .canvas import BLUE, FAINT, GROUND, INK, ORANGE, PALE, Canvas, Place, curve, mixed
from .figures import draw_figure

FAN = StateMachine(
    {
        "sit": ClipNode("sit_idle"),
        "up": ClipNode("stand_up"),
        "stand": ClipNode("stand_idle"),
        "cheer": ClipNode("cheer"),
    },
    [
        Transition("sit", "up", trigger="rise", duration=0.1),
        Transition("up", "stand", at_end=True, duration=0.2),
        Transition("stand", "cheer", when="joy > 0.5", duration=0.3),
        Transition("cheer", "stand", when="joy <= 0.5", at_end=True, duration=0.4),
        Transition("*", "sit", when="calm > 0.5", duration=0.4, priority=1),
    ],
)
"""The machine of docs/controllers.md."""

SECONDS = 0.75
_SIZE = (960, 470)
_HALF = (54.0, 70.0)


def draw_machine() -> Image.Image:
    """The picture."""
    canvas = Canvas(*_SIZE)
    names = list(FAN.states)
    place = _places(names)
    for way in FAN.transitions:
        colour = ORANGE if way.source == "*" else BLUE
        both = any((w.source, w.target) == (way.target, way.source) for w in FAN.transitions)
        bend = 22.0 if both else 0.0
        points, words, anchor = _way(place[way.source], place[way.target], bend)
        canvas.arrow(points, colour, 2.2, dashed=way.source == "*")
        canvas.text(words, _rule(way), 14, colour, anchor)
    spectator = builtin_spectator()
    bank = ClipBank(spectator.skeleton, spectator.clips)
    pool = StreamPool(spectator.skeleton, bank, capacity=len(names), history=2)
    rows = [pool.add(FAN.states[name], time=SECONDS).row for name in names]
    pool.evaluate(1)
    for name, row in zip(names, rows, strict=True):
        x, y = place[name]
        first = name == FAN.start
        canvas.box(
            (x, y), _HALF, mixed(GROUND, BLUE, 0.10), BLUE if first else PALE, 3 if first else 2
        )
        pose = pool.store.ring[pool.store.slice_of(1), row]
        draw_figure(canvas, spectator.skeleton, pose, (x, y + 36), 48, INK)
        canvas.text((x, y + 53), name, 16)
    canvas.box(place["*"], (58, 22), GROUND, FAINT, 1.5)
    canvas.text(place["*"], "any state", 15, FAINT)
    x, y = place[FAN.start]
    canvas.arrow([(x - 120, y), (x - _HALF[0] - 3, y)], BLUE, 2.2)
    canvas.text((x - 124, y), "start", 14, BLUE, "rm")
    canvas.text((_SIZE[0] / 2, 28), "A state machine of four clips", 20)
    return canvas.finish()


def _places(names: list[str]) -> dict[str, Place]:
    """States in a row, and the place that stands for all of them above."""
    step = (_SIZE[0] - 300) / max(len(names) - 1, 1)
    places = {name: (210.0 + step * k, 310.0) for k, name in enumerate(names)}
    return {**places, "*": (210.0 + step, 105.0)}


def _way(start: Place, end: Place, bend: float) -> tuple[list[Place], Place, str]:
    """Points of an arrow from box to box, and where its words go, with their anchor."""
    (ax, ay), (bx, by) = start, end
    if ay < by:  # from what stands for all states, into the top of the box
        points = curve((ax - 61, ay), (bx, ay + 10), (bx, by - _HALF[1] - 3))
        return points, (bx + 10, ay + 32), "rm"
    side = 1.0 if bx > ax else -1.0
    begin, stop = ax + side * (_HALF[0] + 3), bx - side * (_HALF[0] + 3)
    # One of two opposite ways runs above the other, bent away from it.
    y, middle = ay - side * bend, 0.5 * (begin + stop)
    points = curve((begin, y), (middle, y - 1.6 * side * bend), (stop, y))
    return points, (middle, y - side * (0.8 * bend + 9.0)), "md" if side > 0 else "ma"


def _rule(way: Transition) -> str:
    """What takes the transition, and how long it blends."""
    rules = []
    if way.trigger:
        rules.append(f"trigger {way.trigger}")
    if way.when:
        rules.append(way.when)
    if way.at_end:
        rules.append("at the end")
    return "\n".join([*rules, f"{way.duration:g} s"])

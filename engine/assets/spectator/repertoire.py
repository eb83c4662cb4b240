"""What the built-in spectator can do: each clip's shared poses, speed and events.

The file format has words for none of this. A state machine needs the poses to know which clip may
follow which without a blend: one that starts in the pose that the other ended in.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ...animation.clip import ClipEvent
from .tags import events_of, speed_of


@dataclass(frozen=True, slots=True)
class Motion:
    """What is known of a clip of the built-in spectator.

    Parameters
    ----------
    name
        Of the clip. ``sit_`` in front says that it is done on a seat; a number at the end tells
        variants of one motion apart.
    start, end
        Shared poses that it begins and ends in: ``sitting``, ``standing``, ``arms_up``,
        ``sit_arms_up``, ``clapping``, ``sit_clapping`` or ``hands_on_head``; ``moving`` for gaits,
        whose loops join only themselves.
    looping
        Whether it may be repeated.
    speed
        Metres a second that a gait covers; it runs on the spot.
    events
        See `tags`.
    """

    name: str
    start: str
    end: str
    looping: bool = True
    speed: float = 0.0
    events: tuple[ClipEvent, ...] = ()


_SEATED_POSES = {
    "standing": "sitting",
    "arms_up": "sit_arms_up",
    "clapping": "sit_clapping",
}

_EITHER: tuple[tuple[str, int, str, str, bool], ...] = (
    # Motions done standing and on a seat: name, variants, pose at start and end, loop.
    ("look_left", 2, "standing", "standing", True),
    ("look_right", 2, "standing", "standing", True),
    ("turn_left", 1, "standing", "standing", True),
    ("turn_right", 1, "standing", "standing", True),
    ("talk", 4, "standing", "standing", True),
    ("point", 3, "standing", "standing", True),
    ("laugh", 2, "standing", "standing", True),
    ("drink", 2, "standing", "standing", True),
    ("clap", 4, "clapping", "clapping", True),
    ("clap_beat", 4, "clapping", "clapping", True),
    ("clap_begin", 1, "standing", "clapping", False),
    ("clap_end", 1, "clapping", "standing", False),
    ("arm_up", 4, "standing", "arms_up", False),
    ("cheer", 4, "arms_up", "arms_up", True),
    ("cheer_beat", 4, "arms_up", "arms_up", True),
    ("arm_down", 4, "arms_up", "standing", False),
    ("fist_pump", 4, "standing", "standing", True),
    ("chant", 4, "standing", "standing", True),
    ("scarf_raise", 2, "standing", "standing", True),
    ("mexican_wave", 1, "standing", "standing", False),
    ("disappointed", 4, "standing", "standing", True),
    ("anticipate", 4, "standing", "standing", True),
    ("boo", 2, "standing", "standing", True),
    ("protest", 2, "standing", "standing", True),
    ("angry", 2, "standing", "standing", True),
    ("hit_by_ball", 2, "standing", "standing", False),
    ("duck", 2, "standing", "standing", False),
    ("reach", 2, "standing", "standing", False),
    ("let_pass", 2, "standing", "standing", False),
)
_ONE: tuple[tuple[str, int, str, str, bool], ...] = (
    ("sit", 1, "sitting", "sitting", True),
    ("sit_idle", 5, "sitting", "sitting", True),
    ("stand_idle", 5, "standing", "standing", True),
    ("stand_up", 1, "sitting", "standing", False),
    ("sit_down", 1, "standing", "sitting", False),
    ("jump", 4, "arms_up", "arms_up", True),
    ("dismay", 1, "hands_on_head", "hands_on_head", True),
    ("hug_a", 1, "standing", "standing", False),
    ("hug_b", 1, "standing", "standing", False),
    ("side_step", 2, "standing", "standing", False),
    ("kick", 2, "standing", "standing", False),
    ("walk", 4, "moving", "moving", True),
    ("jog", 2, "moving", "moving", True),
    ("run", 2, "moving", "moving", True),
)


def _variants(
    name: str, count: int, start: str, end: str, looping: bool, seated: bool
) -> Iterator[Motion]:
    for number in range(1, count + 1):
        plain = name if number == 1 else f"{name}_{number}"
        full = f"sit_{plain}" if seated else plain
        first, last = (_SEATED_POSES[p] if seated else p for p in (start, end))
        yield Motion(full, first, last, looping, speed_of(full), events_of(full))


def _waves() -> Iterator[Motion]:
    """Waving: two variants sway with the arms up, two greet with one hand."""
    for seated in (False, True):
        prefix = "sit_" if seated else ""
        for name, pose in (
            ("wave", "arms_up"),
            ("wave_2", "arms_up"),
            ("wave_3", "standing"),
            ("wave_4", "standing"),
        ):
            shared = _SEATED_POSES[pose] if seated else pose
            yield Motion(prefix + name, shared, shared, events=events_of(prefix + name))


def _all() -> Iterator[Motion]:
    for name, count, start, end, looping in _ONE:
        yield from _variants(name, count, start, end, looping, seated=False)
    for name, count, start, end, looping in _EITHER:
        for seated in (False, True):
            yield from _variants(name, count, start, end, looping, seated)
    yield from _waves()


MOTIONS: dict[str, Motion] = {motion.name: motion for motion in _all()}
"""Every motion by name."""

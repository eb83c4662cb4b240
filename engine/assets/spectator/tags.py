"""When what happens in the built-in spectator's clips; the file format has no word for it.

``clap_contact``: the hands meet. ``foot_left``, ``foot_right``: a foot comes down. ``apex``: the
hips or hands are highest. ``landing``: both feet are down again. ``kick``: the foot meets the ball.
``shout``: the head goes back and the voice up.
"""

from __future__ import annotations

from ...animation.clip import ClipEvent
from .applause import STYLES, numbered
from .gait import JOGS, RUNS, WALKS, contacts
from .jumping import LEAPS

_CLAPS = {numbered("clap", number): style for number, style in enumerate(STYLES, 1)}
_GAITS = {
    numbered(word, number): gait
    for word, gaits in (("walk", WALKS), ("jog", JOGS), ("run", RUNS))
    for number, gait in enumerate(gaits, 1)
}
_LEAPS = {numbered("jump", number): leap for number, leap in enumerate(LEAPS, 1)}

_APEX = {"mexican_wave": 0.95, "sit_mexican_wave": 1.13}
_KICK = {"kick": 0.56, "kick_2": 0.57}
_SHOUTS: dict[str, tuple[float, ...]] = {
    "cheer_2": (0.75, 1.75),
    "fist_pump": (0.57, 1.10),
    "fist_pump_2": (0.55,),
    "fist_pump_3": (0.57, 1.10),
    "fist_pump_4": (0.55,),
    **{chant: tuple(round(0.6 * k, 1) for k in range(1, 7))
       for chant in ("chant", "chant_2", "chant_3", "chant_4")},
    "boo": (0.67, 1.63),
    "boo_2": (0.67, 1.63),
    "protest": (0.97, 1.47),
    "protest_2": (0.57, 1.28),
    "angry": (1.13, 1.48, 1.82),
    "angry_2": (0.48, 1.22, 1.87),
    "disappointed": (0.37,),
    "disappointed_2": (0.36,),
    "disappointed_3": (0.47,),
    "disappointed_4": (0.36,),
    "hit_by_ball": (0.40,),
    "hit_by_ball_2": (0.22,),
    "mexican_wave": (0.87,),
    "sit_mexican_wave": (1.10,),
}  # fmt: skip
"""Seconds, for standing and seated variants alike unless both are given."""


def speed_of(name: str) -> float:
    """Metres a second that a gait covers, 0 for other clips."""
    return _GAITS[name].speed if name in _GAITS else 0.0


def events_of(name: str) -> tuple[ClipEvent, ...]:
    """Events of a clip of the built-in spectator in the order of their times."""
    plain = name.removeprefix("sit_")
    found = [ClipEvent(time, "shout") for time in _SHOUTS.get(name, _SHOUTS.get(plain, ()))]
    if plain in _CLAPS:
        style = _CLAPS[plain]
        times = (round(style.seconds * clap, 4) for clap in range(style.claps))
        found += [ClipEvent(time, "clap_contact") for time in times]
    elif plain.startswith("clap_beat"):
        found.append(ClipEvent(0.0, "clap_contact"))
    elif plain == "chant_4":
        found += [ClipEvent(round(1.2 * k, 1), "clap_contact") for k in (1, 2, 3)]
    if name in _GAITS:
        left, right = contacts(_GAITS[name])
        found += [ClipEvent(left, "foot_left"), ClipEvent(right, "foot_right")]
    if name in _LEAPS:
        leap = _LEAPS[name]
        found += [ClipEvent(round(leap.apex, 4), "apex"), ClipEvent(leap.land, "landing")]
    for table, event in ((_APEX, "apex"), (_KICK, "kick")):
        if name in table:
            found.append(ClipEvent(table[name], event))
    return tuple(sorted(found, key=lambda event: event.time))

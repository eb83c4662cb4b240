"""When what happens in the built-in spectator's clips; the file format has no word for it."""

from __future__ import annotations

from ...animation.clip import ClipEvent

# Eight claps at 3.3 Hz; the hands meet at the beginning of each.
_CLAPS = tuple(ClipEvent(round(0.3 * clap, 1), "clap_contact") for clap in range(8))

EVENTS: dict[str, tuple[ClipEvent, ...]] = {
    "clap": _CLAPS,
    "sit_clap": _CLAPS,
    "jump": (ClipEvent(0.585, "jump_apex"), ClipEvent(0.77, "landing")),
}
"""Events of each clip that has some."""

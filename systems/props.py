"""Spectators with caps, scarves and flags in their side's colours."""

from __future__ import annotations

import numpy as np

from ..engine.assets.props import builtin_prop, fits
from ..engine.crowd.colours import draw_appearance
from ..engine.crowd.looks import wears
from .crowd import Crowd
from .part import Part
from .parts import add_part

_STREAM = 0x9109
"""Sets these random choices apart from all others of the same seed."""

# Shares of those who have something, from and to: some have a scarf and a cap.
_KINDS = {"scarf": (0.0, 0.52), "cap": (0.40, 0.84), "flag": (0.80, 1.0)}
_NO_CAP = ("curly", "bun")
"""Hair that a cap does not fit over."""
_STREAMS = {"scarf": 6, "cap": 1, "flag": 8}


def give_props(crowd: Crowd, share: float, *, tick: int) -> dict[str, Part]:
    """Give some of those who support a side a cap, a scarf or a flag, each a part of the crowd.

    Parameters
    ----------
    crowd
        Built-in spectators, in the current esper world, without parts of these names.
    share
        Of the supporters, 0 to 1.
    tick
        The world's last pose tick.

    Returns
    -------
    The parts by the names of `tifo.PROPS`; their colours are those of the sides.

    Raises
    ------
    ValueError
        For a crowd of somebody else, or a share out of range.
    """
    if not 0.0 <= share <= 1.0:
        raise ValueError(f"share is {share}, expected 0 to 1")
    if not fits(crowd.character):
        raise ValueError(
            f"character '{crowd.character.name}' has other joints than the built-in spectator, "
            "for whom the props are made; hang parts of your own on it with add_part"
        )
    rng = np.random.default_rng([crowd.spec.seed, _STREAM])
    side = crowd.team.side
    has = (side >= 0) & (rng.random(len(crowd)) < share)
    kind = rng.random(len(crowd))
    colours = draw_appearance(side, rng, fervour=1.0)
    bare = wears(crowd.character, crowd.body, "hair", _NO_CAP)
    # A shirt's pattern is not that of a flag.
    colours.pattern[:] = 0
    parts = {}
    for name, (first, last) in _KINDS.items():
        prop = builtin_prop(name)
        agents = has & (kind >= first) & (kind < last)
        if name == "cap":
            agents &= ~bare
        parts[name] = add_part(
            crowd,
            name,
            prop.character,
            tick=tick,
            hook=prop.hook,
            transform=prop.transform,
            streams=_STREAMS[name],
            agents=agents,
            appearance=colours,
        )
    return parts

"""Spectators with caps, scarves, flags, foam hands and drums in their side's colours."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..engine.assets.props import builtin_prop, drumming, fits
from ..engine.crowd.body_types import ADULT
from ..engine.crowd.colours import draw_appearance
from ..engine.crowd.looks import wears
from .crowd import Crowd
from .part import Part
from .parts import add_part

_STREAM = 0x9109
"""Sets these random choices apart from all others of the same seed."""

# Shares of those who have something, from and to: some have a scarf and a cap.
_KINDS = {
    "scarf": (0.0, 0.52),
    "cap": (0.40, 0.84),
    "flag": (0.80, 0.95),
    "foam_hand": (0.95, 1.0),
    "drum": (0.0, 0.0),
}
_NO_CAP = ("curly", "bun")
"""Hair that a cap does not fit over."""
_STREAMS = {"scarf": 6, "flag": 8}
_ULTRA = 1.3
"""Fervour of those who may drum."""
_DRUMMERS = 0.12
"""Share of the ultras with something who have a drum and nothing else."""
_WIDEST = {"scarf": 0.045, "drum": 0.04}
"""Metres of girth of those who have something before them: bellies are not known to it."""
_OVERLAY = "arms"


def give_props(crowd: Crowd, share: float, *, tick: int) -> dict[str, Part]:
    """Give some of those who support a side a cap, a scarf, a flag, a foam hand or a drum.

    Each is a part of the crowd. Only grown-up ultras drum; one unique has their arms, and they all
    beat in time. Without room for it, or in a baked crowd, nobody has a drum.

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
    drummers = has & _may_drum(crowd) & (rng.random(len(crowd)) < _DRUMMERS)
    parts = {}
    for name, (first, last) in _KINDS.items():
        prop = builtin_prop(name)
        agents = has & ~drummers & (kind >= first) & (kind < last)
        if name == "cap":
            agents &= ~bare
        if name == "scarf":
            agents &= crowd.body.girth < _WIDEST["scarf"]
        if name == "drum":
            agents = drummers
        parts[name] = add_part(
            crowd,
            name,
            prop.character,
            tick=tick,
            hook=prop.hook,
            transform=prop.transform,
            motion=prop.motion,
            streams=_STREAMS.get(name, 1),
            agents=agents,
            appearance=colours,
        )
    if drummers.any():
        crowd.overlay(drummers, crowd.uniques.add(drumming()), _OVERLAY, duration=0.0)
    return parts


def _may_drum(crowd: Crowd) -> NDArray[np.bool_]:
    """(N,) ultras with arms and a belly that the drum fits, in a crowd with room for a unique."""
    if crowd.overlays is None or not (~crowd.uniques.alive).any():
        return np.zeros(len(crowd), np.bool_)
    fits_them = (crowd.body.kind == ADULT) & (crowd.body.girth < _WIDEST["drum"])
    ultra: NDArray[np.bool_] = (crowd.team.fervour > _ULTRA) & fits_them
    return ultra

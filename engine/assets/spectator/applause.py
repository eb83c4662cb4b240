"""Clapping at several rates, seated and standing, and the short ways into and out of it.

A clap takes an even number of sixtieths of a second, so every contact falls on a key and is kept by
any reader. All loops begin at a contact, in the poses `clapping` and `seated_clapping`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .acting import Acting
from .curves import Performance, Pose
from .poses import clapping, seated, seated_clapping, standing
from .rotations import Array


@dataclass(frozen=True, slots=True)
class Applause:
    """How somebody claps.

    Parameters
    ----------
    keys
        Sixtieths of a second that a clap takes.
    claps
        How many until it repeats.
    left, right
        Metres that each hand opens.
    above
        Metres that the right hand comes from above.
    bob
        Metres that the knees give with every other clap, if standing.
    lift
        Metres that the hands rise on the way through the loop.
    sway
        How much the body moves along, 1 for an ordinary crowd.
    """

    keys: int = 18
    claps: int = 8
    left: float = 0.070
    right: float = 0.105
    above: float = 0.045
    bob: float = 0.005
    lift: float = 0.012
    sway: float = 1.0

    @property
    def seconds(self) -> float:
        """Of one clap."""
        return self.keys / 60


ORDINARY = Applause()
SLOW = Applause(keys=30, claps=6, left=0.06, right=0.190, above=0.115, bob=0.010, sway=1.3)
FAST = Applause(keys=14, claps=12, left=0.055, right=0.075, above=0.02, bob=0.008, sway=1.2)
RISING = Applause(keys=24, claps=8, left=0.125, right=0.135, above=0.01, lift=0.150, sway=1.6)
STYLES = (ORDINARY, SLOW, FAST, RISING)


def applaud(name: str, style: Applause, base: Pose) -> Performance:
    """Bring the hands together again and again, the right one striking, the body riding along."""
    p = Performance(name, style.claps * style.seconds, base)
    phase = p.times / style.seconds
    within = phase - np.floor(phase + 1e-9)
    # Hands rebound fast, hang open for a moment and come down onto each other at speed.
    opened = np.sin(np.pi * np.clip(within, 0, 1) ** 0.9)
    loop = 2 * np.pi * p.times / p.duration
    several = style.claps > 1
    if several:
        opened = opened * (1 + 0.16 * np.sin(loop + 0.6) + 0.10 * np.sin(2 * loop + 2.0))
    rise = style.lift * (0.5 - 0.5 * np.cos(loop)) * several
    aside = 0.012 * style.sway * np.sin(loop) * several
    for side, sign, share, up in (
        ("_l", 1.0, style.left, 0.010),
        ("_r", -1.0, style.right, style.above),
    ):
        way = [share * opened + sign * aside, rise + up * opened, -0.35 * share * opened]
        p.add("hand" + side, np.stack(way, axis=1))
        finger = np.array([-0.12, -0.14, 0.12]) if side == "_l" else np.array([-0.12, -0.22, 0.16])
        p.add("finger" + side, _of(opened, finger))
        p.add("curl" + side, (0.24 * np.minimum(opened, 1.2))[:, None])
    s = style.sway
    p.wave("chest", (0.012 * s, 0.0, 0.0), style.claps, 0.15)
    p.wave("head", (0.020 * s, 0.0, 0.0), style.claps, 0.35).wave("shrug", 0.014, style.claps, 0.05)
    if several:
        p.wave("spine", (0.0, 0.014 * s, 0.018 * s), 2)
        p.wave("chest", (0.014, 0.022 * s, 0.016 * s), 1, 0.1)
        p.wave("head", (0.02 * s, 0.09 * s, 0.03), 1, 0.2).wave(
            "neck", (0.0, 0.04 * s, 0.0), 1, 0.1
        )
        p.add("head", _of(rise, np.array([-1.2, 0.0, 0.0])))
    if base["hips"][1] > 0.8:
        bounces = max(style.claps // 2, 1)
        p.wave("hips", (0.0, style.bob, 0.0), bounces, 0.25)
        p.wave("hips", (0.016 * s * several, 0.0, 0.004), 1)
        p.wave("hips_turn", (0.008, 0.03 * several, -0.02 * several), 1)
    return p


def begin(name: str, base: Pose, goal: Pose) -> Acting:
    """A third of a second from rest to the first contact."""
    p = Acting(name, 1 / 3, base, looping=False, goal=goal, snap=2.2)
    for side, late in (("_l", 0.0), ("_r", 0.02)):
        p.hand(side, 0.0, 0.17 + late, {"hand": (0.155, 0.02, 0.265)})
    p.back(0.02, 0.30)
    return p


def finish(name: str, base: Pose, goal: Pose) -> Acting:
    """Two fifths of a second from the last contact to rest."""
    p = Acting(name, 0.4, base, looping=False, goal=goal, snap=2.0)
    for side, late in (("_l", 0.0), ("_r", 0.02)):
        p.hand(side, 0.0, 0.15 + late, {"hand": (0.175, 0.0, 0.255)})
    p.back(0.02, 0.32)
    return p


def performances() -> list[Performance]:
    """All clips of this kind."""
    made: list[Performance] = []
    for prefix, base, rest in (("", clapping, standing), ("sit_", seated_clapping, seated)):
        for number, style in enumerate(STYLES, 1):
            made.append(applaud(numbered(f"{prefix}clap", number), style, base()))
            one = Applause(style.keys, 1, style.left, style.right, style.above, style.bob)
            made.append(applaud(numbered(f"{prefix}clap_beat", number), one, base()))
        made.append(begin(f"{prefix}clap_begin", rest(), base()))
        made.append(finish(f"{prefix}clap_end", base(), rest()))
    return made


def numbered(name: str, number: int) -> str:
    """``clap``, ``clap_2``, ``clap_3``: the first variant goes without a number."""
    return name if number == 1 else f"{name}_{number}"


def _of(share: Array, way: Array) -> Array:
    result: Array = share[:, None] * way
    return result

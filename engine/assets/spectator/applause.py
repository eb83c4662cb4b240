"""Clapping hands: eight claps that meet, each a little different, at 3.3 Hz.

A clap takes exactly 18 keys, so every contact falls on a key and is kept by any reader.
"""

from __future__ import annotations

import numpy as np

from .curves import Performance
from .rotations import Array

CLAPS = 8
CLAP_SECONDS = 0.3
TOUCH = 0.0225
"""Half the distance of the wrists, metres, when the palms meet."""


def add_claps(p: Performance, height: float) -> Performance:
    """Bring the hands together `CLAPS` times, the right one striking, the body riding along.

    Parameters
    ----------
    p
        A looping performance of CLAPS * CLAP_SECONDS seconds whose hands are free.
    height
        Of the wrists above the chest joint, metres.
    """
    phase = p.times / CLAP_SECONDS
    within = phase - np.floor(phase + 1e-9)
    # Hands rebound fast, hang open for a moment and come down onto each other at speed.
    open_hands = np.sin(np.pi * np.clip(within, 0, 1) ** 0.9)
    loop = 2 * np.pi * p.times / p.duration
    vigour = 1 + 0.16 * np.sin(loop + 0.6) + 0.10 * np.sin(2 * loop + 2.0)
    spread = open_hands * vigour
    drift = 0.012 * np.sin(loop)
    for side, share, ahead, lower in (("_l", 0.070, 0.0, 0.0), ("_r", 0.105, 0.004, 0.006)):
        sign = 1.0 if side == "_l" else -1.0
        place = np.stack(
            [
                TOUCH + share * spread + sign * drift,
                height + lower + (0.010 if side == "_l" else 0.045) * spread + 0.010 * np.cos(loop),
                0.305 + ahead - (0.020 if side == "_l" else 0.035) * spread,
            ],
            axis=1,
        )
        p.add("hand" + side, place - p.base["hand" + side])
        finger = _blend((0.02, 0.80, 0.62), (-0.10, 0.66, 0.74), spread)
        p.add("finger" + side, finger - p.base["finger" + side])
        p.add("palm" + side, np.array([-1.0, -0.05, 0.10]) - p.base["palm" + side])
        p.add("elbow" + side, np.array([0.75, -0.75, -0.45]) - p.base["elbow" + side])
        p.add("wrist" + side, 1.0 - p.base["wrist" + side])
        p.add("curl" + side, (-0.03 + 0.24 * spread)[:, None] - p.base["curl" + side])
    p.swing("chest", (0.012, 0.0, 0.0), CLAPS, 0.15).swing("head", (0.020, 0.0, 0.0), CLAPS, 0.35)
    p.swing("shrug", 0.014, CLAPS, 0.05)
    p.swing("spine", (0.0, 0.014, 0.018), 2).swing("chest", (0.014, 0.022, 0.016), 1, 0.1)
    p.swing("head", (0.02, 0.09, 0.03), 1, 0.2).swing("neck", (0.0, 0.04, 0.0), 1, 0.1)
    return p


def _blend(near: tuple[float, ...], far: tuple[float, ...], share: Array) -> Array:
    result: Array = np.array(near) + share[:, None] * (np.array(far) - np.array(near))
    return result

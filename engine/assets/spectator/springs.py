"""How a body part follows its goal: as a damped spring, which lags, swings past and settles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .rotations import Array

_SUBSTEPS = 3
"""Integration steps between two keys."""


@dataclass(frozen=True, slots=True)
class Pace:
    """How promptly a part follows.

    Parameters
    ----------
    hertz
        Natural frequency.
    damping
        Ratio to critical damping: below 1 it swings past the goal.
    lead
        Part of the goal's speed that is taken over at once; negative first moves the other way.
    """

    hertz: float
    damping: float
    lead: float = 0.0


def follow(goal: Array, times: Array, paces: Sequence[Pace], *, looping: bool) -> Array:
    """Where parts are that follow goals.

    The second-order system ``y + k1 y' + k2 y'' = x + k3 x'`` in semi-implicit Euler steps. It
    starts at rest on the goal; a loop is run twice, so that it ends as it began.

    Parameters
    ----------
    goal
        (F, C) at uniform `times` (F,) in seconds.
    paces
        C springs, one a column.
    looping
        Whether the last goal is followed by the first.

    Returns
    -------
    (F, C) float64
    """
    if len(times) < 2:
        return goal.copy()
    hertz, damping, lead = np.array([(p.hertz, p.damping, p.lead) for p in paces]).T
    rate = 2 * np.pi * hertz
    step = float(times[1] - times[0]) / _SUBSTEPS
    drag, stiffness = 1 - step * 2 * damping * rate, step * rate**2
    way = np.concatenate([goal[:-1], goal] if looping else [goal])
    change = np.diff(way, axis=0)
    push = lead * 2 * damping / rate * change / (step * _SUBSTEPS)
    place, speed = way[0].copy(), np.zeros_like(way[0])
    out = np.empty_like(way)
    out[0] = place
    for key in range(len(change)):
        for part in range(1, _SUBSTEPS + 1):
            wanted = way[key] + change[key] * (part / _SUBSTEPS) + push[key]
            place = place + step * speed
            speed = drag * speed + stiffness * (wanted - place)
        out[key + 1] = place
    return out[-len(goal) :]


def arrive(way: Array, times: Array, end: Array, seconds: float) -> Array:
    """Bend the last part of a way so that it ends at rest in `end`, with no kink anywhere.

    Parameters
    ----------
    way
        (F, C) at uniform `times` (F,).
    end
        (C,) where it shall end.
    seconds
        How long the last part is.
    """
    step = float(times[1] - times[0])
    speed = (3 * way[-1] - 4 * way[-2] + way[-3]) / (2 * step)
    u = np.clip((times - times[-1] + seconds) / seconds, 0.0, 1.0)[:, None]
    place = end - way[-1]
    # Cubic from rest at 0 to the missing place and speed at 1.
    bent: Array = way + place * u * u * (3 - 2 * u) - speed * seconds * (u * u * u - u * u)
    bent[-1] = end
    return bent


def close(way: Array, times: Array, end: Array, seconds: float) -> Array:
    """Bend a loop around its seam so that it begins and ends in `end`; see `arrive`."""
    duration = float(times[-1])
    reach = min(seconds, duration / 2)
    near = np.minimum(times, duration - times) / reach
    bump = np.where(near < 1, 0.5 + 0.5 * np.cos(np.pi * np.minimum(near, 1.0)), 0.0)
    result: Array = way + bump[:, None] * (end - way[0])
    result[-1] = result[0]
    return result

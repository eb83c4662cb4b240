"""Who of a crowd comes late, and whose seats stewards have."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components.appearance import Appearance
from ...components.party import Party
from ...components.team import NEUTRAL, Team
from .seating import SeatPlan

LATE = 300.0
"""Seconds within which everybody comes who is late; the most come early."""
BEHIND = 1.5
"""Seconds between two of a party."""
_VEST, _BAND, _DARK = (236, 222, 38, 255), (228, 120, 30, 255), (28, 30, 36, 255)
_HOOPS = 2

Bools = NDArray[np.bool_]
Ints = NDArray[np.int64]


def draw_latecomers(
    party: Party, occupied: Bools, share: float, rng: np.random.Generator
) -> tuple[Ints, NDArray[np.float64]]:
    """Who comes late, and when: whole parties, until they are a share of all people.

    Parameters
    ----------
    party, occupied
        Who belongs together, and (N,) who is there.
    share
        0 to 1.
    rng
        Where choices come from.

    Returns
    -------
    (K,) int64 ids, and (K,) seconds at which they come through a door
    """
    everyone = np.flatnonzero(occupied)
    wanted = round(share * len(everyone))
    if not wanted:
        return everyone[:0], np.zeros(0)
    number = party.party[everyone]
    rank = rng.permutation(int(number.max(initial=0)) + 1)
    order = np.argsort(rank[number], kind="stable")
    chosen, number = everyone[order][:wanted], number[order][:wanted]
    starts = np.flatnonzero(np.diff(number, prepend=-2))
    place = np.arange(wanted) - np.repeat(starts, np.diff(np.append(starts, wanted)))
    times = LATE * rng.beta(1.0, 2.5, len(starts))
    return chosen, np.repeat(times, np.diff(np.append(starts, wanted))) + BEHIND * place


def choose_stewards(
    plan: SeatPlan, occupied: Bools, posts: NDArray[np.float64]
) -> tuple[Ints, Bools]:
    """Seats that stay empty, so that their agents can be stewards.

    Parameters
    ----------
    plan, occupied
        The seats, and (N,) which are taken.
    posts
        (K, 3) where stewards are wanted; K is less than N.

    Returns
    -------
    (K,) int64 ids: of each post the nearest empty seat, or the nearest one where none is empty;
    and (N,) who is there, without those
    """
    chosen: list[int] = []
    there = occupied.copy()
    free = ~occupied
    for post in posts:
        apart = ((plan.position - post[:, None]) ** 2).sum(axis=0)
        apart[chosen] = np.inf
        ids = np.flatnonzero(free)
        near = int(ids[np.argmin(apart[ids])]) if len(ids) else -1
        if near < 0 or not np.isfinite(apart[near]):
            near = int(np.argmin(apart))
        chosen.append(near)
        there[near] = free[near] = False
    return np.array(chosen, np.int64), there


def dress_stewards(agents: Ints, team: Team, appearance: Appearance) -> None:
    """Yellow vests with a band on dark clothes; they support nobody and are moved by nothing."""
    team.side[agents], team.fervour[agents] = NEUTRAL, 0.0
    appearance.shirt[agents], appearance.second[agents] = _VEST, _BAND
    appearance.pattern[agents] = _HOOPS
    appearance.trousers[agents] = appearance.shoes[agents] = _DARK
    appearance.version += 1

"""Parties: people who came together sit together.

Seats are filled along the rows of each block, there and back, so that a party which does not fit
into the rest of a row goes on in the seats behind. Mostly it is given a rest that it fits into, by
letting the next parties of the queue choose.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.party import Party, PartyKind
from ..crowd.seating import SeatPlan

I32 = NDArray[np.int32]

WIDEST_GAP = 1.2
"""Metres between two seats of a row beyond which people don't sit together."""
HUG_REACH = 0.8
"""Metres between the seats of two who hug."""
_LOOK_AHEAD = 24


@dataclass(frozen=True, slots=True, kw_only=True)
class PartyMix:
    """How large parties are and who is in them.

    Parameters
    ----------
    alone
        Share of the *people* who come alone.
    sizes
        Share of each size among the *groups*, from two people on; normalised.
    children
        Share of the people who are children, at most half; they come in families.
    couples
        Share of the pairs without children that are couples.
    led
        Share of the parties of friends that follow somebody.

    Raises
    ------
    ValueError
        For shares that are not finite or outside their range.
    """

    alone: float
    sizes: tuple[float, ...]
    children: float = 0.08
    couples: float = 0.5
    led: float = 0.5

    def __post_init__(self) -> None:
        """Check every value."""
        for name, most in (("alone", 1.0), ("children", 0.5), ("couples", 1.0), ("led", 1.0)):
            value = getattr(self, name)
            if not 0.0 <= value <= most:
                raise ValueError(f"{name} is {value}, expected 0 to {most:g}")
        shares = np.asarray(self.sizes, np.float64)
        if (
            len(shares) == 0
            or not np.isfinite(shares).all()
            or (shares < 0).any()
            or not shares.sum()
        ):
            raise ValueError(f"sizes is {self.sizes}, expected shares of 0 and more, not all 0")

    @property
    def mean_size(self) -> float:
        """People a group, who come alone not counted."""
        shares = np.asarray(self.sizes)
        return float((shares * np.arange(2, len(shares) + 2)).sum() / shares.sum())


GENERAL_PUBLIC = PartyMix(alone=0.0, sizes=(0.71, 0.21, 0.06, 0.012, 0.008))
"""*Thesis*: pairs 71 %, threes 21 %, fours 6 %, five and more 2 % of the groups."""
FOOTBALL = PartyMix(
    alone=0.25,
    sizes=(0.25, 0.22, 0.2, 0.13, 0.09, 0.05, 0.03, 0.015, 0.015),
    couples=0.25,
)
"""Ruback et al. 2013: about a quarter come alone, and parties have four people on average."""


def form_parties(
    plan: SeatPlan, occupied: NDArray[np.bool_], mix: PartyMix, rng: np.random.Generator
) -> Party:
    """Put the people in `occupied` seats together to parties.

    Parameters
    ----------
    plan, occupied
        The seats, and an (N,) mask of those taken.
    mix
        Sizes and kinds.
    rng
        Where choices come from.

    Returns
    -------
    Party whose members follow each other along rows, with empty seats between them where the mask
    leaves some.
    """
    taken = np.asarray(occupied, bool)
    if taken.shape != (plan.count,):
        raise ValueError(f"occupied has shape {taken.shape}, expected ({plan.count},)")
    order = _there_and_back(plan)
    order = order[taken[order]]
    sizes = _fill(_rests(plan, order), mix, rng)
    number = np.repeat(np.arange(len(sizes), dtype=np.int32), sizes)
    return _describe(plan, order, number, sizes, mix, rng)


def seat_parties(
    plan: SeatPlan, people: int, mix: PartyMix, rng: np.random.Generator
) -> tuple[NDArray[np.bool_], Party]:
    """Decide which seats are taken, party by party: gaps lie between parties, not within them.

    Parameters
    ----------
    plan, mix, rng
        As above.
    people
        How many come, at most as many as there are seats.

    Returns
    -------
    (N,) mask of the seats taken, exactly `people`, and the parties in them.
    """
    if not 0 <= people <= plan.count:
        raise ValueError(f"people is {people}, expected 0 to {plan.count}")
    order = _there_and_back(plan)
    sizes = _fill(_rests(plan, order), mix, rng)
    left_out = rng.permutation(len(sizes))
    spare = plan.count - people
    until = int(np.searchsorted(np.cumsum(sizes[left_out]), spare, side="right"))
    kept = sizes.copy()
    kept[left_out[:until]] = 0
    still = spare - int(sizes[left_out[:until]].sum())
    if still:  # the last party comes with fewer
        kept[left_out[until]] -= still
    within = np.arange(plan.count) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    comes = within < np.repeat(kept, sizes)
    mask = np.zeros(plan.count, bool)
    mask[order[comes]] = True
    kept = kept[kept > 0]
    number = np.repeat(np.arange(len(kept), dtype=np.int32), kept)
    return mask, _describe(plan, order[comes], number, kept, mix, rng)


def turn_towards(
    plan: SeatPlan, agents: NDArray[np.integer], others: NDArray[np.integer]
) -> NDArray[np.float32]:
    """(K,) radians that agents turn, left positive, to face others; 0 where `others` is -1.

    Somebody who faces +Z turns by pi/2 to a neighbour at +X.
    """
    x, _, z = plan.position
    to = np.arctan2(x[others] - x[agents], z[others] - z[agents]) - plan.yaw[agents]
    to = np.arctan2(np.sin(to), np.cos(to))
    return np.where(others >= 0, to, 0.0).astype(np.float32)


def _there_and_back(plan: SeatPlan) -> NDArray[np.int64]:
    """Seats of each section row by row, every second row backwards."""
    column = np.where(plan.row % 2 == 0, plan.column, -plan.column)
    return np.lexsort((column, plan.row, plan.section))


def _apart(plan: SeatPlan, a: NDArray[np.integer], b: NDArray[np.integer]) -> NDArray[np.float32]:
    result: NDArray[np.float32] = np.linalg.norm(plan.position[:, a] - plan.position[:, b], axis=0)
    return result


def _rests(plan: SeatPlan, order: NDArray[np.int64]) -> NDArray[np.int64]:
    """Lengths of the runs of people between gangways, wide gaps and ends of rows."""
    if len(order) == 0:
        return np.zeros(0, np.int64)
    before, after = order[:-1], order[1:]
    is_break = (plan.row[before] != plan.row[after]) | (plan.section[before] != plan.section[after])
    is_break |= _apart(plan, before, after) > WIDEST_GAP * max(1.0, _width(plan) / 0.6)
    ends = np.append(np.flatnonzero(is_break) + 1, len(order))
    return np.diff(ends, prepend=0)


def _width(plan: SeatPlan) -> float:
    """Metres of row for a seat, the median."""
    by_row = np.lexsort((plan.column, plan.row))
    is_beside = np.diff(plan.row[by_row]) == 0
    apart = _apart(plan, by_row[:-1][is_beside], by_row[1:][is_beside])
    return float(np.median(apart)) if len(apart) else 0.5


def _draw(count: int, mix: PartyMix, rng: np.random.Generator) -> NDArray[np.int64]:
    """Sizes of parties, of at least `count` people."""
    # A quarter of the people alone is more than a quarter of the parties.
    groups = (1.0 - mix.alone) / mix.mean_size
    alone = mix.alone / max(mix.alone + groups, 1e-12)
    shares = np.asarray(mix.sizes, np.float64) / np.sum(mix.sizes)
    chance = np.concatenate([[alone], (1.0 - alone) * shares])
    mean = float((chance * np.arange(1, len(chance) + 1)).sum())
    drawn = np.zeros(0, np.int64)
    while drawn.sum() < count:
        more = int((count - drawn.sum()) / mean * 1.05) + 16
        drawn = np.concatenate([drawn, rng.choice(len(chance), more, p=chance) + 1])
    return drawn


def _fill(rests: NDArray[np.int64], mix: PartyMix, rng: np.random.Generator) -> NDArray[np.int64]:
    """Party sizes in the order of the seats; a run's last party is chosen to fit, if one does."""
    total = int(rests.sum())
    queue = _draw(total, mix, rng).tolist()
    sizes: list[int] = []
    free, head = 0, 0
    for rest in rests.tolist():
        free += rest  # below 0 while a party of the last run still needs seats
        while free > 0:
            pick = head
            # With a run's last seats in sight, a party that ends it, or leaves two, goes first.
            if free <= 6 and queue[head] != free:
                ahead = queue[head : head + _LOOK_AHEAD]
                exact = free if free in ahead else None
                if exact is None and queue[head] >= free - 1:
                    exact = next((size for size in ahead if size <= free - 2), None)
                pick = head + ahead.index(exact) if exact is not None else head
            size = queue[pick]
            queue[pick] = queue[head]
            head += 1
            sizes.append(size)
            free -= size
    result = np.asarray(sizes, np.int64)
    if len(result):
        result[-1] += total - int(result.sum())  # the last party ends with the last seat
    return result


def _describe(
    plan: SeatPlan,
    order: NDArray[np.int64],
    number: I32,
    sizes: NDArray[np.int64],
    mix: PartyMix,
    rng: np.random.Generator,
) -> Party:
    """Kinds, children, leaders and partners of parties whose members follow each other."""
    count = plan.count
    first = np.cumsum(sizes) - sizes
    within = np.arange(len(order)) - first[number]
    families, children = _families(sizes, mix, rng)
    kind = np.full(len(sizes), PartyKind.FRIENDS, np.int8)
    kind[(sizes == 2) & (rng.random(len(sizes)) < mix.couples)] = PartyKind.COUPLE
    kind[families] = PartyKind.FAMILY
    kind[sizes == 1] = PartyKind.ALONE
    # A family's children sit between its first adult and the others.
    adult = (within == 0) | (within > children[number])
    leader = np.full(len(sizes), -1, np.int32)
    is_led = (kind == PartyKind.FAMILY) | (
        (kind == PartyKind.FRIENDS) & (rng.random(len(sizes)) < mix.led)
    )
    someone = first + np.where(families, 0, rng.integers(0, np.maximum(sizes, 1)))
    leader[is_led] = order[someone[is_led]]
    nearest, partner = _neighbours(plan, order, number)

    result = Party(
        party=np.full(count, -1, np.int32),
        leader=np.full(count, -1, np.int32),
        kind=np.full(count, PartyKind.ALONE, np.int8),
        is_child=np.zeros(count, bool),
        nearest=np.full(count, -1, np.int32),
        partner=np.full(count, -1, np.int32),
    )
    result.party[order] = number
    result.leader[order] = leader[number]
    result.kind[order] = kind[number]
    result.is_child[order] = ~adult
    result.nearest[order] = nearest
    result.partner[order] = partner
    return result


def _families(
    sizes: NDArray[np.int64], mix: PartyMix, rng: np.random.Generator
) -> tuple[NDArray[np.bool_], NDArray[np.int64]]:
    """Which parties are families, and how many children each has: at most two for an adult."""
    most = np.where(sizes >= 2, np.minimum(sizes - 1, 2 * sizes // 3), 0)
    wanted = rng.integers(1, np.maximum(most, 1) + 1)
    queue = rng.permutation(np.flatnonzero(most > 0))
    goal = mix.children * sizes.sum()
    until = int(np.searchsorted(np.cumsum(wanted[queue]), goal, side="right"))
    is_family = np.zeros(len(sizes), bool)
    is_family[queue[:until]] = True
    return is_family, np.where(is_family, wanted, 0)


def _neighbours(plan: SeatPlan, order: NDArray[np.int64], number: I32) -> tuple[I32, I32]:
    """Nearest member of the own party, and the partner for a hug, for each of `order`."""
    nearest = np.full(len(order), -1, np.int32)
    partner = np.full(len(order), -1, np.int32)
    if len(order) < 2:
        return nearest, partner
    before, after = order[:-1], order[1:]
    apart = np.where(np.diff(number) == 0, _apart(plan, before, after), np.inf)
    to_left = np.concatenate([[np.inf], apart])
    to_right = np.concatenate([apart, [np.inf]])
    left = np.concatenate([order[:1], before])
    right = np.concatenate([after, order[-1:]])
    someone = np.where(to_left < to_right, left, right)
    nearest = np.where(np.minimum(to_left, to_right) < np.inf, someone, -1).astype(np.int32)
    # Along each run of members side by side, the first hugs the second, the third the fourth.
    reach = HUG_REACH * max(1.0, _width(plan) / 0.6)
    beside = (apart <= reach) & (plan.row[before] == plan.row[after])
    run = np.concatenate([[0], np.cumsum(~beside)])
    at = np.arange(len(order)) - np.searchsorted(run, run)
    hugs = np.flatnonzero(beside & (at[:-1] % 2 == 0))
    partner[hugs], partner[hugs + 1] = order[hugs + 1], order[hugs]
    return nearest, partner

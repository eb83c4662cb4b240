"""Which seats are taken, and which side their spectators support."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .seating import SeatPlan
from .selection import Selection, parse_selection
from .spec import CrowdSpec

HOME, AWAY, NEUTRAL = 0, 1, -1


def select(plan: SeatPlan, texts: Sequence[str]) -> NDArray[np.bool_]:
    """(N,) mask of the seats that any of the texts names (see `selection`).

    Raises
    ------
    ValueError
        A text can't be read or names no seat of this plan.
    """
    mask = np.zeros(plan.count, dtype=bool)
    single: list[tuple[int, int]] = []
    for selection in map(parse_selection, texts):
        if selection.is_seat and selection.rows and selection.columns:
            single.append((selection.rows[0], selection.columns[0]))
            continue
        inside = _inside(plan, selection)
        if not inside.any():
            raise ValueError(
                f"'{selection.text}' names no seat: rows are 0 to {plan.row.max()}, "
                f"columns 0 to {plan.column.max()}, sections 0 to {len(plan.sections) - 1}"
            )
        mask |= inside
    if single:
        mask[plan.find_all([row for row, _ in single], [column for _, column in single])] = True
    return mask


def _inside(plan: SeatPlan, selection: Selection) -> NDArray[np.bool_]:
    mask = np.ones(plan.count, dtype=bool)
    for span, values in (
        (selection.rows, plan.row),
        (selection.columns, plan.column),
        (selection.sections, plan.section),
    ):
        if span is not None:
            mask &= (values >= span[0]) & (values <= span[1])
    return mask


def occupancy_mask(plan: SeatPlan, spec: CrowdSpec, rng: np.random.Generator) -> NDArray[np.bool_]:
    """(N,) mask of the taken seats.

    In this order: `spec.occupancy` of all seats, rounded to a whole number and drawn at random;
    then `spec.empty` clears; then `spec.occupied` takes.

    Raises
    ------
    ValueError
        A text of `empty` or `occupied` names no seat of this plan.
    """
    free = plan.count - round(spec.occupancy * plan.count)
    mask = np.ones(plan.count, dtype=bool)
    mask[rng.choice(plan.count, free, replace=False, shuffle=False)] = False
    for name, texts, taken in (("empty", spec.empty, False), ("occupied", spec.occupied, True)):
        try:
            mask[select(plan, texts)] = taken
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from error
    return mask


def assign_sides(plan: SeatPlan, spec: CrowdSpec, rng: np.random.Generator) -> NDArray[np.int8]:
    """(N,) int8 side of each seat's spectator: 0 home, 1 away, further sides, -1 neutral.

    With an away block, `spec.away_share` of the seats are neighbouring sections at the end of the
    far stand (a section that is needed in part is cut from front to back), and the share
    `spec.neutrals` of all seats, drawn at random outside the block, is neutral. Several visiting
    sides divide the block among them. Mixed sides and equal blocks have neutrals everywhere.
    """
    sides = np.full(plan.count, HOME, dtype=np.int8)
    if spec.sides > 1 and spec.fans == "mixed":
        sides[:] = rng.integers(0, spec.sides, plan.count)
    elif spec.sides > 1 and spec.fans == "blocks":
        sides[_across(plan)] = np.arange(plan.count) * spec.sides // plan.count
    elif spec.sides > 1:
        block = away_block(plan, round(spec.away_share * plan.count))
        sides[block] = AWAY + np.arange(len(block)) * (spec.sides - 1) // max(len(block), 1)
    in_block = spec.sides == 1 or spec.fans == "away block"
    others = np.flatnonzero(sides == HOME) if in_block else np.arange(plan.count)
    count = min(len(others), round(spec.neutrals * plan.count))
    sides[rng.choice(others, count, replace=False, shuffle=False)] = NEUTRAL
    return sides


def draw_fervour(
    sides: NDArray[np.int8], spec: CrowdSpec, rng: np.random.Generator
) -> NDArray[np.float32]:
    """(N,) float32 how much each makes of what happens: about 1, neutrals 0.4, ultras 1.5.

    Ordinary supporters differ by up to 0.15. Away supporters hold three times as many ultras.
    """
    fervour = rng.uniform(0.85, 1.15, len(sides)).astype(np.float32)
    share = np.where(sides == HOME, spec.ultras, min(3.0 * spec.ultras, 1.0))
    fervour[rng.random(len(sides)) < share] = 1.5
    fervour[sides == NEUTRAL] = 0.4
    return fervour


def away_block(plan: SeatPlan, count: int) -> NDArray[np.int64]:
    """Indices of `count` seats in neighbouring sections, near the corner of +X and -Z.

    The block begins or ends at a section's border, whichever lies nearer to that corner.
    """
    starts = np.array([start for _, start, _ in plan.sections])
    stops = np.array([stop for _, _, stop in plan.sections])
    order = _across(plan)
    x, _, z = plan.position[:, order]
    wanted = float(np.argmin(np.hypot(x - x.max(), z - z.min()))) - 0.5 * count
    borders = np.concatenate([starts, stops - count])
    borders = borders[(borders >= 0) & (borders + count <= plan.count)]
    first = int(borders[np.argmin(np.abs(borders - wanted))])
    return order[first : first + count]


def _across(plan: SeatPlan) -> NDArray[np.int64]:
    """Seat indices section by section, within each from its left border to its right one."""
    key = plan.section.astype(np.int64) << 32 | plan.row
    new = np.flatnonzero(np.diff(key, prepend=-1))
    length = np.diff(np.append(new, plan.count))
    share = (np.arange(plan.count) - np.repeat(new, length) + 0.5) / np.repeat(length, length)
    return np.lexsort((plan.row, share, plan.section))

"""One straight stand on a grid: every seat lies at a formula of its row and column."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from .outline import Block
from .seating import FEET, SeatPlan, Structure, Tier, seats_of

MOST_ROWS = 10_000
MOST_SEATS = 1_000_000
_MOST_IN_A_BLOCK = 28


def build_stand(
    rows: int, columns: int, step: float = 1.5, rise: float = 2.0, depth: float = 2.0
) -> SeatPlan:
    """Seat (row, column), both from 0, at x = column * step, y = row * rise, z = -row * depth.

    Everybody faces +Z. Sections are runs of at most 28 columns over all rows; there are no
    gangways between them.

    Parameters
    ----------
    rows, columns
        1 to 10,000 each and at most 1,000,000 seats together.
    step, rise, depth
        Metres between neighbours in x, y and -z; step and depth above 0, rise at least 0.
    """
    for name, count in (("rows", rows), ("columns", columns)):
        if isinstance(count, bool) or not isinstance(count, int) or not 1 <= count <= MOST_ROWS:
            raise ValueError(
                f"{name} must be a whole number from 1 to {MOST_ROWS:,}, not {count!r}"
            )
    if rows * columns > MOST_SEATS:
        raise ValueError(
            f"rows * columns must be at most {MOST_SEATS:,}, "
            f"not {rows} * {columns} = {rows * columns:,}"
        )
    for name, size, least in (("step", step, 0.3), ("rise", rise, 0.0), ("depth", depth, 0.3)):
        if not least <= size <= 10.0:
            raise ValueError(f"{name} must be from {least} to 10 metres, not {size!r}")
    number = -(-columns // _MOST_IN_A_BLOCK)
    edges = [columns * i // number for i in range(number + 1)]
    blocks = tuple(
        Block((first - 0.5) * step, FEET, 0.0, 0.0, 0.0, (last - first) * step)
        for first, last in pairwise(edges)
    )
    tier = Tier(
        blocks=blocks,
        sections=tuple(range(number)),
        first_row=0,
        offsets=depth * np.arange(rows, dtype=np.float64),
        heights=rise * np.arange(rows, dtype=np.float64),
        counts=np.tile(np.diff(edges).astype(np.int32), (rows, 1)),
        widths=np.full((rows, number), float(step)),
    )
    plan = seats_of(Structure(None, (tier,), depth, 0.0, False))
    exact = np.stack([plan.column * step, plan.row * rise, -plan.row * depth]).astype(np.float32)
    exact.setflags(write=False)
    return replace(plan, position=exact)

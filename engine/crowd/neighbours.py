"""Who sits near whom: all pairs of spectators within a few seats of each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .seating import SeatPlan

SEATS = 3.0
"""How many seats away somebody still is a neighbour."""
_CHUNK = 20_000


def neighbour_pairs(
    plan: SeatPlan, present: NDArray[np.bool_], seats: float = SEATS
) -> NDArray[np.int32]:
    """Pairs of taken seats within `seats` of each other.

    One seat along a row counts as much as one row: a seat's distance is the root of the sum of the
    squares of both. Beside somebody are the seats that the tape measure finds there, whatever their
    numbers: the rows of a bowl have different numbers of seats.

    Parameters
    ----------
    plan
        The seats.
    present
        (N,) which are taken.
    seats
        Largest distance.

    Returns
    -------
    (P, 2) int32 ids, the smaller first; sorted, each pair once.
    """
    ids = np.flatnonzero(present)
    empty = np.zeros((0, 2), np.int32)
    if len(ids) < 2:
        return empty
    x, y, z = plan.position[:, ids].astype(np.float64)
    wide, deep = _spacing(plan)
    reach = seats * max(wide, deep) * 1.05
    # Cells as wide as the reach: neighbours are in the same or in an adjacent one.
    cell_x, cell_z = (np.floor((v - v.min()) / reach).astype(np.int64) for v in (x, z))
    stride = int(cell_z.max()) + 3
    cell = (cell_x + 1) * stride + cell_z + 1
    order = np.argsort(cell, kind="stable")
    sorted_cells = cell[order]
    right = np.stack([np.cos(plan.yaw[ids]), -np.sin(plan.yaw[ids])], axis=1)
    row = plan.row[ids]
    found = []
    for begin in range(0, len(ids), _CHUNK):
        a = order[begin : begin + _CHUNK]
        for step in (0, 1, stride - 1, stride, stride + 1):
            first = np.searchsorted(sorted_cells, cell[a] + step, side="left")
            last = np.searchsorted(sorted_cells, cell[a] + step, side="right")
            if step == 0:
                first = begin + np.arange(len(a)) + 1
            many = np.maximum(last - first, 0)
            one = np.repeat(a, many)
            start = np.repeat(first - np.cumsum(many) + many, many)
            other = order[start + np.arange(len(one))]
            away = np.stack([x[other] - x[one], z[other] - z[one]], axis=1)
            along = np.einsum("pk,pk->p", away, right[one]) / wide
            up = (row[other] - row[one]).astype(np.float64)
            near = along**2 + up**2 <= seats**2 + 1e-3
            # Seats of another tier may lie above or below.
            near &= (away**2).sum(axis=1) <= reach**2
            near &= np.abs(y[other] - y[one]) <= reach
            found.append(np.stack([ids[one[near]], ids[other[near]]], axis=1))
    pairs = np.sort(np.concatenate(found), axis=1).astype(np.int32)
    return pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]


def _spacing(plan: SeatPlan) -> tuple[float, float]:
    """Metres between neighbours of a row, and between rows."""
    follows = (np.diff(plan.row) == 0) & (np.diff(plan.column) == 1)
    follows &= np.diff(plan.section) == 0
    steps = np.hypot(*np.diff(plan.position[[0, 2]], axis=1))[follows]
    deep = float(plan.structure.tread)
    return (float(np.median(steps)) if len(steps) else deep), deep

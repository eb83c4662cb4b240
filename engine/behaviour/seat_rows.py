"""Who sits beside whom, and who in front and behind: rows as closed rings, linked row to row.

A row is put together from the places of the people in it, so gangways are wide gaps, missing
blocks wider ones, and empty seats are not there at all. Distances along a row are in seats: metres
over the median distance of neighbours. Links lead to the nearest person of the rows around.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..crowd.seating import SeatPlan

I32 = NDArray[np.int32]

_WINDOW = 6
_FARTHEST = 12.0
"""Seats beyond which nobody counts as sitting behind somebody."""


class SeatRows:
    """The rows of the people who are there.

    Parameters
    ----------
    plan
        Where the seats are.
    present
        (N,) bool; all by default.
    reach
        Rows to link to, forwards and backwards.

    Attributes
    ----------
    pitch
        Metres between neighbouring seats, taken or not; the median.
    order
        (n,) int32 ids of those present, row by row, along each row.
    place
        (N,) int32 place in `order`; -1 for who is absent.
    along
        (N,) float32 seats from the row's first person, along the row.
    length
        (N,) float32 seats round the row's ring, closed by the straight way.
    start, size
        (N,) int32 first place of the agent's row in `order`, and how many people are in it.
    links
        (2 reach + 1, N) int32: for d = -reach .. reach the nearest person d rows behind (-1 if
        there is none); the row d = 0 holds the agent itself.
    """

    __slots__ = ("along", "length", "links", "order", "pitch", "place", "reach", "size", "start")

    def __init__(
        self, plan: SeatPlan, present: NDArray[np.bool_] | None = None, reach: int = 3
    ) -> None:
        if reach < 1:
            raise ValueError(f"reach is {reach}, expected rows from 1")
        mask = np.ones(plan.count, bool) if present is None else np.asarray(present, bool)
        if mask.shape != (plan.count,):
            raise ValueError(f"present has shape {mask.shape}, expected ({plan.count},)")
        self.reach = reach
        ids = np.flatnonzero(mask)
        ids = ids[np.lexsort((plan.column[ids], plan.row[ids]))]
        self.order = ids.astype(np.int32)
        self.place = np.full(plan.count, -1, np.int32)
        self.place[ids] = np.arange(len(ids), dtype=np.int32)
        rows = plan.row[ids]
        starts = np.flatnonzero(np.diff(rows, prepend=-1))
        sizes = np.diff(np.append(starts, len(ids)))
        self.pitch = _pitch(plan)
        self._measure(plan, starts, sizes)
        self.links = self._link(plan, rows, starts, sizes)

    def _measure(self, plan: SeatPlan, starts: NDArray[np.int64], sizes: NDArray[np.int64]) -> None:
        """Distances along the rows, and round them."""
        order, count = self.order, plan.count
        self.along, self.length = np.zeros(count, np.float32), np.ones(count, np.float32)
        self.start, self.size = np.zeros(count, np.int32), np.zeros(count, np.int32)
        if len(order) == 0:
            return
        step = _apart(plan, order[:-1], order[1:]) / self.pitch
        step[starts[1:] - 1] = 0.0  # from row to row
        travelled = np.concatenate([[0.0], np.cumsum(step, dtype=np.float64)])
        ends = starts + sizes - 1
        closing = _apart(plan, order[ends], order[starts]) / self.pitch
        length = travelled[ends] - travelled[starts] + closing
        self.along[order] = travelled - np.repeat(travelled[starts], sizes)
        self.length[order] = np.maximum(np.repeat(length, sizes), 1e-3)
        self.start[order] = np.repeat(starts, sizes)
        self.size[order] = np.repeat(sizes, sizes)

    def _link(
        self,
        plan: SeatPlan,
        rows: I32,
        starts: NDArray[np.int64],
        sizes: NDArray[np.int64],
    ) -> I32:
        """Nearest people of the rows around."""
        links = np.full((2 * self.reach + 1, plan.count), -1, np.int32)
        links[self.reach, self.order] = self.order
        row_numbers = rows[starts]
        guess = self._guess(plan)
        for way in (-1, 1):
            next_row = np.searchsorted(row_numbers, row_numbers + way)
            next_row = np.minimum(next_row, len(row_numbers) - 1)
            exists = row_numbers[next_row] == row_numbers + way
            begin = np.repeat(np.where(exists, starts[next_row], 0), sizes)
            count = np.repeat(np.where(exists, sizes[next_row], 0), sizes)
            near = np.full(plan.count + 1, -1, np.int32)
            near[self.order] = self._nearest(plan, guess, begin, count, _FARTHEST)
            for distance in range(1, self.reach + 1):
                before = links[self.reach + way * (distance - 1)]
                links[self.reach + way * distance] = near[before]  # -1 leads to the last, -1
        return links

    def sweep(self, plan: SeatPlan) -> tuple[NDArray[np.float32], float]:
        """Where a line that sweeps over the stands, across all rows, meets each agent.

        Returns
        -------
        (N,) float32 seats along the middle row from the point nearest to the first person of the
        agent's row to that nearest to the agent; and the seats round the middle row. On straight
        stands this is `along`; in corners people in the last rows are farther apart than this,
        those in the first rows less far.
        """
        marks = np.zeros(plan.count, np.float32)
        order = self.order
        if len(order) == 0:
            return marks, 1.0
        middle = order[len(order) // 2]  # in the row with half of the people before it
        begin = np.full(len(order), self.start[middle], np.int64)
        count = np.full(len(order), self.size[middle], np.int64)
        near = self._nearest(plan, self._guess(plan), begin, count, np.inf)
        ahead = self.order[begin + (self.place[near] - begin + 1) % count]
        before = self.order[begin + (self.place[near] - begin - 1) % count]
        x, _, z = plan.position
        along_x, along_z = x[ahead] - x[before], z[ahead] - z[before]
        length = np.maximum(np.hypot(along_x, along_z), 1e-3)
        shift = (x[order] - x[near]) * along_x + (z[order] - z[near]) * along_z
        ring = float(self.length[middle])
        marks[order] = self.along[near] + np.clip(shift / length / self.pitch, -0.5, 0.5)
        # From the row's first person on; some may be a little before it.
        marks[order] = (marks[order] - marks[order[self.start[order]]] + 1.0) % ring - 1.0
        return marks, ring

    def _guess(self, plan: SeatPlan) -> NDArray[np.float64]:
        """(n,) where each of `order` is in its row, 0 to 1, comparable between rows.

        Rows round the pitch are compared by the direction from its middle, others by their length.
        """
        order = self.order
        if plan.structure.outline is None:
            return np.asarray(self.along[order] / self.length[order], np.float64)
        x, _, z = plan.position[:, order]
        return np.asarray(np.arctan2(z, x) / (2.0 * np.pi) + 0.5, np.float64)

    def _nearest(
        self,
        plan: SeatPlan,
        guess: NDArray[np.float64],
        begin: NDArray[np.int64],
        count: NDArray[np.int64],
        farthest: float,
    ) -> I32:
        """Nearest of the `count` people from place `begin` on, for each of `order`.

        Rows run side by side, so the search starts at the same value of `guess` and moves on by
        windows while it gets nearer. Nobody beyond `farthest` seats is found (-1).
        """
        order = self.order
        rows = plan.row[order]
        found = np.full(len(order), -1, np.int32)
        some = np.flatnonzero(count > 0)
        by_guess = np.lexsort((guess, rows))
        keys = 2.0 * rows[by_guess] + guess[by_guess]
        at = np.searchsorted(keys, 2.0 * rows[begin[some]] + guess[some])
        at = np.clip(at, begin[some], begin[some] + count[some] - 1)
        first = by_guess[at] - begin[some]
        window = np.arange(-_WINDOW, _WINDOW + 1)
        for _ in range(64):
            places = begin[some, None] + (first[:, None] + window) % count[some, None]
            away = _apart(plan, order[some, None], order[places])
            best = away.argmin(axis=1)
            is_at_edge = (np.abs(window[best]) == _WINDOW) & (count[some] > 2 * _WINDOW + 1)
            lines = np.arange(len(some))
            is_close = away[lines, best] <= farthest * self.pitch
            found[some] = np.where(is_close, order[places[lines, best]], -1)
            first, some = (first + window[best])[is_at_edge], some[is_at_edge]
            if len(some) == 0:
                break
        return found


def _pitch(plan: SeatPlan) -> float:
    by_row = np.lexsort((plan.column, plan.row))
    is_beside = np.diff(plan.row[by_row]) == 0
    apart = _apart(plan, by_row[:-1][is_beside], by_row[1:][is_beside])
    return float(np.median(apart)) if len(apart) else 1.0


def _apart(plan: SeatPlan, a: NDArray[np.integer], b: NDArray[np.integer]) -> NDArray[np.float32]:
    """Metres between seats on the map."""
    x, _, z = plan.position
    result: NDArray[np.float32] = np.hypot(x[a] - x[b], z[a] - z[b])
    return result

"""The Mexican wave: a crowd as an excitable medium, on the seats as they are.

Farkas, Helbing, Vicsek 2002 (Nature 419:131; Physica A 330:18). A person is inactive, then active
(rising, arms up), then refractory, then inactive again. An inactive person i gets up, a reaction
time later, when

    sum_j w_ij [j is active]  >  c_i sum_j w_ij          over the others who are there

Weights fall with distance, `exp(-d)` with d in units of `seats` along a row and `rows` across, and
favour one side by ``1 + bias cos(angle)``. The front passes a seat every 45 ms, while people need
0.2 s to react; so it moves at the distance, divided by the reaction time, at which people ahead are
moved by it: they look several seats ahead. Whoever starts it, it runs or dies by itself.

A row's seats are counted half by themselves and half by where a line that sweeps over the stands,
across all rows, meets people: so a front stays nearly straight from the first row to the last, also
round corners, where the last rows have several times as many seats as the first.

Only what changes costs anything: who gets up adds its weights to the people around, once, and takes
them back when it sits down. They are whole numbers, so nothing is left over after a million waves.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..crowd.agents import agent_ids
from ..crowd.seating import SeatPlan
from .rates import check_rates
from .seat_rows import SeatRows

INACTIVE, REACTING, ACTIVE, REFRACTORY = 0, 1, 2, 3

_UNIT = 1024
"""Weight of somebody at no distance."""
_FARTHEST = 1.9
"""Distance d beyond which nobody counts."""
_STEPS = 8
"""Distances along a row are rounded to this part of a seat."""
_STEPS_A_SEAT = 1.2
"""In the corners of the last rows, a step to the next person is less than a seat of the sweep."""
_CHUNK = 2048
_SPARSE = 0.35
"""Where less than this part of a full neighbourhood is there, people count as if it were there."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WaveRates:
    """Constants of the medium; times in seconds.

    Parameters
    ----------
    seats, rows
        Distance along a row, in seats, and across, in rows, at which a weight is 1/e.
    bias
        How much more those count who sit on the side that the wave comes from: ``1 + bias`` against
        ``1 - bias``. Above 0 it runs clockwise seen from above (to higher columns), below 0 the
        other way.
    threshold, threshold_spread
        Mean and s.d. of the share of active people that moves a person.
    reaction, reaction_spread
        Mean and s.d. from being moved to being seen to move.
    active, active_spread
        Mean and s.d. of how long one counts as active.
    refractory, refractory_spread
        Mean and s.d. of how long one can't be moved afterwards.
    """

    seats: float = 6.8
    rows: float = 2.25
    bias: float = 0.33
    threshold: float = 0.283
    threshold_spread: float = 0.03
    reaction: float = 0.2
    reaction_spread: float = 0.04
    active: float = 0.7
    active_spread: float = 0.1
    refractory: float = 5.0
    refractory_spread: float = 1.0

    def __post_init__(self) -> None:
        """Check every value."""
        check_rates(
            self, signed=("bias",), positive=("seats", "rows", "reaction", "active", "refractory")
        )


class WaveChange(NamedTuple):
    """Ids of the agents that got up and that sat down in a step, both ascending."""

    rose: NDArray[np.int64]
    sat: NDArray[np.int64]


class MexicanWave:
    """The medium.

    Parameters
    ----------
    plan
        The seats.
    rng
        Where people's thresholds and times come from.
    present
        (N,) bool; absent people are not there to be seen, and never get up. All by default.
    rates
        Constants.
    tick_seconds
        Length of a step; it must be much shorter than the reaction time.

    Attributes
    ----------
    state
        (N,) uint8 `INACTIVE`, `REACTING`, `ACTIVE` or `REFRACTORY`.
    threshold
        (N,) float32 c_i: raise it for people in no mood; ``inf`` never joins.
    """

    def __init__(
        self,
        plan: SeatPlan,
        rng: np.random.Generator,
        present: NDArray[np.bool_] | None = None,
        rates: WaveRates = WaveRates(),
        tick_seconds: float = 1.0 / 30.0,
    ) -> None:
        if not 0 < tick_seconds <= 0.05:
            raise ValueError(f"tick_seconds is {tick_seconds}, expected more than 0, at most 0.05")
        self.rates = rates
        self._rng, self._tick_seconds = rng, tick_seconds
        self._rows = SeatRows(plan, present, reach=max(1, int(_FARTHEST * rates.rows)))
        self._tier = plan.tier
        self._weights, self._pattern = self._table(), self._reachable()
        self._most = int(self._pattern[1].max())
        swept, ring = self._rows.sweep(plan)
        along = 0.5 * (self._rows.along + swept)
        self._mark = np.rint(along * _STEPS).astype(np.int32)
        self._marks = self._mark[self._rows.order]
        self._ring = np.rint(0.5 * (self._rows.length + ring) * _STEPS).astype(np.int32)
        count = plan.count
        self.state = np.zeros(count, np.uint8)
        drawn = rng.normal(rates.threshold, rates.threshold_spread, count)
        self.threshold = np.maximum(drawn, 0.05).astype(np.float32)
        self._field = np.zeros(count, np.int32)
        self._full = np.zeros(count, np.float32)
        self._due = np.zeros(count, np.int32)
        self._busy = np.zeros(0, np.int64)
        self._tick = 0

    @property
    def is_quiet(self) -> bool:
        """Whether nobody moves, reacts or rests."""
        return len(self._busy) == 0

    def excitation(self, agents: NDArray[np.int64]) -> NDArray[np.float32]:
        """(K,) share of the weight round each agent that is active, 0 to 1."""
        self.prepare()
        return np.asarray(self._field[agents] / self._full[agents], np.float32)

    def prepare(self) -> None:
        """Weigh everybody's neighbourhood, which the first wave needs.

        0.4 s for 65,000 seats; a second call does nothing.
        """
        if self._full.any():
            return
        full = np.zeros(len(self.state), np.int64)
        for first in range(0, len(self._rows.order), _CHUNK):
            moved, weight, _ = self._around(self._rows.order[first : first + _CHUNK])
            full += np.bincount(moved, weight, len(full)).astype(np.int64)
        self._full[:] = np.maximum(full, _SPARSE * self._whole() * self._crowding())

    def start(self, agents: int | ArrayLike) -> NDArray[np.int64]:
        """Let agents get up at the next step, whatever the others do.

        Returns
        -------
        (K,) int64 those who do: present, and neither active nor about to be.
        """
        self.prepare()
        ids: NDArray[np.int64] = np.unique(agent_ids(agents, len(self.state)))
        ids = ids[(self._rows.place[ids] >= 0) & (self.state[ids] != ACTIVE)]
        self._busy = self._busy[~np.isin(self._busy, ids)]
        self._react(ids, np.ones(len(ids), np.int32))
        return ids

    def reset(self) -> None:
        """Everybody sits, ready for another wave."""
        self.state[:] = INACTIVE
        self._field[:] = 0
        self._busy = self._busy[:0]

    def step(self) -> WaveChange:
        """Advance by a tick."""
        self._tick += 1
        if self.is_quiet:
            return WaveChange(self._busy, self._busy)
        is_due = self._due[self._busy] <= self._tick
        ids = np.sort(self._busy[is_due])
        was = self.state[ids]
        rose, sat, rested = ids[was == REACTING], ids[was == ACTIVE], ids[was == REFRACTORY]
        rates = self.rates
        self._enter(rose, ACTIVE, rates.active, rates.active_spread)
        self._enter(sat, REFRACTORY, rates.refractory, rates.refractory_spread)
        self.state[rested] = INACTIVE
        self._busy = self._busy[self.state[self._busy] != INACTIVE]
        moved, weight, source = self._around(np.concatenate([rose, sat]))
        is_rise = source < len(rose)
        np.add.at(self._field, moved, np.where(is_rise, weight, -weight))
        perhaps = np.concatenate([moved[is_rise], rested])
        perhaps = perhaps[self.state[perhaps] == INACTIVE]
        is_moved = self._field[perhaps] > self.threshold[perhaps] * self._full[perhaps]
        reacting = np.unique(perhaps[is_moved])
        self._react(reacting, self._ticks(rates.reaction, rates.reaction_spread, len(reacting)))
        return WaveChange(rose, sat)

    def _react(self, ids: NDArray[np.int64], ticks: NDArray[np.int32]) -> None:
        self.state[ids] = REACTING
        self._due[ids] = self._tick + ticks
        self._busy = np.concatenate([self._busy, ids])

    def _enter(self, ids: NDArray[np.int64], state: int, mean: float, deviation: float) -> None:
        self.state[ids] = state
        self._due[ids] = self._tick + self._ticks(mean, deviation, len(ids))

    def _ticks(self, mean: float, deviation: float, count: int) -> NDArray[np.int32]:
        """Times drawn, in whole ticks of at least 1; fractions are rounded at random."""
        ticks = self._rng.normal(mean, deviation, count) / self._tick_seconds
        result: NDArray[np.int32] = np.floor(ticks + self._rng.random(count)).astype(np.int32)
        return np.maximum(result, 1)

    def _table(self) -> NDArray[np.int32]:
        """(D, W) weight by rows apart (0 to reach + 1) and rounded seats along the row."""
        rates = self.rates
        most = int(_FARTHEST * rates.seats * _STEPS)
        along = np.arange(-most, most + 1) / (_STEPS * rates.seats)
        across = np.arange(self._rows.reach + 2)[:, None] / rates.rows
        distance = np.hypot(along, across)
        cosine = along / np.maximum(distance, 1e-9)
        weight = np.exp(-distance) * (1.0 + rates.bias * cosine) * (distance <= _FARTHEST)
        weight[0, most] = 0.0  # oneself
        table = np.zeros((len(across), len(along) + 2), np.int32)
        table[:, 1:-1] = np.rint(_UNIT * weight)
        return table

    def _whole(self) -> float:
        """Weight of everybody round somebody in the middle of a full block, at least 1."""
        apart = np.abs(np.arange(-self._rows.reach, self._rows.reach + 1))
        middle = self._weights.shape[1] // 2
        seats = np.arange(-(middle // _STEPS), middle // _STEPS + 1) * _STEPS + middle
        return max(float(self._weights[apart][:, seats].sum()), 1.0)

    def _crowding(self) -> NDArray[np.float64]:
        """(N,) people sit so much denser, counted so: below 1 in the first rows' corners."""
        rows, order = self._rows, self._rows.order
        crowding = np.ones(len(self.state))
        start, size = rows.start[order], rows.size[order]
        ends = [rows.order[start + (rows.place[order] - start + k) % size] for k in (-3, 3)]
        along = rows.along[ends[1]] - rows.along[ends[0]]
        swept = (self._mark[ends[1]] - self._mark[ends[0]]) / _STEPS
        is_plain = (along > 1.0) & (swept > 1.0)  # not where the row closes
        crowding[order[is_plain]] = np.clip((along / np.maximum(swept, 1.0))[is_plain], 0.2, 3.0)
        return crowding

    def _reachable(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """Row of `SeatRows.links` and steps along that row of all who may be near enough."""
        rates, reach = self.rates, self._rows.reach
        most = int(_STEPS_A_SEAT * _FARTHEST * rates.seats)
        apart, steps = np.mgrid[-reach : reach + 1, -most : most + 1]
        near = np.hypot(steps / (_STEPS_A_SEAT * rates.seats), apart / rates.rows)
        d, k = np.nonzero(near <= _FARTHEST)
        return d.astype(np.int32), (k - most).astype(np.int32)[:, None]

    def _around(
        self, ids: NDArray[np.integer]
    ) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int64]]:
        """Whom agents move, with repeats, by how much, and which of `ids` does it."""
        rows, middle = self._rows, self._weights.shape[1] // 2
        d, k = self._pattern
        if len(ids) == 0:
            return np.zeros(0, np.int32), np.zeros(0, np.int32), np.zeros(0, np.int64)
        links = rows.links[:, ids]
        anchors = np.where(links >= 0, links, ids)
        size = rows.size[anchors]
        end = rows.start[anchors] + size
        sizes = size.take(d, 0)
        place = rows.place[anchors].take(d, 0) + k
        if size.min() > self._most:
            turns = (place >= end.take(d, 0)).astype(np.int32)
            turns -= place < (end - size).take(d, 0)
        else:
            turns = (place - (end - size).take(d, 0)) // sizes
        place -= turns * sizes
        column = self._marks.take(place)
        column += turns * self._ring[anchors].take(d, 0)
        column += (middle - self._mark[anchors]).take(d, 0)
        np.clip(column, 0, 2 * middle, out=column)
        apart = np.abs(np.arange(-rows.reach, rows.reach + 1, dtype=np.int32))[:, None]
        apart = apart + (self._tier[anchors] != self._tier[ids])
        column += (apart * np.int32(self._weights.shape[1])).take(d, 0)
        weight = self._weights.ravel().take(column)
        is_real = links >= 0
        if not is_real.all() or size.min() <= 2 * self._most:
            once = (2 * k > -sizes) & (2 * k <= sizes)  # not twice round a short row
            weight *= is_real.take(d, 0) & once
        some = np.flatnonzero(weight)
        source = some % len(ids)
        return rows.order[place.ravel()[some]], weight.ravel()[some], source

"""Emotion passes from neighbour to neighbour, and fades.

Each agent has a mood (valence) and excitement (arousal), columns that the caller owns. They fade to
their rests, ``dv/dt = -g_v (v - b)`` and ``da/dt = -g_a (a - d)``, with half-lives of 1.9 and 1.7
minutes (after Garcia et al. 2016), and are absorbed from the people beside, in front and behind
(the graded, proximity-based contagion that Tsai et al. 2011 found best; Bosse et al. 2009):

    dq_i/dt = rate * susceptibility_i * sum_j w_ij (q_j - q_i)      w_ij ~ exp(-metres / near)

An applause whose `ground` follows the excitement (`clap_benefit`) makes a crowd *boil* (*Thesis*
6.3): at low excitement one here and there claps and gives up; the more excited people are, the more
of them clap and are answered, until suddenly everybody claps.

Emotions change slowly, so each step serves one part of the crowd for the time since its last turn.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..crowd.seating import SeatPlan
from .rates import check_rates
from .seat_rows import SeatRows

F32 = NDArray[np.float32]

_BESIDE = (-2, -1, 1, 2)
_OTHER_ROW = (-1, 0, 1)


@dataclass(frozen=True, slots=True, kw_only=True)
class ContagionRates:
    """Constants of the equations above.

    Parameters
    ----------
    mood_half_life, excitement_half_life
        Seconds.
    rate
        How fast a susceptible person in a full stand takes over what his neighbours feel, a second.
    near
        Metres at which a neighbour's weight is 1/e.
    opponents
        What an opponent's emotion counts, against 1 for everybody else.
    boil
        Benefit of clapping (1 is a good talk) for each unit of excitement.
    """

    mood_half_life: float = 114.0
    excitement_half_life: float = 102.0
    rate: float = 0.05
    near: float = 0.8
    opponents: float = 0.1
    boil: float = 0.8

    def __post_init__(self) -> None:
        """Check every value."""
        check_rates(self, positive=("mood_half_life", "excitement_half_life", "near"))


class EmotionContagion:
    """The spread and the fading of mood and excitement.

    Parameters
    ----------
    plan
        Where people sit.
    present
        (N,) bool; absent ones feel nothing and show nothing. All by default.
    side
        (N,) int8 side of each agent, -1 for neutrals; emotions hardly pass between opponents. By
        default there are none.
    rates
        Constants.
    turn_seconds
        Everybody has a turn once in so long, and later steps see it.

    Attributes
    ----------
    mood_rest, excitement_rest
        (N,) float32 what they fade to; 0 at first.
    neighbours
        (N, 10) int32 whom each agent sees; itself where there is nobody.
    weights
        (N, 10) float32 w_ij, which sum to 1 in a full stand and to less where seats are empty.
    """

    def __init__(
        self,
        plan: SeatPlan,
        present: NDArray[np.bool_] | None = None,
        side: NDArray[np.int8] | None = None,
        rates: ContagionRates = ContagionRates(),
        turn_seconds: float = 2.0,
    ) -> None:
        if not 0 < turn_seconds < 60:
            raise ValueError(f"turn_seconds is {turn_seconds}, expected more than 0, below 60")
        self.rates = rates
        rows = SeatRows(plan, present, reach=1)
        self.neighbours = _beside(rows, plan.count)
        own = np.arange(plan.count, dtype=np.int32)[:, None]
        x, y, z = plan.position
        apart = np.sqrt(sum((axis[self.neighbours] - axis[:, None]) ** 2 for axis in (x, y, z)))
        weights = np.exp(-apart / rates.near) * (self.neighbours != own)
        full = float(np.percentile(weights.sum(axis=1), 90)) if plan.count else 1.0
        weights /= np.maximum(np.maximum(weights.sum(axis=1, keepdims=True), full), 1e-9)
        if side is not None:
            theirs = side[self.neighbours]
            is_opponent = (theirs != side[:, None]) & (theirs >= 0) & (side[:, None] >= 0)
            weights = np.where(is_opponent, rates.opponents * weights, weights)
        self.weights = weights.astype(np.float32)
        self.mood_rest = np.zeros(plan.count, np.float32)
        self.excitement_rest = np.zeros(plan.count, np.float32)
        self._total = self.weights.sum(axis=1)
        self._turn_seconds = turn_seconds
        self._last = np.zeros(plan.count)
        self._now, self._owed, self._next = 0.0, 0.0, 0

    def step(
        self,
        mood: F32,
        excitement: F32,
        dt: float,
        susceptibility: F32 | None = None,
    ) -> tuple[slice, slice]:
        """Give the next part of the crowd its turn; all of it if `dt` is as long as a turn.

        Parameters
        ----------
        mood, excitement
            (N,) float32, changed in place.
        dt
            Seconds since the last step.
        susceptibility
            (N,) 0 and more; 1 for all by default.

        Returns
        -------
        The agents whose columns changed: from where the last step ended, and from 0 on.
        """
        if not dt > 0:
            raise ValueError(f"dt is {dt}, expected seconds above 0")
        count = len(self.mood_rest)
        self._now += dt
        self._owed = min(self._owed + count * dt / self._turn_seconds, float(count))
        number = int(self._owed)
        self._owed -= number
        first, stop = self._next, min(self._next + number, count)
        parts = (slice(first, stop), slice(0, number - (stop - first)))
        self._next = parts[1].stop if stop == count else stop
        for part in parts:
            if part.stop > part.start:
                self._serve(part, mood, excitement, susceptibility)
        return parts

    def _serve(
        self,
        part: slice,
        mood: F32,
        excitement: F32,
        susceptibility: F32 | None,
    ) -> None:
        """Bring one part of the crowd up to date."""
        others, weights, total = self.neighbours[part], self.weights[part], self._total[part]
        seconds = (self._now - self._last[part]).astype(np.float32)
        self._last[part] = self._now
        strength = seconds * total * np.float32(self.rates.rate)
        if susceptibility is not None:
            strength *= susceptibility[part]
        taken = -np.expm1(-strength) / np.maximum(total, np.float32(1e-9))
        for column, rest, half_life in (
            (mood, self.mood_rest, self.rates.mood_half_life),
            (excitement, self.excitement_rest, self.rates.excitement_half_life),
        ):
            now, shown = column[part], column.take(others)
            felt = now + taken * (np.einsum("nk,nk->n", weights, shown) - total * now)
            kept = np.exp2(seconds * np.float32(-1.0 / half_life))
            column[part] = rest[part] + kept * (felt - rest[part])

    def clap_benefit(self, excitement: F32) -> F32:
        """(N,) benefit of clapping without a cue, for `Applause.ground`."""
        return np.float32(self.rates.boil) * excitement


def _beside(rows: SeatRows, count: int) -> NDArray[np.int32]:
    """(N, 10) two people to each side, and three of the rows in front and behind."""
    own = np.arange(count, dtype=np.int32)
    if len(rows.order) == 0:
        return np.repeat(own[:, None], 10, axis=1)
    columns = []
    for link, steps in ((0, _OTHER_ROW), (1, _BESIDE), (2, _OTHER_ROW)):
        anchor = rows.links[link]
        first, size = rows.start[anchor], np.maximum(rows.size[anchor], 1)
        for step in steps:
            found = rows.order[first + (rows.place[anchor] + step - first) % size]
            once = (2 * step > -size) & (2 * step <= size)  # not twice round a short row
            columns.append(np.where((anchor >= 0) & once, found, own))
    return np.stack(columns, axis=1).astype(np.int32)

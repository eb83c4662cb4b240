"""When people clap: everybody's own beat, and the beat that they find together.

Clappers are Kuramoto oscillators that hear each other (Neda et al. 2000, Nature 403:849),

    dphi_k/dt = w_k + (K / N) sum_j sin(phi_j - phi_k)  =  w_k + K Im(Z exp(-i phi_k))

with the mean field ``Z = (1/N) sum_j exp(i phi_j)``, so a step costs O(N). Order needs K above
``K_c = sqrt(8/pi) D`` for Gaussian w of s.d. D. At the rate of free applause it is below; who claps
half as fast has half the spread as well, and then order grows. People change between the two modes
by themselves:

    fast to slow   (seed + join q) a second     once they have clapped fast for their patience
    slow to fast   tire exp((u - stamina) / tire_width) + leave (1 - q)   a second, see below

with q the share of slow clappers among those heard. Slow clapping is less noise, and a common beat
leaves silence between the claps, which is what people miss (Neda et al. 2000): u counts the seconds
of slow clapping, each with 0.2 q + 0.8 |Z|. ``leave`` acts once u passed half of the stamina. Thus
rhythm comes, and goes, and comes again, as long as the applause lasts.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..crowd.agents import agent_ids
from .hearing import Hearing
from .rates import check_rates

_TURN = np.float32(2.0 * np.pi)
_SLOW_IS_QUIET = 0.2
"""Part of what people miss that is gone with slow clapping alone, without a common beat."""
_BATCH = 2048
"""Of more clappers than this, a part thinks about its mode in each step, for that much longer."""
_THINK_EVERY = 0.25
"""Seconds between the times at which fewer do."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RhythmRates:
    """Constants of the equations above; times in seconds, rates a second.

    Parameters
    ----------
    rate, variation
        Claps a second in free applause, and their coefficient of variation among people.
    coupling
        K.
    patience, patience_spread
        Mean and s.d. of how long people clap freely before a beat can carry them away.
    seed, join
        Halving one's rate by oneself, and because all others have.
    stamina, tire, tire_width
        Seconds of slow clapping after which people want noise again, how fast they then speed up,
        and how many seconds before it is e times rarer.
    leave
        Speeding up because all others have.
    """

    rate: float = 3.3
    variation: float = 0.08
    coupling: float = 2.3
    patience: float = 7.0
    patience_spread: float = 2.0
    seed: float = 0.02
    join: float = 1.5
    stamina: float = 10.0
    tire: float = 0.15
    tire_width: float = 2.0
    leave: float = 2.0

    def __post_init__(self) -> None:
        """Check every value."""
        check_rates(self, positive=("rate", "tire_width"))


class Rhythm:
    """The beats of a crowd.

    Parameters
    ----------
    hearing
        Who hears whom; for a whole crowd that hears itself, one group.
    rng
        Where the personal rates come from, and later what happens.
    rates
        Constants.

    Attributes
    ----------
    frequency
        (N,) float32 personal claps a second in free applause.
    phase
        (N,) float32 in turns, 0 to 1; hands meet at 0.
    rate
        (N,) float32 claps a second now: `frequency` or half of it. One array for good.
    is_slow
        (N,) bool.
    speed
        (N,) float32 turns a second of the last step, the pull of the others included.
    """

    def __init__(
        self, hearing: Hearing, rng: np.random.Generator, rates: RhythmRates = RhythmRates()
    ) -> None:
        count = len(hearing.group)
        self.hearing, self.rates = hearing, rates
        self._rng = rng
        drawn = np.clip(rng.standard_normal(count), -3.0, 3.0)
        self.frequency = (rates.rate * (1.0 + rates.variation * drawn)).astype(np.float32)
        self.phase = rng.random(count, np.float32)
        self.rate = self.frequency.copy()
        self.speed = self.frequency.copy()
        self.is_slow = np.zeros(count, bool)
        self._patience = np.maximum(
            rng.normal(rates.patience, rates.patience_spread, count), 0.5
        ).astype(np.float32)
        self._felt = np.zeros(count, np.float32)  # seconds in the mode; u in the slow one
        self._order = np.zeros(hearing.count, np.complex128)
        self._unthought = 0.0  # seconds for which few clappers have not thought about their mode

    @property
    def order(self) -> NDArray[np.complex128]:
        """(G,) mean field Z of the last step, as each group heard it; its size is 0 to 1."""
        return self._order

    def begin(self, agents: int | ArrayLike) -> None:
        """Agents begin to clap: at their own rate, and each at a moment of its own."""
        ids = agent_ids(agents, len(self.phase))
        self.phase[ids] = self._rng.random(len(ids), np.float32)
        self.is_slow[ids] = False
        self.rate[ids] = self.frequency[ids]
        self._felt[ids] = 0.0

    def step(self, active: NDArray[np.int64], dt: float) -> NDArray[np.int64]:
        """Advance the phases of those who clap.

        Parameters
        ----------
        active
            (K,) their ids, each once.
        dt
            Seconds, at most 0.1.

        Returns
        -------
        (C,) int64 ids of those whose hands met, in the order of `active`.
        """
        if not 0 < dt <= 0.1:
            raise ValueError(f"dt is {dt}, expected more than 0 and at most 0.1 seconds")
        if len(active) == 0:
            self._order[:] = 0.0
            return np.zeros(0, np.int64)
        if 2 * len(active) > len(self.phase):
            met = self._advance_all(active, dt)
        else:
            met = self._advance(active, dt)
        self._change_mode(active, dt)
        return met

    def _advance(self, active: NDArray[np.int64], dt: float) -> NDArray[np.int64]:
        """Few clap: their rows are picked."""
        hearing, group = self.hearing, self.hearing.group[active]
        phase = self.phase[active]
        angle = phase * _TURN
        cosine, sine = np.cos(angle), np.sin(angle)
        cosines, sines = (
            np.bincount(group, part, hearing.count).astype(np.float64) for part in (cosine, sine)
        )
        imaginary, real = self._field(hearing.counts(active).astype(np.float64), cosines, sines)
        speed = imaginary[group] * cosine - real[group] * sine + self.rate[active]
        self.speed[active] = speed
        phase += speed * np.float32(dt)
        self.phase[active] = phase - np.floor(phase)
        return active[phase >= 1.0]

    def _advance_all(self, active: NDArray[np.int64], dt: float) -> NDArray[np.int64]:
        """Most clap: whole columns are cheaper than picking.

        The phases of the others run on unseen; they are drawn anew when they begin.
        """
        hearing = self.hearing
        claps = np.zeros(len(self.phase), np.float32)
        claps[active] = 1.0
        angle = self.phase * _TURN
        cosine = np.cos(angle)
        sine = np.sin(angle, out=angle)
        cosines, sines = (hearing.sums(claps * part) for part in (cosine, sine))
        imaginary, real = (
            hearing.spread(part) for part in self._field(hearing.sums(claps), cosines, sines)
        )
        cosine *= imaginary
        sine *= real
        np.subtract(cosine, sine, out=self.speed)
        self.speed += self.rate
        self.phase += np.multiply(self.speed, np.float32(dt), out=sine)
        met = np.flatnonzero((self.phase >= 1.0) & (claps > 0.0))
        self.phase -= np.floor(self.phase, out=sine)
        return met

    def _field(
        self, claps: NDArray[np.float64], cosines: NDArray[np.float64], sines: NDArray[np.float64]
    ) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """(G,) K times the imaginary and the real part of Z, in turns a second."""
        hearing = self.hearing
        heard = hearing.heard(claps)
        real, imaginary = (
            hearing.heard(part) / np.maximum(heard, 1e-9) for part in (cosines, sines)
        )
        self._order = real + 1j * imaginary
        pull = self.rates.coupling / (2.0 * np.pi)
        return (pull * imaginary).astype(np.float32), (pull * real).astype(np.float32)

    def _change_mode(self, active: NDArray[np.int64], dt: float) -> None:
        """Some of the active halve or double their rate."""
        self._unthought += dt
        if len(active) <= _BATCH:  # all of them, now and then
            if self._unthought < _THINK_EVERY:
                return
            ids, seconds = active, np.float32(self._unthought)
            self._unthought = 0.0
        else:
            parts = 1 + len(active) // _BATCH
            ids = active[int(self._rng.integers(parts)) :: parts]
            seconds = np.float32(dt * parts)
            self._unthought = 0.0
        rates, group = self.rates, self.hearing.group[ids]
        slow = self.is_slow[ids]
        if self.hearing.count == 1:
            share = np.full(1, slow.mean(), np.float32)
        else:
            count = self.hearing.count
            heard = self.hearing.heard(np.bincount(group, minlength=count).astype(np.float64))
            heard_slow = self.hearing.heard(np.bincount(group, slow, count).astype(np.float64))
            share = (heard_slow / np.maximum(heard, 1e-9)).astype(np.float32)
        q = share[group]
        silence = np.abs(self._order).astype(np.float32)[group]
        quiet = np.float32(_SLOW_IS_QUIET) * q + np.float32(1.0 - _SLOW_IS_QUIET) * silence
        felt = self._felt[ids] + seconds * np.where(slow, quiet, np.float32(1.0))
        self._felt[ids] = felt
        faster = rates.tire * np.exp(np.minimum((felt - rates.stamina) / rates.tire_width, 4.0))
        faster += np.where(felt > 0.5 * rates.stamina, rates.leave * (1.0 - q), 0.0)
        slower = np.where(felt > self._patience[ids], rates.seed + rates.join * q, 0.0)
        hazard = np.where(slow, faster, slower)
        changes = ids[self._rng.random(len(ids), np.float32) < -np.expm1(-seconds * hazard)]
        self.is_slow[changes] ^= True
        self._felt[changes] = 0.0
        half = np.where(self.is_slow[changes], np.float32(0.5), np.float32(1.0))
        self.rate[changes] = self.frequency[changes] * half

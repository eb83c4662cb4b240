"""Applause as a contagion: who begins to clap, and who stops. Nobody schedules it.

Starting and stopping are hazards (Mann, Faria, Sumpter, Krause 2013, J. R. Soc. Interface 10:
20130466) behind a threshold of benefit and cost (Lupyan & Rifkin 2003). With I and R the clapping
and the lately stopped, as shares x = I/N and y = R/N of what is heard (R is heard as well: y is how
much less than lately x has become):

    start    [b > c1 + c2] r_i (alpha min(b, 1) + beta x)
    stop     s_i (gamma y + delta exp((c1 + c2 - b) / softness))
    c1     = theta_i max(1 - x / tipping, -pressure)     embarrassment; negative: of not clapping
    c2     = cost * (claps so far + weariness * earlier claps, which are forgotten with time)

Where more than `tipping` clap nobody is embarrassed any more, so everybody joins who does not
refuse (b < 0), even without a reason of his own: the 25 % rule of *Thesis* 3.1.4. A clapper who
hears nobody else stops within two claps. Who stopped rests, and his benefit is spent.

A quiet tick costs what a few candidates cost: a Poisson number of agents is drawn at the highest
hazard that anybody can have, and each is accepted with its own share of it, which is exact.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, log
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..crowd.agents import agent_ids, agent_values
from .hearing import Hearing
from .rates import check_rates

IDLE, CLAPPING, RESTING = 0, 1, 2

_BATCH = 16384
"""Of more clappers than this, a random part decides in each step, as much more readily."""
_MOST_PARTS = 6
"""Such parts, at most; a hazard of stopping above 30 / 6 a second, a rare one, counts as that."""
_FORGOTTEN = 0.01
"""Benefit of a cue below which nobody begins to clap for it any more."""
_LEAST_REST, _LOOK_EVERY = 0.4, 0.3
"""Shortest rest, of the mean one; and seconds between looks at whose rest is over."""
_UNANSWERED = 1.9
"""Claps after which one who hears nobody else has stopped."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ApplauseRates:
    """Constants of the equations above; times in seconds, rates a second.

    Parameters
    ----------
    alpha, beta
        Starting by oneself, and because all others clap. Half the room against a twentieth makes
        starting ``(alpha + beta / 2) / (alpha + beta / 20)`` times as likely.
    gamma, delta, softness
        Stopping because all others stopped, stopping when cost equals benefit, and how far below
        it stopping is e times rarer.
    cost
        What a clap costs, in units of the benefit of a good talk.
    theta, theta_spread
        Median of the personal thresholds, and the s.d. of their logarithm.
    spread
        Coefficient of variation of the personal factors r_i and s_i, which have mean 1.
    tipping, pressure
        Share of clappers at which embarrassment is gone, and how far it goes on falling.
    reaction
        From a cue to the first moment at which somebody can answer it.
    weariness, recovery
        Part of the cost of earlier claps that is felt, and the half-life of that.
    half_life
        Of a cue's benefit.
    memory
        How long people remember how loud it was.
    rest
        Mean time from stopping to being able to begin anew, without a new cue or any excitement.
    eagerness
        How much sooner excited people begin anew: ``1 + eagerness * ground`` times.
    """

    alpha: float = 0.04
    beta: float = 9.0
    gamma: float = 2.1
    delta: float = 0.25
    softness: float = 0.4
    cost: float = 0.072
    theta: float = 0.5
    theta_spread: float = 0.5
    spread: float = 0.3
    tipping: float = 0.22
    pressure: float = 1.0
    reaction: float = 0.2
    weariness: float = 0.5
    recovery: float = 30.0
    half_life: float = 20.0
    memory: float = 15.0
    rest: float = 10.0
    eagerness: float = 10.0

    def __post_init__(self) -> None:
        """Check every value."""
        check_rates(
            self, positive=("softness", "spread", "tipping", "half_life", "memory", "recovery")
        )


class ApplauseChange(NamedTuple):
    """Ids of the agents that began and that stopped clapping in a step, both ascending."""

    started: NDArray[np.int64]
    stopped: NDArray[np.int64]


class Applause:
    """The applause of a crowd.

    Parameters
    ----------
    hearing
        Who hears whom, and who is there.
    rng
        Where the personal factors come from, and later what happens.
    clap_rate
        (N,) float32 claps a second, kept by reference: pass `Rhythm.rate`. A number serves all.
    rates
        Constants.

    Attributes
    ----------
    state
        (N,) uint8 `IDLE`, `CLAPPING` or `RESTING`.
    readiness, reluctance
        (N,) float32 r_i and s_i.
    threshold
        (N,) float32 theta_i: multiply it to make a crowd shyer.
    ground
        (N,) float32 benefit without a cue, from excitement, say. Below 0 the agent refuses.
    active
        (K,) int64 ids of the clapping agents, ascending.
    """

    def __init__(
        self,
        hearing: Hearing,
        rng: np.random.Generator,
        clap_rate: NDArray[np.float32] | float = 3.3,
        rates: ApplauseRates = ApplauseRates(),
    ) -> None:
        count = len(hearing.group)
        self.hearing, self.rates = hearing, rates
        self._rng = rng
        self._rate = np.broadcast_to(np.asarray(clap_rate, np.float32), (count,))
        shape = 1.0 / rates.spread**2
        self.readiness = (rng.standard_gamma(shape, count) / shape).astype(np.float32)
        self.reluctance = (rng.standard_gamma(shape, count) / shape).astype(np.float32)
        drawn = rng.standard_normal(count)
        self.threshold = (rates.theta * np.exp(rates.theta_spread * drawn)).astype(np.float32)
        self.ground = np.zeros(count, np.float32)
        self.state = np.where(hearing.present, IDLE, RESTING).astype(np.uint8)
        self.active = np.zeros(0, np.int64)
        self._benefit = np.zeros(count, np.float32)
        self._since = np.zeros(count, np.float64)  # of the cue
        self._until_seen = np.zeros(count, np.float32)  # benefit before: what was left of another
        self._begin = np.zeros(count, np.float64)  # of the clapping
        self._earlier = np.zeros(count, np.float32)  # claps felt at the end of the last clapping
        self._end = np.zeros(count, np.float64)  # of that
        self._wake = np.full(count, np.inf)  # from which on a resting agent is idle
        self._look = 0.0  # when to look whose rest is over
        self._clapping_of = np.zeros(hearing.count)
        self._loudest = np.zeros(hearing.count)  # share heard lately
        self._answered = np.full(hearing.count, -np.inf)  # when each group last heard two
        self._now = 0.0
        self._highest = (0.0, 0.0)  # bound of all cues' benefits, and since when

    @property
    def share(self) -> float:
        """Share of those present that are clapping."""
        return len(self.active) / max(float(self.hearing.sizes.sum()), 1.0)

    def cue(self, agents: int | ArrayLike, benefit: float | ArrayLike) -> None:
        """Something worth clapping for, once they have seen it, unless more is left of another cue.

        Parameters
        ----------
        agents
            Ids or a mask. Whoever rests is ready again.
        benefit
            One or (K,) values: 1 is a good talk, 0 nothing at all, negative values refuse.
        """
        ids = agent_ids(agents, len(self.state))
        values = agent_values("benefit", benefit, len(ids), -np.inf, np.inf)
        keep = self.hearing.present[ids]
        ids, values = ids[keep], values[keep]
        if len(ids) == 0:
            return
        self._wake_up(np.unique(ids[self.state[ids] == RESTING]))
        seen = self._now + self.rates.reaction
        left = self._left(ids)
        new = (values > self._promised(left, ids)) | (values < 0.0)
        ids, values, left = ids[new], values[new], left[new]
        self._until_seen[ids] = np.maximum(left, 0.0)
        self._benefit[ids] = values
        self._since[ids] = np.where(values < 0.0, self._now, seen)  # nobody refuses too late
        self._highest = (max(self._bound(), float(values.max(initial=0.0))), seen)

    def cue_crowd(
        self,
        who: NDArray[np.bool_],
        benefit: NDArray[np.float32] | float,
        *,
        refuse: bool = False,
        ago: float = 0.0,
    ) -> None:
        """`cue` for much of the crowd at once, of what happened `ago` seconds before now.

        `who` (N,) is whom it concerns; `benefit` one for all or (N,), finite, and nothing is read
        of others; `refuse` says whether it is below 0, for all of them.
        """
        who = who & self.hearing.present
        self._wake_up(np.flatnonzero(who & (self.state == RESTING)))
        highest = float(np.max(benefit))
        if highest == 0.0 and not refuse:
            who &= self._benefit < 0.0  # it ends a refusal, and nothing else
        if not who.any():
            return
        seen = self._now - ago + self.rates.reaction
        before = np.zeros(1, np.float32)
        if self._bound() > 0.0 and not refuse:
            left = self._left()
            who &= benefit > self._promised(left)
            before = np.maximum(left, np.float32(0.0))
        np.copyto(self._until_seen, before, where=who)
        np.copyto(self._benefit, benefit, where=who, casting="same_kind")
        np.copyto(self._since, self._now if refuse else seen, where=who)
        self._highest = (max(self._bound(), highest), seen)

    def start(self, agents: int | ArrayLike) -> None:
        """Let agents clap from now on, whatever they think of it; absent ones don't."""
        ids = np.unique(agent_ids(agents, len(self.state)))
        ids = ids[self.hearing.present[ids] & (self.state[ids] != CLAPPING)]
        self._wake_up(ids[self.state[ids] == RESTING])
        self._begin_clapping(ids)

    def stop(self, agents: int | ArrayLike) -> None:
        """Let agents stop now; they rest."""
        ids = np.unique(agent_ids(agents, len(self.state)))
        ids = ids[self.state[ids] == CLAPPING]
        self._stop_clapping(ids)

    def admit(self, agents: NDArray[np.int64], present: bool) -> None:
        """Let agents (K,) ids be there from now on, or no longer; who goes stops clapping."""
        if present:
            self._wake_up(agents[self.state[agents] == RESTING])
        else:
            self.stop(agents)
            self.state[agents], self._wake[agents] = RESTING, np.inf
        self.hearing.admit(agents, present)

    def heard(self) -> NDArray[np.float64]:
        """(G,) share of the clapping that each group hears, x of the equations."""
        return self.hearing.share(self._clapping_of)

    def benefit(self, agents: NDArray[np.int64]) -> NDArray[np.float32]:
        """(K,) benefit b of agents now: ground and what is left of a cue; below 0 they refuse."""
        left = self._left(agents)
        return np.where(left < 0, left, left + self.ground[agents])

    def step(self, dt: float) -> ApplauseChange:
        """Advance by `dt` seconds, less than a clap; a pose tick is best (1/30 s)."""
        if not 0 < dt <= 0.2:
            raise ValueError(f"dt is {dt}, expected more than 0 and at most 0.2 seconds")
        self._now += dt
        self._end_rests()
        clapping = self.heard()
        self._loudest = np.maximum(clapping, self._loudest * exp(-dt / self.rates.memory))
        self._answered[self.hearing.heard(self._clapping_of) >= 2.0] = self._now
        stopped = self._stops(dt, clapping)
        started = self._starts(dt, clapping)
        if len(stopped):
            self._stop_clapping(stopped)
        if len(started):
            self._begin_clapping(started)
        return ApplauseChange(started, stopped)

    def _left(self, agents: NDArray[np.int64] | slice = slice(None)) -> NDArray[np.float32]:
        """(K,) what is left of the cue; below 0 it doesn't fade."""
        age = (self._now - self._since[agents]).astype(np.float32)
        cue = np.where(age >= 0.0, self._benefit[agents], self._until_seen[agents])
        # exp of float32 is several times as fast as exp2.
        fading = np.exp(np.multiply(age, np.float32(-log(2.0) / self.rates.half_life), out=age))
        return np.where(cue < 0, cue, np.multiply(cue, fading, out=fading))

    def _promised(
        self, left: NDArray[np.float32], agents: NDArray[np.int64] | slice = slice(None)
    ) -> NDArray[np.float32]:
        """(K,) what is left, or what it will be once the cue has been seen, if that is more."""
        coming = np.maximum(left, self._benefit[agents])
        return np.where(self._since[agents] > self._now, coming, left)

    def _bound(self) -> float:
        """At least the benefit that any cue still has."""
        value, since = self._highest
        left = value * exp(-0.6931 * max(self._now - since, 0.0) / self.rates.half_life)
        return left if left > _FORGOTTEN else 0.0

    def _starts(self, dt: float, clapping: NDArray[np.float64]) -> NDArray[np.int64]:
        """Ids that begin: by candidates where few can, else by asking all that are idle."""
        rates, count = self.rates, len(self.state)
        loudest = float(clapping.max())
        if loudest <= rates.tipping and self._bound() <= 0.0 and self.ground.max() <= 0.0:
            return np.zeros(0, np.int64)
        bound = float(self.readiness.max()) * (rates.alpha + rates.beta * loudest)
        if bound * dt < 0.125:
            ids = self._rng.integers(0, count, self._rng.poisson(count * bound * dt))
            ids = ids[self.state[ids] == IDLE]
            accepted = self._rng.random(len(ids)) * bound < self._start_hazard(ids, clapping)
            candidates: NDArray[np.int64] = np.unique(ids[accepted])
            return candidates
        idle = np.flatnonzero(self.state == IDLE)
        chance = -np.expm1(-np.float32(dt) * self._start_hazard(idle, clapping))
        begins: NDArray[np.int64] = idle[self._rng.random(len(idle), np.float32) < chance]
        return begins

    def _stops(self, dt: float, clapping: NDArray[np.float64]) -> NDArray[np.int64]:
        """Ids that stop: because they have had enough, or because nobody joined them."""
        if len(self.active) == 0:
            return self.active
        parts = min(1 + len(self.active) // _BATCH, _MOST_PARTS)
        part, count = int(self._rng.integers(parts)), len(self.active)
        ids = self.active[part * count // parts : (part + 1) * count // parts]
        chance = np.float32(-parts) * np.expm1(-np.float32(dt) * self._stop_hazard(ids, clapping))
        tired: NDArray[np.int64] = ids[self._rng.random(len(ids), np.float32) < chance]
        is_lonely = (self._clapping_of > 0) & (self._answered < self._now)
        if not is_lonely.any():
            return tired
        lonely = self.active[is_lonely[self.hearing.group[self.active]]]
        since = np.maximum(self._begin[lonely], self._answered[self.hearing.group[lonely]])
        alone = (self._now - since) * self._rate[lonely]
        both: NDArray[np.int64] = np.union1d(tired, lonely[alone >= _UNANSWERED])
        return both

    def _start_hazard(
        self, ids: NDArray[np.int64], clapping: NDArray[np.float64]
    ) -> NDArray[np.float32]:
        rates, group = self.rates, self.hearing.group[ids]
        x = clapping.astype(np.float32)[group]
        benefit = self.benefit(ids)
        burden = self.threshold[ids] * self._embarrassment(clapping)[group]
        burden += np.float32(rates.cost) * self._earlier_claps(ids)
        is_open = (benefit > burden) & (benefit >= 0.0)
        own = np.float32(rates.alpha) * np.clip(benefit, 0.0, 1.0)
        hazard: NDArray[np.float32] = is_open * self.readiness[ids] * (own + rates.beta * x)
        return hazard

    def _stop_hazard(
        self, ids: NDArray[np.int64], clapping: NDArray[np.float64]
    ) -> NDArray[np.float32]:
        rates, group = self.rates, self.hearing.group[ids]
        stopped = (rates.gamma * (self._loudest - clapping)).astype(np.float32)
        claps = (self._now - self._begin[ids]).astype(np.float32) * self._rate[ids]
        claps += self._earlier_claps(ids)
        excess = self.threshold[ids] * self._embarrassment(clapping)[group]
        excess += np.float32(rates.cost) * claps
        excess -= self.benefit(ids)
        own = rates.delta * np.exp(np.minimum(excess * np.float32(1.0 / rates.softness), 5.0))
        hazard: NDArray[np.float32] = self.reluctance[ids] * (stopped[group] + own)
        return hazard

    def _earlier_claps(self, ids: NDArray[np.int64]) -> NDArray[np.float32]:
        """(K,) claps before the present ones that still count."""
        age = (self._now - self._end[ids]).astype(np.float32)
        left: NDArray[np.float32] = self._earlier[ids]
        left *= np.exp2(age * np.float32(-1.0 / self.rates.recovery))
        return left

    def _embarrassment(self, clapping: NDArray[np.float64]) -> NDArray[np.float32]:
        """(G,) c1 over theta."""
        falling = np.maximum(1.0 - clapping / self.rates.tipping, -self.rates.pressure)
        return falling.astype(np.float32)

    def _begin_clapping(self, ids: NDArray[np.int64]) -> None:
        self.state[ids] = CLAPPING
        self._begin[ids] = self._now
        self._clapping_of += self.hearing.counts(ids)
        self._find_active()

    def _stop_clapping(self, ids: NDArray[np.int64]) -> None:
        self.state[ids] = RESTING
        self._find_active()
        self._clapping_of -= self.hearing.counts(ids)
        claps = (self._now - self._begin[ids]).astype(np.float32) * self._rate[ids]
        self._earlier[ids] = self._earlier_claps(ids) + np.float32(self.rates.weariness) * claps
        self._end[ids] = self._now
        self._benefit[ids] = np.minimum(self._benefit[ids], 0.0)
        rest = self._rng.standard_exponential(len(ids)) * (1.0 - _LEAST_REST) + _LEAST_REST
        rest *= self.rates.rest / (1.0 + self.rates.eagerness * np.maximum(self.ground[ids], 0.0))
        self._wake[ids] = self._now + rest

    def _find_active(self) -> None:
        self.active = np.flatnonzero(self.state == CLAPPING)

    def _wake_up(self, ids: NDArray[np.int64]) -> None:
        self.state[ids] = IDLE
        self._wake[ids] = np.inf

    def _end_rests(self) -> None:
        if self._now < self._look:
            return
        self._look = self._now + _LOOK_EVERY
        over = np.flatnonzero(self._wake <= self._now)
        if len(over):
            self._wake_up(over)

"""Applause: each published figure is measured on crowds that clap, not read off constants."""

from __future__ import annotations

import numpy as np
import pytest

from tifo.benchmarks.experiments import TICK, applaud, clap_from_share, starting_rate
from tifo.engine.behaviour.applause import CLAPPING, IDLE, RESTING, Applause, ApplauseRates
from tifo.engine.behaviour.hearing import Hearing
from tifo.engine.crowd.bowl import build_bowl


def rooms(count: int, people: int) -> Hearing:
    return Hearing(np.repeat(np.arange(count), people))


def test_small_groups_clap_like_those_of_the_study(rng: np.random.Generator) -> None:
    # Mann et al. 2013: 13 to 20 people, first clap after 2.1 s, first to last clap 6.1 s.
    bouts = applaud(rng.integers(13, 21, 1500), 1.0, rng)
    assert bouts.first.mean() == pytest.approx(2.1, abs=0.2)
    assert bouts.length.mean() == pytest.approx(6.1, abs=0.35)
    assert bouts.proportion > 0.97
    # Up within a second, down much more slowly; most people clap some ten times.
    rise = (bouts.all_started - bouts.first).mean()
    fall = (bouts.last - bouts.first_stop).mean()
    assert rise < 1.2
    assert fall > 2.0 * rise
    low, high = np.percentile(bouts.claps, [25, 75])
    assert 8 < low < high < 19
    # The same talk gets short and long applause, by chance.
    assert bouts.length.std() > 0.7


@pytest.mark.slow
def test_many_clappers_stop_no_later_than_few(rng: np.random.Generator) -> None:
    """Of many clappers a part decides at a time; each stops as it would in a room by itself."""
    few = np.concatenate([applaud(rng.integers(13, 21, 400), 1.0, rng).length for _ in range(12)])
    many = applaud(rng.integers(13, 21, 5000), 1.0, rng).length
    # Standard errors of 0.02 s; deciding for so much longer instead takes 0.25 s more.
    assert many.mean() == pytest.approx(few.mean(), abs=0.1)


@pytest.mark.parametrize("crowd", [False, True])
def test_another_cue_counts_as_soon_as_it_is_seen(crowd: bool, rng: np.random.Generator) -> None:
    """And until then what is left of the one before, of which a smaller one takes nothing."""
    applause = Applause(rooms(3, 2), rng)
    everyone = np.arange(6)

    def cue(benefit: float) -> None:
        if crowd:
            applause.cue_crowd(np.ones(6, np.bool_), benefit, refuse=benefit < 0)
        else:
            applause.cue(everyone, benefit)

    def after(ticks: int) -> float:
        for _ in range(ticks):
            applause.step(TICK)
        return float(applause.benefit(everyone)[0])

    applause.state[:] = RESTING  # so that nobody claps; cues wake them
    cue(0.4)
    assert after(1) == 0.0
    assert after(29) == pytest.approx(0.4 * 0.5 ** (0.8 / 20.0), rel=1e-3)
    cue(0.1)
    assert after(1) == pytest.approx(0.4 * 0.5 ** (0.8 / 20.0), rel=5e-3)
    cue(0.45)
    assert after(3) == pytest.approx(0.4 * 0.5 ** (0.8 / 20.0), rel=2e-2)
    assert after(6) == pytest.approx(0.45, rel=1e-2)
    cue(0.6)
    cue(0.5)  # at the same time
    assert after(3) == pytest.approx(0.45, rel=2e-2)
    assert after(6) == pytest.approx(0.6, rel=1e-2)
    cue(-1.0)
    assert after(1) == -1.0
    cue(0.0)
    assert after(1) == 0.0
    assert after(9) == 0.0


def test_starting_is_ten_times_as_likely_with_half_the_room(rng: np.random.Generator) -> None:
    shares = np.array([0.05, 0.1, 0.2, 0.35, 0.5])
    rates = np.array([starting_rate(float(share), 600_000, rng) for share in shares])
    assert rates[-1] / rates[0] == pytest.approx(10.0, rel=0.12)
    # Linear in the share: no tipping point in who answers a good talk.
    line = np.polyval(np.polyfit(shares, rates, 1), shares)
    np.testing.assert_allclose(rates, line, rtol=0.05)


def test_nobody_has_to_sit_near(rng: np.random.Generator) -> None:
    """In one room, who is far from the clappers starts as soon as who sits among them."""
    applause = Applause(Hearing(np.zeros(60_000, int)), rng)
    applause.cue(np.arange(60_000), 2.0)
    for _ in range(7):
        applause.stop(applause.step(TICK).started)
    applause.start(np.arange(6000))
    started = applause.step(TICK).started
    near = np.count_nonzero(started < 33_000)
    assert near / len(started) == pytest.approx(0.5, abs=0.05)


def test_spontaneous_starts_come_at_their_rate(rng: np.random.Generator) -> None:
    """The candidates of quiet ticks are as many as asking everybody would give."""
    rates = ApplauseRates(reaction=0.0)
    applause = Applause(rooms(60_000, 1), rng, rates=rates)
    applause.cue(np.arange(60_000), 0.5)
    expected, started = 0.0, 0
    for _ in range(30):
        benefit = applause.benefit(np.arange(60_000))
        willing = (applause.state == IDLE) & (benefit > applause.threshold)
        hazard = applause.readiness[willing] * rates.alpha * benefit[willing]
        expected += float(-np.expm1(-hazard * TICK).sum())
        started += len(applause.step(TICK).started)
    assert started == pytest.approx(expected, abs=4.0 * float(np.sqrt(expected)))


def test_a_quarter_carries_the_crowd_away_and_less_does_not(rng: np.random.Generator) -> None:
    hearing = Hearing.of_sections(build_bowl(20_000))
    many = clap_from_share(hearing, 0.26, 3.0, rng)
    assert many.max() >= 0.9
    assert clap_from_share(hearing, 0.15, 3.0, rng)[10:].max() < 0.15


def test_an_unanswered_clapper_stops_within_two_claps(rng: np.random.Generator) -> None:
    applause = Applause(rooms(3000, 16), rng, clap_rate=3.0)
    applause.ground[:] = 5.0  # likes it very much, but the others have left the room
    applause.state[np.arange(48_000) % 16 > 0] = RESTING
    applause.start(np.arange(0, 48_000, 16))
    for _ in range(20):
        applause.step(TICK)
    assert not np.isin(np.arange(0, 48_000, 16), applause.active).any()


def test_an_answered_clapper_goes_on(rng: np.random.Generator) -> None:
    applause = Applause(rooms(2000, 2), rng, clap_rate=3.0)
    applause.ground[:] = 5.0
    applause.start(np.arange(4000))
    for _ in range(20):
        applause.step(TICK)
    assert applause.share > 0.95


def test_others_stopping_counts_the_same_after_any_number_of_claps() -> None:
    """Social stopping adds to the reluctance to go on; it does not depend on it."""
    excess = []
    for ticks in (6, 60):
        rates = []
        for stopping in (0.0, 0.4):
            rng = np.random.default_rng(5)
            applause = Applause(rooms(800, 100), rng)
            applause.ground[:] = 2.0
            applause.start(np.arange(80_000))
            for _ in range(ticks):
                applause.start(applause.step(TICK).stopped)
            place = np.arange(80_000) % 100
            applause.stop(place < 100 * stopping)
            clapping = len(applause.active)
            stopped = sum(len(applause.step(TICK).stopped) for _ in range(6))
            rates.append(stopped / clapping / (6 * TICK))
        excess.append(rates[1] - rates[0])
    assert excess[0] == pytest.approx(0.4 * ApplauseRates().gamma, rel=0.25)
    assert excess[1] == pytest.approx(excess[0], rel=0.25)


def test_more_impressive_is_clapped_by_all_and_then_for_longer(rng: np.random.Generator) -> None:
    benefits = (0.1, 0.3, 0.5, 1.0, 2.0, 3.0)
    bouts = [applaud(rng.integers(13, 21, 300), benefit, rng) for benefit in benefits]
    shares = [b.proportion for b in bouts]
    assert shares[0] < 0.01
    assert shares[1] < 0.3
    assert shares[2] > 0.5
    assert min(shares[3:]) > 0.97  # a threshold, then saturated
    lengths = [b.length.mean() for b in bouts[1:]]
    assert (np.diff(lengths) > 0).all()
    assert lengths[-1] > 1.5 * lengths[-3]


def test_a_stadium_rises_faster_than_it_falls(rng: np.random.Generator) -> None:
    applause = Applause(Hearing.of_sections(build_bowl(20_000)), rng)
    applause.cue(np.arange(20_000), 3.0)
    curve = np.array([(applause.step(TICK), applause.share)[1] for _ in range(450)])
    top = int(curve.argmax())
    rise = top - np.flatnonzero(curve > 0.1)[0]
    begin = np.flatnonzero(curve > 0.9)
    fall = np.flatnonzero(curve > 0.1)[-1] - begin[-1]
    assert np.count_nonzero(curve[:top] < 0.9) * TICK < 1.6  # reaction, first claps and rise
    assert curve.max() > 0.98
    assert fall > 1.5 * (begin[0] - np.flatnonzero(curve > 0.1)[0]) > 0
    assert rise > 0
    assert curve[-1] < 0.02


@pytest.mark.parametrize("ground", [0.0, 0.1, 0.2])
def test_applause_ends_and_leaves_nothing_behind(ground: float, rng: np.random.Generator) -> None:
    """A crowd in good mood that was carried away is as quiet again as it was before."""
    applause = Applause(Hearing.of_sections(build_bowl(8000)), rng)
    applause.ground[:] = ground
    quiet = max((applause.step(TICK), applause.share)[1] for _ in range(300))
    applause.cue(np.arange(8000), 3.0)
    curve = np.array([(applause.step(TICK), applause.share)[1] for _ in range(4500)])
    assert curve.max() > 0.97
    assert curve[900:].mean() < 0.01
    assert curve[-600:].max() < quiet + 0.01


def test_people_tire_and_recover(rng: np.random.Generator) -> None:
    """The same talk again is clapped for less long at once, and as long after some minutes."""

    def claps(applause: Applause) -> float:
        applause.cue(np.arange(6000), 1.0)
        total = 0.0
        for _ in range(600):
            applause.step(TICK)
            total += applause.share * TICK
        return total

    applause = Applause(rooms(300, 20), rng)
    first, second = claps(applause), claps(applause)
    for _ in range(7200):
        applause.step(TICK)
    later = claps(applause)
    assert second < 0.9 * first
    assert later == pytest.approx(first, rel=0.06)


def test_who_refuses_never_claps(rng: np.random.Generator) -> None:
    applause = Applause(Hearing(np.zeros(2000, int)), rng)
    applause.ground[:] = 3.0
    applause.cue(np.arange(0, 1000), 2.0)
    applause.cue(np.arange(1000, 2000), -1.0)
    clapped = set()
    for _ in range(300):
        clapped |= set(applause.step(TICK).started.tolist())
    assert len(clapped) > 950
    assert max(clapped) < 1000


def test_the_absent_never_clap(rng: np.random.Generator) -> None:
    present = np.arange(2000) % 2 == 0
    applause = Applause(Hearing(np.zeros(2000, int), present), rng)
    applause.cue(np.arange(2000), 2.0)
    applause.start(np.arange(2000))
    for _ in range(450):
        applause.step(TICK)
        assert present[applause.active].all()
    assert applause.share <= 1.0


def test_nobody_can_react_before_the_reaction_time(rng: np.random.Generator) -> None:
    applause = Applause(Hearing(np.zeros(50_000, int)), rng)
    applause.cue(np.arange(50_000), 3.0)
    starts = [len(applause.step(TICK).started) for _ in range(10)]
    assert sum(starts[:5]) == 0
    assert sum(starts[6:]) > 0


def test_counts_hold_together_and_a_new_cue_wakes_who_rests(rng: np.random.Generator) -> None:
    applause = Applause(rooms(100, 50), rng)
    for _ in range(3):
        applause.cue(np.arange(5000), 1.5)
        assert not (applause.state == RESTING).any()
        for _ in range(60):
            applause.step(TICK)
            np.testing.assert_array_equal(
                applause.active, np.flatnonzero(applause.state == CLAPPING)
            )
        shares = np.bincount(np.arange(5000) // 50, applause.state == CLAPPING) / 50
        np.testing.assert_allclose(applause.heard(), shares)
    for _ in range(900):
        applause.step(TICK)
    assert np.mean(applause.state == IDLE) > 0.97  # rests are of many lengths


def test_a_crowd_without_reasons_is_silent_and_draws_nothing(rng: np.random.Generator) -> None:
    applause = Applause(Hearing(np.zeros(1000, int)), rng)
    before = rng.bit_generator.state
    for _ in range(50):
        change = applause.step(TICK)
        assert len(change.started) == len(change.stopped) == 0
    assert rng.bit_generator.state == before


def test_the_same_seed_gives_the_same_applause() -> None:
    runs = []
    for _ in range(2):
        applause = Applause(rooms(40, 50), np.random.default_rng(4))
        applause.cue(np.arange(2000), 1.0)
        runs.append([applause.step(TICK) for _ in range(200)])
    for one, other in zip(*runs, strict=True):
        np.testing.assert_array_equal(one.started, other.started)
        np.testing.assert_array_equal(one.stopped, other.stopped)


def test_wrong_arguments_are_named(rng: np.random.Generator) -> None:
    applause = Applause(rooms(2, 3), rng)
    with pytest.raises(ValueError, match="benefit"):
        applause.cue([0, 1], np.nan)
    with pytest.raises(ValueError, match="no agent 6"):
        applause.start(6)
    for dt in (0.0, 0.5, np.nan):
        with pytest.raises(ValueError, match="dt is"):
            applause.step(dt)
    applause.cue([], 1.0)
    applause.start([])
    with pytest.raises(ValueError, match="beta is nan"):
        ApplauseRates(beta=float("nan"))
    with pytest.raises(ValueError, match="softness is 0"):
        ApplauseRates(softness=0)


def test_cueing_much_of_a_crowd_does_what_cueing_ids_does(rng: np.random.Generator) -> None:
    present = np.arange(600) % 7 != 0
    who = np.arange(600) % 3 != 0
    benefit = rng.random(600, np.float32)
    hearing = Hearing(np.zeros(600, np.int32), present)
    one, other = (Applause(hearing, np.random.default_rng(5)) for _ in range(2))
    for applause in (one, other):
        applause.start(np.arange(0, 600, 5))
        applause.stop(np.arange(0, 600, 10))
    one.cue(who, benefit[who])
    other.cue_crowd(who, benefit)
    for _ in range(90):
        for a, b in zip(one.step(1 / 30), other.step(1 / 30), strict=True):
            np.testing.assert_array_equal(a, b)
    assert one.share > 0.5
    other.cue_crowd(who, -1.0, refuse=True)
    there = np.flatnonzero(who & present)
    assert (other.benefit(there) == -1.0).all()


def test_who_goes_stops_and_neither_claps_nor_counts_until_he_is_back(
    rng: np.random.Generator,
) -> None:
    applause = Applause(Hearing(np.zeros(40, int)), rng)
    gone = np.arange(20)
    applause.cue(np.arange(40), 3.0)
    applause.start(np.arange(10))
    applause.admit(gone, present=False)
    assert len(applause.active) == 0
    applause.start(gone)
    applause.cue(gone, 3.0)
    heard, who = 0.0, set[int]()
    for _ in range(round(20 / TICK)):
        applause.step(TICK)
        heard = max(heard, float(applause.heard()[0]))
        who |= {*applause.active.tolist()}
    assert who <= {*range(20, 40)}
    assert len(who) > 15
    assert heard > 0.8, "of those who are left"
    applause.admit(gone, present=True)
    applause.cue(np.arange(40), 3.0)
    for _ in range(round(6 / TICK)):
        applause.step(TICK)
        who |= {*applause.active.tolist()}
    assert len(who) > 35

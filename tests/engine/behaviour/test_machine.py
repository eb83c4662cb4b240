"""The state machine of a crowd: legal states, time limits, efforts, robust and rapid changes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tifo.engine.behaviour import BallHit, Event, Goal, load_table, table_from_toml
from tifo.engine.behaviour.machine import wake
from tifo.engine.behaviour.table import BehaviourTable, Rule, State, Variant
from tifo.engine.crowd.motions import Role

CHOICE = """\
[states.hub]
pieces = [1, 1]
[states.easy]
[states.hard]
[[rules]]
from = "hub"
to = "easy"
effort = 1.0
[[rules]]
from = "hub"
to = "hard"
effort = 3.0
[[rules]]
from = ["easy", "hard"]
to = "hub"
"""


def _edges(table: BehaviourTable) -> set[tuple[str, str]]:
    found = {(rule.origin, rule.target) for rule in table.rules}
    found |= {(state.name, state.leave_to) for state in table.states if state.leave_to}
    return found | {(state.name, state.name) for state in table.states}


@given(
    name=st.sampled_from(["sport", "rock_concert", "classical_concert", "speech"]),
    seed=st.integers(0, 2**32 - 1),
    events=st.lists(
        st.tuples(
            st.integers(1, 250),
            st.sampled_from(["goal", "near_miss", "card", "cue", "anthem", "ball", "half_time"]),
            st.integers(0, 1),
            st.floats(0.0, 1.0),
        ),
        max_size=6,
    ),
    embarrassment=st.floats(0.0, 1.0),
)
@settings(
    max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_everyone_is_always_in_a_legal_state_and_never_for_too_long(
    make_crowd: Any, name: str, seed: int, events: Any, embarrassment: float
) -> None:
    crowd = make_crowd(name, count=80, seed=seed, embarrassment=embarrassment)
    table, b = crowd.table, crowd.behaviour
    edges = _edges(table.table)
    machines = np.arange(len(table.starts))[:, None]
    before = b.state.copy()
    for tick in range(1, 300):
        for when, kind, side, weight in events:
            if when == tick:
                place = (5.0, 1.0, 0.0)
                crowd.answer(BallHit(place) if kind == "ball" else Event(kind, side, weight))
        crowd.run()
        assert (table.machine[b.state] == machines).all()
        for machine, agent in zip(*np.nonzero(b.state != before), strict=True):
            way = (table.names[before[machine, agent]], table.names[b.state[machine, agent]])
            assert way in edges
        age = tick - b.entered
        assert (age >= 0).all()
        assert (age <= table.limit[b.state]).all()
        assert (b.until > tick).all()
        assert ((b.variant >= 0) & (b.variant < 4)).all()
        assert ((b.motion[0] >= 0) & (b.motion[0] < len(crowd.library.names))).all()
        for channel, names in ((b.arms, table.arms_names), (b.head, table.head_names)):
            assert ((channel >= 0) & (channel < len(names))).all()
        before = b.state.copy()


def test_the_reference_goes_from_start_over_sit_to_turning_or_standing(make_crowd: Any) -> None:
    crowd = make_crowd(settled=False)
    assert crowd.doing("start").all()
    crowd.run()
    assert crowd.doing("sit").all()
    left = np.zeros(len(crowd.present), bool)
    for _ in range(1000):
        before = crowd.doing("sit")
        crowd.run()
        left |= before & ~crowd.doing("sit")
        assert crowd.doing("sit", "turn_left", "turn_right", "stand").all()
    assert left.all()


def test_an_event_of_the_own_side_goes_by_the_arms_and_back(make_crowd: Any) -> None:
    crowd = make_crowd(embarrassment=0.0)
    home = crowd.supporters(0)
    crowd.behaviour.until[0] = 10**6  # nobody moves for another reason
    crowd.behaviour.state[0] = crowd.table.number("stand")
    crowd.answer(Goal(0, weight=0.5))
    paths: list[list[str]] = [[] for _ in home]
    for _ in range(200):
        crowd.run()
        for path, state in zip(paths, crowd.behaviour.state[0, home], strict=True):
            name = crowd.table.names[state]
            if not path or path[-1] != name:
                path.append(name)
    moved = [path for path in paths if len(path) > 1]
    assert len(moved) > 0.95 * len(home)
    loud = [path[2] for path in moved]
    for path in moved:
        assert path == ["stand", "arm_up", path[2], "arm_down", "stand"]
    assert set(loud) == {"clap", "cheer"}
    assert loud.count("clap") / len(loud) == pytest.approx(0.5, abs=0.04)


def test_effort_makes_a_way_rarer(make_crowd: Any) -> None:
    crowd = make_crowd(table_from_toml(CHOICE))
    b, counts = crowd.behaviour, {"easy": 0, "hard": 0}
    for _ in range(30):
        crowd.run(10)
        for name in counts:
            counts[name] += int((b.state[0] == crowd.table.number(name)).sum())
    # About 60,000 choices of one in four: three standard deviations are 0.005.
    assert counts["hard"] / sum(counts.values()) == pytest.approx(1 / 4, abs=0.007)


def test_effort_makes_a_variant_rarer_and_excitement_spreads_them(make_crowd: Any) -> None:
    variants = (
        Variant(("cheer",), 1.0),
        Variant(("cheer_2",), 1.0, 0.3),
        Variant(("wave",), 2.0, 0.6),
        Variant(("clap",), 4.0, 0.9),
    )
    table = BehaviourTable(
        "loud",
        (State("calm"), State("loud", role=Role.CHEER, variants=variants)),
        (Rule("calm", "loud"), Rule("loud", "calm")),
    )
    for excitement, expected in (
        (0.1, [1.0, 0.0, 0.0, 0.0]),
        (0.4, [1 / 2, 1 / 2, 0.0, 0.0]),
        (0.7, [2 / 5, 2 / 5, 1 / 5, 0.0]),
        (1.0, [4 / 11, 4 / 11, 2 / 11, 1 / 11]),
    ):
        crowd = make_crowd(table, seed=5)
        crowd.emotion.excitement[:] = excitement
        found = np.zeros(4)
        crowd.run(20)  # what was begun before is over
        for _ in range(10):
            crowd.run(10)
            loud = crowd.doing("loud")
            found += np.bincount(crowd.behaviour.variant[0, loud], minlength=4)
        # About 20,000 draws.
        np.testing.assert_allclose(found / found.sum(), expected, atol=0.015)


def test_four_variants_are_equally_likely_in_the_excited(make_crowd: Any) -> None:
    crowd = make_crowd(embarrassment=0.0)
    crowd.emotion.excitement[:] = 0.6
    crowd.answer(Goal(0, weight=0.5))
    crowd.run(60)
    for state in ("clap", "cheer"):
        shown = crowd.behaviour.variant[0, crowd.doing(state)]
        assert len(shown) > 500
        np.testing.assert_allclose(np.bincount(shown, minlength=4) / len(shown), 0.25, atol=0.07)


def test_robust_changes_finish_the_piece_and_rapid_ones_do_not(make_crowd: Any) -> None:
    crowd = make_crowd(load_table("sport"))
    b = crowd.behaviour
    agents = np.arange(1000)
    b.entered[0] = -crowd.rng.integers(0, 10, len(b.event))
    b.until[0] = b.entered[0] + 300
    grid = b.until[0].copy()
    wake(b, 0, agents, 20)
    lag = b.until[0, agents] - 20
    assert ((grid[agents] - b.until[0, agents]) % 10 == 0).all()
    assert lag.min() == 0
    assert lag.max() == 9
    assert lag.mean() == pytest.approx(4.5, abs=0.3)
    rapid = np.arange(1000, 2000)
    wake(b, 0, rapid, 20, True)
    assert (b.until[0, rapid] == 20).all()
    # Nobody's stay is lengthened.
    wake(b, 0, rapid, 50)
    assert (b.until[0, rapid] == 20).all()


def test_people_on_their_feet_lag_by_less_than_a_piece_behind_their_reaction(
    make_crowd: Any,
) -> None:
    crowd = make_crowd(embarrassment=0.0)
    b = crowd.behaviour
    crowd.run(50)
    b.state[0] = crowd.table.number("stand")
    b.until[0] = crowd.tick + 300 + crowd.rng.integers(0, 10, len(b.event))
    reacting = crowd.answer(Goal(0))
    begin = b.stirred_from[reacting].copy()
    entered = np.zeros(len(reacting), int)
    for _ in range(40):
        crowd.run()
        up = crowd.doing("arm_up")[reacting] & (entered == 0)
        entered[up] = crowd.tick
    lag = (entered - begin)[crowd.team.side[reacting] == 0]
    assert lag.min() >= 0
    assert lag.max() <= 9
    assert lag.mean() < 10


def test_a_limit_ends_a_stay_that_no_rule_ends(make_crowd: Any) -> None:
    text = CHOICE.replace("[states.easy]", '[states.easy]\nlimit = 7\nleave_to = "hard"').replace(
        'from = ["easy", "hard"]\nto = "hub"', 'from = ["easy", "hard"]\nto = "hub"\nmood = [2, 3]'
    )
    crowd = make_crowd(table_from_toml(text), settled=False)
    crowd.run(1)
    easy = crowd.doing("easy")
    assert easy.any()
    crowd.run(69)
    assert crowd.doing("easy")[easy].all()
    crowd.run()
    assert crowd.doing("hard").all()


def test_rules_read_signals_that_others_supply(make_crowd: Any) -> None:
    crowd = make_crowd("speech")
    crowd.run(100)
    assert not crowd.doing("sit_clap").any()
    wanted = np.zeros(len(crowd.present), bool)
    wanted[::2] = True
    crowd.behaviour.signals["clapping_wanted"] = wanted
    for machine in range(len(crowd.table.starts)):
        wake(crowd.behaviour, machine, np.arange(len(wanted)), crowd.tick + 1)
    crowd.run(12)
    assert crowd.doing("sit_clap")[::2].mean() > 0.95
    assert not crowd.doing("sit_clap")[1::2].any()
    wanted[:] = False
    crowd.run(12)
    assert not crowd.doing("sit_clap").any()


def test_the_mix_of_states_does_not_drift(make_crowd: Any) -> None:
    crowd = make_crowd()
    names = len(crowd.table.names)
    first = np.bincount(crowd.behaviour.state[0], minlength=names) / len(crowd.present)
    crowd.run(1800)
    last = np.bincount(crowd.behaviour.state[0], minlength=names) / len(crowd.present)
    # Two samples of 4000: three standard deviations of the difference are 0.03.
    np.testing.assert_allclose(first, last, atol=0.03)
    assert last[crowd.table.number("sit")] > 0.6
    assert 0.0 < last[crowd.table.number("stand")] < 0.1


def test_equal_seeds_do_the_same(make_crowd: Any) -> None:
    states = []
    for _ in range(2):
        crowd = make_crowd(seed=3)
        crowd.answer(Goal(1))
        crowd.run(100, feelings=True)
        states.append((crowd.behaviour.state.copy(), crowd.emotion.excitement.copy()))
    for first, second in zip(*states, strict=True):
        np.testing.assert_array_equal(first, second)

"""Orders to parts of a crowd: who they reach, what they hide, how they end, and how they clash."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from tifo.components.motion import NEVER
from tifo.engine.behaviour import Goal
from tifo.engine.crowd.motions import Role
from tifo.systems.crowd import Crowd
from tifo.systems.simulation import Simulation

MakeSimulation = Callable[..., Simulation]
TICK = 2 / 60


@pytest.fixture
def simulation(simulate: MakeSimulation) -> Simulation:
    return simulate(sides=2, away_share=0.3, occupancy=1.0, columns=60)


def _names(crowd: Crowd, agents: Any) -> list[str]:
    return [crowd.library.names[motion] for motion in crowd.motion.wanted[agents]]


def test_selections(simulation: Simulation) -> None:
    crowd = simulation.crowd
    count = len(crowd)
    assert crowd.select().tolist() == list(range(count))
    assert crowd.select(7).tolist() == [7]
    assert crowd.select([9, 3, 3]).tolist() == [3, 9]
    away = crowd.team.side == 1
    np.testing.assert_array_equal(crowd.select(team=1), np.flatnonzero(away))
    np.testing.assert_array_equal(crowd.select(away), np.flatnonzero(away))
    in_section = crowd.select("section 1")
    assert (crowd.seat.section[in_section] == 1).all()
    assert len(in_section) == (crowd.seat.section == 1).sum()
    block = crowd.select("rows 2-4 columns 10-20")
    assert len(block) == 3 * 11
    two = crowd.select(["rows 2", "3|5"])
    assert len(two) == 60 + 1
    both = crowd.select("section 1", team=1)
    assert set(both) == set(in_section) & set(np.flatnonzero(away))
    high = crowd.select(lambda c: c.placement.position[1] > 10.0)  # type: ignore[attr-defined]
    np.testing.assert_array_equal(high, np.flatnonzero(crowd.placement.position[1] > 10.0))
    assert len(crowd.select(team=5)) == 0


@pytest.mark.parametrize(
    ("agents", "team", "message"),
    [
        (900, None, "there is no agent 900"),
        ([0.5], None, "expected an id, ids"),
        (np.zeros(3, bool), None, "the mask has shape"),
        ("section 9", None, "names no seat"),
        ("upstairs", None, "can't be read"),
        (["rows 1", 3], None, "expected texts or ids, not both"),
        (None, 8, "team is 8, expected -1"),
        (None, float("nan"), "team is nan"),
    ],
)
def test_wrong_selections(simulation: Simulation, agents: Any, team: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        simulation.crowd.select(agents, team=team)


def test_an_order_takes_effect_at_the_next_pose_tick_and_ends_with_its_time(
    simulation: Simulation,
) -> None:
    crowd = simulation.crowd
    simulation.run(seconds=0.5)
    crowd.guide("section 0", motion="wave", seconds=0.5)
    chosen = crowd.select("section 0")
    assert set(_names(crowd, chosen)) != {"wave"}
    simulation.run(seconds=TICK)
    assert set(_names(crowd, chosen)) == {"wave"}
    assert "wave" not in _names(crowd, crowd.select("section 1"))
    simulation.run(seconds=0.5 - TICK)
    assert set(_names(crowd, chosen)) == {"wave"}
    simulation.run(seconds=TICK)
    assert "wave" not in _names(crowd, chosen)
    # What they went on doing beneath comes to light.
    np.testing.assert_array_equal(crowd.motion.wanted[chosen], crowd.behaviour.motion[0, chosen])


def test_who_must_not_clap_still_looks_round_and_goes_on_when_the_order_ends(
    simulation: Simulation,
) -> None:
    crowd = simulation.crowd
    order = crowd.guide(team=0, forbid=["clap", "cheer", "jump"])
    simulation.send(Goal(0))
    simulation.run(seconds=3.0)
    home = crowd.select(team=0)
    loud = np.isin(crowd.motion.wanted, crowd.library.roles[Role.CHEER])
    loud |= np.isin(crowd.motion.wanted, crowd.library.roles[Role.APPLAUD])
    assert not loud[home].any()
    assert set(crowd.channels(home)["arms"]) <= {"rest", "up"}
    # Beneath, they are in the middle of it: and the head and the posture are as they were.
    assert crowd.in_state("clap")[home].mean() > 0.2
    assert set(crowd.channels(home)["head"]) >= {"ahead", "talk"}
    assert crowd.channels(home)["posture"].count("standing") > 0.8 * len(home)
    crowd.release(order)
    crowd.release(order)
    simulation.run(seconds=TICK)
    loud = np.isin(crowd.motion.wanted, crowd.library.roles[Role.CHEER])
    loud |= np.isin(crowd.motion.wanted, crowd.library.roles[Role.APPLAUD])
    assert loud[home].mean() > 0.6


def test_guided_goes_before_events_and_events_before_scripts_and_those_before_whims(
    simulation: Simulation,
) -> None:
    crowd = simulation.crowd
    guided, scripted, free = (crowd.select(f"section {k}") for k in range(3))
    crowd.team.side[:] = 0
    crowd.emotion.susceptibility[:] = 1.0
    crowd.guide(guided, motion="sit")
    for agents in (guided, scripted):
        crowd.script(agents, motion="wave")
    simulation.run(seconds=TICK)
    assert {name[:3] for name in _names(crowd, guided)} == {"sit"}
    assert set(_names(crowd, scripted)) == {"wave"}
    assert "wave" not in _names(crowd, free)
    simulation.send(Goal(0, weight=0.5))
    simulation.run(seconds=2.5)
    assert {name[:3] for name in _names(crowd, guided)} == {"sit"}
    states = {"clap", "cheer", "wave", "cheer_2"}
    assert crowd.in_state("clap")[scripted].mean() > 0.2
    assert set(_names(crowd, scripted)) <= states
    assert "clap" in _names(crowd, scripted)
    simulation.run(seconds=8.0)
    assert not crowd.behaviour.reacting.any()
    assert set(_names(crowd, scripted)) == {"wave"}


def test_channels_are_told_apart(simulation: Simulation) -> None:
    crowd = simulation.crowd
    some = crowd.select("rows 1")
    crowd.guide(some, motion="standing", channel="posture")
    simulation.run(seconds=TICK)
    assert {name[:3] for name in _names(crowd, some)} == {"sta"}
    assert set(crowd.channels(some)["posture"]) == {"standing"}
    crowd.guide(some, motion="talk", channel="head")
    simulation.run(seconds=TICK)
    assert set(crowd.channels(some)["head"]) == {"talk"}
    assert set(crowd.channels(some)["arms"]) == {"rest"}
    crowd.guide(some, motion="clap", channel="arms", seconds=0.2)
    simulation.run(seconds=TICK)
    assert set(_names(crowd, some)) == {"clap"}
    shown = crowd.channels(some)
    assert (set(shown["posture"]), set(shown["arms"]), set(shown["head"])) == (
        {"standing"},
        {"clap"},
        {"talk"},
    )
    simulation.run(seconds=0.2)
    assert {name[:3] for name in _names(crowd, some)} == {"sta"}


def test_of_contradictory_orders_the_latest_that_lasts_counts(simulation: Simulation) -> None:
    crowd = simulation.crowd
    one = [5]
    crowd.guide(one, motion="wave")
    crowd.guide(one, motion="dismay", seconds=0.3)
    simulation.run(seconds=TICK)
    assert _names(crowd, one) == ["dismay"]
    crowd.guide(one, motion="standing", channel="posture", seconds=0.1)
    simulation.run(seconds=TICK)
    assert _names(crowd, one) == ["dismay"], "another channel is no contradiction"
    simulation.run(seconds=0.3)
    assert _names(crowd, one) == ["wave"], "the earlier order lasts"
    # What was demanded is forbidden, and then demanded again.
    crowd.guide(one, motion="clap", seconds=9.0)
    ban = crowd.guide(one, forbid="clap")
    simulation.run(seconds=TICK)
    assert "clap" not in _names(crowd, one)
    crowd.guide(one, motion="clap", seconds=0.2)
    simulation.run(seconds=TICK)
    assert _names(crowd, one) == ["clap"]
    simulation.run(seconds=0.3)
    assert _names(crowd, one) != ["clap"]
    crowd.release(ban)
    simulation.run(seconds=TICK)
    assert _names(crowd, one) == ["clap"]


def test_an_order_to_nobody_is_no_order(simulation: Simulation) -> None:
    crowd = simulation.crowd
    before = crowd.motion.wanted.copy()
    crowd.behaviour.until[:] = NEVER
    order = crowd.guide(team=5, motion="wave")
    crowd.guide([], forbid="clap")
    assert len(order.agents) == 0
    simulation.run(seconds=TICK)
    np.testing.assert_array_equal(crowd.motion.wanted, before)
    crowd.release(order)
    assert crowd.guidance.orders == []


@pytest.mark.parametrize(
    ("order", "message"),
    [
        ({}, "the order says nothing"),
        ({"motion": "fly"}, "motion is 'fly', expected one of start, sit"),
        ({"motion": "lying", "channel": "posture"}, "expected a posture: seated or standing"),
        ({"motion": "clap", "channel": "legs"}, "channel is 'legs', expected one of body"),
        ({"motion": "clap", "forbid": "clap"}, "which forbid rules out"),
        ({"forbid": "flying"}, "forbid has 'flying'"),
        ({"motion": "clap", "seconds": float("nan")}, "seconds is nan"),
        ({"motion": "clap", "seconds": float("inf")}, "seconds is inf"),
        ({"motion": "clap", "seconds": 0.0}, "seconds is 0.0"),
        ({"motion": "clap", "seconds": -1.0}, "seconds is -1.0"),
    ],
)
def test_wrong_orders_are_refused_at_once(
    simulation: Simulation, order: dict[str, Any], message: str
) -> None:
    crowd = simulation.crowd
    for give in (crowd.guide, crowd.script):
        with pytest.raises(ValueError, match=message):
            give(**order)
    assert crowd.guidance.orders == []


def test_orders_are_inputs_of_the_state(simulate: MakeSimulation) -> None:
    hashes = []
    for told in (True, True, False):
        simulation = simulate()
        if told:
            simulation.crowd.guide("rows 3-5", motion="cheer", seconds=1.0)
        simulation.send(Goal(0))
        simulation.run(seconds=2.0)
        hashes.append(simulation.crowd.state_hash())
    assert hashes[0] == hashes[1] != hashes[2]


def test_a_baked_crowd_obeys_too(simulate: MakeSimulation) -> None:
    simulation = simulate(poses="baked")
    crowd = simulation.crowd
    crowd.guide(3, motion="clap")
    simulation.run(seconds=TICK)
    assert crowd.baked is not None
    assert crowd.character.clips[crowd.baked[1].clip[3]].name == "clap"


def test_mechanisms_can_wake_agents(simulation: Simulation) -> None:
    crowd = simulation.crowd
    simulation.run(seconds=0.5)
    crowd.behaviour.signals["clapping_wanted"] = np.ones(len(crowd), np.bool_)
    crowd.wake("section 0", rapid=True)
    simulation.run(seconds=TICK)
    told = crowd.select("section 0")
    assert (crowd.in_state("sit_clap") | crowd.in_state("clap"))[told].mean() > 0.8
    with pytest.raises(ValueError, match="state is 'flying', expected one of start"):
        crowd.in_state("flying")

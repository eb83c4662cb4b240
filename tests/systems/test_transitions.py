"""Requests as a game makes them: on a crowd, in seconds, for ids, arrays and masks."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from tifo.components.motion import NEVER
from tifo.engine.streams import Stream
from tifo.systems.crowd import Crowd
from tifo.systems.simulation import Simulation

MakeSimulation = Callable[..., Simulation]
TICK = 2 / 60


@pytest.fixture
def simulation(simulate: MakeSimulation) -> Simulation:
    """Nobody changes motion of their own accord."""
    made = simulate(uniques=4, slots=50)
    made.crowd.behaviour.until[:] = NEVER
    made.run(seconds=TICK)
    return made


def stream(crowd: Crowd, row: int) -> Stream:
    assert crowd.pool is not None
    return Stream(row, int(crowd.pool.generation[row]))


def rows(crowd: Crowd) -> Any:
    assert crowd.anim is not None
    return crowd.anim.row[0]


def is_resting(crowd: Crowd) -> bool:
    assert crowd.transition is not None
    return not crowd.transition.duration.any()


def test_one_some_or_a_mask_of_agents(simulation: Simulation) -> None:
    crowd = simulation.crowd
    before = rows(crowd).copy()
    mask = np.zeros(len(crowd), bool)
    mask[[20, 21]] = True
    crowd.transition_to_streamed(3, stream(crowd, 1), offset=4.0)
    crowd.transition_to_streamed([5, 6], stream(crowd, 2), offset=np.array([1.0, 2.0]))
    crowd.transition_to_streamed(mask, stream(crowd, 3))
    np.testing.assert_array_equal(rows(crowd), before)
    simulation.run(seconds=TICK)
    assert rows(crowd)[[3, 5, 6, 20, 21]].tolist() == [1, 2, 2, 3, 3]
    assert crowd.anim is not None
    assert crowd.anim.start[0, [3, 5, 6]].tolist() == [4, 1, 2]
    others = np.setdiff1d(np.arange(len(crowd)), [3, 5, 6, 20, 21])
    np.testing.assert_array_equal(rows(crowd)[others], before[others])
    assert crowd.blend_counts.tick.two_source == 5
    simulation.run(seconds=0.5)
    assert is_resting(crowd)


def test_a_duration_is_in_seconds(simulation: Simulation) -> None:
    crowd = simulation.crowd
    crowd.transition_to_streamed([0, 1, 2], stream(crowd, 1), duration=[0.0, 0.5, 2.0])
    simulation.run(seconds=TICK)
    assert crowd.transition is not None
    assert crowd.transition.duration[0, :3].tolist() == [0.0, 15.0, 60.0]


def test_a_live_motion_reaches_one_agent(simulation: Simulation) -> None:
    crowd = simulation.crowd
    unique = crowd.uniques.add()
    crowd.transition_to_unique(7, unique, duration=0.2)
    shown = None
    for tick in range(12):
        palette = np.tile(np.eye(3, 4, dtype=np.float32), (7, 1, 1))
        palette[:, 1, 3] = 10.0 + tick
        crowd.uniques.write(unique, palette)
        simulation.run(seconds=TICK)
        shown = crowd.palettes(np.array([7, 8]), simulation.clock.pose_tick, 0.5)
    assert shown is not None
    np.testing.assert_allclose(shown[0, :, 1, 3], 20.5, atol=1e-4)
    assert np.abs(shown[1, :, 1, 3]).max() < 3.0
    crowd.uniques.remove(unique)
    simulation.run(seconds=1.0)
    assert crowd.pool is not None
    assert rows(crowd)[7] == crowd.pool.store.bind_row


def test_what_the_application_asks_goes_before_behaviour(simulation: Simulation) -> None:
    crowd = simulation.crowd
    crowd.motion.wanted[9] = 4
    crowd.transition_to_streamed(9, stream(crowd, 2))
    simulation.run(seconds=TICK)
    assert rows(crowd)[9] == 2
    simulation.run(seconds=1.0)
    assert rows(crowd)[9] == 2
    crowd.motion.wanted[9] = 5
    simulation.run(seconds=TICK)
    assert rows(crowd)[9] != 2


def test_requests_and_focus_are_inputs_of_the_state(simulate: MakeSimulation) -> None:
    hashes = []
    for asked in (True, True, False):
        simulation = simulate(slots=5)
        crowd = simulation.crowd
        for number in range(20):
            if asked:
                crowd.transition_to_streamed(np.arange(100), stream(crowd, number % 4))
            crowd.set_focus((0.0, 0.0, 0.0), radius=8.0)
            simulation.run(seconds=TICK)
        assert not asked or crowd.blend_counts.total.cut > 0
        hashes.append(crowd.state_hash())
    assert hashes[0] == hashes[1] != hashes[2]


def test_wrong_requests_are_named_and_change_nothing(simulation: Simulation) -> None:
    crowd = simulation.crowd
    good = stream(crowd, 1)
    wrong: list[tuple[str, Callable[[], None]]] = [
        ("there is no agent 300", lambda: crowd.transition_to_streamed(300, good)),
        ("there is no agent -1", lambda: crowd.transition_to_streamed([2, -1], good)),
        ("expected an id, ids", lambda: crowd.transition_to_streamed([0.5], good)),
        (r"mask has shape \(3,\)", lambda: crowd.transition_to_streamed([True] * 3, good)),
        ("part is 3, expected 0 to 2", lambda: crowd.transition_to_streamed(0, good, 3)),
        ("stream 99 is not alive", lambda: crowd.transition_to_streamed(0, Stream(99, 1))),
        ("duration has values", lambda: crowd.transition_to_streamed(0, good, duration=-1.0)),
        ("duration has values", lambda: crowd.transition_to_streamed(0, good, duration=np.nan)),
        (
            "offset has values that are not finite or not 0 to 28",
            lambda: crowd.transition_to_streamed(0, good, offset=29.0),
        ),
        (
            r"offset has shape \(3,\), expected a number or \(2,\)",
            lambda: crowd.transition_to_streamed([0, 1], good, offset=[1.0, 2.0, 3.0]),
        ),
        ("radius is -1", lambda: crowd.set_focus((0.0, 0.0, 0.0), radius=-1.0)),
        ("expected three finite numbers", lambda: crowd.set_focus((np.nan, 0.0, 0.0))),
    ]
    for message, call in wrong:
        with pytest.raises(ValueError, match=message):
            call()
    assert crowd.transition is not None
    assert (crowd.transition.next_row == -1).all()
    crowd.transition_to_streamed([], good)
    crowd.transition_to_streamed(np.zeros(300, bool), good)
    assert (crowd.transition.next_row == -1).all()


def test_a_baked_crowd_says_that_it_cannot_blend(simulate: MakeSimulation) -> None:
    crowd = simulate(poses="baked").crowd
    with pytest.raises(ValueError, match="this crowd is baked and can't blend"):
        crowd.transition_to_streamed(0, Stream(0, 1))
    with pytest.raises(ValueError, match="baked"):
        _ = crowd.uniques


def test_a_goal_in_the_middle_of_blends_uses_slots(simulate: MakeSimulation) -> None:
    from tifo.engine.behaviour import Goal

    simulation = simulate(slots=200)
    crowd = simulation.crowd
    crowd.transition_to_streamed(np.arange(300), stream(crowd, 1), duration=3.0)
    simulation.send(Goal(0))
    simulation.run(seconds=1.2)
    total = crowd.blend_counts.total
    assert total.snapshot > 100
    assert total.cut == 0
    simulation.run(seconds=3.0)
    assert crowd.ladder is not None
    assert crowd.ladder.slots.free > 150

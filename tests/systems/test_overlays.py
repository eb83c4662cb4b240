"""Overlays as a game asks for them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from tifo.engine.crowd.spec import CrowdSpec
from tifo.engine.streams import Stream
from tifo.systems.crowd import Crowd
from tifo.systems.simulation import Simulation

MakeSimulation = Callable[..., Simulation]


def stream(crowd: Crowd, clip: str) -> Stream:
    """Some stream that plays a clip."""
    pool = crowd.pool
    assert pool is not None
    (rows,) = np.nonzero(pool.alive & (pool.clip == pool.bank.index(clip)))
    return pool.stream(int(rows[0]))


def palettes(simulation: Simulation, agents: Any) -> Any:
    return simulation.crowd.palettes(np.asarray(agents), simulation.clock.pose_tick)


def test_arms_follow_another_stream_and_the_rest_does_not(simulate: MakeSimulation) -> None:
    with_overlay, without = simulate(), simulate()
    crowd = with_overlay.crowd
    crowd.overlay([4, 9], stream(crowd, "cheer"), "arms", duration=0.2)
    for simulation in (with_overlay, without):
        simulation.run(seconds=1.0)
    apart = np.abs(palettes(with_overlay, [4, 9, 10]) - palettes(without, [4, 9, 10]))
    joints = crowd.character.skeleton.names
    moved = apart.max(axis=(2, 3)) > 1e-5
    names = [{joints[j] for j in np.flatnonzero(row)} for row in moved]
    assert names == [{"hand_l", "hand_r"}, {"hand_l", "hand_r"}, set()]
    assert with_overlay.crowd.state_hash() != without.crowd.state_hash()
    crowd.clear_overlay(crowd.motion.wanted >= 0, duration=0.2)
    for simulation in (with_overlay, without):
        simulation.run(seconds=1.0)
    np.testing.assert_array_equal(palettes(with_overlay, [4, 9]), palettes(without, [4, 9]))


def test_a_mask_of_ones_own_and_a_unique(simulate: MakeSimulation) -> None:
    simulation = simulate(uniques=2)
    crowd = simulation.crowd
    crowd.add_mask("nod", {"head": 0.5})
    unique = crowd.uniques.add("dismay")
    before = palettes(simulation, [0])
    crowd.overlay(0, unique, "nod", layer=1, duration=0.0)
    simulation.run(seconds=0.5)
    head = crowd.character.skeleton.index("head")
    assert np.abs(palettes(simulation, [0]) - before)[0, head].max() > 1e-3


def test_wrong_requests_are_named(simulate: MakeSimulation) -> None:
    crowd = simulate().crowd
    good = stream(crowd, "clap")
    wrong: list[tuple[str, Callable[[], None]]] = [
        ("no mask 'tail'; known: head, arm_l, arm_r, arms", lambda: crowd.overlay(0, good, "tail")),
        ("layer is 2, expected 0 to 1", lambda: crowd.overlay(0, good, "arms", layer=2)),
        ("layer is -1", lambda: crowd.clear_overlay(0, layer=-1)),
        ("weight has values", lambda: crowd.overlay(0, good, "arms", weight=0.0)),
        ("weight has values", lambda: crowd.overlay(0, good, "arms", weight=1.5)),
        ("there is no agent 300", lambda: crowd.overlay(300, good, "arms")),
        ("stream 99 is not alive", lambda: crowd.overlay(0, Stream(99, 1), "arms")),
        ("offset has values", lambda: crowd.overlay(0, good, "arms", offset=29.0)),
        ("mask 'x'.*'hnad'", lambda: crowd.add_mask("x", {"hnad": 1.0})),
    ]
    for message, call in wrong:
        with pytest.raises(ValueError, match=message):
            call()
    baked = simulate(poses="baked").crowd
    with pytest.raises(ValueError, match="baked and has no overlays"):
        baked.clear_overlay(0)


def test_clip_events_of_an_overlay_carry_its_weight() -> None:
    simulation = Simulation(CrowdSpec(layout="stand", rows=4, columns=5, streams=64, props=0.0))
    crowd = simulation.crowd
    crowd.guide([5], motion="stand_idle", seconds=60.0)
    heard: list[tuple[int, float]] = []
    crowd.on_clip_event(
        "clap_contact",
        lambda ids, weights: heard.extend(zip(ids.tolist(), weights.tolist(), strict=True)),
    )
    simulation.run(seconds=4.0)
    assert not any(agent == 5 for agent, _ in heard[-20:])
    heard.clear()
    crowd.overlay([5], stream(crowd, "clap"), "arms", weight=0.5, duration=0.0)
    simulation.run(seconds=2.0)
    mine = [weight for agent, weight in heard if agent == 5]
    # About 3.3 claps a second, however fast the stream plays.
    assert 5 <= len(mine) <= 8
    assert set(mine) == {0.5}
    simulation.close()

"""Pairs who hug after a goal: together, in phase, face to face, and as before afterwards."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from tifo.engine.behaviour.events import Goal
from tifo.engine.crowd.spec import CrowdSpec
from tifo.systems.simulation import Simulation


@pytest.fixture
def stand() -> Iterator[Simulation]:
    simulation = Simulation(
        CrowdSpec(layout="stand", rows=12, columns=40, step=0.55, rise=0.4, depth=0.8, sides=2,
                  fans="blocks", occupancy=1.0, neutrals=0.0, props=0.0, children=0.1, seed=4)
    )  # fmt: skip
    yield simulation
    simulation.close()


def _pairs(simulation: Simulation) -> tuple[np.ndarray, np.ndarray]:
    crowd = simulation.crowd
    assert crowd.company is not None
    first = np.flatnonzero(crowd.in_state("hug_a"))
    return first, crowd.company.party.partner[first].astype(np.int64)


def test_pairs_hug_in_phase_and_face_to_face(stand: Simulation) -> None:
    crowd = stand.crowd
    pool, anim = crowd.pool, crowd.anim
    assert pool is not None
    assert anim is not None
    assert crowd.table.notes == ()
    stand.run(seconds=1.0)
    yaw = crowd.placement.yaw.copy()
    stand.send(Goal(side=0))
    seen = matched = 0
    for _ in range(80):
        stand.run(seconds=0.1)
        first, second = _pairs(stand)
        assert set(second) == set(np.flatnonzero(crowd.in_state("hug_b"))), "nobody hugs alone"
        assert (crowd.team.side[first] == 0).all()
        assert (crowd.body.kind[first] == crowd.body.kind[second]).all()
        entered = crowd.behaviour.entered[0]
        np.testing.assert_array_equal(entered[first], entered[second])
        lasts = crowd.behaviour.tick - entered[first]
        held = (lasts > 24) & (lasts < 50)
        for a, b in zip(first[held], second[held], strict=True):
            seen += 1
            x, _, z = crowd.placement.position
            for one, other in ((a, b), (b, a)):
                to = np.arctan2(x[other] - x[one], z[other] - z[one])
                off = np.angle(np.exp(1j * (crowd.placement.yaw[one] - to)))
                assert abs(off) < 0.02
            if crowd.transition is not None and (crowd.transition.duration[0, [a, b]] > 0).any():
                continue
            rows, starts = anim.row[0, [a, b]], anim.start[0, [a, b]]
            clips = [crowd.library.clips[crowd.library.names.index(f"hug_{k}")] for k in "ab"]
            np.testing.assert_array_equal(pool.clip[rows], clips)
            poses = (pool.head[rows] - np.round(starts).astype(int)) % pool.store.capacity
            phase = pool.store.ring_phase[poses, rows]
            assert abs(np.angle(np.exp(2j * np.pi * (phase[0] - phase[1])))) < 2 * np.pi * 1.5 / 78
            matched += 1
    assert seen > 20
    assert matched > 10
    stand.run(seconds=6.0)
    assert not len(_pairs(stand)[0])
    np.testing.assert_array_equal(crowd.placement.yaw, yaw)


def test_nobody_hugs_for_a_goal_of_little_weight(stand: Simulation) -> None:
    stand.send(Goal(side=0, weight=0.4))
    for _ in range(20):
        stand.run(seconds=0.4)
        assert not len(_pairs(stand)[0])

"""Parties that follow somebody, in a crowd that runs: he gets up, cheers and goes; so do they."""

from __future__ import annotations

from collections.abc import Iterator
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.engine.behaviour.events import Event
from tifo.engine.behaviour.table import SEATED
from tifo.engine.crowd.spec import CrowdSpec
from tifo.systems.crowd import Crowd
from tifo.systems.simulation import Simulation


@pytest.fixture
def match() -> Iterator[Simulation]:
    simulation = Simulation(
        CrowdSpec(seats=6000, poses="none", walking=False, props=0.0, sides=2, seed=5)
    )
    yield simulation
    simulation.close()


def followers(crowd: Crowd) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
    """Ids of those who follow somebody of their side, and his."""
    party, side = crowd.company.party, crowd.team.side
    ids = np.arange(len(party.leader))
    led = np.flatnonzero((party.leader >= 0) & (party.leader != ids))
    led = led[side[led] == side[party.leader[led]]]
    return led, party.leader[led]


def test_parties_stand_with_their_leader(match: Simulation) -> None:
    crowd = match.crowd
    led, leader = followers(crowd)
    assert len(led) > 1000
    together, apart = [], []
    for _ in range(8):
        match.run(seconds=6.0)
        stands = crowd.behaviour.posture != SEATED
        together.append(stands[led][stands[leader]].mean())
        apart.append(stands[led][~stands[leader]].mean())
    # The first of these is at the start: the crowd is found in the middle of things.
    assert min(together) > 0.85
    assert max(apart) < 0.12


def test_parties_are_moved_together_and_stop_together(match: Simulation) -> None:
    crowd = match.crowd
    led, leader = followers(crowd)
    ours = crowd.team.side[led] == 0
    led, leader = led[ours], leader[ours]
    match.run(seconds=2.0)
    match.send(Event("near_miss", side=0, weight=0.45))
    match.run(seconds=1.4)
    moved = crowd.behaviour.reacting
    unled = np.flatnonzero((crowd.company.party.leader < 0) & (crowd.team.side == 0))
    assert 0.4 < moved[unled].mean() < 0.95, "some are not moved by it"
    assert moved[led][moved[leader]].mean() > 0.97
    assert moved[led][~moved[leader]].mean() < moved[unled].mean() + 0.1
    end = crowd.behaviour.stirred_until
    both = moved[led] & moved[leader]
    assert (end[led] == end[leader])[both].mean() > 0.95
    other = np.random.default_rng(1).permutation(leader)
    assert (end[led] == end[other])[both & moved[other]].mean() < 0.2


def test_who_follows_somebody_goes_with_him_and_comes_with_him(factories: ModuleType) -> None:
    clips = ("walk", "sit_idle", "stand_idle", "clap", "cheer", "dismay", "stand_up", "sit_down")
    simulation = Simulation(
        CrowdSpec(seats=300, streams=8, history=30, slots=10, casting=False, walking=True, seed=4),
        factories.make_character(clips),
    )
    try:
        crowd = simulation.crowd
        led, leader = followers(crowd)
        head = int(np.bincount(leader).argmax())
        party = sorted([head, *led[leader == head].tolist()])
        assert len(party) >= 3
        assert crowd.leave(head).tolist() == party
        simulation.run(seconds=4.0)
        assert head in crowd.walk.agent
        assert {*crowd.walk.agent.tolist()} <= {*party}
        assert len(crowd.walk) > 1
        for _ in range(60):
            simulation.run(seconds=2.0)
            if crowd.walkers is not None and crowd.walkers.is_idle:
                break
        assert not crowd.seat.occupied[party].any()
        # One who only follows comes alone, and the others with him whom they follow.
        someone = party[0] if party[0] != head else party[1]
        assert crowd.arrive(someone).tolist() == [someone]
        assert crowd.arrive(head).tolist() == [agent for agent in party if agent != someone]
    finally:
        simulation.close()

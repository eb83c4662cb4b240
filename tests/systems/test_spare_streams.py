"""Streams that a crowd leaves free for its users."""

from __future__ import annotations

import numpy as np
import pytest

from tifo import CrowdSpec, Simulation


@pytest.mark.parametrize(("children", "spare"), [(0.0, 5), (0.2, 5), (0.2, 0)])
def test_spare_streams_are_free_and_can_be_used(children: float, spare: int) -> None:
    spec = CrowdSpec(
        layout="stand",
        rows=4,
        columns=10,
        streams=200,
        spare_streams=spare,
        children=children,
        old=0.0,
        props=0.0,
    )
    simulation = Simulation(spec)
    crowd = simulation.crowd
    assert crowd.pool is not None
    assert crowd.anim is not None
    free = int(np.count_nonzero(~crowd.pool.alive))
    assert spare <= free <= spare + 1  # the two types' twins come in pairs
    assert (len(crowd.pool.twins) > 0) == (children > 0)
    if spare:
        stream = crowd.pool.add("cheer")
        crowd.pool.add_twin(stream, "child")
        crowd.transition_to_streamed(np.arange(len(crowd)), stream, duration=0.0)
        simulation.run(seconds=0.1)
        rows = crowd.anim.row[0]
        assert (crowd.pool.clip[rows] == crowd.pool.bank.index("cheer")).all()
        assert (crowd.pool.twins.kind[rows] == crowd.body.kind).all()
    else:
        assert free < 2
    simulation.close()

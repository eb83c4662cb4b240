"""Stream rows that a crowd leaves free for motions of its users."""

from __future__ import annotations

import esper
import numpy as np
import pytest

import tifo


@pytest.mark.parametrize("idle", [False, True])
def test_spare_streams_are_free_and_stay_awake(esper_world: str, idle: bool) -> None:
    spec = tifo.CrowdSpec(rows=4, columns=10, layout="stand", streams=48, history=14, seed=2)
    plain = tifo.spawn_crowd(spec, tifo.build_seats(spec), tifo.builtin_spectator())
    assert plain.pool is not None
    taken = int(plain.pool.alive.sum())
    more = spec.replace(spare_streams=5, rest_idle=idle)
    crowd = tifo.spawn_crowd(more, tifo.build_seats(more), tifo.builtin_spectator())
    pool = crowd.pool
    assert pool is not None
    assert int(pool.alive.sum()) == taken, "twins don't take them"
    assert len(pool.alive) == len(plain.pool.alive) + 5
    # The crowd itself is the same.
    assert crowd.anim is not None
    assert plain.anim is not None
    np.testing.assert_array_equal(crowd.anim.start[0], plain.anim.start[0])
    streams = [pool.add("wave") for _ in range(5)]
    for system in crowd.systems():
        esper.add_processor(system)
    for _ in range(60):  # four seconds; idle streams rest after two
        esper.process(4 / 60)
    assert pool.running.all() != idle
    assert all(pool.running[stream.row] for stream in streams)

"""A short match without pictures ends as it began; the command runs longer ones."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from tifo.benchmarks.soak import LimitWatch, random_events, soak
from tifo.cli import main
from tifo.engine.crowd.spec import CrowdSpec
from tifo.systems.simulation import Simulation


@pytest.mark.slow
def test_a_match_leaves_nothing_behind() -> None:
    """Fourteen and a half minutes, twice: shares, limits, memory and the final state."""
    result = soak(agents=800, minutes=14.5, events=40, runs=2, seed=5)
    assert result["same_hash"]
    assert result["most_reacting"] > 0.8
    assert result["most_clapping"] > 0.5
    # Of 768 people, means of 2 minutes vary by 0.01 or so.
    assert result["largest_change_of_a_share"] < 0.04
    before, after = result["mean_excitement"]
    assert after == pytest.approx(before, abs=0.05)
    assert result["overstayed_seconds"] == 0.0
    assert result["states_entered"] >= 18
    assert result["memory_end_bytes"] - result["memory_warm_bytes"] < 8 * 2**20


def test_who_stays_too_long_is_found() -> None:
    simulation = Simulation(CrowdSpec(rows=4, columns=5, layout="stand", poses="none"))
    crowd = simulation.crowd
    watch = LimitWatch(crowd)
    crowd.observers.active.append(watch)
    simulation.run(seconds=2.0)
    assert watch.worst.max() <= 0
    agent = int(np.flatnonzero(crowd.in_state("sit") & crowd.seat.occupied)[0])
    sit = crowd.table.number("sit")
    crowd.behaviour.entered[0, agent] = simulation.clock.pose_tick - crowd.table.limit[sit] - 300
    crowd.behaviour.until[0, agent] = simulation.clock.pose_tick + 900
    simulation.run(seconds=1.0)
    assert watch.worst[sit] == pytest.approx(300 + 30, abs=10)
    assert watch.worst[crowd.table.number("jump")] < -1000
    simulation.close()


def test_random_events_are_of_all_kinds_in_order() -> None:
    simulation = Simulation(CrowdSpec(rows=4, columns=5, layout="stand", poses="none", sides=2))
    rng = np.random.default_rng(2)
    events = random_events(simulation.crowd, 400, 60.0, 900.0, rng)
    simulation.close()
    times = [event.time for event in events]
    assert times == sorted(times)
    assert 60.0 <= times[0] <= times[-1] <= 900.0  # type: ignore[operator]
    assert len({event.kind for event in events}) == 15
    assert {event.side for event in events} == {None, 0, 1}


def test_the_command(capsys: pytest.CaptureFixture[str], monkeypatch: Any) -> None:
    def quick(**options: Any) -> dict[str, Any]:
        assert options == {"agents": 500, "minutes": 20.0, "events": 7, "runs": 2}
        return {
            **options,
            **{"benchmark": "soak", "same_hash": False, "seconds": 9.0, "times_faster": 133.0},
            **{"shares": {"sit": [0.8, 0.75]}, "most_reacting": 0.9, "most_clapping": 0.7},
            **{"states_entered": 20, "states": 23, "overstayed_seconds": 0.5},
            **{"mean_excitement": [0.2, 0.21], "state_hash": "ab12", "environment": {}},
            **{"memory_warm_bytes": 2**20, "memory_end_bytes": 3 * 2**20},
        }

    monkeypatch.setattr("tifo.benchmarks.soak.soak", quick)
    words = ["bench", "soak", "--agents", "500", "--minutes", "20", "--events", "7", "--runs", "2"]
    assert main(words) == 0
    out = capsys.readouterr().out
    for said in ("20 minutes with 7 events", "75.00%", "0.50 s", "3.0 MB", "different states"):
        assert said in out
    assert main([*words, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["state_hash"] == "ab12"


def test_impossible_matches_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "soak", "--minutes", "3", "--json"]) == 1
    assert "minutes is 3.0, expected 14 to 1440" in capsys.readouterr().err
    with pytest.raises(ValueError, match="events is -1"):
        soak(agents=10, minutes=15, events=-1)

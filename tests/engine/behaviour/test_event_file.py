"""Files with events of a match."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tifo.engine.behaviour.event_file import load_events
from tifo.engine.crowd.seating import SeatPlan
from tifo.engine.crowd.spec import CrowdSpec
from tifo.engine.crowd.stadium import build_seats
from tifo.engine.errors import AssetError

GOOD = """
[[events]]
time = 9
kind = "ball_in_crowd"
place = "3|4"

[[events]]
time = 2.5
kind = "goal"
side = "away"
weight = 0.8

[[events]]
time = 4
kind = "mexican_wave"
place = [1.0, 2.0, -3.5]
"""


@pytest.fixture
def plan() -> SeatPlan:
    """A stand of 10 rows of 20."""
    return build_seats(CrowdSpec(layout="stand"))


def test_events_come_in_the_order_of_their_times(tmp_path: Path, plan: SeatPlan) -> None:
    file = tmp_path / "match.toml"
    file.write_text(GOOD)
    goal, wave, ball = load_events(file, plan)
    assert (goal.kind, goal.time, goal.side, goal.weight) == ("goal", 2.5, 1, 0.8)
    assert (wave.kind, wave.place) == ("mexican_wave", (1.0, 2.0, -3.5))
    seat = plan.position[:, plan.find("3|4")]
    assert ball.place is not None
    np.testing.assert_allclose(ball.place, seat + np.array([0.0, 1.0, 0.0]), atol=1e-6)


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("[[events", "can't be read"),
        ("speed = 3", "expected nothing but"),
        ("events = 3", "expected nothing but"),
        ("events = [3]", "event 1: it is no table"),
        ('[[events]]\nkind = "goal"\nside = 0', "event 1: time is missing"),
        ("[[events]]\ntime = 1", "event 1: kind is missing"),
        ('[[events]]\ntime = 1\nkind = "gaol"\nside = 0', "event 1: .*did you mean goal"),
        ('[[events]]\ntime = 1\nkind = "goal"', "event 1: side is None"),
        ('[[events]]\ntime = 1\nkind = "goal"\nside = "hoome"', "event 1: side is 'hoome'"),
        ('[[events]]\ntime = nan\nkind = "cue"', "event 1: time is nan"),
        ('[[events]]\ntime = 1\nkind = "cue"\nwho = 3', "event 1: unknown key 'who'"),
        ('[[events]]\ntime = 1\nkind = "ball_in_crowd"\nplace = "section 900"', "names no seat"),
        ('[[events]]\ntime = 1\nkind = "ball_in_crowd"\nplace = [1, 2]', "three finite"),
    ],
)
def test_mistakes_are_named(tmp_path: Path, plan: SeatPlan, text: str, cause: str) -> None:
    file = tmp_path / "match.toml"
    file.write_text(text)
    with pytest.raises(AssetError, match=cause):
        load_events(file, plan)
    with pytest.raises(AssetError, match="can't be read"):
        load_events(tmp_path / "none.toml", plan)

"""Events check themselves, and wait in order."""

from __future__ import annotations

from typing import Any

import pytest

from tifo.engine.behaviour import BallHit, Goal
from tifo.engine.behaviour.events import EventQueue


@pytest.mark.parametrize("side", [-1, 2, None, "home"])
def test_goals_are_for_home_or_away(side: Any) -> None:
    with pytest.raises(ValueError, match=r"side is .*, expected 0 \(home\) or 1 \(away\)"):
        Goal(side)


@pytest.mark.parametrize(
    "place",
    [(0.0, 1.0), (0.0, 1.0, 2.0, 3.0), (0.0, float("nan"), 1.0), (float("inf"), 0.0, 0.0)],
)
def test_balls_land_somewhere(place: Any) -> None:
    with pytest.raises(ValueError, match=r"place is .*, expected three finite coordinates"):
        BallHit(place)


def test_a_queue_keeps_the_order_and_is_empty_after_taking() -> None:
    queue = EventQueue()
    first, second = Goal(1), BallHit((1.0, 2.0, 3.0))
    queue.send(first)
    queue.send(second)
    taken = queue.take()
    assert taken == [first, second]
    assert queue.take() == []
    queue.send(second)
    # What was taken is the taker's own.
    assert taken == [first, second]
    assert queue.take() == [second]

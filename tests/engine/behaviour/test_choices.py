"""Which ways out agents take, beside what the rules say of each agent by itself."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tifo.engine.behaviour.choices import CALM, Choices
from tifo.engine.behaviour.compiled import CompiledRule
from tifo.engine.behaviour.events import KINDS
from tifo.engine.behaviour.table import RELATIONS

INF = float("inf")


def rule(target: int, effort: float = 1.0, **options: Any) -> CompiledRule:
    given: dict[str, Any] = {
        **{"pairs": None, "calm": False, "pieces": (1, 1), "rapid": False, "blend": 0.0},
        **{"limits": (), "signals": (), **options},
    }
    return CompiledRule(target=target, effort=effort, **given)


def shares(
    choices: Choices, state: int, pair: int, rng: np.random.Generator, **columns: float
) -> list[float]:
    """Which share of 20,000 agents goes to each of three states."""
    count = 20_000
    choice = choices.draw(
        np.full(count, state, np.int16),
        np.full(count, pair, np.intp),
        lambda name: np.full(count, columns.get(name, 0.0), np.float32),
        rng,
    )
    return [float((choice.target == k).mean()) for k in range(3)]


def test_each_way_by_one_over_its_effort(rng: np.random.Generator) -> None:
    choices = Choices(((rule(1, 1.0), rule(2, 4.0)), (), ()))
    assert shares(choices, 0, CALM, rng) == pytest.approx([0.0, 0.8, 0.2], abs=0.015)
    assert shares(choices, 1, CALM, rng) == [0.0, 1.0, 0.0]  # no way out


def test_events_limits_and_signals_open_and_close_ways(rng: np.random.Generator) -> None:
    pairs = np.zeros((len(KINDS), len(RELATIONS)), np.bool_)
    pairs[2, 1] = True
    ways = (
        rule(1, pairs=pairs),
        rule(2, calm=True, limits=(("mood", 0.25, 0.5),)),
        rule(2, calm=True, signals=(("told", True), ("late", False))),
    )
    choices = Choices((ways, (), ()))
    moved = 2 * len(RELATIONS) + 1
    assert shares(choices, 0, moved, rng, mood=0.3, told=1.0) == [0.0, 1.0, 0.0]
    assert shares(choices, 0, moved + 1, rng, mood=0.3, told=1.0) == [1.0, 0.0, 0.0]
    for mood, is_met in ((0.2, False), (0.25, True), (0.49, True), (0.5, False)):
        assert shares(choices, 0, CALM, rng, mood=mood) == [1.0 - is_met, 0.0, float(is_met)]
    assert shares(choices, 0, CALM, rng, told=1.0) == [0.0, 0.0, 1.0]
    assert shares(choices, 0, CALM, rng, told=1.0, late=1.0) == [1.0, 0.0, 0.0]


def test_many_situations_at_once_are_told_apart(rng: np.random.Generator) -> None:
    """More than the tables have room for at first, each with one way to go."""
    names = [f"signal {k}" for k in range(8)]
    ways = tuple(rule(k + 1, 10.0**-k, signals=((name, True),)) for k, name in enumerate(names))
    choices = Choices((ways, *[()] * 8))
    number = np.arange(256).repeat(4)
    columns = {name: (number >> k) & 1 == 1 for k, name in enumerate(names)}
    for _ in range(2):
        choice = choices.draw(
            np.zeros(1024, np.int16), np.full(1024, CALM), columns.__getitem__, rng
        )
        allowed = [
            target == 0 or number[i] >> (target - 1) & 1 for i, target in enumerate(choice.target)
        ]
        assert all(allowed)
        assert ((choice.target == 0) == (number == 0)).all()


def test_who_stays_learns_for_how_long(rng: np.random.Generator) -> None:
    choices = Choices(((rule(0, pieces=(3, 24), blend=5.0),),))
    choice = choices.draw(np.zeros(3, np.int16), np.full(3, CALM), np.zeros, rng)
    assert (choice.least == 3).all()
    assert (choice.most == 24).all()
    assert (choice.blend == 5.0).all()


def test_too_many_conditions_are_refused() -> None:
    ways = tuple(rule(0, limits=(("mood", 0.01 * k, INF),)) for k in range(41))
    with pytest.raises(ValueError, match="41 different conditions"):
        Choices((ways,))

"""Who hears whom."""

from __future__ import annotations

import numpy as np
import pytest

from tifo.engine.behaviour.hearing import Hearing
from tifo.engine.crowd.bowl import build_bowl
from tifo.engine.crowd.stand import build_stand


def test_a_room_hears_its_own_share_only() -> None:
    hearing = Hearing(np.array([0, 0, 0, 0, 1, 1]))
    np.testing.assert_allclose(hearing.share(np.array([1.0, 2.0])), [0.25, 1.0])


def test_the_absent_do_not_count() -> None:
    hearing = Hearing(np.array([0, 0, 0, 0]), np.array([True, False, True, False]))
    np.testing.assert_allclose(hearing.share(np.array([1.0])), [0.5])


def test_sections_hear_each_other_less_the_farther_they_are() -> None:
    plan = build_stand(1, 84, step=1.0)  # three sections of 28 m, middles 28 m apart
    hearing = Hearing.of_sections(plan, reach=28.0)
    # Loudness 1, 1/2, 1/5 at 0, 28 and 56 m.
    first = hearing.share(np.array([28.0, 0.0, 0.0]))
    np.testing.assert_allclose(first, [1 / 1.7, 0.5 / 2.0, 0.2 / 1.7], rtol=1e-6)
    np.testing.assert_allclose(hearing.share(np.full(3, 28.0)), 1.0)


def test_with_endless_reach_a_stadium_is_one_room() -> None:
    plan = build_bowl(3000)
    hearing = Hearing.of_sections(plan, reach=np.inf)
    clapping = np.zeros(hearing.count)
    clapping[0] = 30.0
    np.testing.assert_allclose(hearing.share(clapping), 0.01)


@pytest.mark.parametrize("group", [np.repeat([0, 1, 2], 5), np.array([2, 0, 1, 1, 0, 2, 2])])
def test_sums_and_spread_follow_the_groups(group: np.ndarray) -> None:
    hearing = Hearing(group)
    values = np.arange(len(group), dtype=np.float32)
    expected = [values[group == g].sum() for g in range(3)]
    np.testing.assert_allclose(hearing.sums(values), expected)
    np.testing.assert_allclose(hearing.spread(np.array([5.0, 6.0, 7.0])), group + 5.0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((np.zeros(0, int),), "group"),
        ((np.array([0, -1]),), "group"),
        ((np.array([0, 1]), np.array([True])), "present has shape"),
        ((np.array([0, 1]), None, np.ones((3, 3))), "loudness has shape"),
        ((np.array([0, 1]), None, np.full((2, 2), np.nan)), "finite"),
    ],
)
def test_wrong_arguments_are_named(arguments: tuple, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Hearing(*arguments)
    with pytest.raises(ValueError, match="reach"):
        Hearing.of_sections(build_stand(1, 2), reach=0.0)


def test_who_goes_is_not_missed_and_who_comes_counts() -> None:
    hearing = Hearing(np.array([0, 0, 0, 0, 1, 1]), np.array([1, 1, 1, 0, 1, 1], bool))
    np.testing.assert_allclose(hearing.share(np.array([1.0, 1.0])), [1 / 3, 1 / 2])
    hearing.admit(np.array([1, 1, 4, 3]), present=False)  # one twice, one who isn't there
    np.testing.assert_array_equal(hearing.sizes, [2, 1])
    np.testing.assert_allclose(hearing.share(np.array([1.0, 1.0])), [1 / 2, 1])
    hearing.admit(np.array([0, 1, 3]), present=True)
    np.testing.assert_array_equal(hearing.sizes, [4, 1])
    assert hearing.present.tolist() == [True, True, True, True, False, True]

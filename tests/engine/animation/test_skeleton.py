"""Joint trees: their order, their levels and their checks."""

from __future__ import annotations

from dataclasses import replace
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tifo.engine.animation import Skeleton
from tifo.engine.animation.skeleton import breadth_first_order


@pytest.fixture
def body(factories: ModuleType) -> Skeleton:
    made: Skeleton = factories.make_body()
    return made


def test_the_example_of_breadth_first_order() -> None:
    assert breadth_first_order([2, -1, 1]).tolist() == [1, 2, 0]


@given(st.lists(st.integers(0, 10**6), min_size=1, max_size=40), st.randoms())
def test_order_sorts_by_depth_and_keeps_the_order_within_a_level(
    picks: list[int], mix: Any
) -> None:
    # A tree whose joint k has a parent among the first k, with its joints renamed at random.
    tree = [-1, *(pick % k for k, pick in enumerate(picks[1:], start=1))]
    names = list(range(len(tree)))
    mix.shuffle(names)
    parents = [0] * len(tree)
    for joint, parent in enumerate(tree):
        parents[names[joint]] = -1 if parent < 0 else names[parent]
    order = breadth_first_order(parents).tolist()

    def depth(joint: int) -> int:
        return 0 if parents[joint] < 0 else 1 + depth(parents[joint])

    assert order == sorted(range(len(parents)), key=lambda joint: (depth(joint), joint))


@pytest.mark.parametrize("parents", [[0], [1, 0], [-1, 2, 3, 1]])
def test_cycles_are_refused(parents: list[int]) -> None:
    with pytest.raises(ValueError, match="its own ancestor"):
        breadth_first_order(parents)


@pytest.mark.parametrize("parents", [[-1, 2], [-1, -2]])
def test_parents_outside_the_list_are_refused(parents: list[int]) -> None:
    with pytest.raises(ValueError, match=r"parents\[1\] is -?2, but there are 2 joints"):
        breadth_first_order(parents)


def test_levels_are_slices_of_equal_depth(body: Skeleton) -> None:
    assert body.levels == (slice(0, 1), slice(1, 4), slice(4, 7))


def test_several_roots_share_the_first_level(factories: ModuleType) -> None:
    skeleton = factories.make_skeleton([-1, -1, 0, 1], np.zeros((4, 3)))
    assert skeleton.levels == (slice(0, 2), slice(2, 4))


def test_joints_are_found_by_name(body: Skeleton) -> None:
    assert body.index("head") == 4
    with pytest.raises(ValueError, match="no joint 'hand_x'; near: hand_"):
        body.index("hand_x")
    with pytest.raises(ValueError, match="no joint 'qqq'; near: hips"):
        body.index("qqq")


def test_no_joints_are_refused(body: Skeleton) -> None:
    with pytest.raises(ValueError, match="at least one joint"):
        replace(body, names=())


def test_a_name_that_occurs_twice_is_refused(body: Skeleton) -> None:
    with pytest.raises(ValueError, match="'head' occurs more than once"):
        replace(body, names=(*body.names[:6], "head"))


def test_joints_that_are_not_sorted_are_refused(body: Skeleton) -> None:
    parents = body.parents.copy()
    parents[3] = 6
    with pytest.raises(ValueError, match="not sorted by depth"):
        replace(body, parents=parents)


@pytest.mark.parametrize(
    "name", ["parents", "rest_rotation", "rest_translation", "rest_scale", "inverse_bind"]
)
def test_wrong_shapes_are_named(body: Skeleton, name: str) -> None:
    with pytest.raises(ValueError, match=f"{name} has shape"):
        replace(body, **{name: getattr(body, name)[:-1]})

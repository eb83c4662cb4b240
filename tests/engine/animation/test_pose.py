"""Where the numbers of a pose stand in its block."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tifo.engine.animation import PoseLayout


def _fan(factories: ModuleType) -> PoseLayout:
    """A root with two children."""
    return PoseLayout(factories.make_skeleton([-1, 0, 0], np.zeros((3, 3))))


def test_the_worked_example_of_the_docstring(factories: ModuleType) -> None:
    layout = _fan(factories)
    assert layout.rows[0].tolist() == list(range(10))
    assert layout.rows[2, 4] == 19
    assert layout.levels == (slice(0, 10), slice(10, 30))


def test_a_level_holds_rotations_then_translations_then_scales(factories: ModuleType) -> None:
    layout = _fan(factories)
    assert layout.rows[1].tolist() == [10, 12, 14, 16, 18, 20, 22, 24, 26, 28]
    assert layout.rows[2].tolist() == [11, 13, 15, 17, 19, 21, 23, 25, 27, 29]


def test_pack_puts_each_number_at_its_row(factories: ModuleType) -> None:
    layout = _fan(factories)
    rotation = np.zeros((2, 3, 4), np.float32)
    translation = np.zeros((2, 3, 3), np.float32)
    scale = np.ones((2, 3, 3), np.float32)
    rotation[1, 2, 3], translation[0, 2, 0], scale[1, 0, 2] = 5.0, 6.0, 7.0
    block = layout.pack(rotation, translation, scale)
    assert block.shape == (2, 30)
    assert block.dtype == np.float32
    assert block[1, 17] == 5.0
    assert block[0, 19] == 6.0
    assert block[1, 9] == 7.0


@settings(max_examples=30, deadline=None)
@given(st.lists(st.integers(0, 5), min_size=1, max_size=9), st.integers(1, 4), st.integers(0, 99))
def test_unpack_is_the_inverse_of_pack(
    factories: ModuleType, widths: list[int], streams: int, seed: int
) -> None:
    # A tree of one root and then levels of the given widths under the first joint of each level.
    parents, last = [-1], 0
    for width in widths:
        first = len(parents)
        parents += [last] * (width + 1)
        last = first
    joints = len(parents)
    layout = PoseLayout(factories.make_skeleton(parents, np.zeros((joints, 3))))
    rng = np.random.default_rng(seed)
    parts = [rng.normal(size=(streams, joints, c)).astype(np.float32) for c in (4, 3, 3)]
    block = layout.pack(*parts)
    assert sorted(layout.rows.ravel()) == list(range(10 * joints))
    for found, given_part in zip(layout.unpack(block), parts, strict=True):
        np.testing.assert_array_equal(found, given_part)


@pytest.mark.parametrize("streams", [1, 3])
def test_mixing_two_blocks_mixes_every_channel(factories: ModuleType, streams: int) -> None:
    layout = _fan(factories)
    rng = np.random.default_rng(0)
    a, b = ([rng.normal(size=(streams, 3, c)).astype(np.float32) for c in (4, 3, 3)] for _ in "ab")
    mixed = layout.unpack(layout.pack(*a) * np.float32(0.25) + layout.pack(*b) * np.float32(0.75))
    for found, x, y in zip(mixed, a, b, strict=True):
        np.testing.assert_allclose(found, 0.25 * x + 0.75 * y, atol=1e-6)

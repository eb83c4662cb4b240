"""Where the numbers of a pose stand in its block."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tifo.engine.animation import pack_poses, unpack_poses


def test_channels_are_outer_and_joints_inner() -> None:
    rotation = np.zeros((2, 3, 4), np.float32)
    translation = np.zeros((2, 3, 3), np.float32)
    scale = np.ones((2, 3, 3), np.float32)
    rotation[1, 2, 3], translation[0, 2, 0], scale[1, 0, 2] = 5.0, 6.0, 7.0
    block = pack_poses(rotation, translation, scale)
    assert block.shape == (2, 10, 3)
    assert block.dtype == np.float32
    assert block.flags.c_contiguous
    assert block[1, 3, 2] == 5.0
    assert block[0, 4, 2] == 6.0
    assert block[1, 9, 0] == 7.0


@settings(max_examples=30, deadline=None)
@given(st.integers(1, 9), st.integers(1, 4), st.integers(0, 99))
def test_unpack_is_the_inverse_of_pack(joints: int, streams: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    parts = [rng.normal(size=(streams, joints, c)).astype(np.float32) for c in (4, 3, 3)]
    for found, given_part in zip(unpack_poses(pack_poses(*parts)), parts, strict=True):
        np.testing.assert_array_equal(found, given_part)

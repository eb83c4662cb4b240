"""Baked poses against the two algorithms, agent by agent and frame by frame."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tifo.engine.animation import Clip, ClipBank, Skeleton
from tifo.engine.streams import BakedPoses

Array = NDArray[Any]


@pytest.fixture(scope="session")
def bank(factories: ModuleType) -> ClipBank:
    body = factories.make_body()
    clips = [
        factories.make_clip(body, "sit_idle", 4 / 3),
        factories.make_still(body, "still"),
        factories.make_clip(body, "sit_down", 0.5, looping=False),
    ]
    return ClipBank(body, clips)


@pytest.fixture(scope="session")
def body(factories: ModuleType) -> Skeleton:
    made: Skeleton = factories.make_body()
    return made


@pytest.fixture(scope="session")
def baked(body: Skeleton, bank: ClipBank) -> BakedPoses:
    return BakedPoses(body, bank, markers=np.array([4, 5], np.int64))


def _local(clip: Clip, time: float) -> list[Array]:
    """Rotation, translation and scale of all joints at one time, key by key."""
    place = time / clip.duration * (clip.frame_count - 1) if clip.duration else 0.0
    before = min(int(place + 1e-9), max(clip.frame_count - 2, 0))
    share = place - before if clip.frame_count > 1 else 0.0
    after = min(before + 1, clip.frame_count - 1)
    parts = (clip.rotation, clip.translation, clip.scale)
    return [part[before].astype(float) * (1 - share) + part[after] * share for part in parts]


def test_frames_and_starts_follow_from_durations(baked: BakedPoses) -> None:
    # 4/3 s at 30 a second; one key; half a second with both its ends.
    assert baked.frames.tolist() == [40, 1, 16]
    assert baked.start.tolist() == [0, 40, 41]
    assert baked.palettes.shape == (57, 7, 3, 4)
    assert baked.markers.shape == (57, 2, 4)
    assert baked.nbytes == 57 * 7 * 12 * 4


def test_every_frame_is_parent_times_local_times_inverse_bind(
    factories: ModuleType, body: Skeleton, bank: ClipBank, baked: BakedPoses
) -> None:
    for k, clip in enumerate(bank.clips):
        for frame in range(int(baked.frames[k])):
            pose = _local(clip, frame / 30.0)
            row = int(baked.start[k]) + frame
            expected = factories.reference_palettes(body, *pose)
            np.testing.assert_allclose(baked.palettes[row], expected, atol=2e-5)
            places = factories.reference_models(body.parents, *pose)[[4, 5], :3, 3]
            np.testing.assert_allclose(baked.markers[row, :, :3], places, atol=2e-5)


def test_joints_that_a_clip_leaves_alone_stay_at_its_first_frame(
    factories: ModuleType, body: Skeleton
) -> None:
    moving = factories.make_clip(body, "wave", 1.0)
    rotation = np.tile(moving.rotation[:1], (moving.frame_count, 1, 1))
    rotation[:, 5] = moving.rotation[:, 5]
    translation = np.tile(moving.translation[:1], (moving.frame_count, 1, 1))
    clip = Clip("wave", 1.0, rotation, translation, moving.scale)
    palettes = BakedPoses(body, ClipBank(body, [clip])).palettes
    others = [joint for joint in range(7) if joint != 5]
    np.testing.assert_allclose(
        palettes[:, others], np.broadcast_to(palettes[:1, others], (30, 6, 3, 4)), atol=1e-6
    )
    assert np.ptp(palettes[:, 5], axis=0).max() > 0.3


def test_the_example_of_frame_rows(baked: BakedPoses) -> None:
    rows = baked.frame_rows(np.array([0]), np.ones(1, np.float32), np.array([1.5]))
    assert rows.tolist() == [5]


@settings(max_examples=100)
@given(
    st.lists(
        st.tuples(st.integers(0, 2), st.floats(-2, 2, width=32), st.floats(-50, 500)),
        min_size=1,
        max_size=8,
    )
)
def test_agents_show_the_nearest_frame_round_and_round(
    baked: BakedPoses, agents: list[tuple[int, float, float]]
) -> None:
    frames = (40, 1, 16)
    played = [time * speed * 30.0 for _, speed, time in agents]
    # Half way between two frames either is right.
    assume(all(abs(abs(p - int(p)) - 0.5) > 1e-6 for p in played))
    expected = [
        (0, 40, 41)[clip] + round(p) % frames[clip]
        for (clip, _, _), p in zip(agents, played, strict=True)
    ]
    clip, speed, time = (np.array(column) for column in zip(*agents, strict=True))
    assert baked.frame_rows(clip, speed.astype(np.float32), time).tolist() == expected


@pytest.mark.parametrize("fps", [0.0, -30.0, np.nan, np.inf])
def test_rates_are_positive(body: Skeleton, bank: ClipBank, fps: float) -> None:
    with pytest.raises(ValueError, match=r"fps is .*, expected a positive number"):
        BakedPoses(body, bank, fps=fps)


def test_another_rate_bakes_other_frames(body: Skeleton, bank: ClipBank) -> None:
    baked = BakedPoses(body, bank, fps=15.0)
    assert baked.frames.tolist() == [20, 1, 9]
    rows = baked.frame_rows(np.array([2]), np.ones(1, np.float32), np.array([0.2]))
    assert rows.tolist() == [20 + 1 + 3]

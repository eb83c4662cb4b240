"""Sampling of many clips at once, against hand-computed numbers and one clip at a time."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tifo.engine.animation import Clip, ClipBank, Skeleton
from tifo.engine.animation.pose import unpack_poses

FloatArray = NDArray[np.float32]


@pytest.fixture(scope="session")
def pair(factories: ModuleType) -> Skeleton:
    made: Skeleton = factories.make_skeleton([-1, 0], np.zeros((2, 3)))
    return made


def _ramp(name: str, duration: float, values: list[float], *, looping: bool = True) -> Clip:
    """The X of joint 1's translation goes through `values`; nothing else moves."""
    keys = len(values)
    translation = np.zeros((keys, 2, 3), np.float32)
    translation[:, 1, 0] = values
    rotation = np.tile(np.array([0, 0, 0, 1], np.float32), (keys, 2, 1))
    return Clip(name, duration, rotation, translation, np.ones((keys, 2, 3), np.float32), looping)


def _noise(rng: np.random.Generator, name: str, duration: float, keys: int, loop: bool) -> Clip:
    parts = [rng.normal(size=(keys, 2, c)).astype(np.float32) for c in (4, 3, 3)]
    return Clip(name, duration, parts[0], parts[1], parts[2], loop)


def _sample(bank: ClipBank, clip: list[int], time: list[float], loop: list[bool]) -> FloatArray:
    out, scratch = (np.empty((len(clip), 10, 2), np.float32) for _ in range(2))
    returned = bank.sample(np.array(clip), np.array(time, float), np.array(loop), out, scratch)
    assert returned is out
    return out


def _value(bank: ClipBank, clip: int, time: float, *, loop: bool) -> float:
    _, translation, _ = unpack_poses(_sample(bank, [clip], [time], [loop]))
    return float(translation[0, 1, 0])


@pytest.mark.parametrize(
    ("time", "expected"),
    [
        (0.0, 0.0),
        (0.25, 2.5),
        (1.0, 10.0),
        (1.5, 25.0),
        (2.0, 0.0),
        (2.25, 2.5),
        (-0.5, 25.0),
        (-2.0, 0.0),
        (-2.5, 25.0),
        (200.25, 2.5),
    ],
)
def test_a_looping_clip_wraps_in_both_directions(
    pair: Skeleton, time: float, expected: float
) -> None:
    # Keys at 0, 1 and 2 s.
    bank = ClipBank(pair, [_ramp("other", 1.0, [90, 91]), _ramp("a", 2.0, [0, 10, 40])])
    assert _value(bank, 1, time, loop=True) == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize(
    ("time", "expected"), [(-3.0, 0.0), (0.0, 0.0), (0.5, 5.0), (1.75, 32.5), (2.0, 40.0), (9, 40)]
)
def test_a_clip_that_does_not_loop_stays_at_its_ends(
    pair: Skeleton, time: float, expected: float
) -> None:
    bank = ClipBank(pair, [_ramp("a", 2.0, [0, 10, 40], looping=False)])
    assert _value(bank, 0, time, loop=False) == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize("duration", [0.0, 3.0])
@pytest.mark.parametrize("loop", [True, False])
def test_a_single_key_is_shown_at_any_time(pair: Skeleton, duration: float, loop: bool) -> None:
    bank = ClipBank(pair, [_ramp("before", 1.0, [1, 2]), _ramp("still", duration, [7.0])])
    for time in (-5.3, 0.0, 0.4, 1e6):
        assert _value(bank, 1, time, loop=loop) == 7.0


def test_the_example_of_locate(pair: Skeleton) -> None:
    # A 2 s looping clip at -0.5 s shows 1.5 s: half way between its second and third key.
    bank = ClipBank(pair, [_ramp("a", 1.0, [0, 0]), _ramp("b", 2.0, [0, 0, 0])])
    row, weight = bank.locate(np.array([1]), np.array([-0.5]), np.array([True]))
    assert row.tolist() == [3]
    assert weight.tolist() == [0.5]


def test_the_end_of_one_clip_is_not_mixed_with_the_start_of_the_next(pair: Skeleton) -> None:
    bank = ClipBank(pair, [_ramp("a", 1.0, [0, 5], looping=False), _ramp("b", 1.0, [100, 200])])
    assert _value(bank, 0, 1.0, loop=False) == 5.0
    assert _value(bank, 0, 0.999999, loop=False) == pytest.approx(5.0, abs=1e-3)


def test_a_time_just_before_zero_does_not_leave_the_clip(pair: Skeleton) -> None:
    bank = ClipBank(pair, [_ramp("a", 2.0, [3, 10, 4]), _ramp("b", 1.0, [100, 200])])
    # The remainder of -1e-20 is the duration itself in floating point.
    assert _value(bank, 0, -1e-20, loop=True) == 4.0


def _reference(clip: Clip, time: float, *, loop: bool) -> list[NDArray[Any]]:
    parts = [part.astype(float) for part in (clip.rotation, clip.translation, clip.scale)]
    if clip.duration == 0 or clip.frame_count == 1:
        return [part[0] for part in parts]
    if loop:
        local = time - clip.duration * np.floor(time / clip.duration)
    else:
        local = min(max(time, 0.0), clip.duration)
    place = local / clip.duration * (clip.frame_count - 1)
    before = min(int(place), clip.frame_count - 2)
    share = place - before
    return [part[before] * (1 - share) + part[before + 1] * share for part in parts]


@settings(max_examples=60, deadline=None)
@given(
    st.lists(
        st.tuples(st.integers(0, 2), st.floats(-50, 50, allow_subnormal=False), st.booleans()),
        min_size=1,
        max_size=6,
    ),
    st.integers(0, 2**32),
)
def test_sampling_is_that_of_one_clip_at_a_time(
    pair: Skeleton, wanted: list[tuple[int, float, bool]], seed: int
) -> None:
    rng = np.random.default_rng(seed)
    lengths = ((1.3, 79), (0.0, 1), (0.41, 5))
    clips = [_noise(rng, str(k), d, keys, True) for k, (d, keys) in enumerate(lengths)]
    bank = ClipBank(pair, clips)
    clip, time, loop = ([*column] for column in zip(*wanted, strict=True))
    found = unpack_poses(_sample(bank, clip, time, loop))
    for stream, (k, t, wraps) in enumerate(wanted):
        if k != 1 and wraps and min(t % lengths[k][0], -t % lengths[k][0]) < 1e-6:
            continue  # The seam of these clips is a jump; either side of it is right.
        for got, expected in zip(found, _reference(clips[k], t, loop=wraps), strict=True):
            np.testing.assert_allclose(got[stream], expected, atol=2e-4)


def test_playing_backwards_shows_the_same_poses_in_reverse(pair: Skeleton) -> None:
    bank = ClipBank(pair, [_ramp("a", 2.0, [0, 10, 40, 0])])
    times = np.arange(40) / 30.0 + 0.01
    forwards = [_value(bank, 0, float(t), loop=True) for t in times]
    backwards = [_value(bank, 0, float(t) - 2.0, loop=True) for t in times[::-1]]
    np.testing.assert_allclose(backwards, forwards[::-1], atol=1e-4)


def test_linear_mixing_of_rotations_stays_near_spherical_interpolation(
    factories: ModuleType,
) -> None:
    # Keys 1/60 s apart at 10 rad/s; kinematics normalises, so compare directions.
    body = factories.make_skeleton([-1], np.zeros((1, 3)))
    step = 10.0 / 60.0
    rotation = np.zeros((2, 1, 4), np.float32)
    rotation[:, 0, 1] = 0.0, np.sin(step / 2)
    rotation[:, 0, 3] = 1.0, np.cos(step / 2)
    zero, one = np.zeros((2, 1, 3), np.float32), np.ones((2, 1, 3), np.float32)
    bank = ClipBank(body, [Clip("turn", 1 / 60, rotation, zero, one)])
    for share in (0.2, 0.5, 0.8):
        q = bank.sample_one(0, share / 60)[0, :4].astype(float)
        angle = 2 * np.arctan2(q[1], q[3])
        assert abs(angle - share * step) < 1e-4


def test_sample_one_wraps_as_its_clip_does(pair: Skeleton) -> None:
    loop, stay = _ramp("a", 2.0, [0, 10, 40]), _ramp("b", 2.0, [0, 10, 40], looping=False)
    bank = ClipBank(pair, [loop, stay])
    assert unpack_poses(bank.sample_one(0, 2.5))[1][0, 1, 0] == pytest.approx(5.0)
    assert unpack_poses(bank.sample_one(1, 2.5))[1][0, 1, 0] == pytest.approx(40.0)


def test_clips_are_found_by_name(pair: Skeleton) -> None:
    bank = ClipBank(pair, [_ramp("sit", 1.0, [0, 0]), _ramp("clap", 1.0, [0, 0])])
    assert bank.index("clap") == 1
    with pytest.raises(ValueError, match="no clip 'jump'; known: sit, clap"):
        bank.index("jump")


def test_a_bank_needs_clips_of_the_skeleton(pair: Skeleton, factories: ModuleType) -> None:
    with pytest.raises(ValueError, match="at least one clip"):
        ClipBank(pair, [])
    _, slide = factories.make_slide()
    with pytest.raises(ValueError, match="has 1 joints, the skeleton has 2"):
        ClipBank(pair, [slide])

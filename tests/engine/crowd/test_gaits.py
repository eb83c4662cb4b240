"""Gaits of people on their way: speeds, and side steps that stay in place without sliding."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from bodies import model_places

from tifo.engine.assets.spectator import MOTIONS, builtin_spectator
from tifo.engine.crowd.figure import MARKERS, make_figure
from tifo.engine.crowd.gaits import SIDE_SPEEDS, SPEEDS, make_gaits, nearest, sideways


@pytest.fixture(scope="module")
def built_in() -> tuple[Any, int]:
    character = builtin_spectator()
    return character, int(make_figure(character).joints[MARKERS.index("hips")])


def test_each_speed_is_played_by_a_walk_at_its_rate(built_in: Any) -> None:
    character, hips = built_in
    gaits = make_gaits(character.clips, hips)
    walks = [gait for gait in gaits if gait.kind == "walk"]
    assert [gait.speed for gait in walks] == list(SPEEDS)
    for gait in walks:
        assert gait.rate * MOTIONS[gait.clip.name].speed == pytest.approx(gait.speed)
    sides = [(gait.kind, gait.speed) for gait in gaits if gait.kind in ("left", "right")]
    assert sides == [(side, speed) for side in ("left", "right") for speed in SIDE_SPEEDS]


def test_no_walk(built_in: Any) -> None:
    character, hips = built_in
    with pytest.raises(ValueError, match="no clip 'walk'"):
        make_gaits([clip for clip in character.clips if "walk" not in clip.name], hips)


@pytest.mark.parametrize(
    ("name", "walks"),
    [("Walking_A", True), ("walk_2", True), ("Walking", True), ("Walking_Backwards", False),
     ("WalkJump", False)],
)  # fmt: skip
def test_walks_are_known_by_the_names_that_files_give_them(
    built_in: Any, name: str, walks: bool
) -> None:
    character, hips = built_in
    clip = next(clip for clip in character.clips if clip.name == "walk")
    if walks:
        (own, *_) = make_gaits([replace(clip, name=name)], hips)
        assert own.clip.name == name
    else:
        with pytest.raises(ValueError, match="no clip 'walk'"):
            make_gaits([replace(clip, name=name)], hips)


@pytest.mark.parametrize(("name", "way"), [("side_step", 1.0), ("side_step_2", -1.0)])
def test_side_steps_are_loops_whose_feet_stand(built_in: Any, name: str, way: float) -> None:
    character, hips = built_in
    clip = next(clip for clip in character.clips if clip.name == name)
    loop, pace = sideways(clip, hips)
    assert loop.looping
    np.testing.assert_allclose(loop.rotation[0], loop.rotation[-1], atol=1e-5)
    np.testing.assert_allclose(loop.translation[0], loop.translation[-1], atol=1e-5)
    assert 0.15 < way * pace < 0.35
    # Moved at its pace, each foot's lower moments are where they were a moment before.
    places = model_places(character.skeleton, loop)
    seconds = np.linspace(0.0, loop.duration, loop.frame_count)
    key = seconds[1]
    for side in ("l", "r"):
        foot = int(make_figure(character).joints[MARKERS.index(f"foot_{side}")])
        x = places[:, foot, 0] + pace * seconds
        height = places[:, foot, 1]
        bears = height < height.min() + 0.004
        both = bears[1:] & bears[:-1]
        assert both.sum() > 10
        assert (np.abs(np.diff(x))[both] / key).max() < 0.12


def test_nearest_gait() -> None:
    table = (np.array([5, 6, 7], np.int16), np.array([0.3, 0.5, 1.0], np.float32))
    speeds = np.array([0.0, 0.39, 0.41, 0.74, 0.76, 3.0], np.float32)
    assert nearest(table, speeds).tolist() == [5, 5, 6, 6, 7, 7]

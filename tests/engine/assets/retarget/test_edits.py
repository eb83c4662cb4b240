"""Mirroring, trimming and looping clips."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bodies import Body, model_places
from scipy.spatial.transform import Rotation

import tifo
from tifo.engine.animation.clip import Clip, ClipEvent

SWAP = {"left": "right", "right": "left"}


def swing(body: Body, seconds: float, period: float, speed: float = 0.0, turn: float = 0.0) -> Clip:
    """Legs and arms that swing with a period, while the body travels and turns."""
    poses, hips = [], []
    for time in np.arange(round(seconds * 60) + 1) / 60:
        a = 30 * np.sin(2 * np.pi * time / period)
        b = 20 * np.cos(2 * np.pi * time / period)
        hips.append([0.1, 0.94 + 0.0005 * b, speed * time])
        poses.append(
            {
                "hips": Rotation.from_euler("y", turn * time, degrees=True),
                "left_upper_leg": Rotation.from_euler("x", a, degrees=True),
                "right_upper_leg": Rotation.from_euler("x", -a, degrees=True),
                "left_upper_arm": Rotation.from_euler("zy", [-70, b], degrees=True),
                "left_lower_arm": Rotation.from_euler("y", -40 + b, degrees=True),
                "head": Rotation.from_euler("yx", [b, 5], degrees=True),
            }
        )
    return body.clip(poses, np.array(hips))


BODIES = [
    Body(),
    Body("mixamo", axes=np.random.default_rng(1)),
    Body("daz", axes=np.random.default_rng(2), world=Rotation.from_euler("y", 90, degrees=True)),
]


@pytest.mark.parametrize("body", BODIES[:2])
def test_a_mirrored_body_does_with_the_left_what_it_did_with_the_right(body: Body) -> None:
    clip = replace(
        swing(body, 0.2, 1.0, speed=1.0),
        events=(ClipEvent(0.1, "foot_left"), ClipEvent(0.1, "clap")),
    )
    mirrored = tifo.mirror_clip(clip, body.skeleton)
    here, there = model_places(body.skeleton, clip), model_places(body.skeleton, mirrored)
    for joint, part in enumerate(body.parts):
        side, _, rest = part.partition("_")
        other = body.parts.index(f"{SWAP[side]}_{rest}") if side in SWAP else joint
        np.testing.assert_allclose(there[:, joint], here[:, other] * [-1, 1, 1], atol=1e-5)
    assert mirrored.name == "move mirrored"
    assert [event.name for event in mirrored.events] == ["foot_right", "clap"]


@pytest.mark.parametrize("body", BODIES)
def test_mirrored_twice_is_the_same(body: Body) -> None:
    clip = swing(body, 0.2, 1.0, speed=1.0)
    again = tifo.mirror_clip(tifo.mirror_clip(clip, body.skeleton), body.skeleton, "move")
    dots = np.abs(np.sum(again.rotation * clip.rotation, axis=-1))
    np.testing.assert_allclose(dots, 1, atol=1e-6)
    np.testing.assert_allclose(again.translation, clip.translation, atol=1e-6)


def test_the_spectator_is_mirrored() -> None:
    spectator = tifo.builtin_spectator()
    wave = tifo.mirror_clip(spectator.clip("wave"), spectator.skeleton)
    here = model_places(spectator.skeleton, spectator.clip("wave"))
    there = model_places(spectator.skeleton, wave)
    left, right = (spectator.skeleton.index(f"hand_{side}") for side in "lr")
    np.testing.assert_allclose(there[:, left], here[:, right] * [-1, 1, 1], atol=2e-3)


def test_a_clip_is_trimmed() -> None:
    body = Body()
    clip = replace(
        swing(body, 2.0, 1.0, speed=1.0), events=(ClipEvent(0.2, "early"), ClipEvent(1.0, "kept"))
    )
    part = tifo.trim_clip(clip, 0.5, 1.25)
    assert part.duration == 0.75
    assert part.frame_count == 46
    np.testing.assert_allclose(part.translation[0], clip.translation[30], atol=1e-6)
    np.testing.assert_allclose(part.rotation[-1], clip.rotation[75], atol=1e-6)
    assert part.events == (ClipEvent(0.5, "kept"),)
    # Between two keys.
    part = tifo.trim_clip(clip, 0.5 + 1 / 120, 1.0)
    assert part.translation[0, 0, 2] == pytest.approx(0.5 + 1 / 120, abs=1e-5)
    with pytest.raises(ValueError, match="expected 0 <= start < end <= 2 s"):
        tifo.trim_clip(clip, 1.5, 1.0)
    with pytest.raises(ValueError, match="start"):
        tifo.trim_clip(clip, 0.0, 2.5)


@pytest.mark.parametrize(("speed", "turn"), [(0.0, 0.0), (1.4, 0.0), (1.0, 40.0)])
def test_a_loop_is_one_period_long(speed: float, turn: float) -> None:
    body = Body(axes=np.random.default_rng(4))
    clip = swing(body, 2.5, 0.8, speed, turn)
    loop = tifo.find_loop(clip, body.skeleton, shortest=0.5, longest=1.2)
    assert loop.end - loop.start == pytest.approx(0.8, abs=1e-6)
    assert loop.distance < 1e-3
    closed = tifo.loop_clip(clip, body.skeleton, loop)
    assert closed.looping
    places = model_places(body.skeleton, closed)
    np.testing.assert_allclose(places[0], places[-1], atol=1e-5)
    steps = np.linalg.norm(np.diff(places, axis=0), axis=-1)
    assert steps.max() < 0.07
    # In place: what it travelled is taken out; a way that bent by 32 degrees is left as an arc.
    assert np.ptp(places[:, 0, [0, 2]], axis=0).max() < (0.08 if turn else 0.001)


def test_a_loop_that_does_not_match_is_blended() -> None:
    body = Body()
    clip = swing(body, 1.0, 3.0)
    closed = tifo.loop_clip(clip, body.skeleton, tifo.Loop(0.0, 1.0, 1.0), blend=0.3)
    places = model_places(body.skeleton, closed)
    np.testing.assert_allclose(places[0], places[-1], atol=1e-5)
    before = model_places(body.skeleton, clip)
    # What lies before the blend is as it was.
    np.testing.assert_allclose(places[:42], before[:42], atol=1e-5)
    assert np.linalg.norm(np.diff(places, axis=0), axis=-1).max() < 0.1


def test_wrong_loops() -> None:
    body = Body()
    clip = swing(body, 0.4, 1.0)
    with pytest.raises(ValueError, match="expected 0 < shortest <= longest"):
        tifo.find_loop(clip, body.skeleton, shortest=0.5)
    with pytest.raises(ValueError, match="blend is -1"):
        tifo.loop_clip(clip, body.skeleton, blend=-1)
    pose = tifo.retarget(body.clip([{}], body.flat[:1]), body.skeleton, body.skeleton)
    with pytest.raises(ValueError, match="loop in clip 'move' of 0 s"):
        tifo.find_loop(pose, body.skeleton)

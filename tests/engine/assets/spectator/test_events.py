"""Event tags are at the times at which the things happen that they are called after."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest
from joint_motion import Array, JointMotion

from tifo.engine.assets.spectator import MOTIONS
from tifo.engine.assets.spectator.tags import events_of

Variants = Callable[..., Iterator[JointMotion]]


def times(motion: JointMotion, event: str) -> list[float]:
    return [found.time for found in motion.clip.events if found.name == event]


def near(motion: JointMotion, values: Array, time: float, seconds: float) -> Array:
    """Values around a time; a loop goes on at its seam."""
    key = round(time / motion.step)
    reach = round(seconds / motion.step)
    index = np.arange(key - reach, key + reach + 1)
    if motion.clip.looping:
        return values[index % (motion.clip.frame_count - 1)]
    return values[np.clip(index, 0, motion.clip.frame_count - 1)]


def test_events_of_every_clip_are_what_the_table_says(motions: dict[str, JointMotion]) -> None:
    assert {event.name for motion in MOTIONS.values() for event in motion.events} == {
        *("clap_contact", "foot_left", "foot_right", "apex", "landing", "kick", "shout"),
    }
    for name, motion in motions.items():
        assert motion.clip.events == events_of(name) == MOTIONS[name].events
        assert all(0 <= event.time <= motion.clip.duration for event in motion.clip.events)


def test_hands_are_nearest_at_clap_contact(motions: dict[str, JointMotion]) -> None:
    checked = 0
    for name, motion in motions.items():
        for time in times(motion, "clap_contact"):
            apart = np.linalg.norm(motion.place("hand_l") - motion.place("hand_r"), axis=1)
            around = near(motion, apart, time, 0.1)
            assert around.argmin() == len(around) // 2, f"{name} {time}"
            assert around.min() < 0.06
            assert around.max() > 1.6 * around.min(), f"{name} {time}"
            checked += 1
    assert checked > 70


@pytest.mark.parametrize(("name", "rate"), [
    ("clap", 3.33), ("clap_2", 2.0), ("clap_3", 4.29), ("clap_4", 2.5), ("sit_clap_2", 2.0),
    ("clap_beat_3", 4.29), ("sit_clap_beat", 3.33),
])  # fmt: skip
def test_claps_come_at_several_rates(
    motions: dict[str, JointMotion], name: str, rate: float
) -> None:
    motion = motions[name]
    found = times(motion, "clap_contact")
    assert len(found) / motion.clip.duration == pytest.approx(rate, abs=0.01)
    if len(found) > 1:
        np.testing.assert_allclose(np.diff(found), 1 / rate, atol=1e-3)


def test_feet_come_down_at_their_tags(variants: Variants) -> None:
    for motion in variants("walk", "jog", "run"):
        for side, event in (("_l", "foot_left"), ("_r", "foot_right")):
            (time,) = times(motion, event)
            points = [
                motion.point("foot" + side, (0.0, -0.088, -0.060)),
                motion.point("toe" + side, (0.0, -0.028, 0.0)),
            ]
            low = np.min([p[:, 1] for p in points], axis=0)
            before = near(motion, low, time - 0.04, 0.001)
            after = near(motion, low, time + 0.04, 0.001)
            assert before.min() > 0.004, f"{motion.name} {event}"
            assert after.max() < 0.004, f"{motion.name} {event}"
            # Hardly faster downwards than a step of a few centimetres.
            fall = np.gradient(low, motion.step)
            assert near(motion, fall, time, 0.02).min() > -1.3


def test_hips_are_highest_at_the_apex_of_a_jump(variants: Variants) -> None:
    for motion in variants("jump"):
        height = motion.place("hips")[:, 1]
        (apex,), (landing,) = times(motion, "apex"), times(motion, "landing")
        assert apex == pytest.approx(motion.times[height.argmax()], abs=1.5 / 60)
        toe = motion.place("toe_l")[:, 1] - motion.place("toe_l")[0, 1]
        assert near(motion, toe, landing - 0.05, 0.001).min() > 0.01
        assert near(motion, toe, landing + 0.02, 0.001).max() < 0.005


def test_hands_are_highest_at_the_apex_of_a_wave(motions: dict[str, JointMotion]) -> None:
    for name in ("mexican_wave", "sit_mexican_wave"):
        motion = motions[name]
        hands = motion.place("hand_l")[:, 1] + motion.place("hand_r")[:, 1]
        (apex,) = times(motion, "apex")
        assert apex == pytest.approx(motion.times[hands.argmax()], abs=0.03)


def test_the_foot_is_fast_low_and_ahead_when_it_meets_the_ball(variants: Variants) -> None:
    for motion in variants("kick"):
        (time,) = times(motion, "kick")
        key = round(time / motion.step)
        toe = motion.place("toe_r")
        speed = np.linalg.norm(np.gradient(toe, motion.step, axis=0), axis=1)
        assert speed[key] > 0.75 * speed.max()
        assert toe[key, 1] < 0.16
        assert toe[key, 2] > 0.2


def test_heads_go_back_when_voices_go_up(motions: dict[str, JointMotion]) -> None:
    """Within a tenth of a second of a shout the head's pitch has a turning point, upwards."""
    checked = 0
    for name, motion in motions.items():
        for time in times(motion, "shout"):
            up = motion.turn("head")[:, 1, 2]
            around = near(motion, up, time, 0.13)
            top = int(around.argmax())
            assert 0 < top < len(around) - 1, f"{name} {time}"
            assert abs(top - len(around) // 2) * motion.step < 0.115, f"{name} {time}"
            checked += 1
    assert checked > 90

"""Baked crowds: every agent a clip, a speed and a start."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from tifo.systems.simulation import Simulation

MakeSimulation = Callable[..., Simulation]


def test_agents_begin_with_their_innate_clip_in_all_phases(simulate: MakeSimulation) -> None:
    crowd = simulate(poses="baked").crowd
    assert crowd.baked is not None
    clips = crowd.baked[1]
    names = [crowd.character.clips[clip].name for clip in clips.clip]
    assert names == [crowd.library.names[motion] for motion in crowd.motion.shown]
    assert "walk" not in names
    assert clips.began.max() <= 0
    assert np.ptp(clips.began) > 200
    assert clips.speed.min() >= np.float32(0.92)
    assert clips.speed.max() <= np.float32(1.08)


@pytest.mark.parametrize("alpha", [0.0, 0.4, 1.0])
def test_agents_show_the_frame_nearest_to_the_shown_time(
    simulate: MakeSimulation, alpha: float
) -> None:
    simulation = simulate(poses="baked", rows=5)
    simulation.run(seconds=1.5)
    crowd = simulation.crowd
    assert crowd.baked is not None
    poses, clips = crowd.baked
    tick = simulation.clock.pose_tick
    shown = crowd.palettes(np.arange(100), tick, alpha)
    for agent in range(100):
        clip = crowd.character.clips[clips.clip[agent]]
        # A pose tick is one of 30 a second, and so is a baked frame.
        played = (tick - 1 + alpha - clips.began[agent]) * float(clips.speed[agent])
        row = int(poses.start[clips.clip[agent]]) + round(played) % round(clip.duration * 30)
        near_tie = abs(played % 1.0 - 0.5) < 1e-4
        assert near_tie or (shown[agent] == poses.palettes[row]).all()

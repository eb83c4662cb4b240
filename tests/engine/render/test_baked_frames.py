"""Baked crowds: the frame rule of *Algorithms* 2, evaluated on the GPU and on the CPU."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
import pytest

from tifo.components import BakedAnim
from tifo.engine.animation import ClipBank
from tifo.engine.streams.baked import BakedPoses

pytestmark = pytest.mark.gl

AGENTS = 300


def make(factories: ModuleType, seed: int, tick: int) -> tuple[BakedPoses, BakedAnim]:
    """Eight clips, more frames than one layer of 256 holds, one of them not looping."""
    clips = ("idle", "clap", "cheer", "dismay", "wave", "dance", "stand_up", "sit")
    character = factories.make_character(clips)
    poses = BakedPoses(character.skeleton, ClipBank(character.skeleton, character.clips))
    assert len(poses.palettes) > 256
    rng = np.random.default_rng(seed)
    return poses, BakedAnim(
        clip=rng.integers(0, len(clips), AGENTS).astype(np.int32),
        speed=rng.uniform(0.3, 1.7, AGENTS).astype(np.float32),
        began=tick - rng.uniform(-2.0, 500.0, AGENTS),
    )


@pytest.mark.parametrize(("seed", "tick"), [(1, 40), (2, 2**14 + 3), (3, 10**6)])
def test_every_agent_shows_the_frame_of_its_time(
    seed: int, tick: int, factories: ModuleType, shader_crowd: Any
) -> None:
    poses, anim = make(factories, seed, tick)
    crowd = shader_crowd((poses, anim))
    agents = np.arange(AGENTS)
    for step, alpha in ((0, 0.0), (1, 0.5), (2, 1.0), (40, 0.3)):
        crowd.update(tick + step)
        shown = crowd.palettes(agents, tick + step, alpha)
        # round(t * speed * fps) mod frames, with t in seconds since the agent began.
        seconds = (tick + step - 1 + alpha - anim.began) / 30.0
        played = seconds * anim.speed.astype(float) * poses.fps
        # A rounding that could go either way in float32 is left out.
        clear = np.abs(played - np.floor(played) - 0.5) > 2e-3
        assert clear.mean() > 0.97
        frame = np.floor(played + 0.5).astype(int) % poses.frames[anim.clip]
        expected = poses.palettes[poses.start[anim.clip] + frame]
        np.testing.assert_allclose(shown[clear], expected[clear], rtol=0, atol=2e-6)
        rows = poses.frame_rows(anim.clip.astype(np.int64), anim.speed, seconds)
        np.testing.assert_allclose(shown[clear], poses.palettes[rows][clear], rtol=0, atol=2e-6)


def test_a_change_of_clip_arrives_with_the_version(
    factories: ModuleType, shader_crowd: Any
) -> None:
    poses, anim = make(factories, 4, 100)
    crowd = shader_crowd((poses, anim))
    crowd.update(100)
    assert crowd.update(101) == 0, "nothing changed, nothing is copied"
    anim.clip[7], anim.began[7], anim.speed[7] = 2, 99.0, 1.0
    anim.version += 1
    assert crowd.update(101) > 0
    # One tick after its beginning it shows frame 1 of its clip.
    (shown,) = crowd.palettes([7], 101, 0.0)
    np.testing.assert_allclose(shown, poses.palettes[poses.start[2] + 1], rtol=0, atol=2e-6)

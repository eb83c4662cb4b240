"""What the tests of the built-in motions share: where every joint is at every key."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from joint_motion import JointMotion, follow_joints

from tifo.engine.assets.character import Character
from tifo.engine.assets.spectator import builtin_spectator


@pytest.fixture(scope="session")
def spectator() -> Character:
    return builtin_spectator()


@pytest.fixture(scope="session")
def motions(spectator: Character) -> dict[str, JointMotion]:
    """Every clip that ships, by name."""
    return {clip.name: follow_joints(spectator.skeleton, clip) for clip in spectator.clips}


@pytest.fixture(scope="session")
def variants(motions: dict[str, JointMotion]) -> Callable[..., Iterator[JointMotion]]:
    """Motions of some kinds with all their variants: ``variants("walk", "jog")``."""

    def find(*kinds: str) -> Iterator[JointMotion]:
        for name, motion in motions.items():
            stem, _, number = name.rpartition("_")
            if name in kinds or (number.isdigit() and stem in kinds):
                yield motion

    return find

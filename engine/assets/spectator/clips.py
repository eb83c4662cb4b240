"""All motions of the built-in spectator, in the order of the shipped file."""

from __future__ import annotations

from ...animation.clip import Clip
from ...animation.skeleton import Skeleton
from . import excited, seated, upright

PERFORMANCES = (
    seated.sit_idle,
    seated.sit_idle_2,
    seated.sit_clap,
    seated.stand_up,
    seated.sit_down,
    upright.stand_idle,
    upright.stand_idle_2,
    upright.clap,
    excited.cheer,
    excited.cheer_2,
    excited.jump,
    excited.wave,
    excited.dismay,
)


def spectator_clips(skeleton: Skeleton) -> tuple[Clip, ...]:
    """Every clip, with 60 keys a second."""
    return tuple(make().clip(skeleton) for make in PERFORMANCES)

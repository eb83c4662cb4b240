"""The order of a frame, in one place."""

from __future__ import annotations

from enum import IntEnum


class Phase(IntEnum):
    """esper priorities of the systems: higher runs first."""

    WALKING = 75
    BEHAVIOUR = 70
    TRANSITIONS = 60
    DILATION = 55
    CLAPS = 53
    CONTROLLERS = 50
    HISTORY = 40
    CLIP_EVENTS = 35
    RECORD = 32
    DETAIL = 30
    RENDER = 20

"""tifo fills a stadium with animated spectators.

What a game, a script or a test needs is here; importing it loads neither a window system nor GL.
`Stage` and `open_window` load them when they are first asked for.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .components import (
    AgentAnimID,
    Appearance,
    Behaviour,
    Emotion,
    MotionState,
    Placement,
    Seat,
    Team,
    View,
)
from .engine.animation import controllers
from .engine.animation.clip import ClipEvent
from .engine.assets.character import Character, Material, SkinnedMesh
from .engine.assets.load import add_motions, load_character
from .engine.assets.spectator import builtin_spectator
from .engine.behaviour import BehaviourTable, load_table
from .engine.behaviour.events import BallHit, Event, Goal
from .engine.clock import Clock
from .engine.crowd.cameras import camera_presets
from .engine.crowd.pick import pick_seat
from .engine.crowd.spec import CrowdSpec
from .engine.crowd.stadium import build_seats
from .engine.errors import AssetError, GraphicsError, TifoError
from .engine.streams import Stream, StreamPool, Unique, UniquePool
from .scripting.camera import CameraMode, FreeCamera
from .systems.crowd import Crowd
from .systems.schedule import Schedule, add_systems, tick_systems
from .systems.simulation import Simulation, character_of
from .systems.spawn import spawn_crowd

if TYPE_CHECKING:
    from .engine.gl.context import open_window
    from .scripting.stage import Stage
    from .systems.render import RenderSystem

__version__ = "0.1.0"

__all__ = [
    "AgentAnimID",
    "Appearance",
    "AssetError",
    "BallHit",
    "Behaviour",
    "BehaviourTable",
    "CameraMode",
    "Character",
    "ClipEvent",
    "Clock",
    "Crowd",
    "CrowdSpec",
    "Emotion",
    "Event",
    "FreeCamera",
    "Goal",
    "GraphicsError",
    "Material",
    "MotionState",
    "Placement",
    "RenderSystem",
    "Schedule",
    "Seat",
    "Simulation",
    "SkinnedMesh",
    "Stage",
    "Stream",
    "StreamPool",
    "Team",
    "TifoError",
    "Unique",
    "UniquePool",
    "View",
    "add_motions",
    "add_systems",
    "build_seats",
    "builtin_spectator",
    "camera_presets",
    "character_of",
    "controllers",
    "load_character",
    "load_table",
    "open_window",
    "pick_seat",
    "spawn_crowd",
    "tick_systems",
]

_DRAWING = {
    "RenderSystem": "systems.render",
    "Stage": "scripting.stage",
    "open_window": "engine.gl.context",
}


def __getattr__(name: str) -> Any:
    """Load what draws only when it is asked for."""
    if name not in _DRAWING:
        raise AttributeError(f"module 'tifo' has no attribute '{name}'")
    from importlib import import_module

    return getattr(import_module(f"tifo.{_DRAWING[name]}"), name)

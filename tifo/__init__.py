"""tifo fills a stadium with animated spectators.

What a game, a script or a test needs is here; importing it loads neither a window system nor GL.
`Stage`, `open_window` and `WindowInput` load them when they are first asked for.
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
from .engine.assets.character import Character, Material, SkinnedMesh, Variant
from .engine.assets.load import add_motions, load_character
from .engine.assets.motion_file import Motions, load_motions
from .engine.assets.props import PROPS, Prop, builtin_prop, drumming
from .engine.assets.retarget import (
    Humanoid,
    Loop,
    NotHumanoidError,
    find_loop,
    humanoid,
    loop_clip,
    mirror_clip,
    retarget,
    trim_clip,
)
from .engine.assets.spectator import builtin_spectator
from .engine.assets.variants import one_look, variant_groups
from .engine.behaviour import BehaviourTable, load_table
from .engine.behaviour.event_file import load_events
from .engine.behaviour.events import PLACED, BallHit, Event, Goal
from .engine.clock import Clock
from .engine.crowd.cameras import camera_presets
from .engine.crowd.kits import PATTERNS, Kit
from .engine.crowd.pick import pick_seat
from .engine.crowd.spec import CrowdSpec
from .engine.crowd.stadium import build_seats
from .engine.errors import AssetError, GraphicsError, TifoError
from .engine.export import ClipSchedule, Exported, Recording
from .engine.overrides import JointOverride, LookAt, OverriddenJoints, look_at, turn_about
from .engine.streams import Stream, StreamPool, Unique, UniquePool
from .scripting.camera import CameraMode, FreeCamera
from .systems.casting import clone_report
from .systems.clip_recorder import ClipRecorder
from .systems.crowd import Crowd
from .systems.export import export_gltf, export_usd
from .systems.part import Part
from .systems.parts import add_part, remove_part
from .systems.props import give_props
from .systems.recording import Recorder
from .systems.schedule import Schedule, add_systems, tick_systems
from .systems.simulation import Simulation, character_of
from .systems.spawn import spawn_crowd
from .systems.state_recorder import StateRecorder

if TYPE_CHECKING:
    from .engine.animation.controllers import OneShotRequest
    from .engine.gl.adopted import AdoptedContext, adopt_context
    from .engine.gl.context import open_window
    from .scripting import nodes
    from .scripting.easing import Ease, Trans, ease
    from .scripting.exports import Export, export, exports_of
    from .scripting.hot_reload import HotReload
    from .scripting.input_events import (
        InputEvent,
        InputEventAction,
        InputEventJoypadButton,
        InputEventJoypadMotion,
        InputEventKey,
        InputEventMouseButton,
        InputEventMouseMotion,
    )
    from .scripting.input_log import InputLog
    from .scripting.input_map import InputMap
    from .scripting.input_state import Input
    from .scripting.lifecycle import ProcessMode
    from .scripting.node import Node, is_instance_valid
    from .scripting.node3d import Node3D
    from .scripting.nodes import (
        Agent,
        AnimationPlayer,
        AnimationTree,
        Ball,
        Camera,
        Player,
        Section,
        Stadium,
        StateMachinePlayback,
    )
    from .scripting.packed_scene import PackedScene, load_scene
    from .scripting.paths import NodePathError
    from .scripting.reports import FreedError, ScriptError
    from .scripting.resources import (
        Resource,
        add_loader,
        load,
        resource_root,
        save_resource,
        set_resource_root,
    )
    from .scripting.scene_writing import save_scene
    from .scripting.signals import Signal
    from .scripting.stage import Stage
    from .scripting.tasks import Task
    from .scripting.timers import ProcessCallback, SceneTreeTimer, Timer
    from .scripting.tree import GroupCall, SceneTree
    from .scripting.tween import Tween, TweenPause
    from .scripting.vectors import Quaternion, Vector3
    from .scripting.window_input import WindowInput
    from .scripting.window_run import run
    from .systems.render import RenderSystem

__version__ = "0.1.0"

__all__ = [
    "PATTERNS",
    "PLACED",
    "PROPS",
    "AdoptedContext",
    "Agent",
    "AgentAnimID",
    "AnimationPlayer",
    "AnimationTree",
    "Appearance",
    "AssetError",
    "Ball",
    "BallHit",
    "Behaviour",
    "BehaviourTable",
    "Camera",
    "CameraMode",
    "Character",
    "ClipEvent",
    "ClipRecorder",
    "ClipSchedule",
    "Clock",
    "Crowd",
    "CrowdSpec",
    "Ease",
    "Emotion",
    "Event",
    "Export",
    "Exported",
    "FreeCamera",
    "FreedError",
    "Goal",
    "GraphicsError",
    "GroupCall",
    "HotReload",
    "Humanoid",
    "Input",
    "InputEvent",
    "InputEventAction",
    "InputEventJoypadButton",
    "InputEventJoypadMotion",
    "InputEventKey",
    "InputEventMouseButton",
    "InputEventMouseMotion",
    "InputLog",
    "InputMap",
    "JointOverride",
    "Kit",
    "LookAt",
    "Loop",
    "Material",
    "MotionState",
    "Motions",
    "Node",
    "Node3D",
    "NodePathError",
    "NotHumanoidError",
    "OneShotRequest",
    "OverriddenJoints",
    "PackedScene",
    "Part",
    "Placement",
    "Player",
    "ProcessCallback",
    "ProcessMode",
    "Prop",
    "Quaternion",
    "Recorder",
    "Recording",
    "RenderSystem",
    "Resource",
    "SceneTree",
    "SceneTreeTimer",
    "Schedule",
    "ScriptError",
    "Seat",
    "Section",
    "Signal",
    "Simulation",
    "SkinnedMesh",
    "Stadium",
    "Stage",
    "StateMachinePlayback",
    "StateRecorder",
    "Stream",
    "StreamPool",
    "Task",
    "Team",
    "TifoError",
    "Timer",
    "Trans",
    "Tween",
    "TweenPause",
    "Unique",
    "UniquePool",
    "Variant",
    "Vector3",
    "View",
    "WindowInput",
    "add_loader",
    "add_motions",
    "add_part",
    "add_systems",
    "adopt_context",
    "build_seats",
    "builtin_prop",
    "builtin_spectator",
    "camera_presets",
    "character_of",
    "clone_report",
    "controllers",
    "drumming",
    "ease",
    "export",
    "export_gltf",
    "export_usd",
    "exports_of",
    "find_loop",
    "give_props",
    "humanoid",
    "is_instance_valid",
    "load",
    "load_character",
    "load_events",
    "load_motions",
    "load_scene",
    "load_table",
    "look_at",
    "loop_clip",
    "mirror_clip",
    "nodes",
    "one_look",
    "open_window",
    "pick_seat",
    "remove_part",
    "resource_root",
    "retarget",
    "run",
    "save_resource",
    "save_scene",
    "set_resource_root",
    "spawn_crowd",
    "tick_systems",
    "trim_clip",
    "turn_about",
    "variant_groups",
]

_DRAWING = {
    "RenderSystem": "systems.render",
    "Stage": "scripting.stage",
    "AdoptedContext": "engine.gl.adopted",
    "adopt_context": "engine.gl.adopted",
    "open_window": "engine.gl.context",
}
_SCRIPTING = {
    "easing": "Ease Trans ease",
    "exports": "Export export exports_of",
    "input_events": "InputEvent InputEventAction InputEventJoypadButton InputEventJoypadMotion"
    " InputEventKey InputEventMouseButton InputEventMouseMotion",
    "input_log": "InputLog",
    "input_map": "InputMap",
    "input_state": "Input",
    "lifecycle": "ProcessMode",
    "node": "Node is_instance_valid",
    "node3d": "Node3D",
    "nodes": "Agent AnimationPlayer AnimationTree Ball Camera Player Section Stadium"
    " StateMachinePlayback",
    "packed_scene": "PackedScene load_scene",
    "paths": "NodePathError",
    "reports": "FreedError ScriptError",
    "resources": "Resource add_loader load resource_root save_resource set_resource_root",
    "scene_writing": "save_scene",
    "signals": "Signal",
    "tasks": "Task",
    "timers": "ProcessCallback SceneTreeTimer Timer",
    "tree": "GroupCall SceneTree",
    "tween": "Tween TweenPause",
    "vectors": "Quaternion Vector3",
    "window_input": "WindowInput",
    "window_run": "run",
    "hot_reload": "HotReload",
}
_LATE = _DRAWING | {
    name: f"scripting.{module}" for module, names in _SCRIPTING.items() for name in names.split()
}


def __getattr__(name: str) -> Any:
    """Load what draws, and what scripts use, only when it is asked for."""
    if name == "nodes":
        from .scripting import nodes

        return nodes
    if name == "OneShotRequest":
        return controllers.OneShotRequest
    if name not in _LATE:
        raise AttributeError(f"module 'tifo' has no attribute '{name}'")
    from importlib import import_module

    return getattr(import_module(f"tifo.{_LATE[name]}"), name)

"""Controllers: trees of clips, blends and state machines, as data."""

from .custom import BatchContext, Custom, StreamContext
from .files import controller_from_toml, controller_to_toml, load_controller, save_controller
from .machine import StateMachine, Transition
from .masks import Mask, Masked, Overlay
from .nodes import Additive, Blend2, BlendN, ClipNode, Controller, OneShot, TimeScale
from .parameters import OneShotRequest
from .spaces import BlendSpace1D, BlendSpace2D

__all__ = [
    "Additive",
    "BatchContext",
    "Blend2",
    "BlendN",
    "BlendSpace1D",
    "BlendSpace2D",
    "ClipNode",
    "Controller",
    "Custom",
    "Mask",
    "Masked",
    "OneShot",
    "OneShotRequest",
    "Overlay",
    "StateMachine",
    "StreamContext",
    "TimeScale",
    "Transition",
    "controller_from_toml",
    "controller_to_toml",
    "load_controller",
    "save_controller",
]

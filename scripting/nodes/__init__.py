"""Nodes over a stadium's entities: they read and write its components and keep no copies."""

from .agent import Agent
from .animation_player import AnimationPlayer
from .animation_tree import AnimationTree, StateMachinePlayback
from .ball import Ball
from .camera import Camera
from .crowd import Crowd
from .player import Player
from .section import Section
from .stadium import Stadium

__all__ = [
    "Agent",
    "AnimationPlayer",
    "AnimationTree",
    "Ball",
    "Camera",
    "Crowd",
    "Player",
    "Section",
    "Stadium",
    "StateMachinePlayback",
]

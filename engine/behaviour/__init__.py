"""How spectators answer what happens on the pitch."""

from .events import BallHit, Event, Goal
from .reactions import answer_event, settle, wander

__all__ = ["BallHit", "Event", "Goal", "answer_event", "settle", "wander"]

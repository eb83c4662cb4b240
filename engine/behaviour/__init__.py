"""How spectators behave: feelings, events, states, and orders from outside."""

from .emotion import draw_emotion, set_embarrassment
from .events import KINDS, BallHit, Event, EventQueue, Goal
from .table import BehaviourTable
from .table_file import TABLES, load_table, table_from_toml

__all__ = [
    "KINDS",
    "TABLES",
    "BallHit",
    "BehaviourTable",
    "Event",
    "EventQueue",
    "Goal",
    "draw_emotion",
    "load_table",
    "set_embarrassment",
    "table_from_toml",
]

"""How spectators behave: feelings, events, states, orders; and how they move each other."""

from .applause import Applause, ApplauseChange, ApplauseRates
from .clap_stream import ClapOffsets, OffsetChange, clap_offset, clap_slope
from .contagion import ContagionRates, EmotionContagion
from .emotion import draw_emotion, set_embarrassment
from .events import KINDS, BallHit, Event, EventQueue, Goal
from .hearing import Hearing
from .parties import (
    FOOTBALL,
    GENERAL_PUBLIC,
    PartyMix,
    form_parties,
    seat_parties,
    turn_towards,
)
from .rhythm import Rhythm, RhythmRates
from .seat_rows import SeatRows
from .table import BehaviourTable
from .table_file import TABLES, load_table, table_from_toml
from .wave import MexicanWave, WaveChange, WaveRates

__all__ = [
    "FOOTBALL",
    "GENERAL_PUBLIC",
    "KINDS",
    "TABLES",
    "Applause",
    "ApplauseChange",
    "ApplauseRates",
    "BallHit",
    "BehaviourTable",
    "ClapOffsets",
    "ContagionRates",
    "EmotionContagion",
    "Event",
    "EventQueue",
    "Goal",
    "Hearing",
    "MexicanWave",
    "OffsetChange",
    "PartyMix",
    "Rhythm",
    "RhythmRates",
    "SeatRows",
    "WaveChange",
    "WaveRates",
    "clap_offset",
    "clap_slope",
    "draw_emotion",
    "form_parties",
    "load_table",
    "seat_parties",
    "set_embarrassment",
    "table_from_toml",
    "turn_towards",
]

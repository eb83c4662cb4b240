"""How spectators answer what happens on the pitch, and each other."""

from .applause import Applause, ApplauseChange, ApplauseRates
from .clap_stream import ClapOffsets, OffsetChange, clap_offset, clap_slope
from .contagion import ContagionRates, EmotionContagion
from .events import BallHit, Event, Goal
from .hearing import Hearing
from .parties import (
    FOOTBALL,
    GENERAL_PUBLIC,
    PartyMix,
    form_parties,
    seat_parties,
    turn_towards,
)
from .reactions import answer_event, settle, wander
from .rhythm import Rhythm, RhythmRates
from .seat_rows import SeatRows
from .wave import MexicanWave, WaveChange, WaveRates

__all__ = [
    "FOOTBALL",
    "GENERAL_PUBLIC",
    "Applause",
    "ApplauseChange",
    "ApplauseRates",
    "BallHit",
    "ClapOffsets",
    "ContagionRates",
    "EmotionContagion",
    "Event",
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
    "answer_event",
    "clap_offset",
    "clap_slope",
    "form_parties",
    "seat_parties",
    "settle",
    "turn_towards",
    "wander",
]

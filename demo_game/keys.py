"""Which key makes what happen."""

from __future__ import annotations

EVENT_KEYS = {
    "G": "goal",
    "N": "near_miss",
    "O": "foul",
    "Y": "card",
    "R": "referee_decision",
    "U": "substitution",
    "I": "corner",
    "K": "kick_off",
    "L": "half_time",
    "X": "final_whistle",
    "M": "anthem",
    "J": "cue",
    "B": "ball_in_crowd",
    "T": "player_close",
    "Z": "mexican_wave",
}
"""Kinds of events by key; with Shift they are the away side's."""

MESSAGES = {
    "goal": "GOAL for the {side} side!",
    "near_miss": "the {side} side just misses",
    "foul": "foul by the {side} side",
    "card": "a card for the {side} side",
    "referee_decision": "the referee decides for the {side} side",
    "substitution": "substitution: {side} side",
    "corner": "corner for the {side} side",
    "kick_off": "kick-off",
    "half_time": "half-time",
    "final_whistle": "it is over, and the {side} side has won",
    "anthem": "the anthem",
    "cue": "that is worth applause",
    "ball_in_crowd": "the ball hits seat {seat}",
    "player_close": "a player comes to seat {seat}",
    "mexican_wave": "a wave from seat {seat}, perhaps",
}
SIDELESS = frozenset({"kick_off", "half_time", "anthem", "cue"})
"""Kinds that the keys make everybody's."""

MATCH_KEYS = (
    "G / H goal home / away     with Shift, the away side's:  N near miss   O foul   Y card   "
    "R referee   U substitution   I corner   X final whistle\n"
    "K kick-off   L half-time   M anthem   J applause        where the mouse points:  click or B "
    "ball   T player   Z Mexican wave\n"
)
VIEW_KEYS = (
    "1 2 3  cameras        C  orbit or fly        WASD QE  move        drag, scroll  look\n"
    "F  fullscreen        V  vsync        P  pause        F12  screenshot        Esc  quit"
)

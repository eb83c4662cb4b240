"""Feelings: what people come with, what events do to them, and how they return by themselves."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components.emotion import Emotion
from ..streams.pool import POSE_RATE
from .table import PIECE

EXCITEMENT_HALF_LIFE = 1.7 * 60.0
MOOD_HALF_LIFE = 1.9 * 60.0
"""Seconds in which half of a deviation is gone, after Garcia et al. 2016."""
EMBARRASSMENT_HALF_LIFE = EXCITEMENT_HALF_LIFE
FATIGUE_HALF_LIFE = 3.0 * 60.0
"""Seconds; no figure is known for these two."""
REST_EXCITEMENT = 0.2
"""Excitement of an ordinary supporter when nothing happens."""
TIRING = 0.5 / 60.0
"""Fatigue a second of those whom an event moves; it goes away by itself at the same time."""


def draw_emotion(fervour: NDArray[np.float32], level: float, rng: np.random.Generator) -> Emotion:
    """Feelings of people to whom nothing has happened yet.

    Parameters
    ----------
    fervour
        (N,) of each.
    level
        Embarrassment of the whole crowd, 0 to 1.
    rng
        Where traits come from: thresholds are normal, as a threshold curve needs, and shyness is
        lognormal.
    """
    count = len(fervour)
    threshold = rng.normal(0.4, 0.17, count).clip(0.02, 1.0)
    shyness = rng.lognormal(0.0, 0.35, count).astype(np.float32)
    excitement = (REST_EXCITEMENT * fervour).clip(0.0, 0.5).astype(np.float32)
    emotion = Emotion(
        excitement=excitement.copy(),
        embarrassment=np.zeros(count, np.float32),
        mood=np.zeros(count, np.float32),
        fatigue=np.zeros(count, np.float32),
        susceptibility=(1.0 - threshold).astype(np.float32),
        shyness=shyness,
        rest_excitement=excitement,
        rest_embarrassment=np.zeros(count, np.float32),
        level=level,
    )
    set_embarrassment(emotion, level)
    return emotion


def set_embarrassment(emotion: Emotion, level: float) -> None:
    """Make everyone as embarrassed as fits the crowd's `level`, 0 to 1.

    At 0 nobody is, at 1 everybody wholly, and between them people differ by their shyness.

    Raises
    ------
    ValueError
        For a level outside 0 to 1.
    """
    if not 0.0 <= level <= 1.0:
        raise ValueError(f"level is {level!r}, expected embarrassment from 0 to 1")
    emotion.level = float(level)
    np.power(np.float32(level), emotion.shyness, out=emotion.rest_embarrassment)
    emotion.embarrassment[:] = emotion.rest_embarrassment


def relax(
    emotion: Emotion, tick: int, tiring: NDArray[np.bool_], *, contagious: bool = False
) -> None:
    """Let feelings return to where they rest; a tenth of the crowd at each pose tick.

    ``dv/dt = -g (v - b)`` with the half-lives above, exact for the 10 pose ticks between an agent's
    turns.

    Parameters
    ----------
    emotion
        Changed in place.
    tick
        Pose tick; says whose turn it is.
    tiring
        (N,) who gets tired.
    contagious
        Whether mood and excitement pass from neighbour to neighbour, and fade there
        (`contagion.EmotionContagion`), so that they are left alone here.
    """
    count = len(emotion.mood)
    turn = tick % PIECE
    who = slice(turn * count // PIECE, (turn + 1) * count // PIECE)
    seconds = PIECE / POSE_RATE
    for column, rest, half_life in (
        (emotion.excitement, emotion.rest_excitement, EXCITEMENT_HALF_LIFE),
        (emotion.embarrassment, emotion.rest_embarrassment, EMBARRASSMENT_HALF_LIFE),
        (emotion.mood, None, MOOD_HALF_LIFE),
        (emotion.fatigue, None, FATIGUE_HALF_LIFE),
    ):
        if contagious and (column is emotion.excitement or column is emotion.mood):
            continue
        part, left = column[who], np.float32(0.5 ** (seconds / half_life))
        if rest is None:
            part *= left
        else:
            part -= rest[who]
            part *= left
            part += rest[who]
    tired = emotion.fatigue[who]
    tired += np.float32(TIRING * seconds) * tiring[who] * (1.0 - tired)


def shift(
    column: NDArray[np.float32],
    agents: NDArray[np.int64] | slice,
    by: NDArray[np.float32],
    least: float = 0.0,
) -> None:
    """Raise or lower a feeling by a share of the way to 1 or to `least`, so that it stays inside.

    Parameters
    ----------
    column, agents
        The feeling, and whose.
    by
        (K,) of each; more than 1 counts as 1.
    least
        0, or -1 for moods.
    """
    value = column[agents]
    one = np.float32(1.0)
    if by.min() >= 0:
        step = one - value
        step *= np.minimum(by, one)
    elif by.max() <= 0:
        step = value - np.float32(least)
        step *= np.maximum(by, -one)
    else:
        step = np.where(by > 0, one - value, value - np.float32(least))
        step *= np.clip(by, -one, one)
    column[agents] += step

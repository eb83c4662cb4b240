"""How an agent feels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(slots=True, eq=False)
class Emotion:
    """Per agent: what events raise and lower, and where it returns to by itself.

    Attributes
    ----------
    excitement
        (N,) float32 arousal, 0 asleep to 1 beside oneself.
    embarrassment
        (N,) float32 reluctance to be seen doing it, 0 to 1.
    mood
        (N,) float32 valence, -1 to 1.
    fatigue
        (N,) float32 0 fresh to 1 exhausted.
    susceptibility
        (N,) float32 how little it takes to move this person, 0 to 1; a trait, it doesn't change.
    shyness
        (N,) float32 a trait: the person's embarrassment rests at ``level ** shyness``.
    rest_excitement, rest_embarrassment
        (N,) float32 where the two return to; mood and fatigue return to 0.
    level
        Embarrassment of the whole crowd, 0 to 1.
    """

    excitement: NDArray[np.float32]
    embarrassment: NDArray[np.float32]
    mood: NDArray[np.float32]
    fatigue: NDArray[np.float32]
    susceptibility: NDArray[np.float32]
    shyness: NDArray[np.float32]
    rest_excitement: NDArray[np.float32]
    rest_embarrassment: NDArray[np.float32]
    level: float

"""Where an agent belongs in the stands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(slots=True, eq=False)
class Seat:
    """Per agent: its seat.

    Attributes
    ----------
    row, column
        (N,) int32; the seat's label is ``row|column``.
    section
        (N,) int32 index of the section.
    occupied
        (N,) bool; an agent whose seat is empty is absent and is not drawn.
    """

    row: NDArray[np.int32]
    column: NDArray[np.int32]
    section: NDArray[np.int32]
    occupied: NDArray[np.bool_]


@dataclass(slots=True, eq=False)
class Section:
    """An entity of its own: a block of stands, as a range of a crowd's agents.

    Attributes
    ----------
    name
        Unique in the stadium.
    crowd
        Entity of the crowd whose agents sit here.
    start, stop
        The agents' ids are ``range(start, stop)``.
    """

    name: str
    crowd: int
    start: int
    stop: int

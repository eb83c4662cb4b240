"""Whom an agent came with."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray


class PartyKind(IntEnum):
    """What holds a party together. Families are led by an adult, others may have a leader."""

    ALONE = 0
    COUPLE = 1
    FAMILY = 2
    FRIENDS = 3


@dataclass(slots=True, eq=False)
class Party:
    """Per agent: the people it came with, who sit together.

    Attributes
    ----------
    party
        (N,) int32 number of the party, from 0; -1 for who is absent.
    leader
        (N,) int32 id of the agent that the party follows; -1 where it only shares a label.
    kind
        (N,) int8 a `PartyKind`.
    is_child
        (N,) bool; every party with a child has an adult.
    nearest
        (N,) int32 id of the nearest member of the party: whom one turns to when talking; -1 for
        who is alone.
    partner
        (N,) int32 id of the member beside it to hug after a goal, and back; -1 for nobody.
    """

    party: NDArray[np.int32]
    leader: NDArray[np.int32]
    kind: NDArray[np.int8]
    is_child: NDArray[np.bool_]
    nearest: NDArray[np.int32]
    partner: NDArray[np.int32]

"""Who is on the way: to a seat, from one, or on patrol."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray


class Errand(IntEnum):
    """Why somebody walks."""

    ARRIVE = 0
    LEAVE = 1
    PATROL = 2


class Stage(IntEnum):
    """How far somebody is with it."""

    RISE = 0
    WALK = 1
    SETTLE = 2
    STAND = 3
    GONE = 4


class Leg(IntEnum):
    """What is known of the stretch of a way from one vertex to the next: rows of a table.

    The first seven are as at its beginning, and the rows `RATES` hold what a metre adds to each.
    """

    X = 0
    Y = 1
    Z = 2
    NORMAL_X = 3
    NORMAL_Z = 4
    YAW = 5
    SEAT = 6
    AHEAD_X = 14
    AHEAD_Z = 15
    LENGTH = 16
    REST = 17
    TO_MOUTH = 18
    TO_SEAT = 19
    ROOM = 20
    PACE = 21
    IN_ROW = 22


VALUES, RATES = slice(0, 7), slice(7, 14)
LEG = 23
"""Rows of a stretch."""
_COLUMNS: dict[str, type] = {
    "agent": np.int64,
    "errand": np.int8,
    "stage": np.int8,
    "pace": np.float32,
    "speed": np.float32,
    "aside": np.float32,
    "drift": np.float32,
    "vertex": np.int32,
    "along": np.float32,
    "last": np.int32,
    "mouth": np.int32,
    "first": np.int64,
    "step": np.int8,
    "passes": np.int32,
    "run": np.int64,
    "granted": np.bool_,
    "waited": np.float32,
    "until": np.int32,
    "since": np.int32,
    "motion": np.int16,
}
_LEAST = 64


@dataclass(slots=True, eq=False)
class Walk:
    """Per crowd: W people on their way, a row of each column for each, in the order they set out.

    Columns are views of longer ones, so that nobody is copied when one more sets out: write into
    them, but don't put others in their place.

    Attributes
    ----------
    agent
        (W,) int64 ids.
    errand, stage
        (W,) int8 `Errand` and `Stage`.
    pace, speed
        (W,) float32 m/s on a gangway that the person likes, and goes along the route now.
    aside, drift
        (W,) float32 metres to the right of the route's middle, and m/s to the right.
    vertex, along
        (W,) int32 last vertex of the route that was passed, and float32 metres since.
    last
        (W,) int32 the route's last vertex.
    mouth
        (W,) int32 vertex at which the route enters or leaves a row of seats; -1 where it doesn't.
    first, step, passes
        (W,) id of the first seat passed in the row, by how much ids grow from seat to seat, and how
        many are passed, one's own not counted.
    run
        (W,) int64 the row of one block; -1 for those on patrol.
    granted
        (W,) bool: nobody comes the other way in that row, and it was promised to this person.
    waited
        (W,) float32 seconds for which somebody was in the way.
    until
        (W,) int32 pose tick until which someone on patrol stands.
    motion, since
        (W,) int16 motion of the library that is shown, and int32 pose tick since when.
    leg
        (23, W) float32 the stretch of the way that each is on, a row for each of `Leg`.
    ways
        For each of the W people (vertices, 23) float32, all stretches of the way.
    """

    agent: NDArray[np.int64] = field(init=False)
    errand: NDArray[np.int8] = field(init=False)
    stage: NDArray[np.int8] = field(init=False)
    pace: NDArray[np.float32] = field(init=False)
    speed: NDArray[np.float32] = field(init=False)
    aside: NDArray[np.float32] = field(init=False)
    drift: NDArray[np.float32] = field(init=False)
    vertex: NDArray[np.int32] = field(init=False)
    along: NDArray[np.float32] = field(init=False)
    last: NDArray[np.int32] = field(init=False)
    mouth: NDArray[np.int32] = field(init=False)
    first: NDArray[np.int64] = field(init=False)
    step: NDArray[np.int8] = field(init=False)
    passes: NDArray[np.int32] = field(init=False)
    run: NDArray[np.int64] = field(init=False)
    granted: NDArray[np.bool_] = field(init=False)
    waited: NDArray[np.float32] = field(init=False)
    until: NDArray[np.int32] = field(init=False)
    since: NDArray[np.int32] = field(init=False)
    motion: NDArray[np.int16] = field(init=False)
    leg: NDArray[np.float32] = field(init=False)
    ways: list[NDArray[np.float32]] = field(init=False, default_factory=list)
    _store: dict[str, NDArray[np.generic]] = field(init=False, repr=False)
    _legs: NDArray[np.float32] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Nobody walks yet."""
        self._store = {name: np.zeros(_LEAST, kind) for name, kind in _COLUMNS.items()}
        self._legs = np.zeros((LEG, _LEAST), np.float32)
        self._show(0)

    def __len__(self) -> int:
        """How many are on their way."""
        return len(self.agent)

    def add(self, way: NDArray[np.float32], **values: float) -> None:
        """Let one more set out on a way (vertices, 23); columns not named begin at 0."""
        at = len(self)
        if at == self._legs.shape[1]:
            self._store = {
                name: np.concatenate([column, np.zeros_like(column)])
                for name, column in self._store.items()
            }
            self._legs = np.concatenate([self._legs, np.zeros_like(self._legs)], axis=1)
        for name, column in self._store.items():
            column[at] = values.get(name, 0)
        self._store["last"][at] = len(way) - 1
        self._legs[:, at] = way[0]
        self.ways.append(way)
        self._show(at + 1)

    def enter(self, some: NDArray[np.int64]) -> None:
        """Look up the stretches that some (K,) are on, after their vertices have changed."""
        vertices = self.vertex[some].tolist()
        for k, vertex in zip(some.tolist(), vertices, strict=True):
            self.leg[:, k] = self.ways[k][vertex]

    def keep(self, mask: NDArray[np.bool_]) -> None:
        """Forget all others; `mask` is (W,) bool."""
        kept = np.flatnonzero(mask)
        for name, column in self._store.items():
            column[: len(kept)] = getattr(self, name)[kept]
        self._legs[:, : len(kept)] = self.leg[:, kept]
        self.ways = [self.ways[k] for k in kept.tolist()]
        self._show(len(kept))

    def _show(self, count: int) -> None:
        for name, column in self._store.items():
            setattr(self, name, column[:count])
        self.leg = self._legs[:, :count]

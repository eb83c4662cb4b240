"""Who is on the way: to a seat, from one, or on patrol."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
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


_COLUMNS: dict[str, tuple[type, tuple[int, ...]]] = {
    "agent": (np.int64, ()),
    "errand": (np.int8, ()),
    "stage": (np.int8, ()),
    "pace": (np.float32, ()),
    "speed": (np.float32, ()),
    "aside": (np.float32, ()),
    "drift": (np.float32, ()),
    "vertex": (np.int32, ()),
    "along": (np.float32, ()),
    "last": (np.int32, ()),
    "mouth": (np.int32, ()),
    "seat0": (np.int32, ()),
    "first": (np.int64, ()),
    "step": (np.int8, ()),
    "run": (np.int64, ()),
    "granted": (np.bool_, ()),
    "waited": (np.float32, ()),
    "until": (np.int32, ()),
    "since": (np.int32, ()),
    "motion": (np.int16, ()),
}


@dataclass(slots=True, eq=False)
class Walk:
    """Per crowd: W people on their way, a row of each column for each, in the order they set out.

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
    seat0, first, step
        (W,) vertex of the first seat passed in the row, that seat's id, and by how much ids grow
        from vertex to vertex.
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
    route
        (W, P, 3) float32 vertices; (W, P) slices beside them are in `room` and `reach`.
    normal
        (W, P, 2) float32 to the right of the route, x and z.
    room
        (W, P) float32 metres that a person's middle may be aside.
    reach
        (W, P) float32 metres from the beginning to each vertex.
    """

    agent: NDArray[np.int64] = None  # type: ignore[assignment]
    errand: NDArray[np.int8] = None  # type: ignore[assignment]
    stage: NDArray[np.int8] = None  # type: ignore[assignment]
    pace: NDArray[np.float32] = None  # type: ignore[assignment]
    speed: NDArray[np.float32] = None  # type: ignore[assignment]
    aside: NDArray[np.float32] = None  # type: ignore[assignment]
    drift: NDArray[np.float32] = None  # type: ignore[assignment]
    vertex: NDArray[np.int32] = None  # type: ignore[assignment]
    along: NDArray[np.float32] = None  # type: ignore[assignment]
    last: NDArray[np.int32] = None  # type: ignore[assignment]
    mouth: NDArray[np.int32] = None  # type: ignore[assignment]
    seat0: NDArray[np.int32] = None  # type: ignore[assignment]
    first: NDArray[np.int64] = None  # type: ignore[assignment]
    step: NDArray[np.int8] = None  # type: ignore[assignment]
    run: NDArray[np.int64] = None  # type: ignore[assignment]
    granted: NDArray[np.bool_] = None  # type: ignore[assignment]
    waited: NDArray[np.float32] = None  # type: ignore[assignment]
    until: NDArray[np.int32] = None  # type: ignore[assignment]
    since: NDArray[np.int32] = None  # type: ignore[assignment]
    motion: NDArray[np.int16] = None  # type: ignore[assignment]
    route: NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, 0, 3), np.float32))
    normal: NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, 0, 2), np.float32))
    room: NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, 0), np.float32))
    reach: NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, 0), np.float32))

    def __post_init__(self) -> None:
        """Nobody walks yet."""
        for name, (kind, shape) in _COLUMNS.items():
            if getattr(self, name) is None:
                setattr(self, name, np.zeros((0, *shape), kind))

    def __len__(self) -> int:
        """How many are on their way."""
        return len(self.agent)

    def add(
        self,
        points: NDArray[np.float32],
        normal: NDArray[np.float32],
        room: NDArray[np.float32],
        **values: float,
    ) -> None:
        """Let one more set out on a route of p vertices; columns not named begin at 0."""
        count = len(points)
        most = max(self.route.shape[1], count)
        for name, own in (("route", points), ("normal", normal), ("room", room)):
            self._grow(name, own, most)
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        self._grow("reach", np.append(0.0, np.cumsum(steps)).astype(np.float32), most)
        for name, (kind, _) in _COLUMNS.items():
            value = count - 1 if name == "last" else values.get(name, 0)
            setattr(self, name, np.append(getattr(self, name), np.array([value], kind)))

    def keep(self, mask: NDArray[np.bool_]) -> None:
        """Forget all others; `mask` is (W,) bool."""
        for column in fields(self):
            name = column.name
            if name in _COLUMNS or name in ("route", "normal", "room", "reach"):
                setattr(self, name, getattr(self, name)[mask])

    def _grow(self, name: str, own: NDArray[np.float32], most: int) -> None:
        """Append one route's vertices, padded with its last one, to a (W, P, ...) array."""
        old = getattr(self, name)
        table = np.zeros((len(old) + 1, most, *own.shape[1:]), np.float32)
        table[:-1, : old.shape[1]] = old
        table[-1, : len(own)] = own
        table[-1, len(own) :] = own[-1]
        setattr(self, name, table)

"""The pose store: every palette that an agent can show, under one index.

Rows 0 to ``stream_rows - 1`` are streams; each has a ring of `capacity` slices, and slice
``tick mod capacity`` holds the pose of that pose tick. Rows from ``stream_rows`` on are static, one
palette each: the bind pose, which agents without a motion show; two rows for each unique, its
previous and its current pose in turns; and the transition slots. The drawing side mirrors the
arrays; each mirror is told what changed since it last asked.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from weakref import WeakSet

import numpy as np
from numpy.typing import NDArray

MAX_CAPACITY = 256
MAX_ROWS = 16384
"""Rows of a texture that every OpenGL 3.3 driver of use has."""


def ring_capacity(history: int) -> int:
    """Smallest power of two that holds `history` poses and the two being written or mixed.

    60 poses need a ring of 64; 254, the most that is possible, need 256.

    Raises
    ------
    ValueError
        If `history` is not between 2 and 254.
    """
    if not 2 <= history <= MAX_CAPACITY - 2:
        raise ValueError(f"history is {history}, expected 2 to {MAX_CAPACITY - 2} poses")
    return 1 << (history + 1).bit_length()


@dataclass(slots=True, eq=False, weakref_slot=True)
class DirtyPoses:
    """What one mirror has to copy: ring slices, static rows, and the stream table."""

    slices: set[int] = field(default_factory=set)
    static_rows: set[int] = field(default_factory=set)
    streams: bool = True

    def take(self) -> DirtyPoses:
        """What changed since the last call; the record starts anew."""
        taken = DirtyPoses(self.slices, self.static_rows, self.streams)
        self.slices, self.static_rows, self.streams = set(), set(), False
        return taken


class PoseStore:
    """Palettes of one skeleton's streams, uniques and static poses.

    Parameters
    ----------
    joints
        Joints J of the skeleton.
    stream_rows
        How many streams have a ring.
    history
        The longest history of any stream, in poses.
    uniques, slots
        How many uniques and transition slots there are room for.
    markers
        Joint positions K kept beside each palette for the farthest level of detail.

    Attributes
    ----------
    ring
        (capacity, stream_rows, J, 3, 4) float32: a slice is contiguous, for one upload.
    static
        (1 + 2 uniques + slots, J, 3, 4) float32.
    ring_markers, static_markers
        (capacity, stream_rows, K, 4) and (static rows, K, 4) float32, model space, w unused.
    unique_head
        (uniques,) int64: pose tick of each unique's newest pose.
    unique_valid
        (uniques,) int32: poses since its last cut, 0 to 2.
    unique_newest
        (uniques,) int64: which of its two rows has the newest pose, 0 or 1.
    ring_phase
        (capacity, stream_rows) float32: how far through its cycle each pose is, 0 to 1. Drawing
        needs no phases, so they are not mirrored.
    """

    __slots__ = (
        "_mirrors",
        "capacity",
        "ring",
        "ring_markers",
        "ring_phase",
        "slots",
        "static",
        "static_markers",
        "stream_rows",
        "unique_head",
        "unique_newest",
        "unique_valid",
        "uniques",
    )

    def __init__(
        self,
        joints: int,
        stream_rows: int,
        history: int,
        *,
        uniques: int = 0,
        slots: int = 0,
        markers: int = 0,
    ) -> None:
        static_rows = 1 + 2 * uniques + slots
        for name, value in (("uniques", uniques), ("slots", slots)):
            if value < 0:
                raise ValueError(f"{name} is {value}, expected 0 or more")
        if static_rows > MAX_ROWS or stream_rows + uniques > MAX_ROWS:
            raise ValueError(
                f"{stream_rows} streams, {uniques} uniques and {slots} slots need too many rows: "
                f"streams + uniques and 1 + 2 uniques + slots may be at most {MAX_ROWS}"
            )
        self.capacity = ring_capacity(history)
        self.stream_rows = stream_rows
        self.uniques = uniques
        self.slots = slots
        identity = np.eye(3, 4, dtype=np.float32)
        self.ring = np.empty((self.capacity, stream_rows, joints, 3, 4), dtype=np.float32)
        self.ring[...] = identity
        self.static = np.empty((static_rows, joints, 3, 4), dtype=np.float32)
        self.static[...] = identity
        self.ring_markers = np.zeros((self.capacity, stream_rows, markers, 4), dtype=np.float32)
        self.ring_phase = np.zeros((self.capacity, stream_rows), dtype=np.float32)
        self.static_markers = np.zeros((static_rows, markers, 4), dtype=np.float32)
        self.unique_head = np.zeros(uniques, np.int64)
        self.unique_valid = np.zeros(uniques, np.int32)
        self.unique_newest = np.zeros(uniques, np.int64)
        self._mirrors: WeakSet[DirtyPoses] = WeakSet()

    @property
    def bind_row(self) -> int:
        """Unified index of the bind pose."""
        return self.stream_rows

    @property
    def first_unique(self) -> int:
        """Unified index of unique 0; unique k is at ``first_unique + 2 k``."""
        return self.stream_rows + 1

    @property
    def first_slot(self) -> int:
        """Unified index of slot 0."""
        return self.stream_rows + 1 + 2 * self.uniques

    def slice_of(self, tick: int) -> int:
        """Ring slice that holds the pose of pose tick `tick`."""
        return tick % self.capacity

    def mark_slice(self, tick: int) -> None:
        """Record that the slice of `tick` changed."""
        number = self.slice_of(tick)
        for mirror in self._mirrors:
            mirror.slices.add(number)

    def mark_streams(self) -> None:
        """Record that heads, valid counts or states of streams or uniques changed."""
        for mirror in self._mirrors:
            mirror.streams = True

    def write_static(
        self,
        row: int | NDArray[np.int64],
        palette: NDArray[np.float32],
        markers: NDArray[np.float32] | None = None,
    ) -> None:
        """Write one or more static rows (0 is the bind pose).

        Parameters
        ----------
        row
            A static row, or (N,) of them; unified indices less `stream_rows`.
        palette
            (J, 3, 4) or (N, J, 3, 4).
        markers
            (K, 3) or (N, K, 3).
        """
        self.static[row] = palette
        if markers is not None:
            self.static_markers[row, :, :3] = markers
        rows = np.atleast_1d(row).tolist()
        for mirror in self._mirrors:
            mirror.static_rows.update(rows)

    def mirror(self) -> DirtyPoses:
        """A record of its own for one more mirror, in which everything is dirty at first.

        It is kept up to date for as long as the caller holds it.
        """
        record = DirtyPoses(set(range(self.capacity)), set(range(len(self.static))))
        self._mirrors.add(record)
        return record

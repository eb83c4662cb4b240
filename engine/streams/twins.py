"""Twins: streams that show another stream's motion on another type of body.

Bones of another length can't share palettes, so each body type has own rows of the streams it
uses. A twin does nothing by itself: in every tick it takes its stream's local pose, with the bones
of its type, so it has that stream's time, controllers, events and cuts.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..animation.body_type import BodyType
from ..animation.pose import TRANSLATION
from ..animation.skeleton import Skeleton


class Twins:
    """Which rows of a pool are twins of which, and what makes their poses.

    Parameters
    ----------
    skeleton
        Of the pool.
    types
        Body types beside the character's own; type k of an agent is ``types[k - 1]``.
    rows
        Stream rows R of the pool.

    Attributes
    ----------
    types
        As given.
    base
        (R,) int64 the row that a twin mirrors, -1 for a stream of its own.
    kind
        (R,) uint8 body type of each row.
    table
        (1 + T, R) int32 for each type, the row that shows a stream on it; -1 where there is none.
        Row 0 is the streams themselves.
    """

    __slots__ = ("_bones", "_flesh", "_shift", "base", "kind", "table", "types")

    def __init__(self, skeleton: Skeleton, types: Sequence[BodyType], rows: int) -> None:
        self.types = tuple(types)
        names = [kind.name for kind in self.types]
        if len(set(names)) < len(names):
            raise ValueError(f"body types are {names}, expected different names")
        self.base = np.full(rows, -1, np.int64)
        self.kind = np.zeros(rows, np.uint8)
        self.table = np.full((1 + len(self.types), rows), -1, np.int32)
        self.table[0] = np.arange(rows)
        self._bones = np.stack(
            [np.ones(skeleton.joint_count, np.float32), *(kind.bones for kind in self.types)]
        )
        own = np.tile(np.eye(4, dtype=np.float32), (skeleton.joint_count, 1, 1))
        refit = np.stack([own, *(kind.refit(skeleton) for kind in self.types)])
        self._flesh, self._shift = refit[:, :, 0, 0], refit[:, :, :3, 3]

    def __len__(self) -> int:
        """How many twins there are."""
        return int(np.count_nonzero(self.base >= 0))

    def add(self, row: int, base: int, kind: int) -> None:
        """Make a free row the twin of `base`."""
        self.base[row], self.kind[row] = base, kind
        self.table[kind, base] = row

    def forget(self, row: int) -> None:
        """A row is free again."""
        if self.base[row] >= 0:
            self.table[self.kind[row], self.base[row]] = -1
        self.base[row], self.kind[row] = -1, 0

    def family(self, row: int) -> list[int]:
        """A stream's row and those of its twins."""
        twins = self.table[1:, row]
        return [row, *(int(twin) for twin in twins[twins >= 0])]

    def resolve(self, rows: NDArray[np.int32] | int, kind: NDArray[np.uint8]) -> NDArray[np.int32]:
        """Rows that show streams on agents' own types of body, as far as there are any.

        Parameters
        ----------
        rows
            (K,) unified pose indices, or one for all; what is no stream stays as it is.
        kind
            (K,) body types.
        """
        given = np.broadcast_to(np.asarray(rows, np.int32), kind.shape)
        if not self.types:
            return given
        count = self.table.shape[1]
        stream = given < count
        at = np.where(stream, given, 0)
        own = np.where(self.base[at] >= 0, self.base[at], at)
        twin = self.table[np.minimum(kind, len(self.types)), own]
        return np.where(stream & (twin >= 0), twin, given).astype(np.int32)

    def following(self, rows: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Twins of the stream rows (S,), and for each its stream's place among them."""
        twins = np.flatnonzero(self.base >= 0)
        if not len(twins):
            return twins, twins
        place = np.full(len(self.base), -1, np.int64)
        place[rows] = np.arange(len(rows))
        at = place[self.base[twins]]
        return twins[at >= 0], at[at >= 0]

    def kind_of(self, body: str) -> int:
        """Number of a body type; ValueError names the known ones if there is none of the name."""
        names = [kind.name for kind in self.types]
        if body not in names:
            known = ", ".join(names) or "none"
            raise ValueError(f"there is no body type '{body}'; known: {known}")
        return 1 + names.index(body)

    def fit_poses(self, poses: NDArray[np.float32], kind: NDArray[np.uint8]) -> None:
        """Give local poses (n, 10, J) the bones of body types (n,), in place."""
        poses[:, TRANSLATION] *= self._bones[kind][:, None]

    def fit_palettes(
        self, palettes: NDArray[np.float32], rows: NDArray[np.int64], kind: NDArray[np.uint8]
    ) -> None:
        """Turn rows (n,) of palettes (R, J, 3, 4) from the character's bind pose, in place.

        The product with `BodyType.refit`, which is a uniform scale and a shift.
        """
        fitted = palettes[rows]
        shift = self._shift[kind]
        for axis in range(3):
            fitted[..., 3] += fitted[..., axis] * shift[:, :, None, axis]
        fitted[..., :3] *= self._flesh[kind][:, :, None, None]
        palettes[rows] = fitted

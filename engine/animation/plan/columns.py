"""Columns whose rows are handed out in blocks and taken back."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

_FIRST = 64


class Columns:
    """Arrays of one length, with an allocator of blocks of rows.

    A block goes to the first gap that holds it, gaps that touch are joined, and the arrays grow by
    doubling, so adding and removing for hours needs no more room than the most that was in use,
    up to gaps.

    Parameters
    ----------
    spec
        Data type of each column, or data type and the shape of one entry.

    Attributes
    ----------
    end
        Rows from here on are not in use.
    """

    __slots__ = ("_arrays", "_gaps", "end")

    def __init__(self, **spec: DTypeLike | tuple[DTypeLike, tuple[int, ...]]) -> None:
        self._arrays: dict[str, NDArray[Any]] = {}
        for name, kind in spec.items():
            dtype, shape = kind if isinstance(kind, tuple) else (kind, ())
            self._arrays[name] = np.zeros((_FIRST, *shape), dtype)
        self._gaps: list[tuple[int, int]] = []
        self.end = 0

    def __getitem__(self, name: str) -> NDArray[Any]:
        """A column, unused rows included; `allocate` may replace it by a longer one."""
        return self._arrays[name]

    def allocate(self, size: int) -> int:
        """First row of a block of `size` rows, whose contents are what was there before."""
        for place, (start, stop) in enumerate(self._gaps):
            if stop - start >= size:
                if stop - start == size:
                    del self._gaps[place]
                else:
                    self._gaps[place] = (start + size, stop)
                return start
        start = self.end
        self.end += size
        for name, column in self._arrays.items():
            if self.end > len(column):
                longer = np.zeros((max(2 * len(column), self.end), *column.shape[1:]), column.dtype)
                longer[:start] = column[:start]
                self._arrays[name] = longer
        return start

    def store(self, rows: Mapping[str, NDArray[Any]]) -> tuple[int, int]:
        """Put rows into a block of their own: its start and size."""
        size = len(next(iter(rows.values())))
        start = self.allocate(size)
        for name, values in rows.items():
            self._arrays[name][start : start + size] = values
        return start, size

    def release(self, start: int, size: int) -> None:
        """Take a block back."""
        if size == 0:
            return
        stop = start + size
        place = bisect_left(self._gaps, (start, stop))
        if place < len(self._gaps) and self._gaps[place][0] == stop:
            stop = self._gaps.pop(place)[1]
        if place and self._gaps[place - 1][1] == start:
            place -= 1
            start = self._gaps.pop(place)[0]
        if stop == self.end:
            self.end = start
        else:
            self._gaps.insert(place, (start, stop))


def ranges(
    start: NDArray[np.int64], count: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """All members of some ranges, range after range, and the number of the range of each.

    Ranges from 5 and 9 of 2 and 1 members give ``[5, 6, 9]`` and ``[0, 0, 1]``.
    """
    owner = np.repeat(np.arange(len(start)), count)
    first = np.cumsum(count) - count
    return (start - first)[owner] + np.arange(len(owner)), owner

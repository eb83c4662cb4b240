"""Rows of local poses, sampled and blended in batches.

All poses of a tick lie in one block; an operation reads rows of it and writes new rows behind the
last. Work is done in pieces that stay in the processor's cache. Rotations of every row have length
1, which lets a blend of two know the length of its result beforehand.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..clip_bank import ClipBank
from ..pose import CHANNELS, ROTATION, SCALE, TRANSLATION

Array = NDArray[np.float32]
Ints = NDArray[np.int64]

_PIECE = 128
"""Rows worked on together: four blocks of them are about a megabyte at 82 joints."""

_REST = slice(4, CHANNELS)
_TINY = np.float32(1e-20)


class PoseMixer:
    """The block of poses of one tick.

    Parameters
    ----------
    bank
        Where clips are sampled from.
    """

    __slots__ = ("_bank", "_length", "_product", "_share", "_spare", "_used", "poses")

    def __init__(self, bank: ClipBank) -> None:
        joints = bank.joint_count
        self._bank = bank
        self.poses = np.empty((0, CHANNELS, joints), np.float32)
        self._used = 0
        self._spare = np.empty((2, _PIECE, CHANNELS, joints), np.float32)
        self._product = np.empty((_PIECE, 4, joints), np.float32)
        self._length = np.empty((_PIECE, joints), np.float32)
        self._share = np.empty((_PIECE, joints), np.float32)

    def clear(self) -> None:
        """Begin a tick."""
        self._used = 0

    def new_rows(self, count: int) -> Ints:
        """Rows for `count` more poses."""
        first = self._used
        self._used += count
        if self._used > len(self.poses):
            shape = (max(self._used, 2 * len(self.poses)), *self.poses.shape[1:])
            longer = np.empty(shape, np.float32)
            longer[:first] = self.poses[:first]
            self.poses = longer
        return np.arange(first, self._used)

    def sample(self, clip: Ints, time: NDArray[np.float64], looping: NDArray[np.bool_]) -> Ints:
        """Sample clips (see `ClipBank.sample`) into new rows."""
        bank, rows = self._bank, self.new_rows(len(clip))
        before, weight = bank.locate(clip, time, looping)
        after = np.minimum(before + 1, bank.start[clip] + bank.intervals[clip])
        for piece, out in self._pieces(rows):
            scratch = self._spare[0, : len(out)]
            np.take(bank.frames, before[piece], axis=0, out=out, mode="clip")
            np.take(bank.frames, after[piece], axis=0, out=scratch, mode="clip")
            np.subtract(scratch, out, out=scratch)
            np.multiply(scratch, weight[piece, None, None], out=scratch)
            np.add(out, scratch, out=out)
            self._normalise(out)
        return rows

    def blend(self, a: Ints, b: Ints, amount: Array) -> Ints:
        """``a + (b - a) amount`` in new rows.

        Parameters
        ----------
        a, b
            (n,) rows.
        amount
            (n, 1), or (n, J) with an amount for each joint; 0 to 1.
        """
        rows = self.new_rows(len(a))
        for piece, out in self._pieces(rows):
            first, second = self._read(a[piece], 0), self._read(b[piece], 1)
            share = amount[piece]
            dot = self._dot(first, second)
            other = self._share[: len(out)]
            # Of unit quaternions: |a (1-s) + b s|^2 = (1-s)^2 + s^2 + 2 s (1-s) |a.b|.
            rest = 1.0 - share
            np.copysign(share, dot, out=other)
            np.abs(dot, out=dot)
            np.multiply(dot, 2.0 * share * rest, out=dot)
            np.add(dot, rest * rest + share * share, out=dot)
            np.sqrt(dot, out=dot)
            np.divide(other, dot, out=other)
            np.divide(rest, dot, out=dot)
            turned = self._product[: len(out)]
            np.multiply(first[:, ROTATION], dot[:, None], out=out[:, ROTATION])
            np.multiply(second[:, ROTATION], other[:, None], out=turned)
            np.add(out[:, ROTATION], turned, out=out[:, ROTATION])
            np.subtract(second[:, _REST], first[:, _REST], out=out[:, _REST])
            np.multiply(out[:, _REST], share[:, None], out=out[:, _REST])
            np.add(out[:, _REST], first[:, _REST], out=out[:, _REST])
        return rows

    def mean(self, rows: Ints, weight: Array, count: Ints) -> Ints:
        """Weighted means in new rows.

        Parameters
        ----------
        rows, weight
            (m,) rows and weights of the terms, mean after mean; those of one mean add up to 1.
        count
            (n,) number of terms of each mean, descending.
        """
        out_rows = self.new_rows(len(count))
        first = np.cumsum(count) - count
        for piece, out in self._pieces(out_rows):
            start, terms = first[piece], count[piece]
            np.take(self.poses, rows[start], axis=0, out=out, mode="clip")
            np.multiply(out, weight[start, None, None], out=out)
            for term in range(1, int(terms[0])):
                # Terms descend, so those that have this one come first.
                having = int(np.searchsorted(-terms, -term, side="left"))
                entry = start[:having] + term
                into, added = out[:having], self._spare[1, :having]
                np.take(self.poses, rows[entry], axis=0, out=added, mode="clip")
                signed = self._share[:having]
                np.copysign(weight[entry, None], self._dot(into, added), out=signed)
                np.multiply(added[:, ROTATION], signed[:, None], out=added[:, ROTATION])
                np.multiply(added[:, _REST], weight[entry, None, None], out=added[:, _REST])
                np.add(into, added, out=into)
            self._normalise(out)
        return out_rows

    def add(self, base: Ints, pose: Ints, inverse: Array, amount: Array) -> Ints:
        """The difference of `pose` from a reference on top of `base`, in new rows.

        Parameters
        ----------
        base, pose
            (n,) rows.
        inverse
            (n, 10, J): conjugate rotation, translation and reciprocal scale of the reference.
        amount
            (n, 1), 0 to 1.
        """
        rows = self.new_rows(len(base))
        for piece, out in self._pieces(rows):
            below, reference = self.poses[base[piece]], inverse[piece]
            change = self.poses[pose[piece]]
            share = amount[piece][:, None]
            turn = _multiply(reference[:, ROTATION], change[:, ROTATION])
            turn *= np.copysign(share, turn[:, 3:4])
            turn[:, 3] += 1.0 - share[:, 0]
            out[:, ROTATION] = _multiply(below[:, ROTATION], turn)
            moved = (change[:, TRANSLATION] - reference[:, TRANSLATION]) * share
            out[:, TRANSLATION] = below[:, TRANSLATION] + moved
            grown = (change[:, SCALE] * reference[:, SCALE] - 1.0) * share
            out[:, SCALE] = below[:, SCALE] * (1.0 + grown)
            self._normalise(out)
        return rows

    def put(self, poses: Array) -> Ints:
        """Copy poses (n, 10, J) into new rows, rotations normalised."""
        rows = self.new_rows(len(poses))
        for piece, out in self._pieces(rows):
            out[...] = poses[piece]
            self._normalise(out)
        return rows

    def _pieces(self, rows: Ints) -> list[tuple[slice, Array]]:
        """Parts of new rows: their places among them, and their poses."""
        if not len(rows):
            return []
        first, count = int(rows[0]), len(rows)
        return [
            (slice(k, k + _PIECE), self.poses[first + k : first + min(k + _PIECE, count)])
            for k in range(0, count, _PIECE)
        ]

    def _read(self, rows: Ints, spare: int) -> Array:
        """Poses of some rows, to be read only; a view where the rows lie at equal distances."""
        if len(rows) > 1:
            steps = np.diff(rows)
            step = int(steps[0])
            if step > 0 and (steps == step).all():
                return self.poses[int(rows[0]) : int(rows[-1]) + 1 : step]
        out = self._spare[spare, : len(rows)]
        np.take(self.poses, rows, axis=0, out=out, mode="clip")
        return out

    def _dot(self, a: Array, b: Array) -> Array:
        """(n, J) dot products of the rotations of two blocks."""
        product, out = self._product[: len(a)], self._length[: len(a)]
        np.multiply(a[:, ROTATION], b[:, ROTATION], out=product)
        np.add(product[:, 0], product[:, 1], out=out)
        np.add(out, product[:, 2], out=out)
        np.add(out, product[:, 3], out=out)
        return out

    def _normalise(self, block: Array) -> None:
        length = self._dot(block, block)
        np.maximum(length, _TINY, out=length)
        np.sqrt(length, out=length)
        np.divide(1.0, length, out=length)
        np.multiply(block[:, ROTATION], length[:, None], out=block[:, ROTATION])


def _multiply(a: Array, b: Array) -> Array:
    """Quaternion products of (n, 4, J) planes, xyzw."""
    ax, ay, az, aw = (a[:, k] for k in range(4))
    bx, by, bz, bw = (b[:, k] for k in range(4))
    return np.stack(
        [
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz,
        ],
        axis=1,
    )

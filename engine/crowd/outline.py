"""The plan of a bowl: a rounded rectangle that grows outward row by row.

Seen from above, rows run clockwise round the pitch, starting at the far (-Z) side's -X end, so
that columns grow from left to right for someone who looks at a stand from the pitch. The
direction out of the bowl is given by one angle phi: ``n = (sin phi, -cos phi)`` in (x, z), 0 at
the far stand, pi/2 on the +X side, pi at the main (+Z) stand. A spectator who faces straight in
has yaw ``-phi``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

F64 = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Block:
    """A stretch of rows between two gangways, straight or an arc round one centre.

    Parameters
    ----------
    x, z
        Centre of the arc; for a straight block, the centre at its first end.
    radius
        From there to the front edge of the first row (offset 0), metres.
    start, stop
        phi at the two ends; equal for a straight block.
    span
        Length of a straight block, 0 for an arc, metres.
    """

    x: float
    z: float
    radius: float
    start: float
    stop: float
    span: float

    @property
    def is_arc(self) -> bool:
        """Whether the rows are curved here."""
        return self.stop != self.start

    def length(self, offset: ArrayLike) -> F64:
        """Metres of the row whose front edge lies `offset` behind the first, with gangways."""
        behind = np.asarray(offset, dtype=np.float64)
        return self.span + (self.radius + behind) * (self.stop - self.start)

    def locate(self, fraction: ArrayLike, offset: ArrayLike) -> tuple[F64, F64, F64]:
        """Where a point lies in plan: x, z and phi, for arrays that broadcast together.

        Parameters
        ----------
        fraction
            0 at the first end, 1 at the last.
        offset
            Metres behind the front edge of the first row.
        """
        along, behind = np.broadcast_arrays(
            np.asarray(fraction, dtype=np.float64), np.asarray(offset, dtype=np.float64)
        )
        phi = self.start + along * (self.stop - self.start)
        out = self.radius + behind
        x = self.x + along * self.span * np.cos(self.start) + out * np.sin(phi)
        z = self.z + along * self.span * np.sin(self.start) - out * np.cos(phi)
        return x, z, phi

    def split(self, count: int) -> tuple[Block, ...]:
        """`count` equal blocks in the same order."""
        turn = (self.stop - self.start) / count
        span = self.span / count
        step_x, step_z = span * np.cos(self.start), span * np.sin(self.start)
        return tuple(
            replace(
                self,
                x=float(self.x + i * step_x),
                z=float(self.z + i * step_z),
                start=self.start + i * turn,
                stop=self.start + (i + 1) * turn,
                span=span,
            )
            for i in range(count)
        )


@dataclass(frozen=True, slots=True)
class Outline:
    """Rounded rectangle that the front edge of the first row follows.

    Parameters
    ----------
    half_x, half_z
        Half the length of the straight parts along x (far and main side) and z (the ends).
    radius
        Of the four corners.
    """

    half_x: float
    half_z: float
    radius: float

    def pieces(self) -> tuple[Block, ...]:
        """Far side, corner, +X end, corner, main side, corner, -X end, corner."""
        quarter = np.pi / 2
        corners = ((1, -1), (1, 1), (-1, 1), (-1, -1))
        starts = ((-1, -1), (1, -1), (1, 1), (-1, 1))
        result: list[Block] = []
        for side in range(4):
            phi = side * quarter
            span = 2 * (self.half_x if side % 2 == 0 else self.half_z)
            (sx, sz), (cx, cz) = starts[side], corners[side]
            x, z = sx * self.half_x, sz * self.half_z
            result.append(Block(x, z, self.radius, phi, phi, span))
            x, z = cx * self.half_x, cz * self.half_z
            result.append(Block(x, z, self.radius, phi, phi + quarter, 0.0))
        return tuple(result)

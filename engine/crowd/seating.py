"""Where the spectators are: the seats as arrays, and the concrete that they stand on.

A `Structure` says how the rows run (blocks round the pitch, offsets and heights of the treads); a
`SeatPlan` has one column entry for each seat. Bowl and stand describe themselves as a structure,
so that seats and meshes are made by the same code for both.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .outline import Block, Outline
from .selection import parse_label

F32 = NDArray[np.float32]
F64 = NDArray[np.float64]
I32 = NDArray[np.int32]

FEET = 0.13
"""Feet behind the front edge of their tread, metres."""
SEAT_HEIGHT = 0.44
"""Seat surface above the tread, metres."""
SEAT_FRONT, SEAT_BACK = 0.25, 0.65
"""Seat surface behind the feet, metres."""
EYE_HEIGHT = 1.2
"""Eye of a seated spectator above the tread, metres."""
EYE_BEHIND = 0.35
"""Eye of a seated spectator behind the feet, metres."""

CENTRE_BLEND = 0.3
"""How far a spectator in the middle of a corner turns from the row's normal to the pitch centre."""


@dataclass(frozen=True, slots=True, eq=False)
class Tier:
    """Rows that follow each other without a break.

    Parameters
    ----------
    blocks
        In the order in which columns are counted.
    sections
        Section index of each block.
    first_row
        Number of the tier's first row; rows count through all tiers.
    offsets, heights
        (R,) float64: front edge of each tread behind the outline, and its height, metres.
    counts
        (R, B) int32 seats of each row in each block.
    widths
        (R, B) float64 metres of row for each seat.
    """

    blocks: tuple[Block, ...]
    sections: tuple[int, ...]
    first_row: int
    offsets: F64
    heights: F64
    counts: I32
    widths: F64


@dataclass(frozen=True, slots=True, eq=False)
class Structure:
    """The built form under the seats.

    Parameters
    ----------
    outline
        Front of the first row of a bowl; None for a single stand.
    tiers
        From the lowest.
    tread
        Depth of a row, metres.
    gangway
        Width of the stairs between two blocks, metres; 0 where there are none.
    complete
        Whether the rows run all round the pitch.
    """

    outline: Outline | None
    tiers: tuple[Tier, ...]
    tread: float
    gangway: float
    complete: bool


@dataclass(frozen=True, slots=True, eq=False)
class SeatPlan:
    """All seats, sorted by section and within a section by row (front to back) and column.

    Parameters
    ----------
    position
        (3, N) float32, where the feet stand, metres.
    yaw
        (N,) float32, the way the spectator faces; 0 is +Z, positive about +Y, in (-pi, pi].
    row, column
        (N,) int32 from 0. Rows count from the front through all tiers, columns from left to right
        seen from the pitch (round the whole bowl); the pair is unique.
    section
        (N,) int32 index into `sections`.
    tier
        (N,) int8 from 0, the lowest.
    sections
        (name, start, stop) of each section; the name is its index as text.
    structure
        How the rows are built.
    """

    position: F32
    yaw: F32
    row: I32
    column: I32
    section: I32
    tier: NDArray[np.int8]
    sections: tuple[tuple[str, int, int], ...]
    structure: Structure

    @property
    def count(self) -> int:
        """Number of seats, N."""
        return len(self.row)

    def label(self, index: int) -> str:
        """The seat's name, for example ``"12|345"``; ValueError if there is no such seat."""
        if not 0 <= index < self.count:
            raise ValueError(f"index must be from 0 to {self.count - 1}, not {index}")
        return f"{self.row[index]}|{self.column[index]}"

    def find(self, label: str) -> int:
        """Index of the seat called `label`; ValueError if there is no such seat."""
        row, column = parse_label(label)
        return int(self.find_all([row], [column])[0])

    def find_all(self, rows: Sequence[int], columns: Sequence[int]) -> NDArray[np.int64]:
        """Indices of many seats at once, for equally long lists; ValueError names a missing one."""
        keys = self.row.astype(np.int64) << 32 | self.column
        order = np.argsort(keys)
        wanted = np.asarray(rows, dtype=np.int64) << 32 | np.asarray(columns, dtype=np.int64)
        place = np.minimum(np.searchsorted(keys, wanted, sorter=order), self.count - 1)
        found: NDArray[np.int64] = order[place]
        missing = np.flatnonzero(keys[found] != wanted)
        if len(missing):
            row, column = rows[missing[0]], columns[missing[0]]
            in_row = self.column[self.row == row]
            if len(in_row):
                allowed = f"row {row} has columns {in_row.min()} to {in_row.max()}"
            else:
                allowed = f"rows are 0 to {self.row.max()}"
            raise ValueError(f"there is no seat '{row}|{column}'; {allowed}")
        return found


def seats_of(structure: Structure) -> SeatPlan:
    """Place the seats of all blocks; each row's seats are centred in their block."""
    parts: list[tuple[int, F64, I32, I32, int]] = []
    for level, tier in enumerate(structure.tiers):
        first_column = np.cumsum(tier.counts, axis=1) - tier.counts
        for b, (block, section) in enumerate(zip(tier.blocks, tier.sections, strict=True)):
            count, width = tier.counts[:, b], tier.widths[:, b]
            r, j = np.nonzero(np.arange(int(count.max(initial=0))) < count[:, None])
            feet = tier.offsets[r] + FEET
            along = 0.5 + (j + 0.5 - 0.5 * count[r]) * width[r] / block.length(feet)
            x, z, phi = block.locate(along, feet)
            turn = np.zeros_like(phi)
            if block.is_arc:
                off = np.arctan2(x, -z) - phi
                off = np.arctan2(np.sin(off), np.cos(off))
                turn = CENTRE_BLEND * np.abs(np.sin(2 * phi)) * off
            yaw = -(phi + turn)
            yaw = np.arctan2(np.sin(yaw), np.cos(yaw))
            place = np.stack([x, tier.heights[r], z, yaw])
            row = (tier.first_row + r).astype(np.int32)
            column = (first_column[r, b] + j).astype(np.int32)
            parts.append((section, place, row, column, level))
    parts.sort(key=lambda part: part[0])
    sizes = [len(part[2]) for part in parts]
    stops = np.cumsum(sizes).tolist()
    place = np.concatenate([part[1] for part in parts], axis=1).astype(np.float32)
    repeat = np.repeat(np.arange(len(parts)), sizes)
    plan = SeatPlan(
        position=np.ascontiguousarray(place[:3]),
        yaw=place[3].copy(),
        row=np.concatenate([part[2] for part in parts]),
        column=np.concatenate([part[3] for part in parts]),
        section=np.array([part[0] for part in parts], dtype=np.int32)[repeat],
        tier=np.array([part[4] for part in parts], dtype=np.int8)[repeat],
        sections=tuple(
            (str(part[0]), stop - size, stop)
            for part, size, stop in zip(parts, sizes, stops, strict=True)
        ),
        structure=structure,
    )
    for column in (plan.position, plan.yaw, plan.row, plan.column, plan.section, plan.tier):
        column.setflags(write=False)
    return plan

"""A stadium for any number of spectators round a 105 x 68 m pitch.

From about ten thousand seats on the rows run all round; smaller grounds get a far stand first,
then a main stand, the ends and the corners. Rows rise by the sightline formula. The C-value aimed
at is at least 90 mm; where that would be steeper than 34 degrees, the bowl moves away from the
pitch, and if even 60 m do not help, it takes the best C-value that the rake leaves.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, pi, sqrt

import numpy as np
from numpy.typing import NDArray

from .outline import Block, Outline
from .seating import EYE_BEHIND, FEET, SeatPlan, Structure, Tier, seats_of
from .sightline import (
    C_GOOD,
    C_IDEAL,
    C_LEAST,
    MAX_RAKE,
    climb,
    distance_to_pitch,
    steepest,
)

F64 = NDArray[np.float64]
I32 = NDArray[np.int32]

MAX_SEATS = 1_000_000
TREAD = 0.80
GANGWAY = 1.2
SEAT_WIDTH, SEAT_WIDTH_MOST = 0.50, 0.55
MOST_IN_A_ROW = 28
"""Seats between two gangways."""

FIRST_HEIGHT = 1.0
"""First tread above the pitch: its spectators look over the advertising boards to the touchline."""
TIER_GAP, TIER_RAISE = 2.6, 3.0
"""Walkway between two tiers, and the height of the next tier's first tread above it."""

_CURVE = Outline(half_x=51.0, half_z=32.0, radius=10.0)
_SPLIT_X, _SPLIT_Z = 7, 5
_LONE_ROWS = 14
_SETBACKS = range(0, 64, 4)


def build_bowl(seats: int) -> SeatPlan:
    """A bowl with exactly `seats` seats.

    Parameters
    ----------
    seats
        1 to 1,000,000. Up to 24 rows are one tier, up to 84 two, more three.

    Returns
    -------
    SeatPlan whose first row is numbered from the far (-Z) side's left end, seen from the pitch.
    The last row is shorter where the number does not fill it: each of its blocks keeps its share
    of the seats, in its middle.
    """
    if isinstance(seats, bool) or not isinstance(seats, int) or not 1 <= seats <= MAX_SEATS:
        raise ValueError(f"seats must be a whole number from 1 to {MAX_SEATS:,}, not {seats!r}")
    lone_rows = max(1, min(_LONE_ROWS, round(0.4 * sqrt(seats))))
    small = _layout(_CURVE, lone_rows)
    kept = _bays_for(small, seats)
    if kept is not None:
        return _finish(small, kept, seats)
    best: tuple[float, _Layout, list[F64]] | None = None
    for setback in _SETBACKS:
        outline = Outline(_CURVE.half_x + setback, _CURVE.half_z + setback, _CURVE.radius)
        layout = _layout(outline, _rows_for(outline, seats))
        c, heights = _rise(layout)
        if best is None or c > best[0]:
            best = (c, layout, heights)
        if c >= C_GOOD:
            break
    assert best is not None
    return _finish(best[1], None, seats, best[2])


@dataclass(frozen=True, slots=True, eq=False)
class _Layout:
    """Blocks and seat counts of all tiers of a full ring, before any block is left out."""

    outline: Outline
    offsets: list[F64]
    blocks: list[tuple[Block, ...]]
    bays: list[list[int]]
    counts: list[I32]
    widths: list[F64]


def _tier_rows(rows: int) -> list[int]:
    """Rows of each tier; later tiers get the remainder and a little more."""
    tiers = 1 if rows <= 24 else 2 if rows <= 84 else 3
    shares = {1: (1.0,), 2: (0.45, 0.55), 3: (0.3, 0.34, 0.36)}[tiers]
    result = [round(rows * share) for share in shares[:-1]]
    return [*result, rows - sum(result)]


def _layout(outline: Outline, rows: int) -> _Layout:
    """Divide every tier into blocks of at most 28 seats; blocks of a bay share its gangways."""
    per_tier = _tier_rows(rows)
    result = _Layout(outline, [], [], [], [], [])
    start, base = 0.0, 0
    for count in per_tier:
        offsets = start + TREAD * np.arange(count, dtype=np.float64)
        most = MOST_IN_A_ROW * SEAT_WIDTH + GANGWAY
        need = ceil(pi / 2 * (outline.radius + float(offsets[-1]) + FEET) / most)
        base = base or need
        share = ceil(need / base)
        blocks: list[Block] = []
        bays: list[int] = []
        bay = 0
        for piece in outline.pieces():
            if piece.is_arc:
                parts, each = base, share
            else:
                fewest = _SPLIT_X if abs(np.sin(piece.start)) < 0.5 else _SPLIT_Z
                parts, each = max(fewest, ceil(piece.span / most)), 1
            blocks += piece.split(parts * each)
            bays += [bay + i // each for i in range(parts * each)]
            bay += parts
        counts, widths = _fill(tuple(blocks), offsets)
        result.offsets.append(offsets)
        result.blocks.append(tuple(blocks))
        result.bays.append(bays)
        result.counts.append(counts)
        result.widths.append(widths)
        start = float(offsets[-1]) + TREAD + TIER_GAP
    return result


def _fill(blocks: tuple[Block, ...], offsets: F64) -> tuple[I32, F64]:
    """Seats of (R rows, B blocks) and the metres each seat gets."""
    free = np.stack([block.length(offsets + FEET) for block in blocks], axis=1) - GANGWAY
    counts = np.clip(np.floor(free / SEAT_WIDTH + 1e-9), 0, MOST_IN_A_ROW).astype(np.int32)
    widths = np.minimum(free / np.maximum(counts, 1), SEAT_WIDTH_MOST)
    return counts, np.maximum(widths, SEAT_WIDTH)


def _capacity(outline: Outline, rows: int) -> int:
    return sum(int(counts.sum()) for counts in _layout(outline, rows).counts)


def _rows_for(outline: Outline, seats: int) -> int:
    """Fewest rows of a full ring that hold `seats`."""
    low, high = 1, 2
    while _capacity(outline, high) < seats:
        low, high = high, high * 2
    while low < high:
        middle = (low + high) // 2
        if _capacity(outline, middle) < seats:
            low = middle + 1
        else:
            high = middle
    return low


def _bays_for(layout: _Layout, seats: int) -> set[int] | None:
    """Bays of a one-tier ground that is too small for a ring; None if it takes the whole ring."""
    per_block = layout.counts[0].sum(axis=0)
    pieces = layout.outline.pieces()
    middles = [block.locate(0.5, 0.0) for block in layout.blocks[0]]
    phi = np.array([float(middle[2]) for middle in middles])
    x = np.array([float(middle[0]) for middle in middles])
    z = np.array([float(middle[1]) for middle in middles])
    arc = np.array([block.is_arc for block in layout.blocks[0]])
    far = ~arc & (np.abs(phi - pieces[0].start) < 0.1)
    main = ~arc & (np.abs(phi - pieces[4].start) < 0.1)
    side = np.select([far, main, ~arc], [0, 1, 2], 3)
    out_of_middle = np.where(side < 2, np.abs(x), np.where(side == 2, np.abs(z), -np.abs(z)))
    groups = np.stack([side, np.round(out_of_middle, 3)], axis=1)
    held, kept = 0, set[int]()
    for group in np.unique(groups, axis=0):
        if held >= seats:
            return kept
        members = np.flatnonzero((groups == group).all(axis=1))
        held += int(per_block[members].sum())
        kept |= {layout.bays[0][m] for m in members}
    return None


def _rise(layout: _Layout) -> tuple[float, list[F64]]:
    """The largest C-value up to 120 mm that the rake allows (at least 60 mm), and the heights."""
    turns = np.linspace(0.0, 1.0, 33)[:, None]
    distances: list[F64] = []
    for offsets in layout.offsets:
        eyes = offsets + FEET + EYE_BEHIND
        near = [
            distance_to_pitch(*piece.locate(turns if piece.is_arc else 0.5, eyes)[:2])
            for piece in layout.outline.pieces()[:3]
        ]
        distances.append(np.min(np.concatenate([np.atleast_2d(d) for d in near]), axis=0))

    def heights(c: float) -> list[F64]:
        return climb(distances, c, first_height=FIRST_HEIGHT, raises=TIER_RAISE, tread=TREAD)

    low, high = C_LEAST, C_IDEAL
    if steepest(heights(high), TREAD) <= MAX_RAKE:
        return high, heights(high)
    for _ in range(12):
        middle = 0.5 * (low + high)
        if steepest(heights(middle), TREAD) <= MAX_RAKE:
            low = middle
        else:
            high = middle
    return low, heights(low)


def _trim(counts: list[I32], excess: int) -> None:
    """Take `excess` seats from the last rows, evenly over their blocks, in place."""
    for tier in reversed(counts):
        for row in tier[::-1]:
            held = int(row.sum())
            keep = max(0, held - excess)
            if excess <= 0:
                return
            excess -= held - keep
            shares = np.cumsum(row.astype(np.int64)) * keep * 2 + held
            row[:] = np.diff(shares // (2 * max(held, 1)), prepend=0)


def _finish(
    layout: _Layout, kept: set[int] | None, seats: int, heights: list[F64] | None = None
) -> SeatPlan:
    """Leave out bays, trim to the exact number, number the sections and place the seats."""
    levels = _rise(layout)[1] if heights is None else heights
    keep = [[kept is None or bay in kept for bay in bays] for bays in layout.bays]
    counts = [c[:, k] for c, k in zip(layout.counts, keep, strict=True)]
    _trim(counts, sum(int(c.sum()) for c in counts) - seats)
    places = [
        (bay, level, b)
        for level, bays in enumerate(layout.bays)
        for b, bay in enumerate(bays)
        if keep[level][b]
    ]
    number = {place: i for i, place in enumerate(sorted(places))}
    tiers: list[Tier] = []
    first = 0
    for level, offsets in enumerate(layout.offsets):
        rows = int(np.flatnonzero(counts[level].any(axis=1)).max(initial=-1)) + 1
        if rows == 0:
            continue
        chosen = [b for b, wanted in enumerate(keep[level]) if wanted]
        tiers.append(
            Tier(
                blocks=tuple(layout.blocks[level][b] for b in chosen),
                sections=tuple(number[layout.bays[level][b], level, b] for b in chosen),
                first_row=first,
                offsets=offsets[:rows],
                heights=levels[level][:rows],
                counts=counts[level][:rows],
                widths=layout.widths[level][:rows][:, chosen],
            )
        )
        first += rows
    structure = Structure(layout.outline, tuple(tiers), TREAD, GANGWAY, kept is None)
    return seats_of(structure)

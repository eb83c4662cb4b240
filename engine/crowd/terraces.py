"""The stands' geometry: steps, seats, stairs and walls that follow the rows of a structure."""

from __future__ import annotations

from math import acos, ceil

import numpy as np
from numpy.typing import NDArray

from .outline import Block
from .seating import FEET, SEAT_BACK, SEAT_FRONT, SEAT_HEIGHT, Structure, Tier
from .stadium_mesh import UP, MeshBuilder, Surface

F64 = NDArray[np.float64]

FRONT = 0.2
"""A tier's front wall stands this far before its first row's feet line, metres."""

_CONCRETE = (150, 149, 145)
_RISER = (128, 127, 124)
_STAIRS = (176, 174, 166)
_WALL = (98, 101, 107)
_RIBBON = (24, 40, 92)
_RAIL = (205, 207, 210)
_SEATS = ((30, 58, 122), (44, 78, 150))
_UPPER_SEATS = ((38, 66, 128), (54, 90, 160))
_BACK_TOP = 0.84
_PARAPET = 0.9
_SAG = 0.03
# Where neighbours sit far apart, seats stand singly; of very many, benches are drawn instead.
_WIDEST_BENCH, _LONE_WIDTH, _MOST_SINGLE = 0.8, 0.5, 20_000


def add_terraces(builder: MeshBuilder, structure: Structure) -> None:
    """All tiers with their seats and gangways, from the ground up."""
    ground = 0.0
    for level, tier in enumerate(structure.tiers):
        for i in range(len(tier.blocks)):
            _add_steps(builder, structure, tier, i)
            _add_seats(builder, tier, i, level)
            _add_front(builder, structure, tier, i, level, ground)
        if structure.gangway > 0.0:
            _add_gangways(builder, structure, tier)
        for block, at_end in open_ends(tier):
            _add_side(builder, structure, tier, block, at_end)
        if level + 1 < len(structure.tiers):
            _add_walkway(builder, structure, tier, structure.tiers[level + 1])
        ground = float(tier.heights[-1])


def arc_points(block: Block, offset: float) -> int:
    """Points along a block so that the chords leave the arc by at most 3 cm (more far out)."""
    radius = block.radius + offset
    sag = _SAG * max(1.0, radius / 80.0)
    turn = 2.0 * acos(max(0.0, 1.0 - sag / max(radius, sag)))
    return 2 if not block.is_arc else 1 + max(1, ceil((block.stop - block.start) / turn))


def row_points(block: Block, fraction: F64, offset: F64 | float, height: F64 | float) -> F64:
    """(..., 3) points of a block at a fraction of its length, an offset and a height."""
    x, z, _ = block.locate(fraction, offset)
    return np.stack([x, np.broadcast_to(np.asarray(height, dtype=np.float64), x.shape), z], axis=-1)


def inward(block: Block, fraction: F64) -> F64:
    """(..., 3) unit vectors towards the pitch."""
    phi = block.start + fraction * (block.stop - block.start)
    return np.stack([-np.sin(phi), np.zeros_like(phi), np.cos(phi)], axis=-1)


def open_ends(tier: Tier) -> list[tuple[Block, bool]]:
    """Ends of blocks that no other block continues; True for a block's last end."""
    result: list[tuple[Block, bool]] = []
    for block, follower in zip(tier.blocks, (*tier.blocks[1:], tier.blocks[0]), strict=True):
        if not _meet(block, follower):
            result += [(block, True), (follower, False)]
    return result


def _meet(block: Block, follower: Block) -> bool:
    end, begin = block.locate(1.0, 0.0), follower.locate(0.0, 0.0)
    return bool(np.hypot(end[0] - begin[0], end[1] - begin[1]) < 1e-3)


def _margins(structure: Structure, tier: Tier, block: Block, offset: F64) -> F64:
    """Fraction of the block's length that half a gangway takes."""
    return 0.5 * structure.gangway / block.length(offset)


def _fractions(margin: F64, points: int) -> F64:
    """(R, P) fractions from margin to 1 - margin for margins (R,)."""
    return margin[:, None] + (1.0 - 2.0 * margin[:, None]) * np.linspace(0.0, 1.0, points)


def _edges(tier: Tier) -> F64:
    """Front edges of the treads; the first begins at the tier's front wall."""
    edges = tier.offsets.copy()
    edges[0] -= FRONT
    return edges


def _add_steps(builder: MeshBuilder, structure: Structure, tier: Tier, index: int) -> None:
    block = tier.blocks[index]
    front, back = _edges(tier), tier.offsets + structure.tread
    points = arc_points(block, float(back[-1]))
    at_front = _fractions(_margins(structure, tier, block, front), points)
    at_back = _fractions(_margins(structure, tier, block, back), points)
    height = tier.heights[:, None]
    near = row_points(block, at_front, front[:, None], height)
    far = row_points(block, at_back, back[:, None], height)
    builder.strip(near, far, UP, Surface.CONCRETE, _CONCRETE)
    lifted = near[1:]
    builder.strip(far[:-1], lifted, inward(block, at_front[1:]), Surface.CONCRETE, _RISER)


def _add_seats(builder: MeshBuilder, tier: Tier, index: int, level: int) -> None:
    block, count, width = tier.blocks[index], tier.counts[:, index], tier.widths[:, index]
    rows = np.flatnonzero(count)
    feet = tier.offsets[rows] + FEET
    taken = count[rows] * width[rows] / block.length(feet)
    if width.min() > _WIDEST_BENCH and tier.counts.sum() <= _MOST_SINGLE:
        u, at = _single_seats(int(count.max()), float(width.max()), len(rows))
        feet = np.repeat(feet, len(at) // len(rows))
        height = np.repeat(tier.heights[rows], len(at) // len(rows))[:, None]
    else:
        share = np.linspace(0.0, 1.0, arc_points(block, float(tier.offsets[-1])))
        u, at = count[rows, None] * share, 0.5 + taken[:, None] * (share - 0.5)
        height = tier.heights[rows, None]
    palette = _SEATS if level == 0 else _UPPER_SEATS
    color = palette[tier.sections[index] % 2 if level == 0 else index % 2]
    pan = [
        row_points(block, at, (feet + where)[:, None], height + SEAT_HEIGHT)
        for where in (SEAT_FRONT, SEAT_BACK)
    ]
    lip = row_points(block, at, (feet + SEAT_FRONT)[:, None], height + SEAT_HEIGHT - 0.08)
    top = row_points(block, at, (feet + SEAT_BACK)[:, None], height + _BACK_TOP)
    toward = inward(block, at)
    depth = SEAT_BACK - SEAT_FRONT
    tall = _BACK_TOP - SEAT_HEIGHT
    builder.strip(pan[0], pan[1], UP, Surface.SEATS, color, u=u, v=(0.0, depth))
    builder.strip(lip, pan[0], toward, Surface.SEATS, color, u=u, v=(-0.08, 0.0))
    builder.strip(pan[1], top, toward, Surface.SEATS, color, u=u, v=(depth, depth + tall))
    builder.strip(pan[1], top, -toward, Surface.SEATS, color, u=u, v=(depth, depth + tall))


def _single_seats(count: int, width: float, rows: int) -> tuple[F64, F64]:
    """u and fraction of both borders of every seat, (rows * count, 2), for a grid of lone seats."""
    seat = np.tile(np.arange(count, dtype=np.float64), rows)[:, None]
    half = 0.5 * _LONE_WIDTH / width
    border = np.array([0.0, 1.0])
    return seat + border, (seat + 0.5 + half * (2.0 * border - 1.0)) / count


def _add_front(
    builder: MeshBuilder, structure: Structure, tier: Tier, index: int, level: int, ground: float
) -> None:
    """Wall before the first row: up to the tread, then a rail (lowest tier) or a parapet."""
    block, foot, floor = tier.blocks[index], float(_edges(tier)[0]), float(tier.heights[0])
    at = np.linspace(0.0, 1.0, arc_points(block, foot))
    toward = inward(block, at)

    def line(offset: float, height: float) -> F64:
        return row_points(block, at, offset, height)

    if floor > ground:
        builder.strip(line(foot, ground), line(foot, floor), toward, Surface.WALL, _WALL)
    if structure.outline is None:
        return
    if level == 0:
        rail = floor + _PARAPET
        builder.strip(line(foot, rail - 0.06), line(foot, rail), toward, Surface.STEEL, _RAIL)
        builder.strip(line(foot, rail - 0.06), line(foot, rail), -toward, Surface.STEEL, _RAIL)
        return
    top, behind = floor + _PARAPET - 0.1, foot + 0.1
    builder.strip(line(foot, floor), line(foot, top), toward, Surface.BOARD, _RIBBON)
    builder.strip(line(behind, floor), line(behind, top), -toward, Surface.WALL, _WALL)
    builder.strip(line(foot, top), line(behind, top), UP, Surface.STEEL, _RAIL)


def _add_walkway(builder: MeshBuilder, structure: Structure, tier: Tier, above: Tier) -> None:
    """Floor behind the last row of a tier up to the front wall of the next."""
    near, far = float(tier.offsets[-1]) + structure.tread, float(_edges(above)[0])
    height = float(tier.heights[-1])
    for block in tier.blocks:
        at = np.linspace(0.0, 1.0, arc_points(block, far))
        near_line, far_line = (row_points(block, at, o, height) for o in (near, far))
        builder.strip(near_line, far_line, UP, Surface.CONCRETE, _CONCRETE)


def _add_gangways(builder: MeshBuilder, structure: Structure, tier: Tier) -> None:
    """Stairs between neighbouring blocks, two steps a row, and half ones at open ends."""
    followers = (*tier.blocks[1:], tier.blocks[0])
    for block, follower in zip(tier.blocks, followers, strict=True):
        if _meet(block, follower):
            _add_stairs(builder, structure, tier, (block, True, 1.0), (follower, True, 0.0))
        else:
            _add_stairs(builder, structure, tier, (block, True, 1.0), (block, False, 1.0))
            _add_stairs(builder, structure, tier, (follower, False, 0.0), (follower, True, 0.0))


def _add_stairs(
    builder: MeshBuilder,
    structure: Structure,
    tier: Tier,
    left: tuple[Block, bool, float],
    right: tuple[Block, bool, float],
) -> None:
    """One flight; a side is (block, whether half a gangway inside it, which end)."""

    def cross(offset: F64, height: F64) -> F64:
        sides = []
        for block, inside, end in (left, right):
            margin = _margins(structure, tier, block, offset) if inside else np.zeros_like(offset)
            at = end + margin * (1.0 - 2.0 * end)
            sides.append(row_points(block, at, offset, height))
        return np.stack(sides, axis=-2)

    ahead = inward(left[0], np.array(left[2]))
    front, back = _edges(tier), tier.offsets + structure.tread
    low, high = tier.heights[:-1], tier.heights[1:]
    middle, half = 0.5 * (low + high), back[:-1] - 0.5 * structure.tread
    edge = np.append(half, back[-1])
    builder.strip(
        cross(front, tier.heights), cross(edge, tier.heights), UP, Surface.STAIRS, _STAIRS
    )
    builder.strip(cross(half, low), cross(half, middle), ahead, Surface.STAIRS, _RISER)
    builder.strip(cross(half, middle), cross(back[:-1], middle), UP, Surface.STAIRS, _STAIRS)
    builder.strip(cross(back[:-1], middle), cross(back[:-1], high), ahead, Surface.STAIRS, _RISER)


def _add_side(
    builder: MeshBuilder, structure: Structure, tier: Tier, block: Block, at_end: bool
) -> None:
    """Wall from the ground to the treads where a stand ends."""
    end = np.full(len(tier.offsets), 1.0 if at_end else 0.0)
    front, back = _edges(tier), tier.offsets + structure.tread
    tangent = np.array([np.cos(block.start), 0.0, np.sin(block.start)])
    if at_end:
        tangent = np.array([np.cos(block.stop), 0.0, np.sin(block.stop)])
    out = tangent if at_end else -tangent
    feet = [row_points(block, end, o, 0.0) for o in (front, back)]
    tops = [row_points(block, end, o, tier.heights) for o in (front, back)]
    builder.strip(np.stack(feet, axis=-2), np.stack(tops, axis=-2), out, Surface.WALL, _WALL)

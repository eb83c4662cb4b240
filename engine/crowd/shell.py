"""What stands round the rows: back walls, the outer wall, the roof, aprons and the ground."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .outline import Block, Outline
from .pitch import GRASS_HALF_X, GRASS_HALF_Z
from .seating import Structure
from .stadium_mesh import UP, MeshBuilder, Surface
from .terraces import FRONT, arc_points, inward, open_ends, row_points

F64 = NDArray[np.float64]

ROOF_ROWS = 20
"""Complete bowls with at least this many rows have a roof."""
ROOF_CLEAR, ROOF_RISE, ROOF_THICK = 6.5, 0.05, 0.7
"""Roof above the last tread, its rise per metre towards the pitch, its edge; metres."""

_BACK_WALL = 2.4
_CONCOURSE = 6.0
_WALL = (112, 115, 121)
_OUTER = ((88, 92, 100), (188, 194, 200), (72, 92, 120), (206, 210, 214))
_ROOF_TOP, _ROOF_UNDER = (214, 217, 221), (150, 154, 160)
_STEEL = (196, 200, 205)
_APRON = (118, 116, 112)
_PAVING, _GROUND = (134, 132, 127), (88, 102, 74)
_GRASS = (62, 118, 46)
_PAVED, _OUTSIDE = 30.0, 700.0


def roof_span(structure: Structure) -> tuple[float, float, float] | None:
    """Offset of the roof's inner and outer edge and its height at the back; None without a roof."""
    rows = sum(len(tier.offsets) for tier in structure.tiers)
    if not structure.complete or rows < ROOF_ROWS:
        return None
    last = structure.tiers[-1]
    back = float(last.offsets[-1]) + structure.tread
    covered = 0.55 * (back - float(last.offsets[0]))
    return back - min(covered, 30.0), back + _CONCOURSE, float(last.heights[-1]) + ROOF_CLEAR


def add_bowl_shell(builder: MeshBuilder, structure: Structure, outline: Outline) -> None:
    """Back and outer wall, roof where there is one, apron and ground of a bowl."""
    last = structure.tiers[-1]
    span = roof_span(structure)
    for block in last.blocks:
        if span is None:
            _add_low_back(builder, structure, block)
        else:
            _add_high_back(builder, structure, block, span)
            _add_roof(builder, block, span)
    if span is not None:
        _add_rafters(builder, last.blocks, span)
    _add_apron(builder, outline)
    _add_ground(builder, outline, float(last.offsets[-1]) + _CONCOURSE + _PAVED)


def _lines(block: Block, offset: float) -> tuple[F64, F64]:
    """Fractions along the block for a smooth arc at `offset`, and the inward normals there."""
    at = np.linspace(0.0, 1.0, arc_points(block, offset))
    return at, inward(block, at)


def _add_low_back(builder: MeshBuilder, structure: Structure, block: Block) -> None:
    """Wall behind the last row of an open stand, with the same wall seen from outside."""
    last = structure.tiers[-1]
    near = float(last.offsets[-1]) + structure.tread
    floor, far = float(last.heights[-1]), near + 0.4
    top = floor + _BACK_WALL
    at, toward = _lines(block, far)
    base, rim = row_points(block, at, near, floor), row_points(block, at, near, top)
    builder.strip(base, rim, toward, Surface.WALL, _WALL)
    outer = row_points(block, at, far, top)
    builder.strip(rim, outer, UP, Surface.WALL, _WALL)
    builder.strip(row_points(block, at, far, 0.0), outer, -toward, Surface.WALL, _OUTER[0])
    for open_block, at_end in open_ends(last):
        if open_block is not block:
            continue
        end = np.array([1.0 if at_end else 0.0])
        phi = block.stop if at_end else block.start
        out = np.array([np.cos(phi), 0.0, np.sin(phi)]) * (1.0 if at_end else -1.0)
        low = np.concatenate([row_points(block, end, o, 0.0) for o in (near, far)])
        high = np.concatenate([row_points(block, end, o, top) for o in (near, far)])
        builder.strip(low, high, out, Surface.WALL, _WALL)


def _add_high_back(
    builder: MeshBuilder, structure: Structure, block: Block, span: tuple[float, float, float]
) -> None:
    """Wall behind the last row, an open strip under the roof, and the banded outer wall."""
    last = structure.tiers[-1]
    near, floor = float(last.offsets[-1]) + structure.tread, float(last.heights[-1])
    _, far, roof = span
    at, toward = _lines(block, far)
    wall = floor + _BACK_WALL
    base, rim = row_points(block, at, near, floor), row_points(block, at, near, wall)
    builder.strip(base, rim, toward, Surface.WALL, _WALL)
    builder.strip(rim, row_points(block, at, far, wall), UP, Surface.CONCRETE, _APRON)
    levels = [0.0, 0.22 * roof, 0.52 * roof, 0.62 * roof, roof + ROOF_THICK]
    for low, high, color in zip(levels[:-1], levels[1:], _OUTER, strict=True):
        lower, upper = row_points(block, at, far, low), row_points(block, at, far, high)
        builder.strip(lower, upper, -toward, Surface.WALL, color)
    inner = row_points(block, at, far, wall), row_points(block, at, far, roof)
    builder.strip(*inner, toward, Surface.WALL, _OUTER[2])


def _add_roof(builder: MeshBuilder, block: Block, span: tuple[float, float, float]) -> None:
    """Both faces of the roof, its edge over the pitch."""
    inner, outer, height = span
    edge = height + ROOF_RISE * (outer - inner)
    at, toward = _lines(block, outer)
    under = row_points(block, at, inner, edge), row_points(block, at, outer, height)
    tops = under[0] + ROOF_THICK * UP, under[1] + ROOF_THICK * UP
    slope = UP - ROOF_RISE * toward
    slope /= np.linalg.norm(slope, axis=-1, keepdims=True)
    builder.strip(*under, -slope, Surface.ROOF, _ROOF_UNDER)
    builder.strip(*tops, slope, Surface.ROOF, _ROOF_TOP)
    builder.strip(under[0], tops[0], toward, Surface.STEEL, _STEEL)


def _add_rafters(
    builder: MeshBuilder, blocks: tuple[Block, ...], span: tuple[float, float, float]
) -> None:
    """Steel beams and posts under the roof at every second block border, and fins outside."""
    inner, outer, height = span
    edge = height + ROOF_RISE * (outer - inner)
    ends = [
        np.concatenate([row_points(block, np.array([0.0]), o, h) for block in blocks[::2]])
        for o, h in ((inner + 0.3, edge - 0.3), (outer - 0.3, height - 0.5))
    ]
    builder.beam(ends[0], ends[1], 0.4, 0.6, Surface.STEEL, _STEEL)
    feet = np.concatenate(
        [
            row_points(block, np.array([0.0]), outer - 3.0, height - ROOF_CLEAR + _BACK_WALL)
            for block in blocks[::2]
        ]
    )
    heads = feet.copy()
    heads[:, 1] = height + ROOF_RISE * 3.0
    builder.beam(feet, heads, 0.5, 0.5, Surface.STEEL, _STEEL)
    feet = np.concatenate(
        [
            row_points(block, np.array([at]), outer + 0.3, 0.0)
            for block in blocks
            for at in (0.0, 0.5)
        ]
    )
    heads = feet + (height + ROOF_THICK) * UP
    builder.beam(feet, heads, 0.35, 0.9, Surface.STEEL, _STEEL)


def _add_apron(builder: MeshBuilder, outline: Outline) -> None:
    """Hard ground between the grass's rectangle and the front of the rounded rows."""
    gx, gz = GRASS_HALF_X, GRASS_HALF_Z
    for piece in outline.pieces():
        at = np.linspace(0.0, 1.0, 25 if piece.is_arc else 2)
        outer = row_points(piece, at, -FRONT, 0.0)
        inner = outer.copy()
        if piece.is_arc:
            # Half the arc runs along one side of the rectangle, the other half along the next.
            first, last = outer[0], outer[-1]
            corner = np.array([np.sign(piece.x) * gx, 0.0, np.sign(piece.z) * gz])
            ends = [_to_grass(first), _to_grass(last)]
            inner = np.where(
                (at < 0.5)[:, None],
                ends[0] + (corner - ends[0]) * np.minimum(2 * at, 1.0)[:, None],
                corner + (ends[1] - corner) * np.maximum(2 * at - 1.0, 0.0)[:, None],
            )
        else:
            inner = np.stack([_to_grass(point) for point in outer])
        builder.strip(inner, outer, UP, Surface.GROUND, _APRON)


def _to_grass(point: F64) -> F64:
    """The grass's border straight before a point of the front line."""
    return np.clip(point, [-GRASS_HALF_X, 0.0, -GRASS_HALF_Z], [GRASS_HALF_X, 0.0, GRASS_HALF_Z])


def _add_ground(builder: MeshBuilder, outline: Outline, paved: float) -> None:
    """The plane from the front of the rows on, paved up to the offset `paved`."""
    edges = (-FRONT, paved, paved + _OUTSIDE)
    for piece in outline.pieces():
        at = np.linspace(0.0, 1.0, 25 if piece.is_arc else 2)
        lines = [row_points(piece, at, edge, 0.0) for edge in edges]
        builder.strip(lines[0], lines[1], UP, Surface.GROUND, _PAVING)
        builder.strip(lines[1], lines[2], UP, Surface.GROUND, _GROUND)


def add_stand_shell(builder: MeshBuilder, structure: Structure) -> None:
    """Back wall, floor and a strip of grass with a touchline for a single straight stand."""
    (tier,) = structure.tiers
    left = row_points(tier.blocks[0], np.array(0.0), 0.0, 0.0)
    right = row_points(tier.blocks[-1], np.array(1.0), 0.0, 0.0)
    front, x0, x1 = float(left[2]), float(left[0]), float(right[0])
    back = front - float(tier.offsets[-1]) - structure.tread
    floor = float(tier.heights[-1])
    top = floor + _BACK_WALL
    for depth, low, normal in ((back, floor, 1.0), (back - 0.4, 0.0, -1.0)):
        corners = [[x0, low, depth], [x1, low, depth], [x1, top, depth], [x0, top, depth]]
        builder.quad(corners, [0.0, 0.0, normal], Surface.WALL, _WALL)
    corners = [[x0, top, back], [x1, top, back], [x1, top, back - 0.4], [x0, top, back - 0.4]]
    builder.quad(corners, UP, Surface.WALL, _WALL)
    for x, normal in ((x0, -1.0), (x1, 1.0)):
        side = [[x, 0.0, back], [x, 0.0, back - 0.4], [x, top, back - 0.4], [x, top, back]]
        builder.quad(side, [normal, 0.0, 0.0], Surface.WALL, _WALL)
    reach = max(300.0, 2.0 * (x1 - x0), 3.0 * top)
    west, east = x0 - reach, x1 + reach
    lines = [back - reach, back - 0.4, front + FRONT, front + 3.0]
    _flat(builder, west, east, lines[0], lines[1], Surface.GROUND, _GROUND)
    _flat(builder, west, x0, lines[1], lines[2], Surface.GROUND, _GROUND)
    _flat(builder, x1, east, lines[1], lines[2], Surface.GROUND, _GROUND)
    _flat(builder, west, east, lines[2], lines[3], Surface.GROUND, _APRON)
    grass = np.array(
        [[west, lines[3]], [east, lines[3]], [east, lines[3] + 40], [west, lines[3] + 40]]
    )
    points = np.stack([grass[:, 0], np.zeros(4), grass[:, 1]], axis=-1)
    rgb = np.tile(np.array(_GRASS, dtype=np.uint8), (4, 1))
    corners_of = np.array([[0, 1, 2], [0, 2, 3]])
    builder.add(points, np.tile(UP, (4, 1)), grass, rgb, Surface.GRASS, corners_of)
    line = lines[3] + 2.8
    _flat(builder, west, east, line, line + 0.12, Surface.LINE, (240, 242, 238), height=0.02)
    _flat(builder, west, east, lines[3] + 40, lines[3] + reach, Surface.GROUND, _GROUND)


def _flat(
    builder: MeshBuilder,
    x0: float,
    x1: float,
    z0: float,
    z1: float,
    surface: Surface,
    color: tuple[int, int, int],
    height: float = 0.0,
) -> None:
    corners = [[x0, height, z0], [x1, height, z0], [x1, height, z1], [x0, height, z1]]
    builder.quad(corners, UP, surface, color)

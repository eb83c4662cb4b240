"""The pitch: grass, the markings of the Laws of the Game, goals and advertising boards."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .sightline import PITCH_HALF_X, PITCH_HALF_Z
from .stadium_mesh import UP, MeshBuilder, Surface

GRASS_HALF_X, GRASS_HALF_Z = 56.5, 37.5
"""The grass ends at the advertising boards, metres from the centre."""

_WIDTH = 0.12
_LIFT = 0.02
_GREEN = (62, 118, 46)
_WHITE = (240, 242, 238)
_BOARD_HEIGHT, _BOARD_THICK = 0.9, 0.15
_BOARDS = (
    (196, 30, 42),
    (245, 245, 240),
    (18, 60, 140),
    (250, 196, 20),
    (20, 22, 26),
    (0, 128, 96),
    (232, 96, 24),
    (110, 40, 130),
)


def add_pitch(builder: MeshBuilder) -> None:
    """Grass with run-off, markings, goals and boards, with its centre at the origin."""
    x, z = GRASS_HALF_X, GRASS_HALF_Z
    corners = np.array([[-x, 0, -z], [x, 0, -z], [x, 0, z], [-x, 0, z]])
    builder.add(
        corners,
        np.tile(UP, (4, 1)),
        corners[:, [0, 2]],
        np.tile(np.array(_GREEN, dtype=np.uint8), (4, 1)),
        Surface.GRASS,
        np.array([[0, 1, 2], [0, 2, 3]]),
    )
    _add_lines(builder)
    _add_goals(builder)
    _add_boards(builder)


def _add_lines(builder: MeshBuilder) -> None:
    x, z = PITCH_HALF_X, PITCH_HALF_Z
    _frame(builder, -x, x, -z, z)
    _rectangle(builder, -_WIDTH / 2, _WIDTH / 2, -z + _WIDTH, z - _WIDTH)
    _arc(builder, 0.0, 0.0, 9.15, 0.0, 2 * np.pi)
    _spot(builder, 0.0)
    for end in (-1, 1):
        for reach, half in ((16.5, 20.16), (5.5, 9.16)):
            inner, outer = sorted((end * (x - reach), end * x))
            _frame(builder, inner, outer, -half, half)
        spot = end * (x - 11.0)
        _spot(builder, spot)
        # The part of the circle round the spot that lies outside the penalty area.
        half_angle = np.arccos(5.5 / 9.15)
        middle = 0.0 if end < 0 else np.pi
        _arc(builder, spot, 0.0, 9.15, middle - half_angle, middle + half_angle)
        for side in (-1, 1):
            into = np.arctan2(-side, -end)
            _arc(builder, end * x, side * z, 1.0, into - np.pi / 4, into + np.pi / 4)


def _rectangle(builder: MeshBuilder, x0: float, x1: float, z0: float, z1: float) -> None:
    corners = [[x0, _LIFT, z0], [x1, _LIFT, z0], [x1, _LIFT, z1], [x0, _LIFT, z1]]
    builder.quad(corners, UP, Surface.LINE, _WHITE)


def _frame(builder: MeshBuilder, x0: float, x1: float, z0: float, z1: float) -> None:
    """Lines along a rectangle's four sides, inside it."""
    _rectangle(builder, x0, x1, z0, z0 + _WIDTH)
    _rectangle(builder, x0, x1, z1 - _WIDTH, z1)
    _rectangle(builder, x0, x0 + _WIDTH, z0 + _WIDTH, z1 - _WIDTH)
    _rectangle(builder, x1 - _WIDTH, x1, z0 + _WIDTH, z1 - _WIDTH)


def _arc(
    builder: MeshBuilder, x: float, z: float, radius: float, start: float, stop: float
) -> None:
    """Line whose outer edge is an arc about (x, z), angles from +x towards +z."""
    pieces = max(6, int(np.ceil((stop - start) * 10)))
    angle = np.linspace(start, stop, pieces + 1)
    builder.strip(
        _round(x, z, radius - _WIDTH, angle), _round(x, z, radius, angle), UP, Surface.LINE, _WHITE
    )


def _spot(builder: MeshBuilder, x: float) -> None:
    angle = np.linspace(0.0, 2 * np.pi, 13)
    rim = _round(x, 0.0, 0.15, angle)
    builder.strip(np.broadcast_to([x, _LIFT, 0.0], rim.shape), rim, UP, Surface.LINE, _WHITE)


def _round(x: float, z: float, radius: float, angle: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.stack(
        [x + radius * np.cos(angle), np.full_like(angle, _LIFT), z + radius * np.sin(angle)],
        axis=-1,
    )


def _add_goals(builder: MeshBuilder) -> None:
    """Posts and bar 7.32 x 2.44 m inside, 0.12 m thick, and the frame that holds the net."""
    half, top, thick = 7.32 / 2 + _WIDTH / 2, 2.44 + _WIDTH / 2, _WIDTH
    for end in (-1, 1):
        line = end * (PITCH_HALF_X - _WIDTH / 2)
        back = end * (PITCH_HALF_X + 2.0)
        posts = np.array([[line, 0.0, -half], [line, 0.0, half]])
        heads = posts + (top + thick / 2) * UP
        builder.beam(posts, heads, thick, thick, Surface.STEEL, _WHITE)
        builder.beam(
            [line, top, -half + thick / 2],
            [line, top, half - thick / 2],
            thick,
            thick,
            Surface.STEEL,
            _WHITE,
        )
        stays = np.array([[back, 0.03, -half], [back, 0.03, half]])
        builder.beam(heads - thick * UP, stays, 0.05, 0.05, Surface.STEEL, (190, 192, 194))
        builder.beam(stays[0], stays[1], 0.05, 0.05, Surface.STEEL, (190, 192, 194))


def _add_boards(builder: MeshBuilder) -> None:
    """One row of boards round the grass, a colour every six metres or so, grey at the back."""
    x, z = GRASS_HALF_X, GRASS_HALF_Z
    corners = np.array([[-x, -z], [x, -z], [x, z], [-x, z]])
    for side in range(4):
        a, b = corners[side], corners[(side + 1) % 4]
        length = float(np.hypot(*(b - a)))
        along = (b - a) / length
        out = np.array([along[1], -along[0]])
        panels = round(length / 6.0)
        ends = a + np.linspace(0.0, 1.0, panels + 1)[:, None] * (b - a)
        front = np.stack([ends[:-1], ends[1:]], axis=1)
        behind = front + _BOARD_THICK * out
        inward, outward = np.array([-out[0], 0.0, -out[1]]), np.array([out[0], 0.0, out[1]])
        choice = (side + 3 * np.arange(panels)) % len(_BOARDS)
        colors = np.array(_BOARDS, dtype=np.uint8)[choice][:, None, :].repeat(2, axis=1)
        low, high = _at(front, 0.0), _at(front, _BOARD_HEIGHT)
        builder.strip(low, high, inward, Surface.BOARD, colors, v=(0.0, _BOARD_HEIGHT))
        builder.strip(
            _at(behind, 0.0), _at(behind, _BOARD_HEIGHT), outward, Surface.STEEL, (70, 72, 76)
        )
        builder.strip(high, _at(behind, _BOARD_HEIGHT), UP, Surface.STEEL, (70, 72, 76))


def _at(plan: NDArray[np.float64], height: float) -> NDArray[np.float64]:
    """Points (..., 2) of the plan lifted to (..., 3)."""
    return np.stack([plan[..., 0], np.full(plan.shape[:-1], height), plan[..., 1]], axis=-1)

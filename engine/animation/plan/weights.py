"""The way down: each node gives its children their share and their time.

Every function takes all nodes of one kind: those on one level, if it depends on what the levels
above did, else all.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..controllers.program import Kind
from .columns import ranges
from .groups import Group
from .machines import step_machines
from .one_shots import step_one_shots
from .tables import LEAST_WEIGHT, Tables

_LONGEST = 1e6
"""Seconds that a tick can last in a tree: factors of many time scales don't overflow."""

_INSIDE = -1e-9
"""Least barycentric coordinate of a position that counts as inside a triangle."""


def step_level(tables: Tables, group: Group) -> None:
    """Take over from the parents whether nodes are active and how long the tick is for them."""
    columns, nodes = tables.nodes, group.nodes
    parent = group.derived("parent", lambda members: columns["parent"][members])
    columns["active"][nodes] = columns["active"][parent] & (columns["weight"][nodes] > LEAST_WEIGHT)
    seconds = np.clip(columns["delta"][parent] * columns["rate"][parent], -_LONGEST, _LONGEST)
    columns["delta"][nodes] = np.where(columns["restarted"][nodes], 0.0, seconds)


def _blend_2(tables: Tables, group: Group) -> None:
    children = group.children(tables)[0]
    amount = tables.value(group)
    weight = tables.nodes["weight"]
    weight[children[0::2]] = 1.0 - amount
    weight[children[1::2]] = amount


def _blend_n(tables: Tables, group: Group) -> None:
    children, owner = group.children(tables)
    entry = _parameters(tables, group)
    given = tables.values["value"][entry]
    whole = np.bincount(owner, given, len(group.nodes))
    share = given / np.where(whole > 0, whole, 1.0)[owner]
    tables.nodes["weight"][children] = share
    silent = group.nodes[whole <= 0]
    tables.nodes["weight"][tables.child(silent, 0)] = 1.0


def _time_scale(tables: Tables, group: Group) -> None:
    tables.nodes["rate"][group.nodes] = tables.value(group)


def _masked(tables: Tables, group: Group) -> None:
    # The base keeps its weight of 1.
    def overlays(nodes: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        columns = tables.nodes
        count = columns["child_count"][nodes] - 1
        entry, _ = ranges(columns["child_start"][nodes] + 1, count)
        return tables.children["node"][entry], ranges(columns["parameter"][nodes], count)[0]

    children, entry = group.derived("overlays", overlays)
    tables.nodes["weight"][children] = tables.values["value"][entry]


def _additive(tables: Tables, group: Group) -> None:
    children = group.children(tables)[0]
    tables.nodes["weight"][children[1::2]] = tables.value(group)


def _space_1d(tables: Tables, group: Group) -> None:
    columns, knots, nodes = tables.nodes, tables.constants["knots"], group.nodes

    def find(members: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        return ranges(columns["constant"][members], columns["constant_count"][members])

    entry, owner = group.derived("knots", find)
    position = tables.value(group)
    passed = np.bincount(owner, knots["at"][entry] <= position[owner], len(nodes)).astype(np.int64)
    first, last = columns["constant"][nodes], columns["constant_count"][nodes] - 1
    before = first + np.clip(passed - 1, 0, last)
    after = first + np.clip(passed, 0, last)
    start, stop = knots["at"][before], knots["at"][after]
    share = (position - start) / np.where(after > before, stop - start, 1.0)
    share = np.where(after > before, np.clip(share, 0.0, 1.0), 0.0)
    weight = columns["weight"]
    weight[group.children(tables)[0]] = 0.0
    weight[tables.child(nodes, knots["child"][after])] = share
    weight[tables.child(nodes, knots["child"][before])] = 1.0 - share


def _space_2d(tables: Tables, group: Group) -> None:
    columns, nodes = tables.nodes, group.nodes
    triangles, segments = tables.constants["triangles"], tables.constants["segments"]

    def find(members: NDArray[np.int64]) -> tuple[Any, Any]:
        return (
            ranges(columns["constant"][members], columns["constant_count"][members]),
            ranges(columns["second"][members], columns["second_count"][members]),
        )

    (triangle, of_triangle), (segment, of_segment) = group.derived("pieces", find)
    value = columns["parameter"][nodes]
    position = np.stack([tables.values["value"][value + k] for k in (0, 1)], axis=1)
    weight = columns["weight"]
    weight[group.children(tables)[0]] = 0.0
    # The nearest point of the hull first; positions inside a triangle overwrite it.
    from_start = position[of_segment] - segments["origin"][segment]
    along = np.clip(np.einsum("sk,sk->s", from_start, segments["project"][segment]), 0.0, 1.0)
    gap = from_start - along[:, None] * segments["along"][segment]
    best = _first_least(np.einsum("sk,sk->s", gap, gap), of_segment)
    ends = segments["end"][segment[best]]
    inside, place, shares = _inside(triangles, triangle, of_triangle, position)
    outside = np.ones(len(nodes), np.bool_)
    outside[inside] = False
    out = np.flatnonzero(outside)
    weight[tables.child(nodes[out], ends[out, 1])] = along[best][out]
    weight[tables.child(nodes[out], ends[out, 0])] = 1.0 - along[best][out]
    for corner in range(3):
        children = tables.child(nodes[inside], triangles["corner"][place, corner])
        weight[children] = shares[:, corner]


def _inside(
    triangles: Any,
    entry: NDArray[np.int64],
    owner: NDArray[np.int64],
    position: NDArray[np.float64],
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Which positions lie in a triangle: their places, the triangles, and the three shares."""
    from_corner = position[owner] - triangles["origin"][entry]
    uv = np.einsum("tij,tj->ti", triangles["inverse"][entry], from_corner)
    shares = np.concatenate([1.0 - uv.sum(axis=1, keepdims=True), uv], axis=1)
    least = shares.min(axis=1)
    best = _first_least(-least, owner)
    best = best[least[best] >= _INSIDE]
    found = np.maximum(shares[best], 0.0)
    return owner[best], entry[best], found / found.sum(axis=1, keepdims=True)


def _first_least(value: NDArray[np.float64], owner: NDArray[np.int64]) -> NDArray[np.int64]:
    """Place of the least value of each owner, owners ascending."""
    order = np.lexsort((value, owner))
    return order[np.flatnonzero(np.diff(owner[order], prepend=-1))]


def _custom(tables: Tables, group: Group) -> None:
    columns, nodes = tables.nodes, group.nodes
    columns["time"][nodes] += np.where(columns["active"][nodes], columns["delta"][nodes], 0.0)


def _parameters(tables: Tables, group: Group) -> NDArray[np.int64]:
    """Places of as many parameters a node as it has children."""

    def find(nodes: NDArray[np.int64]) -> NDArray[np.int64]:
        columns = tables.nodes
        return ranges(columns["parameter"][nodes], columns["child_count"][nodes])[0]

    found: NDArray[np.int64] = group.derived("parameters", find)
    return found


STEPS: Mapping[int, Callable[[Tables, Group], None]] = {
    Kind.BLEND_2: _blend_2,
    Kind.BLEND_N: _blend_n,
    Kind.TIME_SCALE: _time_scale,
    Kind.MASKED: _masked,
    Kind.ADDITIVE: _additive,
    Kind.SPACE_1D: _space_1d,
    Kind.SPACE_2D: _space_2d,
    Kind.MACHINE: step_machines,
    Kind.ONE_SHOT: step_one_shots,
    Kind.CUSTOM: _custom,
}
"""What each kind of node does on the way down; clips do nothing."""

BY_LEVEL = (Kind.MACHINE, Kind.ONE_SHOT, Kind.CUSTOM)
"""Kinds whose step depends on whether the node is active and on its time."""

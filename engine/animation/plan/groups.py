"""Nodes that are evaluated by one call: those of one kind on one level."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .columns import ranges

Key = tuple[int, int]
Members = dict[Key, NDArray[np.int64]]
"""Numbers of nodes, by the group that they belong to."""


class Group:
    """Some nodes, and what was derived from which nodes they are.

    Attributes
    ----------
    nodes
        (n,) int64 in the order in which they were added.
    """

    __slots__ = ("_derived", "nodes")

    def __init__(self) -> None:
        self.nodes = np.zeros(0, np.int64)
        self._derived: dict[str, Any] = {}

    def add(self, nodes: NDArray[np.int64]) -> None:
        """Add nodes that are not in it."""
        self.nodes = np.concatenate([self.nodes, nodes])
        self._derived.clear()

    def discard(self, start: int, stop: int) -> None:
        """Take out the nodes of a range."""
        self.nodes = self.nodes[(self.nodes < start) | (self.nodes >= stop)]
        self._derived.clear()

    def derived(self, name: str, make: Callable[[NDArray[np.int64]], Any]) -> Any:
        """What `make` says of the nodes, asked anew only after they changed."""
        if name not in self._derived:
            self._derived[name] = make(self.nodes)
        return self._derived[name]

    def children(self, tables: Any) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """All children, node after node, and the place in `nodes` of each one's parent."""

        def find(nodes: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
            columns = tables.nodes
            entry, owner = ranges(columns["child_start"][nodes], columns["child_count"][nodes])
            return tables.children["node"][entry], owner

        found: tuple[NDArray[np.int64], NDArray[np.int64]] = self.derived("children", find)
        return found


class Groups:
    """Groups by key; a stream that comes or goes touches only those that hold its nodes."""

    __slots__ = ("_groups", "_order")

    def __init__(self) -> None:
        self._groups: dict[Key, Group] = {}
        self._order: list[tuple[Key, Group]] | None = None

    def add(self, members: Members, base: int) -> None:
        """Add nodes by key, numbered from `base`."""
        for key, nodes in members.items():
            if key not in self._groups:
                self._groups[key] = Group()
                self._order = None
            self._groups[key].add(nodes + base)

    def discard(self, members: Members, start: int, stop: int) -> None:
        """Take out the nodes of a range from the groups of some keys."""
        for key in members:
            group = self._groups[key]
            group.discard(start, stop)
            if not len(group.nodes):
                del self._groups[key]
                self._order = None

    def in_order(self) -> list[tuple[Key, Group]]:
        """All groups, by ascending key."""
        if self._order is None:
            self._order = [(key, self._groups[key]) for key in sorted(self._groups)]
        return self._order

    def get(self, key: Key) -> Group | None:
        """The group of a key, if it has nodes."""
        return self._groups.get(key)


def members_by(first: NDArray[np.int64], second: NDArray[np.int64]) -> Members:
    """Numbers of the rows that have the same two keys."""
    order = np.lexsort((second, first))
    changes = np.diff(first[order]) | np.diff(second[order])
    parts = np.split(order, np.flatnonzero(changes) + 1)
    return {(int(first[part[0]]), int(second[part[0]])): part for part in parts}

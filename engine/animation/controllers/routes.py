"""Shortest ways through a state machine."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray


def next_hops(count: int, edges: Iterable[tuple[int, int]]) -> NDArray[np.int64]:
    """(count, count) int64: the next state on a shortest way, -1 where there is none.

    Ways are counted in transitions; among equally short ones the edge that comes first wins. With
    edges 0-1 and 1-2, the next state from 0 to 2 is 1.
    """
    into: list[list[tuple[int, int]]] = [[] for _ in range(count)]
    for rank, (source, target) in enumerate(edges):
        into[target].append((rank, source))
    out = np.full((count, count), -1, np.int64)
    rank_of = np.full((count, count), np.iinfo(np.int64).max)
    for goal in range(count):
        distance = {goal: 0}
        waiting = deque([goal])
        while waiting:
            state = waiting.popleft()
            for rank, source in into[state]:
                if source == goal:
                    continue
                if source not in distance:
                    distance[source] = distance[state] + 1
                    waiting.append(source)
                if distance[source] == distance[state] + 1 and rank < rank_of[source, goal]:
                    rank_of[source, goal] = rank
                    out[source, goal] = state
        out[goal, goal] = goal
    return out

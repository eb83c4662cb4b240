"""How the clips of trees were played in a tick, for whoever looks for their tags."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..clip_run import ClipRun
from .groups import Group
from .tables import Tables

Ints = NDArray[np.int64]


class PlayedClips(NamedTuple):
    """Clips with tags that were seen in one tick.

    Attributes
    ----------
    nodes
        (n,) rows of the plan's node table.
    stream
        (n,) their streams; several clips of a tree have the same.
    run
        How they moved. One that wasn't seen for some ticks goes on from where it stood; one that
        started anew, or was put to a phase, starts.
    """

    nodes: Ints
    stream: Ints
    run: ClipRun


def tagged_clips(tables: Tables, group: Group) -> Ints:
    """The active ones of a group of clip nodes whose clips have tags."""

    def find(nodes: Ints) -> Ints:
        found: Ints = nodes[tables.tagged[tables.nodes["clip"][nodes]]]
        return found

    nodes: Ints = group.derived("tagged", find)
    return nodes[tables.nodes["active"][nodes]] if len(nodes) else nodes


def played_clips(tables: Tables, nodes: Ints, before: NDArray[np.float64]) -> PlayedClips:
    """How active clip nodes (n,) moved since times `before` (n,), now that they have advanced."""
    columns = tables.nodes
    clip = columns["clip"][nodes]
    moved = columns["delta"][nodes] * tables.values["value"][columns["parameter"][nodes]]
    run = ClipRun(
        clip=clip,
        before=before,
        after=columns["time"][nodes],
        moved=moved,
        backwards=moved < 0,
        looping=columns["looping"][nodes],
        duration=tables.bank.duration[clip],
        starts=columns["restarted"][nodes],
    )
    return PlayedClips(nodes, columns["stream"][nodes], run)


def shares(tables: Tables, nodes: Ints) -> NDArray[np.float64]:
    """Shares (n,) of active nodes in the poses of their trees: the product of the weights above.

    What lies over a base by a mask or is added to it takes nothing away from the base.
    """
    columns = tables.nodes
    at, above = nodes.copy(), columns["depth"][nodes]
    share = np.ones(len(nodes))
    while len(below := np.flatnonzero(above > 0)):
        share[below] *= columns["weight"][at[below]]
        at[below] = columns["parent"][at[below]]
        above[below] -= 1
    return share

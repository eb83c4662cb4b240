"""Where the evaluation plan keeps all nodes of all trees: one row a node of a stream."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..clip_bank import ClipBank
from ..controllers.program import Kind, Program
from ..pose import CHANNELS
from ..skeleton import Skeleton
from .columns import Columns, ranges
from .groups import Group

LEAST_WEIGHT = 1e-6
"""A child of less weight is not evaluated and doesn't advance."""

# Kind -> (constant table that `constant` counts in, and the one that `second` counts in).
_CONSTANT = {
    Kind.MASKED: "masks",
    Kind.ADDITIVE: "references",
    Kind.SPACE_1D: "knots",
    Kind.SPACE_2D: "triangles",
    Kind.MACHINE: "transitions",
    Kind.ONE_SHOT: "shots",
}
_SECOND = {Kind.SPACE_2D: "segments", Kind.MACHINE: "hops"}

Offsets = Mapping[str, tuple[int, int]]
"""Start and size of a program's block in each constant table."""


class Tables:
    """Columns of nodes, children, parameter values and constants.

    Node columns, besides those that a program gives (`kind`, `depth`, `height`, `size`, `parent`,
    `child_start`, `child_count`, `parameter`, `clip`, `constant`, `constant_count`, `second`,
    `second_count`, `start_state`, `start_time`, `start_weight`, `looping`, and `by_state`: whether
    the node is weighed by its parent's state, not by its parameters):

    ``active``, ``weight``, ``delta``, ``rate``
        This tick: whether the node is evaluated, its share in its parent, its seconds, and how
        much faster time runs below it.
    ``time``
        Seconds: of a clip, since its start; of a machine, in its state; of a one-shot, since it
        was fired; else since the node started.
    ``ended``
        Whether a clip stands at its end, or wrapped at the last tick.
    ``state``, ``source``, ``goal``, ``fade``, ``fade_time``, ``curve``, ``rule``, ``priority``
        Of a machine: current state, the one that fades out or -1, the one to travel to or -1, and
        the running blend. A one-shot uses `state` (1 while active) and `fade` (seconds of its
        fade-out that are left; infinite before).
    ``from_weight``
        Of a machine's child: its share when the running blend began.
    ``restarted``
        The node started anew and was not evaluated since: its first tick lasts no time.
    ``row``
        Where its pose of this tick is in the mixer's block.
    ``stream``
        Row of its stream.

    Beside the columns, ``tagged`` says which clips of the bank have tags.
    """

    __slots__ = ("bank", "children", "constants", "nodes", "skeleton", "tagged", "values")

    def __init__(self, skeleton: Skeleton, bank: ClipBank) -> None:
        self.skeleton = skeleton
        self.bank = bank
        self.tagged = np.array([bool(clip.events) for clip in bank.clips])
        whole, number, flag = np.int64, np.float64, np.bool_
        self.nodes = Columns(
            kind=whole, depth=whole, height=whole, size=whole, parent=whole,
            child_start=whole, child_count=whole, parameter=whole, clip=whole,
            constant=whole, constant_count=whole, second=whole, second_count=whole,
            start_state=whole, start_time=number, start_weight=number, looping=flag,
            by_state=flag,
            active=flag, weight=number, delta=number, rate=number, time=number, ended=flag,
            state=whole, source=whole, goal=whole, fade=number, fade_time=number,
            curve=whole, rule=whole, priority=whole, from_weight=number,
            restarted=flag, row=whole, stream=whole,
        )  # fmt: skip
        self.children = Columns(node=whole)
        self.values = Columns(value=number)
        joints = skeleton.joint_count
        self.constants = {
            "masks": Columns(weights=(np.float32, (joints,))),
            "references": Columns(pose=(np.float32, (CHANNELS, joints))),
            "knots": Columns(at=number, child=whole),
            "triangles": Columns(
                corner=(whole, (3,)), origin=(number, (2,)), inverse=(number, (2, 2))
            ),
            "segments": Columns(
                end=(whole, (2,)),
                origin=(number, (2,)),
                along=(number, (2,)),
                project=(number, (2,)),
            ),
            "transitions": Columns(
                source=whole, target=whole, trigger=whole, condition=whole, operator=whole,
                threshold=number, at_end=flag, automatic=flag, duration=number, curve=whole,
                sync=flag, priority=whole, rule=whole,
            ),
            "hops": Columns(state=whole),
            "shots": Columns(fadein=number, fadeout=number),
        }  # fmt: skip

    def store_constants(self, program: Program) -> Offsets:
        """Put a program's constants into the tables: where they are."""
        return {name: self.constants[name].store(rows) for name, rows in program.constants.items()}

    def release_constants(self, offsets: Offsets) -> None:
        """Take a program's constants out of the tables."""
        for name, (start, size) in offsets.items():
            self.constants[name].release(start, size)

    def store_nodes(self, program: Program, offsets: Offsets, stream: int) -> tuple[int, int]:
        """Put a stream's nodes into the tables: its first node, and its first value."""
        columns = self.nodes
        children, _ = self.children.store({"node": program.children})
        values, _ = self.values.store({"value": program.defaults})
        base, size = columns.store(program.columns)
        block = slice(base, base + size)
        columns["parent"][block] += base
        columns["child_start"][block] += children
        columns["parameter"][block] += values
        self.children["node"][children : children + size - 1] += base
        kinds = program.columns["kind"]
        for column, tables in (("constant", _CONSTANT), ("second", _SECOND)):
            for kind, table in tables.items():
                if table in offsets:
                    columns[column][base + np.flatnonzero(kinds == kind)] += offsets[table][0]
        columns["rate"][block] = 1.0
        columns["weight"][block] = columns["start_weight"][block]
        columns["active"][block] = False
        columns["stream"][block] = stream
        self.restart(np.arange(base, base + size))
        return base, values

    def release_nodes(self, program: Program, base: int, values: int) -> None:
        """Take a stream's nodes out of the tables."""
        self.children.release(int(self.nodes["child_start"][base]), program.size - 1)
        self.values.release(values, len(program.defaults))
        self.nodes.release(base, program.size)

    def restart(self, nodes: NDArray[np.int64]) -> None:
        """Put nodes back to their beginning; their parameters stay."""
        columns = self.nodes
        columns["time"][nodes] = columns["start_time"][nodes]
        columns["state"][nodes] = columns["start_state"][nodes]
        weighed = nodes[columns["by_state"][nodes]]
        columns["weight"][weighed] = columns["start_weight"][weighed]
        columns["ended"][nodes] = False
        columns["source"][nodes] = columns["goal"][nodes] = -1
        columns["fade"][nodes] = np.inf
        columns["from_weight"][nodes] = 0.0
        columns["restarted"][nodes] = True

    def subtrees(self, nodes: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """All nodes at and below some nodes, and for each which of those it is below."""
        return ranges(nodes, self.nodes["size"][nodes])

    def value(self, group: Group) -> NDArray[np.float64]:
        """The first parameter of each node of a group."""
        out: NDArray[np.float64] = self.values["value"][self.nodes["parameter"][group.nodes]]
        return out

    def child(self, nodes: NDArray[np.int64], place: Any) -> NDArray[np.int64]:
        """A child of each node, by place."""
        out: NDArray[np.int64] = self.children["node"][self.nodes["child_start"][nodes] + place]
        return out

    def leading_clips(
        self, nodes: NDArray[np.int64]
    ) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """The clip that each node shows most of, and how fast it plays for the node's own second.

        Follows the child of the greatest weight, the first among equals, down to a leaf. -1 where
        the leaf is no clip.
        """
        columns = self.nodes
        found, speed = nodes.copy(), np.ones(len(nodes))
        while True:
            inner = np.flatnonzero(columns["child_count"][found] > 0)
            if not len(inner):
                break
            above = found[inner]
            speed[inner] *= columns["rate"][above]
            entry, owner = ranges(columns["child_start"][above], columns["child_count"][above])
            children = self.children["node"][entry]
            order = np.lexsort((-columns["weight"][children], owner))
            first = np.flatnonzero(np.diff(owner[order], prepend=-1))
            found[inner] = children[order][first]
        clips = columns["kind"][found] == Kind.CLIP
        speeds = self.values["value"][columns["parameter"][np.where(clips, found, 0)]]
        return np.where(clips, found, -1), np.where(clips, speed * speeds, 0.0)

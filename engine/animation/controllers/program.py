"""Programs: controller trees compiled against a skeleton and a clip bank.

A program is what all streams with the same controller share: the shape of the tree as arrays, the
places of its parameters, and constant tables (masks, reference poses, triangles, transitions).
Numbers of nodes and of table rows count from the program's own beginning; the evaluation plan adds
where it put them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..clip_bank import ClipBank
from ..skeleton import Skeleton
from .nodes import Controller
from .parameters import Parameter
from .tree import FlatTree, flatten


class Kind(IntEnum):
    """What a node does."""

    CLIP = 0
    BLEND_2 = 1
    BLEND_N = 2
    TIME_SCALE = 3
    MASKED = 4
    ADDITIVE = 5
    SPACE_1D = 6
    SPACE_2D = 7
    MACHINE = 8
    ONE_SHOT = 9
    CUSTOM = 10


Reading = tuple[int, str]
"""A value that can only be read: number of the node, and which one."""


@dataclass(frozen=True, slots=True, eq=False)
class Program:
    """A compiled tree of n nodes, in preorder.

    Parameters
    ----------
    controller
        What it was compiled from.
    tree
        The nodes with their paths.
    columns
        Columns of length n for the plan's node table, see `tifo.engine.animation.plan.tables`.
    children
        (n - 1,) int64 numbers of the children, parent after parent.
    parameters, defaults
        Parameters by path, and their first values, (V,) float64.
    readings
        Values to be read, by path.
    constants
        Rows for the plan's constant tables: table name to columns.
    machines
        Names of the states of each state machine, by its path.
    """

    controller: Controller
    tree: FlatTree
    columns: Mapping[str, NDArray[Any]]
    children: NDArray[np.int64]
    parameters: Mapping[str, Parameter]
    defaults: NDArray[np.float64]
    readings: Mapping[str, Reading]
    constants: Mapping[str, Mapping[str, NDArray[Any]]]
    machines: Mapping[str, tuple[str, ...]]

    @property
    def size(self) -> int:
        """Number of nodes n."""
        return len(self.tree.nodes)


def compile_controller(controller: Controller, skeleton: Skeleton, bank: ClipBank) -> Program:
    """Compile a tree.

    Raises
    ------
    ValueError
        If the tree can't be laid out (see `flatten`), or names a clip or joint that isn't there;
        the message names the node by its path.
    """
    from .build import Builder

    tree = flatten(controller)
    builder = Builder(tree, skeleton, bank)
    for number, (node, path) in enumerate(zip(tree.nodes, tree.paths, strict=True)):
        try:
            builder.add(number, node)
        except ValueError as error:
            raise ValueError(f"blend tree node '{path}': {error}") from error
    return builder.program(controller)

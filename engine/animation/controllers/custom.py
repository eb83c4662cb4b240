"""Controllers of the user's own making, in the same tree as all others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..skeleton import Skeleton
from .checks import check_controller, check_part, check_range
from .nodes import Children, Controller

FloatArray = NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False)
class StreamContext:
    """What `evaluate_stream` gets, for one stream.

    Parameters
    ----------
    skeleton
        The joint tree.
    stream
        Row of the stream in its pool.
    time, delta
        Seconds since the node started, and since it was last evaluated.
    restarted
        Whether it started anew just now, so what it remembers of the stream is void.
    parameters
        The node's parameters by name.
    inputs
        (10, J) float32 pose of each child, to be read (`tifo.engine.animation.pose`).
    out
        (10, J) float32 pose to write; holds the first child's pose, or the rest pose.
    """

    skeleton: Skeleton
    stream: int
    time: float
    delta: float
    restarted: bool
    parameters: Mapping[str, float]
    inputs: Sequence[FloatArray]
    out: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class BatchContext:
    """What `evaluate` gets: the same as `StreamContext` for K streams at once.

    Parameters
    ----------
    skeleton
        The joint tree.
    streams
        (K,) int64; a stream may occur twice if the tree holds the node twice.
    time, delta
        (K,) float64 seconds.
    restarted
        (K,) bool.
    parameters
        (K,) float64 each.
    inputs
        (K, 10, J) float32 poses of each child, to be read.
    out
        (K, 10, J) float32 poses to write.
    """

    skeleton: Skeleton
    streams: NDArray[np.int64]
    time: NDArray[np.float64]
    delta: NDArray[np.float64]
    restarted: NDArray[np.bool_]
    parameters: Mapping[str, NDArray[np.float64]]
    inputs: Sequence[FloatArray]
    out: FloatArray


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Custom(Controller):
    """A node that is evaluated by an object of the user's.

    Parameters
    ----------
    code
        Object with ``evaluate(context: BatchContext)``, called once a tick for all streams, or
        ``evaluate_stream(context: StreamContext)``, called one by one; the first goes before the
        second. It writes `context.out`; rotations need not be normalised.
    nodes
        Children whose poses it gets. All are evaluated.
    parameters
        Names of its parameters with what they begin with; any finite number may be set.
    """

    code: Any
    nodes: Sequence[Controller] = ()
    parameters: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check the values; `nodes` stays the user's own sequence and is read when it is used."""
        object.__setattr__(self, "parameters", dict(self.parameters))
        if not (self.batched or callable(getattr(self.code, "evaluate_stream", None))):
            raise ValueError(
                f"{self!r} code is {type(self.code).__name__}, "
                "expected an object with evaluate(context) or evaluate_stream(context)"
            )
        for name, value in self.parameters.items():
            check_part(self, "parameter", name)
            check_range(self, f"parameters[{name!r}]", value)
        for number, node in enumerate(self.nodes):
            check_controller(self, f"nodes[{number}]", node)

    @property
    def batched(self) -> bool:
        """Whether the code takes all streams at once."""
        return callable(getattr(self.code, "evaluate", None))

    def children(self) -> Children:
        """The children, called by their numbers."""
        return tuple((str(number), node) for number, node in enumerate(self.nodes))

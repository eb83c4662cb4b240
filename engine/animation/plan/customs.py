"""Calls of controllers that users wrote."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..controllers.custom import BatchContext, Custom, StreamContext
from ..controllers.program import Program
from ..pose import ROTATION, pack_poses
from .groups import Group
from .mixing import PoseMixer
from .tables import Tables

Array = NDArray[np.float32]


class Customs:
    """The custom nodes of all streams, with their paths for messages."""

    __slots__ = ("_nodes",)

    def __init__(self) -> None:
        self._nodes: dict[int, tuple[Custom, str]] = {}

    def add(self, program: Program, base: int) -> None:
        """Take in the custom nodes of a stream whose nodes begin at `base`."""
        for number, (node, path) in enumerate(
            zip(program.tree.nodes, program.tree.paths, strict=True)
        ):
            if isinstance(node, Custom):
                self._nodes[base + number] = (node, path)

    def discard(self, base: int, size: int) -> None:
        """Forget the nodes of a stream."""
        for number in range(base, base + size):
            self._nodes.pop(number, None)

    def evaluate(self, tables: Tables, mixer: PoseMixer, group: Group) -> None:
        """Evaluate the active nodes of a group, all places of one node at a time.

        Raises
        ------
        ValueError
            If the user's code fails, or writes values that are no pose; names the node.
        """
        active = tables.nodes["active"]
        for node, path, places in group.derived("customs", self._by_node):
            nodes = places[active[places]]
            if len(nodes):
                tables.nodes["row"][nodes] = self._call(tables, mixer, node, path, nodes)

    def _by_node(self, nodes: NDArray[np.int64]) -> list[tuple[Custom, str, NDArray[np.int64]]]:
        found: dict[int, tuple[Custom, str, list[int]]] = {}
        for number in nodes.tolist():
            node, path = self._nodes[number]
            found.setdefault(id(node), (node, path, []))[2].append(number)
        return [(node, path, np.array(places)) for node, path, places in found.values()]

    def _call(
        self,
        tables: Tables,
        mixer: PoseMixer,
        node: Custom,
        path: str,
        nodes: NDArray[np.int64],
    ) -> NDArray[np.int64]:
        columns = tables.nodes
        skeleton = tables.skeleton
        first = columns["parameter"][nodes]
        count = int(columns["child_count"][nodes[0]])
        inputs = [mixer.poses[columns["row"][tables.child(nodes, k)]] for k in range(count)]
        if inputs:
            out = inputs[0].copy()
        else:
            rest = (skeleton.rest_rotation, skeleton.rest_translation, skeleton.rest_scale)
            pose = pack_poses(rest[0][None], rest[1][None], rest[2][None])
            out = np.repeat(pose, len(nodes), axis=0)
        context = BatchContext(
            skeleton=skeleton,
            streams=columns["stream"][nodes],
            time=columns["time"][nodes],
            delta=columns["delta"][nodes],
            restarted=columns["restarted"][nodes],
            parameters={
                name: tables.values["value"][first + k] for k, name in enumerate(node.parameters)
            },
            inputs=inputs,
            out=out,
        )
        try:
            if node.batched:
                node.code.evaluate(context)
            else:
                for place in range(len(nodes)):
                    node.code.evaluate_stream(_of_one(context, place))
        except Exception as error:
            raise ValueError(
                f"blend tree node '{path}': its code raised {type(error).__name__}: {error}"
            ) from error
        lengths = np.square(out[:, ROTATION]).sum(axis=1)
        if not np.isfinite(out).all() or not (lengths > 1e-12).all():
            raise ValueError(
                f"blend tree node '{path}': its code wrote values that are not finite, "
                "or a rotation of length 0"
            )
        return mixer.put(out)


def _of_one(context: BatchContext, place: int) -> StreamContext:
    return StreamContext(
        skeleton=context.skeleton,
        stream=int(context.streams[place]),
        time=float(context.time[place]),
        delta=float(context.delta[place]),
        restarted=bool(context.restarted[place]),
        parameters={name: float(values[place]) for name, values in context.parameters.items()},
        inputs=[pose[place] for pose in context.inputs],
        out=context.out[place],
    )

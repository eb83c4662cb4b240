"""What scripts cost before they do anything: callbacks of many nodes, and signals."""

from __future__ import annotations

from time import perf_counter
from typing import Any

from ..scripting.node import Node
from ..scripting.signals import Signal
from ..scripting.tree import SceneTree
from .measure import environment, spread, time_calls

EMITS = 1000
"""How many emissions are timed together."""


class _Counter(Node):
    """A script that hardly does anything."""

    count: int = 0

    def _process(self, delta: float) -> None:
        self.count += 1

    def listen(self, team: str, score: int) -> None:
        """A handler that does nothing."""


class _Sender(Node):
    goal_scored = Signal[str, int]()


def scripting(*, nodes: int, listeners: int, runs: int) -> dict[str, Any]:
    """Time frames of a tree, the frame after a node was added, and emissions.

    Parameters
    ----------
    nodes
        Nodes with a `_process` of their own.
    listeners
        Methods that a signal with two arguments calls.
    runs
        Frames that are timed.

    Returns
    -------
    dict
        Figures with their units in their names, and the environment.
    """
    for name, value in (("nodes", nodes), ("listeners", listeners)):
        if not 1 <= value <= 1_000_000:
            raise ValueError(f"{name} is {value}, expected 1 to 1000000")
    tree = SceneTree()
    top = tree.root.add_child(Node(name="Top"))
    begin = perf_counter()
    for _ in range(nodes):
        top.add_child(_Counter())
    added = perf_counter() - begin
    frames = time_calls(lambda number: tree.advance(0.0), runs)
    changed = [_frame_after_adding(tree, top) for _ in range(min(runs, 30))]
    sender = tree.root.add_child(_Sender())
    for _ in range(listeners):
        sender.goal_scored.connect(top.add_child(_Counter()).listen)

    def emit(number: int) -> None:
        for _ in range(EMITS):
            sender.goal_scored.emit("home", number)

    emissions = spread(time_calls(emit, max(runs // 10, 1), 1))
    tree.close()
    return {
        "benchmark": "scripting",
        "nodes": nodes,
        "listeners": listeners,
        **spread(frames),
        "frame_after_adding": spread(changed),
        "add_node_us": round(1e6 * added / nodes, 3),
        "emit_us": round(1e3 * emissions["median_ms"] / EMITS, 3),
        "emits_per_second": round(1e3 * EMITS / emissions["median_ms"]),
        "environment": environment(),
    }


def _frame_after_adding(tree: SceneTree, top: Node) -> float:
    top.add_child(_Counter())
    begin = perf_counter()
    tree.advance(0.0)
    return perf_counter() - begin

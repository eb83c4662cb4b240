"""Flat lists of the nodes whose callbacks run, in tree order, and the groups of a tree.

They are made anew only after nodes were added or moved, with one walk of the tree; a frame is a
loop over a list. Removed nodes are switched off at once and leave the lists before the next round.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .node import Node

CALLBACKS = ("_process", "_physics_process", "_input", "_unhandled_input", "_step")
"""What the nodes of a list have in common, in the order of the lists."""


class Order:
    """Lists of nodes by callback.

    Attributes
    ----------
    process, physics
        In tree order, lower `process_priority` first.
    inputs, unhandled
        In reverse tree order: what lies on top is asked first.
    steps
        Nodes of this package that do something before the callbacks.
    prioritised
        Whether any node ever had a priority.
    """

    def __init__(self, root: Node) -> None:
        self._root = root
        self._changed, self._shrunk = True, False
        self.prioritised = False
        self.process: list[Node] = []
        self.physics: list[Node] = []
        self.inputs: list[Node] = []
        self.unhandled: list[Node] = []
        self.steps: list[Node] = []

    def changed(self) -> None:
        """Nodes were added or moved, or a priority changed."""
        self._changed = True

    def shrunk(self) -> None:
        """Nodes were removed; the order of the others is as it was."""
        self._shrunk = True

    def refresh(self) -> None:
        """Bring the lists up to date; the old ones stay as they are for who loops over them."""
        if self._changed:
            self._walk()
        elif self._shrunk:
            for name in ("process", "physics", "inputs", "unhandled", "steps"):
                nodes = getattr(self, name)
                setattr(self, name, [node for node in nodes if node._tree is not None])
        self._changed = self._shrunk = False

    def sorted(self, nodes: list[Node]) -> list[Node]:
        """`nodes` in tree order."""
        self.refresh()
        return sorted(nodes, key=lambda node: node._position_in_tree)

    def _walk(self) -> None:
        lists: dict[str, list[Node]] = {callback: [] for callback in CALLBACKS}
        # Ten thousand nodes are passed here whenever one is added: no calls that can be spared.
        position = 0
        stack = [*reversed(self._root._children.values())]
        while stack:
            node = stack.pop()
            position += 1
            node._position_in_tree = position
            for callback in node._overrides:
                lists[callback].append(node)
            if node._children:
                stack += reversed(node._children.values())
        self.process, self.physics, self.inputs, self.unhandled, self.steps = lists.values()
        if self.prioritised:
            for nodes in (self.process, self.physics, self.steps):
                nodes.sort(key=lambda node: node.process_priority)
        self.inputs.reverse()
        self.unhandled.reverse()


class Groups:
    """Which nodes inside the tree are in which group."""

    def __init__(self, order: Order) -> None:
        self._order = order
        self._members: dict[str, dict[Node, None]] = {}

    def join(self, node: Node, group: str) -> None:
        """Note a member."""
        self._members.setdefault(group, {})[node] = None

    def leave(self, node: Node, group: str) -> None:
        """Forget a member."""
        members = self._members.get(group, {})
        members.pop(node, None)
        if not members:
            self._members.pop(group, None)

    def nodes(self, group: str) -> list[Node]:
        """Members in tree order."""
        return self._order.sorted([*self._members.get(group, {})])

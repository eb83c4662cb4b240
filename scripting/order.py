"""Flat lists of the nodes whose callbacks run, in tree order, and the groups of a tree.

A frame is a loop over a list. Places in the order are numbers, so a few new nodes are put between
their neighbours; after more of them, or moves, one walk of the tree makes the lists anew. Removed
nodes are switched off at once and leave the lists before the next round.
"""

from __future__ import annotations

from bisect import insort
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .node import Node

Call = tuple["Node", Callable[[float], Any]]
"""A node and its bound method, looked up once and not in every frame."""

CALLBACKS = ("_process", "_physics_process", "_input", "_unhandled_input", "_step")
"""What the nodes of a list have in common, in the order of the lists."""

FEW = 32
"""How many new nodes are put between others before a walk is cheaper."""


class Order:
    """Lists of nodes by callback.

    Attributes
    ----------
    process, physics
        What is called, in tree order, lower `process_priority` first.
    resting
        Nodes of these two lists of which a flag may be off: the others needn't be asked.
    inputs, unhandled
        In reverse tree order: what lies on top is asked first.
    steps
        Nodes of this package that do something before the callbacks.
    prioritised
        Whether any node ever had a priority.
    """

    def __init__(self, root: Node) -> None:
        self._root = root
        self._changed, self._forget = True, False
        self._added: dict[Node, None] = {}
        self._gone: set[Node] = set()
        self.prioritised = False
        self.process: list[Call] = []
        self.physics: list[Call] = []
        self.resting: set[Node] = set()
        self.inputs: list[Node] = []
        self.unhandled: list[Node] = []
        self.steps: list[Node] = []

    def changed(self) -> None:
        """Nodes were moved, or a priority changed: a walk is needed."""
        self._changed = True

    def added(self, node: Node) -> None:
        """`node` entered the tree, as the last child of its parent or below one that just did."""
        if self._changed:
            return
        before, after = _previous(node), _next(node)
        if len(self._added) == FEW or self.prioritised or before._tree is not node._tree:
            self.changed()
            return
        low = before._position_in_tree
        node._position_in_tree = low + 1.0
        if after is not None:
            node._position_in_tree = 0.5 * (low + after._position_in_tree)
            if not low < node._position_in_tree < after._position_in_tree:
                self.changed()  # too often between the same two: no number is left
                return
        self._added[node] = None

    def removed(self, nodes: Iterable[Node]) -> None:
        """`nodes` left the tree; the order of the others is as it was."""
        self._gone.update(nodes)
        for node in nodes:
            self._added.pop(node, None)

    def begin(self) -> None:
        """A round of callbacks begins: bring the lists up to date, forget who left for good."""
        if self._gone:
            self._forget = True
        self.refresh()
        if self._forget:
            self.resting.difference_update([n for n in self.resting if n._tree is None])
            self._forget = False

    def refresh(self) -> None:
        """Bring the lists up to date; the old ones stay as they are for who loops over them."""
        if self._changed or (self.prioritised and self._added):
            self._walk()
        elif self._gone or self._added:
            self._change_some()
        self._changed = False
        self._forget = self._forget or bool(self._gone)
        self._gone, self._added = set(), {}

    def sorted(self, nodes: list[Node]) -> list[Node]:
        """`nodes` in tree order."""
        self.refresh()
        return sorted(nodes, key=lambda node: node._position_in_tree)

    def _change_some(self) -> None:
        gone, added = self._gone, self._added
        self.process = [call for call in self.process if call[0] not in gone]
        self.physics = [call for call in self.physics if call[0] not in gone]
        self.inputs = [node for node in self.inputs if node not in gone]
        self.unhandled = [node for node in self.unhandled if node not in gone]
        self.steps = [node for node in self.steps if node not in gone]
        for node in added:
            has = node._overrides
            if "_process" in has:
                insort(self.process, (node, node._process), key=_place_of_call)
            if "_physics_process" in has:
                insort(self.physics, (node, node._physics_process), key=_place_of_call)
            if "_input" in has:
                insort(self.inputs, node, key=_place_from_end)
            if "_unhandled_input" in has:
                insort(self.unhandled, node, key=_place_from_end)
            if "_step" in has:
                insort(self.steps, node, key=_place)

    def _walk(self) -> None:
        lists: dict[str, list[Node]] = {callback: [] for callback in CALLBACKS}
        wanted: dict[type, tuple[list[Node], ...]] = {}
        # Ten thousand nodes are passed here whenever one is added: no calls that can be spared.
        position = 0.0
        stack = [*reversed(self._root._children.values())]
        while stack:
            node = stack.pop()
            position += 1.0
            node._position_in_tree = position
            kind = type(node)
            if kind not in wanted:
                wanted[kind] = tuple(lists[name] for name in CALLBACKS if name in kind._overrides)
            for nodes in wanted[kind]:
                nodes.append(node)
            if node._children:
                stack += reversed(node._children.values())
        process, physics, self.inputs, self.unhandled, self.steps = lists.values()
        if self.prioritised:
            for nodes in (process, physics, self.steps):
                nodes.sort(key=lambda node: node.process_priority)
        self.process = [(node, node._process) for node in process]
        self.physics = [(node, node._physics_process) for node in physics]
        self.inputs.reverse()
        self.unhandled.reverse()


def _place(node: Node) -> float:
    return node._position_in_tree


def _place_from_end(node: Node) -> float:
    return -node._position_in_tree


def _place_of_call(call: Call) -> float:
    return call[0]._position_in_tree


def _previous(node: Node) -> Node:
    """The node before `node` in tree order, which is the last child of its parent so far."""
    parent = node._parent
    assert parent is not None
    above: Node | None = None
    for child in reversed(parent._children.values()):
        if child is node:
            above = parent
        elif above is not None:
            above = child
            break
    assert above is not None
    while above is not parent and above._children:
        above = next(reversed(above._children.values()))
    return above


def _next(node: Node) -> Node | None:
    """The first node in tree order behind `node` and what is below it; None at the end."""
    tree = node._tree
    child, parent = node, node._parent
    while parent is not None:
        children = parent._children
        if next(reversed(children.values())) is not child:
            found = False
            for sibling in children.values():
                if found and sibling._tree is tree and not sibling._leaving:
                    return sibling
                found = found or sibling is child
        child, parent = parent, parent._parent
    return None


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

"""Controller trees laid out flat, with a path for every node."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .machine import StateMachine
from .nodes import Controller

MAX_NODES = 16384


@dataclass(frozen=True, slots=True, eq=False)
class FlatTree:
    """The nodes of a tree in preorder: a node's subtree is a range that begins with it.

    A node object that stands in several places is listed once for each.
    """

    nodes: tuple[Controller, ...]
    paths: tuple[str, ...]
    parents: tuple[int, ...]


def flatten(root: Controller) -> FlatTree:
    """Lay out a tree of any depth.

    Raises
    ------
    ValueError
        If `root` is no controller, a node contains itself, two children of a node have the same
        name, a name holds a ``/``, or there are more than `MAX_NODES` places.
    """
    if not isinstance(root, Controller):
        raise ValueError(f"controller is {root!r}, expected a controller node")
    nodes: list[Controller] = []
    paths: list[str] = []
    parents: list[int] = []
    above: set[int] = set()
    # A number instead of a node closes the subtree of the node with that number.
    stack: list[tuple[Controller | None, str, int]] = [(root, root.name, -1)]
    while stack:
        node, path, parent = stack.pop()
        if node is None:
            above.discard(id(nodes[parent]))
            continue
        if id(node) in above:
            raise ValueError(f"blend tree node '{path}': it contains itself")
        if len(nodes) == MAX_NODES:
            raise ValueError(f"blend tree node '{path}': a tree has at most {MAX_NODES} nodes")
        if "/" in node.name:
            raise ValueError(f"blend tree node '{path}': a name can't hold '/'")
        number = len(nodes)
        nodes.append(node)
        paths.append(path)
        parents.append(parent)
        above.add(id(node))
        stack.append((None, "", number))
        names = _names(node, path)
        for name, (_, child) in zip(reversed(names), reversed(node.children()), strict=True):
            stack.append((child, f"{path}/{name}" if path else name, number))
    return FlatTree(tuple(nodes), tuple(paths), tuple(parents))


def _names(node: Controller, path: str) -> Sequence[str]:
    own = not isinstance(node, StateMachine)
    names = [(own and child.name) or place for place, child in node.children()]
    if len(set(names)) != len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"blend tree node '{path}': two of its children are called '{twice}'")
    return names

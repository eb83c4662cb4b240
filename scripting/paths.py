"""Node paths: ``"../Crowd/North"``, ``"%Unique"``, ``"/root/Main"``."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .node import Node

FORBIDDEN = '/:.@%"'
"""What a node's name can't contain, since paths use it."""


class NodePathError(KeyError):
    """There is no node at a path; names the nearest ones."""

    def __str__(self) -> str:
        """One line with all of it."""
        return str(self.args[0])


def check_name(name: str) -> str:
    """`name` if a node may have it; ValueError otherwise."""
    if not isinstance(name, str) or not name or any(sign in FORBIDDEN for sign in name):
        raise ValueError(f"name is {name!r}, expected a text without any of {FORBIDDEN}")
    return name


def find(start: Node, path: str) -> tuple[Node | None, str]:
    """The node at `path` seen from `start`, or None and why there is none."""
    if not isinstance(path, str) or not path:
        raise ValueError(f"path is {path!r}, expected a text such as '../Crowd'")
    parts = path.split("/")
    node: Node | None = start
    if path.startswith("/"):
        if not start.is_inside_tree():
            return None, f"{start.name} is not inside a tree, so absolute paths lead nowhere"
        root = start.tree.root
        if len(parts) < 2 or parts[1] != root.name:
            return None, f"absolute paths begin with /{root.name}"
        node, parts = root, parts[2:]
    for part in parts:
        assert node is not None
        at = node
        if part in ("", "."):
            continue
        if part == "..":
            node = at.parent
            reason = f"{at.path} has no parent"
        elif part.startswith("%"):
            node = _unique(at, part[1:])
            scene = at if at._uniques else at.owner or at
            reason = f"no unique '{part[1:]}' in the scene of {at.path}" + _near(
                part[1:], [*scene._uniques]
            )
        else:
            node = at._children.get(part)
            reason = f"{at.path} has no child '{part}'" + _near(part, [*at._children])
        if node is None:
            return None, reason
    return node, ""


def path_between(start: Node, end: Node) -> str:
    """Path of `end` as seen from `start`; both must be in one tree of nodes."""
    above = [start]
    while above[-1].parent is not None:
        above.append(above[-1].parent)
    names: list[str] = []
    node = end
    while node not in above:
        names.append(node.name)
        if node.parent is None:
            raise ValueError(f"{end.name} and {start.name} are in different trees of nodes")
        node = node.parent
    return "/".join([*[".."] * above.index(node), *reversed(names)]) or "."


def unique_name(wanted: str, parent: Node) -> str:
    """`wanted`, or with the first free number behind it: ``Fan``, ``Fan2``, ``Fan3``."""
    taken = parent._children
    if wanted not in taken:
        return wanted
    stem = wanted.rstrip("0123456789") or wanted
    # Numbers only go up, so that adding many children of one name stays fast.
    number = max(parent._suffixes.get(stem, 1) + 1, 2)
    while f"{stem}{number}" in taken:
        number += 1
    parent._suffixes[stem] = number
    return f"{stem}{number}"


def _unique(node: Node, name: str) -> Node | None:
    found = node._uniques.get(name)
    if found is None and node.owner is not None:
        found = node.owner._uniques.get(name)
    return found


def _near(name: str, known: list[str]) -> str:
    near = get_close_matches(name, known, n=2)
    if near:
        return f"; did you mean {' or '.join(near)}?"
    return f"; there are: {', '.join(known[:8])}" if known else "; there are none"

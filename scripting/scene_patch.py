"""Changes of a scene file for instances that exist."""

from __future__ import annotations

from typing import Any

from .lifecycle import below
from .node import Node
from .packed_scene import ConnectionEntry, NodeEntry, PackedScene, join


def patch_instance(root: Node, before: PackedScene, now: PackedScene) -> None:
    """Change an instance by what differs between two versions of its scene.

    What the file doesn't change stays as the game has made it.

    Parameters
    ----------
    root
        The instance.
    before, now
        The scene that it was made from, and the new one.
    """
    old, new = _by_path(before), _by_path(now)
    for wire in before.connections:
        if wire not in now.connections:
            _connect(root, wire, on=False)
    gone = [path for path, entry in old.items() if not _same_kind(entry, new.get(path))]
    for path in reversed(gone):
        node = root.get_node_or_none(path)
        if node is root:
            raise ValueError(f"the root of {now.path} has another type; reload the scene for that")
        if node is not None:
            node.free()
    fresh: Node | None = None
    for path, entry in new.items():
        parent = root if path == "." else root.get_node_or_none(entry.parent)
        node = root if path == "." else root.get_node_or_none(path)
        if node is None and parent is not None and (path not in old or path in gone):
            fresh = fresh or now.instantiate()
            _move(fresh, path, parent, root)
        elif node is not None and path in old:
            _set_exports(node, old[path], entry)
    if fresh is not None:
        fresh.free()
    for wire in now.connections:
        if wire not in before.connections or wire.source in gone or wire.target in gone:
            _connect(root, wire, on=True)


def _by_path(scene: PackedScene) -> dict[str, NodeEntry]:
    return {
        join(entry.parent, entry.name) if entry.parent else ".": entry for entry in scene.entries
    }


def _same_kind(one: NodeEntry, other: NodeEntry | None) -> bool:
    return other is not None and one.cls is other.cls and one.scene is other.scene


def _move(fresh: Node, path: str, parent: Node, root: Node) -> None:
    """Take a new node, with all below, out of a new instance and put it in."""
    node = fresh.get_node(path)
    owned = [one for one in (node, *below(node)) if one.owner is fresh]
    assert node.parent is not None
    node.parent.remove_child(node)
    parent.add_child(node)
    for one in owned:
        one.owner = root


def _set_exports(node: Node, before: NodeEntry, now: NodeEntry) -> None:
    for name in {*before.values, *now.values}:
        old, new = before.values.get(name), now.values.get(name)
        if name in before.values and name in now.values and bool(old == new):
            continue
        if name in now.values:
            setattr(node, name, new.copy() if isinstance(new, (list, dict)) else new)
        elif not type(node)._exports[name].is_required:
            setattr(node, name, type(node)._exports[name].default)
    for name, path in now.references.items():
        if before.references.get(name) != path:
            setattr(node, name, node.get_node(path))
    for group in {*before.groups, *now.groups}:
        if group in now.groups and group not in before.groups:
            node.add_to_group(group)
        elif group not in now.groups:
            node.remove_from_group(group)


def _connect(root: Node, wire: ConnectionEntry, *, on: bool) -> None:
    source, target = root.get_node_or_none(wire.source), root.get_node_or_none(wire.target)
    if source is None or target is None:
        return
    signal: Any = getattr(source, wire.signal)
    method = getattr(target, wire.method)
    if on and not signal.is_connected(method):
        signal.connect(
            method,
            binds=wire.binds,
            one_shot=wire.one_shot,
            deferred=wire.deferred,
            persist=True,
        )
    elif not on and signal.is_connected(method):
        signal.disconnect(method)

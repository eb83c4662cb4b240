"""Scene files out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from .export_types import WrongValueError, to_file
from .lifecycle import below
from .node import Node
from .node_types import type_name
from .packed_scene import PackedScene, load_scene
from .paths import path_between
from .resources import export_lines, file_of, load, resource_path_of
from .signals import BoundSignal, Connection
from .toml_file import literal


def save_scene(root: Node, path: str | Path) -> PackedScene:
    """Write a node and all below to a scene file, and give the scene.

    Exports that aren't at their defaults are written, groups, and connections made with `persist`.
    Nodes that are instances of other scenes are written as such, with what was changed.

    Raises
    ------
    ValueError
        If something can't be written: an export that files can't hold, an instance of a scene that
        isn't below the resource folder.
    AssetError
        If the file can't be written.
    """
    text = scene_to_toml(root)
    file = file_of(path)
    file.write_text(text, "utf-8")
    scene = load(path, fresh=True)
    assert isinstance(scene, PackedScene)
    root.scene_path = resource_path_of(file)
    return scene


def scene_to_toml(root: Node) -> str:
    """The text of the scene file of a node and all below; raises as `save_scene`."""
    nodes = [node for node in below(root) if _instance_of(node, root) is None]
    blocks = [_node_lines(root, root), *(_node_lines(node, root) for node in nodes)]
    for node in (root, *below(root)):
        for value in node.__dict__.values():
            if isinstance(value, BoundSignal):
                blocks += [
                    _connection_lines(node, connection, root)
                    for connection in value.connections
                    if connection.persist and _is_own(node, connection, root)
                ]
    return "\n\n".join("\n".join(lines) for lines in blocks) + "\n"


def _instance_of(node: Node, root: Node) -> Node | None:
    """The instance inside `root` whose file brings `node`, if one does."""
    owner = node.owner
    if owner is None or owner is root or not owner.scene_path or not root.is_ancestor_of(owner):
        return None
    return owner


def _node_lines(node: Node, root: Node) -> list[str]:
    lines = ["[[node]]", f"name = {literal(node.name)}"]
    usual: dict[str, Any] = {}
    groups = [*node.groups]
    if node is not root:
        assert node.parent is not None
        lines.append(f"parent = {literal(path_between(root, node.parent))}")
    if node is not root and node.scene_path:
        if not node.scene_path.startswith("res://"):
            raise ValueError(
                f"{node!r} is an instance of {node.scene_path!r}, expected a scene below res://"
            )
        lines.append(f"scene = {literal(node.scene_path)}")
        fresh = load_scene(node.scene_path).instantiate()
        usual = {name: getattr(fresh, name) for name in type(fresh)._exports}
        groups = [group for group in groups if not fresh.is_in_group(group)]
        fresh.free()
    else:
        lines.append(f"type = {literal(type_name(type(node)))}")
    if groups:
        lines.append(f"groups = {literal(groups)}")
    if node.unique_name_in_owner:
        lines.append("unique = true")
    references = [
        f"{name} = {literal(path_between(node, value))}"
        for name in type(node)._exports
        if isinstance(value := getattr(node, name), Node)
        and not (isinstance(usual.get(name), Node) and _is_inside(value, node))
    ]
    skipped = {
        name: value
        for name in type(node)._exports
        if isinstance(value := getattr(node, name), Node)
    }
    exports = export_lines(node, {**usual, **skipped}) + references
    return [*lines, "[node.exports]", *exports] if exports else lines


def _is_inside(value: Node, node: Node) -> bool:
    return value is node or node.is_ancestor_of(value)


def _is_own(source: Node, connection: Connection, root: Node) -> bool:
    """Whether a connection belongs to this scene, and not to one inside it."""
    target = getattr(connection.slot, "__self__", None)
    if not isinstance(target, Node) or not (target is root or root.is_ancestor_of(target)):
        return False
    inner = [
        node
        for node in (_instance_of(source, root), source if source is not root else None)
        if node is not None and node.scene_path
    ]
    return not any(target is node or target.owner is node for node in inner)


def _connection_lines(source: Node, connection: Connection, root: Node) -> list[str]:
    slot: Any = connection.slot
    lines = [
        "[[connection]]",
        f"signal = {literal(connection.signal.name)}",
        f"from = {literal(path_between(root, source))}",
        f"to = {literal(path_between(root, slot.__self__))}",
        f"method = {literal(slot.__name__)}",
    ]
    lines += [f"{name} = true" for name in ("one_shot", "deferred") if getattr(connection, name)]
    if connection.binds:
        try:
            lines.append(f"binds = {literal(to_file(list(connection.binds)))}")
        except WrongValueError as wrong:
            raise ValueError(
                f"{connection.signal!r} binds {connection.binds!r}, which a file can't hold; "
                f"it holds {wrong}"
            ) from None
    return lines

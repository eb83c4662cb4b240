"""Scenes as they are kept: a description that makes nodes, any number of times."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..engine.errors import AssetError
from .exports import Exported
from .node import Node
from .resources import load


@dataclass(frozen=True, slots=True)
class NodeEntry:
    """One node of a scene.

    Attributes
    ----------
    name, parent
        Its name, and the path of its parent from the root: ``"."``, ``"Crowd/North"``; empty for
        the root itself.
    cls, scene
        Its class, or the scene of which it is an instance.
    values
        Exports that are set.
    references
        Exports that name other nodes: their paths as seen from this one.
    groups, unique
        Groups that it joins, and whether ``%Name`` finds it.
    place
        Where in the file it stands, for messages.
    """

    name: str
    parent: str
    cls: type[Node]
    scene: PackedScene | None = None
    values: dict[str, Any] = field(default_factory=dict)
    references: dict[str, str] = field(default_factory=dict)
    groups: tuple[str, ...] = ()
    unique: bool = False
    place: str = ""


@dataclass(frozen=True, slots=True)
class ConnectionEntry:
    """One connection of a scene; paths are from its root."""

    signal: str
    source: str
    target: str
    method: str
    one_shot: bool = False
    deferred: bool = False
    binds: tuple[Any, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class PackedScene:
    """A scene file in memory.

    Attributes
    ----------
    path
        Where it was read from.
    entries
        Its nodes, the root first and parents before children.
    connections
        Its connections.
    """

    path: str
    entries: tuple[NodeEntry, ...]
    connections: tuple[ConnectionEntry, ...] = ()

    def __repr__(self) -> str:
        """For messages."""
        return f"<PackedScene {self.path}>"

    @property
    def classes(self) -> dict[str, type[Node]]:
        """Class of every node by its path from the root, instances' own nodes included."""
        found: dict[str, type[Node]] = {}
        for entry in self.entries:
            at = join(entry.parent, entry.name) if entry.parent else "."
            found[at] = entry.cls
            if entry.scene is not None:
                for path, cls in entry.scene.classes.items():
                    if path != ".":
                        found[join(at, path)] = cls
        return found

    def instantiate(self) -> Node:
        """New nodes: the root, with everything below, outside any tree.

        Raises
        ------
        AssetError
            If a class's constructor fails.
        """
        root: Node | None = None
        made: list[tuple[NodeEntry, Node]] = []
        for entry in self.entries:
            node = self._make(entry)
            node.name = entry.name
            for group in entry.groups:
                node.add_to_group(group)
            if root is None:
                root = node
            else:
                (root if entry.parent == "." else root.get_node(entry.parent)).add_child(node)
                node.owner = root
                node.unique_name_in_owner = entry.unique
            made.append((entry, node))
        assert root is not None
        for entry, node in made:
            for name, path in entry.references.items():
                setattr(node, name, node.get_node(path))
        for wire in self.connections:
            source, target = root.get_node(wire.source), root.get_node(wire.target)
            getattr(source, wire.signal).connect(
                getattr(target, wire.method),
                binds=wire.binds,
                one_shot=wire.one_shot,
                deferred=wire.deferred,
                persist=True,
            )
        root.scene_path = self.path
        return root

    def _make(self, entry: NodeEntry) -> Node:
        try:
            if entry.scene is not None:
                node = entry.scene.instantiate()
            elif entry.cls.__init__ is Exported.__init__:
                return entry.cls(**_copied(entry.values))
            else:
                node = entry.cls()
            for name, value in _copied(entry.values).items():
                setattr(node, name, value)
        except AssetError:
            raise
        except Exception as error:
            kind = type(error).__name__
            cause = f"{entry.cls.__name__} can't be made: {kind}: {error}"
            raise AssetError(self.path, entry.place, cause) from error
        return node


def load_scene(path: str | Path) -> PackedScene:
    """Read a scene file; raises as `load`, and AssetError if it holds something else."""
    scene = load(path)
    if not isinstance(scene, PackedScene):
        raise AssetError(path, "", f"holds a {type(scene).__name__}, expected a scene")
    return scene


def join(parent: str, name: str) -> str:
    """``Crowd/North`` of ``Crowd`` and ``North``, ``North`` of ``.`` and ``North``."""
    return name if parent == "." else f"{parent}/{name}"


def _copied(values: dict[str, Any]) -> dict[str, Any]:
    """Lists and tables anew for every instance."""
    return {
        name: value.copy() if isinstance(value, (list, dict)) else value
        for name, value in values.items()
    }


def scene_root(scene: Node | PackedScene | str | Path) -> Node:
    """Root node of a scene: of a packed one or a file a new instance.

    Raises
    ------
    ValueError
        If it is no scene, or a node that is in use already.
    AssetError
        If the file is none.
    """
    if isinstance(scene, (str, Path)):
        scene = load_scene(scene)
    if isinstance(scene, PackedScene):
        return scene.instantiate()
    if not isinstance(scene, Node) or scene._freed or scene.parent is not None:
        raise ValueError(f"scene is {scene!r}, expected a node without a parent, or a scene")
    return scene

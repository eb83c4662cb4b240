"""Scene files in: every mistake is found when the file is read, with its line.

.. code:: toml

    [[node]]
    name = "Match"
    type = "Node3D"

    [[node]]
    name = "Ball"
    parent = "."
    type = "res://ball.py:Ball"
    groups = ["movable"]
    unique = true
    [node.exports]
    position = [0.0, 1.0, 0.0]

    [[node]]
    name = "North"
    parent = "."
    scene = "res://stand.toml"

    [[connection]]
    signal = "goal_scored"
    from = "Ball"
    to = "North"
    method = "cheer"
"""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import Any, get_args

from ..engine.errors import AssetError
from .exports import unknown
from .node import Node
from .node_types import find_type
from .packed_scene import ConnectionEntry, NodeEntry, PackedScene, join
from .paths import check_name
from .resources import CycleError, load, read_exports, resource_path_of
from .signals import Signal
from .toml_file import TomlFile

_NODE_KEYS = ("name", "parent", "type", "scene", "groups", "unique", "exports")
_CONNECTION_KEYS = ("signal", "from", "to", "method", "one_shot", "deferred", "binds")


def read_scene(toml: TomlFile, file: Path) -> PackedScene:
    """The scene that a file describes; AssetError with line and what was expected otherwise."""
    for key in toml.document:
        if key not in ("node", "connection"):
            hint = unknown(key, ("node", "connection"))
            raise toml.error((key,), f"unknown table {hint}")
    nodes = _tables(toml, "node")
    if not nodes:
        raise toml.error((), "a scene needs at least one [[node]]")
    classes: dict[str, type[Node]] = {}
    entries: list[NodeEntry] = []
    pending: list[tuple[int, NodeEntry]] = []
    for number, table in enumerate(nodes):
        entry = _entry(toml, number, table, classes)
        at = join(entry.parent, entry.name) if entry.parent else "."
        if at in classes:
            cause = f"there are two nodes '{entry.name}' below '{entry.parent}'"
            raise toml.error(("node", number, "name"), cause)
        classes[at] = entry.cls
        if entry.scene is not None:
            inner = entry.scene.classes.items()
            classes |= {join(at, path): cls for path, cls in inner if path != "."}
        entries.append(entry)
        if entry.references:
            pending.append((number, entry))
    for number, entry in pending:
        _check_references(toml, number, entry, classes)
    connections = tuple(
        _connection(toml, number, table, classes)
        for number, table in enumerate(_tables(toml, "connection"))
    )
    return PackedScene(resource_path_of(file), tuple(entries), connections)


def node_class(kind: Any) -> type[Node] | None:
    """The class of nodes that an annotation asks for, alone or beside None."""
    for part in (kind, *get_args(kind)):
        if isinstance(part, type) and issubclass(part, Node):
            return part
    return None


def _tables(toml: TomlFile, key: str) -> list[dict[str, Any]]:
    tables = toml.document.get(key, [])
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise toml.error((key,), f"'{key}' must be written [[{key}]]")
    return tables


def _text(toml: TomlFile, keys: tuple[str | int, ...], table: dict[str, Any], default: str) -> str:
    value = table.get(str(keys[-1]), default)
    if not isinstance(value, str):
        raise toml.error(keys, f"{keys[-1]} is {value!r}, expected a text")
    return value


def _flag(toml: TomlFile, keys: tuple[str | int, ...], table: dict[str, Any]) -> bool:
    value = table.get(str(keys[-1]), False)
    if not isinstance(value, bool):
        raise toml.error(keys, f"{keys[-1]} is {value!r}, expected true or false")
    return value


def _check_keys(
    toml: TomlFile, at: tuple[str | int, ...], table: dict[str, Any], known: tuple[str, ...]
) -> None:
    for key in table:
        if key not in known:
            raise toml.error((*at, key), f"unknown key {unknown(key, known)}")


def _entry(
    toml: TomlFile, number: int, table: dict[str, Any], classes: dict[str, type[Node]]
) -> NodeEntry:
    at: tuple[str | int, ...] = ("node", number)
    _check_keys(toml, at, table, _NODE_KEYS)
    try:
        name = check_name(table.get("name", ""))
    except ValueError as error:
        raise toml.error((*at, "name"), str(error)) from None
    parent = _text(toml, (*at, "parent"), table, "")
    if bool(parent) != (number > 0):
        cause = (
            "the first node is the root and has no parent"
            if parent
            else (f"node '{name}' needs a parent: '.' for the root, or a path from there")
        )
        raise toml.error((*at, "parent"), cause)
    if parent and parent not in classes:
        known = unknown(parent, [*classes])
        raise toml.error((*at, "parent"), f"no node before this one has the path {known}")
    if ("type" in table) == ("scene" in table):
        raise toml.error(at, f"node '{name}' needs either a type or a scene")
    scene = None
    if "scene" in table:
        scene = _instance(toml, (*at, "scene"), table["scene"])
        cls = scene.entries[0].cls
    else:
        cls = find_type(toml, (*at, "type"), table["type"], Node)
    values, references = _values(toml, (*at, "exports"), table, cls)
    if scene is None:
        for export, spec in cls._exports.items():
            if spec.is_required and export not in values and export not in references:
                raise toml.error(at, f"node '{name}' needs {export}: {spec.allowed}")
    groups = table.get("groups", [])
    if not isinstance(groups, list) or not all(
        isinstance(group, str) and group for group in groups
    ):
        raise toml.error((*at, "groups"), f"groups is {groups!r}, expected a list of texts")
    unique = _flag(toml, (*at, "unique"), table)
    place = toml.place(*at)
    return NodeEntry(name, parent, cls, scene, values, references, tuple(groups), unique, place)


def _instance(toml: TomlFile, keys: tuple[str | int, ...], path: object) -> PackedScene:
    if not isinstance(path, str) or not path.startswith("res://"):
        raise toml.error(keys, f"scene is {path!r}, expected a path such as 'res://stand.toml'")
    try:
        scene = load(path)
    except CycleError as error:
        # Told once, in the file that closes the circle.
        raise (
            error
            if error.place
            else CycleError(toml.path, toml.place(*keys), f"scene '{path}' {error.cause}")
        ) from None
    except AssetError as error:
        if Path(error.path) == Path(path) and not error.place:
            raise toml.error(keys, f"scene '{path}': {error.cause}") from None
        raise
    if not isinstance(scene, PackedScene):
        raise toml.error(keys, f"scene is '{path}', which holds a {type(scene).__name__}")
    return scene


def _values(
    toml: TomlFile, keys: tuple[str | int, ...], table: dict[str, Any], cls: type[Node]
) -> tuple[dict[str, Any], dict[str, str]]:
    """Values, and the paths of those that are nodes."""
    given = table.get("exports", {})
    references: dict[str, str] = {}
    if isinstance(given, dict):
        for name, value in given.items():
            spec = cls._exports.get(name)
            if spec is not None and node_class(spec.type) is not None:
                if not isinstance(value, str) or not value or value.startswith("/"):
                    cause = f"{name} is {value!r}, expected a path from this node to another"
                    raise toml.error((*keys, name), cause)
                references[name] = value
    if references:
        # The others are read as if these weren't there.
        table["exports"] = {key: value for key, value in given.items() if key not in references}
    return read_exports(toml, keys, cls), references


def _check_references(
    toml: TomlFile, number: int, entry: NodeEntry, classes: dict[str, type[Node]]
) -> None:
    start = join(entry.parent, entry.name) if entry.parent else "."
    for name, path in entry.references.items():
        keys = ("node", number, "exports", name)
        target = _walk(start, path)
        if target is None or target not in classes:
            raise toml.error(
                keys,
                f"'{path}' leads to no node of the scene; from the root there "
                f"is no {unknown(target or path, [*classes])}",
            )
        wanted = node_class(entry.cls._exports[name].type)
        if wanted is not None and not issubclass(classes[target], wanted):
            cause = f"'{path}' is a {classes[target].__name__}, expected a {wanted.__name__}"
            raise toml.error(keys, cause)


def _walk(start: str, path: str) -> str | None:
    """A path from a node as a path from the root; None if it leaves the scene."""
    parts = [] if start == "." else start.split("/")
    for part in path.split("/"):
        if part == "..":
            if not parts:
                return None
            parts.pop()
        elif part not in ("", "."):
            parts.append(part)
    return "/".join(parts) or "."


def _connection(
    toml: TomlFile, number: int, table: dict[str, Any], classes: dict[str, type[Node]]
) -> ConnectionEntry:
    at: tuple[str | int, ...] = ("connection", number)
    _check_keys(toml, at, table, _CONNECTION_KEYS)
    texts = {key: _text(toml, (*at, key), table, "") for key in _CONNECTION_KEYS[:4]}
    for key, text in texts.items():
        if not text:
            raise toml.error(at, f"the connection has no '{key}'")
    for key in ("from", "to"):
        if texts[key] not in classes:
            raise toml.error((*at, key), f"there is no node {unknown(texts[key], [*classes])}")
    source, target = classes[texts["from"]], classes[texts["to"]]
    signals = [name for name in dir(source) if isinstance(getattr(source, name, None), Signal)]
    if texts["signal"] not in signals:
        hint = unknown(texts["signal"], signals)
        raise toml.error((*at, "signal"), f"{source.__name__} has no signal {hint}")
    method = getattr(target, texts["method"], None)
    if not inspect.isfunction(method):
        names = [name for name in dir(target) if inspect.isfunction(getattr(target, name))]
        hint = unknown(texts["method"], names)
        raise toml.error((*at, "method"), f"{target.__name__} has no method {hint}")
    binds = table.get("binds", [])
    if not isinstance(binds, list):
        raise toml.error((*at, "binds"), f"binds is {binds!r}, expected a list")
    count = len(getattr(source, texts["signal"]).types) + len(binds)
    try:
        inspect.signature(method).bind(*[None] * (count + 1))
    except TypeError as error:
        cause = f"{target.__name__}.{texts['method']} can't take {count} arguments: {error}"
        raise toml.error((*at, "method"), cause) from None
    one_shot = _flag(toml, (*at, "one_shot"), table)
    deferred = _flag(toml, (*at, "deferred"), table)
    return ConnectionEntry(
        texts["signal"],
        texts["from"],
        texts["to"],
        texts["method"],
        one_shot,
        deferred,
        tuple(binds),
    )

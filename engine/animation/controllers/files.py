"""Controllers as TOML files.

A file lists every node once under a name of its own and says which one is the root, so trees of any
depth stay flat and a node may stand in several places:

.. code:: toml

    root = "waving"

    [nodes.waving]
    type = "Masked"
    base = "sit"
    overlays = [{ node = "wave", mask = { weights = { chest = 0.5, hand_l = 1.0 } }, amount = 0.0 }]

    [nodes.sit]
    type = "ClipNode"
    clip = "sit_idle"

    [nodes.wave]
    type = "ClipNode"
    clip = "wave"

The keys are the fields of the node classes; what is left out has their defaults.
"""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import MISSING, Field, fields
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from ...errors import AssetError
from .custom import Custom
from .machine import StateMachine, Transition
from .masks import Mask, Masked, Overlay
from .nodes import Additive, Blend2, BlendN, ClipNode, Controller, OneShot, TimeScale
from .spaces import BlendSpace1D, BlendSpace2D
from .tree import flatten

_TYPES: dict[str, type[Controller]] = {
    kind.__name__: kind
    for kind in (
        *(Additive, Blend2, BlendN, BlendSpace1D, BlendSpace2D),
        *(ClipNode, Masked, OneShot, StateMachine, TimeScale),
    )
}


class _WrongError(Exception):
    """What is wrong, and where."""

    def __init__(self, place: str, cause: str) -> None:
        self.place, self.cause = place, cause


def save_controller(controller: Controller, path: str | Path) -> None:
    """Write a tree to a TOML file.

    Raises
    ------
    ValueError
        If the tree can't be laid out, or holds a `Custom` node, which is code.
    """
    Path(path).write_text(controller_to_toml(controller), "utf-8")


def controller_to_toml(controller: Controller) -> str:
    """A tree as TOML text; `load_controller` makes an equal tree of it. Raises as the above."""
    tree = flatten(controller)
    keys: dict[int, str] = {}
    first: list[Controller] = []
    for node, path in zip(tree.nodes, tree.paths, strict=True):
        if isinstance(node, Custom):
            raise ValueError(f"blend tree node '{path}': a Custom node can't be saved, it is code")
        if id(node) not in keys:
            keys[id(node)] = path or "root"
            first.append(node)
            if list(keys.values()).count(keys[id(node)]) > 1:
                keys[id(node)] = f"{path} {len(keys)}"
    lines = [f"root = {_text(keys[id(controller)])}"]
    for node in first:
        lines += ["", f"[nodes.{_text(keys[id(node)])}]", f'type = "{type(node).__name__}"']
        for field in fields(node):
            value = getattr(node, field.name)
            if value is not None and not _is_default(field, value):
                lines.append(f"{field.name} = {_text(_plain(value, keys))}")
    return "\n".join(lines) + "\n"


def load_controller(path: str | Path) -> Controller:
    """Read a tree from a TOML file.

    Raises
    ------
    AssetError
        If the file can't be read, is no TOML, or describes no tree: an unknown type or key, a
        reference to a node that isn't there, a node that contains itself, a value out of range.
    """
    try:
        text = Path(path).read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise AssetError(path, "", f"can't be read as text: {error}") from error
    return controller_from_toml(text, path)


def controller_from_toml(text: str, path: str | Path = "<text>") -> Controller:
    """The tree that TOML text describes; raises as `load_controller`, naming `path`."""
    try:
        document = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise AssetError(path, "", f"is no TOML: {error}") from error
    try:
        return _build(document)
    except _WrongError as wrong:
        raise AssetError(path, wrong.place, wrong.cause) from None


def _is_default(field: Field[Any], value: Any) -> bool:
    if field.default is not MISSING:
        return bool(value == field.default)
    return field.default_factory is not MISSING and bool(value == field.default_factory())


def _plain(value: Any, keys: dict[int, str]) -> Any:
    """A field's value as strings, numbers, lists and dicts."""
    if isinstance(value, Controller):
        return keys[id(value)]
    if isinstance(value, (Overlay, Mask, Transition)):
        return {
            field.name: _plain(getattr(value, field.name), keys)
            for field in fields(value)
            if not _is_default(field, getattr(value, field.name))
        }
    if isinstance(value, dict):
        return {name: _plain(entry, keys) for name, entry in value.items()}
    if isinstance(value, tuple):
        return [_plain(entry, keys) for entry in value]
    return value


def _text(value: Any) -> str:
    """A value as TOML, tables inline."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, list):
        return f"[{', '.join(map(_text, value))}]"
    if isinstance(value, dict):
        entries = (f"{_text(name)} = {_text(entry)}" for name, entry in value.items())
        return f"{{ {', '.join(entries)} }}"
    return repr(float(value)) if isinstance(value, float) else repr(int(value))


def _build(document: dict[str, Any]) -> Controller:
    """Make the nodes, children before their parents, without recursion."""
    tables = document.get("nodes")
    if not isinstance(tables, dict) or set(document) - {"nodes", "root"}:
        raise _WrongError("", "expected the keys 'root' and 'nodes' and no others")
    done: dict[str, Controller] = {}
    # Open nodes in the order in which they were met, each inside the one before.
    opened: dict[str, Iterator[Any]] = {}

    def open_node(key: Any, place: str) -> None:
        if not isinstance(key, str) or key not in tables:
            near = get_close_matches(str(key), tables) or list(tables)[:5]
            raise _WrongError(place, f"there is no node {key!r}; near: {', '.join(near)}")
        if key in opened:
            chain = [*opened][[*opened].index(key) :]
            raise _WrongError(f"nodes.{key}", f"it contains itself: {' > '.join((*chain, key))}")
        if not isinstance(tables[key], dict):
            raise _WrongError(f"nodes.{key}", "expected a table")
        found: list[Any] = []

        def gather(name: Any) -> Controller:
            found.append(name)
            return _NOBODY

        _make(key, tables[key], gather)
        opened[key] = iter(found)

    root = document.get("root")
    open_node(root, "root")
    while opened:
        key, rest = next(reversed(opened.items()))
        child = next((name for name in rest if not isinstance(name, str) or name not in done), None)
        if child is not None:
            open_node(child, f"nodes.{key}")
            continue
        done[key] = _make(key, tables[key], done.__getitem__)
        del opened[key]
    unused = [key for key in tables if key not in done]
    if unused:
        raise _WrongError(f"nodes.{unused[0]}", "is no part of the tree")
    return done[str(root)]


_NOBODY = ClipNode("nobody")
"""Stands for children that aren't made yet, while a node's references are gathered."""


def _make(key: str, table: dict[str, Any], child: Callable[[Any], Controller]) -> Controller:
    """The node of a table; `child` gives the node of a reference."""
    place = f"nodes.{key}"
    values = dict(table)
    name = values.pop("type", None)
    if name not in _TYPES:
        raise _WrongError(place, f"type is {name!r}, expected one of {', '.join(_TYPES)}")
    for field in ("a", "b", "node", "base", "add", "shot"):
        if field in values and name != "ClipNode":
            values[field] = child(values[field])
    try:
        if "nodes" in values:
            values["nodes"] = [child(entry) for entry in values["nodes"]]
        if "states" in values:
            values["states"] = {k: child(entry) for k, entry in values["states"].items()}
        if "points" in values:
            values["points"] = [_point(entry, child) for entry in values["points"]]
        if "overlays" in values:
            values["overlays"] = [_overlay(entry, child) for entry in values["overlays"]]
        if "transitions" in values:
            values["transitions"] = [Transition(**entry) for entry in values["transitions"]]
        return _TYPES[name](**values)
    except (TypeError, ValueError, AttributeError, KeyError) as error:
        raise _WrongError(place, _cause(error)) from None


def _point(entry: Any, child: Callable[[Any], Controller]) -> tuple[Any, Controller]:
    if not isinstance(entry, list) or len(entry) != 2:
        raise ValueError(f"a point is {entry!r}, expected [position, node]")
    return entry[0], child(entry[1])


def _overlay(entry: dict[str, Any], child: Callable[[Any], Controller]) -> Overlay:
    given = dict(entry)
    given["node"] = child(given["node"])
    given["mask"] = Mask(**given["mask"])
    return Overlay(**given)


def _cause(error: Exception) -> str:
    if isinstance(error, KeyError):
        return f"'{error.args[0]}' is missing"
    # A constructor's complaint about its arguments, without the constructor's name.
    return str(error).rpartition("__init__() ")[2]

"""What an annotation allows: checking values, describing them, and their form in files."""

from __future__ import annotations

import types
from collections.abc import Callable
from enum import Enum
from numbers import Integral, Real
from typing import Any, Literal, Union, get_args, get_origin

from .vectors import Quaternion, Vector3

_PLAIN: dict[Any, str] = {
    bool: "true or false",
    int: "a whole number",
    float: "a number",
    str: "a text",
    Vector3: "three numbers",
    Quaternion: "four numbers x, y, z, w",
    type(None): "nothing",
}


class WrongValueError(Exception):
    """A value doesn't fit; the message says what would."""


def describe(kind: Any) -> str:
    """What `kind` allows, for messages: ``a number``, ``one of CALM, ANGRY``."""
    if kind is Any:
        return "anything"
    if kind in _PLAIN:
        return _PLAIN[kind]
    origin, parts = get_origin(kind), get_args(kind)
    if origin is Literal:
        return f"one of {', '.join(map(repr, parts))}"
    if origin in (Union, types.UnionType):
        return " or ".join(describe(part) for part in parts)
    if origin is list:
        return f"a list of: {describe(parts[0])}"
    if origin is tuple:
        if len(parts) == 2 and parts[1] is Ellipsis:
            return f"a list of: {describe(parts[0])}"
        return f"[{', '.join(describe(part) for part in parts)}]"
    if origin is dict:
        return f"a table of: {describe(parts[1])}"
    if isinstance(kind, type) and issubclass(kind, Enum):
        return f"one of {', '.join(member.name for member in kind)}"
    return f"a {getattr(origin or kind, '__name__', kind)}"


def accept(kind: Any, value: Any) -> Any:
    """`value` as `kind`, numbers and vectors converted; `WrongValueError` if it doesn't fit."""
    if kind is Any:
        return value
    origin, parts = get_origin(kind), get_args(kind)
    if kind in _PLAIN:
        return _accept_plain(kind, value)
    if origin is Literal:
        if value not in parts:
            raise WrongValueError(describe(kind))
        return value
    if origin in (Union, types.UnionType):
        for part in parts:
            try:
                return accept(part, value)
            except WrongValueError:
                continue
        raise WrongValueError(describe(kind))
    if origin in (list, tuple, dict):
        return _accept_collection(kind, origin, parts, value)
    if not isinstance(value, origin or kind):
        raise WrongValueError(describe(kind))
    return value


def from_file(kind: Any, value: Any, load: Callable[[str], Any]) -> Any:
    """What a value of a TOML file stands for: names of enums, ``res://`` paths, nested ones.

    Paths of nodes stay texts; the scene replaces them when all its nodes are there.
    """
    origin, parts = get_origin(kind), get_args(kind)
    if isinstance(kind, type) and issubclass(kind, Enum):
        if isinstance(value, str) and value in kind.__members__:
            return kind[value]
        raise WrongValueError(describe(kind))
    if origin in (Union, types.UnionType):
        for part in parts:
            try:
                return accept(part, from_file(part, value, load))
            except WrongValueError:
                continue
        raise WrongValueError(describe(kind))
    if isinstance(value, list) and origin in (list, tuple) and parts:
        each = parts if origin is tuple and parts[-1] is not Ellipsis else parts[:1] * len(value)
        if len(each) != len(value):
            raise WrongValueError(describe(kind))
        made = [from_file(part, item, load) for part, item in zip(each, value, strict=True)]
        return made if origin is list else tuple(made)
    if isinstance(value, dict) and origin is dict:
        return {key: from_file(parts[1], item, load) for key, item in value.items()}
    is_object = isinstance(kind, type) and kind not in _PLAIN
    if is_object and isinstance(value, str) and value.startswith("res://"):
        return load(value)
    return value


def to_file(value: Any) -> Any:
    """The form of a value in a TOML file; `WrongValueError` if it has none."""
    if isinstance(value, Enum):
        return value.name
    if isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, (list, tuple)):
        return [to_file(item) for item in value]
    if isinstance(value, dict) and all(isinstance(key, str) for key in value):
        return {key: to_file(item) for key, item in value.items()}
    path = getattr(value, "resource_path", "")
    if path:
        return path
    raise WrongValueError("a number, text, enum, vector, list, table, or a resource with a path")


def _accept_plain(kind: Any, value: Any) -> Any:
    if kind is Vector3 or kind is Quaternion:
        try:
            return value if type(value) is kind and _finite(value) else kind.of(value)
        except ValueError:
            raise WrongValueError(describe(kind)) from None
    if kind is float and isinstance(value, Real) and not isinstance(value, bool):
        return float(value)
    if kind is int and isinstance(value, Integral) and not isinstance(value, bool):
        return int(value)
    if kind in (float, int) or not isinstance(value, kind):
        raise WrongValueError(describe(kind))
    return value


def _finite(value: tuple[float, ...]) -> bool:
    # A sum with inf or nan in it times zero is nan; much faster than four calls. The squares of a
    # rotation must besides be near one.
    total = sum(value) * 0.0
    return total == 0.0 and (len(value) == 3 or abs(sum(v * v for v in value) - 1.0) < 1e-9)


def _accept_collection(kind: Any, origin: Any, parts: tuple[Any, ...], value: Any) -> Any:
    if origin is dict:
        if not isinstance(value, dict):
            raise WrongValueError(describe(kind))
        return {accept(parts[0], key): accept(parts[1], item) for key, item in value.items()}
    if not isinstance(value, (list, tuple)):
        raise WrongValueError(describe(kind))
    repeated = origin is list or (len(parts) == 2 and parts[1] is Ellipsis)
    each = (parts[0],) * len(value) if repeated else parts
    if len(each) != len(value):
        raise WrongValueError(describe(kind))
    try:
        made = [accept(part, item) for part, item in zip(each, value, strict=True)]
    except WrongValueError:
        raise WrongValueError(describe(kind)) from None
    return made if origin is list else tuple(made)

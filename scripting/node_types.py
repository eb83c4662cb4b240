"""The classes that files name: ``Node3D``, ``game.fans.Fan``, ``res://fans.py:Fan``."""

from __future__ import annotations

import importlib
import sys
from types import ModuleType
from typing import TypeVar

from ..engine.errors import AssetError
from .exports import Exported, unknown
from .resources import load
from .toml_file import TomlFile

E = TypeVar("E", bound=Exported)


def find_type(toml: TomlFile, keys: tuple[str | int, ...], name: object, base: type[E]) -> type[E]:
    """The class that a file names at `keys`; AssetError with near names if there is none."""
    what = base.__name__.lower()
    if not isinstance(name, str) or not name:
        raise toml.error(keys, f"type is {name!r}, expected the name of a {what} type")
    if name.startswith("res://"):
        return _in_script(toml, keys, name, base)
    known = known_types(base)
    if "." not in name:
        found = known.get(name, [])
        if not found:
            raise toml.error(keys, f"there is no {what} type {unknown(name, [*known])}")
        # A game's own Ball goes before tifo's.
        found = [cls for cls in found if not _is_own(cls)] or found
        if len(found) > 1:
            paths = ", ".join(f"{one.__module__}.{one.__qualname__}" for one in found)
            raise toml.error(keys, f"type '{name}' could be any of {paths}")
        return found[0]
    module_name, _, class_name = name.rpartition(".")
    try:
        module = importlib.import_module(module_name)
    except Exception as error:
        cause = f"module '{module_name}' can't be imported: {type(error).__name__}: {error}"
        raise toml.error(keys, cause) from error
    return _member(toml, keys, module, class_name, base)


def known_types(base: type[E]) -> dict[str, list[type[E]]]:
    """All subclasses that exist by name, tifo's own included; of one defined again, the last."""
    for module in ("node3d", "timers", "nodes"):
        importlib.import_module(f"{__package__}.{module}")
    by_place: dict[tuple[str, str], type[E]] = {}
    stack = [base]
    while stack:
        cls = stack.pop()
        by_place[cls.__module__, cls.__qualname__] = cls
        stack.extend(reversed(cls.__subclasses__()))
    known: dict[str, list[type[E]]] = {}
    for cls in by_place.values():
        known.setdefault(cls.__name__, []).append(cls)
    return known


def type_name(cls: type) -> str:
    """The name of a class in files."""
    module = sys.modules.get(cls.__module__)
    path = getattr(module, "resource_path", "")
    if path:
        return f"{path}:{cls.__name__}"
    alone = len(known_types(Exported).get(cls.__name__, ())) == 1
    if _is_own(cls) and alone:
        return cls.__name__
    if cls.__module__ == "__main__" or "<locals>" in cls.__qualname__:
        return cls.__name__
    return f"{cls.__module__}.{cls.__qualname__}"


def _is_own(cls: type) -> bool:
    """Whether tifo brings the class."""
    return cls.__module__.startswith(f"{__package__}.")


def _in_script(toml: TomlFile, keys: tuple[str | int, ...], name: str, base: type[E]) -> type[E]:
    path, _, class_name = name.removeprefix("res://").partition(":")
    if not path.endswith(".py"):
        raise toml.error(keys, f"type is '{name}', expected something like 'res://fan.py:Fan'")
    try:
        module = load(f"res://{path}")
    except AssetError as error:
        raise toml.error(keys, str(error)) from error
    if class_name:
        return _member(toml, keys, module, class_name, base)
    own = [
        value
        for value in vars(module).values()
        if isinstance(value, type)
        and issubclass(value, base)
        and value.__module__ == module.__name__
    ]
    if len(own) != 1:
        names = ", ".join(cls.__name__ for cls in own) or "none"
        raise toml.error(keys, f"'{name}' has {names}; say which, as in '{name}:Fan'")
    return own[0]


def _member(
    toml: TomlFile, keys: tuple[str | int, ...], module: ModuleType, name: str, base: type[E]
) -> type[E]:
    found = getattr(module, name, None)
    if not (isinstance(found, type) and issubclass(found, base)):
        names = [
            key
            for key, value in vars(module).items()
            if isinstance(value, type) and issubclass(value, base)
        ] or [*known_types(base)]
        what = base.__name__.lower()
        raise toml.error(keys, f"{module.__name__} has no {what} type {unknown(name, names)}")
    return found

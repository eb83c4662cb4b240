"""New code for classes that exist: they stay the same objects, so that nothing is lost."""

from __future__ import annotations

from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

from ..engine.errors import AssetError
from .exports import Export, Exported
from .resources import line_in, resource_path_of
from .signals import BoundSignal, Signal

_OWN = {"__dict__", "__weakref__", "__module__", "__qualname__", "__firstlineno__"}
_NOTED = ("_exports", "_fields", "_overrides")


def reload_module(module: ModuleType, file: Path) -> tuple[type, ...]:
    """Run a script again in its module; the classes that got new code.

    Functions and classes that were there before stay the same objects with new contents. Other
    names of the module get new values.

    Raises
    ------
    AssetError
        If it can't be run; everything is as before then.
    """
    before = dict(vars(module))
    path = resource_path_of(file)
    try:
        code = compile(file.read_bytes(), str(file), "exec")
        exec(code, vars(module))
    except Exception as error:
        vars(module).clear()
        vars(module).update(before)
        line = line_in(file, error)
        kind = type(error).__name__
        raise AssetError(path, f"line {line}" if line else "", f"{kind}: {error}") from error
    patched: list[type] = []
    twins: dict[type, type] = {}
    for name, new in [*vars(module).items()]:
        old = before.get(name)
        if old is new or getattr(new, "__module__", None) != module.__name__:
            continue
        if isinstance(old, FunctionType) and isinstance(new, FunctionType):
            vars(module)[name] = _take_function(old, new)
        elif isinstance(old, type) and isinstance(new, type) and _is_same(old, new):
            twins[new] = old
    for new, old in twins.items():
        _take_class(old, new, twins)
        patched.append(old)
    for name, new in [*vars(module).items()]:
        if not isinstance(new, type) or new.__module__ != module.__name__:
            continue
        if new in twins:
            vars(module)[name] = twins[new]
        elif any(base in twins for base in new.__bases__):
            # A class that wasn't there before, made from one that was.
            new.__bases__ = tuple(twins.get(base, base) for base in new.__bases__)
            patched.append(new)
    for cls in patched:
        _note_again(cls)
    return tuple(patched)


def revalidate(thing: Exported) -> list[Exception]:
    """Bring an instance up to date with its class; what its exports had to give up."""
    wrong: list[Exception] = []
    for name, spec in type(thing)._exports.items():
        if name not in thing.__dict__:
            continue
        try:
            thing.__dict__[name] = spec.check(thing.__dict__[name])
        except ValueError as error:
            if not spec.is_required:
                del thing.__dict__[name]
            wrong.append(error)
    for name, value in [*thing.__dict__.items()]:
        declared = getattr(type(thing), name, None)
        if isinstance(value, BoundSignal) and isinstance(declared, Signal):
            value.retype(len(declared.types))
    return wrong


def _is_same(old: type, new: type) -> bool:
    """Whether `new` is what a script makes of `old` when it is run again."""
    place = (old.__module__, old.__qualname__) == (new.__module__, new.__qualname__)
    return place and issubclass(old, Exported)


def _take_class(old: type, new: type, twins: dict[type, type]) -> None:
    """Give `old` what `new` has, and nothing that it doesn't have."""
    bases = tuple(twins.get(base, base) for base in new.__bases__)
    if bases != old.__bases__:
        old.__bases__ = bases
    for name in [*old.__dict__]:
        if name not in new.__dict__ and name not in _OWN and name not in _NOTED:
            delattr(old, name)
    for name, value in [*new.__dict__.items()]:
        if name in _OWN or name in _NOTED:
            continue
        have = old.__dict__.get(name)
        if isinstance(have, FunctionType) and isinstance(value, FunctionType):
            value = _take_function(have, value)
        for function in _functions(value):
            _own_cell(function, new, old)
        if isinstance(value, Export):
            value.owner = old
        if have is not value:
            setattr(old, name, value)


def _take_function(old: FunctionType, new: FunctionType) -> FunctionType:
    """`old` with the code of `new`, so that what holds it runs the new; else `new` itself."""
    if old.__code__.co_freevars != new.__code__.co_freevars or (
        old.__closure__ and old.__code__.co_freevars != ("__class__",)
    ):
        return new
    old.__code__ = new.__code__
    old.__defaults__, old.__kwdefaults__ = new.__defaults__, new.__kwdefaults__
    old.__annotations__, old.__doc__ = new.__annotations__, new.__doc__
    old.__dict__.update(new.__dict__)
    return old


def _functions(value: Any) -> list[FunctionType]:
    parts = [value]
    if isinstance(value, (staticmethod, classmethod)):
        parts = [value.__func__]
    elif isinstance(value, property):
        parts = [value.fget, value.fset, value.fdel]
    return [part for part in parts if isinstance(part, FunctionType)]


def _own_cell(function: FunctionType, new: type, old: type) -> None:
    """Let ``super()`` of a function that was compiled for `new` work in `old`."""
    names = function.__code__.co_freevars
    if "__class__" in names and function.__closure__ is not None:
        cell = function.__closure__[names.index("__class__")]
        if cell.cell_contents is new:
            cell.cell_contents = old


def _note_again(cls: type) -> None:
    """Let a class, and those made from it, note anew what they declare."""
    for name in _NOTED:
        if name in cls.__dict__:
            delattr(cls, name)
    from .node import Node

    base: Any = Node if issubclass(cls, Node) else Exported
    base.__dict__["__init_subclass__"].__func__(cls)
    derived: list[type] = cls.__subclasses__()
    for one in derived:
        _note_again(one)

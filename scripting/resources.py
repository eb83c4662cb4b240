"""Resources: what is loaded from files below one folder, once each.

``load("res://kits/home.toml")`` gives the same object every time. TOML files hold scenes or
resources, Python files scripts, glTF and BVH files characters; `add_loader` teaches it more.
"""

from __future__ import annotations

import copy
import importlib.util
import sys
from collections.abc import Callable
from difflib import get_close_matches
from pathlib import Path, PurePosixPath
from typing import Any, Self

from ..engine.errors import AssetError
from .export_types import WrongValueError, from_file, to_file
from .exports import Exported, unknown
from .toml_file import TomlFile, literal

Loader = Callable[[str, Path], Any]


class CycleError(AssetError):
    """Files that need each other in a circle."""


class Resource(Exported):
    """Data with exports that several nodes can share.

    Attributes
    ----------
    resource_path
        Where it was loaded from; empty if it was made by code.
    """

    def __new__(cls, *args: Any, **kwargs: Any) -> Any:
        """Make an object with its state, before its `__init__`."""
        resource = super().__new__(cls)
        resource._prepare()
        return resource

    def _prepare(self) -> None:
        self.resource_path = ""

    def __repr__(self) -> str:
        """For messages."""
        return f"<{type(self).__name__} {self.resource_path or 'made by code'}>"

    def duplicate(self, *, deep: bool = False) -> Self:
        """A copy of its own, without a path; resources inside are shared unless `deep`."""
        made = copy.copy(self)
        made.__dict__.update(self.__dict__, resource_path="")
        for name in type(self)._exports:
            value = getattr(self, name)
            if isinstance(value, Resource):
                made.__dict__[name] = value.duplicate(deep=True) if deep else value
            elif isinstance(value, (list, dict)):
                made.__dict__[name] = copy.deepcopy(value) if deep else copy.copy(value)
        return made


class _Store:
    """Root folder, loaders and what was loaded."""

    def __init__(self) -> None:
        self.root: Path | None = None
        self.loaders: dict[str, Loader] = {}
        self.loaded: dict[Path, Any] = {}
        self.loading: list[tuple[Path, str]] = []


_store = _Store()


def set_resource_root(folder: str | Path) -> None:
    """Make `folder` what ``res://`` stands for, and forget what was loaded.

    Raises
    ------
    ValueError
        If there is no such folder.
    """
    root = Path(folder).resolve()
    if not root.is_dir():
        raise ValueError(f"folder is {str(folder)!r}, which is no folder")
    _store.root = root
    _store.loaded.clear()


def resource_root() -> Path:
    """The folder of ``res://``: the current one if none was set."""
    return _store.root or Path.cwd().resolve()


def add_loader(suffix: str, loader: Loader) -> None:
    """Load files that end in `suffix` by ``loader(path, file)``: its name, and the file."""
    if not suffix.startswith(".") or suffix != suffix.lower():
        raise ValueError(f"suffix is {suffix!r}, expected something like '.png'")
    _store.loaders[suffix] = loader


def file_of(path: str | Path) -> Path:
    """The file of a ``res://`` or an ordinary path. AssetError if it leads out of ``res://``."""
    text = str(path)
    if not text.startswith("res://"):
        return Path(path).resolve()
    root = resource_root()
    parts = PurePosixPath(text.removeprefix("res://")).parts
    file = root.joinpath(*parts).resolve()
    if not file.is_relative_to(root):
        raise AssetError(text, "", "leads out of the resource folder")
    return file


def resource_path_of(file: Path) -> str:
    """The ``res://`` path of a file, or its ordinary one if it lies elsewhere."""
    root = resource_root()
    if file.is_relative_to(root):
        return f"res://{file.relative_to(root).as_posix()}"
    return str(file)


def loaded_files() -> dict[Path, Any]:
    """What was loaded, by file."""
    return _store.loaded


def missing(file: Path, more: str = "") -> str:
    """That a file isn't there, and `more`, with the names beside it that are much the same."""
    names = [entry.name for entry in file.parent.iterdir()] if file.parent.is_dir() else []
    near = get_close_matches(file.name, names)
    hint = f"; did you mean {' or '.join(near)}?" if near else ""
    return f"there is no such file{more}{hint}"


def load(path: str | Path, *, fresh: bool = False) -> Any:
    """What a file holds, read once and then shared; `fresh` reads it again.

    Raises
    ------
    AssetError
        If the file can't be read, or is of no known kind.
    CycleError
        If it needs itself.
    """
    file = file_of(path)
    if file in _store.loaded and not fresh:
        return _store.loaded[file]
    name = str(path)
    around = [at for at, _ in _store.loading]
    if file in around:
        chain = [title for _, title in _store.loading[around.index(file) :]]
        raise CycleError(name, "", f"contains itself: {' > '.join((*chain, name))}")
    if not file.is_file():
        raise AssetError(name, "", missing(file))
    loader = _store.loaders.get(file.suffix.lower())
    if loader is None:
        known = ", ".join(sorted(_store.loaders))
        raise AssetError(
            name, "", f"files that end in '{file.suffix}' can't be loaded; {known} can"
        )
    _store.loading.append((file, name))
    try:
        loaded = loader(name, file)
    finally:
        _store.loading.pop()
    _store.loaded[file] = loaded
    return loaded


def save_resource(resource: Resource, path: str | Path) -> None:
    """Write a resource's exports to a TOML file, which becomes its path.

    Raises
    ------
    ValueError
        If an export holds something that files can't hold.
    """
    from .node_types import type_name

    lines = ["[resource]", f"type = {literal(type_name(type(resource)))}", "", "[exports]"]
    lines += export_lines(resource, {})
    file = file_of(path)
    file.write_text("\n".join(lines) + "\n", "utf-8")
    resource.resource_path = resource_path_of(file)
    _store.loaded[file] = resource


def export_lines(thing: Exported, usual: dict[str, Any]) -> list[str]:
    """A line ``name = value`` for each export that is not as in `usual` or its default."""
    lines = []
    for name, spec in type(thing)._exports.items():
        value = getattr(thing, name)
        if name in usual:
            is_usual = bool(usual[name] == value)
        else:
            is_usual = not spec.is_required and bool(spec.check(spec.default) == value)
        if is_usual:
            continue
        try:
            lines.append(f"{name} = {literal(to_file(value))}")
        except WrongValueError as wrong:
            raise ValueError(
                f"{spec!r} is {value!r}, which a file can't hold; it holds {wrong}"
            ) from None
    return lines


def read_exports(
    toml: TomlFile, keys: tuple[str | int, ...], cls: type[Exported]
) -> dict[str, Any]:
    """The checked values of a table of exports; AssetError with the line of what is wrong."""
    table: Any = toml.document
    for key in keys:
        table = table[key] if isinstance(key, int) else table.get(key, {})
    if not isinstance(table, dict):
        raise toml.error(keys, f"exports is {table!r}, expected a table")
    values: dict[str, Any] = {}
    for name, value in table.items():
        spec = cls._exports.get(name)
        if spec is None:
            hint = unknown(name, [*cls._exports])
            raise toml.error((*keys, name), f"{cls.__name__} has no export {hint}")
        try:
            made = from_file(spec.type, value, load)
            values[name] = spec.check(made)
            cls._check_names(name, values[name])
        except WrongValueError:
            cause = f"{cls.__name__}.{name} is {value!r}, expected {spec.allowed}"
            raise toml.error((*keys, name), cause) from None
        except (ValueError, AssetError) as error:
            if isinstance(error, CycleError):
                raise
            raise toml.error((*keys, name), str(error)) from None
    return values


def _load_toml(path: str, file: Path) -> Any:
    toml = TomlFile.read(path, file)
    if "resource" not in toml.document:
        from .scene_reading import read_scene

        return read_scene(toml, file)
    from .node_types import find_type

    extra = set(toml.document) - {"resource", "exports"}
    header = toml.document["resource"]
    if extra or not isinstance(header, dict) or set(header) != {"type"}:
        raise toml.error(("resource",), "expected [resource] with a type, and [exports]")
    cls = find_type(toml, ("resource", "type"), header["type"], Resource)
    values = read_exports(toml, ("exports",), cls)
    try:
        resource = cls(**values)
    except Exception as error:
        raise toml.error(("resource", "type"), f"{cls.__name__} can't be made: {error}") from error
    resource.resource_path = resource_path_of(file)
    return resource


def _load_script(path: str, file: Path) -> Any:
    """A Python file as a module of its own, known to pickling and annotations."""
    stem = (
        "_".join(file.relative_to(resource_root()).with_suffix("").parts)
        if (file.is_relative_to(resource_root()))
        else file.stem
    )
    name = f"tifo_scripts.{stem}"
    spec = importlib.util.spec_from_file_location(name, file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    module.__dict__["resource_path"] = resource_path_of(file)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        del sys.modules[name]
        line = line_in(file, error)
        kind = type(error).__name__
        raise AssetError(path, f"line {line}" if line else "", f"{kind}: {error}") from error
    return module


def line_in(file: Path, error: Exception) -> int:
    """The last line of `file` that an exception came through."""
    line = 0
    if isinstance(error, SyntaxError) and error.filename == str(file):
        line = error.lineno or 0
    trace = error.__traceback__
    while trace is not None:
        if trace.tb_frame.f_code.co_filename == str(file):
            line = trace.tb_lineno
        trace = trace.tb_next
    return line


def _load_character(path: str, file: Path) -> Any:
    from ..engine.assets.load import load_character

    return load_character(file)


for _suffix in (".glb", ".gltf", ".bvh"):
    add_loader(_suffix, _load_character)
add_loader(".toml", _load_toml)
add_loader(".py", _load_script)

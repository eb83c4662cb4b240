"""What a player did, tick by tick, written down and played again.

Ticks are all that counts in a game whose scripts act in `_physics_process` and in input callbacks:
the same events in the same ticks give the same game, at whatever frame rate it ran.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .exports import unknown
from .input_events import (
    InputEvent,
    InputEventAction,
    InputEventJoypadButton,
    InputEventJoypadMotion,
    InputEventKey,
    InputEventMouseButton,
    InputEventMouseMotion,
)
from .toml_file import TomlFile, literal

if TYPE_CHECKING:
    from .tree import SceneTree

_CLASSES = (
    *(InputEventAction, InputEventJoypadButton, InputEventJoypadMotion),
    *(InputEventKey, InputEventMouseButton, InputEventMouseMotion),
)
_KINDS: dict[str, type[InputEvent]] = {
    cls.__name__.removeprefix("InputEvent"): cls for cls in _CLASSES
}
_TYPES: dict[str, tuple[tuple[type, ...], str]] = {
    "str": ((str,), "a text"),
    "bool": ((bool,), "true or false"),
    "int": ((int,), "a whole number"),
    "float": ((float, int), "a number"),
    "frozenset[str]": ((list,), "a list of texts"),
}


class InputLog:
    """Events with their ticks, and which files changed in between.

    Examples
    --------
    >>> log = InputLog()
    >>> log.record(tree)  # before the game runs
    >>> log.save("goal.toml")
    >>> InputLog.load("goal.toml").play(another_tree)

    Attributes
    ----------
    events
        Tick and event, in order.
    changes
        Tick and path of scripts and other files that were taken over while the game ran. They are
        for the reader: a replay runs with the files as they are.
    ticks
        How many ticks the recorded game has run.
    """

    def __init__(self) -> None:
        self.events: list[tuple[int, InputEvent]] = []
        self.changes: list[tuple[int, str]] = []
        self._ticks = 0
        self._tree: SceneTree | None = None

    def __repr__(self) -> str:
        """For messages."""
        return f"<InputLog, {len(self.events)} events in {self.ticks} ticks>"

    @property
    def ticks(self) -> int:
        """Ticks that the game has run when it was recorded."""
        return self._ticks if self._tree is None else max(self._ticks, self._tree.tick)

    def record(self, tree: SceneTree) -> None:
        """Write down from now on what `tree` gets. ValueError if this log records already."""
        if self._tree is not None:
            raise ValueError("this log records a tree already; call stop first")
        self._tree = tree
        tree.input_taken.connect(self._note)
        tree.file_taken.connect(self._note_change)

    def stop(self) -> None:
        """Write down no more."""
        tree = self._tree
        if tree is not None:
            self._ticks, self._tree = self.ticks, None
            tree.input_taken.disconnect(self._note)
            tree.file_taken.disconnect(self._note_change)

    def play(self, tree: SceneTree) -> None:
        """Let each event take effect in `tree` in its tick, before what is pressed meanwhile.

        Raises
        ------
        ValueError
            If a tick of an event has passed in `tree`.
        """
        if self.events and self.events[0][0] <= tree.tick:
            raise ValueError(
                f"{tree!r} has passed tick {self.events[0][0]}, in which the log begins; "
                "play it in a new tree"
            )
        waiting: dict[int, list[InputEvent]] = defaultdict(list)
        for tick, event in self.events:
            waiting[tick].append(event)

        def feed() -> None:
            tree.events[:0] = waiting.pop(tree.tick, [])
            if waiting:
                tree.at_next_tick(feed)

        tree.at_next_tick(feed)

    def save(self, path: str | Path) -> None:
        """Write a TOML file."""
        lines = [f"ticks = {self.ticks}", f"changes = {literal([[*c] for c in self.changes])}"]
        for tick, event in self.events:
            lines += ["", "[[event]]", f"tick = {tick}"]
            lines.append(f"type = {literal(type(event).__name__.removeprefix('InputEvent'))}")
            lines += [f"{name} = {literal(value)}" for name, value in _values(event).items()]
        Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")

    @classmethod
    def load(cls, path: str | Path) -> InputLog:
        """Read a file that `save` wrote. AssetError with the line of what can't be used."""
        toml = TomlFile.read(path, Path(path))
        log = cls()
        for key in toml.document:
            if key not in ("ticks", "changes", "event"):
                raise toml.error((key,), unknown(key, ["ticks", "changes", "event"]))
        log._ticks = _tick(toml, ("ticks",), toml.document.get("ticks"), 0)
        changes = toml.document.get("changes", [])
        if not isinstance(changes, list) or not all(map(_is_change, changes)):
            raise toml.error(("changes",), "changes: expected a list of [tick, path]")
        log.changes = [(tick, file) for tick, file in changes]
        entries = toml.document.get("event", [])
        if not isinstance(entries, list) or not all(isinstance(one, dict) for one in entries):
            raise toml.error(("event",), "event: expected tables [[event]]")
        least = 1
        for number, entry in enumerate(entries):
            least = _tick(toml, ("event", number, "tick"), entry.get("tick"), least)
            log.events.append((least, _event(toml, number, entry)))
        return log

    def _note(self, event: InputEvent) -> None:
        assert self._tree is not None
        self.events.append((self._tree.tick, event))

    def _note_change(self, path: str) -> None:
        assert self._tree is not None
        self.changes.append((self._tree.tick, path))


def _values(event: InputEvent) -> dict[str, Any]:
    """Fields of an event that are not as they are by default."""
    values = {}
    for one in fields(event):
        value = getattr(event, one.name)
        if one.init and value != one.default:
            values[one.name] = sorted(value) if isinstance(value, frozenset) else value
    return values


def _tick(toml: TomlFile, keys: tuple[str | int, ...], value: Any, least: int) -> int:
    if not isinstance(value, int) or isinstance(value, bool) or value < least:
        raise toml.error(keys, f"{keys[-1]} is {value!r}, expected a whole number from {least} on")
    return value


def _is_change(value: Any) -> bool:
    return (
        isinstance(value, list)
        and len(value) == 2
        and isinstance(value[0], int)
        and isinstance(value[1], str)
    )


def _event(toml: TomlFile, number: int, entry: dict[str, Any]) -> InputEvent:
    kind = entry.get("type")
    if kind not in _KINDS:
        raise toml.error(("event", number, "type"), f"type is {unknown(str(kind), sorted(_KINDS))}")
    cls = _KINDS[kind]
    known = {one.name: str(one.type) for one in fields(cls) if one.init}
    values: dict[str, Any] = {}
    for name, value in entry.items():
        if name in ("tick", "type"):
            continue
        keys = ("event", number, name)
        if name not in known:
            raise toml.error(keys, f"{kind} has no {unknown(name, [*known])}")
        types, expected = _TYPES[known[name]]
        if not isinstance(value, types) or (isinstance(value, bool) and bool not in types):
            raise toml.error(keys, f"{name} is {value!r}, expected {expected}")
        values[name] = frozenset(map(str, value)) if isinstance(value, list) else value
    try:
        return cls(**values)
    except (TypeError, ValueError) as error:
        raise toml.error(("event", number), f"{kind}: {error}") from None

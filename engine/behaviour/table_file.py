"""Behaviour tables as TOML files that a designer edits.

.. code:: toml

    [states.clap]
    arms = "clap"                      # channels: posture, arms, head
    role = "applaud"                   # motions that stand in for missing clips
    pieces = [1, 1]                    # of 10 pose frames each
    variants = [
        { clips = "clap(_1)?" },       # a regular expression, or a list of names
        { clips = ["clap_2"], effort = 2.0, excitement = 0.3 },
    ]

    [[rules]]
    from = ["stand", "sit"]            # or "*"
    to = "clap"
    event = ["goal", "cue"]            # or a kind, true for any, false for none
    side = "own"                       # own, other, neutral, hit, near
    excitement = [0.2, 1.0]            # least, and below which; also embarrassment, mood, ...
    signals = { clapping_wanted = true }
    effort = 1.0                       # chance is proportional to 1 / effort
    rapid = true                       # else the piece is finished
    blend = 0.3

    [responses.goal.own]
    gain = 1.0
    seconds = 8.7
    excitement = 0.8

What a table doesn't say about responses is taken from the shipped ``responses.toml``.
"""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Iterator
from difflib import get_close_matches
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any, NoReturn

from ..crowd.motions import Role
from ..errors import AssetError
from .events import KINDS
from .table import (
    GUARDS,
    NO_LIMIT,
    POSTURES,
    RELATIONS,
    BehaviourTable,
    Response,
    Rule,
    State,
    Variant,
)
from .table_lines import Lines

TABLES = ("sport", "rock_concert", "classical_concert", "speech")
"""Tables that ship with the package."""
_AT = re.compile(r"\s*\(at (?:line (\d+), column \d+|end of document)\)")
_STATE = (
    "machine",
    "role",
    *("posture", "arms", "head"),
    "pieces",
    "limit",
    "leave_to",
    "variants",
)
_VARIANT = ("clips", "effort", "excitement")
_RULE = (
    "from",
    "to",
    "effort",
    "event",
    "side",
    "rapid",
    "blend",
    "pieces",
    "signals",
    "limits",
    *GUARDS,
)
_RESPONSE = (
    "gain",
    "seconds",
    "delay",
    "excitement",
    "embarrassment",
    "mood",
    "fatigue",
    "applause",
)


def load_table(name: str | Path) -> BehaviourTable:
    """A table that ships with the package, by its name (`TABLES`), or one in a file.

    Raises
    ------
    AssetError
        With line and cause: no TOML, unknown keys, values out of range, states that don't exist,
        that have no way out, or that no way leads to.
    """
    if name in TABLES:
        return _shipped(str(name))
    path = Path(name)
    if not path.is_file():
        raise AssetError(name, "", f"there is no such file; tables shipped: {', '.join(TABLES)}")
    try:
        text = path.read_bytes().decode("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise AssetError(name, "", f"can't be read as text: {error}") from error
    return table_from_toml(text, path)


def table_from_toml(text: str, path: str | Path = "<text>") -> BehaviourTable:
    """The table that TOML text describes; raises as `load_table`, naming `path`."""
    return _Reader(text, path).read()


@cache
def _shipped(name: str) -> BehaviourTable:
    file = files(__package__) / "tables" / f"{name}.toml"
    return table_from_toml(file.read_text("utf-8"), f"{name}.toml")


@cache
def _common_responses() -> dict[tuple[str, str], Response]:
    text = (files(__package__) / "tables" / "responses.toml").read_text("utf-8")
    return _Reader(text, "responses.toml").responses()


class _Reader:
    """One file: its values, and the lines that they stand on."""

    def __init__(self, text: str, path: str | Path) -> None:
        self.path = path
        self.lines = Lines(text)
        try:
            self.values: dict[str, Any] = tomllib.loads(text)
        except (tomllib.TOMLDecodeError, RecursionError) as error:
            match = _AT.search(str(error))
            line = int(match[1]) if match and match[1] else len(text.splitlines())
            self.fail(line, f"not valid TOML: {_AT.sub('', str(error))}")

    def read(self) -> BehaviourTable:
        self.known(self.values, ("states", "rules", "responses"), "")
        states = self.table(self.values.get("states", {}), "states")
        rules = self.values.get("rules", [])
        if not isinstance(rules, list) or not all(isinstance(rule, dict) for rule in rules):
            self.fail(self.lines.of("", key="rules"), "expected [[rules]] with a table each")
        read = [self.state(name, value) for name, value in states.items()]
        made = tuple(
            rule for index, value in enumerate(rules) for rule in self.rules(index, value, read)
        )
        table = BehaviourTable(
            name=Path(self.path).stem,
            states=tuple(read),
            rules=made,
            responses={**_common_responses(), **self.responses()},
        )
        problem = table.problem()
        if problem:
            self.fail(*problem)
        return table

    def state(self, name: str, value: Any) -> State:
        at = f"states.{name}"
        given = self.table(value, at)
        self.known(given, _STATE, at)

        def line(key: str = "") -> int:
            return self.lines.of(at, 0, key)

        for key in ("machine", "arms", "head", "leave_to"):
            if key in given and (not isinstance(given[key], str) or not given[key]):
                self.fail(line(key), f"{key} is {given[key]!r}, expected a name")
        if given.get("posture", "seated") not in POSTURES:
            self.fail(
                line("posture"), f"posture is {given['posture']!r}, expected one of {POSTURES}"
            )
        roles = {role.value: role for role in Role}
        if given.get("role") not in (*roles, None):
            self.fail(
                line("role"), f"role is {given['role']!r}, expected one of {', '.join(roles)}"
            )
        least, most = self.pieces(given, line("pieces"))
        limit = NO_LIMIT
        if "limit" in given:
            limit = int(self.number(given["limit"], line("limit"), "limit", most, 1e6))
        variants = given.get("variants", [])
        if not isinstance(variants, list):
            self.fail(line("variants"), "variants is no list")
        made = tuple(self.variant(v, line("variants"), k) for k, v in enumerate(variants, 1))
        if not made and given.get("role"):
            self.fail(line(), f"state '{name}' has a role but no variants")
        return State(
            name=name,
            machine=given.get("machine", "body"),
            role=roles.get(given.get("role", "")),
            posture=given.get("posture"),
            arms=given.get("arms"),
            head=given.get("head"),
            pieces=(least, most),
            limit=limit,
            leave_to=given.get("leave_to", ""),
            variants=made,
            line=line(),
        )

    def variant(self, value: Any, line: int, number: int) -> Variant:
        if not isinstance(value, dict) or "clips" not in value:
            self.fail(line, f"variant {number} has no clips")
        self.known(value, _VARIANT, "", line)
        clips = value["clips"]
        if isinstance(clips, list):
            clips = tuple(clips)
        is_text = isinstance(clips, str)
        if not is_text and not all(isinstance(c, str) for c in clips or [0]):
            self.fail(line, f"clips of variant {number} are neither an expression nor names")
        if is_text:
            try:
                re.compile(clips)
            except re.error as error:
                self.fail(line, f"clips of variant {number}: {clips!r} is no expression: {error}")
        return Variant(
            clips=clips,
            effort=self.number(value.get("effort", 1.0), line, "effort", 1e-6),
            excitement=self.number(value.get("excitement", 0.0), line, "excitement", 0.0, 1.0),
        )

    def rules(self, index: int, given: dict[str, Any], states: list[State]) -> Iterator[Rule]:
        def line(key: str = "") -> int:
            return self.lines.of("rules", index, key)

        self.known(given, _RULE, "rules", line(), index)
        if not isinstance(given.get("to"), str):
            self.fail(line("to"), "a rule needs 'to', the name of a state")
        origins = given.get("from")
        if origins == "*":
            machine = next((s.machine for s in states if s.name == given["to"]), "body")
            origins = [s.name for s in states if s.name != given["to"] and s.machine == machine]
        elif isinstance(origins, str):
            origins = [origins]
        if not isinstance(origins, list) or not all(isinstance(name, str) for name in origins):
            self.fail(line("from"), "a rule needs 'from': a state, a list of states or '*'")
        event, relations = given.get("event"), given.get("side", [])
        events = KINDS if event is True else self.names(event or [], line("event"), "event", KINDS)
        limits = self.table(given.get("limits", {}), "limits", line("limits"))
        numbers = {**{key: given[key] for key in GUARDS if key in given}, **limits}
        signals = self.table(given.get("signals", {}), "signals", line("signals"))
        if not all(isinstance(wanted, bool) for wanted in signals.values()):
            self.fail(line("signals"), "signals are wanted true or false")
        if not isinstance(given.get("rapid", False), bool):
            self.fail(line("rapid"), f"rapid is {given['rapid']!r}, expected true or false")
        for origin in origins:
            yield Rule(
                origin=origin,
                target=given["to"],
                effort=self.number(given.get("effort", 1.0), line("effort"), "effort", 1e-6),
                events=frozenset(events),
                relations=frozenset(self.names(relations, line("side"), "side", RELATIONS)),
                calm=event is False,
                rapid=given.get("rapid", False),
                blend=self.number(given.get("blend", 0.3), line("blend"), "blend", 0.0, 10.0),
                pieces=self.pieces(given, line("pieces")),
                limits=tuple(
                    (key, *self.pair(value, line(key), key, -math.inf, math.inf))
                    for key, value in numbers.items()
                ),
                signals=tuple(signals.items()),
                line=line(),
            )

    def responses(self) -> dict[tuple[str, str], Response]:
        found = {}
        for kind, sides in self.table(self.values.get("responses", {}), "responses").items():
            at = f"responses.{kind}"
            self.names([kind], self.lines.of(at), "event", KINDS)
            for relation, value in self.table(sides, at).items():
                place = f"{at}.{relation}"
                line = self.lines.of(place) or self.lines.of(at)
                self.names([relation], line, "side", RELATIONS)
                given = self.table(value, place)
                self.known(given, _RESPONSE, place)
                delay = self.pair(given.pop("delay", [0.15, 0.6]), line, "delay", 0.0, 60.0)
                low = {"gain": 0.0, "seconds": 0.0, "applause": -10.0}
                high = {"seconds": 3600.0, "gain": 1000.0, "applause": 10.0}
                numbers = {
                    key: self.number(
                        value,
                        self.lines.of(place, 0, key),
                        key,
                        low.get(key, -1.0),
                        high.get(key, 1.0),
                    )
                    for key, value in given.items()
                }
                found[kind, relation] = Response(delay=delay, **numbers)
        return found

    def known(
        self, given: dict[str, Any], keys: tuple[str, ...], at: str, line: int = 0, index: int = 0
    ) -> None:
        for key in given:
            if key not in keys:
                near = get_close_matches(key, keys, n=2, cutoff=0.6)
                hint = f"did you mean {' or '.join(near)}?" if near else f"known: {', '.join(keys)}"
                found = self.lines.of(at, index, key) or self.lines.of(key) or line
                self.fail(found, f"unknown key '{key}'; {hint}")

    def table(self, value: Any, name: str, line: int = 0) -> dict[str, Any]:
        if not isinstance(value, dict):
            self.fail(line or self.lines.of("", key=name), f"{name} is no table")
        return dict(value)

    def names(self, value: Any, line: int, key: str, known: tuple[str, ...]) -> list[str]:
        values = value if isinstance(value, list) else [value]
        for name in values:
            if name not in known:
                near = get_close_matches(str(name), known, n=2, cutoff=0.6)
                hint = (
                    f"did you mean {' or '.join(near)}?" if near else f"known: {', '.join(known)}"
                )
                self.fail(line, f"{key} is {name!r}; {hint}")
        return values

    def number(self, value: Any, line: int, key: str, low: float, high: float = math.inf) -> float:
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not is_number or not low <= value <= high:
            allowed = f"{low:g} to {high:g}" if math.isfinite(high) else f"{low:g} or more"
            self.fail(line, f"{key} is {value!r}, expected a number, {allowed}")
        return float(value)

    def pair(self, value: Any, line: int, key: str, low: float, high: float) -> tuple[float, float]:
        if not isinstance(value, list) or len(value) != 2:
            self.fail(line, f"{key} is {value!r}, expected [least, most]")
        least = self.number(value[0], line, key, low, high)
        most = self.number(value[1], line, key, low, high)
        if least > most:
            self.fail(line, f"{key} is {value!r}: the least is more than the most")
        return least, most

    def pieces(self, given: dict[str, Any], line: int) -> tuple[int, int]:
        least, most = self.pair(given.get("pieces", [1, 1]), line, "pieces", 1, 100_000)
        if least != int(least) or most != int(most):
            self.fail(line, "pieces are whole numbers")
        return int(least), int(most)

    def fail(self, line: int, cause: str) -> NoReturn:
        raise AssetError(self.path, f"line {line}" if line else "", cause)

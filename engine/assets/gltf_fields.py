"""A typed look at a piece of a file's JSON.

A glTF file may hold anything where an index, a number or a list belongs. Every access goes through
`Fields`, which returns what was asked for or raises one `AssetError` that names the place.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from ..errors import AssetError

FloatArray = NDArray[np.float64]

LARGEST_INTEGER = 2**53
"""The largest whole number that every JSON writer can store exactly."""


class Fields:
    """One JSON object of the file and the place where it stands.

    Parameters
    ----------
    path
        The file, for messages.
    place
        Where the object stands, such as ``"nodes[3]"``; empty for the whole file.
    values
        What the file has there.

    Raises
    ------
    AssetError
        If `values` is not a JSON object.
    """

    __slots__ = ("path", "place", "values")

    def __init__(self, path: Path, place: str, values: object) -> None:
        """Check that there is an object."""
        if not isinstance(values, dict):
            raise AssetError(path, place, f"is {_kind(values)}, expected an object")
        self.path = path
        self.place = place
        self.values = values

    def fail(self, name: str, cause: str) -> NoReturn:
        """Raise an AssetError at the field `name` of this object (empty: at the object)."""
        raise AssetError(self.path, self.at(name), cause)

    def at(self, name: str) -> str:
        """The place of the field `name`."""
        return f"{self.place}.{name}" if self.place and name else self.place or name

    def __contains__(self, name: str) -> bool:
        """Whether the file has the field `name`."""
        return name in self.values

    def integer(
        self, name: str, default: int | None = None, low: int = 0, high: int = LARGEST_INTEGER
    ) -> int:
        """Read the whole number at `name`, from `low` to `high`; required without a default.

        JSON has no integers, so 1.0 and 1e0 are as good as 1.
        """
        value = self.values.get(name, default)
        if value is None:
            self.fail(name, "is missing")
        return self._whole(name, value, low, high)

    def index(self, name: str, count: int) -> int | None:
        """Read the reference at `name` into a list of `count` things; None if it is absent."""
        if name not in self.values:
            return None
        return self._reference(name, self.values[name], count)

    def indices(self, name: str, count: int) -> list[int]:
        """Read the list of references at `name` into a list of `count` things."""
        return [
            self._reference(f"{name}[{k}]", value, count)
            for k, value in enumerate(self._list(name))
        ]

    def number(self, name: str, default: float) -> float:
        """Read the finite number at `name`."""
        return self._finite(name, self.values.get(name, default))

    def numbers(self, name: str, default: Sequence[float]) -> FloatArray:
        """Read as many finite numbers at `name` as the default has, as (n,) float64."""
        if name not in self.values:
            return np.array(default, dtype=np.float64)
        values = self._list(name)
        if len(values) != len(default):
            self.fail(name, f"has {len(values)} numbers, expected {len(default)}")
        return np.array([self._finite(name, value) for value in values], dtype=np.float64)

    def text(self, name: str, default: str = "") -> str:
        """Read the text at `name`; characters that can't be printed become question marks."""
        value = self.values.get(name, default)
        if not isinstance(value, str):
            self.fail(name, f"is {_kind(value)}, expected a text")
        return value if value.isprintable() else _printable(value)

    def texts(self, name: str) -> list[str]:
        """Read the list of texts at `name`."""
        values = self._list(name)
        if not all(isinstance(value, str) for value in values):
            self.fail(name, "has an entry that is not a text")
        return [_printable(str(value)) for value in values]

    def flag(self, name: str) -> bool:
        """Read the truth value at `name`, false if it is absent."""
        value = self.values.get(name, False)
        if not isinstance(value, bool):
            self.fail(name, f"is {_kind(value)}, expected true or false")
        return value

    def child(self, name: str) -> Fields:
        """Read the object at `name`, an empty one if it is absent."""
        return Fields(self.path, self.at(name), self.values.get(name, {}))

    def children(self, name: str) -> list[Fields]:
        """Read the list of objects at `name`, an empty one if it is absent."""
        place = self.at(name)
        return [
            Fields(self.path, f"{place}[{k}]", value) for k, value in enumerate(self._list(name))
        ]

    def _list(self, name: str) -> list[object]:
        values = self.values.get(name, [])
        if not isinstance(values, list):
            self.fail(name, f"is {_kind(values)}, expected a list")
        return values

    def _whole(self, name: str, value: object, low: int, high: int) -> int:
        if isinstance(value, float) and math.isfinite(value) and value.is_integer():
            value = int(value)
        if not isinstance(value, int) or isinstance(value, bool):
            self.fail(name, f"is {_kind(value)}, expected a whole number")
        if not low <= value <= high:
            self.fail(name, f"is {_short(value)}, expected {low} to {high}")
        return value

    def _reference(self, name: str, value: object, count: int) -> int:
        if type(value) is int and 0 <= value < count:
            return value
        index = self._whole(name, value, -LARGEST_INTEGER, LARGEST_INTEGER)
        if not 0 <= index < count:
            self.fail(name, f"refers to number {index}, but the file has {count}")
        return index

    def _finite(self, name: str, value: object) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.fail(name, f"has {_kind(value)} where a number belongs")
        if abs(value) > 1e30 or math.isnan(value):
            self.fail(name, f"has the number {_short(value)}, which is too large")
        return float(value)


def _printable(value: str) -> str:
    return "".join(character if character.isprintable() else "?" for character in value)


def _short(value: float) -> str:
    return str(value) if abs(value) < LARGEST_INTEGER else "a number beyond all bounds"


def _kind(value: object) -> str:
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true or false"
    if isinstance(value, int | float):
        return "a number that is not whole" if isinstance(value, float) else "a number"
    if isinstance(value, str):
        return "a text"
    return "a list" if isinstance(value, list) else "an object"

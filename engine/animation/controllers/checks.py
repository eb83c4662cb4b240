"""Checks of the values that controllers are made of; the messages name node, field and range."""

from __future__ import annotations

from typing import Any

LARGEST = 1e9
"""Bound of all numbers, so that none overflows on its way through a tree."""


class Label(str):
    """Text that messages show without quotes, where else a node stands."""

    __slots__ = ()

    def __repr__(self) -> str:
        """The text itself."""
        return str(self)


def check_range(
    node: Any, field: str, value: Any, low: float = -LARGEST, high: float = LARGEST
) -> None:
    """ValueError unless `value` is a number from `low` to `high`."""
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not number or not low <= value <= high:
        raise ValueError(f"{node!r} {field} is {value!r}, expected {low:g} to {high:g}")


def check_name(node: Any, field: str, value: Any) -> None:
    """ValueError unless `value` is a string with something in it."""
    if not isinstance(value, str) or not value:
        raise ValueError(f"{node!r} {field} is {value!r}, expected a name")


def check_part(node: Any, field: str, value: Any) -> None:
    """ValueError unless `value` is a name that can be part of a path."""
    check_name(node, field, value)
    if "/" in value:
        raise ValueError(f"{node!r} {field} is {value!r}; '/' separates the parts of a path")


def check_controller(node: Any, field: str, value: Any) -> None:
    """ValueError unless `value` is a controller."""
    from .nodes import Controller

    if not isinstance(value, Controller):
        raise ValueError(f"{node!r} {field} is {value!r}, expected a controller")

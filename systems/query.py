"""Queries in a defined order: esper's own follow the order of a set."""

from __future__ import annotations

from typing import Any, TypeVar, overload

import esper

A = TypeVar("A")
B = TypeVar("B")
C = TypeVar("C")


@overload
def crowds(first: type[A], /) -> list[tuple[int, tuple[A]]]: ...
@overload
def crowds(first: type[A], second: type[B], /) -> list[tuple[int, tuple[A, B]]]: ...
@overload
def crowds(
    first: type[A], second: type[B], third: type[C], /
) -> list[tuple[int, tuple[A, B, C]]]: ...
def crowds(*types: type[Any]) -> list[tuple[int, Any]]:
    """Entities that have all the components, by ascending entity id."""
    found = esper.get_components(*types)
    return sorted(((entity, tuple(parts)) for entity, parts in found), key=lambda item: item[0])

"""Blend spaces: children at points of a line or a plane, blended by where a position lies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .checks import check_controller, check_range
from .nodes import Children, Controller


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class BlendSpace1D(Controller):
    """Children along a line; a position between two blends them linearly.

    Parameter ``position`` (any finite number; beyond the ends the last child plays).

    Parameters
    ----------
    points
        (position, child) pairs in any order, no position twice; a child without a name is called
        by its number.
    position
        What ``position`` begins with.
    """

    points: Sequence[tuple[float, Controller]]
    position: float = 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        object.__setattr__(self, "points", tuple((at, node) for at, node in self.points))
        check_range(self, "position", self.position)
        _check_points(self, len(self.points))
        for number, (at, node) in enumerate(self.points):
            check_range(self, f"points[{number}]", at)
            check_controller(self, f"points[{number}]", node)
        _check_distinct(self, [(at,) for at, _ in self.points])

    def children(self) -> Children:
        """The children, called by their numbers."""
        return tuple((str(number), node) for number, (_, node) in enumerate(self.points))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class BlendSpace2D(Controller):
    """Children at points of a plane, blended by the Delaunay triangle that holds the position.

    Outside the triangles the nearest point on their hull counts; points on one line blend along
    that line. Parameter ``position`` (two finite numbers; ``position/0`` sets one).

    Parameters
    ----------
    points
        ((x, y), child) pairs, no point twice; a child without a name is called by its number.
    position
        What ``position`` begins with.
    """

    points: Sequence[tuple[tuple[float, float], Controller]]
    position: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        """Check the values."""
        points = tuple((_pair(self, at), node) for at, node in self.points)
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "position", _pair(self, self.position))
        _check_points(self, len(points))
        for number, (_, node) in enumerate(points):
            check_controller(self, f"points[{number}]", node)
        _check_distinct(self, [at for at, _ in points])

    def children(self) -> Children:
        """The children, called by their numbers."""
        return tuple((str(number), node) for number, (_, node) in enumerate(self.points))


def _pair(node: Controller, value: Sequence[float]) -> tuple[float, float]:
    if not isinstance(value, Sequence) or isinstance(value, str) or len(value) != 2:
        raise ValueError(f"{node!r} has the point {value!r}, expected two numbers")
    for number in value:
        check_range(node, f"point {value!r}", number)
    return (value[0], value[1])


def _check_points(node: Controller, count: int) -> None:
    if not count:
        raise ValueError(f"{node!r} points is empty, expected at least one")


def _check_distinct(node: Controller, places: Sequence[tuple[float, ...]]) -> None:
    if len(set(places)) != len(places):
        twice = next(place for place in places if places.count(place) > 1)
        raise ValueError(f"{node!r} has two points at {', '.join(f'{x:g}' for x in twice)}")

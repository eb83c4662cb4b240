"""Vectors and rotations of scripts: small immutable tuples, so that nothing changes unseen."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, NamedTuple


def _numbers(kind: str, values: Any, count: int) -> list[float]:
    """Finite floats; ValueError saying what was given otherwise."""
    shown = values
    try:
        if isinstance(values, str) or not isinstance(values, Iterable):
            raise TypeError
        numbers = [float(value) for value in values]
    except (TypeError, ValueError):
        numbers = []
    if len(numbers) != count or not all(map(math.isfinite, numbers)):
        raise ValueError(f"{shown!r} is no {kind}, expected {count} finite numbers")
    return numbers


class Vector3(NamedTuple):
    """A place, a direction or a scale: x, y, z."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0

    @classmethod
    def of(cls, value: Any) -> Vector3:
        """`value` as a vector: one already, or three numbers in a list, tuple or array.

        Raises
        ------
        ValueError
            If it isn't three finite numbers.
        """
        return cls(*_numbers("Vector3", value, 3))

    def __add__(self, other: Any) -> Vector3:
        """Sum, part by part."""
        x, y, z = other
        return Vector3(self.x + x, self.y + y, self.z + z)

    def __radd__(self, other: Any) -> Vector3:
        """Sum, part by part."""
        return self.__add__(other)

    def __sub__(self, other: Any) -> Vector3:
        """Difference, part by part."""
        x, y, z = other
        return Vector3(self.x - x, self.y - y, self.z - z)

    def __rsub__(self, other: Any) -> Vector3:
        """Difference, part by part."""
        x, y, z = other
        return Vector3(x - self.x, y - self.y, z - self.z)

    def __mul__(self, other: Any) -> Vector3:
        """Product with a number, or part by part with a vector."""
        if isinstance(other, tuple):
            x, y, z = other
            return Vector3(self.x * x, self.y * y, self.z * z)
        return Vector3(self.x * other, self.y * other, self.z * other)

    def __rmul__(self, other: Any) -> Vector3:
        """Product with a number."""
        return self.__mul__(other)

    def __truediv__(self, other: Any) -> Vector3:
        """Quotient by a number, or part by part by a vector."""
        if isinstance(other, tuple):
            x, y, z = other
            return Vector3(self.x / x, self.y / y, self.z / z)
        return Vector3(self.x / other, self.y / other, self.z / other)

    def __neg__(self) -> Vector3:
        """The opposite direction."""
        return Vector3(-self.x, -self.y, -self.z)

    def length(self) -> float:
        """Its length: 5 for (3, 4, 0)."""
        return math.hypot(*self)

    def normalized(self) -> Vector3:
        """The same direction with length 1; zero stays zero."""
        length = self.length()
        return self / length if length > 0.0 else self

    def dot(self, other: Vector3) -> float:
        """Scalar product."""
        return self.x * other[0] + self.y * other[1] + self.z * other[2]

    def cross(self, other: Vector3) -> Vector3:
        """Right-handed vector product: x cross y is z."""
        a, b, c = self
        x, y, z = other
        return Vector3(b * z - c * y, c * x - a * z, a * y - b * x)

    def distance_to(self, other: Vector3) -> float:
        """Length of the way to `other`."""
        return (self - other).length()

    def lerp(self, to: Vector3, weight: float) -> Vector3:
        """Straight from here (0) to `to` (1); weights beyond go on along the line."""
        return self + (Vector3.of(to) - self) * weight


class Quaternion(NamedTuple):
    """A rotation: x, y, z, w with length 1. ``a * b`` turns by b first, then by a."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    w: float = 1.0

    @classmethod
    def of(cls, value: Any) -> Quaternion:
        """`value` as a rotation: four numbers x, y, z, w, which are normalised.

        Raises
        ------
        ValueError
            If it isn't four finite numbers, or all are zero.
        """
        numbers = _numbers("Quaternion", value, 4)
        length = math.hypot(*numbers)
        if length < 1e-12:
            raise ValueError(f"{value!r} is no rotation, its length is 0")
        if abs(length - 1.0) < 1e-12:
            return cls(*numbers)
        return cls(*(number / length for number in numbers))

    @classmethod
    def from_axis_angle(cls, axis: Any, angle: float) -> Quaternion:
        """Rotation by `angle` radians about `axis`, counterclockwise when it points at you."""
        direction = Vector3.of(axis).normalized()
        if direction.length() == 0.0:
            raise ValueError(f"axis is {axis!r}, expected a direction")
        x, y, z = direction * math.sin(angle / 2.0)
        return cls(x, y, z, math.cos(angle / 2.0))

    @classmethod
    def from_euler(cls, angles: Any) -> Quaternion:
        """Rotation of three angles in radians about x, y, z: first z, then x, then y (yaw)."""
        x, y, z = Vector3.of(angles)
        yaw = cls.from_axis_angle((0.0, 1.0, 0.0), y)
        pitch = cls.from_axis_angle((1.0, 0.0, 0.0), x)
        return cls.of(yaw * pitch * cls.from_axis_angle((0.0, 0.0, 1.0), z))

    def to_euler(self) -> Vector3:
        """The angles that `from_euler` makes this rotation of, x in [-pi/2, pi/2]."""
        x, y, z, w = self
        sine = 2.0 * (w * x - y * z)
        if abs(sine) > 1.0 - 1e-9:  # looking straight up or down: z can be put into y
            angle = 2.0 * math.atan2(y, w)
            return Vector3(math.copysign(math.pi / 2.0, sine), math.remainder(angle, math.tau), 0.0)
        return Vector3(
            math.asin(sine),
            math.atan2(2.0 * (x * z + w * y), 1.0 - 2.0 * (x * x + y * y)),
            math.atan2(2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z)),
        )

    def __mul__(self, other: Any) -> Any:
        """Product with a rotation, or a turned vector."""
        a, b, c, d = self
        if len(other) == 3:
            axis = Vector3(a, b, c)
            twice = axis.cross(other) * 2.0
            return Vector3(*other) + twice * d + axis.cross(twice)
        x, y, z, w = other
        return Quaternion(
            d * x + a * w + b * z - c * y,
            d * y - a * z + b * w + c * x,
            d * z + a * y - b * x + c * w,
            d * w - a * x - b * y - c * z,
        )

    def inverse(self) -> Quaternion:
        """The rotation back."""
        return Quaternion(-self.x, -self.y, -self.z, self.w)

    def slerp(self, to: Quaternion, weight: float) -> Quaternion:
        """On the shortest way from here (0) to `to` (1), at constant speed."""
        target = Quaternion.of(to)
        cosine = sum(a * b for a, b in zip(self, target, strict=True))
        if cosine < 0.0:
            target, cosine = Quaternion(*(-value for value in target)), -cosine
        angle = math.acos(min(cosine, 1.0))
        if angle < 1e-6:
            near, far = 1.0 - weight, weight
        else:
            near = math.sin((1.0 - weight) * angle) / math.sin(angle)
            far = math.sin(weight * angle) / math.sin(angle)
        return Quaternion.of([near * a + far * b for a, b in zip(self, target, strict=True)])


ZERO = Vector3()
ONE = Vector3(1.0, 1.0, 1.0)
IDENTITY = Quaternion()

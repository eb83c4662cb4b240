"""How records lie in a buffer that feeds vertex attributes."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import DTypeLike

from .buffer import Buffer

_GL_TYPES = {
    "f4": "GL_FLOAT",
    "f2": "GL_HALF_FLOAT",
    "i1": "GL_BYTE",
    "u1": "GL_UNSIGNED_BYTE",
    "i2": "GL_SHORT",
    "u2": "GL_UNSIGNED_SHORT",
    "i4": "GL_INT",
    "u4": "GL_UNSIGNED_INT",
}


@dataclass(frozen=True, slots=True)
class Attribute:
    """How one attribute lies in a buffer's record.

    Parameters
    ----------
    name
        Of the attribute in the shader, or its location.
    components
        Numbers in it: 1 to 4, or columns times rows for a matrix, column by column.
    type
        NumPy type of one number: f4, f2, i1, u1, i2, u2, i4 or u4.
    offset
        Bytes from the start of the record.
    normalised
        Integers reach a float attribute as 0..1 (unsigned) or -1..1 (signed).
    integer
        For attributes given by location: the shader declares int or uint. Attributes given by
        name are looked up.
    """

    name: str | int
    components: int
    type: DTypeLike = np.float32
    offset: int = 0
    normalised: bool = False
    integer: bool = False


class VertexInput:
    """A buffer of equal records and what they contain.

    Parameters
    ----------
    buffer
        The records.
    layout
        A structured dtype whose fields are named like the attributes, or a list of `Attribute`.
    divisor
        0 when each vertex reads the next record, 1 when each instance does.
    stride
        Bytes from record to record; by default the dtype's size or the end of the last attribute.
    offset
        First byte of the first record.
    normalised
        Fields of a structured dtype whose integers mean 0..1 or -1..1.

    Raises
    ------
    ValueError
        For an unusable layout.
    """

    __slots__ = ("_extent", "attributes", "buffer", "divisor", "offset", "stride")

    def __init__(
        self,
        buffer: Buffer,
        layout: np.dtype[Any] | Sequence[Attribute],
        *,
        divisor: int = 0,
        stride: int | None = None,
        offset: int = 0,
        normalised: Collection[str] = (),
    ) -> None:
        if isinstance(layout, np.dtype):
            self.attributes = _from_dtype(layout, normalised)
            stride = layout.itemsize if stride is None else stride
        else:
            self.attributes = tuple(layout)
        for attribute in self.attributes:
            gl_type(attribute)
        if divisor < 0 or offset < 0:
            raise ValueError(f"divisor {divisor} and offset {offset} must be 0 or more")
        self.buffer = buffer
        self.divisor = divisor
        self.offset = offset
        self._extent = max(
            (a.offset + a.components * np.dtype(a.type).itemsize for a in self.attributes),
            default=0,
        )
        self.stride = self._extent if stride is None else stride
        if self.stride < 1:
            raise ValueError(f"stride is {self.stride} bytes, expected 1 or more")

    @property
    def records(self) -> int:
        """How many whole records the buffer holds now; the last one needs no padding."""
        return max(0, (self.buffer.nbytes - self.offset - self._extent) // self.stride + 1)


def _from_dtype(layout: np.dtype[Any], normalised: Collection[str]) -> tuple[Attribute, ...]:
    if layout.fields is None:
        raise ValueError(f"layout is {layout}, expected a structured dtype with named fields")
    unknown = set(normalised) - set(layout.fields)
    if unknown:
        raise ValueError(f"normalised names {sorted(unknown)}, but the fields are {layout.names}")
    attributes = []
    for name, entry in layout.fields.items():
        kind, offset = entry[0], entry[1]
        components = int(np.prod(kind.shape, dtype=np.int64))
        attributes.append(Attribute(name, components, kind.base, offset, name in normalised))
    return tuple(attributes)


def gl_type(attribute: Attribute) -> tuple[str, int]:
    """Return the GL constant's name and the bytes of one number."""
    kind = np.dtype(attribute.type)
    found = _GL_TYPES.get(kind.str[1:])
    if found is None or kind.byteorder == ">":
        raise ValueError(
            f"attribute '{attribute.name}' has type {kind}, expected one of {', '.join(_GL_TYPES)}"
        )
    return found, kind.itemsize

"""Which buffers feed which attributes, and drawing from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import DTypeLike

from .api import gl
from .buffer import Buffer
from .introspect import Variable
from .objects import GLObject
from .program import Program
from .vertex_input import Attribute, VertexInput, gl_type

_INDEX_TYPES = {"u1": "GL_UNSIGNED_BYTE", "u2": "GL_UNSIGNED_SHORT", "u4": "GL_UNSIGNED_INT"}


class Primitive(IntEnum):
    """What consecutive vertices make; the values are GL's."""

    POINTS = 0
    LINES = 1
    LINE_STRIP = 3
    TRIANGLES = 4
    TRIANGLE_STRIP = 5


class VertexArray(GLObject):
    """Buffers bound to the attributes of a program.

    It serves any program with the same attribute locations. Layout fields that the program does
    not read are skipped; an attribute that the program reads must be fed.

    Parameters
    ----------
    program
        Gives the locations; None when all attributes are given by location.
    inputs
        The buffers and their layouts. The vertex array keeps them alive.
    index
        Buffer of vertex numbers; without it vertices are taken in order.
    index_dtype
        uint8, uint16 or uint32.

    Raises
    ------
    ValueError
        For an attribute without data, fed twice, or of a kind that the data can't give.
    """

    __slots__ = ("_base", "_bindings", "_index", "_index_dtype", "_inputs")

    def __init__(
        self,
        program: Program | None,
        inputs: Sequence[VertexInput],
        index: Buffer | None = None,
        index_dtype: DTypeLike = np.uint32,
    ) -> None:
        kind = np.dtype(index_dtype)
        if kind.str[1:] not in _INDEX_TYPES:
            raise ValueError(f"index_dtype is {kind}, expected uint8, uint16 or uint32")
        bindings = _resolve(program, inputs)
        super().__init__("vertex array")
        self._inputs = tuple(inputs)
        self._index = index
        self._index_dtype = kind
        self._bindings = bindings
        self._base = 0
        gl.glBindVertexArray(self.name)
        for binding in bindings:
            binding.point(0)
        if index is not None:
            gl.glBindBuffer(gl.GL_ELEMENT_ARRAY_BUFFER, index.name)
        gl.glBindVertexArray(0)
        gl.glBindBuffer(gl.GL_ARRAY_BUFFER, 0)

    @property
    def index(self) -> Buffer | None:
        """The buffer of vertex numbers."""
        return self._index

    def draw(
        self, mode: Primitive | int = Primitive.TRIANGLES, count: int | None = None, first: int = 0
    ) -> None:
        """Draw once with the program in use.

        Parameters
        ----------
        mode
            What the vertices make.
        count
            Indices to draw, or vertices where there is no index buffer; by default all.
        first
            The first index or vertex.

        Raises
        ------
        ValueError
            When there are fewer indices or vertices.
        """
        self.draw_instanced(mode, count, None, first)

    def draw_instanced(
        self,
        mode: Primitive | int = Primitive.TRIANGLES,
        count: int | None = None,
        instances: int | None = 1,
        index_offset: int = 0,
        *,
        first_instance: int = 0,
    ) -> None:
        """Draw a number of instances with the program in use.

        Parameters
        ----------
        mode, count, index_offset
            As `mode`, `count` and `first` of `draw`.
        instances
            How many; 0 draws nothing.
        first_instance
            Record of the instanced buffers at which the first instance reads. Done by moving the
            attribute pointers, as GL 3.3 knows no base instance, so ``gl_InstanceID`` starts at 0.

        Raises
        ------
        ValueError
            When there are fewer indices, vertices or instances.
        """
        count = self.resolve_count(count, index_offset)
        self._check_instances(1 if instances is None else instances, first_instance)
        if count == 0 or instances == 0:
            return
        gl.glBindVertexArray(self.name)
        if first_instance != self._base:
            self._rebase(first_instance)
        if self._index is not None:
            offset = index_offset * self._index_dtype.itemsize
            kind = getattr(gl, _INDEX_TYPES[self._index_dtype.str[1:]])
            if instances is None:
                gl.glDrawElements(mode, count, kind, offset)
            else:
                gl.glDrawElementsInstanced(mode, count, kind, offset, instances)
        elif instances is None:
            gl.glDrawArrays(mode, index_offset, count)
        else:
            gl.glDrawArraysInstanced(mode, index_offset, count, instances)
        # Whoever binds an index buffer next must not change this vertex array.
        gl.glBindVertexArray(0)

    def resolve_count(self, count: int | None, first: int = 0) -> int:
        """Return `count`, or how many indices (else vertices) there are from `first` on.

        Raises
        ------
        ValueError
            When there are fewer, or no buffer tells how many there are.
        """
        if self._index is not None:
            available = self._index.nbytes // self._index_dtype.itemsize
        else:
            fed = [source.records for source in self._inputs if source.divisor == 0]
            if not fed and count is None:
                raise ValueError("count is None and no buffer tells how many vertices there are")
            available = min(fed) if fed else first + (count or 0)
        if count is None:
            count = available - first
        if first < 0 or count < 0 or first + count > available:
            raise ValueError(f"can't draw {count} from {first} on: there are {available}")
        return count

    def _check_instances(self, instances: int, first: int) -> None:
        fed = [source.records * source.divisor for source in self._inputs if source.divisor]
        available = min(fed, default=first + instances)
        if first < 0 or instances < 0 or first + instances > available:
            raise ValueError(
                f"can't draw instances {first} to {first + instances}: there are {available}"
            )

    def _rebase(self, first_instance: int) -> None:
        for binding in self._bindings:
            if binding.input.divisor:
                binding.point(first_instance)
        gl.glBindBuffer(gl.GL_ARRAY_BUFFER, 0)
        self._base = first_instance


@dataclass(frozen=True, slots=True)
class _Binding:
    """An attribute with its location: everything a pointer call needs."""

    input: VertexInput
    attribute: Attribute
    location: int
    columns: int
    integer: bool

    def point(self, first_instance: int) -> None:
        """Set the pointers of the bound vertex array."""
        source = self.input
        rows = self.attribute.components // self.columns
        kind, itemsize = gl_type(self.attribute)
        start = source.offset + self.attribute.offset
        if source.divisor:
            start += first_instance // source.divisor * source.stride
        gl.glBindBuffer(gl.GL_ARRAY_BUFFER, source.buffer.name)
        for column in range(self.columns):
            location = self.location + column
            offset = start + column * rows * itemsize
            gl.glEnableVertexAttribArray(location)
            if self.integer:
                gl.glVertexAttribIPointer(location, rows, getattr(gl, kind), source.stride, offset)
            else:
                gl.glVertexAttribPointer(
                    location,
                    rows,
                    getattr(gl, kind),
                    self.attribute.normalised,
                    source.stride,
                    offset,
                )
            gl.glVertexAttribDivisor(location, source.divisor)


def _resolve(program: Program | None, inputs: Sequence[VertexInput]) -> tuple[_Binding, ...]:
    """Match layouts with the attributes of a program."""
    wanted = {} if program is None else dict(program.attributes)
    by_location = {variable.location: variable for variable in wanted.values()}
    taken: dict[int, str | int] = {}
    bindings = []
    for source in inputs:
        for attribute in source.attributes:
            if isinstance(attribute.name, int):
                variable = by_location.get(attribute.name)
                location = attribute.name
            else:
                if program is None:
                    raise ValueError(
                        f"attribute '{attribute.name}' is given by name, which needs a program"
                    )
                variable = wanted.get(attribute.name)
                if variable is None:
                    continue
                location = variable.location
            if location in taken:
                raise ValueError(f"attribute '{attribute.name}' is fed twice")
            taken[location] = attribute.name
            bindings.append(_bind(source, attribute, location, variable))
    for variable in wanted.values():
        if variable.location not in taken:
            label = program.label if program else ""
            raise ValueError(f"attribute '{variable.name}' of {label} is fed by no buffer")
    return tuple(bindings)


def _bind(
    source: VertexInput, attribute: Attribute, location: int, variable: Variable | None
) -> _Binding:
    columns, integer, limit = 1, attribute.integer, 4
    if variable is not None:
        columns, integer = variable.type.columns, variable.type.base in ("int", "uint")
        limit = columns * (variable.type.rows if columns > 1 else 4)
    fits = attribute.components == limit if columns > 1 else 1 <= attribute.components <= limit
    if not fits:
        raise ValueError(
            f"attribute '{attribute.name}' has {attribute.components} components, "
            f"the shader takes {limit if columns > 1 else '1 to 4'}"
        )
    if integer and np.dtype(attribute.type).kind == "f":
        raise ValueError(f"attribute '{attribute.name}' is an integer and its data are floats")
    return _Binding(source, attribute, location, columns, integer)

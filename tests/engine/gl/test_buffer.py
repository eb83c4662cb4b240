from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from pyglet import gl as pgl

from tifo.engine.gl import Buffer

pytestmark = pytest.mark.gl


def test_contents_come_back() -> None:
    data = np.arange(12, dtype=np.float32).reshape(3, 4)
    buffer = Buffer(data)
    assert buffer.nbytes == 48
    assert_array_equal(buffer.read(np.float32), data.ravel())
    assert_array_equal(buffer.read(np.float32, 2, 8), [2, 3])


def test_structured_records_come_back() -> None:
    kind = np.dtype([("position", "f4", 3), ("id", "u4")])
    data = np.array([((1, 2, 3), 4), ((5, 6, 7), 8)], kind)
    assert_array_equal(Buffer(data).read(kind), data)


def test_arrays_are_copied_in_c_order() -> None:
    data = np.arange(6, dtype=np.int32).reshape(2, 3)
    assert_array_equal(Buffer(data.T).read(np.int32), [0, 3, 1, 4, 2, 5])
    buffer = Buffer(24)
    buffer.write(data[:, ::2])
    assert_array_equal(buffer.read(np.int32, 4), [0, 2, 3, 5])


def test_write_replaces_only_its_range() -> None:
    buffer = Buffer(np.zeros(4, np.uint8), "dynamic")
    buffer.write(np.array([7, 8], np.uint8), 1)
    assert_array_equal(buffer.read(), [0, 7, 8, 0])
    buffer.write(np.array([1, 2, 3, 4], np.uint8), orphan=True)
    assert_array_equal(buffer.read(), [1, 2, 3, 4])


def test_replace_changes_the_size_and_keeps_the_name() -> None:
    buffer = Buffer(4)
    name = buffer.name
    buffer.replace(np.arange(100, dtype=np.uint8))
    assert (buffer.name, buffer.nbytes) == (name, 100)
    buffer.replace(8)
    assert len(buffer.read()) == 8


@pytest.mark.parametrize(("size", "offset"), [(5, 0), (1, 4), (1, -1)])
def test_writing_outside_is_refused_and_changes_nothing(size: int, offset: int) -> None:
    buffer = Buffer(np.arange(4, dtype=np.uint8))
    with pytest.raises(ValueError, match="buffer holds 4"):
        buffer.write(np.full(size, 9, np.uint8), offset)
    assert_array_equal(buffer.read(), [0, 1, 2, 3])


def test_reading_outside_is_refused() -> None:
    for count, offset in ((5, 0), (1, 4), (1, -1), (-1, 0)):
        with pytest.raises(ValueError, match="buffer of 4 bytes"):
            Buffer(4).read(np.uint8, count, offset)


def test_empty_buffers_and_writes() -> None:
    buffer = Buffer(np.empty((0, 4), np.float32))
    buffer.write(np.empty(0, np.float32))
    assert buffer.nbytes == 0
    assert len(buffer.read()) == 0


def test_wrong_arguments() -> None:
    with pytest.raises(ValueError, match="usage is 'often'"):
        Buffer(4, "often")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="data is -1 bytes"):
        Buffer(-1)


def test_transfers_leave_the_index_buffer_of_a_vertex_array_alone() -> None:
    index = Buffer(np.arange(3, dtype=np.uint32))
    array = pgl.GLuint()
    pgl.glGenVertexArrays(1, array)
    pgl.glBindVertexArray(array)
    pgl.glBindBuffer(pgl.GL_ELEMENT_ARRAY_BUFFER, index.name)
    Buffer(np.arange(3, dtype=np.uint32)).read()
    bound = pgl.GLint()
    pgl.glGetIntegerv(pgl.GL_ELEMENT_ARRAY_BUFFER_BINDING, bound)
    pgl.glDeleteVertexArrays(1, array)
    assert bound.value == index.name

"""Keeping what a vertex shader computes, by transform feedback; nothing is drawn.

`capture_into` leaves it in a buffer for a later pass. `capture` reads it back: tests compare
skinned vertices with NumPy through it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .api import gl
from .buffer import Buffer
from .introspect import Variable
from .program import Program
from .vertex_array import Primitive, VertexArray


def capture(
    program: Program, vertex_array: VertexArray, count: int | None = None, instances: int = 1
) -> NDArray[Any]:
    """Run the vertex shader and return its captured outputs.

    Parameters
    ----------
    program
        Made with ``feedback=(names...)``, its uniforms and textures set.
    vertex_array
        Feeds it.
    count
        Vertices an instance (indices where there is an index buffer); by default all.
    instances
        How many instances.

    Returns
    -------
    (instances, count) structured array
        One field for each name of ``feedback``: float32, int32 or uint32, with a shape for
        vectors and for arrays. A matrix is (columns, rows), as GL stores it.

    Raises
    ------
    ValueError
        When the program captures nothing, or for a count that the buffers don't hold.
    """
    count = vertex_array.resolve_count(count)
    results = Buffer(0, "stream")
    dtype = capture_into(results, program, vertex_array, count, instances)
    records = results.read(dtype, count * instances).reshape(instances, count)
    results.delete()
    return records


def capture_into(
    results: Buffer,
    program: Program,
    vertex_array: VertexArray,
    count: int | None = None,
    instances: int = 1,
) -> np.dtype[Any]:
    """Run the vertex shader and leave its captured outputs in a buffer, which grows if it must.

    Parameters
    ----------
    results
        Receives the records, from its first byte on.
    program, vertex_array, count, instances
        As for `capture`, with the same errors.

    Returns
    -------
    Type of one record, as `capture` describes it.
    """
    if not program.outputs:
        raise ValueError(f"{program.label} captures nothing: make it with feedback=(names...)")
    dtype = np.dtype([(out.name, out.type.dtype, _shape(out)) for out in program.outputs])
    count = vertex_array.resolve_count(count)
    nbytes = count * instances * dtype.itemsize
    if nbytes > results.nbytes:
        results.replace(nbytes)
    program.use()
    gl.glBindBufferBase(gl.GL_TRANSFORM_FEEDBACK_BUFFER, 0, results.name)
    gl.glEnable(gl.GL_RASTERIZER_DISCARD)
    gl.glBeginTransformFeedback(gl.GL_POINTS)
    try:
        vertex_array.draw_instanced(Primitive.POINTS, count, instances)
    finally:
        gl.glEndTransformFeedback()
        gl.glDisable(gl.GL_RASTERIZER_DISCARD)
        gl.glBindBufferBase(gl.GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0)
    return dtype


def _shape(output: Variable) -> tuple[int, ...]:
    """Return the shape of one captured output."""
    shape = (output.type.columns, output.type.rows)
    one = shape if shape[0] > 1 else shape[1:] if shape[1] > 1 else ()
    return one if output.size == 1 else (output.size, *one)

"""Reading back what a vertex shader computes, by transform feedback.

Tests compare skinned vertices with NumPy through it; it draws nothing.
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
    if not program.outputs:
        raise ValueError(f"{program.label} captures nothing: make it with feedback=(names...)")
    dtype = np.dtype([(out.name, out.type.dtype, _shape(out)) for out in program.outputs])
    count = vertex_array.resolve_count(count)
    results = Buffer(count * instances * dtype.itemsize, "stream")
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
    records = results.read(dtype).reshape(instances, count)
    results.delete()
    return records


def _shape(output: Variable) -> tuple[int, ...]:
    """Return the shape of one captured output."""
    shape = (output.type.columns, output.type.rows)
    one = shape if shape[0] > 1 else shape[1:] if shape[1] > 1 else ()
    return one if output.size == 1 else (output.size, *one)

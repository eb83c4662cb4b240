"""The stadium itself and the sky over it: geometry that doesn't change."""

from __future__ import annotations

import numpy as np

from ..crowd.stadium_mesh import StadiumMesh
from ..gl.buffer import Buffer
from ..gl.program import Program
from ..gl.vertex_array import Primitive, VertexArray
from ..gl.vertex_input import VertexInput
from .frame import Frame
from .state import opaque

_VERTEX = np.dtype(
    [
        ("position", np.float32, 3),
        ("normal", np.float32, 3),
        ("uv", np.float32, 2),
        ("color", np.uint8, 4),
        ("surface", np.uint8),
        ("padding", np.uint8, 3),
    ]
)


class StadiumPass:
    """Draws a stadium's mesh and the sky.

    Parameters
    ----------
    mesh
        The static geometry.
    """

    def __init__(self, mesh: StadiumMesh) -> None:
        self._program = Program("stadium/stadium.vert.glsl", "stadium/stadium.frag.glsl")
        vertices = np.zeros(len(mesh.positions), _VERTEX)
        vertices["position"], vertices["normal"] = mesh.positions, mesh.normals
        vertices["uv"], vertices["color"] = mesh.uvs, mesh.colors
        vertices["surface"] = mesh.surface
        self._vertices = Buffer(vertices)
        self._indices = Buffer(mesh.triangles.ravel())
        self._vertex_array = VertexArray(
            self._program,
            [VertexInput(self._vertices, _VERTEX, normalised=("color",))],
            self._indices,
        )
        self._sky = Program("sky/sky.vert.glsl", "sky/sky.frag.glsl")
        self._nothing = VertexArray(self._sky, [])

    def draw(self, frame: Frame) -> None:
        """Draw into the bound framebuffer, the sky last where nothing else is."""
        frame.apply(self._program)
        opaque()
        self._vertex_array.draw()
        frame.apply(self._sky)
        opaque(cull=False, depth_write=False)
        self._nothing.draw(Primitive.TRIANGLES, 3)
        opaque()

    def delete(self) -> None:
        """Delete everything on the GPU."""
        for thing in (self._vertex_array, self._nothing, self._vertices, self._indices):
            thing.delete()
        self._program.delete()
        self._sky.delete()

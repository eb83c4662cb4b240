"""Agents of a few pixels: one point sprite each, on which the fragments draw a figure of strokes.

Points are drawn as one long run of vertices. An instance of four vertices an agent would be the
usual way to do it, but software rasterisers start anew for every instance: at 62,400 agents that
alone takes a tenth of a second, and the points' vertices together take a hundredth.
"""

from __future__ import annotations

from collections.abc import Mapping

from ..gl.api import gl
from ..gl.program import Program
from ..gl.state import DrawTarget
from ..gl.vertex_array import Primitive, VertexArray
from .crowd_inputs import CrowdInputs
from .frame import Frame
from .skinned_pass import InstanceList
from .state import opaque


class FigurePass:
    """Draws the farthest level of detail.

    Parameters
    ----------
    height
        Height of the character in metres, before an agent's scale.
    defines
        Of the pose source.
    """

    def __init__(self, height: float, defines: Mapping[str, int]) -> None:
        self._program = Program(
            "far/figure.vert.glsl", "far/figure.frag.glsl", defines=dict(defines)
        )
        self._height = height
        self.agents = InstanceList()
        self._vertex_array = VertexArray(self._program, [self.agents.input(divisor=0)])

    def draw(self, frame: Frame, inputs: CrowdInputs) -> int:
        """Draw all figures; triangles drawn, two for each."""
        if not self.agents.count:
            return 0
        program = self._program
        frame.apply(program)
        inputs.bind(program, frame.tick, frame.alpha, markers=True)
        program["body_height"] = self._height
        program["pixel"] = 2.0 / (float(frame.projection[1, 1]) * frame.size[1])
        program["viewport"] = DrawTarget.current().viewport
        opaque(cull=False, coverage=True)
        gl.glEnable(gl.GL_PROGRAM_POINT_SIZE)
        self._vertex_array.draw(Primitive.POINTS, self.agents.count)
        gl.glDisable(gl.GL_PROGRAM_POINT_SIZE)
        opaque()
        return 2 * self.agents.count

    def delete(self) -> None:
        """Delete everything on the GPU."""
        self._vertex_array.delete()
        self.agents.buffer.delete()
        self._program.delete()

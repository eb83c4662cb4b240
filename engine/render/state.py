"""The GL state that passes draw with; each pass sets what it relies on."""

from __future__ import annotations

from ..gl.api import gl


def opaque(*, cull: bool = True, depth_write: bool = True, coverage: bool = False) -> None:
    """State for opaque surfaces.

    Parameters
    ----------
    cull
        Whether back faces are left out.
    depth_write
        Whether depth is written; it is always tested.
    coverage
        Whether alpha chooses how many samples of a pixel are written.
    """
    gl.glEnable(gl.GL_DEPTH_TEST)
    gl.glDepthFunc(gl.GL_LEQUAL)
    gl.glDepthMask(depth_write)
    gl.glDisable(gl.GL_BLEND)
    gl.glFrontFace(gl.GL_CCW)
    gl.glCullFace(gl.GL_BACK)
    _switch(gl.GL_CULL_FACE, cull)
    _switch(gl.GL_SAMPLE_ALPHA_TO_COVERAGE, coverage)


def _switch(capability: int, on: bool) -> None:
    (gl.glEnable if on else gl.glDisable)(capability)

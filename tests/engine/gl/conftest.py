"""What the tests of GL objects share."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

# One triangle that covers everything, without any buffer.
FULL_SCREEN = """#version 330 core
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
    gl_Position = vec4(corner, 0.0, 1.0);
}
"""

Shade = Callable[..., NDArray[np.float32]]


@pytest.fixture
def shade(gl: Any) -> Shade:
    """Return what ``result`` of a fragment shader is, as float32 at one pixel."""
    from tifo.engine.gl import Framebuffer, Primitive, Program, TextureFormat, VertexArray

    def run(
        body: str, uniforms: Mapping[str, Any] | None = None, declarations: str = ""
    ) -> NDArray[np.float32]:
        fragment = (
            f"#version 330 core\n{declarations}\nlayout(location = 0) out vec4 result;\n"
            f"void main() {{ {body} }}\n"
        )
        program = Program(FULL_SCREEN, fragment)
        for name, value in (uniforms or {}).items():
            program[name] = value
        target = Framebuffer((1, 1), color=TextureFormat.RGBA32F, depth=False)
        nothing = VertexArray(None, [])
        with target:
            program.use()
            nothing.draw(Primitive.TRIANGLES, 3)
        pixel: NDArray[np.float32] = target.color_texture.read()[0, 0]
        for owned in (nothing, target, program):
            owned.delete()
        return pixel

    return run

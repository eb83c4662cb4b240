from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from numpy.typing import NDArray
from pyglet.math import Mat4, Vec3

from tifo.engine.errors import GraphicsError
from tifo.engine.gl import Buffer, Program, Texture2D, TextureFormat, live_objects

pytestmark = pytest.mark.gl

Shade = Callable[..., NDArray[np.float32]]

PLAIN_FRAGMENT = """#version 330 core
layout(location = 0) out vec4 result;
void main() { result = vec4(1.0); }
"""
PLAIN_VERTEX = """#version 330 core
in vec3 position;
void main() { gl_Position = vec4(position, 1.0); }
"""


@pytest.mark.parametrize(
    ("declaration", "expression", "value", "expected"),
    [
        ("uniform float u;", "vec4(u)", 0.25, [0.25] * 4),
        ("uniform int u;", "vec4(u)", -7, [-7] * 4),
        ("uniform uint u;", "vec4(u >> 16u)", 0xABCD1234, [0xABCD] * 4),
        ("uniform bool u;", "vec4(u ? 1.0 : 2.0)", True, [1] * 4),
        ("uniform vec3 u;", "vec4(u, 9.0)", (1, 2, 3), [1, 2, 3, 9]),
        ("uniform vec3 u;", "vec4(u, 9.0)", Vec3(1, 2, 3), [1, 2, 3, 9]),
        ("uniform ivec2 u;", "vec4(u, u)", np.array([3, -4]), [3, -4, 3, -4]),
        ("uniform uvec4 u;", "vec4(u)", [1, 2, 3, 4], [1, 2, 3, 4]),
        ("uniform bvec2 u;", "vec4(u, u)", [True, False], [1, 0, 1, 0]),
        ("uniform float u[5];", "vec4(u[1], u[2], u[3], u[4])", range(5), [1, 2, 3, 4]),
        ("uniform vec2 bones0[2];", "vec4(bones0[0], bones0[1])", [(1, 2), (3, 4)], [1, 2, 3, 4]),
    ],
)
def test_uniforms_arrive(
    shade: Shade, declaration: str, expression: str, value: object, expected: list[float]
) -> None:
    name = declaration.split()[2].rstrip(";").split("[")[0]
    result = shade(f"result = {expression};", {name: value}, declaration)
    assert_allclose(result, expected)


MATRIX = np.array([[2.0, 0, 0, 5], [0, 3, 0, 6], [0, 0, 4, 7], [0, 0, 0, 1]])


@pytest.mark.parametrize(
    "value",
    [
        MATRIX,
        MATRIX.astype(np.float32),
        Mat4(*MATRIX.T.ravel()),
        np.asfortranarray(MATRIX),
        np.frombuffer(MATRIX.T.astype(np.float32).tobytes(), np.float32),
    ],
    ids=["float64", "float32", "pyglet", "fortran", "read-only, flat"],
)
def test_a_matrix_maps_column_vectors(shade: Shade, value: object) -> None:
    result = shade("result = u * vec4(1.0, 10.0, 100.0, 1.0);", {"u": value}, "uniform mat4 u;")
    assert_allclose(result, MATRIX @ [1, 10, 100, 1])  # [7, 36, 407, 1]


def test_pyglet_and_numpy_agree_about_a_translation(shade: Shade) -> None:
    moved = Mat4.from_translation(Vec3(1, 2, 3))
    result = shade("result = u * vec4(0.0, 0.0, 0.0, 1.0);", {"u": moved}, "uniform mat4 u;")
    assert_allclose(result, [1, 2, 3, 1])


def test_matrices_that_are_not_square_and_arrays_of_them(shade: Shade) -> None:
    affine = MATRIX[:3]
    result = shade(
        "result = vec4(u[1] * vec4(1.0, 1.0, 1.0, 1.0), 0.0);",
        {"u": [np.zeros((3, 4)), affine]},
        "uniform mat4x3 u[2];",
    )
    assert_allclose(result, [7, 9, 11, 0])


def test_part_of_an_array_can_be_set(shade: Shade) -> None:
    result = shade(
        "result = vec4(u[0], u[1], u[2], u[3]);", {"u": [5.0, 6.0]}, "uniform float u[4];"
    )
    assert_allclose(result, [5, 6, 0, 0])


def test_members_of_structs(shade: Shade) -> None:
    result = shade(
        "result = vec4(lights[1].color, 0.0);",
        {"lights[1].color": (1, 2, 3)},
        "struct Light { vec3 color; };\nuniform Light lights[2];",
    )
    assert_allclose(result, [1, 2, 3, 0])


def test_a_uniform_block_reads_its_buffer() -> None:
    fragment = """#version 330 core
layout(std140) uniform Frame { vec4 tint; mat4 view; };
layout(location = 0) out vec4 result;
void main() { result = view * tint; }
"""
    program = Program(PLAIN_VERTEX, fragment)
    assert program.blocks["Frame"].nbytes == 80
    program.bind_block("Frame", 3)
    Buffer(np.zeros(20, np.float32)).bind_uniform(3)
    with pytest.raises(KeyError, match="declares no uniform block 'Fame'; near: Frame"):
        program.bind_block("Fame", 3)
    assert "tint" not in program.uniforms


def test_samplers_of_every_kind_are_known() -> None:
    fragment = """#version 330 core
uniform samplerBuffer a; uniform usamplerBuffer b; uniform sampler2DArrayShadow c;
uniform sampler2DShadow d; uniform usampler2DArray e; uniform samplerCube f;
layout(location = 0) out vec4 result;
void main() {
    result = texelFetch(a, 0) + vec4(texelFetch(b, 0)) + texture(c, vec4(0.0)) +
        texture(d, vec3(0.0)) + vec4(texelFetch(e, ivec3(0), 0)) + texture(f, vec3(1.0));
}
"""
    program = Program(PLAIN_VERTEX, fragment)
    assert sorted(program.uniforms) == ["a", "b", "c", "d", "e", "f"]
    for unit, name in enumerate(program.uniforms):
        program[name] = unit


def test_a_sampler_reads_its_unit(shade: Shade) -> None:
    texture = Texture2D((1, 1), TextureFormat.RGBA32F)
    texture.write(np.array([[[1, 2, 3, 4]]], np.float32))
    texture.bind(5)
    result = shade("result = texelFetch(t, ivec2(0), 0);", {"t": 5}, "uniform sampler2D t;")
    assert_allclose(result, [1, 2, 3, 4])


def test_removed_uniforms_are_ignored_and_unknown_ones_are_not(shade: Shade) -> None:
    assert_allclose(shade("result = vec4(1.0);", {"unused": 1.0}, "uniform float unused;"), 1.0)
    with pytest.raises(KeyError, match="declares no uniform 'unsued'; near: unused"):
        shade("result = vec4(1.0);", {"unsued": 1.0}, "uniform float unused;")


def test_attributes_and_blocks_are_listed() -> None:
    vertex = """#version 330 core
layout(location = 3) in vec3 position; in uint joint; in mat4 model; in vec4 unused;
void main() { gl_Position = model * vec4(position, float(joint)); }
"""
    attributes = Program(vertex).attributes
    assert sorted(attributes) == ["joint", "model", "position"]
    assert attributes["position"].location == 3
    assert attributes["joint"].type.base == "uint"
    assert attributes["model"].type.columns == 4


def test_compile_errors_name_the_users_file_and_line() -> None:
    vertex = PLAIN_VERTEX.replace("void", '#include "override.glsl"\nvoid')
    with pytest.raises(GraphicsError) as caught:
        Program(vertex, includes={"override.glsl": "// head\nvec4 f() { return nothing; }\n"})
    message = str(caught.value)
    assert "shader <vertex shader> does not compile" in message
    assert "override.glsl:2: " in message
    assert "vec4 f() { return nothing; }" in message


def test_link_errors_name_both_shaders() -> None:
    fragment = PLAIN_FRAGMENT.replace("void", "in vec3 missing;\nvoid").replace("1.0", "missing.x")
    vertex = PLAIN_VERTEX.replace("void", "out vec2 missing;\nvoid").replace(
        "gl_P", "missing = vec2(1.0); gl_P"
    )
    before = live_objects()
    with pytest.raises(GraphicsError, match=r"<vertex shader> \+ <fragment shader> does not link"):
        Program(vertex, fragment)
    assert live_objects() == before


def test_unknown_feedback_outputs_do_not_link() -> None:
    with pytest.raises(GraphicsError, match="does not link"):
        Program(PLAIN_VERTEX, feedback=("nothing",))


def test_defines_reach_the_shaders_that_use_them(shade: Shade) -> None:
    fragment = PLAIN_FRAGMENT.replace("vec4(1.0)", "vec4(LEVEL)")
    Program(PLAIN_VERTEX, fragment, defines={"LEVEL": 2.0})
    with pytest.raises(ValueError, match=r"define LEVLE is used by none of the shaders.*LEVEL"):
        Program(PLAIN_VERTEX, fragment, defines={"LEVEL": 2.0, "LEVLE": 2.0})


def test_a_deleted_program_can_not_be_used() -> None:
    program: Any = Program(PLAIN_VERTEX, PLAIN_FRAGMENT)
    program.delete()
    program.delete()
    assert program.deleted
    with pytest.raises(GraphicsError, match="program has been deleted"):
        program.use()

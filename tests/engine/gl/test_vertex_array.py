from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from pyglet import gl as pgl

from tifo.engine.gl import (
    Attribute,
    Buffer,
    Framebuffer,
    Primitive,
    Program,
    TextureFormat,
    VertexArray,
    VertexInput,
    capture,
)

pytestmark = pytest.mark.gl

VERTEX = """#version 330 core
in vec3 position;
in vec4 weight;
in uvec2 joint;
in float plain;
in vec2 place;
out vec3 seen_position;
out vec4 seen_weight;
flat out uvec2 seen_joint;
out float seen_plain;
out vec2 seen_place;
void main() {
    seen_position = position;
    seen_weight = weight;
    seen_joint = joint;
    seen_plain = plain;
    seen_place = place;
    gl_Position = vec4(position, 1.0);
}
"""
RECORD = np.dtype(
    [
        ("position", "f4", 3),
        ("weight", "u1", 4),
        ("joint", "u2", 2),
        ("plain", "i2"),
        ("padding", "u2"),
    ]
)
RECORDS = np.array(
    [((1, 2, 3), (0, 51, 102, 255), (7, 65535), -5, 0), ((4, 5, 6), (255, 0, 0, 0), (1, 2), 6, 0)],
    RECORD,
)
PLACES = np.array([[10, 20], [30, 40], [50, 60]], np.float32)


@pytest.fixture
def program(gl: Any) -> Program:
    names = ("seen_position", "seen_weight", "seen_joint", "seen_plain", "seen_place")
    return Program(VERTEX, feedback=names)


def make(program: Program, index: Buffer | None = None) -> VertexArray:
    return VertexArray(
        program,
        [
            VertexInput(Buffer(RECORDS), RECORD, normalised=("weight",)),
            VertexInput(Buffer(PLACES), [Attribute("place", 2)], divisor=1),
        ],
        index,
        np.uint8,
    )


def test_structured_records_reach_the_shader(program: Program) -> None:
    seen = capture(program, make(program), instances=3)
    assert seen.shape == (3, 2)
    for instance in range(3):
        assert_array_equal(seen[instance]["seen_position"], RECORDS["position"])
        assert_array_equal(seen[instance]["seen_joint"], RECORDS["joint"])
        assert_array_equal(seen[instance]["seen_plain"], [-5, 6])  # not normalised: as numbers
        assert_array_equal(seen[instance]["seen_place"], PLACES[[instance, instance]])
    assert_allclose(seen[0, 0]["seen_weight"], [0, 0.2, 0.4, 1], rtol=1e-6)


def test_indices_pick_vertices(program: Program) -> None:
    array = make(program, Buffer(np.array([1, 1, 0], np.uint8)))
    seen = capture(program, array)
    assert_array_equal(seen["seen_plain"], [[6, 6, -5]])
    assert_array_equal(capture(program, array, 1)["seen_plain"], [[6]])


def test_the_first_instance_moves_only_instanced_buffers(program: Program) -> None:
    array = make(program)
    target = Buffer(5 * 2 * 48)
    program.use()
    pgl.glBindBufferBase(pgl.GL_TRANSFORM_FEEDBACK_BUFFER, 0, target.name)
    pgl.glEnable(pgl.GL_RASTERIZER_DISCARD)
    pgl.glBeginTransformFeedback(pgl.GL_POINTS)
    array.draw_instanced(Primitive.POINTS, instances=2, first_instance=1)
    array.draw_instanced(Primitive.POINTS, instances=1)
    pgl.glEndTransformFeedback()
    rows = target.read(np.float32).reshape(10, 12)[:6]
    assert_array_equal(rows[:, -2:], PLACES[[1, 1, 2, 2, 0, 0]])
    assert_array_equal(rows[:, :3], RECORDS["position"][[0, 1] * 3])


def test_a_matrix_per_instance(gl: Any) -> None:
    vertex = """#version 330 core
layout(location = 2) in mat4x3 model;
out vec3 moved;
void main() { moved = model * vec4(1.0, 10.0, 100.0, 1.0); gl_Position = vec4(0.0); }
"""
    program = Program(vertex, feedback=("moved",))
    models = np.arange(24, dtype=np.float32).reshape(2, 3, 4)
    columns = Buffer(models.swapaxes(1, 2))  # column by column
    for name in ("model", 2):
        array = VertexArray(program, [VertexInput(columns, [Attribute(name, 12)], divisor=1)])
        moved = capture(program, array, 1, 2)["moved"][:, 0]
        assert_allclose(moved, models @ np.array([1, 10, 100, 1], np.float32))


def test_outputs_of_feedback_have_their_shapes(gl: Any) -> None:
    vertex = """#version 330 core
in float x;
out mat2x3 matrix; out float list[2]; flat out int number;
void main() {
    matrix = mat2x3(1.0, 2.0, 3.0, 4.0, 5.0, 6.0) * x;
    list[0] = x; list[1] = -x; number = -int(x);
    gl_Position = vec4(0.0);
}
"""
    program = Program(vertex, feedback=("matrix", "number"))
    array = VertexArray(
        program, [VertexInput(Buffer(np.array([1, 2], np.float32)), [Attribute("x", 1)])]
    )
    seen = capture(program, array)
    assert_array_equal(seen["matrix"][0, 1], [[2, 4, 6], [8, 10, 12]])
    assert_array_equal(seen["number"], [[-1, -2]])
    with pytest.raises(ValueError, match="captures nothing"):
        capture(Program(vertex), array)


def test_feedback_leaves_drawing_switched_on(program: Program) -> None:
    capture(program, make(program))
    assert not pgl.glIsEnabled(pgl.GL_RASTERIZER_DISCARD)
    fragment = "#version 330 core\nout vec4 o;\nvoid main() { o = vec4(2.0); }\n"
    vertex = """#version 330 core
in vec2 corner;
void main() { gl_Position = vec4(corner, 0.0, 1.0); }
"""
    solid = Program(vertex, fragment)
    corners = Buffer(np.array([[-1, -1], [3, -1], [-1, 3]], np.float32))
    target = Framebuffer((2, 2), color=TextureFormat.R32F, depth=False)
    with target:
        solid.use()
        VertexArray(solid, [VertexInput(corners, [Attribute("corner", 2)])]).draw()
    assert_array_equal(target.color_texture.read(), np.full((2, 2, 1), 2))


def test_drawing_leaves_no_vertex_array_bound(program: Program) -> None:
    capture(program, make(program))
    bound = pgl.GLint(1)
    pgl.glGetIntegerv(pgl.GL_VERTEX_ARRAY_BINDING, bound)
    assert bound.value == 0


def test_drawing_nothing_is_allowed(program: Program) -> None:
    array = make(program)
    program.use()
    array.draw(count=0)
    array.draw_instanced(instances=0)


@pytest.mark.parametrize(("count", "first"), [(4, 0), (3, 1), (-1, 0), (1, -1)])
def test_drawing_beyond_the_buffers_is_refused(program: Program, count: int, first: int) -> None:
    array = make(program, Buffer(np.zeros(3, np.uint8)))
    with pytest.raises(ValueError, match="there are 3"):
        array.draw(count=count, first=first)


def test_drawing_more_instances_than_there_are_is_refused(program: Program) -> None:
    array = make(program)
    with pytest.raises(ValueError, match="instances 2 to 4: there are 3"):
        array.draw_instanced(instances=2, first_instance=2)
    with pytest.raises(ValueError, match="instances -1"):
        array.draw_instanced(instances=1, first_instance=-1)


def test_a_forgotten_attribute_is_named(program: Program) -> None:
    with pytest.raises(ValueError, match=r"attribute 'place' of .* is fed by no buffer"):
        VertexArray(program, [VertexInput(Buffer(RECORDS), RECORD)])


def test_an_attribute_fed_twice_is_named(program: Program) -> None:
    twice = VertexInput(Buffer(RECORDS), RECORD)
    with pytest.raises(ValueError, match="'position' is fed twice"):
        VertexArray(program, [twice, twice])


@pytest.mark.parametrize(
    ("attribute", "message"),
    [
        (Attribute("joint", 2, "f4"), "is an integer and its data are floats"),
        (Attribute("place", 5), "has 5 components"),
        (Attribute("place", 0), "stride is 0 bytes"),
    ],
)
def test_data_that_the_shader_can_not_read(
    program: Program, attribute: Attribute, message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        VertexArray(program, [VertexInput(Buffer(64), [attribute])])


def test_unusable_layouts() -> None:
    buffer = Buffer(64)
    with pytest.raises(ValueError, match="has type float64, expected one of f4"):
        VertexInput(buffer, [Attribute("x", 1, np.float64)])
    with pytest.raises(ValueError, match="has type >f4"):
        VertexInput(buffer, [Attribute("x", 1, ">f4")])
    with pytest.raises(ValueError, match="expected a structured dtype"):
        VertexInput(buffer, np.dtype("f4"))
    with pytest.raises(ValueError, match="normalised names"):
        VertexInput(buffer, RECORD, normalised=("weights",))
    with pytest.raises(ValueError, match="divisor -1"):
        VertexInput(buffer, RECORD, divisor=-1)
    with pytest.raises(ValueError, match="index_dtype is int32"):
        VertexArray(None, [], buffer, np.int32)
    with pytest.raises(ValueError, match="needs a program"):
        VertexArray(None, [VertexInput(buffer, RECORD)])

from __future__ import annotations

import pytest

from tifo.engine.overrides.declarations import UniformType, read_declarations, renamed

TEXT = """
// uniform float not_this;
/* uniform float nor_this; */
#define TWICE(x) \\
    (2.0 * (x))
uniform vec3 target, other[4]; uniform highp float speed;
uniform mat3x2 m; uniform ivec2 cell; uniform bool on; uniform mat4 whole;
const float LIMIT = sqrt(2.0), REST = min(1.0, 2.0);
const vec2 CORNERS[2] = vec2[2](vec2(0.0), vec2(1.0, 2.0));
struct Mood { float calm; vec3 eyes; };
float helper(vec2 a, float b);
float helper(vec2 a, float b)
{
    float inner = a.x;
    if (b > 0.0) { inner = max(inner, b); }
    return inner;
}
mat4
nod(const in OverriddenJoint joint)
{
    Mood mood = Mood(1.0, vec3(0.0));
    return joint.pose;
}
"""


def test_uniforms_have_the_shapes_that_numpy_gives_them() -> None:
    assert read_declarations(TEXT).uniforms == {
        "target": UniformType("f", (3,)),
        "other": UniformType("f", (4, 3)),
        "speed": UniformType("f", ()),
        "m": UniformType("f", (2, 3)),
        "cell": UniformType("i", (2,)),
        "on": UniformType("b", ()),
        "whole": UniformType("f", (4, 4)),
    }


def test_functions_and_all_other_names_are_found() -> None:
    found = read_declarations(TEXT)
    assert set(found.functions) == {"helper", "nod"}
    assert found.functions["nod"] == "const in OverriddenJoint joint"
    assert found.macros == {"TWICE"}
    assert found.names == {
        *("target", "other", "speed", "m", "cell", "on", "whole"),
        *("LIMIT", "REST", "CORNERS", "Mood", "helper", "nod"),
    }


@pytest.mark.parametrize(
    "text",
    [
        "uniform sampler2D picture;",
        "uniform Block { vec4 a; };",
        "uniform float a = 1.0;",
        "uniform vec3 a[COUNT];",
        "uniform vec3[2] a;",
    ],
)
def test_uniforms_that_cannot_be_set_are_refused(text: str) -> None:
    with pytest.raises(ValueError, match="can't be set"):
        read_declarations(text)


def test_what_belongs_to_whole_shaders_is_refused() -> None:
    with pytest.raises(ValueError, match="'out vec3 colour' is for whole shaders"):
        read_declarations("out vec3 colour;\n")


def test_names_get_a_prefix_and_members_do_not() -> None:
    text = "uniform float scale;\nfloat f(Body b) { return scale * b.scale + rescale(f2); }\n"
    assert renamed(text, read_declarations(text), "own_") == (
        "uniform float own_scale;\n"
        "float own_f(Body b) { return own_scale * b.scale + rescale(f2); }\n"
    )

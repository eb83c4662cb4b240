from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from tifo.engine.gl.introspect import ShaderType, as_uniform, declared_uniforms

MAT4 = ShaderType("float", 4, 4)
MAT4X3 = ShaderType("float", 3, 4)  # 4 columns of 3 rows


def test_declared_uniforms_finds_all_forms() -> None:
    text = """
    uniform vec3 light, sun ; // uniform int commented;
    uniform highp sampler2DArray history[2];
    #if 0
    uniform float gone = 1.0, kept = 2.0;
    #endif
    layout(std140) uniform Frame { mat4 view; vec4 eye; } frame;
    /* uniform int commented; */
    float uniformity;
    """
    expected = {"light", "sun", "history", "gone", "kept", "Frame"}
    assert declared_uniforms(text) == expected


@pytest.mark.parametrize(
    ("kind", "setter"),
    [
        (ShaderType("float"), "glUniform1fv"),
        (ShaderType("int", 3), "glUniform3iv"),
        (ShaderType("uint", 2), "glUniform2uiv"),
        (ShaderType("bool", 4), "glUniform4iv"),
        (ShaderType("sampler"), "glUniform1iv"),
        (MAT4, "glUniformMatrix4fv"),
        (MAT4X3, "glUniformMatrix4x3fv"),
    ],
)
def test_setters(kind: ShaderType, setter: str) -> None:
    assert kind.setter == setter


def test_matrices_go_column_by_column() -> None:
    matrix = np.arange(12.0).reshape(3, 4)
    expected = [[0, 4, 8, 1, 5, 9, 2, 6, 10, 3, 7, 11]]
    assert_array_equal(as_uniform("m", MAT4X3, 1, matrix), expected)
    assert_array_equal(as_uniform("m", MAT4X3, 1, expected[0]), expected)
    assert_array_equal(as_uniform("m", MAT4X3, 2, [matrix, matrix]), expected * 2)
    assert as_uniform("m", MAT4X3, 1, matrix).dtype == np.float32


def test_scalars_vectors_and_arrays() -> None:
    assert_array_equal(as_uniform("a", ShaderType("float"), 1, 2), [[2.0]])
    assert_array_equal(as_uniform("a", ShaderType("int"), 3, [1, 2]), [[1], [2]])
    assert_array_equal(as_uniform("a", ShaderType("float", 2), 1, (1, 2)), [[1, 2]])
    assert_array_equal(
        as_uniform("a", ShaderType("float", 2), 2, [(1, 2), (3, 4)]), [[1, 2], [3, 4]]
    )
    assert_array_equal(as_uniform("a", ShaderType("bool"), 1, True), [[1]])
    big = as_uniform("a", ShaderType("uint"), 1, 2**32 - 1)
    assert big.dtype == np.uint32
    assert big[0, 0] == 2**32 - 1


@pytest.mark.parametrize(
    ("kind", "size", "value"),
    [
        (ShaderType("int"), 1, 1.5),
        (ShaderType("sampler"), 1, True),
        (ShaderType("uint"), 1, -1),
        (ShaderType("uint"), 1, 2**32),
        (ShaderType("int"), 1, 2**31),
        (ShaderType("int"), 1, 2**70),
        (ShaderType("float"), 1, "one"),
        (ShaderType("float"), 1, None),
        (ShaderType("float"), 1, 1j),
        (ShaderType("float", 3), 1, [1, 2]),
        (ShaderType("float"), 2, [1, 2, 3]),
        (ShaderType("float"), 2, []),
        (MAT4, 1, np.eye(3)),
        (MAT4X3, 1, np.zeros((4, 3))),
        (MAT4, 1, np.zeros((2, 4, 4))),
    ],
)
def test_what_does_not_fit_is_refused(kind: ShaderType, size: int, value: object) -> None:
    with pytest.raises(ValueError, match="uniform 'wave'"):
        as_uniform("wave", kind, size, value)

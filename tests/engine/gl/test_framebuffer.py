from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from pyglet import gl as pgl

from tifo.engine.errors import GraphicsError
from tifo.engine.gl import (
    Attribute,
    Buffer,
    Framebuffer,
    Program,
    Texture2D,
    TextureArray,
    TextureFormat,
    VertexArray,
    VertexInput,
    describe_context,
)

pytestmark = pytest.mark.gl

VERTEX = """#version 330 core
in vec3 corner;
void main() { gl_Position = vec4(corner, 1.0); }
"""
FRAGMENT = """#version 330 core
uniform vec4 color;
layout(location = 0) out vec4 result;
void main() { result = color; }
"""

# Left column of pixels of a 2 pixels wide picture, at half depth.
LEFT = np.array([[-1, -1, 0], [0, -1, 0], [-1, 1, 0], [0, 1, 0]], np.float32)


def draw(color: tuple[float, float, float, float], corners: Any = LEFT) -> None:
    program = Program(VERTEX, FRAGMENT)
    program["color"] = color
    array = VertexArray(program, [VertexInput(Buffer(corners), [Attribute("corner", 3)])])
    array.draw(5)


def test_light_is_stored_as_srgb_and_the_top_row_comes_first() -> None:
    target = Framebuffer((2, 3))
    lower = LEFT * [1, 1, 1]
    lower[:, 1] = [-1, -1, -1 / 3, -1 / 3]
    with target:
        target.clear((0.5, 0.0, 1.0, 0.25))
        draw((0.0, 0.2, 0.0, 1.0), np.float32(lower))
    picture = target.read_pixels()
    assert picture.shape == (3, 2, 4)
    assert picture.dtype == np.uint8
    # 1.055 x ** (1 / 2.4) - 0.055, alpha is linear
    assert_allclose(picture[0, 0], [188, 0, 255, 64], atol=1)
    assert_allclose(picture[2, 0], [0, 124, 0, 255], atol=1)
    assert_array_equal(picture[2, 1], picture[0, 0])


def test_linear_formats_are_not_encoded() -> None:
    target = Framebuffer((1, 1), color=TextureFormat.RGBA8)
    with target:
        target.clear((0.5, 0.0, 1.0, 1.0))
    assert_allclose(target.read_pixels()[0, 0], [128, 0, 255, 255], atol=1)


def test_depth_is_tested_stored_and_read_back() -> None:
    target = Framebuffer((2, 2))
    with target:
        target.clear(depth=1.0)
        pgl.glEnable(pgl.GL_DEPTH_TEST)
        draw((1.0, 0.0, 0.0, 1.0), LEFT - np.array([0, 0, 0.5], np.float32))
        draw((0.0, 1.0, 0.0, 1.0), LEFT)
    assert_allclose(target.read_depth(), [[0.25, 1.0]] * 2, atol=1e-6)
    assert_array_equal(target.read_pixels()[0, 0], [255, 0, 0, 255])


def test_clearing_works_after_depth_writes_were_off() -> None:
    target = Framebuffer((1, 1))
    pgl.glDepthMask(False)
    pgl.glColorMask(False, False, False, False)
    with target:
        target.clear((1, 1, 1, 1), 0.5)
    assert_allclose(target.read_depth(), 0.5, atol=1e-6)
    assert target.read_pixels().min() == 255


def test_samples_are_averaged_in_linear_light() -> None:
    if describe_context().max_samples < 4:
        pytest.skip("this driver has no multisampling")
    target = Framebuffer((2, 2), samples=4)
    half = LEFT + np.array([0.5, 0, 0], np.float32)  # covers the right half of the left pixels
    with target:
        target.clear((0.0, 0.0, 0.0, 1.0))
        draw((1.0, 1.0, 1.0, 1.0), half)
    picture = target.read_pixels()
    assert_allclose(picture[:, :, 0], 188, atol=2)
    assert target.resolve().samples == 0
    assert target.resolve() is target.resolve()
    assert target.read_depth().shape == (2, 2)
    with pytest.raises(ValueError, match="resolve first"):
        _ = target.color_texture


def test_what_was_bound_comes_back() -> None:
    outer, inner = Framebuffer((4, 2)), Framebuffer((3, 3), color=TextureFormat.RGBA8)
    viewport = (pgl.GLint * 4)()
    bound = pgl.GLint()
    with outer:
        with inner:
            assert not pgl.glIsEnabled(pgl.GL_FRAMEBUFFER_SRGB)
        pgl.glGetIntegerv(pgl.GL_VIEWPORT, viewport)
        pgl.glGetIntegerv(pgl.GL_DRAW_FRAMEBUFFER_BINDING, bound)
        assert list(viewport) == [0, 0, 4, 2]
        assert bound.value == outer.name
        assert pgl.glIsEnabled(pgl.GL_FRAMEBUFFER_SRGB)
    pgl.glGetIntegerv(pgl.GL_DRAW_FRAMEBUFFER_BINDING, bound)
    assert bound.value == 0
    assert not pgl.glIsEnabled(pgl.GL_FRAMEBUFFER_SRGB)


def test_making_and_reading_disturb_no_target() -> None:
    target = Framebuffer((4, 2))
    bound = pgl.GLint()
    with target:
        Framebuffer((2, 2), samples=min(2, describe_context().max_samples)).read_pixels()
        pgl.glGetIntegerv(pgl.GL_DRAW_FRAMEBUFFER_BINDING, bound)
        assert bound.value == target.name


def test_drawing_into_layers_of_an_array_texture() -> None:
    stack = TextureArray((2, 2), 3, TextureFormat.RGBA32F)
    stack.write(np.zeros((3, 2, 2, 4), np.float32))
    target = Framebuffer.onto(stack, layer=1)
    with target:
        target.clear((1, 2, 3, 4))
        target.select_layer(2)
        draw((5, 6, 7, 8))
    layers = stack.read()
    assert_array_equal(layers[0], np.zeros((2, 2, 4)))
    assert_array_equal(layers[1, 1, 1], [1, 2, 3, 4])
    assert_array_equal(layers[2, :, 0], [[5, 6, 7, 8]] * 2)
    assert_array_equal(layers[2, :, 1], np.zeros((2, 4)))
    with pytest.raises(ValueError, match="layer is 3, expected 0 to 2"):
        target.select_layer(3)
    with pytest.raises(ValueError, match="has RGBA32F: read its color_texture"):
        target.read_pixels()


def test_a_depth_only_pass() -> None:
    shadow = Texture2D((2, 2), TextureFormat.DEPTH24, compare=True)
    target = Framebuffer.onto(None, shadow)
    with target:
        target.clear(depth=0.75)
        pgl.glEnable(pgl.GL_DEPTH_TEST)
        draw((1, 1, 1, 1), LEFT)
    assert target.depth_texture is shadow
    assert_allclose(target.read_depth(), [[0.5, 0.75]] * 2, atol=1e-6)
    with pytest.raises(ValueError, match="no colour"):
        target.read_pixels()


def test_integer_targets_are_cleared_to_whole_numbers() -> None:
    target = Framebuffer((1, 1), color=TextureFormat.RGBA32UI, depth=False)
    with target:
        target.clear((1, 2, 3, 4e9))
    assert_array_equal(target.color_texture.read()[0, 0], [1, 2, 3, 4_000_000_000])
    with pytest.raises(ValueError, match="no depth image"):
        target.read_depth()


@pytest.mark.parametrize(
    "format", [TextureFormat.RGBA16, TextureFormat.RGBA16F, TextureFormat.RG32F]
)
def test_formats_that_passes_draw_to(format: TextureFormat) -> None:
    target = Framebuffer((1, 1), color=format, depth=False)
    with target:
        target.clear((0.25, 0.5, 0.75, 1.0))
    value = target.color_texture.read()[0, 0].astype(np.float64)
    expected = np.array([0.25, 0.5, 0.75, 1.0])[: format.channels]
    scale = 65535 if format is TextureFormat.RGBA16 else 1
    assert_allclose(value / scale, expected, atol=1e-4)


def test_wrong_framebuffers_are_refused() -> None:
    most = describe_context().max_samples
    with pytest.raises(ValueError, match=f"samples is {most + 1}"):
        Framebuffer((4, 4), most + 1)
    with pytest.raises(ValueError, match="samples is -1"):
        Framebuffer((4, 4), -1)
    with pytest.raises(ValueError, match="size is"):
        Framebuffer((0, 4))
    with pytest.raises(ValueError, match="size is"):
        Framebuffer((0, 4), samples=most)
    with pytest.raises(ValueError, match="nothing to draw to"):
        Framebuffer((4, 4), color=None, depth=False)
    with pytest.raises(ValueError, match="nothing to draw to"):
        Framebuffer.onto(None)
    with pytest.raises(ValueError, match="differ in size"):
        Framebuffer.onto(Texture2D((4, 4)), Texture2D((2, 2), TextureFormat.DEPTH24))
    with pytest.raises(ValueError, match="color is DEPTH24"):
        Framebuffer((4, 4), color=TextureFormat.DEPTH24)
    with pytest.raises(ValueError, match="give it as depth"):
        Framebuffer.onto(Texture2D((4, 4), TextureFormat.DEPTH24))
    with pytest.raises(ValueError, match="depth is RGBA8"):
        Framebuffer.onto(None, Texture2D((4, 4)))
    with pytest.raises(ValueError, match="layer is 2"):
        Framebuffer.onto(TextureArray((4, 4), 2), layer=2)


def test_a_deleted_framebuffer_frees_what_it_owns_and_only_that() -> None:
    from tifo.engine.gl import live_objects

    before = live_objects()
    target = Framebuffer((4, 4), samples=min(2, describe_context().max_samples))
    target.read_pixels()
    target.delete()
    assert live_objects() == before
    given = Texture2D((4, 4))
    Framebuffer.onto(given).delete()
    assert not given.deleted
    with pytest.raises(GraphicsError, match="framebuffer has been deleted"):
        target.bind()

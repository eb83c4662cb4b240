from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from numpy.typing import NDArray
from pyglet import gl as pgl

from tifo.engine.gl import Texture2D, TextureArray, TextureFormat

pytestmark = pytest.mark.gl

Shade = Callable[..., NDArray[np.float32]]


def texels(format: TextureFormat, shape: tuple[int, ...]) -> NDArray[Any]:
    rng = np.random.default_rng(7)
    if format.dtype.kind == "f":
        return rng.random((*shape, format.channels)).astype(format.dtype)
    most = np.iinfo(format.dtype).max
    return rng.integers(0, most, (*shape, format.channels), format.dtype, endpoint=True)


@pytest.mark.parametrize("format", TextureFormat)
def test_texels_come_back(format: TextureFormat) -> None:
    # Three texels a row: rows of one byte are not aligned to four.
    data = texels(format, (2, 3))
    texture = Texture2D((3, 2), format)
    texture.write(data)
    tolerance = 2.0**-22 if format.is_depth else 0
    assert_allclose(texture.read(), data, rtol=0, atol=tolerance)
    assert texture.nbytes == data.nbytes

    layers = texels(format, (4, 2, 3))
    stack = TextureArray((3, 2), 4, format)
    stack.write(layers)
    assert_allclose(stack.read(), layers, rtol=0, atol=tolerance)


def test_writing_a_rectangle_changes_nothing_else() -> None:
    data = np.zeros((4, 5, 4), np.uint8)
    texture = Texture2D((5, 4), TextureFormat.RGBA8)
    texture.write(data)
    patch = texels(TextureFormat.RGBA8, (2, 3))
    texture.write(patch, x=2, y=1)
    data[1:3, 2:5] = patch
    assert_array_equal(texture.read(), data)


def test_writing_layers_changes_nothing_else() -> None:
    data = np.zeros((5, 2, 3, 1), np.float32)
    stack = TextureArray((3, 2), 5, TextureFormat.R32F)
    stack.write(data)
    two = texels(TextureFormat.R32F, (2, 1, 2))
    stack.write(two, x=1, y=1, layer=3)
    data[3:5, 1:2, 1:3] = two
    one = texels(TextureFormat.R32F, (2, 3))
    stack.write(one, layer=1)
    data[1] = one
    assert_array_equal(stack.read(), data)
    stack.write(one[:, :, 0], layer=0)  # without the axis of channels
    data[0] = one
    assert_array_equal(stack.read(), data)


def test_views_are_copied_as_they_look() -> None:
    data = texels(TextureFormat.RG32F, (4, 6))
    texture = Texture2D((3, 4), TextureFormat.RG32F)
    texture.write(data[::-1, ::2])
    assert_array_equal(texture.read(), data[::-1, ::2])


def test_unpacking_left_by_others_does_not_matter() -> None:
    pgl.glPixelStorei(pgl.GL_UNPACK_ROW_LENGTH, 17)
    pgl.glPixelStorei(pgl.GL_UNPACK_SKIP_ROWS, 3)
    data = texels(TextureFormat.R8, (3, 3))
    texture = Texture2D((3, 3), TextureFormat.R8)
    texture.write(data)
    assert_array_equal(texture.read(), data)


def test_row_zero_is_at_coordinate_zero(shade: Shade) -> None:
    texture = Texture2D((1, 2), TextureFormat.R32F)
    texture.write(np.array([[1], [2]], np.float32))
    texture.bind(1)
    result = shade(
        "result = vec4(texture(t, vec2(0.5, 0.0)).r, texture(t, vec2(0.5, 1.0)).r, 0, 0);",
        {"t": 1},
        "uniform sampler2D t;",
    )
    assert_allclose(result[:2], [1, 2])


def test_srgb_texels_are_read_as_linear_light(shade: Shade) -> None:
    texture = Texture2D((1, 1), TextureFormat.SRGB8_ALPHA8)
    texture.write(np.array([[[188, 0, 255, 128]]], np.uint8))
    texture.bind(0)
    result = shade("result = texture(t, vec2(0.5));", {"t": 0}, "uniform sampler2D t;")
    linear = ((188 / 255 + 0.055) / 1.055) ** 2.4
    assert_allclose(result, [linear, 0, 1, 128 / 255], atol=2e-3)


def test_integers_arrive_exactly(shade: Shade) -> None:
    stack = TextureArray((2, 1), 3, TextureFormat.R32UI)
    values = np.array([[[0, 1]], [[2, 3]], [[4, 0xFFFF0005]]], np.uint32)
    stack.write(values)
    stack.bind(2)
    result = shade(
        "uint v = texelFetch(t, ivec3(1, 0, 2), 0).r; result = vec4(v >> 16u, v & 65535u, 0, 0);",
        {"t": 2},
        "uniform usampler2DArray t;",
    )
    assert_array_equal(result[:2], [0xFFFF, 5])


@pytest.mark.parametrize(("filter", "expected"), [("nearest", 0.0), ("linear", 0.25)])
def test_filters(shade: Shade, filter: str, expected: float) -> None:
    texture = Texture2D((2, 1), TextureFormat.R32F, filter=filter)  # type: ignore[arg-type]
    texture.write(np.array([[0, 1]], np.float32))
    texture.bind(0)
    result = shade("result = texture(t, vec2(0.375, 0.5));", {"t": 0}, "uniform sampler2D t;")
    assert_allclose(result[0], expected, atol=1e-2)


@pytest.mark.parametrize(("wrap", "expected"), [("clamp", 1.0), ("repeat", 0.0)])
def test_wraps(shade: Shade, wrap: str, expected: float) -> None:
    texture = Texture2D((2, 1), TextureFormat.R32F, wrap=wrap)  # type: ignore[arg-type]
    texture.write(np.array([[0, 1]], np.float32))
    texture.bind(0)
    result = shade("result = texture(t, vec2(1.25, 0.5));", {"t": 0}, "uniform sampler2D t;")
    assert_allclose(result[0], expected)


def test_mipmaps_are_averages_and_can_be_written() -> None:
    texture = Texture2D((4, 2), TextureFormat.R32F, levels=3)
    texture.write(np.array([[0, 4, 8, 12], [0, 4, 8, 12]], np.float32))
    texture.build_mipmaps()
    assert_allclose(texture.read(1)[..., 0], [[2, 10]])
    assert_allclose(texture.read(2)[..., 0], [[6]])
    texture.write(np.array([[7]], np.float32), level=2)
    assert_allclose(texture.read(2)[..., 0], [[7]])
    with pytest.raises(ValueError, match="level is 3, expected 0 to 2"):
        texture.read(3)


def test_depth_can_be_compared(shade: Shade) -> None:
    texture = Texture2D((1, 1), TextureFormat.DEPTH24, compare=True)
    texture.write(np.array([[0.5]], np.float32))
    texture.bind(0)
    result = shade(
        "result = vec4(texture(t, vec3(0.5, 0.5, 0.4)), texture(t, vec3(0.5, 0.5, 0.6)), 0, 0);",
        {"t": 0},
        "uniform sampler2DShadow t;",
    )
    assert_array_equal(result[:2], [1, 0])


def test_transfers_keep_what_passes_have_bound() -> None:
    kept = Texture2D((1, 1))
    kept.bind(0)
    other = Texture2D((1, 1))
    other.write(np.zeros((1, 1, 4), np.uint8))
    other.read()
    other.build_mipmaps()
    bound, active = pgl.GLint(), pgl.GLint()
    pgl.glGetIntegerv(pgl.GL_TEXTURE_BINDING_2D, bound)
    pgl.glGetIntegerv(pgl.GL_ACTIVE_TEXTURE, active)
    assert bound.value == kept.name
    assert active.value == pgl.GL_TEXTURE0


def test_texels_outside_are_refused() -> None:
    texture = Texture2D((4, 4), TextureFormat.R8)
    stack = TextureArray((4, 4), 2, TextureFormat.R8)
    block = np.zeros((2, 2, 1), np.uint8)
    for x, y in ((3, 0), (0, 3), (-1, 0), (0, -1)):
        with pytest.raises(ValueError, match="lie outside of 0 to 4"):
            texture.write(block, x, y)
        with pytest.raises(ValueError, match="lie outside of 0 to 4"):
            stack.write(block, x, y)
    with pytest.raises(ValueError, match="layers 2 to 3 lie outside of 0 to 2"):
        stack.write(block, layer=2)


def test_wrong_arrays_are_refused() -> None:
    texture = Texture2D((4, 4), TextureFormat.RGBA8)
    with pytest.raises(ValueError, match="array is float32, texture format RGBA8 takes uint8"):
        texture.write(np.zeros((4, 4, 4), np.float32))
    with pytest.raises(ValueError, match=r"expected \(height, width, 4\)"):
        texture.write(np.zeros((4, 4, 3), np.uint8))
    with pytest.raises(ValueError, match=r"expected \(layers, height, width, 4\)"):
        TextureArray((4, 4), 2).write(np.zeros((4, 4), np.uint8))


def test_wrong_textures_are_refused() -> None:
    with pytest.raises(ValueError, match=r"size is \(0, 4\)"):
        Texture2D((0, 4))
    with pytest.raises(ValueError, match="texels a side"):
        Texture2D((1 << 20, 4))
    with pytest.raises(ValueError, match="layers is 100000"):
        TextureArray((4, 4), 100000)
    with pytest.raises(ValueError, match=r"levels is 4, a texture of .* has 1 to 3"):
        Texture2D((4, 4), levels=4)
    with pytest.raises(ValueError, match="takes only nearest"):
        Texture2D((4, 4), TextureFormat.R32UI, filter="linear")
    with pytest.raises(ValueError, match="compare is for DEPTH24"):
        Texture2D((4, 4), compare=True)
    with pytest.raises(ValueError, match="wrap is 'mirror'"):
        Texture2D((4, 4), wrap="mirror")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="filter is 'cubic'"):
        Texture2D((4, 4), filter="cubic")  # type: ignore[arg-type]

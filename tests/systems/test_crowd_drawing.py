"""A crowd inside somebody else's OpenGL program: the picture, and what is left behind."""

from __future__ import annotations

import ctypes
import gc
from collections.abc import Iterator
from typing import Any

import esper
import numpy as np
import pytest
from numpy.typing import NDArray

import tifo

pytestmark = pytest.mark.gl

SPEC = tifo.CrowdSpec(layout="stand", rows=4, columns=9, streams=16, history=14, seed=4)
SIZE = (160, 90)
EMPTY = "#version 330 core\nvoid main() { gl_Position = vec4(0.0); }"


@pytest.fixture
def crowd(esper_world: str) -> Iterator[tifo.Crowd]:
    made = tifo.spawn_crowd(SPEC, tifo.build_seats(SPEC), tifo.builtin_spectator())
    for system in made.systems():
        esper.add_processor(system)
    for _ in range(10):
        esper.process(1 / 60)
    yield made
    made.release_graphics()


@pytest.fixture
def camera(crowd: tifo.Crowd) -> tifo.FreeCamera:
    return tifo.FreeCamera.looking(*tifo.camera_presets(crowd.plan)["close"])


def picture(
    crowd: tifo.Crowd, view: Any, projection: Any, kind: str = "SRGB8_ALPHA8", **how: Any
) -> NDArray[np.uint8]:
    from tifo.engine.gl import Framebuffer, TextureFormat

    target = Framebuffer(SIZE, color=TextureFormat[kind])
    with target:
        target.clear((0.0, 0.0, 0.0, 1.0))
        crowd.draw(view, projection, **how)
    pixels = target.read_pixels()[..., :3]
    target.delete()
    return pixels


class Poison:
    """Sets every piece of state that a game may hold to something odd, and reads it again."""

    def __init__(self, api: Any) -> None:
        self.gl = gl = api
        self.program = self._program()
        names = (gl.GLuint * 40)()
        gl.glGenTextures(40, names)
        self.textures = [*names]
        names = (gl.GLuint * 20)()
        gl.glGenSamplers(20, names)
        self.samplers = [*names]
        names = (gl.GLuint * 12)()
        gl.glGenBuffers(12, names)
        self.buffers = [*names]
        for name in self.buffers:
            gl.glBindBuffer(gl.GL_ARRAY_BUFFER, name)
            gl.glBufferData(gl.GL_ARRAY_BUFFER, 1024, None, gl.GL_STATIC_DRAW)
        names = (gl.GLuint * 1)()
        gl.glGenVertexArrays(1, names)
        self.vertex_array = names[0]

    def _program(self) -> int:
        from tifo.engine.gl import Program

        self._owned = Program(
            "#version 330 core\nvoid main() { gl_Position = vec4(0.0); }",
            "#version 330 core\nout vec4 c; void main() { c = vec4(1.0); }",
        )
        return self._owned.name

    def set(self, scissor: tuple[int, int, int, int]) -> None:
        gl = self.gl
        gl.glUseProgram(self.program)
        gl.glBindVertexArray(self.vertex_array)
        gl.glBindBuffer(gl.GL_ELEMENT_ARRAY_BUFFER, self.buffers[0])
        targets = ("ARRAY", "COPY_READ", "COPY_WRITE", "PIXEL_PACK", "PIXEL_UNPACK", "UNIFORM")
        for number, target in enumerate(targets, 1):
            gl.glBindBuffer(getattr(gl, f"GL_{target}_BUFFER"), self.buffers[number])
        for binding in (0, 1, 5):
            gl.glBindBufferRange(gl.GL_UNIFORM_BUFFER, binding, self.buffers[7], 256, 64)
        gl.glBindBufferRange(gl.GL_TRANSFORM_FEEDBACK_BUFFER, 0, self.buffers[8], 16, 32)
        gl.glBindBuffer(gl.GL_TRANSFORM_FEEDBACK_BUFFER, self.buffers[9])
        for place, unit in enumerate((*range(16), 47)):
            gl.glActiveTexture(gl.GL_TEXTURE0 + unit)
            gl.glBindTexture(gl.GL_TEXTURE_2D, self.textures[place])
            gl.glBindTexture(gl.GL_TEXTURE_2D_ARRAY, self.textures[20 + place])
            gl.glBindSampler(unit, self.samplers[place])
        gl.glActiveTexture(gl.GL_TEXTURE0 + 5)
        for name in SWITCHES:
            gl.glEnable(getattr(gl, name))
        gl.glDisable(gl.GL_DEPTH_TEST)
        gl.glDisablei(gl.GL_BLEND, 2)
        gl.glStencilFunc(gl.GL_ALWAYS, 0, 0xFF)
        gl.glDepthMask(False)
        gl.glDepthFunc(gl.GL_GREATER)
        gl.glDepthRange(0.0, 1.0)
        gl.glCullFace(gl.GL_FRONT_AND_BACK)
        gl.glFrontFace(gl.GL_CW)
        gl.glPolygonMode(gl.GL_FRONT_AND_BACK, gl.GL_LINE)
        gl.glPolygonOffset(3.0, 4.0)
        gl.glColorMask(False, True, False, True)
        gl.glColorMaski(1, True, False, False, False)
        gl.glBlendFunc(gl.GL_ONE, gl.GL_ONE)
        gl.glClearColor(0.1, 0.2, 0.3, 0.4)
        gl.glPointSize(7.0)
        gl.glPrimitiveRestartIndex(5)
        gl.glScissor(*scissor)
        gl.glViewport(0, 0, *SIZE)
        unpack = ("ROW_LENGTH", "IMAGE_HEIGHT", "SKIP_PIXELS", "SKIP_ROWS", "SKIP_IMAGES")
        for value, name in enumerate(unpack, 3):
            gl.glPixelStorei(getattr(gl, f"GL_UNPACK_{name}"), value)
        gl.glPixelStorei(gl.GL_UNPACK_ALIGNMENT, 8)
        gl.glPixelStorei(gl.GL_UNPACK_SWAP_BYTES, 1)
        gl.glPixelStorei(gl.GL_UNPACK_LSB_FIRST, 1)
        gl.glPixelStorei(gl.GL_PACK_ALIGNMENT, 2)

    def read(self) -> dict[str, Any]:
        gl = self.gl
        state: dict[str, Any] = {}
        for name, count in VALUES.items():
            values = (gl.GLdouble * count)()
            gl.glGetDoublev(getattr(gl, name), values)
            state[name] = [*values]
        for name in (*SWITCHES, "GL_DEPTH_TEST"):
            state[name] = bool(gl.glIsEnabled(getattr(gl, name)))
        for index in range(8):
            state[f"blend {index}"] = bool(gl.glIsEnabledi(gl.GL_BLEND, index))
            mask = (gl.GLboolean * 4)()
            gl.glGetBooleani_v(gl.GL_COLOR_WRITEMASK, index, mask)
            state[f"mask {index}"] = [*mask]
        for kind in ("UNIFORM", "TRANSFORM_FEEDBACK"):
            for index in range(1 if kind == "TRANSFORM_FEEDBACK" else 8):
                for what in ("BINDING", "START", "SIZE"):
                    value = gl.GLint64(0)
                    query = getattr(gl, f"GL_{kind}_BUFFER_{what}")
                    gl.glGetInteger64i_v(query, index, ctypes.byref(value))
                    state[f"{kind} {index} {what}"] = value.value
        active = state["GL_ACTIVE_TEXTURE"][0]
        for unit in range(48):
            gl.glActiveTexture(gl.GL_TEXTURE0 + unit)
            for name in ("TEXTURE_BINDING_2D", "TEXTURE_BINDING_2D_ARRAY", "SAMPLER_BINDING"):
                value = gl.GLint(0)
                gl.glGetIntegerv(getattr(gl, f"GL_{name}"), value)
                state[f"{name} {unit}"] = value.value
        gl.glActiveTexture(int(active))
        return state

    def delete(self) -> None:
        gl = self.gl
        for deleter, names in (
            (gl.glDeleteTextures, self.textures),
            (gl.glDeleteSamplers, self.samplers),
            (gl.glDeleteBuffers, self.buffers),
            (gl.glDeleteVertexArrays, [self.vertex_array]),
        ):
            deleter(len(names), (gl.GLuint * len(names))(*names))
        self._owned.delete()


SWITCHES = (
    *("GL_BLEND", "GL_CULL_FACE", "GL_SCISSOR_TEST", "GL_STENCIL_TEST", "GL_FRAMEBUFFER_SRGB"),
    *("GL_POLYGON_OFFSET_FILL", "GL_PRIMITIVE_RESTART", "GL_DEPTH_CLAMP", "GL_COLOR_LOGIC_OP"),
    *("GL_SAMPLE_COVERAGE", "GL_SAMPLE_MASK", "GL_SAMPLE_ALPHA_TO_ONE", "GL_PROGRAM_POINT_SIZE"),
    *("GL_SAMPLE_ALPHA_TO_COVERAGE", "GL_RASTERIZER_DISCARD", "GL_POLYGON_SMOOTH"),
    *(f"GL_CLIP_DISTANCE{plane}" for plane in range(8)),
)
VALUES = {
    "GL_CURRENT_PROGRAM": 1,
    "GL_VERTEX_ARRAY_BINDING": 1,
    "GL_ELEMENT_ARRAY_BUFFER_BINDING": 1,
    "GL_ARRAY_BUFFER_BINDING": 1,
    "GL_COPY_READ_BUFFER": 1,
    "GL_COPY_WRITE_BUFFER": 1,
    "GL_PIXEL_PACK_BUFFER_BINDING": 1,
    "GL_PIXEL_UNPACK_BUFFER_BINDING": 1,
    "GL_UNIFORM_BUFFER_BINDING": 1,
    "GL_TRANSFORM_FEEDBACK_BUFFER_BINDING": 1,
    "GL_DRAW_FRAMEBUFFER_BINDING": 1,
    "GL_READ_FRAMEBUFFER_BINDING": 1,
    "GL_RENDERBUFFER_BINDING": 1,
    "GL_VIEWPORT": 4,
    "GL_SCISSOR_BOX": 4,
    "GL_ACTIVE_TEXTURE": 1,
    "GL_DEPTH_WRITEMASK": 1,
    "GL_DEPTH_FUNC": 1,
    "GL_DEPTH_RANGE": 2,
    "GL_CULL_FACE_MODE": 1,
    "GL_FRONT_FACE": 1,
    "GL_POLYGON_MODE": 1,
    "GL_POLYGON_OFFSET_FACTOR": 1,
    "GL_COLOR_CLEAR_VALUE": 4,
    "GL_POINT_SIZE": 1,
    "GL_PRIMITIVE_RESTART_INDEX": 1,
    "GL_BLEND_SRC_RGB": 1,
    "GL_BLEND_DST_ALPHA": 1,
    "GL_STENCIL_FUNC": 1,
    "GL_UNPACK_ALIGNMENT": 1,
    "GL_UNPACK_SWAP_BYTES": 1,
    "GL_UNPACK_LSB_FIRST": 1,
    "GL_UNPACK_ROW_LENGTH": 1,
    "GL_UNPACK_IMAGE_HEIGHT": 1,
    "GL_UNPACK_SKIP_PIXELS": 1,
    "GL_UNPACK_SKIP_ROWS": 1,
    "GL_UNPACK_SKIP_IMAGES": 1,
    "GL_PACK_ALIGNMENT": 1,
}


def clean_up(api: Any) -> None:
    """What `reset_state` doesn't know of."""
    for name in SWITCHES:
        api.glDisable(getattr(api, name))
    api.glPolygonMode(api.GL_FRONT_AND_BACK, api.GL_FILL)
    api.glColorMask(True, True, True, True)
    for unit in (*range(16), 47):
        api.glBindSampler(unit, 0)
    for name in VALUES:
        if name.startswith("GL_UNPACK") and "ALIGNMENT" not in name:
            api.glPixelStorei(getattr(api, name), 0)
    api.glPixelStorei(api.GL_UNPACK_ALIGNMENT, 4)
    api.glPixelStorei(api.GL_PACK_ALIGNMENT, 4)
    api.glCullFace(api.GL_BACK)
    api.glFrontFace(api.GL_CCW)
    api.glPointSize(1.0)
    api.glClearColor(0.0, 0.0, 0.0, 0.0)
    for binding in (0, 1, 5):
        api.glBindBufferBase(api.GL_UNIFORM_BUFFER, binding, 0)
    api.glBindBufferBase(api.GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0)


@pytest.mark.parametrize("first", [True, False])
def test_poisoned_state_is_left_as_it_was_and_does_no_harm(
    gl: Any, crowd: tifo.Crowd, camera: tifo.FreeCamera, first: bool
) -> None:
    """Also in the first call, which makes and fills all objects."""
    from tifo.engine.gl import Framebuffer, check_errors, reset_state
    from tifo.engine.gl.api import gl as api

    view, projection = camera.view(), camera.projection(SIZE)
    crowd.add_override(tifo.look_at())
    plain = picture(crowd, view, projection)
    if first:
        crowd.release_graphics()
    poison = Poison(api)
    target, other = Framebuffer(SIZE), Framebuffer((8, 8))
    target.bind()
    target.clear((0.0, 0.0, 0.0, 1.0))
    api.glBindFramebuffer(api.GL_READ_FRAMEBUFFER, other.name)
    try:
        poison.set((20, 10, 100, 60))
        before = poison.read()
        crowd.draw(view, projection)
        after = poison.read()
        check_errors("drawing with poisoned state")
    finally:
        clean_up(api)
        reset_state()
        poison.delete()
    assert after == before
    # The picture is what it is without poison, inside of the scissor.
    expected = np.zeros_like(plain)
    expected[SIZE[1] - 70 : SIZE[1] - 10, 20:120] = plain[SIZE[1] - 70 : SIZE[1] - 10, 20:120]
    np.testing.assert_array_equal(target.read_pixels()[..., :3], expected)
    assert expected.std() > 10
    target.delete()
    other.delete()


def test_without_restoring_the_picture_is_the_same(
    gl: Any, crowd: tifo.Crowd, camera: tifo.FreeCamera
) -> None:
    view, projection = camera.view(), camera.projection(SIZE)
    kept = picture(crowd, view, projection)
    np.testing.assert_array_equal(kept, picture(crowd, view, projection, restore_state=False))
    np.testing.assert_array_equal(kept, picture(crowd, view, projection, size=SIZE))
    assert kept.std() > 20


def test_the_picture_is_that_of_a_stage_where_nothing_stands_before_it(
    gl: Any, camera: tifo.FreeCamera
) -> None:
    from tifo.systems.render import RenderSystem

    simulation = tifo.Simulation(SPEC)
    simulation.run(seconds=0.2)
    view, projection = camera.view(), camera.projection(SIZE)
    ours = picture(simulation.crowd, view, projection)
    from tifo.engine.gl import Framebuffer, describe_context

    if describe_context().is_software:
        simulation.detail.coarseness = 2.0
    system, target = RenderSystem(SIZE), Framebuffer(SIZE)
    simulation.schedule.frame_systems.append(system)
    simulation.look(view, projection, SIZE[1])
    with target:
        target.clear((0.0, 0.0, 0.0, 1.0))
        simulation.advance(0.0)
    np.testing.assert_array_equal(ours, target.read_pixels()[..., :3])
    system.delete()
    target.delete()
    simulation.crowd.release_graphics()
    simulation.close()


def test_framebuffers_without_srgb_get_encoded_bytes(
    gl: Any, crowd: tifo.Crowd, camera: tifo.FreeCamera
) -> None:
    view, projection = camera.view(), camera.projection(SIZE)
    encoded = picture(crowd, view, projection, "RGBA8").astype(int)
    by_gl = picture(crowd, view, projection, "SRGB8_ALPHA8").astype(int)
    assert np.abs(encoded - by_gl).max() <= 2
    from tifo.engine.gl import Framebuffer, TextureFormat

    target = Framebuffer(SIZE, color=TextureFormat.RGBA16F)
    with target:
        target.clear((0.0, 0.0, 0.0, 1.0))
        crowd.draw(view, projection)
    light = target.color_texture.read()[::-1, :, :3].astype(float)
    target.delete()
    low, high = light / 12.92, np.maximum(light, 1e-9)
    as_bytes = np.where(light <= 0.0031308, 12.92 * light, 1.055 * high ** (1 / 2.4) - 0.055)
    assert low.shape == as_bytes.shape
    assert np.abs(np.round(255 * as_bytes) - by_gl).max() <= 3


def test_a_placed_crowd_looks_as_it_does_from_a_camera_placed_the_other_way(
    gl: Any, crowd: tifo.Crowd, camera: tifo.FreeCamera
) -> None:
    place = np.eye(4)
    cosine, sine = np.cos(0.7), np.sin(0.7)
    place[:3, :3] = 2.5 * np.array([[cosine, 0, sine], [0, 1, 0], [-sine, 0, cosine]])
    place[:3, 3] = 10.0, 2.0, -5.0
    view, projection = camera.view().astype(float), camera.projection(SIZE)
    moved = view @ np.linalg.inv(place)
    here = picture(crowd, view, projection).astype(int)
    there = picture(crowd, moved, projection, world_from_crowd=place).astype(int)
    assert (np.abs(here - there).max(axis=2) > 2).mean() < 0.002
    flat = [*np.asarray(moved).T.ravel()]
    by_columns = picture(crowd, flat, projection.T.ravel(), world_from_crowd=place).astype(int)
    np.testing.assert_array_equal(there, by_columns)


def test_two_worlds_and_who_has_the_systems(esper_world: str) -> None:
    first = tifo.spawn_crowd(SPEC, tifo.build_seats(SPEC), tifo.builtin_spectator())
    (schedule,) = first.systems()
    assert isinstance(schedule, tifo.Schedule)
    esper.add_processor(schedule)
    second = tifo.spawn_crowd(SPEC, tifo.build_seats(SPEC), tifo.builtin_spectator())
    assert first.systems() == second.systems() == []
    esper.process(1 / 30)
    assert esper.component_for_entity(first.entity, tifo.Clock) is schedule.clock
    assert esper.component_for_entity(second.entity, tifo.Clock).tick == 2
    esper.switch_world("default")
    assert first.systems() == []
    assert esper.current_world == "default"
    esper.switch_world(esper_world)


def test_releasing_leaves_no_object(gl: Any, crowd: tifo.Crowd, camera: tifo.FreeCamera) -> None:
    from tifo.engine.gl import Buffer, Program, Texture2D, collect, live_objects
    from tifo.engine.gl.api import gl as api

    collect()
    before = live_objects()
    newest = max(Buffer(1).name, Texture2D((1, 1)).name, Program(EMPTY).name)
    collect()

    def exist() -> int:
        tests = (api.glIsBuffer, api.glIsTexture, api.glIsVertexArray, api.glIsProgram)
        return sum(bool(test(name)) for test in tests for name in range(1, newest + 300))

    counted = exist()
    for _ in range(2):
        picture(crowd, camera.view(), camera.projection(SIZE))
        assert sum(live_objects().values()) > sum(before.values()) + 10
        assert exist() > counted + 10
        crowd.release_graphics()
        crowd.release_graphics()
        assert live_objects() == before
        assert exist() == counted
    gc.collect()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"view": np.diag([1.0, 2.0, 1.0, 1.0])}, "a rotation, a translation and a uniform scale"),
        ({"view": np.diag([-1.0, 1.0, 1.0, 1.0])}, "uniform scale above 0"),
        ({"view": np.eye(3)}, r"\(4, 4\) matrix for column vectors"),
        ({"view": np.full((4, 4), np.nan)}, "finite"),
        ({"projection": np.eye(4)}, "expected a perspective one"),
        ({"world_from_crowd": np.zeros((4, 4))}, "uniform scale above 0"),
        ({"world_from_crowd": "here"}, "world_from_crowd is 'here'"),
    ],
)
def test_matrices_that_can_not_be_used(
    gl: Any, crowd: tifo.Crowd, camera: tifo.FreeCamera, change: dict[str, Any], message: str
) -> None:
    given = {"view": camera.view(), "projection": camera.projection(SIZE), **change}
    with pytest.raises(ValueError, match=message):
        crowd.draw(given.pop("view"), given.pop("projection"), **given)

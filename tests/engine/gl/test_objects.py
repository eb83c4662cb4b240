from __future__ import annotations

import gc
import threading
from typing import Any

import pytest
from pyglet import gl as pgl

from tifo.engine.errors import GraphicsError
from tifo.engine.gl import (
    Buffer,
    Framebuffer,
    GpuTimer,
    Texture2D,
    check_errors,
    collect,
    gl_errors,
    live_objects,
    objects,
)

pytestmark = pytest.mark.gl


def count(kind: str) -> int:
    return live_objects().get(kind, 0)


def test_delete_frees_at_once_and_only_once() -> None:
    before = count("buffer")
    buffer = Buffer(16)
    name = buffer.name
    assert count("buffer") == before + 1
    assert pgl.glIsBuffer(name)
    buffer.delete()
    buffer.delete()
    assert count("buffer") == before
    assert not pgl.glIsBuffer(name)
    with pytest.raises(GraphicsError, match="buffer has been deleted"):
        buffer.read()


def test_dropped_objects_wait_for_collect() -> None:
    before = count("texture")
    texture: Any = Texture2D((1, 1))
    name = texture.name
    del texture
    gc.collect()
    assert pgl.glIsTexture(name)
    assert count("texture") == before + 1
    assert collect() >= 1
    assert not pgl.glIsTexture(name)
    assert count("texture") == before


def test_objects_may_be_dropped_on_another_thread() -> None:
    holder = [Buffer(16)]
    name = holder[0].name
    thread = threading.Thread(target=holder.clear)
    thread.start()
    thread.join()
    assert pgl.glIsBuffer(name)
    collect()
    assert not pgl.glIsBuffer(name)


def test_making_objects_collects_what_was_dropped() -> None:
    collect()
    before = count("buffer")
    for _ in range(20):
        Buffer(16)
    assert count("buffer") <= before + 2


def test_names_of_other_contexts_are_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    class Other:
        """Stands for a second context."""

    other: Any = Other()
    buffer = Buffer(16)
    name = buffer.name
    before = count("buffer")
    with monkeypatch.context() as patched:
        patched.setattr(objects, "current_context", lambda: other)
        buffer.delete()
        assert pgl.glIsBuffer(name)
        assert count("buffer") == before
    collect()
    assert not pgl.glIsBuffer(name)


def test_names_of_dead_contexts_are_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    class Other:
        """Stands for a context that gets closed."""

    others = [Other()]
    before = count("buffer")
    with monkeypatch.context() as patched:
        patched.setattr(objects, "require_context", lambda: others[0])
        buffer = Buffer(16)
        name = buffer.name
    others.clear()
    gc.collect()
    buffer.delete()
    assert count("buffer") == before
    assert pgl.glIsBuffer(name)  # it might be somebody else's by now
    pgl.glDeleteBuffers(1, pgl.GLuint(name))


def test_no_object_leaks_when_making_it_fails() -> None:
    before = live_objects()
    with pytest.raises(ValueError, match="texels a side"):
        Framebuffer((4, 1 << 20))
    gc.collect()
    collect()
    assert live_objects() == before


def test_errors_are_taken_and_named() -> None:
    assert gl_errors() == []
    check_errors("doing nothing")
    silent = pgl.glEnable.errcheck
    del pgl.glEnable.errcheck
    try:
        pgl.glEnable(0xFFFF)
        with pytest.raises(GraphicsError, match="GL_INVALID_ENUM while drawing the far crowd"):
            check_errors("drawing the far crowd")
    finally:
        pgl.glEnable.errcheck = silent
    assert gl_errors() == []


def test_a_faulty_call_raises_in_tests() -> None:
    with pytest.raises(pgl.GLException):
        pgl.glEnable(0xFFFF)


def test_the_timer_measures_without_waiting() -> None:
    timer = GpuTimer(history=2)
    assert timer.seconds is None
    target = Framebuffer((64, 64))
    for _ in range(5):
        with timer, target:
            target.clear((1, 1, 1, 1))
    measured = timer.wait()
    if timer.available:
        assert measured is not None
        assert 0 <= measured < 10
        assert timer.seconds == measured
    before = count("query")
    timer.delete()
    assert count("query") == before - 2 * timer.available


def test_the_timer_does_nothing_where_gl_can_not_measure(monkeypatch: pytest.MonkeyPatch) -> None:
    from tifo.engine.gl import api

    def no_bits(target: int, parameter: int, value: Any) -> None:
        value.value = 0

    monkeypatch.setitem(api.gl.__dict__, "glGetQueryiv", no_bits)
    timer = GpuTimer()
    with timer:
        pass
    assert not timer.available
    assert timer.wait() is None
    timer.delete()


class FakeContext:
    """Stands for a context that shares objects with others."""

    def __init__(self, space: Any) -> None:
        self.object_space, self.canvas = space, self


def test_deleting_on_another_thread_waits_for_the_own_one() -> None:
    before = count("buffer")
    buffer = Buffer(16)
    name = buffer.name
    thread = threading.Thread(target=buffer.delete)
    thread.start()
    thread.join()
    assert buffer.deleted
    assert pgl.glIsBuffer(name), "there is no GL on that thread"
    collect()
    assert not pgl.glIsBuffer(name)
    assert count("buffer") == before


def test_what_is_shared_is_deleted_from_any_context_of_the_group(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    real = pgl.current_context
    sibling: Any = FakeContext(real.object_space)
    buffer, target = Buffer(16), Framebuffer((1, 1))
    names = buffer.name, target.name
    with monkeypatch.context() as patched:
        patched.setattr(objects, "current_context", lambda: sibling)
        target.delete()
        buffer.delete()
        assert not pgl.glIsBuffer(names[0])
        assert pgl.glIsFramebuffer(names[1]), "framebuffers belong to one context"
    collect()
    assert not pgl.glIsFramebuffer(names[1])


def test_a_destroyed_context_takes_its_own_and_leaves_what_is_shared(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    real = pgl.current_context
    gone: Any = FakeContext(real.object_space)
    before = live_objects()
    with monkeypatch.context() as patched:
        patched.setattr(objects, "require_context", lambda: gone)
        buffer, query = Buffer(16), GpuTimer(history=1)
        name = buffer.name
    gone.canvas = None  # as pyglet leaves it, whoever still holds it
    buffer.delete()
    query.delete()
    assert not pgl.glIsBuffer(name)
    assert live_objects() == before


def test_a_group_whose_contexts_are_all_destroyed_is_forgotten(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    class Space:
        """Stands for a share group."""

    gone: Any = FakeContext(Space())
    before = count("buffer")
    with monkeypatch.context() as patched:
        patched.setattr(objects, "require_context", lambda: gone)
        buffer = Buffer(16)
        name = buffer.name
    gone.canvas = None
    buffer.delete()
    assert count("buffer") == before
    assert pgl.glIsBuffer(name)
    pgl.glDeleteBuffers(1, pgl.GLuint(name))

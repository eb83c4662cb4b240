"""Life and death of GL objects: names, the deletion queue and the live counters.

Buffers, textures, renderbuffers and programs belong to all contexts that share objects; vertex
arrays, framebuffers and queries to the one that they were made in. Python may run a finaliser on
any thread and at any time, GL only on the thread of the context, while that, or one that shares
with it, is current. So a finaliser merely queues the name, and `collect` deletes what has been
queued for the current context and thread. Creating an object collects too.
"""

from __future__ import annotations

import threading
import weakref
from collections import Counter, deque
from typing import Any

from ..errors import GraphicsError
from .api import current_context, gl, require_context

# kind -> how to make and delete one name
_GENERATED = {
    "buffer": ("glGenBuffers", "glDeleteBuffers"),
    "vertex array": ("glGenVertexArrays", "glDeleteVertexArrays"),
    "texture": ("glGenTextures", "glDeleteTextures"),
    "framebuffer": ("glGenFramebuffers", "glDeleteFramebuffers"),
    "renderbuffer": ("glGenRenderbuffers", "glDeleteRenderbuffers"),
    "query": ("glGenQueries", "glDeleteQueries"),
}

_OF_ONE_CONTEXT = ("vertex array", "framebuffer", "query")

_live: Counter[str] = Counter()
_doomed: deque[tuple[str, int, weakref.ref[Any], int]] = deque()
"""Kind, name, context or share group, and thread."""
_groups: weakref.WeakKeyDictionary[Any, weakref.WeakSet[Any]] = weakref.WeakKeyDictionary()
"""Contexts of each share group."""


class GLObject:
    """Base of the wrappers: owns one GL name of one context.

    Parameters
    ----------
    kind
        ``"buffer"``, ``"vertex array"``, ``"texture"``, ``"framebuffer"``, ``"renderbuffer"``,
        ``"query"`` or ``"program"``.
    name
        An existing GL name to own; by default a new one is generated.

    Raises
    ------
    GraphicsError
        Without a current context.
    """

    __slots__ = ("__weakref__", "_finalizer", "_kind", "_name")

    def __init__(self, kind: str, name: int | None = None) -> None:
        context = require_context()
        collect()
        if name is None:
            generated = gl.GLuint(0)
            getattr(gl, _GENERATED[kind][0])(1, generated)
            name = int(generated.value)
        self._kind = kind
        self._name = name
        owner = context if kind in _OF_ONE_CONTEXT else _group(context)
        entry = (kind, name, weakref.ref(owner), threading.get_ident())
        self._finalizer = weakref.finalize(self, _doomed.append, entry)
        self._finalizer.atexit = False
        _live[kind] += 1

    @property
    def name(self) -> int:
        """The GL name.

        Raises
        ------
        GraphicsError
            When the object has been deleted.
        """
        if self._finalizer.alive:
            return self._name
        raise GraphicsError(f"this {self._kind} has been deleted and can't be used any more")

    @property
    def deleted(self) -> bool:
        """Whether `delete` has been called."""
        return not self._finalizer.alive

    def delete(self) -> None:
        """Free the GL object now if its context is current, else when it next is; idempotent."""
        self._finalizer()
        collect()


def collect() -> int:
    """Delete what has been queued for the current context; return how many names that were.

    Names whose context no longer exists died with it and are only taken off the counters.
    """
    context, thread = current_context(), threading.get_ident()
    here = () if context is None else (context, _group(context))
    deleted = 0
    for _ in range(len(_doomed)):
        entry = _doomed.popleft()
        kind, name, reference, home = entry
        owner = reference()
        if owner is None or not _exists(owner):
            _live[kind] -= 1
        elif home == thread and any(owner is one for one in here):
            _delete(kind, name)
            _live[kind] -= 1
            deleted += 1
        else:
            _doomed.append(entry)
    return deleted


def live_objects() -> dict[str, int]:
    """Return how many objects of each kind exist, without the kinds of which there are none.

    Queued deletions still count until `collect` has run.
    """
    return {kind: count for kind, count in sorted(_live.items()) if count}


def context_exists(context: Any) -> bool:
    """Whether a context has not been destroyed, as those of closed windows are."""
    return getattr(context, "canvas", context) is not None


def _group(context: Any) -> Any:
    """What stands for all contexts that share objects with `context`."""
    group = getattr(context, "object_space", context)
    if group is not context:
        _groups.setdefault(group, weakref.WeakSet()).add(context)
    return group


def _exists(owner: Any) -> bool:
    """Whether a context exists, or any of a share group's."""
    members = _groups.get(owner)
    return context_exists(owner) if members is None else any(map(context_exists, members))


def _delete(kind: str, name: int) -> None:
    if kind == "program":
        gl.glDeleteProgram(name)
    else:
        getattr(gl, _GENERATED[kind][1])(1, gl.GLuint(name))

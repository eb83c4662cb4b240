"""How long the GPU takes for a pass."""

from __future__ import annotations

from collections import deque
from types import TracebackType
from typing import Self

from .api import gl, require_context
from .objects import GLObject

_NANOSECONDS = 1e-9


class _TimeQuery(GLObject):
    """One GL query object."""

    __slots__ = ()

    def __init__(self) -> None:
        super().__init__("query")

    def finished(self) -> bool:
        ready = gl.GLint(0)
        gl.glGetQueryObjectiv(self.name, gl.GL_QUERY_RESULT_AVAILABLE, ready)
        return bool(int(ready.value))

    def seconds(self) -> float:
        value = gl.GLuint64(0)
        gl.glGetQueryObjectui64v(self.name, gl.GL_QUERY_RESULT, value)
        return int(value.value) * _NANOSECONDS


class GpuTimer:
    """Measures passes without making anybody wait.

    The GPU runs frames behind, so the time that is known is that of an earlier frame. Where the
    driver can't measure, it does nothing and `seconds` stays None. GL allows one measurement at
    a time: timers must not nest.

    Parameters
    ----------
    history
        Measurements under way at most; further ones are left out.

    Examples
    --------
    >>> timer = GpuTimer()
    >>> with timer:
    ...     draw_crowd()
    >>> timer.seconds  # of the last frame that the GPU has finished, None before
    """

    __slots__ = ("_active", "_available", "_free", "_pending", "_seconds")

    def __init__(self, history: int = 4) -> None:
        require_context()
        bits = gl.GLint(0)
        gl.glGetQueryiv(gl.GL_TIME_ELAPSED, gl.GL_QUERY_COUNTER_BITS, bits)
        self._available = int(bits.value) > 0
        self._free = [_TimeQuery() for _ in range(history if self._available else 0)]
        self._pending: deque[_TimeQuery] = deque()
        self._active: _TimeQuery | None = None
        self._seconds: float | None = None

    @property
    def available(self) -> bool:
        """Whether the driver can measure."""
        return self._available

    @property
    def seconds(self) -> float | None:
        """The newest measurement that has finished, None before the first."""
        self._take_finished()
        return self._seconds

    def wait(self) -> float | None:
        """Wait for every measurement under way and return the last; for benchmarks."""
        while self._pending:
            self._take()
        return self._seconds

    def delete(self) -> None:
        """Free its GL objects."""
        for query in (*self._free, *self._pending):
            query.delete()
        self._free.clear()
        self._pending.clear()

    def __enter__(self) -> Self:
        """Start measuring."""
        self._take_finished()
        if self._free:
            self._active = self._free.pop()
            gl.glBeginQuery(gl.GL_TIME_ELAPSED, self._active.name)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Stop measuring."""
        if self._active is not None:
            gl.glEndQuery(gl.GL_TIME_ELAPSED)
            self._pending.append(self._active)
            self._active = None

    def _take_finished(self) -> None:
        while self._pending and self._pending[0].finished():
            self._take()

    def _take(self) -> None:
        query = self._pending.popleft()
        self._seconds = query.seconds()
        self._free.append(query)

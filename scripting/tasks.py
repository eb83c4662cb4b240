"""Coroutines in the game's time: a task runs until it awaits a signal and goes on when it comes.

There is no event loop beside the game's: nothing happens between frames, and a run is repeatable.
"""

from __future__ import annotations

import inspect
from collections.abc import Coroutine, Generator
from typing import Any

from .reports import FreedError, report
from .signals import BoundSignal, Connection, Signal, Waiter


class Task(Waiter):
    """A coroutine that the tree runs; await it for its result.

    Attributes
    ----------
    finished
        Emitted once when the coroutine returned, failed or was cancelled.
    """

    finished = Signal[()]()

    def __init__(self, tree: Any, coroutine: Coroutine[Any, Any, Any], owner: Any, cause: str):
        self._tree = tree
        self._coroutine = coroutine
        self._owner = owner
        self._cause = cause
        self._wait: Connection | None = None
        self._result: Any = None
        self._error: Exception | None = None
        self._running = False
        self._cancelled = False
        self.is_done = False

    def __repr__(self) -> str:
        """For messages."""
        return f"task {getattr(self._coroutine, '__qualname__', '')}"

    def __await__(self) -> Generator[Any, Any, Any]:
        """Its result, or the exception that ended it."""
        if not self.is_done:
            yield self.finished
        if self._error is not None:
            raise self._error
        return self._result

    @property
    def result(self) -> Any:
        """What the coroutine returned; None before."""
        return self._result

    def cancel(self) -> None:
        """Close the coroutine where it waits; its ``finally`` blocks run."""
        if self.is_done:
            return
        self._cancelled = True
        if self._wait is not None:
            self._wait.signal.drop(self._wait)
            self._wait = None
        if self._running:
            return  # it cancels itself, and is closed at its next await
        try:
            self._coroutine.close()
        except Exception as error:
            self._report(error)
        self._end(error=FreedError(f"{self!r} was cancelled"))

    def step(self) -> None:
        """Run to the first await."""
        self._go(None, None)

    def resume(self, *args: Any) -> None:
        """What it waited for has come."""
        self._wait = None
        self._go(args, None)

    def lost(self, error: FreedError) -> None:
        """What it waited for can't come any more; it is told at the next flush."""
        self._wait = None
        self._tree.defer(self._go, None, error)

    def _go(self, value: Any, error: Exception | None) -> None:
        if self.is_done:
            return
        self._running = True
        try:
            if error is not None:
                awaited = self._coroutine.throw(error)
            else:
                awaited = self._coroutine.send(value)
        except StopIteration as stop:
            self._running = False
            self._end(result=stop.value)
            return
        except Exception as raised:
            self._running = False
            self._end(error=raised)
            return
        self._running = False
        if self._cancelled:
            self.cancel()
        elif isinstance(awaited, BoundSignal):
            try:
                self._wait = awaited.wait(self)
            except FreedError as gone:
                self.lost(gone)
        else:
            wrong = TypeError(
                f"{self!r} awaited {awaited!r}; scripts can await signals and tasks, "
                "such as tree.create_timer(1.0).timeout"
            )
            self._coroutine.close()
            self._end(error=wrong)

    def _end(self, result: Any = None, error: Exception | None = None) -> None:
        self.is_done = True
        self._result, self._error = result, error
        self._tree.forget_task(self, self._owner)
        heard = bool(self.finished.connections)
        if error is not None and not heard and not self._cancelled:
            self._report(error)
        self.finished.emit()

    def _report(self, error: Exception) -> None:
        report(error, _Named(self._coroutine, self._owner), self._cause, self._owner or self)


class _Named:
    """Name and place of a coroutine, for reports."""

    def __init__(self, coroutine: Coroutine[Any, Any, Any], owner: Any) -> None:
        self.__name__ = getattr(coroutine, "__name__", "coroutine")
        self.__code__ = getattr(coroutine, "cr_code", None)
        self.__self__ = owner


def as_coroutine(result: object) -> Coroutine[Any, Any, Any] | None:
    """`result` if it is a coroutine."""
    return result if inspect.iscoroutine(result) else None

"""Calls that wait until the callbacks of a round are through."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

from .reports import report

MOST_ROUNDS = 64
"""How often calls that defer further calls are followed within one flush."""


class DeferredCalls:
    """A queue of calls; those of freed nodes are dropped."""

    __slots__ = ("_calls", "_flushing")

    def __init__(self) -> None:
        self._calls: deque[tuple[Callable[..., object], tuple[Any, ...], str, Any]] = deque()
        self._flushing = False

    def __len__(self) -> int:
        """How many calls wait."""
        return len(self._calls)

    def add(
        self, function: Callable[..., object], args: tuple[Any, ...], cause: str, owner: Any
    ) -> None:
        """Call ``function(*args)`` at the next flush; `cause` and `owner` are for reports."""
        self._calls.append((function, args, cause, owner))

    def flush(self, run: Callable[[object, Any], None]) -> None:
        """Make the calls in order, also those that they defer; `run` gets what they return.

        Calls that go on deferring are left for the next flush after 64 rounds, so that a frame
        comes to its end.
        """
        if self._flushing:
            return
        self._flushing = True
        try:
            for _ in range(MOST_ROUNDS):
                if not self._calls:
                    break
                for _ in range(len(self._calls)):
                    function, args, cause, owner = self._calls.popleft()
                    receiver = getattr(function, "__self__", None)
                    if getattr(receiver, "_freed", False) or getattr(owner, "_freed", False):
                        continue
                    try:
                        result = function(*args)
                    except Exception as error:
                        report(error, function, cause or "a deferred call", owner)
                    else:
                        if result is not None:
                            run(result, receiver if receiver is not None else owner)
        finally:
            self._flushing = False

    def clear(self) -> None:
        """Forget all calls."""
        self._calls.clear()

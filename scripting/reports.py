"""What goes wrong in a script is told, and the game goes on.

Every call of a script's code by the tree, a signal, a timer, a tween or a coroutine is guarded: an
exception becomes a `ScriptError` that names the script, the place and what was called, and goes to
the tree's report function. `KeyboardInterrupt` and `SystemExit` pass.
"""

from __future__ import annotations

import logging
import os
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ..engine.errors import TifoError

_HERE = os.path.dirname(os.path.abspath(__file__))
_LOG = logging.getLogger("tifo.scripting")


class FreedError(TifoError):
    """A node was used, or waited for, after it was freed."""


@dataclass(frozen=True, slots=True)
class ScriptError:
    """One exception in a script's code.

    Attributes
    ----------
    script
        What was called: ``Fan._process``, ``Board._on_goal``, the name of a function.
    cause
        Why it was called, for other calls than callbacks: ``signal 'goal_scored' of /root/Ball``.
    node
        Path or name of the node; empty if none is concerned.
    file, line
        Where in the script it was raised.
    error
        The exception.
    """

    script: str
    cause: str
    node: str
    file: str
    line: int
    error: Exception

    def __str__(self) -> str:
        """One line with all of it."""
        where = f" ({self.node})" if self.node else ""
        cause = f" on {self.cause}" if self.cause else ""
        kind = type(self.error).__name__
        return f"{self.script}{where}{cause}, {self.file}:{self.line}: {kind}: {self.error}"


Report = Callable[[ScriptError], None]


class LogReport:
    """Logs errors to ``tifo.scripting``: each place at its 1st, 10th, 100th, ... time."""

    __slots__ = ("_times",)

    def __init__(self) -> None:
        self._times: Counter[tuple[str, int, str]] = Counter()

    def __call__(self, report: ScriptError) -> None:
        """Log `report` unless the same was logged lately."""
        key = (report.file, report.line, type(report.error).__name__)
        self._times[key] += 1
        times = self._times[key]
        if times == 10 ** (len(str(times)) - 1):
            again = f" ({times} times so far)" if times > 1 else ""
            _LOG.error("%s%s", report, again, exc_info=report.error if times == 1 else None)


_DEFAULT: Report = LogReport()


def describe(error: Exception, function: Any, cause: str = "", owner: Any = None) -> ScriptError:
    """What is told of `error`, raised by `function`, a callback of `owner` if it has one."""
    receiver = getattr(function, "__self__", None)
    if receiver is None or isinstance(receiver, type):
        receiver = owner
    name = getattr(function, "__name__", type(function).__name__)
    is_method = getattr(function, "__self__", None) is not None
    if is_method and not isinstance(function.__self__, type):
        name = f"{type(receiver).__name__}.{name}"
    file, line = _place(error, function)
    return ScriptError(name, cause, place_of(receiver), file, line, error)


def report(error: Exception, function: Any, cause: str = "", owner: Any = None) -> None:
    """Report `error` to the tree of whom it concerns, or log it."""
    described = describe(error, function, cause, owner)
    tree = tree_of(getattr(function, "__self__", None)) or tree_of(owner)
    target: Report = _DEFAULT if tree is None else tree.report
    try:
        target(described)
    except Exception:
        _LOG.exception("the report function itself failed, on: %s", described)


def tree_of(thing: Any) -> Any:
    """The tree that a node, timer or tween belongs to, or None."""
    return getattr(thing, "_tree", None)


def freed(thing: Any) -> bool:
    """Whether `thing` is a node that was freed."""
    return bool(getattr(thing, "_freed", False))


def place_of(thing: Any) -> str:
    """Path of a node inside a tree, its name outside, the class of other things."""
    path = getattr(thing, "path", None)
    if isinstance(path, str):
        return path
    return "" if thing is None else type(thing).__name__


def _place(error: Exception, function: Any) -> tuple[str, int]:
    """File and line of the innermost script code that the exception passed through."""
    found: tuple[str, int] | None = None
    trace = error.__traceback__
    while trace is not None:
        file = trace.tb_frame.f_code.co_filename
        if os.path.dirname(os.path.abspath(file)) != _HERE:
            found = (file, trace.tb_lineno)
        trace = trace.tb_next
    if found is None:
        inner = getattr(function, "__func__", function)
        code = getattr(inner, "__code__", None) or getattr(inner, "cr_code", None)
        found = (code.co_filename, code.co_firstlineno) if code else ("unknown", 0)
    return found

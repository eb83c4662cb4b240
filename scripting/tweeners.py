"""The steps of tweens: changing an attribute, calling with a changing value, waiting, calling."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from .easing import CURVES, Ease, Trans
from .reports import freed
from .signals import Signal
from .vectors import Quaternion, Vector3

if TYPE_CHECKING:
    from .tween import Tween


def seconds_of(name: str, value: Any) -> float:
    """`value` as seconds; ValueError if it is no time."""
    if not isinstance(value, (int, float)) or not math.isfinite(value) or value < 0.0:
        raise ValueError(f"{name} is {value!r}, expected seconds >= 0")
    return float(value)


class Tweener:
    """One step of a tween."""

    finished = Signal[()]()

    def __init__(self, tween: Tween) -> None:
        self._tween = tween
        self._tree = tween._tree
        self._delay = 0.0
        self._elapsed = 0.0
        self._done = False

    def start(self) -> None:
        """The step begins."""
        self._elapsed, self._done = 0.0, False

    def step(self, delta: float) -> float | None:
        """Let time pass; the seconds left over when it has finished, None while it runs."""
        if self._done:
            return delta
        if freed(self._subject()):
            self._done = True
            self.finished.emit()
            return delta
        self._elapsed += delta
        left = self._elapsed - self._delay - self._duration()
        self._move()
        # A hair is allowed for, or steps of 1/60 s would need one more than they should.
        if left < -1e-9:
            return None
        self._done = True
        self.finished.emit()
        return max(left, 0.0)

    def _duration(self) -> float:
        return 0.0

    def _subject(self) -> object:
        """What it acts on; the step is over when that is freed."""
        return None

    def _move(self) -> None:
        """Do what is to be done now."""

    def _set_delay(self, seconds: float) -> None:
        self._delay = seconds_of("seconds", seconds)


class IntervalTweener(Tweener):
    """Waits."""

    def __init__(self, tween: Tween, seconds: float) -> None:
        super().__init__(tween)
        self._set_delay(seconds)


class CallbackTweener(Tweener):
    """Calls a function."""

    def __init__(self, tween: Tween, callback: Callable[[], object]) -> None:
        super().__init__(tween)
        if not callable(callback):
            raise ValueError(f"callback is {callback!r}, expected something callable")
        self._callback = callback

    def set_delay(self, seconds: float) -> Self:
        """Call it that much later."""
        self._set_delay(seconds)
        return self

    def _subject(self) -> object:
        return getattr(self._callback, "__self__", None)

    def _move(self) -> None:
        if self._elapsed - self._delay >= -1e-9:
            self._tree.call(self._callback, cause="a tween", owner=self._tween.bound_node)


class _ValueTweener(Tweener):
    """Goes from one value to another along a curve."""

    def __init__(self, tween: Tween, seconds: float) -> None:
        super().__init__(tween)
        self._seconds = seconds_of("seconds", seconds)
        self._trans: Trans | None = None
        self._ease: Ease | None = None

    def set_trans(self, trans: Trans) -> Self:
        """Its transition, if not that of the tween."""
        self._trans = Trans(trans)
        return self

    def set_ease(self, ease: Ease) -> Self:
        """Its easing, if not that of the tween."""
        self._ease = Ease(ease)
        return self

    def set_delay(self, seconds: float) -> Self:
        """Begin that much later than its step."""
        self._set_delay(seconds)
        return self

    def _duration(self) -> float:
        return self._seconds

    def _share(self) -> float:
        """Share of the change that is done by now; exactly 1 at the end."""
        time = self._elapsed - self._delay
        if time >= self._seconds - 1e-9:
            return 1.0
        trans = self._tween.trans if self._trans is None else self._trans
        ease = self._tween.ease if self._ease is None else self._ease
        return CURVES[trans][ease](max(time, 0.0) / self._seconds)


class PropertyTweener(_ValueTweener):
    """Changes an attribute, or a part of one: ``"position:x"``."""

    def __init__(
        self, tween: Tween, target: object, attribute: str, final: Any, seconds: float
    ) -> None:
        super().__init__(tween, seconds)
        self._target = target
        self._parts = attribute.split(":") if isinstance(attribute, str) else [""]
        if not all(self._parts):
            raise ValueError(f"attribute is {attribute!r}, expected 'position' or 'position:x'")
        try:
            now = self._get()
        except AttributeError as error:
            raise ValueError(f"attribute is {attribute!r}: {error}") from None
        self._given = match(now, final, attribute)
        self._from: Any = None
        self._relative = False
        self._initial: Any = now
        self._final = self._given
        self._begun = False

    def from_(self, value: Any) -> Self:
        """Begin at `value` and not where the attribute is then."""
        self._from = match(self._given, value, ":".join(self._parts))
        return self

    def from_current(self) -> Self:
        """Begin at the attribute's value of now."""
        return self.from_(self._get())

    def as_relative(self) -> Self:
        """The final value is a change, added to the first one."""
        self._relative = True
        return self

    def start(self) -> None:
        """The step begins."""
        super().start()
        self._begun = False

    def _subject(self) -> object:
        return self._target

    def _move(self) -> None:
        if self._elapsed < self._delay:
            return
        if not self._begun:
            self._begun = True
            self._initial = self._get() if self._from is None else self._from
            self._final = added(self._initial, self._given) if self._relative else self._given
        share = self._share()
        self._set(self._final if share == 1.0 else between(self._initial, self._final, share))

    def _get(self) -> Any:
        value: Any = self._target
        for part in self._parts:
            value = getattr(value, part)
        return value

    def _set(self, value: Any) -> None:
        """Set a part; tuples on the way are replaced by changed ones."""
        holders: list[Any] = [self._target]
        for part in self._parts[:-1]:
            holders.append(getattr(holders[-1], part))
        for holder, part in zip(reversed(holders), reversed(self._parts), strict=True):
            if not isinstance(holder, tuple):
                setattr(holder, part, value)
                return
            value = holder._replace(**{part: value})  # type: ignore[attr-defined]


class MethodTweener(_ValueTweener):
    """Calls a function with a changing value."""

    def __init__(
        self,
        tween: Tween,
        method: Callable[[Any], object],
        initial: Any,
        final: Any,
        seconds: float,
    ) -> None:
        super().__init__(tween, seconds)
        if not callable(method):
            raise ValueError(f"method is {method!r}, expected something callable")
        self._method = method
        self._initial, self._final = initial, match(initial, final, "final")

    def _subject(self) -> object:
        return getattr(self._method, "__self__", None)

    def _move(self) -> None:
        if self._elapsed >= self._delay:
            share = self._share()
            value = self._final if share == 1.0 else between(self._initial, self._final, share)
            self._tree.call(self._method, value, cause="a tween", owner=self._tween.bound_node)


class SubtweenTweener(Tweener):
    """Runs another tween as a step."""

    def __init__(self, tween: Tween, inner: Tween) -> None:
        super().__init__(tween)
        self._inner = inner

    def set_delay(self, seconds: float) -> Self:
        """Begin that much later."""
        self._set_delay(seconds)
        return self

    def start(self) -> None:
        """The step begins, and the inner tween from its beginning."""
        super().start()
        self._inner.stop()
        self._inner.play()

    def step(self, delta: float) -> float | None:
        """Let time pass."""
        if self._done:
            return delta
        before = self._elapsed
        self._elapsed += delta
        if self._elapsed < self._delay:
            return None
        left = self._inner.run_for(self._elapsed - max(before, self._delay))
        if left is None:
            return None
        self._done = True
        self.finished.emit()
        return left


def match(now: Any, value: Any, what: str) -> Any:
    """`value` in the type of `now`; ValueError if it has none that can be interpolated."""
    try:
        if isinstance(now, (Vector3, Quaternion)):
            return type(now).of(value)
        if isinstance(now, np.ndarray):
            return np.broadcast_to(np.asarray(value, dtype=float), now.shape)
        if isinstance(now, (int, float)) and isinstance(value, (int, float)):
            return float(value) if isinstance(now, float) else value
        if isinstance(now, tuple) and isinstance(value, (tuple, list)) and len(now) == len(value):
            return tuple(match(a, b, what) for a, b in zip(now, value, strict=True))
        if operator.is_(type(now), type(value)):
            between(now, value, 0.5)
            return value
    except (TypeError, ValueError):
        pass
    raise ValueError(f"{what} can't go from {now!r} to {value!r}; expected a {type(now).__name__}")


def between(a: Any, b: Any, share: float) -> Any:
    """The value at `share` of the way: whole numbers rounded, rotations on the shortest way."""
    if isinstance(a, Quaternion):
        return a.slerp(b, share)
    if isinstance(a, bool):
        return a if share < 0.5 else b
    if isinstance(a, int) and isinstance(b, int):
        return round(a + (b - a) * share)
    if type(a) is tuple:
        return tuple(between(x, y, share) for x, y in zip(a, b, strict=True))
    return a + (b - a) * share


def added(a: Any, change: Any) -> Any:
    """`a` with `change` on top; for rotations, turned further."""
    if isinstance(a, Quaternion):
        return a * change
    if type(a) is tuple:
        return tuple(added(x, y) for x, y in zip(a, change, strict=True))
    return a + change

"""Signals: declared on a class with their types, connected and awaited on its instances.

.. code:: python

    class Ball(Node3D):
        goal_scored = Signal[str, int]()

    ball.goal_scored.connect(board.show)
    ball.goal_scored.emit("home", 2)
    team, score = await ball.goal_scored
"""

from __future__ import annotations

import inspect
import sys
from abc import ABC, abstractmethod
from collections.abc import Callable, Generator
from typing import Any, Generic, Self, TypeVar, TypeVarTuple, get_args, overload

from .reports import FreedError, place_of, report, tree_of

Ts = TypeVarTuple("Ts")
Rest = TypeVarTuple("Rest")
T = TypeVar("T")
T2 = TypeVar("T2")


class Signal(Generic[*Ts]):
    """Declaration of a signal in a class body: ``scored = Signal[str, int]()``.

    A signal without arguments is ``Signal[()]()``.
    """

    def __init__(self) -> None:
        self.name = ""

    def __set_name__(self, owner: type, name: str) -> None:
        """Called by Python with the name in the class."""
        self.name = name

    @property
    def types(self) -> tuple[Any, ...]:
        """Types of its arguments."""
        return get_args(getattr(self, "__orig_class__", None))

    @overload
    def __get__(self, instance: None, owner: type) -> Self: ...
    @overload
    def __get__(self, instance: object, owner: type) -> BoundSignal[*Ts]: ...
    def __get__(self, instance: object | None, owner: type) -> Any:
        """The signal of one instance, made when it is first asked for."""
        if instance is None:
            return self
        bound = BoundSignal[*Ts](instance, self.name, len(self.types))
        instance.__dict__[self.name] = bound
        return bound


class Connection:
    """One receiver of one signal.

    Attributes
    ----------
    slot
        What is called.
    binds
        Arguments that are added after those of the signal.
    one_shot, deferred, persist
        Disconnected before its first call; called when the tree flushes; saved in scene files.
    live
        Whether it is still connected.
    """

    __slots__ = ("binds", "deferred", "live", "one_shot", "persist", "plain", "signal", "slot")

    def __init__(
        self,
        signal: Any,
        slot: Callable[..., object],
        binds: tuple[Any, ...] = (),
        *,
        one_shot: bool = False,
        deferred: bool = False,
        persist: bool = False,
    ) -> None:
        self.signal, self.slot, self.binds = signal, slot, binds
        self.one_shot, self.deferred, self.persist = one_shot, deferred, persist
        self.live = True
        self.plain = not (binds or one_shot or deferred)

    def cut(self) -> None:
        """End it: it isn't called any more, not even by an emission under way."""
        self.live = self.plain = False


class Waiter(ABC):
    """What waits for a signal: it is resumed with the arguments, or told that none will come."""

    @abstractmethod
    def resume(self, *args: Any) -> None:
        """The signal was emitted."""

    @abstractmethod
    def lost(self, error: FreedError) -> None:
        """The signal will never be emitted."""


class BoundSignal(Generic[*Ts]):
    """The signal of one instance."""

    def __init__(self, owner: object, name: str, count: int) -> None:
        self.owner, self.name = owner, name
        self._count = count
        self._by_slot: dict[Any, Connection] = {}
        self._snapshot: tuple[Connection, ...] | None = ()
        self._closed = False

    def __repr__(self) -> str:
        """For messages."""
        return f"signal '{self.name}' of {place_of(self.owner)}"

    @overload
    def connect(
        self,
        slot: Callable[[*Ts], object],
        *,
        one_shot: bool = False,
        deferred: bool = False,
        persist: bool = False,
    ) -> None: ...
    @overload
    def connect(
        self,
        slot: Callable[..., object],
        *,
        binds: tuple[Any, ...],
        one_shot: bool = False,
        deferred: bool = False,
        persist: bool = False,
    ) -> None: ...
    def connect(
        self,
        slot: Callable[..., object],
        *,
        binds: tuple[Any, ...] = (),
        one_shot: bool = False,
        deferred: bool = False,
        persist: bool = False,
    ) -> None:
        """Call `slot` at every emission from now on.

        Parameters
        ----------
        slot
            Anything callable, also an ``async def``, which then runs as a task of its node.
        binds
            Arguments added after those of the signal.
        one_shot
            Disconnect before the first call.
        deferred
            Call when the tree flushes its deferred calls, not inside `emit`.
        persist
            Save the connection in scene files; needs a method of a node.

        Raises
        ------
        ValueError
            If `slot` is connected already, or can't take the arguments.
        FreedError
            If the signal's or the slot's node was freed.
        """
        self._check_slot(slot, len(binds))
        receiver = getattr(slot, "__self__", None)
        if self._closed or getattr(receiver, "_freed", False):
            gone = self.owner if self._closed else receiver
            raise FreedError(f"{self!r} can't be connected: {place_of(gone)} was freed")
        key = _key(slot)
        if key in self._by_slot:
            raise ValueError(f"{_name(slot)} is connected to {self!r} already")
        self._add(
            key,
            Connection(
                self, slot, tuple(binds), one_shot=one_shot, deferred=deferred, persist=persist
            ),
        )

    def disconnect(self, slot: Callable[..., object]) -> None:
        """Don't call `slot` any more, not even in an emission under way. ValueError if it isn't."""
        connection = self._by_slot.get(_key(slot))
        if connection is None:
            raise ValueError(f"{_name(slot)} is not connected to {self!r}")
        self._remove(connection)

    def is_connected(self, slot: Callable[..., object]) -> bool:
        """Whether `slot` is connected."""
        return _key(slot) in self._by_slot

    @property
    def connections(self) -> tuple[Connection, ...]:
        """What is connected, in the order of connecting."""
        if self._snapshot is None:
            self._snapshot = tuple(self._by_slot.values())
        return self._snapshot

    def emit(self, *args: *Ts) -> None:
        """Call what is connected now, in the order of connecting.

        What is connected meanwhile is called at the next emission; what is disconnected meanwhile
        is not called. Exceptions are reported and the next slot is called.

        Raises
        ------
        TypeError
            If the number of arguments is not that of the declaration.
        """
        if len(args) != self._count:
            raise TypeError(f"{self!r} takes {self._count} arguments, got {len(args)}: {args!r}")
        connections = self._snapshot
        if connections is None:
            connections = self.connections
        for connection in connections:
            if connection.plain:
                try:
                    result = connection.slot(*args)
                except Exception as error:
                    self._failed(connection.slot, error)
                else:
                    if result is not None:
                        self._returned(connection.slot, result)
            elif connection.live:
                self._emit_special(connection, args)

    # mypy takes an empty pack for a subtype of every other.
    @overload
    def __await__(self: BoundSignal[()]) -> Generator[Any, Any, None]: ...
    @overload
    def __await__(self: BoundSignal[T]) -> Generator[Any, Any, T]: ...
    @overload
    def __await__(
        self: BoundSignal[T, T2, *Rest],
    ) -> Generator[Any, Any, tuple[T, T2, *Rest]]: ...
    def __await__(self) -> Generator[Any, Any, Any]:
        """Wait for the next emission: None, its argument, or a tuple of its arguments.

        Raises
        ------
        FreedError
            If the signal's node is freed meanwhile, or was.
        """
        args: tuple[Any, ...] = yield self
        if len(args) > 1:
            return args
        return args[0] if args else None

    def retype(self, count: int) -> None:
        """Take another number of arguments: the declaration was changed in a running game."""
        self._count = count

    def wait(self, waiter: Waiter) -> Connection:
        """Resume `waiter` once at the next emission; FreedError if there can't be one."""
        if self._closed:
            raise FreedError(f"{self!r} was awaited, but {place_of(self.owner)} was freed")
        connection = Connection(self, waiter.resume, one_shot=True)
        self._add(connection, connection)
        return connection

    def drop(self, connection: Connection) -> None:
        """End one connection, if it hasn't ended."""
        if connection.live:
            self._remove(connection)

    def close(self) -> None:
        """Cut all connections, for ever: the owner was freed. Who waits gets a `FreedError`."""
        self._closed = True
        for connection in self.connections:
            self._remove(connection)
            waiter = getattr(connection.slot, "__self__", None)
            if isinstance(waiter, Waiter):
                waiter.lost(FreedError(f"{self!r} was awaited, but its owner was freed"))

    def _add(self, key: Any, connection: Connection) -> None:
        self._by_slot[key] = connection
        self._snapshot = None
        incoming = getattr(getattr(connection.slot, "__self__", None), "_incoming", None)
        if incoming is not None:
            incoming[connection] = None

    def _remove(self, connection: Connection) -> None:
        connection.cut()
        key = connection if connection in self._by_slot else _key(connection.slot)
        self._by_slot.pop(key, None)
        self._snapshot = None
        incoming = getattr(getattr(connection.slot, "__self__", None), "_incoming", None)
        if incoming is not None:
            incoming.pop(connection, None)

    def _emit_special(self, connection: Connection, args: tuple[Any, ...]) -> None:
        if connection.one_shot:
            self._remove(connection)
        slot, values = connection.slot, (*args, *connection.binds)
        if connection.deferred:
            tree = tree_of(getattr(slot, "__self__", None)) or tree_of(self.owner)
            if tree is None:
                error = ValueError("a deferred connection needs a tree, and neither side is in one")
                self._failed(slot, error)
            else:
                tree.defer(slot, *values, cause=repr(self))
            return
        try:
            result = slot(*values)
        except Exception as error:
            self._failed(slot, error)
        else:
            if result is not None:
                self._returned(slot, result)

    def _failed(self, slot: Callable[..., object], error: Exception) -> None:
        # Handlers that emit in a circle: only the outermost emission may tell and go on, or each
        # of a thousand levels would try its other handlers, and theirs, and never come to an end.
        if isinstance(error, RecursionError) and _is_nested():
            raise error
        report(error, slot, repr(self), self.owner)

    def _returned(self, slot: Callable[..., object], result: object) -> None:
        if not inspect.iscoroutine(result):
            return
        receiver = getattr(slot, "__self__", None)
        tree = tree_of(receiver) or tree_of(self.owner)
        if tree is None:
            result.close()
            self._failed(slot, ValueError("an async handler needs a tree, and neither is in one"))
        else:
            owner = receiver if tree_of(receiver) is not None else self.owner
            tree.start(result, owner=owner, cause=repr(self))

    def _check_slot(self, slot: Callable[..., object], binds: int) -> None:
        if not callable(slot):
            raise ValueError(f"slot is {slot!r}, expected something callable")
        try:
            signature = inspect.signature(slot)
        except (TypeError, ValueError):
            return  # some built-in functions don't tell
        try:
            signature.bind(*[None] * (self._count + binds))
        except TypeError as error:
            with_binds = f" and {binds} bound ones" if binds else ""
            raise ValueError(
                f"{_name(slot)}{signature} can't take the {self._count} arguments of "
                f"{self!r}{with_binds}: {error}"
            ) from None


def emit_if_made(owner: object, name: str, *args: Any) -> None:
    """Emit a signal of `owner` if anybody ever asked for it; cheap otherwise."""
    bound = owner.__dict__.get(name)
    if isinstance(bound, BoundSignal):
        bound.emit(*args)


def _is_nested() -> bool:
    """Whether the emission that calls this runs inside another one."""
    codes = (BoundSignal.emit.__code__, BoundSignal._emit_special.__code__)
    frame = sys._getframe(2)
    if frame.f_code is codes[1] and frame.f_back is not None:
        frame = frame.f_back
    outer = frame.f_back
    while outer is not None:
        if outer.f_code in codes:
            return True
        outer = outer.f_back
    return False


def _key(slot: Callable[..., object]) -> Any:
    """What tells slots apart; methods are new objects at every look, but equal."""
    try:
        hash(slot)
    except TypeError:
        return id(slot)
    return slot


def _name(slot: Callable[..., object]) -> str:
    return getattr(slot, "__qualname__", None) or repr(slot)

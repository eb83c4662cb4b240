"""Godot's view of a stream with a tree of controllers."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from ...engine.animation.controllers import Controller, OneShotRequest, load_controller
from ...engine.streams.pool import Stream, StreamPool
from ...systems.simulation import Simulation
from ..exports import export
from ..resources import file_of
from ..signals import Signal
from .stream_node import StreamNode

PREFIX = "parameters/"
_CALLED_HERE = {
    "blend_position": "position",
    "blend_amount": "amount",
    "add_amount": "amount",
    "internal_active": "active",
}
"""Godot's names of parameters that controllers call otherwise."""


class AnimationTree(StreamNode):
    """A stream of the crowd above that plays a tree of controllers.

    Parameters are read and set by their path, as in Godot: ``tree["parameters/mood/blend_amount"]
    = 0.4``. After ``parameters/`` comes the path that the stream pool knows (docs/controllers.md);
    ``blend_position``, ``blend_amount``, ``add_amount``, ``conditions/...`` and ``playback`` are
    understood as well. What is set counts from the next pose tick on.

    Attributes
    ----------
    tree_root
        The tree, if it is made by code.
    controller
        File of the tree, if it isn't.
    active
        Whether it plays.
    speed_scale
        How fast time passes in the tree.
    state_started
        Emitted with path and name when a state machine enters a state.
    state_finished
        Emitted with path and name when a state is left and no longer seen.
    """

    state_started = Signal[str, str]()
    state_finished = Signal[str, str]()

    tree_root: Controller | None = None
    controller: str = export(default="", changed="_tree_changed")
    active: bool = export(default=True, changed="_active_changed")
    speed_scale: float = export(default=1.0, range=(-100, 100), changed="_speed_changed")

    def _prepare(self) -> None:
        super()._prepare()
        self._states: dict[str, tuple[str | None, str | None]] = {}

    def __getitem__(self, path: str) -> Any:
        """A parameter at ``parameters/...``, else the node at a path.

        Raises
        ------
        KeyError
            If there is no such parameter (near ones are named) or node.
        """
        if not path.startswith(PREFIX):
            return super().__getitem__(path)
        own = _own_path(path)
        pool, stream = self.pool, self.stream
        if own == "playback" or own.endswith("/playback"):
            return StateMachinePlayback(self, own.removesuffix("playback").removesuffix("/"))
        try:
            return pool.get(stream, own)
        except ValueError as error:
            raise self._unknown(path, error) from None

    def __setitem__(self, path: str, value: Any) -> None:
        """Set a parameter.

        Raises
        ------
        KeyError
            If there is no such parameter; near ones are named.
        ValueError
            For a value that it can't have.
        """
        if not path.startswith(PREFIX):
            raise KeyError(f"'{path}' is no parameter; they begin with '{PREFIX}'")
        own = _own_path(path)
        pool, stream = self.pool, self.stream
        if own not in pool.parameters(stream):
            try:
                pool.set(stream, own, value)
            except ValueError as error:
                raise self._unknown(path, error) from None
        pool.set(stream, own, value)

    def set_parameter(self, path: str, value: Any) -> None:
        """The same as ``tree[path] = value``, for tweens and deferred calls."""
        self[path] = value

    @property
    def parameters(self) -> dict[str, Any]:
        """All parameters by path, with their values."""
        stream = self.stream
        found = self.pool.parameters(stream).items()
        return {f"{PREFIX}{path}": value for path, value in found}

    def fire(self, one_shot: str = "") -> None:
        """Let the one-shot at a path play once; the root if the path is empty."""
        path = f"{one_shot}/request" if one_shot else "request"
        self[f"{PREFIX}{path}"] = OneShotRequest.FIRE

    def _make(self, pool: StreamPool) -> Stream:
        stream = pool.add(self._root(), speed=self.speed_scale)
        if not self.active:
            pool.stop(stream)
        self._states = _states_of(pool, stream)
        return stream

    def _root(self) -> Controller:
        if self.tree_root is not None:
            return self.tree_root
        if not self.controller:
            raise ValueError(f"{self!r} has neither a tree_root nor a controller file")
        return load_controller(Path(file_of(self.controller)))

    def _sources(self) -> Iterable[tuple[str, Callable[[], object]]]:
        return () if self.tree_root is not None else ((self.controller, self._tree_changed),)

    def _tree_changed(self) -> None:
        running = self._running()
        if running is not None:
            running[0].play(running[1], self._root())
            self._states = _states_of(*running)

    def _active_changed(self) -> None:
        running = self._running()
        if running is not None:
            (running[0].run if self.active else running[0].stop)(running[1])

    def _speed_changed(self) -> None:
        running = self._running()
        if running is not None:
            running[0].speed[running[1].row] = self.speed_scale

    def _after_tick(self, simulation: Simulation) -> None:
        running = self._running()
        if running is None or not {"state_started", "state_finished"} & self.__dict__.keys():
            return
        pool, stream = running
        earlier, self._states = self._states, _states_of(pool, stream)
        for path, now in self._states.items():
            before = earlier.get(path, now)
            if before == now:
                continue
            gone = {state for state in before if state is not None} - set(now)
            for state in sorted(gone):
                self.state_finished.emit(path, state)
            if now[0] != before[0] and now[0] is not None:
                self.state_started.emit(path, now[0])

    def _unknown(self, path: str, error: ValueError) -> KeyError:
        if "can only be read" in str(error):
            return KeyError(f"'{path}' can only be read")
        known = [*self.parameters]
        near = get_close_matches(path, known, cutoff=0.5) or known[:8]
        return KeyError(f"no parameter '{path}'; near: {', '.join(near) or 'there are none'}")


class StateMachinePlayback:
    """Godot's handle of a state machine: ``tree["parameters/playback"]``."""

    def __init__(self, tree: AnimationTree, path: str) -> None:
        self._tree, self._path = tree, path
        tree.pool.machine_states(tree.stream, path)

    def travel(self, to: str) -> None:
        """Go to a state by the fewest transitions, or jump if none lead there.

        ValueError if there is no such state.
        """
        self._tree.pool.travel(self._tree.stream, self._path, to)

    def start(self, state: str) -> None:
        """Be in a state at once, which starts anew; ValueError if there is no such state."""
        self._tree.pool.start_state(self._tree.stream, self._path, state)

    def is_playing(self) -> bool:
        """Whether its stream runs."""
        return bool(self._tree.pool.running[self._tree.stream.row])

    def get_current_node(self) -> str:
        """Name of the current state."""
        return str(self._get("current"))

    def get_fading_from_node(self) -> str:
        """Name of the state that is blended from; empty without a blend."""
        return self._get("fading_from") or ""

    def get_current_play_position(self) -> float:
        """Seconds in the current state."""
        return float(self._get("position"))

    def _get(self, what: str) -> Any:
        path = f"{self._path}/{what}" if self._path else what
        return self._tree.pool.get(self._tree.stream, path)


def _states_of(pool: StreamPool, stream: Stream) -> dict[str, tuple[str | None, str | None]]:
    """Current state of each machine, and the one that it fades from."""
    found = {}
    for path in pool.machines(stream):
        prefix = f"{path}/" if path else ""
        found[path] = (
            pool.get(stream, f"{prefix}current"),
            pool.get(stream, f"{prefix}fading_from"),
        )
    return found


def _own_path(path: str) -> str:
    """``parameters/mood/blend_amount`` as the pool calls it: ``mood/amount``."""
    parts = path.removeprefix(PREFIX).split("/")
    if len(parts) > 1 and parts[-2] == "conditions":
        del parts[-2]
    parts[-1] = _CALLED_HERE.get(parts[-1], parts[-1])
    return "/".join(parts)

"""The node that owns a simulation and lets it run with the tree's ticks."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import fields
from typing import Any, Protocol, TypeVar

from ...components.team import MOST_SIDES
from ...engine.behaviour.events import Event
from ...engine.behaviour.table_file import TABLES, load_table
from ...engine.crowd.bowl import MAX_SEATS
from ...engine.crowd.spec import CrowdSpec, Fans, Layout, Offsets, Parties, Poses
from ...engine.crowd.stand import MOST_ROWS
from ...systems.crowd import Crowd as CrowdColumns
from ...systems.simulation import Simulation
from ...systems.tables import exchange_table
from ..exports import export
from ..lifecycle import ancestors
from ..node import Node
from ..node3d import Node3D
from ..resources import file_of, missing
from ..signals import Signal

N = TypeVar("N", bound=Node)

# `Node` has children of another kind.
_RENAMED = {"children": "child_share", "old": "old_share"}


class TickListener(Protocol):
    """A node that is told of every pose tick of its stadium."""

    def _pose_tick(self, simulation: Simulation) -> None: ...


class Stadium(Node3D):
    """A stadium with its crowd: a `Simulation` that runs while the node's callbacks do.

    It is built when it is first asked for, at the latest when the node gets ready, and built anew
    when an export of the group "Crowd" changes. Those exports are fields of `CrowdSpec`; the
    shares of children and old people are called `child_share` and `old_share` here. Its place in
    the world is where the middle of the pitch is.

    Attributes
    ----------
    rebuilt
        Emitted when exports changed, so that what was kept of the old crowd is stale.
    """

    rebuilt = Signal[()]()

    layout: Layout = export(default="bowl", group="Crowd", changed="_spec_changed")
    seats: int = export(
        default=65_000, range=(1, MAX_SEATS), group="Crowd", changed="_spec_changed"
    )
    rows: int = export(default=10, range=(1, MOST_ROWS), group="Crowd", changed="_spec_changed")
    columns: int = export(default=20, range=(1, MOST_ROWS), group="Crowd", changed="_spec_changed")
    step: float = export(default=1.5, range=(0.3, 10), group="Crowd", changed="_spec_changed")
    rise: float = export(default=2.0, range=(0, 10), group="Crowd", changed="_spec_changed")
    depth: float = export(default=2.0, range=(0.3, 10), group="Crowd", changed="_spec_changed")
    occupancy: float = export(default=0.96, range=(0, 1), group="Crowd", changed="_spec_changed")
    occupied: tuple[str, ...] = export(default=(), group="Crowd", changed="_spec_changed")
    empty: tuple[str, ...] = export(default=(), group="Crowd", changed="_spec_changed")
    sides: int = export(default=2, range=(1, MOST_SIDES), group="Crowd", changed="_spec_changed")
    neutrals: float = export(default=0.03, range=(0, 1), group="Crowd", changed="_spec_changed")
    away_share: float = export(default=0.05, range=(0, 1), group="Crowd", changed="_spec_changed")
    fans: Fans = export(default="away block", group="Crowd", changed="_spec_changed")
    ultras: float = export(default=0.05, range=(0, 1), group="Crowd", changed="_spec_changed")
    child_share: float = export(default=0.06, range=(0, 1), group="Crowd", changed="_spec_changed")
    old_share: float = export(default=0.1, range=(0, 1), group="Crowd", changed="_spec_changed")
    women: float = export(default=0.4, range=(0, 1), group="Crowd", changed="_spec_changed")
    parties: Parties = export(default="football", group="Crowd", changed="_spec_changed")
    behaviour: str = export(default="sport", group="Crowd", changed="_spec_changed")
    embarrassment: float = export(
        default=0.25, range=(0, 1), group="Crowd", changed="_spec_changed"
    )
    latecomers: float = export(default=0.0, range=(0, 1), group="Crowd", changed="_spec_changed")
    stewards: int = export(default=0, range=(0, 1000), group="Crowd", changed="_spec_changed")
    walking: bool = export(default=False, group="Crowd", changed="_spec_changed")
    props: float = export(default=0.35, range=(0, 1), group="Crowd", changed="_spec_changed")
    tint: float = export(default=1.0, range=(0, 1), group="Crowd", changed="_spec_changed")
    casting: bool = export(default=True, group="Crowd", changed="_spec_changed")
    streams: int = export(default=256, range=(1, 256), group="Crowd", changed="_spec_changed")
    spare_streams: int = export(default=16, range=(0, 256), group="Crowd", changed="_spec_changed")
    history: int = export(default=60, range=(2, 254), group="Crowd", changed="_spec_changed")
    slots: int = export(default=800, range=(0, 8192), group="Crowd", changed="_spec_changed")
    uniques: int = export(default=64, range=(0, 2048), group="Crowd", changed="_spec_changed")
    rest_idle: bool = export(default=False, group="Crowd", changed="_spec_changed")
    poses: Poses = export(default="streams", group="Crowd", changed="_spec_changed")
    offsets: Offsets = export(default="normal", group="Crowd", changed="_spec_changed")
    seed: int = export(default=1, range=(0, 2**63 - 1), group="Crowd", changed="_spec_changed")
    lod: bool = export(default=True, group="Crowd", changed="_spec_changed")
    character: str = export(default="", group="Crowd", changed="_spec_changed")
    motions: tuple[str, ...] = export(default=(), group="Crowd", changed="_spec_changed")

    def _prepare(self) -> None:
        super()._prepare()
        self._simulation: Simulation | None = None
        self._listeners: dict[TickListener, None] = {}

    @property
    def spec(self) -> CrowdSpec:
        """What its exports ask for.

        Raises
        ------
        ValueError
            If they contradict each other.
        """
        values = {
            field.name: getattr(self, _RENAMED.get(field.name, field.name))
            for field in fields(CrowdSpec)
        }
        values["character"] = _file(self.character)
        values["behaviour"] = _file(self.behaviour)
        values["motions"] = tuple(_file(motion) for motion in self.motions)
        return CrowdSpec(**values)

    @property
    def simulation(self) -> Simulation:
        """The simulation, built if it isn't yet.

        Raises
        ------
        ValueError, AssetError
            If the exports contradict each other or a file can't be used.
        """
        if self._freed:
            raise ValueError(f"{self!r} has no simulation any more")
        if self._simulation is None:
            self._simulation = Simulation(self.spec)
        return self._simulation

    @property
    def crowd(self) -> CrowdColumns:
        """The crowd's entity and columns."""
        return self.simulation.crowd

    def send(self, event: Event) -> None:
        """Let the crowd see an event at the next tick."""
        self.simulation.send(event)

    @classmethod
    def _check_names(cls, name: str, value: Any) -> None:
        if name == "behaviour" and value not in TABLES:
            _check_file(name, value, f", and no table of that name ({', '.join(TABLES)})")
        elif name == "character" and value:
            _check_file(name, value)
        elif name == "motions":
            for path in value:
                _check_file(name, path)

    def _sources(self) -> Iterable[tuple[str, Callable[[], object]]]:
        yield from ((path, self._body_changed) for path in (self.character, *self.motions))
        if self.behaviour not in TABLES:
            yield self.behaviour, self._table_changed

    def _body_changed(self) -> None:
        if self._simulation is not None:
            fresh = Simulation(self.spec)  # what can't be built leaves the old one running
            self._close()
            self._simulation = fresh
            self.rebuilt.emit()

    def _table_changed(self) -> None:
        simulation, table = self._simulation, load_table(_file(self.behaviour))
        if simulation is not None:
            with simulation.active():
                is_taken = exchange_table(simulation.crowd, table)
            if not is_taken:
                self._body_changed()

    def _spec_changed(self) -> None:
        if self._simulation is not None:
            self._close()
            self.rebuilt.emit()

    def _close(self) -> None:
        if self._simulation is not None:
            self._simulation.close()
            self._simulation = None

    def _made_ready(self) -> None:
        # Asked for here, so that what can't be built is told at once and not in a frame.
        try:
            _ = self.simulation
        except Exception as error:
            self._failed(error)

    def _step(self, delta: float, *, physics: bool) -> None:
        try:
            simulation = self.simulation
        except Exception as error:
            self.process_mode = type(self.process_mode).DISABLED
            self._failed(error)
            return
        clock = simulation.clock
        if not physics:
            clock.ahead = self.tree.clock.remainder * self.tree.time_scale
            return
        clock.ahead = 0.0
        for _ in range(clock.due(delta)):
            with simulation.active():
                simulation.schedule.tick()
            if clock.is_pose_tick:
                for listener in tuple(self._listeners):
                    listener._pose_tick(simulation)
            if self._simulation is not simulation:
                return  # a handler changed an export

    def _failed(self, error: Exception) -> None:
        from ..reports import report

        report(error, Stadium._step, "building the stadium", self)

    def _has_left(self, *, freed: bool) -> None:
        if freed:
            self._close()


def above(node: Node, kind: type[N]) -> N:
    """The nearest node above of a kind; ValueError if there is none."""
    for one in ancestors(node):
        if isinstance(one, kind):
            return one
    raise ValueError(f"{node!r} has no {kind.__name__} above it")


def _check_file(name: str, path: str, more: str = "") -> None:
    file = file_of(path)
    if not file.is_file():
        raise ValueError(f"Stadium.{name} is '{path}': {missing(file, more)}")


def _file(path: str) -> str:
    return str(file_of(path)) if path.startswith("res://") else path

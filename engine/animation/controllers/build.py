"""How each kind of node becomes rows of columns and of constant tables."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..clip_bank import ClipBank
from ..pose import ROTATION, SCALE, TRANSLATION, pack_poses
from ..skeleton import Skeleton
from .custom import Custom
from .machine import ANY_STATE, CURVES, INTERRUPTIONS, OPERATORS, StateMachine, parse_condition
from .masks import Masked
from .nodes import Additive, Blend2, BlendN, ClipNode, Controller, OneShot, TimeScale
from .parameters import Parameter, Range
from .program import Kind, Program, Reading
from .routes import next_hops
from .spaces import BlendSpace1D, BlendSpace2D
from .tree import FlatTree
from .triangulation import hull_segments, triangulate

_COLUMNS = (
    *("kind", "depth", "height", "size", "parent", "child_start", "child_count", "parameter"),
    *("clip", "constant", "constant_count", "second", "second_count", "start_state"),
)


class Builder:
    """Collects the rows of one program, node by node in preorder."""

    def __init__(self, tree: FlatTree, skeleton: Skeleton, bank: ClipBank) -> None:
        self.tree = tree
        self.skeleton = skeleton
        self.bank = bank
        count = len(tree.nodes)
        self.columns: dict[str, NDArray[Any]] = {
            name: np.zeros(count, np.int64) for name in _COLUMNS
        }
        self.columns["start_time"] = np.zeros(count, np.float64)
        self.columns["looping"] = np.zeros(count, np.bool_)
        self.columns["by_state"] = np.zeros(count, np.bool_)
        self.columns["start_weight"] = np.ones(count, np.float64)
        self.values: list[float] = []
        self.parameters: dict[str, Parameter] = {}
        self.readings: dict[str, Reading] = {}
        self.machines: dict[str, tuple[str, ...]] = {}
        self.constants: dict[str, dict[str, list[Any]]] = {}
        self._children = self._shape()

    def _shape(self) -> NDArray[np.int64]:
        columns = self.columns
        parents = np.array(self.tree.parents, np.int64)
        columns["parent"][:] = parents
        columns["size"][:] = 1
        for number in range(1, len(parents)):
            columns["depth"][number] = columns["depth"][parents[number]] + 1
        for number in range(len(parents) - 1, 0, -1):
            above = parents[number]
            columns["size"][above] += columns["size"][number]
            columns["height"][above] = max(columns["height"][above], columns["height"][number] + 1)
        counts = np.bincount(parents[1:], minlength=len(parents))
        columns["child_count"][:] = counts
        columns["child_start"][:] = np.cumsum(counts) - counts
        return np.argsort(parents[1:], kind="stable") + 1

    def add(self, number: int, node: Controller) -> None:
        """Add one node's rows."""
        kind, build = _BUILDERS[type(node)]
        self.columns["kind"][number] = kind
        self.columns["parameter"][number] = len(self.values)
        build(self, number, node)

    def parameter(
        self, number: int, name: str, kind: Range, *values: float, each: bool = False
    ) -> int:
        """Add a parameter; `each`: every one of its numbers has a path as well. Its offset."""
        path = self._path(number, name)
        offset = len(self.values)
        self.parameters[path] = Parameter(path, offset, len(values), kind)
        if each:
            for k in range(len(values)):
                part = f"{path}/{k}"
                self.parameters[part] = Parameter(part, offset + k, 1, kind)
        self.values += values
        return offset

    def reading(self, number: int, name: str) -> None:
        """Add a value that can only be read."""
        self.readings[self._path(number, name)] = (number, name)

    def constant(self, table: str, **row: Any) -> int:
        """Add a row to a constant table; its number."""
        columns = self.constants.setdefault(table, {name: [] for name in row})
        for name, value in row.items():
            columns[name].append(value)
        return len(next(iter(columns.values()))) - 1

    def rows_of(self, table: str) -> int:
        """How many rows a constant table has so far."""
        columns = self.constants.get(table)
        return len(next(iter(columns.values()))) if columns else 0

    def child(self, number: int, place: int) -> int:
        """Number of a node's child."""
        return int(self._children[self.columns["child_start"][number] + place])

    def weigh_by_state(self, number: int, place: int, weight: float) -> None:
        """Let a child be weighed by a node's state, with a weight to begin with."""
        child = self.child(number, place)
        self.columns["by_state"][child] = True
        self.columns["start_weight"][child] = weight

    def _path(self, number: int, name: str) -> str:
        path = self.tree.paths[number]
        return f"{path}/{name}" if path else name

    def program(self, controller: Controller) -> Program:
        """The finished program."""
        constants: Mapping[str, Mapping[str, NDArray[Any]]] = {
            table: {name: np.array(values) for name, values in columns.items()}
            for table, columns in self.constants.items()
        }
        return Program(
            controller=controller,
            tree=self.tree,
            columns=self.columns,
            children=self._children,
            parameters=self.parameters,
            defaults=np.array(self.values, np.float64),
            readings=self.readings,
            constants=constants,
            machines=self.machines,
        )


def _clip(b: Builder, number: int, node: ClipNode) -> None:
    clip = b.bank.index(node.clip)
    b.columns["clip"][number] = clip
    b.columns["start_time"][number] = node.phase * b.bank.duration[clip]
    b.columns["looping"][number] = b.bank.looping[clip] if node.loop is None else node.loop
    b.parameter(number, "speed", Range.NUMBER, node.speed)


def _blend_2(b: Builder, number: int, node: Blend2) -> None:
    b.parameter(number, "amount", Range.AMOUNT, node.amount)


def _blend_n(b: Builder, number: int, node: BlendN) -> None:
    b.parameter(number, "weights", Range.WEIGHT, *node.weights, each=True)


def _time_scale(b: Builder, number: int, node: TimeScale) -> None:
    b.parameter(number, "scale", Range.NUMBER, node.scale)


def _masked(b: Builder, number: int, node: Masked) -> None:
    layers = node.layers
    b.columns["constant"][number] = b.rows_of("masks")
    b.columns["constant_count"][number] = len(layers)
    for layer in layers:
        b.constant("masks", weights=layer.mask.of(b.skeleton))
    amounts = [layer.amount for layer in layers]
    b.parameter(number, "amount", Range.AMOUNT, *amounts, each=len(layers) > 1)


def _additive(b: Builder, number: int, node: Additive) -> None:
    if node.reference:
        pose = b.bank.sample_one(b.bank.index(node.reference), node.reference_time)[0]
    else:
        rest = (b.skeleton.rest_rotation, b.skeleton.rest_translation, b.skeleton.rest_scale)
        pose = pack_poses(rest[0][None], rest[1][None], rest[2][None])[0]
    # What the evaluation multiplies with or subtracts: inverse rotation, translation, 1 / scale.
    inverse = pose.astype(np.float64)
    inverse[ROTATION] /= np.linalg.norm(inverse[ROTATION], axis=0)
    inverse[:3] *= -1.0
    inverse[TRANSLATION] = pose[TRANSLATION]
    flat = inverse[SCALE] == 0
    inverse[SCALE] = np.where(flat, 1.0, 1.0 / np.where(flat, 1.0, inverse[SCALE]))
    b.columns["constant"][number] = b.constant("references", pose=inverse.astype(np.float32))
    b.parameter(number, "amount", Range.AMOUNT, node.amount)


def _space_1d(b: Builder, number: int, node: BlendSpace1D) -> None:
    order = sorted(range(len(node.points)), key=lambda k: node.points[k][0])
    b.columns["constant"][number] = b.rows_of("knots")
    b.columns["constant_count"][number] = len(order)
    for k in order:
        b.constant("knots", at=float(node.points[k][0]), child=k)
    b.parameter(number, "position", Range.NUMBER, node.position)


def _space_2d(b: Builder, number: int, node: BlendSpace2D) -> None:
    points = np.array([at for at, _ in node.points], np.float64)
    triangles = triangulate(points)
    b.columns["constant"][number] = b.rows_of("triangles")
    b.columns["constant_count"][number] = len(triangles)
    for triangle in triangles:
        corners = points[triangle]
        edges = np.stack([corners[1] - corners[0], corners[2] - corners[0]], axis=1)
        b.constant("triangles", corner=triangle, origin=corners[0], inverse=np.linalg.inv(edges))
    segments = hull_segments(points, triangles)
    b.columns["second"][number] = b.rows_of("segments")
    b.columns["second_count"][number] = len(segments)
    for segment in segments:
        start, stop = points[segment]
        along = stop - start
        square = float(along @ along)
        per_length = along / square if square > 0 else np.zeros(2)
        b.constant("segments", end=segment, origin=start, along=along, project=per_length)
    b.parameter(number, "position", Range.NUMBER, *node.position, each=True)


def _machine(b: Builder, number: int, node: StateMachine) -> None:
    states = tuple(node.states)
    b.machines[b.tree.paths[number]] = states
    place = {state: k for k, state in enumerate(states)}
    start = b.columns["start_state"][number] = place[node.start]
    for k in range(len(states)):
        b.weigh_by_state(number, k, float(k == start))
    offsets = {
        name: b.parameter(number, name, Range.NUMBER, node.parameters.get(name, 0.0))
        for name in node.conditions()
    }
    for name in node.triggers():
        offsets[name] = b.parameter(number, name, Range.TRIGGER, 0.0)
    # Relative to the node's own first parameter, so that all streams share the table.
    base = int(b.columns["parameter"][number])
    ways = sorted(node.transitions, key=lambda way: way.priority)
    b.columns["constant"][number] = b.rows_of("transitions")
    b.columns["constant_count"][number] = len(ways)
    for way in ways:
        condition = parse_condition(way.when) if way.when else None
        b.constant(
            "transitions",
            source=-1 if way.source == ANY_STATE else place[way.source],
            target=place[way.target],
            trigger=offsets[way.trigger] - base if way.trigger else -1,
            condition=offsets[condition.parameter] - base if condition else -1,
            operator=OPERATORS.index(condition.operator) if condition else 0,
            threshold=condition.threshold if condition else 0.0,
            at_end=way.at_end,
            automatic=way.automatic,
            duration=float(way.duration),
            curve=CURVES.index(way.curve),
            sync=way.sync,
            priority=way.priority,
            rule=INTERRUPTIONS.index(way.interrupt),
        )
    edges = [
        (source, place[way.target])
        for way in ways
        for source in (range(len(states)) if way.source == ANY_STATE else (place[way.source],))
    ]
    b.columns["second"][number] = b.rows_of("hops")
    b.columns["second_count"][number] = len(states) ** 2
    for hop in next_hops(len(states), edges).ravel():
        b.constant("hops", state=hop)
    for name in ("current", "fading_from", "position"):
        b.reading(number, name)


def _one_shot(b: Builder, number: int, node: OneShot) -> None:
    b.columns["constant"][number] = b.constant(
        "shots", fadein=float(node.fadein), fadeout=float(node.fadeout)
    )
    b.weigh_by_state(number, 0, 1.0)
    b.weigh_by_state(number, 1, 0.0)
    b.parameter(number, "request", Range.REQUEST, 0.0)
    b.reading(number, "active")


def _custom(b: Builder, number: int, node: Custom) -> None:
    for name, value in node.parameters.items():
        b.parameter(number, name, Range.NUMBER, value)


_BUILDERS: dict[type[Controller], tuple[Kind, Callable[[Builder, int, Any], None]]] = {
    ClipNode: (Kind.CLIP, _clip),
    Blend2: (Kind.BLEND_2, _blend_2),
    BlendN: (Kind.BLEND_N, _blend_n),
    TimeScale: (Kind.TIME_SCALE, _time_scale),
    Masked: (Kind.MASKED, _masked),
    Additive: (Kind.ADDITIVE, _additive),
    BlendSpace1D: (Kind.SPACE_1D, _space_1d),
    BlendSpace2D: (Kind.SPACE_2D, _space_2d),
    StateMachine: (Kind.MACHINE, _machine),
    OneShot: (Kind.ONE_SHOT, _one_shot),
    Custom: (Kind.CUSTOM, _custom),
}

"""A naive evaluator of controllers: one stream, node by node, in float64, from the definitions."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, Delaunay, QhullError
from scipy.spatial.transform import Rotation

from tifo.engine.animation import Clip, Skeleton
from tifo.engine.animation.controllers import (
    Additive,
    Blend2,
    BlendN,
    BlendSpace1D,
    BlendSpace2D,
    ClipNode,
    Controller,
    Masked,
    OneShot,
    StateMachine,
    TimeScale,
)

Array = NDArray[Any]
Pose = tuple[Array, Array, Array]


class Reference:
    """A tree for one stream, with its parameters and states."""

    def __init__(
        self, controller: Controller, skeleton: Skeleton, clips: list[Clip], time: float = 0.0
    ) -> None:
        self.skeleton = skeleton
        self.clips = {clip.name: clip for clip in clips}
        self.values: dict[str, Any] = {}
        self.closest = 1.0
        """Least |dot| that a hemisphere was chosen by: near 0 either choice is right."""
        self.root = RefNode(self, controller, controller.name)
        for node in self.root.below():
            if isinstance(node.kind, ClipNode):
                node.time += time

    def tick(self, delta: float) -> Pose:
        for node in self.root.below():
            node.played = None
        self.root.step(delta)
        return self.root.pose()

    def nlerp(self, terms: list[tuple[float, Array]]) -> Array:
        """Weighted sum of (J, 4) rotations in one hemisphere, normalised."""
        total = terms[0][0] * terms[0][1]
        for weight, q in terms[1:]:
            dot = (total * q).sum(axis=1, keepdims=True)
            size = np.linalg.norm(total, axis=1, keepdims=True)
            nearness = np.abs(dot) / np.where(size > 0, size, 1.0)
            self.closest = min([self.closest, *nearness[size > 0]])
            total = total + weight * np.where(dot < 0, -q, q)
        return total / np.linalg.norm(total, axis=1, keepdims=True)


class RefNode:
    """One place in the tree."""

    def __init__(self, tree: Reference, kind: Controller, path: str) -> None:
        self.tree, self.kind, self.path, self.children = tree, kind, path, []
        machine = isinstance(kind, StateMachine)
        for place, child in kind.children():
            name = f"{path}/" * bool(path) + (place if machine else (child.name or place))
            self.children.append(RefNode(tree, child, name))
        self.share = 1.0  # of the tree's pose, where it was seen
        # Of a clip seen in this tick: whether it started, its time before, and its step.
        self.played: tuple[bool, float, float] | None = None
        self._declare()
        self.restart()

    def below(self) -> list[RefNode]:
        return [self, *(node for child in self.children for node in child.below())]

    def restart(self) -> None:
        kind = self.kind
        self.time = kind.phase * self.clip.duration if isinstance(kind, ClipNode) else 0.0
        self.restarted, self.ended = True, False
        self.on, self.fade = False, math.inf
        self.source: int | None = None
        self.goal: int | None = None
        self.origin = [0.0] * len(self.children)
        self.weights = [1.0] * len(self.children)
        if isinstance(kind, StateMachine):
            self.state = list(kind.states).index(kind.start)
            self.weights = [float(k == self.state) for k in range(len(self.children))]
        for child in self.children:
            child.restart()

    def _declare(self) -> None:
        kind = self.kind
        given: dict[str, Any] = {}
        if isinstance(kind, ClipNode):
            given = {"speed": kind.speed}
        elif isinstance(kind, (Blend2, Additive)):
            given = {"amount": kind.amount}
        elif isinstance(kind, BlendN):
            given = {"weights": list(kind.weights)}
        elif isinstance(kind, TimeScale):
            given = {"scale": kind.scale}
        elif isinstance(kind, Masked):
            given = {"amount": [layer.amount for layer in kind.layers]}
        elif isinstance(kind, BlendSpace1D | BlendSpace2D):
            given = {"position": kind.position}
        elif isinstance(kind, OneShot):
            given = {"request": 0}
        elif isinstance(kind, StateMachine):
            given = {name: kind.parameters.get(name, 0.0) for name in kind.conditions()}
            given |= dict.fromkeys(kind.triggers(), 0.0)
        self.tree.values |= {self._at(name): value for name, value in given.items()}

    def _at(self, name: str) -> str:
        return f"{self.path}/{name}" if self.path else name

    def value(self, name: str) -> Any:
        return self.tree.values[self._at(name)]

    @property
    def clip(self) -> Clip:
        assert isinstance(self.kind, ClipNode)
        return self.tree.clips[self.kind.clip]

    @property
    def loops(self) -> bool:
        assert isinstance(self.kind, ClipNode)
        return self.clip.looping if self.kind.loop is None else self.kind.loop

    def step(self, delta: float) -> None:
        """Advance by a tick and let the children that weigh something advance."""
        if self.restarted:
            delta = 0.0
        kind = self.kind
        if isinstance(kind, ClipNode):
            self._play(delta * self.value("speed"))
        elif isinstance(kind, StateMachine):
            self._machine(kind, abs(delta))
        elif isinstance(kind, OneShot):
            self._one_shot(kind, abs(delta))
        else:
            self.weights = self.shares()
        self.restarted = False
        scale = self.value("scale") if isinstance(kind, TimeScale) else 1.0
        for child, weight in zip(self.children, self.weights, strict=True):
            if weight > 1e-6:
                child.share = self.share * weight
                child.step(delta * scale)

    def shares(self) -> list[float]:
        """Weights of the children of a node without a state."""
        kind = self.kind
        if isinstance(kind, Blend2):
            return [1 - self.value("amount"), self.value("amount")]
        if isinstance(kind, Additive):
            return [1.0, self.value("amount")]
        if isinstance(kind, Masked):
            return [1.0, *self.value("amount")]
        if isinstance(kind, BlendN):
            total = sum(self.value("weights"))
            if total == 0:
                return [1.0] + [0.0] * (len(self.children) - 1)
            return [weight / total for weight in self.value("weights")]
        if isinstance(kind, BlendSpace1D):
            return line_weights([at for at, _ in kind.points], self.value("position"))
        if isinstance(kind, BlendSpace2D):
            return plane_weights(np.array([at for at, _ in kind.points]), self.value("position"))
        return [1.0] * len(self.children)

    def _play(self, step: float) -> None:
        duration = self.clip.duration
        self.played = (self.restarted, self.time, step)
        self.time += step
        if self.loops and duration > 0:
            self.ended = not 0 <= self.time < duration
            self.time %= duration
        else:
            forward = step >= 0 and self.time >= duration - 1e-9
            self.ended = forward or (step < 0 and self.time < 1e-9)
            self.time = min(max(self.time, 0.0), duration)

    def leading(self) -> tuple[RefNode, float]:
        """The clip that is seen most, and its speed."""
        if not self.children:
            return self, self.value("speed")
        stateful = isinstance(self.kind, (StateMachine, OneShot))
        weights = self.weights if stateful else self.shares()
        clip, speed = self.children[weights.index(max(weights))].leading()
        return clip, speed * (self.value("scale") if isinstance(self.kind, TimeScale) else 1.0)

    def _machine(self, kind: StateMachine, delta: float) -> None:
        names = list(kind.states)
        self.time += delta
        self.fade += delta
        if self.source is not None and self.fade >= self.way.duration - 1e-9:
            self.source = None
        if self.goal == self.state:
            self.goal = None
        if self.goal is not None and self._route(kind)[0] is None:
            self._enter(self.goal)
            self.goal = self.source = None
        hop = None if self.goal is None else self._route(kind)[0]
        ways = sorted(kind.transitions, key=lambda way: way.priority)
        for way in ways:
            target = names.index(way.target)
            any_state = way.source == "*" and target != self.state
            if not any_state and way.source != names[self.state]:
                continue
            if self.source is not None:
                interrupts = {
                    "any": True,
                    "none": False,
                    "priority": way.priority < self.way.priority,
                }[self.way.interrupt]
                if self.goal is not None or not interrupts:
                    continue
            if self.goal is not None:
                if target != hop:
                    continue
            else:
                if not (way.trigger or way.when or way.at_end):
                    continue
                if way.trigger and not self.value(way.trigger):
                    continue
                if way.when and not self._holds(way.when):
                    continue
            clip, _ = self.children[self.state].leading()
            if way.at_end and not clip.ended:
                continue
            self._take(way, target)
            break
        share = 1.0
        if self.source is not None:
            x = self.fade / self.way.duration
            share = x if self.way.curve == "linear" else x * x * (3 - 2 * x)
        self.weights = [w * (1 - share) for w in self.origin]
        self.weights[self.state] += share

    def _holds(self, text: str) -> bool:
        words = text.split()
        if len(words) == 1:
            return bool(self.value(text))
        if words[0] == "not":
            return not self.value(words[1])
        number = float(words[2])
        compare: dict[str, Callable[[float], bool]] = {
            ">": lambda x: x > number,
            "<": lambda x: x < number,
            ">=": lambda x: x >= number,
            "<=": lambda x: x <= number,
            "==": lambda x: x == number,
            "!=": lambda x: x != number,
        }
        return compare[words[1]](self.value(words[0]))

    def _take(self, way: Any, target: int) -> None:
        before = self.state
        if way.trigger:
            self.tree.values[self._at(way.trigger)] = 0.0
        clip, _ = self.children[before].leading()
        at = clip.time / clip.clip.duration
        phase = at % 1.0 if clip.loops else min(max(at, 0.0), 1.0)
        anew = self._enter(target)
        if way.sync and anew:
            for node in self.children[target].below():
                if isinstance(node.kind, ClipNode):
                    node.time = phase * node.clip.duration
        self.way, self.fade = way, 0.0
        self.source = before if way.duration > 0 and before != target else None

    def _enter(self, target: int) -> bool:
        self.origin = list(self.weights)
        anew = target == self.state or self.weights[target] <= 1e-6
        self.state, self.time = target, 0.0
        if anew:
            self.children[target].restart()
        return anew

    def _route(self, kind: StateMachine) -> tuple[int | None, int]:
        """First state on a shortest way to the goal, and the way's length."""
        names = list(kind.states)
        ways = sorted(kind.transitions, key=lambda way: way.priority)
        waiting = deque([(self.state, None, 0)])
        seen = {self.state}
        while waiting:
            state, first, length = waiting.popleft()
            if state == self.goal:
                return first, length
            for way in ways:
                target = names.index(way.target)
                if way.source in ("*", names[state]) and target not in seen:
                    seen.add(target)
                    waiting.append((target, target if first is None else first, length + 1))  # type: ignore[arg-type]
        return None, 0

    def _one_shot(self, kind: OneShot, delta: float) -> None:
        shot = self.children[1]

        def share() -> float:
            rising = self.time / kind.fadein if kind.fadein > 0 else 1.0
            falling = self.fade / kind.fadeout if kind.fadeout > 0 else float(self.fade > 1e-9)
            return min(max(min(rising, falling), 0.0), 1.0) if self.on else 0.0

        if self.on:
            self.time += delta
            self.fade -= delta
            clip, speed = shot.leading()
            if speed != 0:
                left = clip.clip.duration - clip.time if speed > 0 else clip.time
                left = left / abs(speed) - (0.0 if shot.restarted else delta)
                if math.isinf(self.fade) and left <= kind.fadeout + 1e-9:
                    self.fade = max(left, 0.0)
        request, self.tree.values[self._at("request")] = self.value("request"), 0
        if request == 3 and self.on:
            self.fade = min(self.fade, share() * kind.fadeout)
        if self.on and self.fade <= 1e-9:
            self.on = False if request != 1 else self.on
        if request == 1:
            self.time = share() * kind.fadein
            self.on, self.fade = True, math.inf
            shot.restart()
        if request == 2:
            self.on = False
        self.weights = [1 - share(), share()]

    def pose(self) -> Pose:
        kind = self.kind
        if isinstance(kind, ClipNode):
            return sample(self.clip, self.time, self.loops)
        seen = [(c, w) for c, w in zip(self.children, self.weights, strict=True) if w > 1e-6]
        if isinstance(kind, Masked):
            return self._masked(kind)
        if isinstance(kind, Additive):
            return self._additive(kind)
        total = sum(weight for _, weight in seen)
        poses = [(weight / total, child.pose()) for child, weight in seen]
        q = self.tree.nlerp([(weight, pose[0]) for weight, pose in poses])
        t, s = (sum(weight * pose[k] for weight, pose in poses) for k in (1, 2))
        return q, t, s

    def _masked(self, kind: Masked) -> Pose:
        q, t, s = self.children[0].pose()
        for layer, child, weight in zip(
            kind.layers, self.children[1:], self.weights[1:], strict=True
        ):
            if weight <= 1e-6:
                continue
            over = child.pose()
            for joint in range(len(q)):
                share = weight * mask_weight(self.tree.skeleton, layer.mask, joint)
                one = slice(joint, joint + 1)
                q[one] = self.tree.nlerp([(1 - share, q[one]), (share, over[0][one])])
                t[joint] += share * (over[1][joint] - t[joint])
                s[joint] += share * (over[2][joint] - s[joint])
        return q, t, s

    def _additive(self, kind: Additive) -> Pose:
        q, t, s = self.children[0].pose()
        amount = self.weights[1]
        if amount <= 1e-6:
            return q, t, s
        added = self.children[1].pose()
        if kind.reference:
            clip = self.tree.clips[kind.reference]
            reference = sample(clip, kind.reference_time, clip.looping)
        else:
            skeleton = self.tree.skeleton
            rest = (skeleton.rest_rotation, skeleton.rest_translation, skeleton.rest_scale)
            reference = tuple(part.astype(float) for part in rest)  # type: ignore[assignment]
        change = (Rotation.from_quat(reference[0]).inv() * Rotation.from_quat(added[0])).as_quat()
        still = np.tile([0.0, 0, 0, 1], (len(q), 1))
        turn = self.tree.nlerp([(1 - amount, still), (amount, change)]) if amount < 1 else change
        q = (Rotation.from_quat(q) * Rotation.from_quat(turn)).as_quat()
        return (
            q,
            t + amount * (added[1] - reference[1]),
            s * (1 + amount * (added[2] / reference[2] - 1)),
        )


def sample(clip: Clip, time: float, looping: bool) -> Pose:
    """Pose of a clip: its two nearest keys, mixed."""
    duration = clip.duration
    local = time % duration if looping else min(max(time, 0.0), duration)
    place = local / duration * (clip.frame_count - 1)
    before = min(int(place), clip.frame_count - 2)
    share = place - before
    q, t, s = (
        part[before].astype(float) * (1 - share) + part[before + 1].astype(float) * share
        for part in (clip.rotation, clip.translation, clip.scale)
    )
    return q / np.linalg.norm(q, axis=1, keepdims=True), t, s


def mask_weight(skeleton: Skeleton, mask: Any, joint: int) -> float:
    """Weight of one joint: its own, or that of the nearest named joint above."""
    while joint >= 0:
        name = skeleton.names[joint]
        if name in mask.weights:
            return float(mask.weights[name])
        if not mask.descendants:
            return 0.0
        joint = int(skeleton.parents[joint])
    return 0.0


def line_weights(points: list[float], x: float) -> list[float]:
    """Weights of points on a line."""
    order = np.argsort(points)
    places = np.asarray(points)[order]
    return [float(np.interp(x, places, np.eye(len(points))[:, k])) for k in np.argsort(order)]


def plane_weights(points: Array, x: Any) -> list[float]:
    """Weights of points in the plane: barycentric in the Delaunay triangle, or on the hull."""
    x, out = np.asarray(x, float), np.zeros(len(points))
    try:
        mesh = Delaunay(points)
        simplex = int(mesh.find_simplex(x))
        if simplex >= 0:
            corners = mesh.simplices[simplex]
            system = np.vstack([points[corners].T, np.ones(3)])
            out[corners] = np.linalg.solve(system, [*x, 1.0])
            return [float(w) for w in out]
        edges = ConvexHull(points).simplices
    except (QhullError, ValueError):
        order = np.lexsort(points.T)
        edges = list(pairwise(order)) or [(0, 0)]
    best = math.inf
    for a, b in edges:
        along = points[b] - points[a]
        square = along @ along
        share = min(max(float((x - points[a]) @ along / square), 0.0), 1.0) if square else 0.0
        gap = float(np.linalg.norm(points[a] + share * along - x))
        if gap < best:
            best = gap
            out[:] = 0.0
            out[b] = share
            out[a] += 1 - share
    return [float(w) for w in out]

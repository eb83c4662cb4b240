"""Acting in broad strokes: goals for the body's parts, followed the way that bodies follow.

An `Acting` is a performance whose channels are sent to goals one after another. Between goals
they ease; then each part follows its goal as a damped spring of its own pace does, the hips
promptly and head and hands later. That gives what hand-made keys need three keys for: parts that
start a little against the way, arrive one after the other, swing past the goal and settle.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np

from ...animation.clip import Clip
from ...animation.skeleton import Skeleton
from .curves import Performance, Pose, Value, keyed, sided
from .rig import CENTRAL
from .rotations import Array
from .springs import Pace, arrive, close, follow

Shape = Mapping[str, Value]
"""Channels of a limb without their side, such as where a hand is and where its palm faces."""

PACES: dict[str, Pace] = {
    "hips": Pace(4.6, 0.85),
    "hips_turn": Pace(4.2, 0.80, -0.3),
    "spine": Pace(3.8, 0.75, -0.3),
    "chest": Pace(3.4, 0.70, -0.3),
    "neck": Pace(3.6, 0.72),
    "head": Pace(3.2, 0.66),
    "hand": Pace(3.3, 0.70, -0.2),
    "rest": Pace(3.6, 0.85),
    "hold": Pace(3.6, 1.0),
    # With the hands, so that the way between the frames of chest and head is straight.
    "clasp": Pace(3.3, 0.70, -0.2),
    "wrist": Pace(3.6, 1.0),
    "palm": Pace(3.0, 0.80),
    "finger": Pace(2.8, 0.72),
    "elbow": Pace(3.0, 0.85),
    "curl": Pace(3.4, 0.80),
    "shrug": Pace(3.4, 0.80),
}
"""Of the channels that follow; feet and knees go exactly where they are sent."""

_ARRIVAL = 0.35
"""Seconds over which the last bit to a clip's final pose is taken up, at most."""


@dataclass
class Acting(Performance):
    """A performance that is told where to go.

    Parameters
    ----------
    goal
        The pose that the clip ends in; the pose it starts in if None.
    snap
        How much faster than at ease all springs are.
    """

    goal: Pose | None = None
    snap: float = 1.0
    _goals: dict[str, list[tuple[float, Array]]] = field(init=False, default_factory=dict)
    _steps: dict[str, Array] = field(init=False, default_factory=dict)

    @property
    def end(self) -> Pose:
        """The pose that the clip ends in."""
        return self.base if self.goal is None else self.goal

    @property
    def stands(self) -> bool:
        """Whether the clip starts on the feet, not on a seat."""
        return bool(self.base["hips"][1] > 0.8)

    def move(self, begin: float, until: float, shape: Shape | None = None, **to: Value) -> Self:
        """Send channels to goals, from `begin` to `until` seconds.

        Goals of the trunk (`CENTRAL`) are offsets from the base pose, those of the limbs are
        values. A name without its side goes to both; `shape` holds more channels.
        """
        for name, value in {**(shape or {}), **to}.items():
            for channel in sided(self.base, name):
                here = self.base[channel]
                goal = np.broadcast_to(np.asarray(value, float), here.shape)
                self._send(channel, begin, until, here + goal if channel in CENTRAL else goal)
        return self

    def hand(self, side: str, begin: float, until: float, shape: Shape, **to: Value) -> Self:
        """Send the channels of one side ("_l" or "_r") to goals."""
        return self.move(
            begin, until, {name + side: value for name, value in {**shape, **to}.items()}
        )

    def reach(
        self, side: str, begin: float, until: float, shape: Shape, via: Value | None = None
    ) -> Self:
        """Bring the hands of `side` ("_l", "_r", or "" for both) into a shape, past a place.

        With both hands the right one is a little later and slower, as nobody moves in unison.
        """
        for one, late in (("_l", 0.0), ("_r", 0.06 if not side else 0.0)):
            if side not in ("", one):
                continue
            start, end = begin + late, until + late
            if via is None:
                self.hand(one, start, end, shape)
                continue
            place = {name: shape[name] for name in ("hand", "clasp")}
            self.hand(one, start, (start + end) / 2, {"hand": via, "clasp": 0.0})
            self.hand(one, (start + end) / 2, end, place)
            self.hand(one, start, end, {k: v for k, v in shape.items() if k not in place})
        return self

    def back(self, begin: float, until: float, *names: str, via: Value | None = None) -> Self:
        """Send channels to the pose of the clip's end: all that differ from it by then, or some.

        Hands go past a place before the chest on their way, if there is one.
        """
        if via is not None:
            middle = begin + 0.45 * (until - begin)
            for side in ("_l", "_r"):
                if "clasp" + side in self._goals:
                    self.hand(side, begin, middle, {"hand": via, "clasp": 0.0})
        channels = [c for name in names for c in sided(self.base, name)] or list(self.base)
        for channel in channels:
            moved = channel in self._goals or self.goal is not None
            if moved and channel.partition("_")[0] not in ("ball", "foot"):
                start = max(begin, self._until(channel)) if via is not None else begin
                self._send(channel, start, until, np.asarray(self.end[channel], float))
        return self

    def step(
        self,
        side: str,
        begin: float,
        until: float,
        by: tuple[float, float] | None = None,
        *,
        outward: float | None = None,
        height: float = 0.05,
    ) -> Self:
        """Lift one foot and put it down `by` (outward, forward) metres from where it stands.

        Without `by` it goes to where the clip ends. `outward` is the foot's turn then, radians;
        None leaves it, or takes the end's with `by` None. Heel first up, heel last down.
        """
        ball, foot = "ball" + side, "foot" + side
        start = self._steps.get(ball, self.base[ball])
        turn = self._steps.get(foot, self.base[foot])[1]
        if by is None:
            goal, after = self.end[ball], self.end[foot][1]
        else:
            goal, after = start + np.array([by[0], 0.0, by[1]]), turn
        after = after if outward is None else outward
        u = np.clip((self.times - begin) / (until - begin), 0.0, 1.0)
        v = np.clip((u - 0.2) / 0.76, 0.0, 1.0)
        way = (v**3 * (10 - 15 * v + 6 * v * v))[:, None]
        arc = height * np.sin(np.pi * v)[:, None] ** 2
        self.add(ball, way * (goal - start) + arc * np.array([0.0, 1.0, 0.0]))
        lift = 0.5 * np.sin(np.pi * np.clip(u / 0.92, 0.0, 1.0)) ** 2
        self.add(foot, np.stack([lift, way[:, 0] * (after - turn)], axis=1))
        self._steps[ball], self._steps[foot] = goal, np.array([0.0, after])
        return self

    def shake(
        self,
        name: str,
        amount: Value,
        hertz: float,
        between: tuple[float, float, float, float],
        phase: float = 0.0,
    ) -> Self:
        """Add a sine of some Hz that swells, lasts and fades at four rising times in seconds."""
        swell = keyed(np.array(between), np.array([[0.0], [1.0], [1.0], [0.0]]), self.times)
        angle = 2 * np.pi * (hertz * (self.times - between[0]) + phase)
        self.add(name, swell * np.sin(angle)[:, None] * np.asarray(amount, float))
        return self

    def breathe(self, *, every: float = 3.4, depth: float = 1.0) -> Self:
        """Let the chest rise and the head and shoulders ride on it, whole breaths a clip."""
        breaths = max(round(self.duration / every), 1)
        self.wave("chest", (-0.018 * depth, 0.0, 0.0), breaths, 0.25)
        self.wave("shrug", -0.016 * depth, breaths, 0.25)
        self.wave("head", (0.010 * depth, 0.0, 0.0), breaths, 0.25)
        return self

    def live(self, seed: float = 0.0, amount: float = 1.0) -> Self:
        """Breathe, and let trunk and head wander a little, so that nothing ever stands still."""
        slow = max(round(self.duration / 3.1), 1)
        quick = max(round(self.duration / 1.3), 2)
        a = amount
        self.wave("spine", (0.010 * a, 0.012 * a, 0.010 * a), slow, 0.13 + seed)
        self.wave("head", (0.012 * a, 0.020 * a, 0.010 * a), slow + 1, 0.37 + 2 * seed)
        self.wave("head", (0.007 * a, 0.010 * a, 0.006 * a), quick, 0.71 + 3 * seed)
        if self.stands:
            self.wave("hips", (0.007 * a, 0.0, 0.004 * a), slow, 0.55 + seed)
        return self.breathe(depth=a)

    def mirrored(self) -> Self:
        """Exchange left and right of everything done so far."""
        self._follow()
        before = dict(self._curves)
        for channel, base in self.base.items():
            source = channel
            if channel.endswith(("_l", "_r")):
                source = channel[:-1] + ("r" if channel.endswith("_l") else "l")
            offset = before[source] - self.base[source]
            if channel == "hips":
                offset = offset * np.array([-1.0, 1.0, 1.0])
            elif channel in CENTRAL:
                offset = offset * np.array([1.0, -1.0, -1.0])
            self._curves[channel] = base + offset
        return self

    def clip(self, skeleton: Skeleton) -> Clip:
        """Let the body follow its goals, and solve the limbs."""
        self._follow()
        if not self.looping:
            self.settle(self.end)
        return super().clip(skeleton)

    def _until(self, channel: str) -> float:
        goals = self._goals.get(channel)
        return goals[-1][0] if goals else 0.0

    def _send(self, channel: str, begin: float, until: float, goal: Array) -> None:
        goals = self._goals.setdefault(channel, [(0.0, np.asarray(self.base[channel], float))])
        if begin > goals[-1][0] + 1e-6:
            goals.append((begin, goals[-1][1]))
        if until <= goals[-1][0] + 1e-6:
            raise ValueError(
                f"'{self.name}' sends {channel} to a goal until {until} s, "
                f"but it is on another way until {goals[-1][0]} s"
            )
        goals.append((until, goal))

    def _follow(self) -> None:
        """Add to the curves what the goals make of their channels."""
        springs: list[tuple[str, Array, Pace]] = []
        for channel, goals in self._goals.items():
            times, values = (np.array(part) for part in zip(*goals, strict=True))
            way = keyed(times, values, self.times)
            name = channel.removesuffix("_l").removesuffix("_r")
            if name in PACES:
                pace = PACES[name]
                springs.append((channel, way, replace(pace, hertz=pace.hertz * self.snap)))
            else:
                self.add(channel, way - self.base[channel])
        self._goals.clear()
        if not springs:
            return
        widths = [way.shape[1] for _, way, _ in springs]
        paces = [pace for _, way, pace in springs for _ in range(way.shape[1])]
        ends = np.concatenate([self.end[channel] for channel, _, _ in springs])
        whole = np.concatenate([way for _, way, _ in springs], axis=1)
        whole = follow(whole, self.times, paces, looping=self.looping)
        bend = close if self.looping else arrive
        whole = bend(whole, self.times, ends, min(_ARRIVAL, 0.4 * self.duration))
        parts = np.split(whole, np.cumsum(widths)[:-1], axis=1)
        for (channel, _, _), way in zip(springs, parts, strict=True):
            self.add(channel, way - self.base[channel])

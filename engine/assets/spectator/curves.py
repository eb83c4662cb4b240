"""Controls over time: keyed poses, and sines on top that keep a body from standing still."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ...animation.clip import Clip, continuous_hemisphere, uniform_times
from ...animation.skeleton import Skeleton
from .rig import solve
from .rotations import Array

Pose = Mapping[str, Array]
Value = Sequence[float] | Array | float


def keyed(times: Array, values: Array, at: Array) -> Array:
    """Smooth curve through keys that never overshoots them, level at its turning points.

    Monotone cubic interpolation of F. Fritsch and R. Carlson (1980), with level ends.

    Parameters
    ----------
    times
        (K,) rising seconds.
    values
        (K, C).
    at
        (F,) seconds; outside the keys the nearest key holds.

    Returns
    -------
    (F, C) float64
    """
    if len(times) == 1:
        return np.repeat(values, len(at), axis=0)
    gap = np.diff(times)[:, None]
    slope = np.diff(values, axis=0) / gap
    tangent = np.zeros_like(values)
    before, after = slope[:-1], slope[1:]
    agree = before * after > 0
    weight0, weight1 = 2 * gap[1:] + gap[:-1], gap[1:] + 2 * gap[:-1]
    safe0, safe1 = np.where(agree, before, 1.0), np.where(agree, after, 1.0)
    mean = (weight0 + weight1) / (weight0 / safe0 + weight1 / safe1)
    tangent[1:-1] = np.where(agree, mean, 0.0)
    clamped = np.clip(at, times[0], times[-1])
    k = np.clip(np.searchsorted(times, clamped, side="right") - 1, 0, len(times) - 2)
    u = ((clamped - times[k])[:, None]) / gap[k]
    start, end = values[k], values[k + 1]
    return (
        start * (1 + 2 * u) * (1 - u) ** 2
        + tangent[k] * gap[k] * u * (1 - u) ** 2
        + end * u**2 * (3 - 2 * u)
        - tangent[k + 1] * gap[k] * u**2 * (1 - u)
    )


def pose(base: Pose, **changes: Value) -> dict[str, Array]:
    """A copy of a pose with some channels set; a name without its side sets both sides."""
    result = {name: value.copy() for name, value in base.items()}
    for name, value in changes.items():
        for channel in sided(result, name):
            result[channel] = np.atleast_1d(np.asarray(value, dtype=np.float64))
    return result


def sided(known: Mapping[str, object], name: str) -> tuple[str, ...]:
    """The channels that a name with or without its side means: ``hand`` is both hands."""
    return (name,) if name in known else (name + "_l", name + "_r")


@dataclass
class Performance:
    """A clip in the making: what each control does over `duration` seconds.

    Parameters
    ----------
    name, duration, looping
        Of the clip.
    base
        The pose that the clip starts from and that channels keep which nothing moves.
    """

    name: str
    duration: float
    base: Pose
    looping: bool = True
    _curves: dict[str, Array] = field(init=False)

    def __post_init__(self) -> None:
        """Start with every channel at rest."""
        frames = len(self.times)
        self._curves = {
            name: np.tile(value, (frames, 1)).astype(np.float64)
            for name, value in self.base.items()
        }

    @property
    def times(self) -> Array:
        """(F,) seconds of the clip's keys."""
        return uniform_times(self.duration)

    def key(self, name: str, *keys: tuple[float, Value]) -> Performance:
        """Add offsets from the base pose at given times; a name without side moves both sides."""
        for channel in sided(self.base, name):
            width = self._curves[channel].shape[1]
            values = np.array([np.broadcast_to(np.asarray(v, float), (width,)) for _, v in keys])
            self._curves[channel] += keyed(np.array([t for t, _ in keys]), values, self.times)
        return self

    def towards(self, goal: Pose, *names: str, keys: Sequence[tuple[float, float]]) -> Performance:
        """Move channels from the base pose to another; `keys` are (seconds, share of the way)."""
        share = keyed(np.array([t for t, _ in keys]), np.array([[s] for _, s in keys]), self.times)
        for name in names:
            for channel in sided(self.base, name):
                self._curves[channel] += share * (goal[channel] - self.base[channel])
        return self

    def wave(self, name: str, amount: Value, cycles: int, phase: float = 0.0) -> Performance:
        """Add a sine of whole `cycles` over the clip that starts and ends at zero.

        `phase` in turns shifts it: 0.25 gives ``cos - 1``, which only dips below the base.
        """
        angle = 2 * np.pi * (cycles * self.times / self.duration + phase)
        return self.add(
            name, (np.sin(angle) - np.sin(2 * np.pi * phase))[:, None] * np.asarray(amount)
        )

    def swing(self, name: str, amount: Value, cycles: int, phase: float = 0.0) -> Performance:
        """Add a sine of whole `cycles` about the base pose, `phase` turns ahead.

        For loops that no other clip has to join: they need not start in the base pose.
        """
        angle = 2 * np.pi * (cycles * self.times / self.duration + phase)
        return self.add(name, np.sin(angle)[:, None] * np.asarray(amount))

    def add(self, name: str, offsets: Array) -> Performance:
        """Add any offsets (F, C) to a channel."""
        for channel in sided(self.base, name):
            self._curves[channel] = self._curves[channel] + offsets
        return self

    def settle(self, goal: Pose) -> Performance:
        """End exactly in another pose: the last key of every channel becomes the goal's.

        Raises
        ------
        ValueError
            If a channel would jump there instead of arriving.
        """
        for name, value in goal.items():
            gap = float(np.abs(self._curves[name][-1] - value).max())
            if gap > 1e-6:
                raise ValueError(f"'{self.name}' ends with {name} {gap:.3g} away from its goal")
            self._curves[name][-1] = value
        return self

    def clip(self, skeleton: Skeleton) -> Clip:
        """Solve the limbs and close the loop exactly."""
        rotation, translation = solve(skeleton, self._curves)
        rotation = continuous_hemisphere(rotation)
        if self.looping:
            gap = float(np.abs(rotation[-1] - rotation[0]).max())
            if gap > 1e-6:
                raise ValueError(f"'{self.name}' loops with a jump of {gap:.3g}")
            rotation[-1], translation[-1] = rotation[0], translation[0]
        return Clip(
            name=self.name,
            duration=self.duration,
            rotation=rotation.astype(np.float32),
            translation=translation.astype(np.float32),
            scale=np.ones(translation.shape, dtype=np.float32),
            looping=self.looping,
        )

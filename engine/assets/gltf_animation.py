"""Exact evaluation of glTF animations, and their resampling to uniform keys.

glTF 2.0 specification, section 3.11 and appendix C: STEP, LINEAR (spherical for rotations) and
CUBICSPLINE. Channels that share key times are evaluated together; a clip of a hundred channels is
then a handful of NumPy calls.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..animation.clip import MIN_KEY_RATE, Clip, continuous_hemisphere, uniform_times
from ..animation.skeleton import Skeleton
from .gltf_transforms import FloatArray, Transforms, model_positions

MAX_KEY_RATE = 120.0
"""Highest rate that a clip is stored at to meet its file's own keys."""

CHUNK = 512
"""Keys that are evaluated at once: bounds the memory of long clips."""


@dataclass(frozen=True, slots=True, eq=False)
class Track:
    """C channels of one path with common key times.

    Parameters
    ----------
    path
        ``"rotation"``, ``"translation"`` or ``"scale"``.
    interpolation
        ``"STEP"``, ``"LINEAR"`` or ``"CUBICSPLINE"``.
    times
        (K,) float64 seconds, increasing.
    values
        (K, C, n) float64, n = 4 for rotations and 3 for the rest; (K, 3, C, n) for CUBICSPLINE:
        in-tangent, value, out-tangent. Rotation keys of STEP and LINEAR have unit length.
    joints
        (C,) joints of the skeleton, each once.
    """

    path: str
    interpolation: str
    times: FloatArray
    values: FloatArray
    joints: NDArray[np.int64]

    def evaluate(self, at: FloatArray) -> FloatArray:
        """Evaluate the channels by the rules of the format.

        Parameters
        ----------
        at
            (T,) float64 seconds; before the first and after the last key these hold.

        Returns
        -------
        (T, C, n) float64
            Rotations have unit length. Two LINEAR keys at 0 s and 1 s that are 90 degrees apart
            give 45 degrees at 0.5 s.
        """
        if len(self.times) == 1:
            only = self.values[:, 1] if self.interpolation == "CUBICSPLINE" else self.values
            return _unit(self.path, np.repeat(only, len(at), axis=0))
        before = np.clip(np.searchsorted(self.times, at, side="right") - 1, 0, len(self.times) - 1)
        if self.interpolation == "STEP":
            return self.values[before]
        before = np.minimum(before, len(self.times) - 2)
        span = np.diff(self.times)[before]
        u = np.clip((at - self.times[before]) / span, 0.0, 1.0)[:, None, None]
        if self.interpolation == "CUBICSPLINE":
            return _unit(self.path, self._hermite(before, u, span[:, None, None]))
        start, stop = self.values[before], self.values[before + 1]
        if self.path == "rotation":
            return slerp(start, stop, u)
        mixed: FloatArray = start + u * (stop - start)
        return mixed

    def _hermite(self, before: NDArray[np.int64], u: FloatArray, span: FloatArray) -> FloatArray:
        """Cubic Hermite spline of appendix C.5."""
        start, leaving = self.values[before, 1], self.values[before, 2]
        arriving, stop = self.values[before + 1, 0], self.values[before + 1, 1]
        u2, u3 = u * u, u * u * u
        value: FloatArray = (
            (2 * u3 - 3 * u2 + 1) * start
            + span * (u3 - 2 * u2 + u) * leaving
            + (-2 * u3 + 3 * u2) * stop
            + span * (u3 - u2) * arriving
        )
        return value


def slerp(start: FloatArray, stop: FloatArray, u: FloatArray) -> FloatArray:
    """Turn at constant speed along the shorter arc between unit quaternions.

    Parameters
    ----------
    start, stop
        (..., 4) float64 xyzw, unit length.
    u
        (..., 1) float64 from 0 to 1.

    Returns
    -------
    (..., 4) float64
        Unit quaternions. The angle comes from both the sum and the difference of the ends, so it
        is exact for small and for large angles.
    """
    dot = np.einsum("...k,...k->...", start, stop)[..., None]
    stop = np.where(dot < 0, -stop, stop)
    angle = 2 * np.arctan2(
        np.linalg.norm(stop - start, axis=-1, keepdims=True),
        np.linalg.norm(stop + start, axis=-1, keepdims=True),
    )
    sine = np.sin(angle)
    small = sine < 1e-8
    divisor = np.where(small, 1.0, sine)
    mixed: FloatArray = (
        np.where(small, 1 - u, np.sin((1 - u) * angle) / divisor) * start
        + np.where(small, u, np.sin(u * angle) / divisor) * stop
    )
    return mixed


def key_rate(tracks: list[Track]) -> float:
    """Rate at which uniform keys meet the file's own keys, if there is one.

    Returns
    -------
    float
        Keys a second, 60 to 120: the smallest multiple of the rate that all keys of the file keep,
        so 72 for a file made at 24 frames a second; `MIN_KEY_RATE` for keys at uneven times.
    """
    times = np.unique(np.concatenate([track.times for track in tracks]))
    duration = float(times[-1] - times[0])
    gaps = np.diff(times)
    gaps = gaps[gaps > 1e-4]
    if len(gaps) == 0 or gaps.min() < 1 / MAX_KEY_RATE - 1e-4:
        return MIN_KEY_RATE
    steps = round(duration / float(gaps.min()))
    step = duration / steps
    ticks = (times - times[0]) / step
    if np.abs(ticks - np.round(ticks)).max() > 1e-3:
        return MIN_KEY_RATE
    return int(np.ceil(step * MIN_KEY_RATE - 1e-6)) / step


def resample(name: str, tracks: list[Track], skeleton: Skeleton, rest: Transforms) -> Clip:
    """Make a clip of uniform keys and measure what that changes.

    Parameters
    ----------
    name
        Of the clip.
    tracks
        What moves, at least one track; no joint occurs twice in one path.
    skeleton
        The joints.
    rest
        (J, ...) float64 local transforms of joints that no track moves.

    Returns
    -------
    Clip
        From the first key of any track, which becomes time 0, to the last. Its resampling error
        compares the exact joint positions half way between keys with those of mixed keys.

    Raises
    ------
    ValueError
        If the keys are too large for float32.
    """
    start = min(float(track.times[0]) for track in tracks)
    duration = max(float(track.times[-1]) for track in tracks) - start
    times = start + uniform_times(duration, key_rate(tracks))
    count = skeleton.joint_count
    keys = Transforms(
        np.empty((len(times), count, 4)),
        np.empty((len(times), count, 3)),
        np.empty((len(times), count, 3)),
    )
    error = 0.0
    for first in range(0, len(times), CHUNK):
        rows = slice(first, first + CHUNK + 1)
        at = times[rows]
        exact = _evaluate(tracks, rest, at)
        stored = Transforms(*(part.astype(np.float32).astype(np.float64) for part in exact))
        for target, part in zip(keys, stored, strict=True):
            target[rows] = part
        if len(at) > 1:
            middle = _evaluate(tracks, rest, (at[1:] + at[:-1]) / 2)
            positions = [
                model_positions(pose, skeleton.parents, skeleton.levels)
                for pose in (middle, _mix_neighbours(stored))
            ]
            error = max(error, float(np.linalg.norm(positions[0] - positions[1], axis=2).max()))
    return Clip(
        name=name,
        duration=duration,
        rotation=continuous_hemisphere(keys.rotation).astype(np.float32),
        translation=keys.translation.astype(np.float32),
        scale=keys.scale.astype(np.float32),
        resampling_error=error,
    )


def _evaluate(tracks: list[Track], rest: Transforms, at: FloatArray) -> Transforms:
    """Local transforms (T, J, ...) of all joints at the times `at`."""
    pose = Transforms(*(np.repeat(part[None], len(at), axis=0) for part in rest))
    for track in tracks:
        getattr(pose, track.path)[:, track.joints] = track.evaluate(at)
    return pose


def _mix_neighbours(keys: Transforms) -> Transforms:
    """Half-way poses between neighbouring keys, mixed as a clip is sampled."""
    near, far = keys.rotation[:-1], keys.rotation[1:]
    dot = np.einsum("fjk,fjk->fj", near, far)[..., None]
    return Transforms(
        _unit("rotation", near + np.where(dot < 0, -far, far)),
        (keys.translation[:-1] + keys.translation[1:]) / 2,
        (keys.scale[:-1] + keys.scale[1:]) / 2,
    )


def _unit(path: str, values: FloatArray) -> FloatArray:
    """Bring rotations to unit length; a spline that runs through zero there gives no rotation."""
    if path != "rotation":
        return values
    length = np.linalg.norm(values, axis=-1, keepdims=True)
    safe = np.where(length > 1e-9, length, 1.0)
    return np.where(length > 1e-9, values / safe, (0.0, 0.0, 0.0, 1.0))

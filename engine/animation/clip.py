"""A motion of one skeleton, resampled to uniform keys.

Files store keys at any times with any interpolation; readers evaluate them by the exact rules of
their format at uniform times (at least 60 a second) and report the error that this makes. From
then on sampling is two gathers and a mix, the same for every clip.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .skeleton import Skeleton

FloatArray = NDArray[np.float32]

MIN_KEY_RATE = 60.0
"""Keys a second that readers resample to, at least."""


@dataclass(frozen=True, slots=True)
class ClipEvent:
    """A tag on a clip: whoever plays it past `time` seconds from its start gets the event `name`.

    Raises
    ------
    ValueError
        For a time that is negative or not finite, or an empty name.
    """

    time: float
    name: str

    def __post_init__(self) -> None:
        """Check the values."""
        if not np.isfinite(self.time) or self.time < 0:
            raise ValueError(f"time of clip event '{self.name}' is {self.time}, expected >= 0")
        if not self.name:
            raise ValueError("name of a clip event is empty")


@dataclass(frozen=True, slots=True, eq=False)
class Clip:
    """Local joint transforms at F uniform times from 0 to `duration` seconds.

    Parameters
    ----------
    name
        What files and scripts call it.
    duration
        Seconds between the first and the last key; 0 for a single pose (F = 1).
    rotation, translation, scale
        (F, J, 4) xyzw, (F, J, 3) and (F, J, 3) float32 in each joint's parent space. Neighbouring
        rotation keys lie in the same hemisphere, so mixing them takes the shortest path.
    looping
        Whether the last key continues into the first.
    resampling_error
        Largest distance in metres between a joint's model-space position in the file's own
        interpolation and in this clip's, measured half way between keys; 0 where the source is
        uniform already.
    events
        Tags anywhere from 0 to `duration`, both included. On a looping clip both ends are the
        seam, and tags on either are passed once a loop.

    Raises
    ------
    ValueError
        For wrong shapes, no keys, several keys in no time, a negative or non-finite duration or
        values, or an event after the end.
    """

    name: str
    duration: float
    rotation: FloatArray
    translation: FloatArray
    scale: FloatArray
    looping: bool = True
    resampling_error: float = 0.0
    events: tuple[ClipEvent, ...] = ()

    def __post_init__(self) -> None:
        """Check the shapes."""
        if self.rotation.ndim != 3 or self.rotation.shape[2] != 4 or len(self.rotation) == 0:
            raise ValueError(
                f"rotation of clip '{self.name}' has shape {self.rotation.shape}, "
                "expected (F, J, 4) with F >= 1"
            )
        shape = (*self.rotation.shape[:2], 3)
        for name in ("translation", "scale"):
            found = getattr(self, name).shape
            if found != shape:
                raise ValueError(
                    f"{name} of clip '{self.name}' has shape {found}, expected {shape}"
                )
        if not np.isfinite(self.duration) or self.duration < 0:
            raise ValueError(f"duration of clip '{self.name}' is {self.duration}, expected >= 0")
        if self.duration == 0 and self.frame_count > 1:
            raise ValueError(f"clip '{self.name}' has {self.frame_count} keys and no duration")
        for name in ("rotation", "translation", "scale"):
            if not np.isfinite(getattr(self, name)).all():
                raise ValueError(f"{name} of clip '{self.name}' has values that are not finite")
        for event in self.events:
            if event.time > self.duration:
                raise ValueError(
                    f"event '{event.name}' of clip '{self.name}' is at {event.time} s, "
                    f"expected 0 to {self.duration} s"
                )

    @property
    def frame_count(self) -> int:
        """Number of keys F."""
        return len(self.rotation)

    @property
    def joint_count(self) -> int:
        """Number of joints J."""
        return int(self.rotation.shape[1])


def rest_clip(skeleton: Skeleton) -> Clip:
    """A clip of one key called ``rest``: the skeleton's rest pose."""
    return Clip(
        "rest",
        0.0,
        skeleton.rest_rotation[None],
        skeleton.rest_translation[None],
        skeleton.rest_scale[None],
    )


def uniform_times(duration: float, rate: float = MIN_KEY_RATE) -> NDArray[np.float64]:
    """Times of the keys that a clip of `duration` seconds gets: 0 to `duration`, ends included.

    A clip of 1.01 s at 60 Hz gets 62 keys, 61 intervals of 1.01 / 61 s.
    """
    intervals = max(int(np.ceil(duration * rate - 1e-6)), 0)
    return np.linspace(0.0, duration, intervals + 1)


def continuous_hemisphere(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """Flip the signs of (F, J, 4) quaternions so that each is nearest to the key before it."""
    if len(rotation) < 2:
        return rotation
    dots = np.einsum("fjk,fjk->fj", rotation[1:], rotation[:-1])
    signs = np.cumprod(np.where(dots < 0, -1.0, 1.0), axis=0)
    return np.concatenate([rotation[:1], rotation[1:] * signs[..., None]])

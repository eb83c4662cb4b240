"""Cuts a piece out of a clip."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...animation.clip import Clip, ClipEvent
from .turns import Array


def trim_clip(clip: Clip, start: float = 0.0, end: float | None = None) -> Clip:
    """The part of a clip from `start` to `end` seconds.

    A clip of 2 s trimmed to 0.5 and 1.25 lasts 0.75 s and begins with the pose at 0.5 s. Keys are
    as dense as before; the first and the last are mixed of their neighbours where no key lies.
    Events of the part are kept, and it does not loop.

    Raises
    ------
    ValueError
        If the times don't lie in the clip, in this order.
    """
    last = clip.duration if end is None else end
    if not 0 <= start < last <= clip.duration + 1e-9:
        raise ValueError(
            f"start {start} and end {last} of clip '{clip.name}', expected 0 <= start < end <= "
            f"{clip.duration:g} s"
        )
    last = min(last, clip.duration)
    rate = (clip.frame_count - 1) / clip.duration
    keys = max(round((last - start) * rate), 1) + 1
    at = np.linspace(start, last, keys) * rate
    before = np.minimum(at.astype(np.int64), clip.frame_count - 2)
    share = (at - before)[:, None, None]
    rotation, translation, scale = (
        _mixed(values.astype(np.float64), before, share)
        for values in (clip.rotation, clip.translation, clip.scale)
    )
    rotation /= np.linalg.norm(rotation, axis=-1, keepdims=True)
    return replace(
        clip,
        duration=last - start,
        rotation=rotation.astype(np.float32),
        translation=translation.astype(np.float32),
        scale=scale.astype(np.float32),
        looping=False,
        events=tuple(
            ClipEvent(min(max(event.time - start, 0.0), last - start), event.name)
            for event in clip.events
            if start <= event.time <= last
        ),
    )


def _mixed(
    values: Array, before: np.ndarray[tuple[int], np.dtype[np.int64]], share: Array
) -> Array:
    return np.asarray(values[before] * (1 - share) + values[before + 1] * share)

"""Clips that play once, made fit for streams that run for ever."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .clip import Clip, ClipEvent


def with_pauses(clip: Clip, before: float, after: float) -> Clip:
    """The clip as a loop: its first pose held, the clip, its last pose held, and round again.

    Agents enter such a loop while the first pose is held or at the clip's start, and leave it
    before the last pose's hold is over; the jump from the last pose to the first is never shown.

    Parameters
    ----------
    clip
        With at least two keys.
    before, after
        Seconds to hold, rounded up to whole keys.

    Returns
    -------
    Clip
        Looping, with the same key rate, name and events, the latter `before` later.

    Raises
    ------
    ValueError
        For a clip of one pose, or a time that is negative or not finite.
    """
    if clip.frame_count < 2 or clip.duration <= 0:
        raise ValueError(f"clip '{clip.name}' is one pose, expected at least two keys")
    for name, value in (("before", before), ("after", after)):
        if not 0 <= value < np.inf:
            raise ValueError(f"{name} is {value}, expected seconds >= 0")
    key = clip.duration / (clip.frame_count - 1)
    first, last = (int(np.ceil(seconds / key - 1e-6)) for seconds in (before, after))
    frames = np.clip(np.arange(-first, clip.frame_count + last), 0, clip.frame_count - 1)
    return replace(
        clip,
        duration=(len(frames) - 1) * key,
        rotation=clip.rotation[frames],
        translation=clip.translation[frames],
        scale=clip.scale[frames],
        looping=True,
        events=tuple(ClipEvent(event.time + first * key, event.name) for event in clip.events),
    )

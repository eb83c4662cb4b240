"""What people on their way show: walking at several speeds, side steps, making room, standing.

A clip of walking is made for one speed; played on streams of several speeds, feet slide by no more
than half of the difference between two. Side steps are cut from a clip that goes to the side and
back, and made into a loop on the spot.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..animation.clip import Clip
from ..assets.rotations import multiply
from ..assets.spectator import MOTIONS
from ..streams.pool import StreamPool
from .motions import MotionLibrary, MotionStreams, start_staggered

SPEEDS = (0.3, 0.42, 0.54, 0.66, 0.8, 1.0, 1.3)
"""Metres a second of the walks."""
SIDE_SPEEDS = (0.28, 0.4)
"""The same of side steps."""
USUAL_SPEED = 1.3
"""Of a walk that nobody knows the speed of."""
STILL = 0.12
"""Metres a second below which somebody stands."""

_WALK = re.compile(r"^walk(ing)?(_(\d+|[a-z]))?$", re.IGNORECASE)
_SIDE = "side_step"
_PASS = "let_pass"
"""Clips of the built-in spectator; people with other clips walk or stand instead."""


@dataclass(frozen=True, slots=True, eq=False)
class Gait:
    """A motion of people on their way: the clip as a loop, its playing speed, and its own."""

    name: str
    clip: Clip
    rate: float
    speed: float
    kind: str


@dataclass(frozen=True, slots=True, eq=False)
class Gaits:
    """Motions of a library for people on their way.

    Parameters
    ----------
    walk, left, right
        Motions (G,) int16 and their speeds (G,) float32, ascending.
    make_room
        Motions of those who let others pass.
    """

    walk: tuple[NDArray[np.int16], NDArray[np.float32]]
    left: tuple[NDArray[np.int16], NDArray[np.float32]]
    right: tuple[NDArray[np.int16], NDArray[np.float32]]
    make_room: NDArray[np.int16]


def make_gaits(clips: Sequence[Clip], hips: int) -> list[Gait]:
    """Gaits among a character's clips.

    Parameters
    ----------
    clips
        Of the character.
    hips
        Joint that side steps move.

    Raises
    ------
    ValueError
        If there is no clip of walking.
    """
    walks = [clip for clip in clips if _WALK.match(clip.name)]
    if not walks:
        raise ValueError("the character has no clip 'walk', so nobody can come, go or be a steward")
    own = [MOTIONS[c.name].speed if c.name in MOTIONS else USUAL_SPEED for c in walks]
    found = []
    for speed in SPEEDS:
        # A slow walk is a walk with short steps rather than slow motion.
        k = int(np.argmin([abs(np.log(speed / of)) for of in own]))
        found.append(Gait(f"walk at {speed:g}", walks[k], speed / own[k], speed, "walk"))
    by_name = {clip.name: clip for clip in clips}
    for kind, name in (("left", _SIDE), ("right", f"{_SIDE}_2")):
        if name not in by_name:
            continue
        clip, pace = sideways(by_name[name], hips)
        for speed in SIDE_SPEEDS:
            found.append(Gait(f"{kind} at {speed:g}", clip, speed / abs(pace), speed, kind))
    for name in (_PASS, f"{_PASS}_2"):
        if name in by_name:
            clip = replace(by_name[name], looping=True)
            found.append(Gait(f"{name} again", clip, 1.0, 0.0, "pass"))
    return found


def sideways(clip: Clip, hips: int) -> tuple[Clip, float]:
    """The first half of a step to the side and back, as a loop on the spot.

    Parameters
    ----------
    clip
        Goes to the side and comes back.
    hips
        The joint that moves.

    Returns
    -------
    Clip
        In which what bears moves backwards.
    float
        Metres a second to +x, the left.
    """
    x = clip.translation[:, hips, 0].astype(np.float64)
    x = x - x[0]
    turn = int(np.argmax(np.abs(x)))
    apart = 1.0 - np.abs(np.sum(clip.rotation * clip.rotation[:1], axis=2)).mean(axis=1)
    late = np.flatnonzero(np.abs(x[: turn + 1]) > 0.8 * np.abs(x[turn]))
    end = int(late[np.argmin(apart[late])])
    key = clip.duration / (clip.frame_count - 1)
    seconds = end * key
    share = (np.arange(end + 1) / end)[:, None]
    rotation = clip.rotation[: end + 1].astype(np.float64)
    translation = clip.translation[: end + 1].astype(np.float64)
    translation -= share[..., None] * (translation[end] - translation[0])
    # What the last key still lacks to the first is spread over the whole.
    lack = multiply(rotation[0], rotation[end] * np.array([-1.0, -1.0, -1.0, 1.0]))
    lack = np.where(lack[:, 3:] < 0, -lack, lack)
    fraction = share[..., None]
    spread = fraction * lack + (1.0 - fraction) * np.array([0.0, 0.0, 0.0, 1.0])
    spread /= np.linalg.norm(spread, axis=2, keepdims=True)
    rotation = multiply(spread, rotation)
    for k in range(1, end + 1):
        flip = np.sum(rotation[k] * rotation[k - 1], axis=1) < 0
        rotation[k, flip] *= -1.0
    return replace(
        clip,
        name=f"{clip.name} on the spot",
        duration=seconds,
        rotation=rotation.astype(np.float32),
        translation=translation.astype(np.float32),
        scale=clip.scale[: end + 1],
        looping=True,
        events=tuple(event for event in clip.events if event.time < seconds),
    ), float(x[end] / seconds)


def add_gaits(
    library: MotionLibrary, gaits: Sequence[Gait], first_clip: int
) -> tuple[MotionLibrary, Gaits]:
    """The library with gaits as its last motions, which nobody wants for their own sake."""
    count, at = len(gaits), len(library.names)
    extended = replace(
        library,
        names=(*library.names, *(gait.name for gait in gaits)),
        clips=np.append(library.clips, np.arange(first_clip, first_clip + count)),
        innate=np.append(library.innate, np.zeros(count)),
    )

    def of(kind: str) -> tuple[NDArray[np.int16], NDArray[np.float32]]:
        chosen = [k for k, gait in enumerate(gaits) if gait.kind == kind]
        speeds = np.array([gaits[k].speed for k in chosen], np.float32)
        return np.array(chosen, np.int16) + np.int16(at), speeds

    walk = of("walk")
    left, right = (found if len(found[0]) else walk for found in (of("left"), of("right")))
    return extended, Gaits(walk, left, right, of("pass")[0])


def start_gaits(
    pool: StreamPool, gaits: Sequence[Gait], first_clip: int, streams: MotionStreams
) -> MotionStreams:
    """Start a stream for each gait, on rows that are free; places of all motions with them.

    Where other motions are shown on the pool's body types, gaits are as well.
    """
    rows = [start_staggered(pool, first_clip + k, 1, gait.rate) for k, gait in enumerate(gaits)]
    if len(pool.twins):
        for (row,) in rows:
            for kind in pool.twins.types:
                pool.add_twin(pool.stream(int(row)), kind.name)
    return streams.followed_by(rows)


def nearest(
    table: tuple[NDArray[np.int16], NDArray[np.float32]], speed: NDArray[np.float32]
) -> NDArray[np.int16]:
    """The motions (n,) of a gait whose speeds are nearest to those wanted (n,)."""
    motions, speeds = table
    middles = 0.5 * (speeds[1:] + speeds[:-1])
    chosen: NDArray[np.int16] = motions[np.searchsorted(middles, speed)]
    return chosen

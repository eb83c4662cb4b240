"""Which clips a crowd uses for what, and the streams that play them.

Characters come with all kinds of clip names. The library sorts them into roles by name, shares the
streams of a pool out among the motions, and draws motions for agents.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from ..animation.clip import Clip
from ..streams.pool import StreamPool
from ..streams.twins import Twins

SEAM = 0.6
"""Radians that a joint may turn at the seam of a loop."""


class Role(Enum):
    """What a motion is for."""

    CALM = "calm"
    APPLAUD = "applaud"
    CHEER = "cheer"
    DISMAY = "dismay"


@dataclass(frozen=True, slots=True)
class _Pattern:
    """Clips whose names match belong to `role`; `innate` weighs them when nothing happens.

    Variants of one motion, which differ only in a number at the end, share that weight.
    """

    words: str
    role: Role
    innate: float


# The first pattern that matches decides. Single-purpose clips (an attack, a death) match nothing
# and are used only if a character has nothing better.
_PATTERNS = (
    _Pattern(r"stand_?up|sit_?down|standup|sitdown", Role.CALM, 0.0),
    _Pattern(r"sit\w*clap", Role.APPLAUD, 3.0),
    _Pattern(r"clap|applau", Role.APPLAUD, 1.0),
    _Pattern(r"cheer|fist|jump_full|celebrat|dance|(^|_)jump(_\d+)?$", Role.CHEER, 0.0),
    _Pattern(r"wave|thumbsup|yes", Role.CHEER, 1.5),
    _Pattern(r"dismay|disappoint|(^|_)no$|hit_a|sad|hands_on_head", Role.DISMAY, 0.0),
    _Pattern(r"sit\w*idle|^sitting$|sit_idle", Role.CALM, 120.0),
    _Pattern(r"idle|stand", Role.CALM, 20.0),
)
_REJECTED = re.compile(
    r"2h_|1h_|block|death|unarmed|dualwield|spell|lie_|pose|jump_(idle|start|land)"
    # Parts of a reaction, and reactions on the seat: those who react get up.
    r"|_beat|mexican|^sit_(cheer|fist|wave|disappoint)",
    re.IGNORECASE,
)
_NUMBER = re.compile(r"_\d+$")
_STAND_FOR: dict[Role, tuple[Role, ...]] = {
    Role.CALM: (Role.APPLAUD, Role.CHEER),
    Role.APPLAUD: (Role.CHEER,),
    Role.CHEER: (Role.APPLAUD,),
    Role.DISMAY: (Role.CALM,),
}


@dataclass(frozen=True, slots=True, eq=False)
class MotionLibrary:
    """Motions of one crowd.

    Parameters
    ----------
    names
        K motion names, the clips' names.
    clips
        (K,) int64 clip of each motion in the pool's bank.
    roles
        Motions of each role, never empty.
    innate
        (K,) float64 probability of each motion when nothing happens; sums to 1.
    """

    names: tuple[str, ...]
    clips: NDArray[np.int64]
    roles: dict[Role, NDArray[np.int16]]
    innate: NDArray[np.float64]

    def draw(self, role: Role, count: int, rng: np.random.Generator) -> NDArray[np.int16]:
        """`count` motions of a role, each as likely as any other."""
        choices = self.roles[role]
        return np.take(choices, rng.integers(0, len(choices), count))

    def draw_innate(self, count: int, rng: np.random.Generator) -> NDArray[np.int16]:
        """`count` motions by their innate probabilities."""
        edges = np.cumsum(self.innate)
        drawn = np.searchsorted(edges, rng.random(count) * edges[-1], side="right")
        last = np.flatnonzero(self.innate)[-1]
        motions: NDArray[np.int16] = np.minimum(drawn, last).astype(np.int16)
        return motions


def sort_motions(
    clips: Sequence[Clip], most: int | None = None, wanted: Sequence[Sequence[str]] = ()
) -> MotionLibrary:
    """Sort a character's clips into roles by their names.

    Clips that don't end where they begin are no loops, whatever the file says, and are left out.
    A role that no clip matches is played by another role's motions. If no name matches at all, the
    first clip is the calm one and the second one celebrates; a single clip does everything.

    Parameters
    ----------
    clips
        The character's.
    most
        Of how many motions variants are left out, those with the highest numbers first, until so
        many are left or only one of each kind; None keeps all.
    wanted
        Clips that somebody asks for, by name: of each list the first goes before variants of other
        motions, and so do the others if there is room. Those that no role has stay without one.

    Raises
    ------
    ValueError
        If there are no clips.
    """
    if not clips:
        raise ValueError("clips: a crowd needs at least one clip")
    kept: list[int] = []
    role_of: list[Role | None] = []
    weight: list[float] = []
    rank = _ranks(wanted)
    for index, clip in enumerate(clips):
        if not (clip.looping and closes(clip)):
            continue
        pattern = _match(clip.name)
        if pattern is not None or clip.name in rank:
            kept.append(index)
            role_of.append(pattern.role if pattern else None)
            weight.append(pattern.innate if pattern else 0.0)
    kept, role_of, weight = _thinned(clips, kept, role_of, weight, most, rank)
    if not any(role_of):
        kept, role_of, weight = [0], [Role.CALM], [1.0]
        if len(clips) > 1:
            kept, role_of, weight = [0, 1], [Role.CALM, Role.CHEER], [1.0, 0.0]
    roles = {
        role: np.array([k for k, r in enumerate(role_of) if r is role], np.int16) for role in Role
    }
    full = dict(roles)
    everything = np.arange(len(kept), dtype=np.int16)
    for role in Role:
        if not len(roles[role]):
            stand_in = (roles[other] for other in _STAND_FOR[role] if len(roles[other]))
            full[role] = next(stand_in, everything)
    innate = np.array(weight)
    if innate.sum() <= 0:
        innate = np.zeros(len(kept))
        innate[full[Role.CALM]] = 1.0
    return MotionLibrary(
        names=tuple(clips[index].name for index in kept),
        clips=np.array(kept, np.int64),
        roles=full,
        innate=innate / innate.sum(),
    )


@dataclass(frozen=True, slots=True, eq=False)
class MotionStreams:
    """Which streams play each motion.

    Parameters
    ----------
    first, count
        (K,) int32: motion k is played by the stream rows ``first[k]`` to
        ``first[k] + count[k] - 1``.
    twins
        Of the pool: who shows those streams on other body types.
    shared
        (K,) int32 how many of a motion's streams, from the first on, are shown on all body types;
        None where there are no others.
    """

    first: NDArray[np.int32]
    count: NDArray[np.int32]
    twins: Twins
    shared: NDArray[np.int32] | None = None

    def draw_rows(
        self, motion: NDArray[np.int16], kind: NDArray[np.uint8], rng: np.random.Generator
    ) -> NDArray[np.int32]:
        """A stream row for each wanted motion (n,), on the body types (n,) of who wants it."""
        count = self.count[motion]
        if self.shared is not None:
            count = np.where(kind > 0, self.shared[motion], count)
        pick = (rng.random(len(motion)) * count).astype(np.int32)
        return self.twins.resolve(self.first[motion] + pick, kind)

    def followed_by(self, rows: Sequence[NDArray[np.int32]]) -> MotionStreams:
        """These and further motions, each played by consecutive rows that all body types show."""
        count = np.array([len(own) for own in rows], np.int32)
        return replace(
            self,
            first=np.append(self.first, np.array([own[0] for own in rows], np.int32)),
            count=np.append(self.count, count),
            shared=None if self.shared is None else np.append(self.shared, count),
        )


def start_streams(
    pool: StreamPool, library: MotionLibrary, streams: int, rng: np.random.Generator
) -> MotionStreams:
    """Start `streams` streams and share them out among the motions.

    Every motion gets at least one stream, and more the more agents will want it. Streams of one
    motion differ in phase and by up to 8 % in speed. With fewer streams than motions, motions
    share.

    Parameters
    ----------
    pool
        Gets the streams; must have that many free rows.
    library
        The motions.
    streams
        How many, at least 1.
    rng
        Where phases and speeds come from.
    """
    motions = len(library.names)
    # Reactions are rare in time but everybody's at once, so they get half of the streams.
    share = 0.5 * library.innate + 0.5 / motions
    wanted = np.maximum(np.floor(share * streams), 1).astype(np.int32)
    while wanted.sum() > max(streams, motions):
        wanted[np.argmax(wanted)] -= 1
    while wanted.sum() < streams:
        wanted[np.argmax(share * streams - wanted)] += 1
    first = np.concatenate([[0], np.cumsum(wanted)[:-1]]).astype(np.int32)
    if streams < motions:
        # Rows beyond the last wrap round to the streams that exist.
        first %= streams
    playing = np.repeat(np.arange(motions), wanted)[:streams]
    rows = []
    for motion in playing:
        clip = int(library.clips[motion])
        time = rng.uniform(0.0, float(pool.bank.duration[clip]))
        rows.append(pool.add(clip, time=time, speed=rng.uniform(0.92, 1.08)).row)
    return MotionStreams(first + np.int32(rows[0]), wanted, pool.twins)


def start_staggered(pool: StreamPool, clip: int, number: int, speed: float) -> NDArray[np.int32]:
    """Start streams that play a clip as a loop, at evenly spread phases; their rows (number,)."""
    times = float(pool.bank.duration[clip]) * np.arange(number) / number
    rows = [pool.add(clip, time=float(t), speed=speed, looping=True).row for t in times]
    return np.array(rows, np.int32)


def _thinned(
    clips: Sequence[Clip],
    kept: list[int],
    roles: list[Role | None],
    weights: list[float],
    most: int | None,
    rank: dict[str, int],
) -> tuple[list[int], list[Role | None], list[float]]:
    """Leave out variants beyond `most` motions, and share the weight out among the rest."""
    kinds = [_NUMBER.sub("", clips[index].name) for index in kept]
    order = [kinds[:k].count(kind) for k, kind in enumerate(kinds)]
    needed = [number == 0 and role is not None for number, role in zip(order, roles, strict=True)]
    names = [clips[index].name for index in kept]
    chosen = sorted(
        range(len(kept)),
        key=lambda k: (not needed[k], rank.get(names[k], len(rank)), order[k], k),
    )
    if most is not None:
        chosen = chosen[: max(most, needed.count(True))]
    chosen.sort()
    together = Counter(kinds[k] for k in chosen)
    return (
        [kept[k] for k in chosen],
        [roles[k] for k in chosen],
        [weights[k] / together[kinds[k]] for k in chosen],
    )


def _ranks(wanted: Sequence[Sequence[str]]) -> dict[str, int]:
    """How early each wanted clip comes: the first of every list, then the second ones, ..."""
    deepest = max(map(len, wanted), default=0)
    ordered = (names[depth] for depth in range(deepest) for names in wanted if depth < len(names))
    return {name: number for number, name in enumerate(dict.fromkeys(ordered))}


def closes(clip: Clip) -> bool:
    """Whether no joint turns by more than `SEAM` from the last key to the first."""
    dots = np.abs(np.sum(clip.rotation[0] * clip.rotation[-1], axis=1))
    return bool(2.0 * np.arccos(np.clip(dots.min(), 0.0, 1.0)) < SEAM)


def _match(name: str) -> _Pattern | None:
    if _REJECTED.search(name):
        return None
    return next((p for p in _PATTERNS if re.search(p.words, name, re.IGNORECASE)), None)

"""How likely it is that two spectators are seen to be clones of each other.

McDonnell et al. 2008 (*Clone attack! Perception of crowd variety*): people find two figures that
look alike within seconds, but need about a minute for two that only move alike. Both are taken as
searches that succeed at a constant rate, so that a pair is found within the time that one looks at
a stand with probability

    score = 1 - exp(-LOOKING * (look / LOOK_FOUND + motion / MOTION_FOUND))

where `look` and `motion` say how much alike both are, from 0 to 1.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.appearance import Appearance

LOOKING, LOOK_FOUND, MOTION_FOUND = 10.0, 5.0, 60.0
"""Seconds: how long one looks, and the mean times until clones are found."""

SIGMA = {"girth": 0.015, "scale": 0.05, "colour": 30.0, "poses": 3.0}
"""Differences that make two clearly, but not wholly different: metres, share, levels of 255 (the
root of the sum of the squares of the three channels), poses of 1/30 s."""
WEIGHTS = {"skin": 0.5, "hair": 0.7, "shirt": 1.0, "second": 0.5, "trousers": 0.8}
"""How much a colour's difference counts: what is larger is looked at more."""
UNLIKE = {"kind": 3.0, "pattern": 1.5, "parts": 1.5}
"""What another body type, another pattern of the shirt, or other things worn count, in squares of
half a clear difference: look is multiplied by exp(-value)."""

F32 = NDArray[np.float32]
Pairs = NDArray[np.int32]


@dataclass(frozen=True, slots=True, eq=False)
class Features:
    """What of N agents can be alike, so scaled that distances count.

    Parameters
    ----------
    build
        (N, 2) float32 girth and scale.
    colours
        (N, 15) float32 skin, hair, shirt, second, trousers.
    kinds
        (N, 3) int64 body type, pattern, part bits.
    stream
        (N,) int64 whose motion an agent shows; -1 where that is nobody else's.
    offset
        (N,) float32 poses behind the stream's head.
    """

    build: F32
    colours: F32
    kinds: NDArray[np.int64]
    stream: NDArray[np.int64]
    offset: F32

    def look(self, pairs: Pairs) -> F32:
        """(P,) how much pairs (P, 2) look alike, 0 to 1."""
        one, other = pairs[:, 0], pairs[:, 1]
        far = 0.5 * ((self.build[one] - self.build[other]) ** 2).sum(axis=1)
        far += 0.5 * ((self.colours[one] - self.colours[other]) ** 2).sum(axis=1)
        unlike = self.kinds[one] != self.kinds[other]
        far += unlike @ np.array([UNLIKE[name] for name in ("kind", "pattern", "parts")])
        alike: F32 = np.exp(-far).astype(np.float32)
        return alike

    def motion(self, pairs: Pairs) -> F32:
        """(P,) how much pairs (P, 2) move alike, 0 to 1."""
        one, other = pairs[:, 0], pairs[:, 1]
        same = (self.stream[one] == self.stream[other]) & (self.stream[one] >= 0)
        apart = (self.offset[one] - self.offset[other]) / SIGMA["poses"]
        return np.where(same, np.exp(-0.5 * apart**2), 0.0).astype(np.float32)

    def swapped(self, source: NDArray[np.int64], *, looks: bool) -> Features:
        """As if each agent k had the clothes, skin and hair (or the motion) of ``source[k]``."""
        if not looks:
            return Features(
                self.build, self.colours, self.kinds, self.stream[source], self.offset[source]
            )
        kinds = self.kinds.copy()
        kinds[:, 1] = kinds[source, 1]
        return Features(self.build, self.colours[source], kinds, self.stream, self.offset)


def clone_features(
    kind: NDArray[np.uint8],
    girth: NDArray[np.float32],
    scale: NDArray[np.float32],
    looks: Appearance,
    stream: NDArray[np.int64],
    offset: NDArray[np.float32],
    *,
    bits: NDArray[np.uint32] | None = None,
) -> Features:
    """Features of a crowd.

    Parameters
    ----------
    kind, girth, scale
        (N,) body types, metres of girth, and sizes as factors on a grown-up's mean.
    looks
        Clothes, skin and hair.
    stream, offset
        (N,) the streams, those that twins mirror, and poses behind their heads; -1 for motions that
        are not shared.
    bits
        (N,) the parts that agents have.
    """
    count = len(scale)
    build = np.stack([girth / SIGMA["girth"], scale / SIGMA["scale"]], axis=1)
    colours = [
        getattr(looks, name)[:, :3].astype(np.float32) * np.sqrt(weight) / SIGMA["colour"]
        for name, weight in WEIGHTS.items()
    ]
    # A plain shirt has no second colour that could be seen.
    second = list(WEIGHTS).index("second")
    shirt = list(WEIGHTS).index("shirt")
    plain = (looks.pattern == 0)[:, None]
    ratio = np.float32(np.sqrt(WEIGHTS["second"] / WEIGHTS["shirt"]))
    colours[second] = np.where(plain, colours[shirt] * ratio, colours[second])
    none = np.zeros(count, np.uint32)
    kinds = np.stack([kind, looks.pattern, none if bits is None else bits], axis=1)
    return Features(
        build=build.astype(np.float32),
        colours=np.concatenate(colours, axis=1).astype(np.float32),
        kinds=kinds.astype(np.int64),
        stream=np.asarray(stream, np.int64),
        offset=np.asarray(offset, np.float32),
    )


def clone_score(look: F32, motion: F32) -> F32:
    """(P,) probability that pairs are found to be clones while one looks at them."""
    rate = look / LOOK_FOUND + motion / MOTION_FOUND
    return (-np.expm1(-LOOKING * rate)).astype(np.float32)


@dataclass(frozen=True, slots=True)
class CloneReport:
    """What the neighbours of a crowd share.

    Parameters
    ----------
    pairs
        How many pairs of neighbours there are.
    score
        Mean clone score.
    worst
        The highest.
    found
        How many pairs have a score of at least one half.
    same_look, same_motion, same_both
        Shares of pairs: body, shirt and colours alike; stream and offset alike; all of it.
    """

    pairs: int
    score: float
    worst: float
    found: int
    same_look: float
    same_motion: float
    same_both: float

    def figures(self) -> Mapping[str, float]:
        """By name."""
        return {name: getattr(self, name) for name in self.__slots__}


ALIKE = 0.6
"""What two share is the same to the eye if they are alike to at least this: one clear difference
makes 0.61, and so do three poses."""
_AT_ONCE = 1_000_000


def report_clones(features: Features, pairs: Pairs) -> CloneReport:
    """Score all pairs (P, 2)."""
    look, motion = likenesses(features, pairs)
    score = clone_score(look, motion)
    count = max(len(pairs), 1)
    alike, moving = look >= ALIKE, motion >= ALIKE
    return CloneReport(
        pairs=len(pairs),
        score=float(score.sum(dtype=np.float64) / count),
        worst=float(score.max(initial=0.0)),
        found=int((score >= 0.5).sum()),
        same_look=float(alike.sum() / count),
        same_motion=float(moving.sum() / count),
        same_both=float((alike & moving).sum() / count),
    )


def likenesses(features: Features, pairs: Pairs) -> tuple[F32, F32]:
    """(P,) look and motion of many pairs, some at a time."""
    look, motion = np.empty(len(pairs), np.float32), np.empty(len(pairs), np.float32)
    for begin in range(0, len(pairs), _AT_ONCE):
        some = slice(begin, begin + _AT_ONCE)
        look[some], motion[some] = features.look(pairs[some]), features.motion(pairs[some])
    return look, motion

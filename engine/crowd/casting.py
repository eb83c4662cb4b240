"""Casting: neighbours who look or move too much alike change places with others.

Looks and motions are drawn for every agent by itself, so in a large crowd some neighbours are
drawn alike by chance. Here they swap clothes, skin and hair, or stream and offset, with somebody
of their own side, age and motion who sits elsewhere. A swap leaves every share as it was drawn: how
many wear their side's colour, how many have grey hair, how many play each motion.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from ...components.animation import AgentAnimID
from ...components.appearance import Appearance
from .clones import Features, Pairs, clone_score, likenesses

PASSES = 6
"""Rounds of swaps, for looks and for motions each."""
TOO_ALIKE = 0.25
"""Pairs that look or move alike by more than this try to find a swap."""

I64 = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Casting:
    """Who gets whose.

    Parameters
    ----------
    looks, motions
        (N,) int64 permutations: agent k gets what was drawn for ``looks[k]``, ``motions[k]``.
    """

    looks: I64
    motions: I64

    def dress(self, looks: Appearance) -> None:
        """Swap appearances."""
        for column in fields(looks):
            values = getattr(looks, column.name)
            if isinstance(values, np.ndarray):
                values[:] = values[self.looks]
        looks.version += 1

    def move(self, anim: AgentAnimID) -> None:
        """Swap rows and offsets of the bodies, which rest."""
        for column in (anim.row, anim.start, anim.target):
            column[0] = column[0, self.motions]
        anim.version += 1


def cast(
    features: Features,
    pairs: Pairs,
    look_class: I64,
    motion_class: I64,
    rng: np.random.Generator,
    *,
    passes: int = PASSES,
) -> Casting:
    """Find swaps that lower the sum of the clone scores of all pairs.

    Parameters
    ----------
    features, pairs
        The agents as drawn, and (P, 2) who sits near whom.
    look_class, motion_class
        (N,) agents swap only within a class; those of a negative class never.
    rng
        Where proposals come from.
    passes
        How many rounds; the time that it takes is bounded by it.
    """
    count = len(features.offset)
    looks, motions = np.arange(count), np.arange(count)
    current = features
    values = likenesses(features, pairs)
    for _ in range(passes):
        for looking, classes in ((True, look_class), (False, motion_class)):
            swap, current, values = _round(current, values, pairs, classes, rng, looking)
            if looking:
                looks = looks[swap]
            else:
                motions = motions[swap]
    return Casting(looks, motions)


Values = tuple[NDArray[np.float32], NDArray[np.float32]]


def _round(
    features: Features,
    values: Values,
    pairs: Pairs,
    classes: I64,
    rng: np.random.Generator,
    looking: bool,
) -> tuple[I64, Features, Values]:
    """One round of swaps; what is kept lowers the sum."""
    count = len(classes)
    nobody = np.arange(count)
    score = clone_score(*values)
    chosen = _chosen(values[0] if looking else values[1], score, pairs, classes, count)
    one, other = _partners(chosen, classes, rng)
    if not len(one):
        return nobody, features, values
    source = nobody.copy()
    source[one], source[other] = other, one
    touched = np.flatnonzero((source != nobody)[pairs].any(axis=1))
    tried = clone_score(*likenesses(features.swapped(source, looks=looking), pairs[touched]))
    # Those swaps stay that lower the scores around the two who swapped.
    less = tried - score[touched]
    ends = pairs[touched]
    change = np.bincount(ends[:, 0], less, count) + np.bincount(ends[:, 1], less, count)
    good = change[one] + change[other] < 0.0
    source = nobody.copy()
    source[one[good]], source[other[good]] = other[good], one[good]
    after = features.swapped(source, looks=looking)
    now = likenesses(after, pairs[touched])
    # Swaps next to each other were judged as if both happened.
    if clone_score(*now).sum(dtype=np.float64) >= score[touched].sum(dtype=np.float64):
        return nobody, features, values
    new = values[0].copy(), values[1].copy()
    new[0][touched], new[1][touched] = now
    return source, after, new


def _chosen(
    likeness: NDArray[np.float32],
    score: NDArray[np.float32],
    pairs: Pairs,
    classes: I64,
    count: int,
) -> I64:
    """Of each pair that is too much alike, the agent who is more alike to those around."""
    bad = pairs[likeness > TOO_ALIKE]
    sums = np.bincount(pairs[:, 0], score, count) + np.bincount(pairs[:, 1], score, count)
    worse = np.where(sums[bad[:, 0]] > sums[bad[:, 1]], bad[:, 0], bad[:, 1])
    found = np.unique(worse)
    able: I64 = found[classes[found] >= 0].astype(np.int64)
    return able


def _partners(chosen: I64, classes: I64, rng: np.random.Generator) -> tuple[I64, I64]:
    """Chosen agents, and for each another one of its class; nobody twice."""
    order = np.argsort(classes, kind="stable")
    first = np.searchsorted(classes[order], classes[chosen], side="left")
    last = np.searchsorted(classes[order], classes[chosen], side="right")
    drawn = order[first + (rng.random(len(chosen)) * (last - first)).astype(np.int64)]
    free = ~np.isin(drawn, chosen)
    _, once = np.unique(drawn[free], return_index=True)
    return chosen[free][once], drawn[free][once]

"""How states look: which variants and motions they have, and which of them agents take."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

KEEP = -1
"""A motion or channel value that leaves things as they are."""


@dataclass(frozen=True, slots=True, eq=False)
class Look:
    """How a state can look.

    Parameters
    ----------
    motion
        (L,) int16 motions of the library; -1 keeps what is shown.
    variant
        (L,) int16 which variant each is of.
    chance
        (L,) float64 1 / effort, shared among the motions of a variant.
    excitement
        (L,) float32 from which on each is used.
    """

    motion: NDArray[np.int16]
    variant: NDArray[np.int16]
    chance: NDArray[np.float64]
    excitement: NDArray[np.float32]


class Looks:
    """The looks of all states, padded to those of the state that has the most (W).

    Parameters
    ----------
    looks
        By state.
    """

    def __init__(self, looks: Sequence[Look]) -> None:
        self._looks = tuple(looks)
        most = max(len(look.motion) for look in looks)
        self._width = most
        shape = (len(looks), most)
        self._count = np.array([len(look.motion) for look in looks], np.int16)
        self._motion = np.full(shape, KEEP, np.int16)
        self._variant = np.zeros(shape, np.int16)
        self._chance = np.zeros(shape, np.float32)
        self._from = np.full(shape, np.inf, np.float32)
        for row, look in enumerate(looks):
            count = len(look.motion)
            self._motion[row, :count], self._variant[row, :count] = look.motion, look.variant
            self._chance[row, :count] = look.chance
            # Whoever is less excited than all of them ask for has the calmest ones.
            calmest = look.excitement == look.excitement.min()
            self._from[row, :count] = np.where(calmest, -np.inf, look.excitement)

    def __getitem__(self, state: int) -> Look:
        """Of one state."""
        return self._looks[state]

    def __iter__(self) -> Iterator[Look]:
        """Of all states."""
        return iter(self._looks)

    def draw(
        self,
        state: NDArray[np.int16],
        excitement: NDArray[np.float32],
        rng: np.random.Generator,
    ) -> tuple[NDArray[np.int16], NDArray[np.int16]]:
        """(K,) variants and motions for agents that enter states, by effort.

        The more excited someone is, the more there are.

        Parameters
        ----------
        state, excitement
            (K,) of each agent.
        rng
            Where choices come from.
        """
        pick = np.zeros(len(state), np.intp)
        some = np.flatnonzero(self._count.take(state) > 1)
        if len(some):
            pick[some] = self._pick(state.take(some), excitement.take(some), rng)
        pick += state.astype(np.intp) * self._width
        return self._variant.ravel().take(pick), self._motion.ravel().take(pick)

    def _pick(
        self,
        state: NDArray[np.int16],
        excitement: NDArray[np.float32],
        rng: np.random.Generator,
    ) -> NDArray[np.intp]:
        """(K,) which of its state's looks each agent takes."""
        count = self._count.take(state)
        edges = []
        total = np.zeros(len(state), np.float32)
        for number in range(int(count.max())):
            chance = self._chance[:, number].take(state)
            chance *= self._from[:, number].take(state) <= excitement
            total = total + chance
            edges.append(total)
        draw = rng.random(len(state), np.float32)
        draw *= total
        np.minimum(draw, np.nextafter(total, np.float32(0.0)), out=draw)
        pick = np.zeros(len(state), np.intp)
        for edge in edges:
            pick += edge <= draw
        return np.minimum(pick, count - 1)

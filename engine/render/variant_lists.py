"""Who is drawn with which meshes of one level of detail: everybody's, and those of variants."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..assets.character import Character
from ..assets.variants import MOST_CHOICES, default_choices, variant_groups
from .skinned_pass import Draw, InstanceList


class VariantLists:
    """Lists of agents of one level, one for every choice of the character's variants.

    Parameters
    ----------
    character
        Its coarsest level stands for missing ones.
    level
        Which level.

    Attributes
    ----------
    draws
        For a `SkinnedPass`, which owns the lists.
    """

    def __init__(self, character: Character, level: int) -> None:
        levels = (character.meshes, *character.lower_levels)
        meshes = levels[min(level, len(levels) - 1)]
        self._default = np.array(list(default_choices(character).values()), np.uint8)
        common = [mesh for mesh in meshes if mesh.variant is None]
        self._everybody = InstanceList() if common else None
        self.draws: list[Draw] = []
        if self._everybody is not None:
            self.draws.append((common, self._everybody))
        self._groups: list[list[InstanceList]] = []
        for group, choices in variant_groups(character).items():
            lists = []
            for choice in choices:
                own = [
                    mesh
                    for mesh in meshes
                    if mesh.variant is not None
                    and (mesh.variant.group, mesh.variant.choice) == (group, choice.choice)
                ]
                lists.append(InstanceList())
                self.draws.append((own, lists[-1]))
            self._groups.append(lists)

    def write(self, ids: NDArray[np.uint32], choice: NDArray[np.uint8] | None) -> int:
        """Copy the ids of a level's agents, each to the lists of its choices; bytes copied.

        Parameters
        ----------
        ids
            (n,) ascending.
        choice
            (G, N) choices of all agents; as `default_choices` has them if None or without groups.
        """
        copied = 0 if self._everybody is None else self._everybody.write(ids)
        for group, lists in enumerate(self._groups):
            if choice is None or not len(choice):
                column = np.broadcast_to(self._default[group], len(ids))
            else:
                column = choice[group][ids]
            # Sorting bytes is one pass; each choice's ids stay ascending.
            sorted_ids = ids[np.argsort(column, kind="stable")]
            ends = np.cumsum(np.bincount(column, minlength=MOST_CHOICES + 1))
            first = 0
            for agents, end in zip(lists, ends.tolist(), strict=False):
                if end > first:
                    copied += agents.write(sorted_ids[first:end])
                agents.count = end - first
                first = end
        return copied

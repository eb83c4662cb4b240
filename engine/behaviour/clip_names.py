"""Which of a character's clips a behaviour table means, by their names."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .table import POSTURES, SEATED, BehaviourTable, State, Variant

_SEATED = re.compile(r"^sit", re.IGNORECASE)
_FORM = re.compile(r"^(sit|stand)_", re.IGNORECASE)


def is_seated(name: str) -> bool:
    """Whether a clip is one of somebody who sits."""
    return bool(_SEATED.match(name))


def matching(variant: Variant, state: State, names: Sequence[str]) -> list[int]:
    """Places in `names` of the clips that can show a variant of a state.

    Where a posture is given, clips of the other one count only if there are no better ones. A state
    that leaves the posture as it is means the standing form of each clip; `other_form` has the
    seated one.
    """
    found: list[int] = []
    if isinstance(variant.clips, str):
        words = re.compile(variant.clips, re.IGNORECASE)
        found = [k for k, name in enumerate(names) if words.fullmatch(name)]
    else:
        found = [names.index(name) for name in variant.clips if name in names][:1]
    sits = state.posture == POSTURES[SEATED]
    fitting = [k for k in found if is_seated(names[k]) == sits]
    return fitting or found


def other_form(names: Sequence[str]) -> NDArray[np.int16]:
    """(K,) for each clip the one of the same motion in the other posture; itself if there is none.

    ``sit_talk_2`` and ``talk_2`` are two forms of one motion, ``sit_idle`` and ``stand_idle`` too.
    """
    places = {(is_seated(name), _FORM.sub("", name).lower()): k for k, name in enumerate(names)}
    return np.array(
        [
            places.get((not is_seated(name), _FORM.sub("", name).lower()), k)
            for k, name in enumerate(names)
        ],
        np.int16,
    )


def wanted_clips(table: BehaviourTable, names: Sequence[str]) -> list[list[str]]:
    """For each variant of each state, the clips that can show it, the best first."""
    other = other_form(names)
    wanted: list[list[str]] = []
    for state in table.states:
        for variant in state.variants:
            found = matching(variant, state, names)
            wanted.append([names[k] for k in found])
            if state.posture is None:
                wanted.append([names[other[k]] for k in found])
    return wanted

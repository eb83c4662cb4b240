"""Things that spectators have with them, made entirely by this package's own code.

They are fitted to the built-in spectator; `Prop.hook` and `Prop.transform` say where they go.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np

from ..character import Character
from ..spectator.skeleton import spectator_skeleton
from .beat import drumming
from .cap import make_cap
from .drum import make_drum
from .flag import make_flag
from .foam_hand import make_foam_hand
from .prop import Prop
from .scarf import make_scarf

__all__ = ["PROPS", "Prop", "builtin_prop", "drumming", "fits"]

_MAKERS: dict[str, Callable[[], Prop]] = {
    "cap": make_cap,
    "drum": make_drum,
    "flag": make_flag,
    "foam_hand": make_foam_hand,
    "scarf": make_scarf,
}
PROPS = tuple(_MAKERS)
"""Names of the props that there are."""


@cache
def builtin_prop(name: str) -> Prop:
    """A prop for the built-in spectator.

    Parameters
    ----------
    name
        ``"cap"`` (on the head), ``"drum"`` (before the belly, with sticks in both hands),
        ``"flag"`` (in the right hand; clips ``wave`` and ``hang``), ``"foam_hand"`` (over the right
        hand) or ``"scarf"`` (round the neck; clips ``hang`` and ``swing``).

    Raises
    ------
    ValueError
        For another name.
    """
    if name not in _MAKERS:
        raise ValueError(f"name is {name!r}, expected one of {', '.join(PROPS)}")
    return _MAKERS[name]()


def fits(character: Character) -> bool:
    """Whether a character has the built-in spectator's joints, so that the props fit it."""
    given, made_for = character.skeleton, spectator_skeleton()
    return given.names == made_for.names and bool(
        np.allclose(given.inverse_bind, made_for.inverse_bind, atol=1e-3)
    )

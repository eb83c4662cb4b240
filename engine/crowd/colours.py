"""What spectators wear: skin, hair and clothes drawn per agent.

Colours are drawn from palettes and varied in hue, saturation and brightness within limits for each
part (*Thesis* 4.1). Supporters wear their side's shirt, with or without its pattern, or something
muted, so that a stand reads as home or away without looking painted.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...components.appearance import Appearance
from .body_types import CHILD, OLD
from .hsb import Limits, varied
from .kits import KITS, Kit

TEAM_COLOURS: tuple[tuple[int, int, int], ...] = tuple(kit.colour for kit in KITS)
"""sRGB of the home and the away side, and of further ones."""

PATTERNED = 0.7
"""Share of those in their side's colour whose shirt has its pattern; others' shirts are plain."""
GREY = {CHILD: 0.0, OLD: 0.85}
"""Share of those with grey hair in each age; of all others:"""
GREY_ADULTS = 0.06

LIMITS = {
    "skin": Limits((0.03, 0.10), (0.20, 0.62), (0.30, 1.0)),
    "hair": Limits((0.0, 0.125), (0.12, 0.72), (0.08, 0.85)),
    "grey hair": Limits((0.0, 0.125), (0.0, 0.10), (0.42, 0.92)),
    "shirt": Limits((0.0, 1.0), (0.0, 0.62), (0.14, 0.95)),
    "trousers": Limits((0.0, 1.0), (0.0, 0.55), (0.10, 0.72)),
    "shoes": Limits((0.0, 1.0), (0.0, 0.60), (0.08, 0.95)),
}
"""Where colours stay, by part. Skin is a narrow range of hue with little saturation; clothes of
people who wear no team's colour are muted. Team shirts are as bright as the team's are."""

_TEAM = Limits((0.0, 1.0), (0.0, 1.0), (0.0, 1.0))

# Standard deviations of hue in turns, and of saturation and brightness as factors.
_SPREAD = {
    "skin": (0.004, 0.06, 0.05),
    "hair": (0.008, 0.10, 0.14),
    "grey hair": (0.02, 0.4, 0.10),
    "shirt": (0.03, 0.25, 0.14),
    "trousers": (0.015, 0.20, 0.16),
    "shoes": (0.01, 0.10, 0.10),
    # Shirts of one team fade, but keep their hue.
    "team": (0.0, 0.0, 0.07),
}

_SKIN = (
    *((255, 219, 190), (241, 194, 160), (224, 172, 130)),
    *((198, 134, 92), (141, 85, 54), (84, 52, 36)),
)
_SKIN_SHARE = (0.2, 0.3, 0.2, 0.14, 0.1, 0.06)
_HAIR = ((28, 22, 18), (54, 36, 24), (92, 62, 38), (122, 62, 34), (150, 110, 62), (196, 164, 108))
_HAIR_SHARE = (0.32, 0.29, 0.19, 0.03, 0.1, 0.07)
_HAIR_SHARE_CHILD = (0.24, 0.24, 0.2, 0.05, 0.14, 0.13)
_GREY_HAIR = ((128, 126, 124), (168, 166, 162), (206, 204, 200))
_CLOTHES = (
    *((38, 40, 46), (70, 74, 82), (230, 228, 222), (52, 66, 96), (94, 86, 72), (128, 130, 134)),
    *((66, 84, 66), (140, 110, 84), (186, 178, 166), (96, 52, 56), (92, 120, 140), (164, 138, 92)),
)
_TROUSERS = (
    *((44, 52, 78), (30, 32, 38), (66, 76, 104), (96, 88, 76), (74, 74, 78), (118, 106, 86)),
    *((56, 66, 56), (92, 104, 130)),
)
_SHOES = ((34, 32, 32), (225, 225, 222), (84, 62, 46))


def draw_appearance(
    side: NDArray[np.int8],
    rng: np.random.Generator,
    *,
    fervour: float = 0.62,
    kind: NDArray[np.uint8] | None = None,
    kits: Sequence[Kit] = KITS,
) -> Appearance:
    """Colours for every agent.

    Parameters
    ----------
    side
        (N,) 0 home, 1 away, further sides, -1 neutral.
    rng
        Where choices come from.
    fervour
        Share of supporters in their side's colour.
    kind
        (N,) body types, which tell ages: old people's hair is mostly grey and children's never.
    kits
        Shirts of the sides.

    Raises
    ------
    ValueError
        If a side has no kit.
    """
    count = len(side)
    if count and int(side.max()) >= len(kits):
        raise ValueError(f"kits has {len(kits)} shirts, expected {int(side.max()) + 1} or more")
    looks = Appearance(
        skin=_varied("skin", _pick(_SKIN, count, rng, _SKIN_SHARE), rng),
        hair=_hair(count, kind, rng),
        shirt=_varied("shirt", _pick(_CLOTHES, count, rng), rng),
        trousers=_varied("trousers", _pick(_TROUSERS, count, rng), rng),
        shoes=_varied("shoes", _pick(_SHOES, count, rng), rng),
    )
    looks.second = looks.shirt.copy()
    in_colours = (side >= 0) & (rng.random(count) < fervour)
    patterned = in_colours & (rng.random(count) < PATTERNED)
    faded = np.random.default_rng(rng.integers(2**63))
    for colours, name in ((looks.shirt, "colour"), (looks.second, "second")):
        palette = np.array([getattr(kit, name) for kit in kits] or [(0, 0, 0)], np.float64)
        own = varied(palette[side], _SPREAD["team"], _TEAM, faded)
        colours[in_colours] = own[in_colours]
    numbers = np.array([kit.number for kit in kits] or [0], np.uint8)
    looks.pattern[patterned] = numbers[side[patterned]]
    return looks


def _hair(
    count: int, kind: NDArray[np.uint8] | None, rng: np.random.Generator
) -> NDArray[np.uint8]:
    age = np.zeros(count, np.uint8) if kind is None else kind
    grown = _pick(_HAIR, count, rng, _HAIR_SHARE)
    young = _pick(_HAIR, count, rng, _HAIR_SHARE_CHILD)
    hair = _varied("hair", np.where((age == CHILD)[:, None], young, grown), rng)
    share = np.full(256, GREY_ADULTS)
    share[list(GREY)] = list(GREY.values())
    grey = rng.random(count) < share[age]
    turned = _varied("grey hair", _pick(_GREY_HAIR, count, rng), rng)
    hair[grey] = turned[grey]
    return hair


def _pick(
    palette: Sequence[tuple[int, int, int]],
    count: int,
    rng: np.random.Generator,
    share: Sequence[float] | None = None,
) -> NDArray[np.float64]:
    return np.array(palette, np.float64)[rng.choice(len(palette), count, p=share)]


def _varied(part: str, colours: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.uint8]:
    return varied(colours, _SPREAD[part], LIMITS[part], rng)

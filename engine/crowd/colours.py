"""What spectators wear: skin, hair and clothes drawn per agent.

Skin tones vary along one line of hue and lightness, as real ones do; supporters wear their side's
colour or something muted, so that a stand reads as home or away without looking painted.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components.appearance import Appearance

TEAM_COLOURS: tuple[tuple[int, int, int], ...] = (
    *((198, 30, 45), (36, 84, 176), (238, 190, 40), (30, 130, 76)),
    *((232, 116, 34), (112, 52, 148), (64, 178, 200), (236, 96, 166)),
)
"""sRGB of the home and the away side, and of further ones."""

_SKIN = np.array(
    [
        (255, 219, 190),
        (241, 194, 160),
        (224, 172, 130),
        (198, 134, 92),
        (141, 85, 54),
        (84, 52, 36),
    ],
    np.float32,
)
_SKIN_SHARE = np.array([0.2, 0.3, 0.2, 0.14, 0.1, 0.06])
_HAIR = np.array(
    [(28, 22, 18), (54, 36, 24), (92, 62, 38), (150, 110, 62), (196, 164, 108), (150, 148, 146)],
    np.float32,
)
_HAIR_SHARE = np.array([0.3, 0.27, 0.18, 0.1, 0.08, 0.07])
_CLOTHES = np.array(
    [
        (38, 40, 46),
        (70, 74, 82),
        (230, 228, 222),
        (52, 66, 96),
        (94, 86, 72),
        (128, 130, 134),
        (66, 84, 66),
        (140, 110, 84),
        (186, 178, 166),
        (96, 52, 56),
    ],
    np.float32,
)
_TROUSERS = np.array(
    [(44, 52, 78), (30, 32, 38), (66, 76, 104), (96, 88, 76), (74, 74, 78), (118, 106, 86)],
    np.float32,
)
_SHOES = np.array([(34, 32, 32), (225, 225, 222), (84, 62, 46)], np.float32)


def draw_appearance(
    side: NDArray[np.int8], rng: np.random.Generator, *, fervour: float = 0.62
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
    """
    count = len(side)
    team = np.array([*TEAM_COLOURS, (0, 0, 0)], np.float32)[side]
    shirt = _pick(_CLOTHES, None, count, rng)
    in_colours = (side >= 0) & (rng.random(count) < fervour)
    shirt[in_colours] = team[in_colours]
    return Appearance(
        skin=_vary(_pick(_SKIN, _SKIN_SHARE, count, rng), 0.05, rng),
        hair=_vary(_pick(_HAIR, _HAIR_SHARE, count, rng), 0.12, rng),
        shirt=_vary(shirt, 0.14, rng),
        trousers=_vary(_pick(_TROUSERS, None, count, rng), 0.15, rng),
        shoes=_vary(_pick(_SHOES, None, count, rng), 0.1, rng),
    )


def _pick(
    palette: NDArray[np.float32],
    share: NDArray[np.float64] | None,
    count: int,
    rng: np.random.Generator,
) -> NDArray[np.float32]:
    return palette[rng.choice(len(palette), count, p=share)]


def _vary(
    colour: NDArray[np.float32], spread: float, rng: np.random.Generator
) -> NDArray[np.uint8]:
    """Make colours lighter or darker by a factor of about 1 +- spread; hue stays."""
    factor = rng.normal(1.0, spread, (len(colour), 1)).clip(1 - 2 * spread, 1 + 2 * spread)
    out = np.full((len(colour), 4), 255, np.uint8)
    out[:, :3] = np.clip(colour * factor, 0, 255)
    return out

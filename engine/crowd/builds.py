"""How the agents of a crowd are built: children and old people among adults, wide and slim ones."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components.body import Body
from .body_types import ADULT, CHILD, OLD

_SIZE = {
    ADULT: (1.0, 0.045, 0.88, 1.12),
    CHILD: (0.72, 0.07, 0.58, 0.86),
    OLD: (0.97, 0.04, 0.86, 1.08),
}
"""Mean, spread, least and most of each type's scale."""
_WOMAN_SIZE = {ADULT: 0.935, CHILD: 1.0, OLD: 0.94}
"""Factor on the scale of women and girls."""
_GIRTH = {ADULT: (0.012, 0.022), CHILD: (-0.004, 0.010), OLD: (0.022, 0.024)}
"""Mean and spread in metres on a body 1.75 m tall."""
GIRTH_RANGE = (-0.025, 0.09)
_HEAD_SPREAD = 0.03
HEAD_RANGE = (-0.08, 0.08)


def draw_bodies(
    count: int,
    children: float,
    old: float,
    height: float,
    rng: np.random.Generator,
    *,
    women: float = 0.0,
    is_child: NDArray[np.bool_] | None = None,
) -> tuple[Body, NDArray[np.float32]]:
    """Bodies of `count` agents, and their uniform scales on a character of adult size.

    Parameters
    ----------
    count
        N.
    children, old
        Shares of the agents, at most 1 together.
    height
        Of the character in model space, for girths in its units.
    rng
        Where choices come from.
    women
        Share of women among the grown-ups, and of girls among the children.
    is_child
        (N,) who the children are; drawn if None.
    """
    body = Body.allocate(count)
    draw = rng.random(count)
    if is_child is None:
        is_child = draw < children
        draw = draw - children
    else:
        draw *= 1.0 - children
    body.kind[draw < old] = OLD
    body.kind[is_child] = CHILD
    spread, wide = rng.standard_normal((2, count))
    scale = np.empty(count)
    for kind in (ADULT, CHILD, OLD):
        some = body.kind == kind
        mean, deviation, least, most = _SIZE[kind]
        scale[some] = np.clip(mean + deviation * spread[some], least, most)
        mean, deviation = _GIRTH[kind]
        body.girth[some] = np.clip(mean + deviation * wide[some], *GIRTH_RANGE)
    body.girth *= np.float32(height / 1.75)
    body.woman[:] = rng.random(count) < women
    for kind, factor in _WOMAN_SIZE.items():
        scale[body.woman & (body.kind == kind)] *= factor
    body.head[:] = np.clip(_HEAD_SPREAD * rng.standard_normal(count), *HEAD_RANGE)
    return body, scale.astype(np.float32)

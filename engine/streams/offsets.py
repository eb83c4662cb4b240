"""First offsets of agents on their streams (*Streams 2017*, 4.1: random normal, or the user's)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np
from numpy.typing import NDArray

OffsetSource = (
    Literal["normal", "uniform"] | Callable[[np.random.Generator, int], NDArray[np.float32]]
)


def initial_offsets(
    source: OffsetSource, count: int, history: int, rng: np.random.Generator
) -> NDArray[np.float32]:
    """Offsets for `count` agents on streams that keep `history` poses.

    Parameters
    ----------
    source
        ``"normal"``: clipped normal about the middle of the history, a quarter of it wide;
        ``"uniform"``; or a function of the generator and the count that returns offsets in poses.
    count, history
        Number of agents, and M.
    rng
        Where random offsets come from.

    Returns
    -------
    (count,) float32 in [0, M - 2]: the mix of two slices needs one more pose.

    Raises
    ------
    ValueError
        If a user's function returns another shape or values that are not finite or outside
        the history.
    """
    longest = history - 2
    if source == "uniform":
        return rng.uniform(0.0, longest, count).astype(np.float32)
    if source == "normal":
        drawn = rng.normal(longest / 2, history / 4, count)
        return np.clip(drawn, 0.0, longest).astype(np.float32)
    if not callable(source):
        raise ValueError(f"offsets is {source!r}, expected 'normal', 'uniform' or a function")
    own = np.asarray(source(rng, count), dtype=np.float32)
    if own.shape != (count,):
        raise ValueError(f"offsets: the function returned shape {own.shape}, expected ({count},)")
    if not (np.isfinite(own).all() and (own >= 0).all() and (own <= longest).all()):
        raise ValueError(f"offsets: the function returned values outside 0 to {longest} poses")
    return own

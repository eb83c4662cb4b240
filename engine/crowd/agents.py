"""What a caller names agents by, and gives for each of them, as checked columns."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def agent_ids(agents: int | ArrayLike, count: int) -> NDArray[np.int64]:
    """Ids of the agents that are meant.

    Parameters
    ----------
    agents
        An id, a sequence of ids, or a (count,) boolean mask.
    count
        Agents of the crowd.

    Returns
    -------
    (K,) int64

    Raises
    ------
    ValueError
        For anything else, or ids that don't exist.
    """
    given = np.asarray(agents)
    if given.dtype == np.bool_:
        if given.shape != (count,):
            raise ValueError(f"agents: the mask has shape {given.shape}, expected ({count},)")
        return np.flatnonzero(given)
    if given.size == 0:
        return np.zeros(0, np.int64)
    if given.ndim > 1 or given.dtype.kind not in "iu":
        raise ValueError(f"agents is {agents!r}, expected an id, ids, or a mask of {count}")
    ids = np.atleast_1d(given).astype(np.int64)
    if ids.min() < 0 or ids.max() >= count:
        wrong = ids[(ids < 0) | (ids >= count)][0]
        raise ValueError(f"agents: there is no agent {wrong}, expected 0 to {count - 1}")
    return ids


def agent_values(
    name: str,
    values: float | ArrayLike,
    count: int,
    least: float,
    most: float,
    *,
    drawn: bool = False,
) -> NDArray[np.float32]:
    """One value for each of `count` agents, or one for all.

    Parameters
    ----------
    name
        Of the argument, for messages.
    values
        A number or (count,) numbers.
    count, least, most
        How many agents there are, and what is allowed.
    drawn
        Whether NaN stands for a value to be drawn.

    Raises
    ------
    ValueError
        For another shape, or values out of range or not finite.
    """
    given = np.asarray(values, dtype=np.float32)
    if given.shape not in ((), (count,)):
        raise ValueError(f"{name} has shape {given.shape}, expected a number or ({count},) numbers")
    good = np.isfinite(given) & (given >= least) & (given <= most)
    if not (good | (drawn & np.isnan(given))).all():
        allowed = f"{least:g} to {most:g}" if np.isfinite(most) else f"{least:g} or more"
        raise ValueError(f"{name} has values that are not finite or not {allowed}")
    return np.broadcast_to(given, (count,))

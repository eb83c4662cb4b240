"""Requests of applications, checked: for another motion, or for another offset.

Crowds and their parts take the same requests.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...components.dilation import Dilation, DilationRequest
from ..crowd.agents import agent_ids, agent_values
from .ladder import BlendLadder
from .pool import POSE_RATE, Stream, StreamPool
from .uniques import Unique


def ask_streamed(
    ladder: BlendLadder,
    agents: int | ArrayLike,
    stream: Stream,
    part: int,
    duration: float | ArrayLike,
    offset: float | ArrayLike | None,
) -> None:
    """Ask agents to blend to a stream; see `tifo.Crowd.transition_to_streamed`."""
    row = ladder.pool.row(stream)
    longest = float(ladder.pool.history[row] - 2)
    _ask(ladder, agents, row, part, duration, np.nan if offset is None else offset, longest)


def ask_unique(
    ladder: BlendLadder,
    agents: int | ArrayLike,
    unique: Unique,
    part: int,
    duration: float | ArrayLike,
) -> None:
    """Ask agents to blend to a unique; see `tifo.Crowd.transition_to_unique`."""
    _ask(ladder, agents, ladder.uniques.row(unique), part, duration, 0.0, 0.0)


def _ask(
    ladder: BlendLadder,
    agents: int | ArrayLike,
    row: int,
    part: int,
    duration: float | ArrayLike,
    offset: float | ArrayLike,
    longest: float,
) -> None:
    parts, count = ladder.anim.row.shape
    if not 0 <= part < parts:
        raise ValueError(f"part is {part}, expected 0 to {parts - 1}")
    ids = agent_ids(agents, count)
    seconds = agent_values("duration", duration, len(ids), 0.0, np.inf)
    poses = agent_values("offset", offset, len(ids), 0.0, longest, drawn=True)
    ladder.ask(part, ids, ladder.own_rows(ids, row), poses, seconds * np.float32(POSE_RATE))


def ask_dilation(
    dilation: Dilation,
    pool: StreamPool,
    count: int,
    agents: NDArray[np.int64],
    targets: NDArray[np.float32],
    seconds: float,
) -> None:
    """Ask some of `count` agents for other offsets; see `tifo.Crowd.dilate`."""
    ids = np.asarray(agents, np.int64)
    wanted = np.asarray(targets, np.float32)
    if wanted.shape != ids.shape or ids.ndim != 1:
        raise ValueError(f"targets has shape {wanted.shape}, expected {ids.shape}")
    if len(ids) and (ids.min() < 0 or ids.max() >= count):
        raise ValueError(f"agents are {ids.min()} to {ids.max()}, expected 0 to {count - 1}")
    longest = int(pool.history_goal.max()) - 2
    if not ((wanted >= 0) & (wanted <= longest)).all():
        raise ValueError(f"targets must be 0 to {longest} poses")
    if not 0 <= seconds <= 86_400:
        raise ValueError(f"seconds is {seconds}, expected 0 to 86400")
    dilation.waiting.append(DilationRequest(0, ids, wanted, float(seconds)))

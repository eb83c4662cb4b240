"""Heads that follow a point: the override that comes with the package, and an example of one."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping, Sequence
from importlib.resources import files
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .override import JointOverride
from .posed_joints import OverriddenJoints, turn_about

Array = NDArray[np.float32]

TEXT = "overrides/look_at.glsl"
TRAIL, SPACING = 16, 0.05
"""Places of the point that shaders get, and seconds between them."""
LONGEST_LAG = (TRAIL - 1) * SPACING
SMOOTHING = 0.08
"""Seconds of each of two filters that keep heads from jerking when the point jumps."""
BEHIND = (1.7, 2.7)
"""Radians between which heads give up and look ahead."""
MOST_JOINTS = 4
LIMITS = (1.25, 0.7)


class LookAt(JointOverride):
    """An override that turns heads to a point; made by `look_at`.

    Values of an agent are how much it cares, 0 to 1, and how many seconds its attention lags, up to
    `LONGEST_LAG`; the other two are unused.
    """

    __slots__ = ("_at", "_past", "_point", "_time")

    def __init__(self, name: str, joints: Mapping[str, float], limits: tuple[float, float]) -> None:
        before = 0.0
        shares = np.zeros((MOST_JOINTS, 2), np.float32)
        for order, part in enumerate(joints.values()):
            shares[order] = before, part
            before += part
        root = files(f"{__name__.partition('.')[0]}.shaders")
        text = root.joinpath(*TEXT.split("/")).read_text(encoding="utf-8")
        # The packaged text calls its function look_at, whatever the override is called.
        super().__init__(
            name,
            joints,
            text.replace("mat4 look_at(", f"mat4 {name}("),
            uniforms={"trail": np.zeros((TRAIL, 3)), "limits": limits, "shares": shares},
            python=_turned,
            values=(1.0, 0.0, 0.0, 0.0),
        )
        self._time = 0.0
        self._at: NDArray[np.float64] | None = None
        self._point = np.zeros((2, 3))
        self._past: deque[tuple[float, NDArray[np.float64]]] = deque()

    def aim(self, point: ArrayLike, seconds: float = 0.0) -> None:
        """Say where the point is now, once a frame.

        A point that jumps is followed smoothly, within about a third of a second.

        Parameters
        ----------
        point
            (3,) metres, in the stadium's frame.
        seconds
            That have passed since the last call; the first call sets the point for all times.

        Raises
        ------
        ValueError
            For anything but three finite numbers, or a time below 0.
        """
        given = np.asarray(point, np.float64)
        if given.shape != (3,) or not np.isfinite(given).all():
            raise ValueError(f"point is {point!r}, expected three finite numbers")
        if not 0.0 <= seconds < math.inf:
            raise ValueError(f"seconds is {seconds}, expected 0 or more")
        if self._at is None:
            self._point[:] = given
            self._past.append((self._time, given.copy()))
        self._at = given
        keep = math.exp(-seconds / SMOOTHING)
        self._point[0] = given + keep * (self._point[0] - given)
        self._point[1] = self._point[0] + keep * (self._point[1] - self._point[0])
        self._time += seconds
        if seconds:
            self._past.append((self._time, self._point[1].copy()))
        while len(self._past) > 1 and self._past[1][0] <= self._time - LONGEST_LAG:
            self._past.popleft()
        times = np.array([time for time, _ in self._past])
        places = np.array([place for _, place in self._past])
        lagging = self._time - SPACING * np.arange(TRAIL)
        self.uniforms["trail"] = np.stack(
            [np.interp(lagging, times, column) for column in places.T], axis=1
        )

    def draw_attention(self, count: int, rng: np.random.Generator, *, share: float = 0.9) -> Array:
        """Values for a crowd: most follow the point, some less than others, none at the same time.

        Parameters
        ----------
        count
            How many agents.
        rng
            Draws them.
        share
            How many follow it at all.

        Returns
        -------
        (count, 4) float32
        """
        values = np.zeros((count, 4), np.float32)
        values[:, 0] = rng.uniform(0.7, 1.0, count) * (rng.random(count) < share)
        values[:, 1] = 0.05 + (LONGEST_LAG - 0.05) * rng.beta(2.0, 4.0, count)
        return values


def look_at(
    joints: Mapping[str, float] | None = None,
    *,
    limit: float | Sequence[float] = LIMITS,
    name: str = "look_at",
) -> LookAt:
    """An override that lets heads follow a point.

    Joints share the turn. Near the limit they turn less and less, and where the point is behind an
    agent, it looks ahead instead; nothing snaps.

    Parameters
    ----------
    joints
        Up to four joints from the top of the tree down, with the part of the turn that each does;
        0.35 at the ``neck`` and the rest at the ``head`` if None. Parts below 1 in all leave the
        rest to the eyes.
    limit
        Radians that they turn at most in all: one number, or sideways and up or down.
    name
        Of the override; several crowds of heads in one crowd need several.

    Raises
    ------
    ValueError
        For parts or limits that make no sense.

    Examples
    --------
    >>> look = look_at()
    >>> crowd.add_override(look)
    >>> look.aim((20.0, 0.2, -5.0), seconds=1 / 60)  # once a frame
    """
    given = {"neck": 0.35, "head": 0.65} if joints is None else dict(joints)
    parts = list(given.values())
    if not 1 <= len(parts) <= MOST_JOINTS:
        raise ValueError(f"joints has {len(parts)} joints, expected 1 to {MOST_JOINTS}")
    if not all(0 < part <= 1 for part in parts) or sum(parts) > 1 + 1e-6:
        raise ValueError(f"joints has parts {parts}, expected more than 0, and 1 at most in all")
    limits = np.broadcast_to(np.asarray(limit, float), (2,)) if np.size(limit) in (1, 2) else None
    if limits is None or not ((limits > 0) & (limits <= math.pi)).all():
        raise ValueError(f"limit is {limit!r}, expected one or two angles, more than 0 to pi")
    return LookAt(name, given, (float(limits[0]), float(limits[1])))


def _turned(joints: OverriddenJoints, uniforms: Mapping[str, NDArray[Any]]) -> Array:
    """The same as ``look_at.glsl``, for K agents."""
    care = np.clip(joints.values[:, 0], 0.0, 1.0)
    ahead = _unit(joints.pose[:, :3, 2])
    aside = _unit(np.cross(joints.pose[:, :3, 1], ahead))
    above = np.cross(ahead, aside)
    place = np.clip(joints.values[:, 1] / np.float32(SPACING), 0.0, TRAIL - 1.0)
    before = np.minimum(place.astype(np.int64), TRAIL - 2)
    part = (place - before)[:, None]
    trail = uniforms["trail"]
    point = trail[before] + part * (trail[before + 1] - trail[before])
    way = joints.body.to_model(point) - joints.pivot
    metres = np.linalg.norm(way, axis=1, keepdims=True)
    way = np.where(metres > 1e-4, way / np.maximum(metres, 1e-4), ahead)

    off = np.stack([(way * aside).sum(axis=1), (way * above).sum(axis=1)], axis=1)
    across = np.linalg.norm(off, axis=1, keepdims=True)
    heading = np.where(across > 1e-5, off / np.maximum(across, 1e-5), [1.0, 0.0])
    angle = np.arctan2(across[:, 0], (way * ahead).sum(axis=1))

    done, own = uniforms["shares"][joints.order]
    wanted = angle * care * own / np.maximum(1.0 - care * done, 1e-3)
    limit = own / np.linalg.norm(heading / uniforms["limits"], axis=1)
    turn = wanted / (1.0 + (wanted / limit) ** 4) ** 0.25
    fade = np.clip((angle - BEHIND[0]) / (BEHIND[1] - BEHIND[0]), 0.0, 1.0)
    turn = turn * (1.0 - fade * fade * (3.0 - 2.0 * fade))
    axis = heading[:, :1] * above - heading[:, 1:] * aside
    return turn_about(joints.pose, joints.pivot, np.asarray(axis, np.float32), turn)


def _unit(vectors: Array) -> Array:
    out: Array = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    return out

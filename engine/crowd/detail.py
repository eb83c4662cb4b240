"""Which agents are in view, and how finely each is drawn.

An agent is a sphere about its middle; it is in view unless the sphere lies wholly outside one plane
of the view frustum. Its level follows from how many pixels tall it would be.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.attachment import PartBits
from ...components.detail import Detail, Level
from ...components.placement import GROUP, Placement
from ...components.view import View

MESH_PIXELS = (110.0, 42.0, 17.0)
"""Agents at least this tall are drawn with the first, second or third mesh; others as figures."""

_BLOCK = 8192
"""Agents a matrix product: larger products are spread over threads, which wait for each other."""
_GROUP = GROUP
"""Neighbouring agents that have a common box."""

Ints = NDArray[np.int64]


@dataclass(slots=True)
class Bounds:
    """Boxes about groups of neighbouring agents: most of a stadium is out of view, so most of it
    can be left out without looking at each agent.

    Attributes
    ----------
    low, high
        (4, G) float32 least and greatest x, y, z and scale of each group.
    version, touches
        Of the placement that they were made from.
    """

    low: NDArray[np.float32]
    high: NDArray[np.float32]
    version: int
    touches: int = 0

    @classmethod
    def of(cls, placement: Placement) -> Bounds:
        """Of a crowd."""
        body = np.concatenate([placement.position, placement.scale[None]])
        starts = np.arange(0, body.shape[1], _GROUP)
        return cls(
            np.minimum.reduceat(body, starts, axis=1),
            np.maximum.reduceat(body, starts, axis=1),
            placement.version,
            placement.touches,
        )

    def fits(self, placement: Placement) -> bool:
        """Whether nobody was moved since; making new ones is cheaper than finding out who was."""
        return (self.version, self.touches) == (placement.version, placement.touches)

    def ids(self, rows: NDArray[np.float32], edges: NDArray[np.float32], count: int) -> Ints:
        """Ids below `count` of the groups that reach beyond the edges of all planes (P, 4)."""
        rising = np.maximum(rows, 0.0)
        farthest = rising @ self.high + (rows - rising) @ self.low
        # A millimetre for rounding.
        seen = (farthest >= edges[:, None] - 1e-3).all(axis=0)
        return np.flatnonzero(np.repeat(seen, _GROUP)[:count])


def frustum_planes(view_projection: NDArray[np.float32]) -> NDArray[np.float32]:
    """Planes left, right, bottom, top, near as (5, 4) float32: inside where ``n . p + d >= 0``.

    Gribb and Hartmann 2001. The far plane is left out: nothing of a stadium is too far to draw.
    """
    x, y, z, w = view_projection
    planes = np.stack([w + x, w - x, w + y, w - y, w + z])
    length = np.linalg.norm(planes[:, :3], axis=1, keepdims=True)
    normalised: NDArray[np.float32] = (planes / np.maximum(length, 1e-12)).astype(np.float32)
    return normalised


def pixel_heights(
    scale: NDArray[np.float32], height: float, view: View, depth: NDArray[np.float32]
) -> NDArray[np.float32]:
    """Height of each agent in the picture, in pixels.

    Parameters
    ----------
    scale, depth
        (N,) uniform scale of each agent, and metres before the camera.
    height
        Height of the character in metres, before an agent's scale.
    view
        The camera.

    Examples
    --------
    A 1.75 m agent 20 m away in a picture 720 pixels high, seen with a vertical field of 60 degrees,
    is 1.75 * 1.732 * 360 / 20 = 54.6 pixels tall.
    """
    pixels = height * float(view.projection[1, 1]) * view.height / 2.0
    heights: NDArray[np.float32] = np.divide(scale * np.float32(pixels), np.maximum(depth, 0.1))
    return heights.astype(np.float32, copy=False)


def select_detail(
    detail: Detail,
    placement: Placement,
    present: NDArray[np.bool_],
    height: float,
    view: View,
    *,
    levels: bool,
    coarseness: float = 1.0,
    bounds: Bounds | None = None,
) -> None:
    """Sort the agents that are in view by level of detail.

    Parameters
    ----------
    detail
        Receives the ids.
    placement, present
        Places, and who is there.
    height
        Height of the character in metres, before an agent's scale.
    view
        The camera.
    levels
        Whether distant agents are drawn more coarsely; if not, all are drawn as near ones.
    coarseness
        Factor on `MESH_PIXELS`: 2 draws an agent as coarsely as one half as tall otherwise.
    bounds
        Boxes about the agents, for who keeps them from frame to frame; made anew if None.
    """
    planes = frustum_planes(view.projection @ view.view)
    forward = -view.view[2]
    # The sphere's radius is three quarters of a height; its middle is half a height above the feet.
    # So a plane's distance, radius added, is linear in the place and the scale of the agent, and
    # one matrix product gives it for all planes, and the depth with it.
    rows = np.zeros((6, 4), np.float32)
    rows[:5, :3], rows[5, :3] = planes[:, :3], forward[:3]
    rows[:5, 3] = height * (0.5 * planes[:, 1] + 0.75)
    edges = -planes[:, 3]
    bounds = Bounds.of(placement) if bounds is None else bounds
    near = bounds.ids(rows[:5], edges, len(present))
    near = near.compress(present.take(near))
    ids: list[Ints] = [near[:0]]
    depths: list[NDArray[np.float32]] = [np.zeros(0, np.float32)]
    body = np.empty((4, min(_BLOCK, len(near))), np.float32)
    for first in range(0, len(near), _BLOCK):
        some = near[first : first + _BLOCK]
        for column, values in zip(body, (*placement.position, placement.scale), strict=True):
            values.take(some, out=column[: len(some)], mode="clip")
        distance = rows @ body[:, : len(some)]
        inside = distance[0] >= edges[0]
        for row, edge in zip(distance[1:5], edges[1:], strict=True):
            inside &= row >= edge
        found = np.flatnonzero(inside)
        ids.append(some.take(found))
        depths.append(distance[5].take(found))
    places = np.concatenate(ids)
    agents = places.astype(np.uint32)
    if not levels:
        detail.agents = (agents, agents[:0], agents[:0], agents[:0])
        return
    depth = np.concatenate(depths) + forward[3]
    pixels = pixel_heights(placement.scale.take(places), height, view, depth)
    level = np.zeros(len(agents), np.int8)
    for least in np.float32(coarseness) * np.array(MESH_PIXELS, np.float32):
        level += pixels < least
    detail.agents = tuple(agents[level == number] for number in Level)


def select_part(detail: Detail, parent: Detail, bits: PartBits, bit: int) -> None:
    """Sort the agents in view that have a part: at the levels of their bodies, none at the last.

    Parameters
    ----------
    detail
        Receives the ids.
    parent
        Of the crowd, selected before.
    bits, bit
        Which agents have which parts, and which part it is.
    """
    wanted = np.uint32(1 << bit)
    near = [ids[(bits.bits[ids] & wanted) != 0] for ids in parent.agents[: Level.FAR]]
    detail.agents = (*near, np.zeros(0, np.uint32))

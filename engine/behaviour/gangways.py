"""Where people can walk: gangways, the walkways behind tiers, doors, and the rows of seats.

A gangway is the stairs between two blocks of a tier. Behind the last row of every tier but the
highest a walkway runs along all of them, with a door at every third gangway; gangways of the
highest tier have a door each. The shortest ways from the doors are found once (Dijkstra 1959);
a way to a seat then goes over the gangway at one of the two ends of its row, whichever is quicker.
"""

from __future__ import annotations

from dataclasses import dataclass
from heapq import heappop, heappush
from math import dist

import numpy as np
from numpy.typing import NDArray

from ..crowd.outline import Block
from ..crowd.seating import FEET, SeatPlan, Tier

F64 = NDArray[np.float64]
F32 = NDArray[np.float32]

STAIR_SPEED, ROW_SPEED, FLOOR_SPEED = 0.6, 0.4, 1.1
"""Metres a second on stairs, past people in a row, and on a walkway."""
IN_FRONT = 0.11
"""Metres before the feet of those who sit, along which others pass them."""
DOORS = 3
"""Every so many gangways a walkway has a door."""
STUB = 1.6
"""Metres behind the wall at which people begin or end their way."""
_BODY = 0.25
_STEP_ASIDE = 0.05
_WALKWAY = 1.2
_FREEDOM = 0.8


@dataclass(frozen=True, slots=True, eq=False)
class Route:
    """A way from one place to another.

    Parameters
    ----------
    points
        (p, 3) float32 vertices, metres.
    room
        (p,) float32 metres that the middle of a person may be aside.
    mouth
        Vertex between gangway and row; -1 for a way on gangways only.
    seat0, first, step
        Vertex of the first seat in the row, its id, and by how much ids grow at each vertex.
    """

    points: F32
    room: F32
    mouth: int = -1
    seat0: int = 0
    first: int = 0
    step: int = 1

    @property
    def normal(self) -> F32:
        """(p, 2) float32 unit x and z to the right of the way, turning evenly at corners."""
        ahead = np.diff(self.points[:, [0, 2]].astype(np.float64), axis=0)
        ahead /= np.maximum(np.linalg.norm(ahead, axis=1, keepdims=True), 1e-9)
        side = np.stack([-ahead[:, 1], ahead[:, 0]], axis=1)
        both = np.concatenate([side[:1], side[:-1] + side[1:], side[-1:]])
        both /= np.maximum(np.linalg.norm(both, axis=1, keepdims=True), 1e-9)
        return both.astype(np.float32)

    def reversed(self, agents: int) -> Route:
        """The same way back, past `agents` seats."""
        last = len(self.points) - 1
        return Route(
            self.points[::-1].copy(),
            self.room[::-1].copy(),
            last - self.mouth,
            0,
            self.first + self.step * (agents - 1),
            -self.step,
        )


@dataclass(frozen=True, slots=True, eq=False)
class _Gate:
    """The middle of one gangway: (R, 3) stairs points, the landing, and metres of freedom."""

    stairs: F64
    mouths: F64
    landing: F64
    out: F64
    freedom: float


class Gangways:
    """Gangways of a seat plan, and ways over them.

    Parameters
    ----------
    plan
        The seats; its structure must have gangways.

    Raises
    ------
    ValueError
        For a plan without gangways.
    """

    def __init__(self, plan: SeatPlan) -> None:
        if plan.structure.gangway <= 0.0:
            raise ValueError("plan has no gangways to walk on; layout 'bowl' has them")
        self._plan = plan
        self._gates: list[_Gate] = []
        self._ends: dict[int, tuple[int, int]] = {}
        self._tier_of: dict[int, int] = {}
        self._next: list[list[tuple[int, F64]]] = []
        self._doors: list[int] = []
        for level in range(len(plan.structure.tiers)):
            self._add_tier(level)
        self._cost, self._back = self._shortest()
        starts: dict[tuple[int, int], tuple[int, int]] = {}
        key = plan.section.astype(np.int64) << 32 | plan.row
        edges = np.flatnonzero(np.diff(key, prepend=key[0] - 1, append=key[-1] + 1))
        for a, b in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
            starts[int(plan.section[a]), int(plan.row[a])] = (a, b)
        self._runs = starts

    @property
    def count(self) -> int:
        """Number of gangways, those of every tier for themselves."""
        return len(self._gates)

    @property
    def doors(self) -> F64:
        """(D, 3) where people come in."""
        return np.stack([self._gates[g].out for g in self._doors])

    def run_of(self, agent: int) -> int:
        """Number of the row of one block that a seat is in."""
        return self._runs[int(self._plan.section[agent]), int(self._plan.row[agent])][0]

    def choose(self, agent: int) -> tuple[int, range]:
        """The gangway over which a seat is reached soonest, and the seats passed from there."""
        plan = self._plan
        section, row = int(plan.section[agent]), int(plan.row[agent])
        r = row - plan.structure.tiers[self._tier_of[section]].first_row
        first, stop = self._runs[section, row]
        x, y, z = plan.position[:, agent].tolist()
        best: tuple[float, int, range] | None = None
        for gate, seats in zip(
            self._ends[section],
            (range(first, agent + 1), range(stop - 1, agent - 1, -1)),
            strict=True,
        ):
            g = self._gates[gate]
            cost = self._cost[gate] + dist(g.stairs[-1], g.stairs[r]) / STAIR_SPEED
            cost += dist(g.mouths[r], (x, y, z)) / ROW_SPEED
            if best is None or cost < best[0]:
                best = (cost, gate, seats)
        assert best is not None
        return best[1], best[2]

    def door_of(self, gate: int) -> F64:
        """(3,) the door from which a gangway is reached."""
        while self._back[gate] >= 0:
            gate = self._back[gate]
        return self._gates[gate].out

    def to_seat(self, agent: int) -> Route:
        """The quickest way from a door to a seat."""
        plan = self._plan
        row = int(plan.row[agent])
        r = row - plan.structure.tiers[self._tier_of[int(plan.section[agent])]].first_row
        gate, seats = self.choose(agent)
        points, room = self._down_to(gate, r)
        points.append(self._gates[gate].mouths[r][None])
        room.append(np.array([0.05]))
        ids = np.array(seats)
        yaw = plan.yaw[ids].astype(np.float64)
        in_row = plan.position[:, ids].T.astype(np.float64)
        ahead = np.stack([np.sin(yaw), 0.0 * yaw, np.cos(yaw)], axis=1)
        in_row[:-1] += IN_FRONT * ahead[:-1]
        points.append(in_row)
        room.append(np.zeros(len(ids)))
        whole = np.concatenate(points).astype(np.float32)
        seat0 = len(whole) - len(ids)
        return Route(
            whole,
            np.concatenate(room).astype(np.float32),
            seat0 - 1,
            seat0,
            int(ids[0]),
            seats.step,
        )

    def stairs(self, gate: int, begin: int, end: int) -> Route:
        """Along one gangway, from a row of its tier to another, or a few centimetres down to it."""
        g = self._gates[gate]
        rows = np.arange(begin, end + (1 if end >= begin else -1), 1 if end >= begin else -1)
        if begin == end:
            rows = np.repeat(rows, 2)
        points = g.stairs[rows].astype(np.float32)
        if begin == end:
            behind = g.landing - g.stairs[begin]
            points[0, ::2] += _STEP_ASIDE * (behind / np.linalg.norm(behind[::2]))[::2]
        return Route(points, np.full(len(rows), g.freedom, np.float32))

    def rows(self, gate: int) -> int:
        """How many rows a gangway passes."""
        return len(self._gates[gate].stairs)

    def lines(self) -> list[F64]:
        """Polylines (p, 3) of all gangways and walkways; rows are the seats'."""
        found = [np.concatenate([g.stairs, g.landing[None], g.out[None]]) for g in self._gates]
        found += [g.mouths for g in self._gates]
        return found + [way for links in self._next for _, way in links]

    def _down_to(self, gate: int, r: int) -> tuple[list[F64], list[F64]]:
        """From the door that is nearest to a gangway down to just above row r of its tier."""
        chain = [gate]
        while self._back[chain[-1]] >= 0:
            chain.append(self._back[chain[-1]])
        g = self._gates[chain[-1]]
        points, room = [g.out[None], g.landing[None]], [np.array([0.1]), np.array([0.3])]
        for near, far in zip(chain[::-1][:-1], chain[::-1][1:], strict=True):
            way = next(line for other, line in self._next[near] if other == far)
            points.append(way[1:])
            room.append(np.full(len(way) - 1, _FREEDOM))
        g = self._gates[gate]
        points.append(g.stairs[:r:-1])
        room.append(np.full(len(g.stairs) - 1 - r, g.freedom))
        return points, room

    def _add_tier(self, level: int) -> None:
        structure = self._plan.structure
        tier = structure.tiers[level]
        highest = level + 1 == len(structure.tiers)
        blocks, base = tier.blocks, len(self._gates)
        start_gate: dict[int, int] = {}
        end_gate: dict[int, int] = {}
        for b, block in enumerate(blocks):
            before = (b - 1) % len(blocks)
            if _meet(blocks[before], block):
                if before in end_gate:
                    start_gate[b] = end_gate[before]
                else:
                    start_gate[b] = self._add_gate(tier, block, 0.0, False, highest)
                    end_gate[before] = start_gate[b]
            else:
                start_gate[b] = self._add_gate(tier, block, 0.0, True, highest)
            follower = (b + 1) % len(blocks)
            if b not in end_gate:
                if _meet(block, blocks[follower]):
                    if follower in start_gate:
                        end_gate[b] = start_gate[follower]
                    else:
                        end_gate[b] = self._add_gate(tier, block, 1.0, False, highest)
                else:
                    end_gate[b] = self._add_gate(tier, block, 1.0, True, highest)
        for b, block in enumerate(blocks):
            section = tier.sections[b]
            self._ends[section] = (start_gate[b], end_gate[b])
            self._tier_of[section] = level
            if not highest:
                self._link(tier, block, start_gate[b], end_gate[b])
        gates = range(base, len(self._gates))
        if highest:
            self._doors += gates
            return
        # Every third gangway, and one at least wherever a stretch of walkway is not joined on.
        alone = [g for g in gates if len(self._next[g]) == 1]
        self._doors += sorted({*gates[::DOORS], *alone})

    def _add_gate(self, tier: Tier, block: Block, end: float, is_open: bool, highest: bool) -> int:
        tread = self._plan.structure.tread
        half = 0.5 * self._plan.structure.gangway
        inset = 0.5 * half if is_open else 0.0

        def points(offset: F64, height: F64) -> F64:
            share = inset / block.length(offset)
            x, z, _ = block.locate(end + share * (1.0 - 2.0 * end), offset)
            return np.stack([x, height, z], axis=-1)

        heights = tier.heights
        stairs = points(tier.offsets + 0.25 * tread, heights)
        mouths = points(tier.offsets + FEET - IN_FRONT, heights)
        back = float(tier.offsets[-1]) + tread
        behind = np.array([back - 0.2 if highest else back + _WALKWAY])
        out = np.array([back - 0.2 + STUB if highest else back + _WALKWAY + STUB + 0.4])
        landing = points(behind, heights[-1:])[0]
        freedom = max(0.05, (0.5 * half if is_open else half) - _BODY)
        self._gates.append(_Gate(stairs, mouths, landing, points(out, heights[-1:])[0], freedom))
        self._next.append([])
        return len(self._gates) - 1

    def _link(self, tier: Tier, block: Block, a: int, b: int) -> None:
        offset = float(tier.offsets[-1]) + self._plan.structure.tread + _WALKWAY
        count = max(2, int(np.ceil(abs(block.stop - block.start) / 0.05)) + 1)
        x, z, _ = block.locate(np.linspace(0.0, 1.0, count), offset)
        way = np.stack([x, np.full_like(x, tier.heights[-1]), z], axis=-1)
        way[0], way[-1] = self._gates[a].landing, self._gates[b].landing
        self._next[a].append((b, way))
        self._next[b].append((a, way[::-1]))

    def _shortest(self) -> tuple[list[float], list[int]]:
        """Seconds from the nearest door to each landing, and the landing before it (-1: a door)."""
        cost, back = [np.inf] * self.count, [-1] * self.count
        heap: list[tuple[float, int]] = []
        for door in self._doors:
            cost[door] = 0.0
            heappush(heap, (0.0, door))
        while heap:
            here, gate = heappop(heap)
            if here > cost[gate]:
                continue
            for other, way in self._next[gate]:
                length = float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())
                if here + length / FLOOR_SPEED < cost[other]:
                    cost[other] = here + length / FLOOR_SPEED
                    back[other] = gate
                    heappush(heap, (cost[other], other))
        return cost, back


def _meet(block: Block, follower: Block) -> bool:
    end, begin = block.locate(1.0, 0.0), follower.locate(0.0, 0.0)
    return bool(np.hypot(end[0] - begin[0], end[1] - begin[1]) < 1e-3)

"""Everyone of a crowd who is on the way: what they set out for, and how they get there.

A person on the way follows the vertices of a route (`gangways`) and may be a little aside of it.
Speed along it and drift across it follow from `walk_speed`, so nobody can leave the stairs. In a
row one passes those who belong there (`making_room`), and nobody enters a row against somebody who
comes out of it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components.motion import NEVER, MotionState
from ...components.placement import Placement
from ...components.walk import Errand, Stage, Walk
from ..crowd.gaits import STILL, Gaits, nearest
from ..crowd.seating import SeatPlan
from ..streams.pool import POSE_RATE
from .compiled import CompiledTable
from .gangways import STAIR_SPEED, Gangways, Route
from .guidance import BODY, NOTHING, Guidance, Order, Priority
from .making_room import NEAR_ROW, RoomMakers
from .table import STANDING
from .walk_now import F32, Now, advance, look
from .walk_speed import BEFORE_MOUTH, PATIENCE, steer

Ints = NDArray[np.int64]

PACE = (STAIR_SPEED, 0.06, 0.45, 0.75)
"""Metres a second on stairs: mean, spread, least and most."""
TURN = 2.6
"""Radians a second."""
POST = (20.0, 90.0)
"""Seconds for which a steward stands at the foot of a gangway, at least and at most."""
_DOOR = 0.8
_AT_ONCE = 6
_RETRY = 15
_HOLD = 9
_ALIGNED = 0.02


class Walkers:
    """People on their way in one crowd.

    Parameters
    ----------
    plan, gaits
        The seats, and the motions of walking.
    compiled
        The behaviour table, for what people do who just stand.
    home_yaw
        (N,) where people at their seats look.
    occupied
        (N,) bool column of the crowd; changed when somebody comes or is gone.
    rng
        Where choices come from.

    Attributes
    ----------
    walk
        Columns of those on their way.
    waiting
        (Q, 3) int64 ids, errands and pose ticks of those who will set out, the first first.
    ways
        Where people can go.
    room
        Who lets others pass.
    away
        (N,) bool: who is not at its seat, but on the way or not there at all.
    posts
        Gangway of each steward by id.
    """

    def __init__(
        self,
        plan: SeatPlan,
        gaits: Gaits,
        compiled: CompiledTable,
        home_yaw: F32,
        occupied: NDArray[np.bool_],
        rng: np.random.Generator,
    ) -> None:
        self.walk, self.room = Walk(), RoomMakers(plan)
        self.ways = Gangways(plan)
        self.gaits, self.posts = gaits, dict[int, int]()
        self.waiting = np.zeros((0, 3), np.int64)
        self.away = ~occupied
        self._plan, self._occupied, self._rng = plan, occupied, rng
        self._home_yaw = home_yaw.copy()
        self._calm, self._seated = compiled.calm[STANDING], compiled.seated
        self._walking = np.zeros(plan.count, np.bool_)
        self._held: dict[int, list[int]] = {}
        self._routes: dict[int, Route] = {}
        self._now: Now | None = None
        self._speeds = np.zeros(len(compiled.seated), np.float32)
        self._sideways = np.zeros(len(compiled.seated), np.bool_)
        for motions, speeds in (gaits.left, gaits.right, gaits.walk):
            self._speeds[motions] = speeds
            self._sideways[motions] = motions is not gaits.walk[0]
        nobody = np.zeros(0, np.int64), np.zeros(0, np.int16)
        none = np.zeros(len(compiled.names), np.bool_)
        self._bound, self._asked = (
            Order(nobody[0], priority, BODY, nobody[1], NOTHING, NOTHING, none, NEVER)
            for priority in (Priority.BOUND, Priority.GUIDED)
        )
        self._changed = False

    @property
    def is_idle(self) -> bool:
        """Whether nobody is on the way, makes room or will set out."""
        return not (len(self.walk) or len(self.waiting)) and self.room.is_idle

    def is_expected(self, agents: Ints) -> NDArray[np.bool_]:
        """Which of the agents (K,) will set out or are on the way."""
        expected: NDArray[np.bool_] = np.isin(agents, self.waiting[:, 0])
        return expected | self._walking[agents]

    def draw_times(self, count: int, seconds: float) -> NDArray[np.float64]:
        """`count` times up to `seconds`, ascending."""
        return np.sort(self._rng.uniform(0.0, seconds, count))

    def send(self, agents: Ints, errand: Errand, ticks: Ints) -> None:
        """Let agents (K,) set out at pose ticks (K,), or as soon after as there is room."""
        rows = np.stack([agents, np.full(len(agents), errand), ticks], axis=1)
        self._queue(np.concatenate([self.waiting, rows]))

    def move(self, tick: int, placement: Placement, seconds: float) -> Ints:
        """Advance everybody by so many seconds; ids of those who arrived at their seats."""
        walk = self.walk
        moved = [self.room.move(placement, ~self.away, seconds)]
        arrived = moved[0][:0]
        if len(walk):
            advance(walk, seconds)
            self._now = look(walk)
            moved.append(walk.agent)
            self._place(self._now, placement, seconds)
            arrived = self._finish(tick, placement)
        if sum(map(len, moved)):
            placement.touch(np.concatenate(moved))
        return arrived

    def step(
        self, tick: int, placement: Placement, motion: MotionState, guidance: Guidance
    ) -> None:
        """Decide at a pose tick who sets out, how fast everybody goes, and who makes room.

        What they show are orders: those on their way are bound by them, and those who make room are
        asked to, so that an order of the application's can keep them from it.
        """
        walk, now = self.walk, None
        if len(walk):
            now = self._now = self._now or look(walk)
            self._grant(now)
            rising = np.flatnonzero(walk.stage == Stage.RISE)
            agents = walk.agent[rising]
            up = ~self._seated[motion.shown[agents]] & (motion.busy_until[agents] <= tick)
            walk.stage[rising[up]] = Stage.WALK
            steer(walk, now, self._to_seated(now, motion, tick))
            self._show(now, tick)
        if self.room.choose(walk, now, ~self.away):
            room = self.gaits.make_room if len(self.gaits.make_room) else self._calm
            ids = self.room.agents
            guidance.revise(self._asked, ids, room[ids % len(room)])
        self._depart(tick, placement)
        if self._changed:
            order = np.argsort(walk.agent, kind="stable")
            guidance.revise(self._bound, walk.agent[order], walk.motion[order])
            self._changed = False

    # Setting out and getting there.

    def _queue(self, waiting: Ints) -> None:
        self.waiting = waiting[np.argsort(waiting[:, 2], kind="stable")]

    def _depart(self, tick: int, placement: Placement) -> None:
        due = int(np.searchsorted(self.waiting[:, 2], tick, "right"))
        if not due:
            return
        some, rest = self.waiting[: min(due, _AT_ONCE)], self.waiting[min(due, _AT_ONCE) :]
        late = [
            (agent, errand, tick + _RETRY)
            for agent, errand, _ in some.tolist()
            if not self._begin(agent, Errand(errand), placement)
        ]
        self.waiting = rest
        if late:
            self._queue(np.concatenate([rest, np.array(late, np.int64)]))

    def _begin(self, agent: int, errand: Errand, placement: Placement) -> bool:
        """Let somebody set out; False if there is no room yet."""
        if errand is Errand.PATROL:
            gate = self.posts[agent]
            route = self.ways.stairs(gate, min(1, self.ways.rows(gate) - 1), 0)
            self._add(agent, errand, route, -1)
            placement.position[:, agent] = route.points[0]
            return True
        run = self.ways.run_of(agent)
        route = self._routes.pop(agent) if agent in self._routes else self.ways.to_seat(agent)
        x, _, z = route.points[0]
        others = placement.position[:, self.walk.agent]
        if errand is Errand.ARRIVE:
            if len(self.walk) and np.hypot(others[0] - x, others[2] - z).min() < _DOOR:
                self._routes[agent] = route
                return False
            self._occupied[agent] = True
            placement.position[:, agent] = route.points[0]
            ahead = route.points[1] - route.points[0]
            placement.yaw[agent] = np.arctan2(ahead[0], ahead[2])
        else:
            if not self._take(run, -route.step):
                self._routes[agent] = route
                return False
            route = route.reversed(len(route.points) - route.seat0)
        self._add(agent, errand, route, run)
        return True

    def _add(self, agent: int, errand: Errand, route: Route, run: int) -> None:
        mean, spread, least, most = PACE
        self.walk.add(
            route.points,
            route.normal,
            route.room,
            agent=agent,
            errand=errand,
            stage=Stage.RISE if errand is Errand.LEAVE else Stage.WALK,
            pace=float(np.clip(self._rng.normal(mean, spread), least, most)),
            mouth=route.mouth,
            seat0=route.seat0,
            first=route.first,
            step=route.step,
            run=run,
            granted=errand is not Errand.ARRIVE,
            motion=int(self._calm[agent % len(self._calm)]),
        )
        self._walking[agent] = self.away[agent] = self._changed = True
        self._now = None

    def _take(self, run: int, step: int) -> bool:
        """Promise a row to somebody who goes that way along it; False while others come."""
        held = self._held.setdefault(run, [step, 0])
        if held[1] and held[0] != step:
            return False
        held[0] = step
        held[1] += 1
        return True

    def _give(self, runs: Ints) -> None:
        for run in runs.tolist():
            self._held[run][1] -= 1
            if not self._held[run][1]:
                del self._held[run]

    def _grant(self, now: Now) -> None:
        walk = self.walk
        asks = ~walk.granted & (now.to_mouth < BEFORE_MOUTH + 1.0)
        for k in np.flatnonzero(asks):
            walk.granted[k] = self._take(int(walk.run[k]), int(walk.step[k]))

    def _finish(self, tick: int, placement: Placement) -> Ints:
        """Those who came to the end of their way; ids of who is at its seat."""
        walk = self.walk
        leaves = walk.errand == Errand.LEAVE
        out = leaves & (walk.run >= 0) & (walk.vertex >= walk.mouth)
        if out.any():
            self._give(walk.run[out])
            walk.run[out] = -1
        ends = (walk.vertex >= walk.last) & (walk.stage == Stage.WALK)
        if ends.any():
            walk.stage[ends & (walk.errand == Errand.ARRIVE)] = Stage.SETTLE
            patrol = ends & (walk.errand == Errand.PATROL)
            walk.stage[patrol] = Stage.STAND
            walk.speed[ends] = walk.drift[ends] = 0.0
            # Up on the stairs they only turn round: who stood there would be in the way.
            stay = self._rng.uniform(*POST, int(patrol.sum()))
            down = walk.route[patrol, walk.last[patrol], 1] <= walk.route[patrol, 0, 1]
            walk.until[patrol] = tick + np.rint(np.where(down, stay, 1.0) * POSE_RATE)
        facing = _wrapped(self._home_yaw[walk.agent] - placement.yaw[walk.agent])
        arrived = (walk.stage == Stage.SETTLE) & (np.abs(facing) < _ALIGNED)
        done = arrived | (ends & leaves)
        ids: Ints = walk.agent[arrived]
        if done.any():
            self._give(walk.run[arrived])
            all_done = walk.agent[done]
            placement.touch(all_done)
            placement.position[:, all_done] = self._plan.position[:, all_done]
            placement.yaw[all_done] = self._home_yaw[all_done]
            self.away[ids] = self._walking[all_done] = False
            self._occupied[walk.agent[ends & leaves]] = False
            self._forget(done)
        again = (walk.stage == Stage.STAND) & (walk.until <= tick)
        if again.any():
            self._patrol(again)
        return ids

    def _forget(self, some: NDArray[np.bool_]) -> None:
        self.walk.keep(~some)
        self._now, self._changed = None, True

    def _patrol(self, again: NDArray[np.bool_]) -> None:
        """Send stewards up their gangway, to as far as its middle, or down again."""
        walk = self.walk
        agents, at = walk.agent[again], walk.route[again, walk.last[again], 1]
        asides, motions = walk.aside[again], walk.motion[again]
        self._forget(again)
        for k, agent in enumerate(agents.tolist()):
            gate = self.posts[agent]
            rows = self.ways.rows(gate)
            heights = self.ways.stairs(gate, 0, rows - 1).points[:, 1]
            row = int(np.argmin(np.abs(heights - at[k])))
            goal = 0 if row else min(int(self._rng.integers(1, rows // 2 + 2)), rows - 1)
            self._add(agent, Errand.PATROL, self.ways.stairs(gate, row, goal), -1)
            # One's right is on the other side after turning round.
            walk.aside[-1], walk.motion[-1] = -asides[k], motions[k]

    # On the way.

    def _to_seated(self, now: Now, motion: MotionState, tick: int) -> F32:
        """(W,) metres along the row to the next person who sits yet; inf if nobody does."""
        walk = self.walk
        after = np.maximum(np.floor(now.seat).astype(np.int64) + 1, 0)
        some = np.flatnonzero(
            (now.in_row | (now.to_mouth < NEAR_ROW))
            & (after < now.passes)
            & (walk.waited < PATIENCE)
        )
        room = np.full(len(walk), np.inf, np.float32)
        after = after[some]
        ids = walk.first[some] + walk.step[some] * after
        busy = self._seated[motion.shown[ids]] | (motion.busy_until[ids] > tick + _HOLD)
        busy &= ~self.away[ids]
        some, after = some[busy], after[busy]
        room[some] = walk.reach[some, walk.seat0[some] + after] - now.covered[some]
        return room

    def _show(self, now: Now, tick: int) -> None:
        """Choose gaits by speed; a gait lasts a third of a second at least."""
        walk = self.walk
        still = (walk.speed < STILL) | (walk.stage != Stage.WALK)
        motion = nearest(self.gaits.walk, walk.speed)
        some = np.flatnonzero(now.in_row)
        if len(some):
            yaw = self._yaw_in_row(now, some)
            to_left = now.tangent[0, some] * np.cos(yaw) > now.tangent[1, some] * np.sin(yaw)
            speed = walk.speed[some]
            left, right = nearest(self.gaits.left, speed), nearest(self.gaits.right, speed)
            motion[some] = np.where(to_left, left, right)
        before = self._speeds[walk.motion]
        calm = self._calm[walk.agent % len(self._calm)]
        motion = np.where(still, np.where(before == 0.0, walk.motion, calm), motion)
        off = np.abs(self._speeds[motion] - walk.speed) + np.float32(0.02)
        better = off < np.abs(before - walk.speed)
        turns = self._sideways[motion] != self._sideways[walk.motion]
        change = (motion != walk.motion) & (better | turns | still) & (tick - walk.since >= _HOLD)
        if change.any():
            walk.motion = np.where(change, motion, walk.motion)
            walk.since[change] = tick
            self._changed = True

    def _yaw_in_row(self, now: Now, some: Ints) -> F32:
        """Where those look (K,) who pass the seats of a row: to the pitch, as people there do."""
        walk = self.walk
        index = np.clip(
            np.rint(now.seat[some]).astype(np.int64), 0, np.maximum(now.passes[some], 0)
        )
        index = np.where(
            walk.errand[some] == Errand.LEAVE, np.minimum(index, now.passes[some] - 1), index
        )
        yaw: F32 = self._plan.yaw[walk.first[some] + walk.step[some] * index]
        return yaw

    def _place(self, now: Now, placement: Placement, seconds: float) -> None:
        walk = self.walk
        agents = walk.agent
        placement.position[0, agents] = now.x
        placement.position[1, agents] = now.y
        placement.position[2, agents] = now.z
        ahead = np.arctan2(now.tangent[0], now.tangent[1])
        wanted = np.where(walk.stage == Stage.STAND, ahead + np.float32(np.pi), ahead)
        some = np.flatnonzero(now.in_row)
        wanted[some] = self._yaw_in_row(now, some)
        at_home = (walk.stage == Stage.SETTLE) | (walk.stage == Stage.RISE)
        wanted = np.where(at_home, self._home_yaw[agents], wanted)
        most = np.float32(TURN * seconds)
        yaw = placement.yaw[agents]
        turn = np.minimum(np.maximum(_wrapped(wanted - yaw), -most), most)
        placement.yaw[agents] = _wrapped(yaw + turn)


def _wrapped(angle: F32) -> F32:
    """The same angle from -pi to pi."""
    whole = np.float32(2.0 * np.pi)
    result: F32 = angle - whole * np.rint(angle / whole)
    return result

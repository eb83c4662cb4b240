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
from ...components.walk import RATES, Errand, Leg, Stage, Walk
from ..crowd.gaits import Gaits
from ..crowd.seating import SeatPlan
from ..streams.pool import POSE_RATE
from .compiled import CompiledTable
from .gangways import STAIR_SPEED, Gangways, Route
from .guidance import BODY, NOTHING, Guidance, Order, Priority
from .legs import FAR, legs_of, passed
from .making_room import NEAR_ROW, RoomMakers
from .nearby import Nearby
from .steering import REACH
from .table import STANDING
from .walk_gait import Gaiting
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
_CHOICES = 3
"""Pose ticks from one choice of who makes room, and of gaits, to the next."""
_SOON = 9
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
    size
        (N,) how long their legs are, 1 for the character's own.
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
        size: F32,
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
        self._hopes: dict[int, tuple[float, float, int]] = {}
        self._now: Now | None = None
        self._near = Nearby(REACH)
        self._gaiting = Gaiting(gaits, self._calm, len(compiled.seated), size)
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
            passed = advance(walk, seconds)
            self._now = look(walk)
            moved.append(walk.agent.copy())
            self._place(self._now, placement, seconds)
            if len(passed):
                self._pass(passed, tick)
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
            now = self._now or look(walk)
            self._grant()
            rising = np.flatnonzero(walk.stage == Stage.RISE)
            if len(rising):
                agents = walk.agent[rising]
                up = ~self._seated[motion.shown[agents]] & (motion.busy_until[agents] <= tick)
                walk.stage[rising[up]] = Stage.WALK
                walk.enter(rising[up])
            pairs = self._near.pairs(walk, now.place[0], now.place[2])
            steer(walk, now, self._to_seated(motion, tick), pairs)
            if tick % _CHOICES == 1:
                self._changed |= self._gaiting.choose(walk, tick)
        if tick % _CHOICES == 0 and self.room.choose(walk, ~self.away):
            room = self.gaits.make_room if len(self.gaits.make_room) else self._calm
            ids = self.room.agents
            guidance.revise(self._asked, ids, room[ids % len(room)])
        self._depart(tick, placement)
        if self._changed:
            order = np.argsort(walk.agent)
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
        here = placement.position[::2, self.walk.agent]
        late = []
        for agent, errand, _ in some.tolist():
            if not self._begin(agent, Errand(errand), placement, here):
                late.append((agent, errand, tick + _RETRY))
            elif errand != Errand.LEAVE:
                here = placement.position[::2, self.walk.agent]
        if late:
            at = int(np.searchsorted(rest[:, 2], tick + _RETRY, "right"))
            rest = np.concatenate([rest[:at], np.array(late, np.int64), rest[at:]])
        self.waiting = rest

    def _begin(self, agent: int, errand: Errand, placement: Placement, here: F32) -> bool:
        """Let somebody set out; False if others (2, W) are in the way yet, or come towards it."""
        if errand is Errand.PATROL:
            gate = self.posts[agent]
            route = self.ways.stairs(gate, min(1, self.ways.rows(gate) - 1), 0)
            self._add(agent, errand, route, -1)
            placement.position[:, agent] = route.points[0]
            return True
        run = self.ways.run_of(agent)
        if agent not in self._hopes:
            gate, seats = self.ways.choose(agent)
            x, _, z = self.ways.door_of(gate).tolist()
            self._hopes[agent] = (x, z, seats.step)
        x, z, step = self._hopes[agent]
        if errand is Errand.ARRIVE:
            dx, dz = here[0] - np.float32(x), here[1] - np.float32(z)
            if (dx * dx + dz * dz < np.float32(_DOOR * _DOOR)).any():
                return False
        elif not self._take(run, -step):
            return False
        del self._hopes[agent]
        route = self.ways.to_seat(agent)
        if errand is Errand.ARRIVE:
            self._occupied[agent] = True
            placement.position[:, agent] = route.points[0]
            ahead = route.points[1] - route.points[0]
            placement.yaw[agent] = np.arctan2(ahead[0], ahead[2])
        else:
            route = route.reversed(len(route.points) - route.seat0)
        self._add(agent, errand, route, run)
        return True

    def _add(self, agent: int, errand: Errand, route: Route, run: int) -> None:
        mean, spread, least, most = PACE
        self.walk.add(
            legs_of(route, errand, self._plan.yaw),
            agent=agent,
            errand=errand,
            stage=Stage.RISE if errand is Errand.LEAVE else Stage.WALK,
            pace=float(np.clip(self._rng.normal(mean, spread), least, most)),
            mouth=route.mouth,
            first=route.first,
            step=route.step,
            passes=passed(route, errand),
            run=run,
            granted=errand is not Errand.ARRIVE,
            motion=int(self._calm[agent % len(self._calm)]),
        )
        if errand is Errand.LEAVE:
            self._look_ahead(np.array([len(self.walk) - 1]))
        self._walking[agent] = self.away[agent] = self._changed = True
        self._now = None

    def _look_ahead(self, some: Ints) -> None:
        """Let some (K,) turn to where they look at their seats."""
        self.walk.leg[Leg.YAW, some] = self._home_yaw[self.walk.agent[some]]
        self.walk.leg[RATES][Leg.YAW, some] = 0.0

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

    def _grant(self) -> None:
        walk = self.walk
        asks = walk.leg[Leg.TO_MOUTH] - walk.along < np.float32(BEFORE_MOUTH + 1.0)
        asks &= ~walk.granted
        for k in np.flatnonzero(asks):
            walk.granted[k] = self._take(int(walk.run[k]), int(walk.step[k]))

    def _pass(self, passed: Ints, tick: int) -> None:
        """What follows for those (K,) who passed a vertex: a row is free, or a way ends."""
        walk = self.walk
        out = (walk.errand[passed] == Errand.LEAVE) & (walk.run[passed] >= 0)
        out &= walk.vertex[passed] >= walk.mouth[passed]
        self._give(walk.run[passed[out]])
        walk.run[passed[out]] = -1
        ends = passed[walk.vertex[passed] >= walk.last[passed]]
        if not len(ends):
            return
        walk.speed[ends] = walk.drift[ends] = 0.0
        walk.stage[ends[walk.errand[ends] == Errand.LEAVE]] = Stage.GONE
        settles = ends[walk.errand[ends] == Errand.ARRIVE]
        walk.stage[settles] = Stage.SETTLE
        self._look_ahead(settles)
        patrol = ends[walk.errand[ends] == Errand.PATROL]
        walk.stage[patrol] = Stage.STAND
        # Up on the stairs they only turn round: who stood there would be in the way.
        stay = self._rng.uniform(*POST, len(patrol))
        for k, seconds in zip(patrol.tolist(), stay.tolist(), strict=True):
            down = walk.ways[k][-1, Leg.Y] <= walk.ways[k][0, Leg.Y]
            walk.until[k] = tick + round((seconds if down else 1.0) * POSE_RATE)
        walk.leg[Leg.YAW, patrol] += np.float32(np.pi)

    def _finish(self, tick: int, placement: Placement) -> Ints:
        """Those who came to the end of their way; ids of who is at its seat."""
        walk = self.walk
        arrived = np.flatnonzero(walk.stage == Stage.SETTLE)
        if len(arrived):
            agents = walk.agent[arrived]
            facing = _wrapped(self._home_yaw[agents] - placement.yaw[agents])
            arrived = arrived[np.abs(facing) < _ALIGNED]
        ids: Ints = walk.agent[arrived]
        gone = walk.stage == Stage.GONE
        if len(arrived) or gone.any():
            self._give(walk.run[arrived])
            self._occupied[walk.agent[gone]] = False
            gone[arrived] = True
            done = walk.agent[gone]
            placement.position[:, done] = self._plan.position[:, done]
            placement.yaw[done] = self._home_yaw[done]
            self.away[ids] = self._walking[done] = False
            self._forget(gone)
        again = walk.stage == Stage.STAND
        if again.any():
            self._patrol(again & (walk.until <= tick))
        return ids

    def _forget(self, some: NDArray[np.bool_]) -> None:
        self._near.keep(~some)
        self.walk.keep(~some)
        self._now, self._changed = None, True

    def _patrol(self, again: NDArray[np.bool_]) -> None:
        """Send stewards (W,) up their gangway, to as far as its middle, or down again."""
        walk = self.walk
        if not again.any():
            return
        agents, at = walk.agent[again], walk.leg[Leg.Y, again]
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

    def _to_seated(self, motion: MotionState, tick: int) -> F32:
        """(W,) metres along the row to the next person who sits yet; inf if nobody does."""
        walk, leg = self.walk, self.walk.leg
        room = np.full(len(walk), np.inf, np.float32)
        near = leg[Leg.IN_ROW] > 0
        near |= leg[Leg.TO_MOUTH] - walk.along < np.float32(NEAR_ROW)
        near &= walk.waited < np.float32(PATIENCE)
        some = np.flatnonzero(near)
        some = some[leg[Leg.TO_SEAT, some] < FAR]
        after = np.maximum(leg[Leg.SEAT, some].astype(np.int64) + 1, 0)
        ids = walk.first[some] + walk.step[some] * after
        busy = self._seated[motion.shown[ids]] | (motion.busy_until[ids] > tick + _SOON)
        busy &= ~self.away[ids]
        some = some[busy]
        room[some] = leg[Leg.TO_SEAT, some] - walk.along[some]
        return room

    def _place(self, now: Now, placement: Placement, seconds: float) -> None:
        walk = self.walk
        agents = walk.agent
        for axis in (0, 1, 2):
            placement.position[axis, agents] = now.place[axis]
        yaw = placement.yaw[agents]
        turn = _wrapped(now.yaw - yaw)
        most = np.float32(TURN * seconds)
        np.minimum(np.maximum(turn, -most, out=turn), most, out=turn)
        yaw += turn
        placement.yaw[agents] = _wrapped(yaw)


def _wrapped(angle: F32) -> F32:
    """The same angle from -pi to pi."""
    whole = np.float32(2.0 * np.pi)
    result: F32 = np.subtract(angle, whole * np.rint(angle / whole), dtype=np.float32)
    return result

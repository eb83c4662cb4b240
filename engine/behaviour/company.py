"""What people do because others do it: the mechanisms of one crowd, and what they tell the machine.

Applause, rhythm, Mexican waves, moods and parties each have a module of their own. A `Company` owns
those of a crowd, lets events cue applause, and supplies the signals that a behaviour table's rules
ask for:

=================  ==========================================================
`clapping_wanted`  the applause has got hold of the agent
`wave_wanted`      a Mexican wave reaches it, in this pose tick
`neighbour_left`   the member of its party to talk to sits to the left
`neighbour_right`  ... to the right
`spoken_to`        that member talks
`leader_stands`    the agent follows somebody who is on his feet
`seated`           the agent's posture
`distance`         metres to where the last event happened; infinite where it had no place
`player_near`      a player is close: the scorer, or one who comes to the stand
=================  ==========================================================
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...components.behaviour import Behaviour
from ...components.emotion import Emotion
from ...components.party import Party
from ...components.placement import Placement
from ...components.team import Team
from ..crowd.agents import agent_ids
from ..crowd.seating import SeatPlan
from ..streams.pool import POSE_RATE
from .applause import Applause
from .compiled import CompiledTable
from .contagion import EmotionContagion
from .cueing import Cues
from .events import PLACED, Event
from .following import Following
from .hearing import Hearing
from .machine import wake
from .parties import turn_towards
from .responses import distance_to
from .rhythm import Rhythm
from .table import PIECE, SEATED
from .wave import MexicanWave

TALKING_REACH = 1.6
"""Metres to the member of one's party up to which people talk."""
BESIDE = 0.4
"""Radians by which that member sits to one side, at least."""
SHY = (0.9, 0.4)
"""Threshold of clapping, as a multiple of the person's: without embarrassment, and more with it."""
BORED = 0.022
"""By how much getting up raises the share of others that it takes the next time."""
FRESH_AGAIN = 240.0
"""Seconds in which all but 1/e of that is forgotten."""
WAVE_STARTERS = 50
"""People who get up where a Mexican wave shall begin."""
ENDS_WAVE = 0.5
"""Weight of an event from which on everybody looks at the pitch and a Mexican wave ends."""
USUAL = 0.15
"""Excitement above one's own at rest that is no reason to clap yet."""
SULKING = -0.25
"""Mood below which nobody claps because of being excited."""
GREETING_RADIUS = 14.0
"""Metres up to which people wave to a player or reach out to him."""
GREETING = 9.0
"""Seconds that he stays there."""
_STEP = 1.0 / POSE_RATE


class Company:
    """The mechanisms of one crowd.

    Parameters
    ----------
    plan, present
        The seats, and (N,) who is there.
    team, emotion, party
        Columns of the crowd; the emotions' are changed by contagion.
    rng
        Where choices come from.

    Attributes
    ----------
    applause, rhythm, contagion, following
        The models; see their modules.
    party
        Who came with whom.
    signals
        By name, (N,) columns for `Behaviour.signals`.
    """

    def __init__(
        self,
        plan: SeatPlan,
        present: NDArray[np.bool_],
        team: Team,
        emotion: Emotion,
        party: Party,
        rng: np.random.Generator,
    ) -> None:
        count = plan.count
        hearing = Hearing.of_sections(plan, present)
        self._plan, self._present, self._rng = plan, present, rng
        self.rhythm = Rhythm(hearing, rng)
        self.applause = Applause(hearing, rng, self.rhythm.rate)
        self._cues = Cues(self.applause, team)
        self.contagion = EmotionContagion(plan, present, team.side)
        self.contagion.excitement_rest = emotion.rest_excitement
        self.party, self.following = party, Following(party, team)
        self._threshold = self.applause.threshold.copy()
        self._away = np.zeros(count, np.bool_)
        self._wave: MexicanWave | None = None
        self._eager = np.zeros(0, np.float32)
        left, right = _neighbours(plan, party)
        self.signals: dict[str, NDArray[np.generic]] = {
            "clapping_wanted": np.zeros(count, np.bool_),
            "wave_wanted": np.zeros(count, np.bool_),
            "neighbour_left": left,
            "neighbour_right": right,
            "spoken_to": np.zeros(count, np.bool_),
            "leader_stands": self.following.stands,
            "seated": np.zeros(count, np.bool_),
            "distance": np.full(count, np.inf, np.float32),
            "player_near": np.zeros(count, np.bool_),
        }
        self._waving = np.zeros(0, np.int64)
        self._greeted = np.zeros(0, np.int64)
        self._greets_until: int | None = None
        self._arms = -1

    @property
    def wave(self) -> MexicanWave:
        """The medium of Mexican waves; made when it is first asked for."""
        if self._wave is None:
            self._wave = MexicanWave(self._plan, self._rng, self._present)
            self._eager = self._wave.threshold.copy()
        return self._wave

    def start_wave(self, agents: int | ArrayLike) -> NDArray[np.int64]:
        """Let agents, ids or a mask, get up for a Mexican wave; ids of those who do."""
        ids = agent_ids(agents, len(self._present))
        return self.wave.start(ids) if len(ids) else ids

    @property
    def away(self) -> NDArray[np.bool_]:
        """(N,) who is away, or on the way."""
        return self._away

    def excuse(self, agents: NDArray[np.int64], away: bool) -> None:
        """Let agents take no part in applause while they are away or on their way, or again."""
        self._away[agents] = away
        self.applause.admit(agents, not away)
        if away:
            self.signals["clapping_wanted"][agents] = False
        else:
            self._present[agents] = True

    def see(
        self, event: Event, compiled: CompiledTable, team: Team, placement: Placement
    ) -> NDArray[np.int64]:
        """Let an event ask for applause, end a wave, or say how far away it was.

        Returns
        -------
        (K,) int64 ids of those who have a player close to them now, where it happens
        """
        greeted = np.zeros(0, np.int64)
        if (
            self._wave is not None
            and event.kind not in PLACED
            and (event.weight or 0.0) >= ENDS_WAVE
        ):
            self._wave.reset()
        distance = None
        if event.place is None:
            self.signals["distance"][:] = np.inf
        else:
            distance = distance_to(placement, event.place)
            self.signals["distance"][:] = distance
            if event.kind in ("goal", "player_close"):
                friends = (team.side == event.side) | (event.kind == "player_close")
                self._arms = compiled.machine_number("arms")
                near = (distance <= GREETING_RADIUS) & friends & self.applause.hearing.present
                greeted = np.flatnonzero(near)
                self._greet(greeted)
            if event.kind == "mexican_wave":
                here = np.flatnonzero(self.applause.hearing.present)
                nearest = np.argsort(distance[here], kind="stable")[:WAVE_STARTERS]
                self.start_wave(here[nearest])
        self._cues.take(event, compiled, distance)
        return greeted

    def step(self, tick: int, emotion: Emotion, behaviour: Behaviour) -> None:
        """Advance all mechanisms by a pose tick, and wake those whose signals change."""
        self.contagion.step(emotion.mood, emotion.excitement, _STEP, emotion.susceptibility)
        self._boil(tick, emotion)
        self._cues.step()
        started, stopped = self.applause.step(_STEP)
        wanted = self.signals["clapping_wanted"]
        wanted[started], wanted[stopped] = True, False
        # Others hear who begins from now on, so it begins now, unless its arms do something else.
        at_rest = behaviour.arms[started] == 0
        wake(behaviour, 0, started[at_rest], tick, rapid=True)
        for later in (started[~at_rest], stopped):
            wake(behaviour, 0, later, tick)
        self._watch_player(tick, behaviour)
        self.following.step(tick, behaviour, self._away)
        waving = self.signals["wave_wanted"]
        waving[self._waving] = False
        if self._wave is not None:
            self._waving = self._wave.step().rose
            if len(self._waving):
                waving[self._waving] = True
                self._wave.threshold[self._waving] += np.float32(BORED)
                wake(behaviour, 0, self._waving, tick, rapid=True)
        np.equal(behaviour.posture, SEATED, out=self.signals["seated"])

    def listen(
        self,
        compiled: CompiledTable,
        behaviour: Behaviour,
        changed: NDArray[np.int64],
        tick: int,
    ) -> None:
        """Let those be spoken to whose neighbours among `changed` began to talk, or no longer."""
        machine = compiled.machine_number("head")
        if machine < 0 or "talk" not in compiled.head_names:
            return
        others = self.party.nearest[changed]
        some = np.flatnonzero(others >= 0)
        others = others[some].astype(np.int64)
        value = compiled.head[behaviour.state[machine, changed[some]]]
        talk = compiled.head_names.index("talk")
        talks = value == talk
        spoken_to = self.signals["spoken_to"]
        spoken_to[others[~talks]] = False
        new = others[talks]
        new = np.unique(new[~spoken_to[new].astype(np.bool_)])
        spoken_to[new] = True
        # Who talks already answers by going on.
        silent = new[compiled.head[behaviour.state[machine, new]] != talk]
        if len(silent):
            wake(behaviour, machine, silent, tick + 1)

    def columns(self) -> list[NDArray[np.generic]]:
        """What is part of the crowd's state."""
        found: list[NDArray[np.generic]] = [self.applause.state, self.rhythm.phase]
        found += self.signals.values()
        return found if self._wave is None else [*found, self._wave.state]

    def _greet(self, agents: NDArray[np.int64]) -> None:
        """Let agents see a player close to them, from the next step on."""
        self.signals["player_near"][self._greeted] = False
        self._greeted, self._greets_until = agents, None
        self.signals["player_near"][agents] = True

    def _watch_player(self, tick: int, behaviour: Behaviour) -> None:
        """The player comes, and is gone after a while."""
        if not len(self._greeted):
            return
        comes = self._greets_until is None
        if self._greets_until is None:
            self._greets_until = tick + round(GREETING * POSE_RATE)
        if (comes or tick >= self._greets_until) and self._arms > 0:
            wake(behaviour, self._arms, self._greeted, tick, rapid=comes)
        if tick >= self._greets_until:
            self.signals["player_near"][self._greeted] = False
            self._greeted = self._greeted[:0]

    def _boil(self, tick: int, emotion: Emotion) -> None:
        """Excitement above what is usual is a reason to clap, and embarrassment one not to.

        A tenth of the crowd is brought up to date in each pose tick, and forgets a bit of how often
        it got up for a Mexican wave.
        """
        count, turn = len(self._present), tick % PIECE
        who = slice(turn * count // PIECE, (turn + 1) * count // PIECE)
        unusual = emotion.excitement[who] - emotion.rest_excitement[who]
        unusual = np.maximum(unusual - np.float32(USUAL), 0.0)
        unusual *= emotion.mood[who] > SULKING
        self.applause.ground[who] = self.contagion.clap_benefit(unusual)
        shy = np.float32(SHY[0]) + np.float32(SHY[1]) * emotion.embarrassment[who]
        self.applause.threshold[who] = self._threshold[who] * shy
        if self._wave is not None:
            bored = self._wave.threshold[who]
            bored += (self._eager[who] - bored) * np.float32(PIECE / POSE_RATE / FRESH_AGAIN)


def _neighbours(plan: SeatPlan, party: Party) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """(N,) whose companion sits to the left, and whose to the right, near enough to talk."""
    everyone = np.arange(plan.count)
    other = np.where(party.nearest >= 0, party.nearest, everyone)
    apart = np.linalg.norm(plan.position - plan.position[:, other], axis=0)
    angle = turn_towards(plan, everyone, party.nearest)
    near = (party.nearest >= 0) & (apart <= TALKING_REACH)
    return near & (angle > BESIDE), near & (angle < -BESIDE)

"""Takes down what agents show, frame by frame, for files of other programs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import ceil, floor, isfinite

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..engine.clock import BASE_RATE, TICKS_PER_POSE, Clock
from ..engine.crowd.agents import agent_ids
from ..engine.crowd.occupancy import select
from ..engine.crowd.physique import seat_lift
from ..engine.crowd.regions import SURFACES
from ..engine.export.recording import Recording, recorded_bytes
from .crowd import Crowd

Agents = int | str | Sequence[int | str] | ArrayLike | None
"""An id, a mask, seats as text such as ``"section 5"``, or several ids and texts; None for all."""

MOST_BYTES = 2 * 1024**3
"""Memory that the palettes of one recording may take."""
MOST_SECONDS = 3600.0
FPS_RANGE = (1.0, 240.0)


def present_agents(crowd: Crowd, agents: Agents = None) -> NDArray[np.int64]:
    """Ids (K,) of those agents that are there, ascending; empty seats are passed over.

    Parameters
    ----------
    crowd
        Whose agents they are.
    agents
        An id, ids, or a (N,) mask; seats as text, such as ``"12|345"``, ``"rows 3-10"``,
        ``"section 5"``; several ids and texts; None for everybody.

    Raises
    ------
    ValueError
        For agents or seats that don't exist, or if nobody is there.
    """
    if agents is None:
        ids = np.arange(len(crowd))
    elif isinstance(agents, str):
        ids = np.flatnonzero(select(crowd.plan, [agents]))
    elif isinstance(agents, (list, tuple)) and any(isinstance(one, str) for one in agents):
        seats = [one for one in agents if isinstance(one, str)]
        others = agent_ids([one for one in agents if not isinstance(one, str)], len(crowd))
        ids = np.union1d(np.flatnonzero(select(crowd.plan, seats)), others)
    else:
        ids = np.unique(agent_ids(agents, len(crowd)))
    there = ids[crowd.seat.occupied[ids]]
    if len(there):
        return there
    why = f"the seats of all {len(ids):,} that are chosen are empty" if len(ids) else "none given"
    raise ValueError(f"agents: nobody is there to record, {why}")


def check_times(start: float, seconds: float, fps: float) -> None:
    """ValueError for times that can't be recorded."""
    _checked("start", start, 0.0, MOST_SECONDS)
    _checked("seconds", seconds, 0.0, MOST_SECONDS)
    _checked("fps", fps, *FPS_RANGE)


class Recorder:
    """Collects frames of a crowd; for worlds that step themselves.

    Parameters
    ----------
    crowd
        Whose agents are recorded.
    agents
        As for `present_agents`.
    frames
        How many will be taken.
    fps
        Frames a second.

    Raises
    ------
    ValueError
        For agents that don't exist, nobody, or more than `MOST_BYTES`.

    Examples
    --------
    >>> from tifo.engine.crowd.spec import CrowdSpec
    >>> from tifo.systems.simulation import Simulation
    >>> simulation = Simulation(CrowdSpec(rows=2, columns=3, layout="stand", occupancy=1.0))
    >>> recorder = Recorder(simulation.crowd, "rows 1", frames=1, fps=30)
    >>> recorder.take(simulation.clock.pose_tick)
    >>> recorder.finish().labels
    ('1|0', '1|1', '1|2')
    """

    def __init__(self, crowd: Crowd, agents: Agents = None, *, frames: int, fps: float) -> None:
        self._crowd = crowd
        self._ids = present_agents(crowd, agents)
        self._fps = _checked("fps", fps, *FPS_RANGE)
        if frames < 1:
            raise ValueError(f"frames is {frames}, expected 1 or more")
        count, joints = len(self._ids), crowd.character.skeleton.joint_count
        size = recorded_bytes(frames, count, joints)
        if size > MOST_BYTES:
            raise ValueError(
                f"{count:,} agents at {frames:,} moments take {size / 1e9:.1f} GB of memory, at "
                f"most {MOST_BYTES / 1e9:.1f} GB are allowed; fewer agents, a shorter time or "
                "fewer frames a second take less"
            )
        self._palettes = np.empty((frames, count, joints, 3, 4), np.float32)
        self._position = np.empty((frames, count, 3), np.float32)
        self._yaw = np.empty((frames, count), np.float32)
        self._scale = np.empty((frames, count), np.float32)
        self._taken = 0

    def take(self, tick: int, alpha: float = 1.0) -> None:
        """Take the next frame.

        Parameters
        ----------
        tick, alpha
            Current pose tick and the fraction of it that has passed, as for `Crowd.palettes`.

        Raises
        ------
        ValueError
            If all frames were taken, or an override has no Python form.
        """
        if self._taken == len(self._palettes):
            raise ValueError(f"all {self._taken} frames were taken")
        crowd, ids, frame = self._crowd, self._ids, self._taken
        palettes = crowd.palettes(ids, tick, alpha)
        self._palettes[frame] = palettes
        place = crowd.placement
        self._position[frame] = place.position[:, ids].T
        self._position[frame, :, 1] += _lift(crowd, ids, palettes)
        self._yaw[frame], self._scale[frame] = place.yaw[ids], place.scale[ids]
        self._taken += 1

    def finish(self) -> Recording:
        """What was taken; ValueError before the last frame."""
        if self._taken < len(self._palettes):
            raise ValueError(f"{self._taken} of {len(self._palettes)} frames were taken")
        crowd, ids = self._crowd, self._ids
        looks = [getattr(crowd.appearance, surface)[ids, :3] for surface in SURFACES]
        return Recording(
            character=crowd.character,
            agents=ids,
            labels=tuple(crowd.plan.label(int(k)) for k in ids),
            fps=self._fps,
            palettes=self._palettes,
            position=self._position,
            yaw=self._yaw,
            scale=self._scale,
            girth=crowd.body.girth[ids],
            head=crowd.body.head[ids],
            colors=np.stack(looks, axis=1).astype(np.uint8),
            morphs=crowd.physique.morphs if crowd.physique is not None else None,
            choice=crowd.body.choice[:, ids],
            second=crowd.appearance.second[ids, :3],
            pattern=crowd.appearance.pattern[ids],
            regions=crowd.regions,
        )


def record(
    crowd: Crowd,
    clock: Clock,
    tick: Callable[[], None],
    agents: Agents = None,
    *,
    start: float = 0.0,
    seconds: float = 0.0,
    fps: float = 30.0,
    progress: Callable[[str, int, int], None] | None = None,
) -> Recording:
    """Let time pass and take frames of it.

    Parameters
    ----------
    crowd, clock
        What is recorded, and its time.
    tick
        Lets one base tick pass.
    agents
        As for `present_agents`.
    start
        Seconds that pass before the first frame.
    seconds
        Time from the first frame to the last; 0 takes one.
    fps
        Frames a second, 1 to 240; frames between base ticks show what drawing shows there.
    progress
        Called as ``progress(what, done, total)`` after every frame.

    Raises
    ------
    ValueError
        For agents that don't exist, nobody, times out of range, or too much memory.
    """
    check_times(start, seconds, fps)
    rate = float(fps)
    frames = floor(seconds * rate + 1e-6) + 1
    recorder = Recorder(crowd, agents, frames=frames, fps=rate)
    origin = clock.tick
    for frame in range(frames):
        due = (start + frame / rate) * BASE_RATE
        while clock.tick - origin < floor(due + 1e-6):
            tick()
        passed = clock.tick % TICKS_PER_POSE + max(due - (clock.tick - origin), 0.0)
        recorder.take(clock.pose_tick, min(passed / TICKS_PER_POSE, 1.0))
        if progress is not None:
            progress("frames", frame + 1, frames)
    # Whole ticks only, so that the next recording goes on where this one ends.
    while clock.tick - origin < ceil(due - 1e-6):
        tick()
    return recorder.finish()


def _checked(name: str, value: float, least: float, most: float) -> float:
    if not isfinite(value) or not least <= value <= most:
        raise ValueError(f"{name} is {value}, expected {least:g} to {most:g}")
    return float(value)


def _lift(
    crowd: Crowd, ids: NDArray[np.int64], palettes: NDArray[np.float32]
) -> NDArray[np.float32]:
    """(K,) metres by which agents are moved up onto their seats."""
    body = crowd.physique
    if body is None or body.seats is None:
        return np.zeros(len(ids), np.float32)
    hips = palettes[:, body.hips, 1] @ np.append(body.hips_bind, np.float32(1.0))
    scale = crowd.placement.scale[ids]
    return seat_lift(hips, scale, body.legs[crowd.body.kind[ids]], body.seats)

"""Which clips agents play, when and how: what a clip scheduler of an animation program needs.

*Thesis* 3.3.1: motions lie in a library, and an agent's timeline holds instances of them. An
instance has a start, a range of its source, how often that is repeated, and a scale of time; it is
relative, so it moves the agent where its seat is.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .targets import check_target, replacing

KINDS = (".csv", ".json")
_DIGITS = 4


@dataclass(frozen=True, slots=True, eq=False)
class ClipSchedule:
    """K clip instances of A agents, by agent and then by time.

    ``end - start = cycles * (source_end - source_start) * scale``, but for instances that hold one
    pose, whose range is empty.

    Parameters
    ----------
    seconds
        Length of the timeline.
    agents, labels, position, yaw, size
        (A,) ids, and the seats' labels; (A, 3) metres, (A,) radians and (A,) scale: where agents
        are and how large. Clips move them from there.
    clips, durations, looping
        Names and seconds of the clips, and whether they are repeated seamlessly.
    states
        Names of the behaviour table's states.
    agent
        (K,) int64 id.
    clip, state
        (K,) int64 which clip, and what the agent's body did when the instance began.
    start, end
        (K,) float64 seconds on the timeline.
    source_start, source_end
        (K,) float64 seconds in the clip. The end of a looping clip's range may lie beyond the
        clip's: it goes on at the beginning. Beyond the ends of others their first or last pose is
        held.
    cycles
        (K,) float64 how often the range is played, 1 or more.
    scale
        (K,) float64 by how much the range is stretched on the timeline; 0.8 is faster.
    blend
        (K,) float64 seconds in which it blends in from the instance before.
    relative
        (K,) bool, all true: clips are played in the agent's own frame (*Thesis* 3.3.2).
    """

    seconds: float
    agents: NDArray[np.int64]
    labels: tuple[str, ...]
    position: NDArray[np.float32]
    yaw: NDArray[np.float32]
    size: NDArray[np.float32]
    clips: tuple[str, ...]
    durations: NDArray[np.float64]
    looping: NDArray[np.bool_]
    states: tuple[str, ...]
    agent: NDArray[np.int64]
    clip: NDArray[np.int64]
    state: NDArray[np.int64]
    start: NDArray[np.float64]
    end: NDArray[np.float64]
    source_start: NDArray[np.float64]
    source_end: NDArray[np.float64]
    cycles: NDArray[np.float64]
    scale: NDArray[np.float64]
    blend: NDArray[np.float64]
    relative: NDArray[np.bool_]

    def __len__(self) -> int:
        """Number of instances."""
        return len(self.agent)

    def rows(self, agent: int | None = None) -> Iterator[dict[str, Any]]:
        """Instances as dictionaries, all or those of one agent; ValueError for one without any."""
        of = {int(k): label for k, label in zip(self.agents, self.labels, strict=True)}
        which: range | list[int] = range(len(self))
        if agent is not None:
            if agent not in of:
                raise ValueError(f"agent is {agent}, which is not in the schedule")
            which = np.flatnonzero(self.agent == agent).tolist()
        numbers = ("start", "end", "source_start", "source_end", "cycles", "scale", "blend")
        columns = {name: getattr(self, name) for name in numbers}
        for k in which:
            one = int(self.agent[k])
            yield {
                "agent": one,
                "seat": of[one],
                "clip": self.clips[self.clip[k]],
                "state": self.states[self.state[k]],
                **{name: round(float(column[k]), _DIGITS) for name, column in columns.items()},
                "relative": bool(self.relative[k]),
            }

    def write(self, path: str | Path) -> Path:
        """Write a .csv file, a line an instance, or a .json file, which has clips and places too.

        Returns
        -------
        Path
            Of the file.

        Raises
        ------
        AssetError
            If the file can't be written, or its name has another ending.
        """
        target = check_target(path, KINDS)
        with replacing(target) as unfinished:
            if target.suffix.lower() == ".csv":
                self._write_csv(unfinished)
            else:
                self._write_json(unfinished)
        return target

    def _write_csv(self, path: Path) -> None:
        names = (
            *("agent", "seat", "clip", "state", "start", "end", "source_start", "source_end"),
            *("cycles", "scale", "blend", "relative"),
        )
        with path.open("w", newline="", encoding="utf-8") as lines:
            writer = csv.DictWriter(lines, names)
            writer.writeheader()
            for row in self.rows():
                writer.writerow(row | {"relative": "true" if row["relative"] else "false"})

    def _write_json(self, path: Path) -> None:
        of: dict[int, list[dict[str, Any]]] = {int(agent): [] for agent in self.agents}
        for row in self.rows():
            del row["seat"]
            of[row.pop("agent")].append(row)
        clips = zip(self.clips, self.durations, self.looping, strict=True)
        document = {
            "seconds": self.seconds,
            "clips": {
                name: {"seconds": round(float(length), _DIGITS), "looping": bool(loops)}
                for name, length, loops in clips
            },
            "agents": [
                {
                    "agent": int(agent),
                    "seat": label,
                    "position": [round(float(x), _DIGITS) for x in place],
                    "yaw": round(float(yaw), _DIGITS),
                    "size": round(float(size), _DIGITS),
                    "clips": of[int(agent)],
                }
                for agent, label, place, yaw, size in zip(
                    self.agents, self.labels, self.position, self.yaw, self.size, strict=True
                )
            ],
        }
        with path.open("w", encoding="utf-8") as text:
            json.dump(document, text)
            text.write("\n")

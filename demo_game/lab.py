"""The lab: one small stand in which every row shows some features of the animation runtime."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

import tifo

from .captions import Caption
from .lab_bodies import BodyStation, LookStation, OverlayStation, PartStation
from .lab_motions import BlendSpaceStation, MachineStation, MaskStation
from .lab_station import Station
from .lab_time import DilatedStation, EntryStation, InStepStation, InterruptedStation

ROWS, COLUMNS = 3, 18
STEP, RISE, DEPTH = 0.86, 2.62, 1.6
SETTLE = 3.5
"""Seconds in which everybody sits down or gets up, before the stations begin."""
TICK_RATE = 60
WARM_UP = 6.0
"""Seconds that pass before the lab is shown, in which agents find their motions."""
FIELD = math.radians(8.0)
ELEVATION = math.radians(11.0)
SPREAD = (0.0, 8.0, 16.0, 24.0)

_SHIRTS = (
    *((222, 174, 52), (222, 174, 52), (214, 92, 56), (132, 96, 176)),
    *((46, 125, 190), (200, 76, 118), (70, 150, 92)),
    *((52, 146, 152), (196, 60, 52), (92, 112, 190), (128, 142, 66)),
)
"""sRGB colours of the stations, from the left of the top row to the right of the first."""


class Lab:
    """The crowd of the lab, its stations, and the words for them.

    Parameters
    ----------
    seed
        Of the crowd.

    Attributes
    ----------
    simulation
        The stand and its crowd.
    stations
        From the left of the top row to the right of the first.
    """

    keys = ""

    def __init__(self, seed: int = 1) -> None:
        groups = _groups()
        taken = {place for group in groups for place in group}
        every = {(row, column) for row in range(ROWS) for column in range(COLUMNS)}
        spec = tifo.CrowdSpec(
            layout="stand",
            rows=ROWS,
            columns=COLUMNS,
            step=STEP,
            rise=RISE,
            depth=DEPTH,
            occupancy=1.0,
            empty=tuple(f"{row}|{column}" for row, column in sorted(every - taken)),
            neutrals=0.0,
            children=0.1,
            old=0.1,
            streams=160,
            spare_streams=80,
            slots=32,
            props=0.0,
            lod=False,
            seed=seed,
        )
        self.simulation = tifo.Simulation(spec)
        self.time = -WARM_UP
        self._begin = 0
        ids = [self._ids(group) for group in groups]
        self._make_alike(ids)
        seated = (ids[3], ids[7])
        standing = np.setdiff1d(np.arange(ROWS * COLUMNS), np.concatenate(seated))
        self.simulation.crowd.guide(standing, motion="stand_idle")
        self.simulation.crowd.guide(ids[7], motion="sit_idle")
        self.simulation.run(seconds=SETTLE)
        self._begin = self.simulation.clock.tick
        self.stations = self._stations(ids)
        while self.time < -1e-6:
            self.simulation.run(seconds=1 / 30)
            self.advance(1 / 30)

    def advance(self, seconds: float) -> None:
        """Let the stations do what is due.

        The lab goes by its simulation's clock, which slow pictures hold back; whoever shows the
        lab runs the simulation.
        """
        self.time = (self.simulation.clock.tick - self._begin) / TICK_RATE - WARM_UP
        for station in self.stations:
            station.advance(self.time)

    def captions(self) -> list[Caption]:
        """A label below each agent and a title below each station."""
        words = []
        position = self.simulation.crowd.placement.position
        for station in self.stations:
            places = position[:, station.agents].T + np.array([0.0, -0.06, 0.13], np.float32)
            for place, label in zip(places, station.labels(), strict=True):
                words.append(Caption(_point(place), "", label))
            middle = places.mean(axis=0) - np.array([0.0, 0.28, 0.0], np.float32)
            words.append(Caption(_point(middle), station.title, station.text))
        return words

    def happen(self, kind: str, side: int, seat: int | None = None) -> str:
        """Nothing: the lab shows what it shows."""
        return ""

    def camera(self, name: str, size: tuple[int, int]) -> tifo.FreeCamera:
        """A camera before the lab: ``tv`` sees all of it, ``close`` some, ``bowl`` from aside."""
        rows = ROWS - 1
        # Below the first row are its captions, above the last one are hands.
        low, high = -0.95, rows * (RISE + DEPTH * math.tan(ELEVATION)) + 2.5
        width, height = STEP * COLUMNS + 0.9, (high - low) * math.cos(ELEVATION)
        middle = np.array([STEP * (COLUMNS - 1) / 2, 0.5 * (low + high), 0.0])
        aspect = size[0] / size[1]
        half = 0.5 * max(height, width / aspect) / math.tan(0.5 * FIELD)
        turn = 0.0
        if name == "close":
            middle, half = np.array([0.7 * middle[0], 0.95, 0.0]), 0.42 * half
        elif name == "bowl":
            turn, half = math.radians(32.0), 1.05 * half
        way = (
            math.sin(turn) * math.cos(ELEVATION),
            math.sin(ELEVATION),
            math.cos(turn) * math.cos(ELEVATION),
        )
        camera = tifo.FreeCamera.looking(tuple(middle + half * np.array(way)), tuple(middle))
        camera.fov = FIELD
        return camera

    def _ids(self, places: list[tuple[int, int]]) -> NDArray[np.int64]:
        rows, columns = zip(*places, strict=True)
        return self.simulation.plan.find_all(rows, columns)

    def _make_alike(self, groups: list[NDArray[np.int64]]) -> None:
        """Everybody is an adult of the same size who looks ahead; stations differ in colour."""
        crowd = self.simulation.crowd
        physique = crowd.physique
        assert physique is not None
        assert physique.seats is not None
        crowd.body.kind[:], crowd.body.girth[:], crowd.body.head[:] = 0, 0.0, 0.0
        crowd.placement.scale[:] = physique.seats.seat / physique.seats.sitting
        crowd.placement.yaw[:] = 0.0
        for agents, colour in zip(groups, _SHIRTS, strict=True):
            crowd.appearance.shirt[agents, :3] = colour
        for column in (crowd.body, crowd.placement, crowd.appearance):
            column.version += 1

    def _stations(self, ids: list[NDArray[np.int64]]) -> list[Station]:
        it = self.simulation
        return [
            InStepStation(it, ids[0]),
            DilatedStation(it, ids[1], SPREAD),
            MaskStation(it, ids[2]),
            EntryStation(it, ids[3]),
            BlendSpaceStation(it, ids[4]),
            InterruptedStation(it, ids[5]),
            MachineStation(it, ids[6]),
            OverlayStation(it, ids[7]),
            PartStation(it, ids[8]),
            LookStation(it, ids[9]),
            BodyStation(it, ids[10]),
        ]


def _groups() -> list[list[tuple[int, int]]]:
    """Rows and columns of each station's agents, with an empty seat between stations."""
    groups = []
    for row, sizes in ((2, (3, 4, 5, 3)), (1, (5, 5, 6)), (0, (3, 3, 4, 5))):
        first = 0
        gap = (COLUMNS - sum(sizes)) // (len(sizes) - 1)
        for size in sizes:
            groups.append([(row, column) for column in range(first, first + size)])
            first += size + gap
    return groups


def _point(place: NDArray[np.float32]) -> tuple[float, float, float]:
    x, y, z = place.tolist()
    return x, y, z

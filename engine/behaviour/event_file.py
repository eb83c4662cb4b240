"""Events of a whole match in a TOML file, for runs without anybody at the keys.

.. code:: toml

    [[events]]
    time = 12.5                 # seconds from the beginning
    kind = "goal"
    side = "home"               # or "away", or a number
    weight = 0.8                # as usual for its kind if absent

    [[events]]
    time = 20
    kind = "ball_in_crowd"
    place = "section 5"         # the middle of these seats; or [x, y, z] in metres
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np

from ..crowd.occupancy import select
from ..crowd.seating import SeatPlan
from ..errors import AssetError
from .events import Event

_KEYS = ("time", "kind", "side", "weight", "place")
_SIDES = {"home": 0, "away": 1}
_CHEST = 1.0


def load_events(path: str | Path, plan: SeatPlan) -> list[Event]:
    """The events of a file, in the order of their times.

    Parameters
    ----------
    path
        The file.
    plan
        Whose seats places may name.

    Raises
    ------
    AssetError
        If it can't be read, or says something that can't happen; names which event it is.
    """
    try:
        values = tomllib.loads(Path(path).read_bytes().decode("utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise AssetError(path, "", f"can't be read: {error}") from error
    given = values.pop("events", [])
    if values or not isinstance(given, list):
        raise AssetError(path, "", "expected nothing but [[events]]")
    found = []
    for number, fields in enumerate(given, start=1):
        try:
            found.append(_event(fields, plan))
        except (ValueError, TypeError) as error:
            raise AssetError(path, f"event {number}", str(error)) from error
    return sorted(found, key=lambda event: event.time or 0.0)


def _event(given: Any, plan: SeatPlan) -> Event:
    if not isinstance(given, dict):
        raise ValueError("it is no table")
    for key in given:
        if key not in _KEYS:
            raise ValueError(f"unknown key '{key}'; known: {', '.join(_KEYS)}")
    for key in ("time", "kind"):
        if key not in given:
            raise ValueError(f"{key} is missing")
    fields = dict(given)
    side = fields.get("side")
    if isinstance(side, str):
        if side not in _SIDES:
            raise ValueError(f"side is {side!r}, expected 'home', 'away' or a number")
        fields["side"] = _SIDES[side]
    place = fields.get("place")
    if isinstance(place, str):
        middle = plan.position[:, select(plan, [place])].mean(axis=1)
        fields["place"] = tuple(float(v) for v in middle + np.array([0.0, _CHEST, 0.0]))
    elif isinstance(place, list):
        fields["place"] = tuple(place)
    return Event(**fields)

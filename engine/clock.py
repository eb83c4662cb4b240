"""Time in integer ticks.

The base tick is 60 Hz; poses and behaviour advance every second one (30 Hz). Whole ticks are what a
recording holds, so nothing drifts over hours; between two pose ticks drawing gets a fraction.
"""

from __future__ import annotations

import math

BASE_RATE = 60
TICKS_PER_POSE = 2
MAX_CATCH_UP = 4


class Clock:
    """Counts base ticks and turns real time into them.

    Attributes
    ----------
    tick
        Base ticks since the start.
    ahead
        Seconds of the next tick that have passed besides what `due` was told; for pictures between
        the ticks of somebody else's clock.
    """

    __slots__ = ("_remainder", "ahead", "tick")

    def __init__(self) -> None:
        self.tick = 0
        self.ahead = 0.0
        self._remainder = 0.0

    @property
    def remainder(self) -> float:
        """Seconds since the last tick, less than one tick."""
        return self._remainder

    @property
    def pose_tick(self) -> int:
        """Pose ticks since the start."""
        return self.tick // TICKS_PER_POSE

    @property
    def is_pose_tick(self) -> bool:
        """Whether this base tick evaluates poses and behaviour."""
        return self.tick % TICKS_PER_POSE == 0

    @property
    def alpha(self) -> float:
        """Fraction of the current pose tick that has passed, in [0, 1]."""
        ticks = self.tick % TICKS_PER_POSE + min((self._remainder + self.ahead) * BASE_RATE, 1.0)
        return min(ticks / TICKS_PER_POSE, 1.0)

    @property
    def seconds(self) -> float:
        """Simulated seconds since the start."""
        return self.tick / BASE_RATE

    def due(self, delta: float) -> int:
        """How many base ticks `delta` more seconds make due, at most 4.

        What is beyond that is dropped, so that a long pause slows time down instead of freezing the
        program. After 0.05 s three ticks are due; after 10 s, four.

        Raises
        ------
        ValueError
            If `delta` is negative or not finite.
        """
        if not math.isfinite(delta) or delta < 0:
            raise ValueError(f"delta is {delta}, expected seconds >= 0")
        self._remainder += delta
        ticks = math.floor(self._remainder * BASE_RATE + 1e-9)
        if ticks > MAX_CATCH_UP:
            self._remainder = 0.0
            return MAX_CATCH_UP
        self._remainder = max(self._remainder - ticks / BASE_RATE, 0.0)
        return ticks

    def advance(self) -> None:
        """Go to the next base tick."""
        self.tick += 1

"""Pools whose poses tell which time of which clip they show."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType

import pytest

from tifo.engine.animation import ClipBank
from tifo.engine.streams import StreamPool

SlidePool = Callable[..., StreamPool]


@pytest.fixture(scope="session")
def slide_pool(factories: ModuleType) -> SlidePool:
    """Make a pool of one-joint streams that move by 1 in X every pose tick at speed 1.

    Clip k starts at X = 1000 k, so the X of a pose names its clip and its time.
    """

    def make(*, capacity: int = 3, history: int = 60, clips: int = 2) -> StreamPool:
        made = [factories.make_slide(base=1000.0 * k) for k in range(clips)]
        skeleton = made[0][0]
        bank = ClipBank(skeleton, [clip for _, clip in made])
        return StreamPool(skeleton, bank, capacity=capacity, history=history)

    return make

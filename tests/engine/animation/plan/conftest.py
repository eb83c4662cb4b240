"""Random trees, and a pool to evaluate them in."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import pytest
from hypothesis import strategies as st
from trees import make_moves, plain_trees

from tifo.engine.animation import ClipBank
from tifo.engine.animation.controllers import Controller
from tifo.engine.streams import StreamPool


class Stage:
    """A body with moves, pools, and naive evaluations beside them."""

    def __init__(self, factories: ModuleType, naive: ModuleType) -> None:
        self.skeleton = factories.make_body()
        self.clips = make_moves(self.skeleton)
        self.bank = ClipBank(self.skeleton, self.clips)
        self._palettes = factories.reference_palettes
        self._naive = naive

    def pool(self, capacity: int = 4) -> StreamPool:
        return StreamPool(self.skeleton, self.bank, capacity=capacity, history=4)

    def reference(self, controller: Controller, time: float = 0.0) -> Any:
        return self._naive.Reference(controller, self.skeleton, self.clips, time)

    def palettes(self, pose: Any) -> Any:
        return self._palettes(self.skeleton, *pose)


@pytest.fixture(scope="module")
def stage(factories: ModuleType, naive: ModuleType) -> Stage:
    return Stage(factories, naive)


@pytest.fixture(scope="session")
def trees() -> st.SearchStrategy[Controller]:
    """Trees without states of their own."""
    return plain_trees()

"""Simulations of a few hundred box people, and the factories they are made with."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from tifo.engine.crowd.spec import CrowdSpec
from tifo.systems.simulation import Simulation

MakeSimulation = Callable[..., Simulation]


@pytest.fixture(scope="session")
def factories() -> ModuleType:
    """The functions of ``tests/factories/characters.py``."""
    path = Path(__file__).resolve().parents[1] / "factories" / "characters.py"
    spec = importlib.util.spec_from_file_location("tifo_test_characters", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def simulate(factories: ModuleType) -> Iterator[MakeSimulation]:
    """Make small simulations that are closed after the test; fields of the spec may be given."""
    made: list[Simulation] = []

    def make(*, offsets: Any = None, **fields: Any) -> Simulation:
        small = {"layout": "stand", "rows": 15, "columns": 20, "streams": 24, "history": 30}
        spec = CrowdSpec(**{**small, **fields})
        simulation = Simulation(spec, factories.make_character(), offsets=offsets)
        made.append(simulation)
        return simulation

    yield make
    for simulation in made:
        simulation.close()

"""The factories of small characters, for all tests of the engine."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest


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

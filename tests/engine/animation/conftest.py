"""The naive evaluator of controllers, for the tests of nodes and plan."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest


@pytest.fixture(scope="session")
def naive() -> ModuleType:
    """The functions and classes of ``tests/factories/controllers.py``."""
    path = Path(__file__).resolve().parents[2] / "factories" / "controllers.py"
    spec = importlib.util.spec_from_file_location("tifo_test_controllers", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module

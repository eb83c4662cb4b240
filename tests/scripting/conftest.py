"""A tree for every test, and the errors that it reports."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tifo import SceneTree, ScriptError, set_resource_root
from tifo.scripting import resources


@pytest.fixture
def errors() -> list[ScriptError]:
    """What the tree reported; a test that expects nothing must find it empty."""
    return []


@pytest.fixture
def tree(errors: list[ScriptError]) -> Iterator[SceneTree]:
    """A tree without a scene."""
    made = SceneTree(report=errors.append)
    yield made
    if not made._advancing:
        made.close()


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[Path]:
    """An empty folder that is ``res://`` during the test."""
    before = resources._store.root
    set_resource_root(tmp_path)
    yield tmp_path
    resources._store.root = before
    resources._store.loaded.clear()

"""A small stadium in a tree."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from tifo import SceneTree, ScriptError, Stadium, nodes


@pytest.fixture
def errors() -> list[ScriptError]:
    """What the tree reported."""
    return []


@pytest.fixture
def tree(errors: list[ScriptError]) -> Iterator[SceneTree]:
    """A tree without a scene."""
    made = SceneTree(report=errors.append)
    yield made
    made.close()


@pytest.fixture
def stadium(tree: SceneTree) -> Stadium:
    """A stand of 6 x 15 seats with a crowd, in the tree."""
    exports: dict[str, Any] = {"streams": 24, "history": 16, "seed": 3, "away_share": 0.4}
    made = Stadium(name="Stadium", layout="stand", rows=6, columns=15, **exports)
    made.add_child(nodes.Crowd(name="Crowd"))
    tree.root.add_child(made)
    return made


@pytest.fixture
def crowd(stadium: Stadium) -> nodes.Crowd:
    """The crowd's node."""
    return stadium.get_node("Crowd", nodes.Crowd)

"""Nodes that outlive scenes, by name."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .node import Node


class Autoloads:
    """The autoloaded nodes as attributes: ``tree.autoloads.scores``."""

    def __init__(self) -> None:
        self._nodes: dict[str, Node] = {}

    def __getattr__(self, name: str) -> Any:
        """The node of that name."""
        try:
            return self.__dict__["_nodes"][name]
        except KeyError:
            known = ", ".join(self.__dict__.get("_nodes", ())) or "there are none"
            raise AttributeError(f"no autoload '{name}'; known: {known}") from None

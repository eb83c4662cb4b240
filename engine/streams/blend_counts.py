"""Which rungs of the blend ladder were used: how a full pool shows, since it raises no error."""

from __future__ import annotations

from dataclasses import dataclass, field, fields


@dataclass(slots=True)
class BlendCounts:
    """How many changes of motion took each rung.

    Attributes
    ----------
    two_source
        Began from a motion.
    snapshot
        Began from a slot: in the middle of a blend, or because a stream was cut.
    deferred
        Had to wait for the end of a blend; counted once, and again by the rung they end on.
    cut
        Jumped.
    """

    two_source: int = 0
    snapshot: int = 0
    deferred: int = 0
    cut: int = 0

    def add(self, other: BlendCounts) -> None:
        """Add the counts of another."""
        for column in fields(self):
            name = column.name
            setattr(self, name, getattr(self, name) + getattr(other, name))


@dataclass(slots=True)
class LadderCounts:
    """Counts since the last pose tick began, and of all time."""

    tick: BlendCounts = field(default_factory=BlendCounts)
    total: BlendCounts = field(default_factory=BlendCounts)

"""Another behaviour table for a crowd that runs: whoever is in a state stays in it."""

from __future__ import annotations

import esper

from ..engine.behaviour.compiled import CompiledTable, compile_table
from ..engine.behaviour.table import BehaviourTable
from .crowd import Crowd


def exchange_table(crowd: Crowd, table: BehaviourTable) -> bool:
    """Let a crowd run on `table` from the next tick on, if that has the states of its old one.

    Rules, efforts, looks, stays and responses may differ. Motions are those that the crowd has.

    Parameters
    ----------
    crowd
        In the current world.
    table
        What it is to run on.

    Returns
    -------
    bool
        False if the states, what they can look like or the channels' values are others, so that
        what the crowd knows of its states means nothing in `table`; nothing happens then.

    Raises
    ------
    ValueError
        If the table can't be used.
    """
    old, new = crowd.table, compile_table(table, crowd.library)
    if _numbers(old) != _numbers(new):
        return False
    crowd.table = new
    esper.add_component(crowd.entity, new)
    return True


def _numbers(table: CompiledTable) -> tuple[object, ...]:
    """What the columns of a crowd hold numbers of."""
    variants = [look.variant.tolist() for look in table.looks]
    channels = (table.arms_names, table.head_names)
    return (table.names, table.machine.tolist(), table.starts, channels, variants)

"""State machines and the blends between their states, many machines at once.

In a tick a machine first lets its running blend go on, then takes at most one transition, then
weighs its states. With f the curve of the blend's progress, a state weighs what it weighed when
the blend began, times 1 - f; the current state has f more.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..controllers.machine import CURVES, INTERRUPTIONS, OPERATORS
from ..controllers.program import Kind
from .columns import ranges
from .groups import Group
from .tables import LEAST_WEIGHT, Tables

Ints = NDArray[np.int64]

_SMOOTH = CURVES.index("smooth")
_ANY, _PRIORITY = INTERRUPTIONS.index("any"), INTERRUPTIONS.index("priority")
_DONE = 1e-9
"""Seconds that a blend may be short of its end and count as done."""


def step_machines(tables: Tables, group: Group) -> None:
    """Advance the active machines of a group and weigh their states."""
    columns = tables.nodes
    nodes = group.nodes[columns["active"][group.nodes]]
    if not len(nodes):
        return
    seconds = np.abs(columns["delta"][nodes])
    columns["time"][nodes] += seconds
    columns["fade"][nodes] += seconds
    done = columns["fade"][nodes] >= columns["fade_time"][nodes] - _DONE
    columns["source"][nodes[done]] = -1
    arrived = columns["goal"][nodes] == columns["state"][nodes]
    columns["goal"][nodes[arrived]] = -1
    _jump(tables, nodes)
    taken, transition = _choose(tables, nodes)
    if len(taken):
        _begin(tables, taken, transition)
    _weigh(tables, nodes)


def _next_hop(tables: Tables, nodes: Ints) -> Ints:
    """State that a travelling machine goes to next; -1 if there is no way."""
    columns = tables.nodes
    states = columns["child_count"][nodes]
    place = columns["state"][nodes] * states + columns["goal"][nodes]
    hop: Ints = tables.constants["hops"]["state"][columns["second"][nodes] + place]
    return hop


def _jump(tables: Tables, nodes: Ints) -> None:
    """Put machines that travel where no transition leads straight into their goal."""
    columns = tables.nodes
    travelling = nodes[columns["goal"][nodes] >= 0]
    lost = travelling[_next_hop(tables, travelling) < 0]
    if len(lost):
        goal = columns["goal"][lost]
        columns["goal"][lost] = -1
        _enter(tables, lost, goal)
        columns["source"][lost] = -1


def _choose(tables: Tables, nodes: Ints) -> tuple[Ints, Ints]:
    """Machines that take a transition now, and which."""
    columns, table = tables.nodes, tables.constants["transitions"]
    entry, owner = ranges(columns["constant"][nodes], columns["constant_count"][nodes])
    machine = nodes[owner]
    state = columns["state"][machine]
    target = table["target"][entry]
    source = table["source"][entry]
    able = (source == state) | ((source < 0) & (target != state))
    fading = columns["source"][machine] >= 0
    goal = columns["goal"][machine]
    travelling = goal >= 0
    rule = columns["rule"][machine]
    urgent = table["priority"][entry] < columns["priority"][machine]
    interrupts = (rule == _ANY) | ((rule == _PRIORITY) & urgent)
    able &= ~fading | (interrupts & ~travelling)
    if travelling.any():
        hop = np.full(len(entry), -1)
        hop[travelling] = _next_hop(tables, machine[travelling])
        able &= np.where(travelling, target == hop, True)
    values, first = tables.values["value"], columns["parameter"][machine]
    trigger, condition = table["trigger"][entry], table["condition"][entry]
    # A machine without parameters may begin where the values end.
    pulled = (trigger < 0) | (values.take(first + trigger, mode="clip") != 0)
    value = values.take(first + condition, mode="clip")
    held = (condition < 0) | _compare(value, table["operator"][entry], table["threshold"][entry])
    able &= travelling | (table["automatic"][entry] & pulled & held)
    waits = np.flatnonzero(able & table["at_end"][entry])
    if len(waits):
        clips, _ = tables.leading_clips(tables.child(machine[waits], state[waits]))
        able[waits] = np.where(clips >= 0, columns["ended"][np.maximum(clips, 0)], False)
    chosen = np.flatnonzero(able)
    _, one = np.unique(owner[chosen], return_index=True)
    return machine[chosen[one]], entry[chosen[one]]


def _compare(
    value: NDArray[np.float64], operator: Ints, threshold: NDArray[np.float64]
) -> NDArray[np.bool_]:
    results = {
        "!=": value != threshold,
        "==": value == threshold,
        ">": value > threshold,
        "<": value < threshold,
        ">=": value >= threshold,
        "<=": value <= threshold,
    }
    return np.choose(operator, [results[name] for name in OPERATORS]).astype(np.bool_)


def _begin(tables: Tables, nodes: Ints, transition: Ints) -> None:
    """Take a transition in each machine."""
    columns, table = tables.nodes, tables.constants["transitions"]
    before = columns["state"][nodes]
    target = table["target"][transition]
    trigger = table["trigger"][transition]
    used = trigger >= 0
    tables.values["value"][columns["parameter"][nodes[used]] + trigger[used]] = 0.0
    synced = np.flatnonzero(table["sync"][transition])
    leading, _ = tables.leading_clips(tables.child(nodes[synced], before[synced]))
    synced, leading = synced[leading >= 0], leading[leading >= 0]
    phase = clip_phases(tables, leading)
    anew = _enter(tables, nodes, target)
    which = anew[synced]
    _synchronise(tables, nodes[synced[which]], phase[which])
    duration = table["duration"][transition]
    columns["source"][nodes] = np.where((duration > 0) & (before != target), before, -1)
    columns["fade"][nodes] = 0.0
    columns["fade_time"][nodes] = duration
    for name in ("curve", "rule", "priority"):
        columns[name][nodes] = table[name][transition]


def _enter(tables: Tables, nodes: Ints, target: Ints) -> NDArray[np.bool_]:
    """Make `target` the current state of each machine; which of them start it anew."""
    columns = tables.nodes
    entry, _ = ranges(columns["child_start"][nodes], columns["child_count"][nodes])
    children = tables.children["node"][entry]
    columns["from_weight"][children] = columns["weight"][children]
    child = tables.child(nodes, target)
    again = columns["state"][nodes] == target
    anew: NDArray[np.bool_] = again | (columns["weight"][child] <= LEAST_WEIGHT)
    columns["state"][nodes] = target
    columns["time"][nodes] = 0.0
    weight = columns["weight"][child]
    tables.restart(tables.subtrees(child[anew])[0])
    columns["weight"][child] = weight
    return anew


def enter_state(tables: Tables, nodes: Ints, target: Ints) -> None:
    """Put machines into states at once: they start anew, and nothing blends or is travelled to."""
    columns = tables.nodes
    columns["goal"][nodes] = columns["source"][nodes] = -1
    columns["state"][nodes] = target
    columns["time"][nodes] = 0.0
    tables.restart(tables.subtrees(tables.child(nodes, target))[0])


def _synchronise(tables: Tables, nodes: Ints, phase: NDArray[np.float64]) -> None:
    """Put all clips of the machines' current states to some phases."""
    columns = tables.nodes
    below, owner = tables.subtrees(tables.child(nodes, columns["state"][nodes]))
    clips = columns["kind"][below] == Kind.CLIP
    below, owner = below[clips], owner[clips]
    columns["time"][below] = phase[owner] * tables.bank.duration[columns["clip"][below]]


def clip_phases(tables: Tables, clips: Ints) -> NDArray[np.float64]:
    """Times of clip nodes as shares of their durations, 0 to 1; 0 for a clip of no duration.

    A node that was just put somewhere may stand beyond an end: loops are wrapped, others held.
    """
    duration = tables.bank.duration[tables.nodes["clip"][clips]]
    share = tables.nodes["time"][clips] / np.where(duration > 0, duration, 1.0)
    inside = np.where(tables.nodes["looping"][clips], share % 1.0, np.clip(share, 0.0, 1.0))
    return np.where(duration > 0, inside, 0.0)


def _weigh(tables: Tables, nodes: Ints) -> None:
    columns = tables.nodes
    fading = columns["source"][nodes] >= 0
    whole = np.where(fading, columns["fade_time"][nodes], 1.0)
    progress = np.where(fading, columns["fade"][nodes] / whole, 1.0)
    smooth = progress * progress * (3.0 - 2.0 * progress)
    share = np.where(columns["curve"][nodes] == _SMOOTH, smooth, progress)
    entry, owner = ranges(columns["child_start"][nodes], columns["child_count"][nodes])
    children = tables.children["node"][entry]
    rest = 1.0 - share[owner]
    columns["weight"][children] = np.where(rest > 0, columns["from_weight"][children] * rest, 0.0)
    columns["weight"][tables.child(nodes, columns["state"][nodes])] += share

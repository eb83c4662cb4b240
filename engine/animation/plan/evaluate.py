"""The way up: nodes make their poses from their children's, a batch for each kind and level."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from ..controllers.program import Kind
from .columns import ranges
from .customs import Customs
from .groups import Group
from .mixing import PoseMixer
from .tables import Tables

Ints = NDArray[np.int64]

_END = 1e-9
"""Seconds that a clip may be short of its end and count as ended."""


class Work(IntEnum):
    """What a node's pose is made by, in the order in which a level does them."""

    SAMPLE = 0
    MIX = 1
    MASK = 2
    ADD = 3
    CUSTOM = 4


WORK_OF = np.full(len(Kind), Work.MIX, np.int64)
"""The work of each kind of node; whatever only weighs its children mixes them."""
WORK_OF[[Kind.CLIP, Kind.MASKED, Kind.ADDITIVE, Kind.CUSTOM]] = (
    Work.SAMPLE,
    Work.MASK,
    Work.ADD,
    Work.CUSTOM,
)


def advance_clips(tables: Tables, group: Group) -> None:
    """Let the active clips play; a looping one's time stays within one period."""
    columns = tables.nodes
    nodes = group.nodes[columns["active"][group.nodes]]
    speed = tables.values["value"][columns["parameter"][nodes]]
    step = columns["delta"][nodes] * speed
    duration = tables.bank.duration[columns["clip"][nodes]]
    looping = columns["looping"][nodes] & (duration > 0)
    time = columns["time"][nodes] + step
    past = time >= duration - np.where(looping, 0.0, _END)
    before = time < np.where(looping, 0.0, _END)
    # Standing at the beginning is no end, unless the clip plays backwards into it.
    columns["ended"][nodes] = np.where(
        looping, past | before, (past & (step >= 0)) | (before & (step < 0)) | (duration == 0)
    )
    wrapped = np.mod(time, np.where(looping, duration, 1.0))
    columns["time"][nodes] = np.where(looping, wrapped, np.clip(time, 0.0, duration))


def _sample(tables: Tables, mixer: PoseMixer, group: Group, customs: Customs) -> None:
    columns = tables.nodes
    nodes = group.nodes[columns["active"][group.nodes]]
    clip, time, looping = (columns[name][nodes] for name in ("clip", "time", "looping"))
    columns["row"][nodes] = mixer.sample(clip, time, looping)


def _mix(tables: Tables, mixer: PoseMixer, group: Group, customs: Customs) -> None:
    columns = tables.nodes
    children, owner = group.children(tables)
    seen = columns["active"][children]
    children, owner = children[seen], owner[seen]
    count = np.bincount(owner, minlength=len(group.nodes))
    first = np.cumsum(count) - count
    weight, row = columns["weight"][children], columns["row"]
    one = count == 1
    row[group.nodes[one]] = row[children[first[one]]]
    two = np.flatnonzero(count == 2)
    if len(two):
        a, b = first[two], first[two] + 1
        amount = (weight[b] / (weight[a] + weight[b])).astype(np.float32)
        row[group.nodes[two]] = mixer.blend(row[children[a]], row[children[b]], amount[:, None])
    several = np.flatnonzero(count > 2)
    if len(several):
        several = several[np.argsort(-count[several], kind="stable")]
        entry, of = ranges(first[several], count[several])
        share = weight[entry] / np.bincount(of, weight[entry])[of]
        row[group.nodes[several]] = mixer.mean(
            row[children[entry]], share.astype(np.float32), count[several]
        )


def _mask(tables: Tables, mixer: PoseMixer, group: Group, customs: Customs) -> None:
    columns = tables.nodes
    masks = tables.constants["masks"]["weights"]
    nodes = group.nodes[columns["active"][group.nodes]]
    columns["row"][nodes] = columns["row"][tables.child(nodes, 0)]
    overlays = columns["child_count"][nodes] - 1
    for layer in range(int(overlays.max(initial=0))):
        having = nodes[overlays > layer]
        over = tables.child(having, layer + 1)
        seen = columns["active"][over]
        having, over = having[seen], over[seen]
        if len(having):
            amount = columns["weight"][over, None] * masks[columns["constant"][having] + layer]
            columns["row"][having] = mixer.blend(
                columns["row"][having], columns["row"][over], amount.astype(np.float32)
            )


def _add(tables: Tables, mixer: PoseMixer, group: Group, customs: Customs) -> None:
    columns = tables.nodes
    nodes = group.nodes[columns["active"][group.nodes]]
    base, added = tables.child(nodes, 0), tables.child(nodes, 1)
    columns["row"][nodes] = columns["row"][base]
    seen = columns["active"][added]
    nodes, base, added = nodes[seen], base[seen], added[seen]
    if len(nodes):
        columns["row"][nodes] = mixer.add(
            columns["row"][base],
            columns["row"][added],
            tables.constants["references"]["pose"][columns["constant"][nodes]],
            columns["weight"][added, None].astype(np.float32),
        )


def _custom(tables: Tables, mixer: PoseMixer, group: Group, customs: Customs) -> None:
    customs.evaluate(tables, mixer, group)


MAKE: Mapping[int, Callable[[Tables, PoseMixer, Group, Customs], None]] = {
    Work.SAMPLE: _sample,
    Work.MIX: _mix,
    Work.MASK: _mask,
    Work.ADD: _add,
    Work.CUSTOM: _custom,
}
"""How each kind of work is done for the active nodes of a group."""

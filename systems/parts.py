"""Parts of a crowd: what hangs on its agents, each with its own meshes, streams and offsets.

*Techniques 2022*, 4.2. A part is an entity. With a pool of its own it has the components of a crowd
(streams, blends, offsets), so the systems of a tick evaluate, blend and commit it without knowing
what it is; a part that plays its crowd's streams has everything but the pool.
"""

from __future__ import annotations

from dataclasses import fields
from typing import Any, Literal, get_args
from zlib import crc32

import esper
import numpy as np
from numpy.typing import ArrayLike

from ..components import (
    MOST_PARTS,
    AgentAnimID,
    Appearance,
    Attachment,
    Detail,
    Dilation,
    PartBits,
    Transition,
)
from ..engine.animation.clip import rest_clip
from ..engine.animation.clip_bank import ClipBank
from ..engine.assets.character import Character
from ..engine.crowd.agents import agent_ids
from ..engine.crowd.hooks import as_affine, check_same_skeleton, hook_place
from ..engine.streams.ladder import BlendLadder
from ..engine.streams.offsets import initial_offsets
from ..engine.streams.pool import StreamPool
from ..engine.streams.slots import SlotPool
from ..engine.streams.uniques import UniquePool
from .crowd import Crowd
from .crowd_overlays import unstreamed
from .part import Part

PartMotion = Literal["own", "crowd", "body"]
"""Whose poses a part shows: of a pool of its own; of its crowd's pool, each agent at a place of its
own; or exactly the body's."""


def add_part(
    crowd: Crowd,
    name: str,
    character: Character,
    *,
    tick: int,
    hook: str | None = None,
    transform: ArrayLike | None = None,
    motion: PartMotion = "own",
    streams: int = 8,
    history: int = 60,
    slots: int = 64,
    uniques: int = 0,
    agents: int | ArrayLike | None = None,
    appearance: Appearance | None = None,
) -> Part:
    """Hang something on agents of a crowd of the current esper world.

    Parameters
    ----------
    crowd, name
        The crowd, and what it shall know the part by.
    character
        Meshes, their coarser levels, materials, skeleton and clips of the part. Materials called
        ``shirt``, ``skin``, ... take the agent's colours. Without clips it keeps its rest pose.
    tick
        The world's last pose tick.
    hook
        Joint of the crowd's skeleton whose frame the part moves with, blends included; None is the
        agent's own frame, between its feet.
    transform
        (4, 4) or (3, 4) from the part's model space to the joint's frame; identity if None.
    motion
        ``"own"``: the part has a pool of its own. ``"crowd"``: it has the crowd's skeleton and
        plays the crowd's streams, beginning with what the bodies play. ``"body"``: it has the
        crowd's skeleton and shows what the body shows; it takes no hook.
    streams, history, slots, uniques
        Size of a pool of its own; its streams are shared out among the clips, and agents begin on
        those of the first clip.
    agents
        Who has the part at first: an id, ids, or a mask; everybody if None.
    appearance
        Colours of the part; the agents' own if None.

    Raises
    ------
    ValueError
        For a name that is taken, more than 32 parts, an unknown joint, a transform that can't be
        used, a skeleton that doesn't fit, or values out of range. The crowd is as before then.
    """
    _check_part(crowd, name, character, motion, hook, transform, appearance)
    count = len(crowd)
    ids = np.arange(count) if agents is None else agent_ids(agents, count)
    joint, place = hook_place(crowd.character.skeleton, hook, transform)
    components: list[Any] = [Detail(), character]
    if appearance is not None:
        components.append(appearance)
    ladder: BlendLadder | None = None
    if motion == "own":
        rng = np.random.default_rng([crowd.spec.seed, crc32(name.encode())])
        ladder = _own_streams(crowd, character, streams, history, slots, uniques, tick, rng)
        components += [ladder.pool, ladder.uniques, ladder.slots]
    elif motion == "crowd":
        ladder = _crowd_streams(crowd)
    dilation = None if ladder is None else Dilation()
    if ladder is not None:
        components += [ladder, ladder.anim, ladder.transition, dilation]
    bits = esper.try_component(crowd.entity, PartBits)
    if bits is None:
        bits = PartBits(np.zeros(count, np.uint32))
        esper.add_component(crowd.entity, bits)
    taken = {part.attachment.bit for part in crowd.parts.values()}
    bit = next(bit for bit in range(MOST_PARTS) if bit not in taken)
    attachment = Attachment(name, crowd.entity, bit, joint, place, motion == "body")
    entity = esper.create_entity(attachment, *components)
    part = Part(crowd, entity, character, attachment, bits, ladder, dilation)
    crowd.parts[name] = part
    part.attach(ids)
    part.detach(np.zeros(0, np.int64))
    return part


def remove_part(crowd: Crowd, name: str) -> None:
    """Remove a part from its crowd and from the current esper world.

    Raises
    ------
    ValueError
        If the crowd has no such part.
    """
    part = crowd.parts.get(name)
    if part is None:
        known = ", ".join(sorted(crowd.parts)) or "none"
        raise ValueError(f"name: the crowd has no part '{name}'; it has: {known}")
    part.bits.bits &= ~np.uint32(1 << part.attachment.bit)
    ladder = part.ladder
    if ladder is not None and ladder.pool is crowd.pool:
        ladder.close()
    del crowd.parts[name]
    esper.delete_entity(part.entity, immediate=True)


def _check_part(
    crowd: Crowd,
    name: str,
    character: Character,
    motion: str,
    hook: str | None,
    transform: ArrayLike | None,
    appearance: Appearance | None,
) -> None:
    if not isinstance(name, str) or not name:
        raise ValueError(f"name is {name!r}, expected some text")
    if name in crowd.parts:
        raise ValueError(f"name: the crowd has a part '{name}' already")
    if len(crowd.parts) >= MOST_PARTS:
        raise ValueError(f"the crowd has {MOST_PARTS} parts, which is as many as it can have")
    if motion not in get_args(PartMotion):
        allowed = ", ".join(f"'{choice}'" for choice in get_args(PartMotion))
        raise ValueError(f"motion is {motion!r}, expected one of {allowed}")
    if not character.meshes:
        raise ValueError(f"character '{character.name}' has no meshes, so nobody would see it")
    as_affine(transform)
    if motion == "body" and (hook is not None or transform is not None):
        raise ValueError("hook and transform: a part with motion='body' moves with the body itself")
    if motion != "own":
        check_same_skeleton(character.skeleton, crowd.character.skeleton)
    if motion == "crowd" and crowd.pool is None:
        raise ValueError(
            f"motion is 'crowd', and this crowd {unstreamed(crowd.spec)} and has no streams; "
            "expected 'own' or 'body'"
        )
    if appearance is not None:
        for column in fields(appearance):
            colours = getattr(appearance, column.name)
            expected = (len(crowd),) if column.name == "pattern" else (len(crowd), 4)
            if isinstance(colours, np.ndarray) and colours.shape != expected:
                raise ValueError(
                    f"appearance: {column.name} has shape {colours.shape}, expected {expected}"
                )


def _own_streams(
    crowd: Crowd,
    character: Character,
    streams: int,
    history: int,
    slots: int,
    uniques: int,
    tick: int,
    rng: np.random.Generator,
) -> BlendLadder:
    if not 1 <= streams <= 256:
        raise ValueError(f"streams is {streams}, expected 1 to 256")
    bank = ClipBank(character.skeleton, character.clips or (rest_clip(character.skeleton),))
    pool = StreamPool(
        character.skeleton, bank, capacity=streams, history=history, uniques=uniques, slots=slots
    )
    for row in range(streams):
        clip = row % len(bank.clips)
        time = rng.uniform(0.0, float(bank.duration[clip]))
        pool.add(clip, time=time, speed=rng.uniform(0.92, 1.08))
    # The part is found in the middle of things, so its streams have a past.
    for past in range(tick + 1 - history, tick + 1):
        pool.evaluate(past)
        pool.commit(past)
    for still in np.flatnonzero(bank.duration[pool.clip] == 0):
        pool.stop(pool.stream(int(still)))  # A pose that never changes needs no more evaluating.
    count = len(crowd)
    anim = AgentAnimID.allocate(1, count, 0)
    first = np.arange(0, streams, len(bank.clips), dtype=np.int32)
    anim.row[0] = rng.choice(first, count)
    anim.start[0] = anim.target[0] = initial_offsets("uniform", count, history, rng)
    anim.t0[0] = tick
    transition = Transition.allocate(1, count)
    slot_pool = SlotPool(pool.store)
    return BlendLadder(pool, UniquePool(pool), slot_pool, anim, transition, crowd.placement)


def _crowd_streams(crowd: Crowd) -> BlendLadder:
    """A place of its own for each agent in the crowd's streams: at first, where its body is."""
    body, bodies = crowd.ladder, crowd.anim
    assert body is not None
    assert bodies is not None
    anim = AgentAnimID.allocate(1, len(crowd), 0)
    for column in ("row", "start", "target", "t0", "rate"):
        getattr(anim, column)[0] = getattr(bodies, column)[0]
    transition = Transition.allocate(1, len(crowd))
    return BlendLadder(
        body.pool, body.uniques, body.slots, anim, transition, crowd.placement, body.kind
    )

"""From states, scripts and orders to the one motion that a body shows.

Priority (*Thesis* 2.2.1): guided control, then what events demand, then scripts of groups, then
what people do by themselves. Channels that nobody claims go on as they were.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components.behaviour import Behaviour
from .compiled import CompiledTable
from .guidance import ARMS, BODY, HEAD, POSTURE, Guidance, Priority
from .looks import KEEP
from .table import SEATED


def motions_to_show(
    compiled: CompiledTable,
    behaviour: Behaviour,
    guidance: Guidance,
    agents: NDArray[np.int64],
    wanted: NDArray[np.int16],
) -> NDArray[np.int16]:
    """Motions for agents that may look different now.

    Parameters
    ----------
    compiled, behaviour, guidance
        The table, the states, and the orders.
    agents
        (K,) ids.
    wanted
        (N,) int16 motions wanted so far; kept where nobody says anything.

    Returns
    -------
    (K,) int16
    """
    b = behaviour
    motion = np.where(b.motion[0, agents] == KEEP, wanted[agents], b.motion[0, agents])
    sits = b.posture[agents] == SEATED
    turns = compiled.takes_any_posture[b.state[0, agents]] & (compiled.seated[motion] != sits)
    motion = np.where(turns, compiled.other_form[motion], motion)
    at_rest = (b.arms[agents] == 0) & ~compiled.takes_any_posture[b.state[0, agents]]
    head_machine = compiled.machine_number("head")
    if head_machine > 0:
        head = b.motion[head_machine, agents]
        head = np.where(compiled.seated[head] == sits, head, compiled.other_form[head])
        fits = at_rest & (b.motion[head_machine, agents] != KEEP) & (compiled.seated[head] == sits)
        motion = np.where(fits, head, motion)
    told = guidance.demanded(agents)
    if told.any():
        k = np.flatnonzero(told)
        motion[k] = _obey(compiled, b, guidance, agents[k], motion[k], at_rest[k])
    result: NDArray[np.int16] = motion.astype(np.int16)
    return result


def channel_values(
    compiled: CompiledTable, behaviour: Behaviour, guidance: Guidance, agents: NDArray[np.int64]
) -> tuple[NDArray[np.int8], NDArray[np.int8], NDArray[np.int8]]:
    """(K,) posture, arms and head that agents show, orders included; -1 where it has no name."""
    b = behaviour
    shown = [b.posture[agents], b.arms[agents], b.head[agents]]
    state = b.state[0, agents].astype(np.int64)
    for priority in Priority:
        heard = _heard(b, agents, priority)
        banned = heard & _is_banned(guidance, priority, agents, state)
        shown[1] = np.where(banned, 0, shown[1])
        whole = heard & (guidance.motion[priority, BODY, agents] != KEEP)
        shown[1] = np.where(whole, guidance.value[priority, BODY, agents], shown[1])
        for k, channel in enumerate((POSTURE, ARMS, HEAD)):
            value = guidance.value[priority, channel, agents]
            shown[k] = np.where(heard & (value >= 0), value, shown[k])
    posture, arms, head = (column.astype(np.int8) for column in shown)
    return posture, arms, head


def _heard(
    behaviour: Behaviour, agents: NDArray[np.int64], priority: Priority
) -> NDArray[np.bool_]:
    """Whose orders of a priority count now: events drown scripts."""
    if priority is Priority.SCRIPTED:
        return ~behaviour.reacting[agents]
    return np.ones(len(agents), np.bool_)


def _is_banned(
    guidance: Guidance, priority: Priority, agents: NDArray[np.int64], state: NDArray[np.int64]
) -> NDArray[np.bool_]:
    banned: NDArray[np.bool_] = (guidance.forbidden[priority, agents] >> state) & 1 == 1
    return banned


def _obey(
    compiled: CompiledTable,
    b: Behaviour,
    guidance: Guidance,
    agents: NDArray[np.int64],
    motion: NDArray[np.int16],
    at_rest: NDArray[np.bool_],
) -> NDArray[np.int16]:
    """What agents with orders show."""
    posture = b.posture[agents].astype(np.int64)
    state = b.state[0, agents].astype(np.int64)
    ahead = b.ahead[0, agents].astype(np.int64)
    # A seat's neighbours don't rest in the same way, and an agent always does in its own.
    calm = np.stack([which[agents % len(which)] for which in compiled.calm])
    everyone = np.arange(len(agents))
    for priority in Priority:
        heard = _heard(b, agents, priority)
        banned = heard & (
            _is_banned(guidance, priority, agents, state)
            | ((ahead >= 0) & _is_banned(guidance, priority, agents, np.maximum(ahead, 0)))
        )
        motion = np.where(banned, calm[posture, everyone], motion)
        at_rest = at_rest | banned
        wish = guidance.value[priority, POSTURE, agents].astype(np.int64)
        moves = heard & (wish >= 0)
        posture = np.where(moves, wish, posture)
        wrong = moves & (compiled.seated[motion] != (wish == SEATED))
        motion = np.where(wrong, calm[posture, everyone], motion)
        rests = heard & (guidance.value[priority, ARMS, agents] == 0)
        motion = np.where(rests & ~at_rest, calm[posture, everyone], motion)
        at_rest = at_rest | rests
        turned = guidance.motion[priority, HEAD, agents]
        fits = heard & at_rest & (turned != KEEP)
        fits &= compiled.seated[turned] == (posture == SEATED)
        motion = np.where(fits, turned, motion)
        for channel in (BODY, ARMS):
            demanded = guidance.motion[priority, channel, agents]
            given = heard & (demanded != KEEP)
            motion = np.where(given, demanded, motion)
            at_rest = at_rest & ~given
    result: NDArray[np.int16] = motion.astype(np.int16)
    return result

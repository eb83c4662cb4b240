"""A behaviour table as arrays, with the motions of one character cast for its variants."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..crowd.motions import MotionLibrary, Role
from ..streams.pool import POSE_RATE
from .choices import Choices
from .clip_names import is_seated, matching, other_form
from .events import KINDS
from .looks import KEEP, Look, Looks
from .table import PIECE, POSTURES, RELATIONS, BehaviourTable, Response, Rule, State, Variant

WAKING = frozenset(
    {"clapping_wanted", "wave_wanted", "spoken_to", "leader_stands", "player_near"}
    | {"hug_first", "hug_second"}
)
"""Signals whose changes wake agents (`company`, `hugs`), so that nobody has to look for them."""
_REST = "rest"
"""The value of the arms channel, and the first of each list, that means nothing special."""


@dataclass(frozen=True, slots=True, eq=False)
class CompiledRule:
    """One rule with numbers for names.

    `pairs` says for each kind and relation whether such an event opens it; None needs no event.
    `blend` is in pose ticks.
    """

    target: int
    effort: float
    pairs: NDArray[np.bool_] | None
    calm: bool
    pieces: tuple[int, int]
    rapid: bool
    blend: float
    limits: tuple[tuple[str, float, float], ...]
    signals: tuple[tuple[str, bool], ...]


@dataclass(frozen=True, slots=True, eq=False)
class CompiledTable:
    """A table that a crowd runs on; S states.

    Parameters
    ----------
    table
        As written.
    names, machine, starts
        Names of the states, the machine of each, and the first state of each machine.
    rules, choices
        By state the ways out, and what takes one of them.
    looks
        By state: how it can look.
    pieces
        (S, 2) least and most pieces of a stay.
    limit, leave_to
        (S,) pose ticks after which a state must be left, and where to.
    posture, arms, head
        (S,) int8 values of the channels, -1 where a state leaves one as it is.
    arms_names, head_names
        What those values mean; postures are `POSTURES`.
    is_bridge
        (S,) bool: it has no motion of its own, lasts one piece, and shows what comes next.
    wakes, wakes_rapidly
        (S, kinds, relations) bool: some rule is there for such an event; a rapid one.
    sleeps
        (S, kinds, relations) bool: no rule leads away while such an event moves an agent.
    seated
        (K,) bool of the library's motions.
    other_form
        (K,) int16 the same motion in the other posture, or itself.
    takes_any_posture
        (S,) bool: a state is shown in the posture that the agent has.
    calm
        For each posture the motions of someone at rest.
    responses
        By kind and relation numbers.
    notes
        What stands in for clips that the character doesn't have.
    """

    table: BehaviourTable
    names: tuple[str, ...]
    machine: NDArray[np.int8]
    starts: tuple[int, ...]
    rules: tuple[tuple[CompiledRule, ...], ...]
    choices: Choices
    looks: Looks
    pieces: NDArray[np.int32]
    limit: NDArray[np.int32]
    leave_to: NDArray[np.int16]
    posture: NDArray[np.int8]
    arms: NDArray[np.int8]
    head: NDArray[np.int8]
    arms_names: tuple[str, ...]
    head_names: tuple[str, ...]
    is_bridge: NDArray[np.bool_]
    wakes: NDArray[np.bool_]
    wakes_rapidly: NDArray[np.bool_]
    sleeps: NDArray[np.bool_]
    seated: NDArray[np.bool_]
    other_form: NDArray[np.int16]
    takes_any_posture: NDArray[np.bool_]
    calm: tuple[NDArray[np.int16], NDArray[np.int16]]
    responses: dict[tuple[int, int], Response]
    notes: tuple[str, ...]

    def machine_number(self, name: str) -> int:
        """Index of a machine; -1 if the table hasn't got it."""
        machines = self.table.machines
        return machines.index(name) if name in machines else -1

    def number(self, name: str) -> int:
        """Index of a state; ValueError if there is none of that name."""
        self.table.state(name)
        return self.names.index(name)


def compile_table(table: BehaviourTable, library: MotionLibrary) -> CompiledTable:
    """Turn a table into arrays and cast its variants with a library's motions.

    Raises
    ------
    ValueError
        If the table can't be used; `BehaviourTable.problem` says why.
    """
    problem = table.problem()
    if problem:
        raise ValueError(f"table '{table.name}': {problem[1]}")
    states = table.states
    names = tuple(state.name for state in states)
    index = {name: k for k, name in enumerate(names)}
    seated = np.array([is_seated(name) for name in library.names], np.bool_)
    notes: list[str] = []
    looks = tuple(_cast(state, library, seated, notes) for state in states)
    rules = tuple(
        tuple(_compile(rule, index) for rule in table.rules if rule.origin == name)
        for name in names
    )
    wakes = np.zeros((len(states), len(KINDS), len(RELATIONS)), np.bool_)
    rapid, awake = wakes.copy(), wakes.copy()
    for k, out in enumerate(rules):
        for rule in out:
            if rule.target == k:
                continue
            if rule.pairs is None:
                awake[k] |= not (rule.calm or any(name in WAKING for name, _ in rule.signals))
                continue
            pairs = rule.pairs
            awake[k] |= pairs
            wakes[k] |= pairs
            if rule.rapid:
                rapid[k] |= pairs
    arms = _values([state.arms for state in states], _REST)
    head = _values([state.head for state in states], "ahead")
    leave = [
        state.leave_to
        or next(
            rule.target
            for rule in reversed(table.rules)
            if rule.origin == state.name and rule.target != state.name
        )
        for state in states
    ]
    is_bridge = np.array(
        [
            state.pieces == (1, 1) and state.role is None and bool((look.motion == KEEP).all())
            for state, look in zip(states, looks, strict=True)
        ]
    ) & np.array([state.machine == table.machines[0] for state in states])
    return CompiledTable(
        table=table,
        names=names,
        machine=np.array([table.machines.index(state.machine) for state in states], np.int8),
        starts=tuple(
            next(k for k, state in enumerate(states) if state.machine == machine)
            for machine in table.machines
        ),
        rules=rules,
        choices=Choices(rules),
        looks=Looks(looks),
        pieces=np.array([state.pieces for state in states], np.int32),
        limit=np.array([state.limit for state in states], np.int32) * PIECE,
        leave_to=np.array([index[name] for name in leave], np.int16),
        posture=_numbers([state.posture for state in states], POSTURES),
        arms=_numbers([state.arms for state in states], arms),
        head=_numbers([state.head for state in states], head),
        arms_names=arms,
        head_names=head,
        is_bridge=is_bridge,
        wakes=wakes,
        wakes_rapidly=rapid,
        sleeps=~awake,
        seated=seated,
        other_form=other_form(library.names),
        takes_any_posture=np.array([state.posture is None for state in states]) & ~is_bridge,
        calm=(_calm(library, seated, True), _calm(library, seated, False)),
        responses={
            (KINDS.index(kind), RELATIONS.index(relation)): response
            for (kind, relation), response in table.responses.items()
        },
        notes=tuple(notes),
    )


def _compile(rule: Rule, index: dict[str, int]) -> CompiledRule:
    kinds = _mask(rule.events or frozenset(KINDS), KINDS)
    relations = _mask(rule.relations or frozenset(RELATIONS), RELATIONS)
    return CompiledRule(
        target=index[rule.target],
        effort=rule.effort,
        pairs=kinds[:, None] & relations if rule.events or rule.relations else None,
        calm=rule.calm,
        pieces=rule.pieces,
        rapid=rule.rapid,
        blend=rule.blend * POSE_RATE,
        limits=rule.limits,
        signals=rule.signals,
    )


def _mask(chosen: frozenset[str], names: tuple[str, ...]) -> NDArray[np.bool_]:
    return np.array([name in chosen for name in names], np.bool_)


def _values(given: list[str | None], first: str) -> tuple[str, ...]:
    return tuple(dict.fromkeys((first, *(value for value in given if value is not None))))


def _numbers(given: list[str | None], names: tuple[str, ...]) -> NDArray[np.int8]:
    return np.array([KEEP if value is None else names.index(value) for value in given], np.int8)


def _calm(library: MotionLibrary, seated: NDArray[np.bool_], wanted: bool) -> NDArray[np.int16]:
    calm = library.roles[Role.CALM]
    fitting = calm[seated[calm] == wanted]
    return fitting if len(fitting) else calm


def _cast(
    state: State, library: MotionLibrary, seated: NDArray[np.bool_], notes: list[str]
) -> Look:
    motion: list[int] = []
    variant: list[int] = []
    chance: list[float] = []
    excitement: list[float] = []
    for number, one in enumerate(state.variants or (Variant(()),)):
        found = matching(one, state, library.names)
        if not found:
            found = [_stand_in(state, number, library, seated)]
            if one.clips:
                what = library.names[found[0]] if found[0] >= 0 else "nothing of its own"
                clips = one.clips if isinstance(one.clips, str) else " or ".join(one.clips)
                notes.append(f"{state.name} {number + 1}: no clip {clips}; {what} stands in")
        motion += found
        variant += [number] * len(found)
        chance += [1.0 / one.effort / len(found)] * len(found)
        excitement += [one.excitement] * len(found)
    return Look(
        np.array(motion, np.int16),
        np.array(variant, np.int16),
        np.array(chance),
        np.array(excitement, np.float32),
    )


def _stand_in(state: State, number: int, library: MotionLibrary, seated: NDArray[np.bool_]) -> int:
    if state.role is None:
        return KEEP
    motions = library.roles[state.role]
    if state.posture is not None:
        fitting = motions[seated[motions] == (state.posture == POSTURES[0])]
        motions = fitting if len(fitting) else motions
    return int(motions[number % len(motions)])

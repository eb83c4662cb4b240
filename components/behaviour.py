"""What an agent is doing and why."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray


@dataclass(slots=True, eq=False)
class Behaviour:
    """Per machine of the behaviour table (M) and agent (N): its state; per agent: its event.

    Attributes
    ----------
    state, variant
        (M, N) int16 state of the table, and which of the state's variants is played.
    motion
        (M, N) int16 motion of the crowd's library that shows it; -1 keeps what is shown.
    ahead, ahead_variant, ahead_motion
        (M, N) int16 what was already chosen to come next; -1 where nothing was.
    entered
        (M, N) int32 pose tick at which the state was entered.
    until
        (M, N) int32 pose tick at which the current stay ends: a whole number of pieces after it
        began, give or take half a piece where its length was drawn, unless something rapid ends it.
    event, relation
        (N,) int8 kind of the last event that moved the agent, and what it was to the agent; -1
        before the first.
    impact
        (N,) float32 how impressive it was, 0 to 1.
    strength
        (N,) float32 its benefit to the agent, which weighs it against the next event.
    stirred_from, stirred_until
        (N,) int32 pose ticks between which it moves the agent.
    reacting
        (N,) bool: the present tick lies between the two.
    posture, arms, head
        (N,) int8 values of the three channels, by the table's lists of names.
    signals
        Columns by name that other mechanisms supply and the table's rules may ask for: (N,) bool
        or numbers.
    tick
        The last pose tick.
    """

    state: NDArray[np.int16]
    variant: NDArray[np.int16]
    motion: NDArray[np.int16]
    ahead: NDArray[np.int16]
    ahead_variant: NDArray[np.int16]
    ahead_motion: NDArray[np.int16]
    entered: NDArray[np.int32]
    until: NDArray[np.int32]
    event: NDArray[np.int8]
    relation: NDArray[np.int8]
    impact: NDArray[np.float32]
    strength: NDArray[np.float32]
    stirred_from: NDArray[np.int32]
    stirred_until: NDArray[np.int32]
    reacting: NDArray[np.bool_]
    posture: NDArray[np.int8]
    arms: NDArray[np.int8]
    head: NDArray[np.int8]
    signals: dict[str, NDArray[np.generic]] = field(default_factory=dict)
    tick: int = 0

    @classmethod
    def allocate(cls, machines: int, agents: int) -> Behaviour:
        """Everyone in state 0 of each machine, moved by nothing, with a stay that ends at once."""
        shape = (machines, agents)

        def per_machine(value: int) -> NDArray[np.int16]:
            return np.full(shape, value, np.int16)

        return cls(
            state=per_machine(0),
            variant=per_machine(0),
            motion=per_machine(-1),
            ahead=per_machine(-1),
            ahead_variant=per_machine(0),
            ahead_motion=per_machine(-1),
            entered=np.zeros(shape, np.int32),
            until=np.zeros(shape, np.int32),
            event=np.full(agents, -1, np.int8),
            relation=np.full(agents, -1, np.int8),
            impact=np.full(agents, 0.0, np.float32),
            strength=np.full(agents, 0.0, np.float32),
            stirred_from=np.full(agents, 0, np.int32),
            stirred_until=np.full(agents, 0, np.int32),
            reacting=np.zeros(agents, np.bool_),
            posture=np.zeros(agents, np.int8),
            arms=np.zeros(agents, np.int8),
            head=np.zeros(agents, np.int8),
        )

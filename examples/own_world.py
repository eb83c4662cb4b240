"""A crowd in an esper world of your own, with a component and a processor of your own.

Run with ``python examples/own_world.py``.
"""

from __future__ import annotations

from dataclasses import dataclass

import esper
import numpy as np
from numpy.typing import NDArray

import tifo


@dataclass
class Thirst:
    """One row a spectator, like every component of a crowd."""

    level: NDArray[np.float32]


class ThirstSystem(esper.Processor):
    """Cheering makes thirsty."""

    def process(self, delta: float) -> None:
        """One frame."""
        for _, (thirst, behaviour) in esper.get_components(Thirst, tifo.Behaviour):
            thirst.level += np.where(behaviour.reacting, 0.05, 0.01).astype(np.float32) * delta


def main() -> None:
    spec = tifo.CrowdSpec(rows=8, columns=25, layout="stand", seed=3)
    crowd = tifo.spawn_crowd(spec, tifo.build_seats(spec), tifo.builtin_spectator())
    thirst = Thirst(np.zeros(len(crowd), np.float32))
    esper.add_component(crowd.entity, thirst)
    esper.add_processor(tifo.Schedule(tifo.Clock(), tifo.tick_systems(spec.seed)), priority=1)
    esper.add_processor(ThirstSystem())

    crowd.send(tifo.Goal(side=0))
    for _ in range(60 * 5):
        esper.process(1 / 60)
    print(f"thirst after five seconds: {thirst.level.min():.2f} to {thirst.level.max():.2f}")


if __name__ == "__main__":
    main()

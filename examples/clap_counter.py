"""How loud the applause is: claps a second, counted from the tags on the clapping clips.

Run with ``python examples/clap_counter.py``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import tifo


def main() -> None:
    simulation = tifo.Simulation(tifo.CrowdSpec(seats=3_000, sides=2, neutrals=0.6, seed=4))
    crowd = simulation.crowd
    loudness = 0.0

    def heard(agents: NDArray[np.int64], weights: NDArray[np.float32]) -> None:
        nonlocal loudness
        # Someone who only begins to clap, or ends, is heard in part.
        loudness += float(weights.sum())

    crowd.on_clip_event("clap_contact", heard)
    for second in range(12):
        if second == 2:
            simulation.send(tifo.Goal(side=0))  # neutrals applaud
        loudness = 0.0
        simulation.run(seconds=1.0)
        print(f"{second + 1:2d} s  {loudness:5.0f} claps  {'#' * round(loudness / 100)}")
    simulation.close()


if __name__ == "__main__":
    main()

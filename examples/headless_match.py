"""Ten seconds of a match without a window: who stands up for a goal, section by section.

Run with ``python examples/headless_match.py``.
"""

from __future__ import annotations

import numpy as np

import tifo


def main() -> None:
    simulation = tifo.Simulation(tifo.CrowdSpec(seats=3_000, sides=2, away_share=0.2, seed=4))
    crowd = simulation.crowd
    for second in range(10):
        if second == 2:
            simulation.send(tifo.Goal(side=0))
        simulation.run(seconds=1.0)
        reacting = crowd.behaviour.reacting
        home, away = (np.mean(reacting[crowd.team.side == side]) for side in (0, 1))
        print(f"{second + 1:2d} s  home {home:4.0%}  away {away:4.0%}")
    simulation.close()


if __name__ == "__main__":
    main()

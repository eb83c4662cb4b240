"""Figures 19 to 21 of the thesis, as numbers: before and after, long and short, one side only."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from tifo.engine.behaviour import Goal
from tifo.engine.errors import AssetError
from tifo.systems.simulation import Simulation

MakeSimulation = Callable[..., Simulation]


def _cheering(simulation: Simulation) -> np.ndarray:
    crowd = simulation.crowd
    states = [crowd.in_state(name) for name in ("clap", "cheer", "jump")]
    return np.any(states, axis=0)[crowd.seat.occupied]


def _curve(simulation: Simulation, frames: int) -> np.ndarray:
    """Share that cheers at each pose frame; the event falls at frame 120."""
    shares = []
    for frame in range(frames):
        if frame == 120:
            simulation.send(Goal(0, weight=0.5))
        simulation.run(seconds=2 / 60)
        shares.append(_cheering(simulation).mean())
    return np.array(shares)


def test_embarrassment_shortens_cheering(simulate: MakeSimulation) -> None:
    ends, peaks = [], []
    for level in (0.0, 0.25, 0.5, 0.75, 1.0):
        simulation = simulate(embarrassment=level, neutrals=0.0, columns=40)
        curve = _curve(simulation, 290)
        assert not curve[:120].any(), "before the event nobody cheers"
        ends.append(int(np.flatnonzero(curve >= 0.5 * curve.max())[-1]))
        peaks.append(curve.max())
        if level == 0.0:
            assert curve[160] > 0.95, "and then everybody, in a second of reacting"
            assert curve[245] > 0.5
            assert curve[275] < 0.1
        if level == 1.0:
            assert not curve[200:].any()
    # About 250 at 0, over by 200 at 1, and interpolated between.
    assert ends[0] == pytest.approx(250, abs=10)
    assert ends[-1] < 200
    assert (np.diff(ends) < 0).all()
    straight = np.interp(np.linspace(0, 1, 5), [0, 1], [ends[0], ends[-1]])
    np.testing.assert_allclose(ends, straight, atol=16)
    assert (np.diff(peaks) < 0.02).all(), "fewer take part, too"


def test_with_one_side_everybody_cheers_and_with_two_only_the_winners(
    simulate: MakeSimulation,
) -> None:
    one = simulate(neutrals=0.0, sides=1)
    one.send(Goal(0))
    one.run(seconds=1.5)
    assert _cheering(one).mean() > 0.95
    for fans, share in (("mixed", 0.5), ("blocks", 0.5), ("away block", 0.3)):
        two = simulate(neutrals=0.0, sides=2, fans=fans, away_share=0.3, columns=60)
        crowd = two.crowd
        away = (crowd.team.side == 1)[crowd.seat.occupied]
        assert away.mean() == pytest.approx(share, abs=0.06)
        two.send(Goal(1))
        two.run(seconds=1.5)
        cheering = _cheering(two)
        assert cheering[away].mean() > 0.95
        assert not cheering[~away].any()


def test_four_sides_sit_in_blocks_or_mixed(simulate: MakeSimulation) -> None:
    blocks = simulate(sides=4, fans="blocks", neutrals=0.0, columns=60).crowd
    assert np.bincount(blocks.team.side).tolist() == [225] * 4
    ends = [blocks.placement.position[0, blocks.team.side == side] for side in range(4)]
    middles = sorted(float(np.median(x)) for x in ends)
    assert np.diff(middles).min() > 15.0
    mixed = simulate(sides=4, fans="mixed", neutrals=0.1, columns=60).crowd
    shares = np.bincount(mixed.team.side + 1) / len(mixed)
    np.testing.assert_allclose(shares, [0.1, 0.225, 0.225, 0.225, 0.225], atol=0.05)
    guests = simulate(sides=3, away_share=0.2, neutrals=0.0, columns=60).crowd
    assert np.bincount(guests.team.side).tolist() == [720, 90, 90]


def test_fervour_follows_the_side(simulate: MakeSimulation) -> None:
    crowd = simulate(sides=2, away_share=0.5, neutrals=0.2, ultras=0.1, columns=60).crowd
    fervour, side = crowd.team.fervour, crowd.team.side
    assert (fervour[side == -1] == np.float32(0.4)).all()
    ultras = fervour == 1.5
    assert ultras[side == 0].mean() == pytest.approx(0.1, abs=0.06)
    assert ultras[side == 1].mean() == pytest.approx(0.3, abs=0.07)
    ordinary = fervour[(side >= 0) & ~ultras]
    assert ordinary.min() >= 0.85
    assert ordinary.max() <= 1.15


@pytest.mark.parametrize("table", ["rock_concert", "classical_concert", "speech"])
def test_other_audiences_behave_otherwise(simulate: MakeSimulation, table: str) -> None:
    from tifo.engine.behaviour import Event

    simulation = simulate(behaviour=table, neutrals=0.0)
    simulation.run(seconds=5.0)
    crowd = simulation.crowd
    standing = np.array(crowd.channels()["posture"]) == "standing"
    assert standing.mean() == (1.0 if table == "rock_concert" else 0.0)
    simulation.send(Event("cue", weight=0.6))
    simulation.run(seconds=4.0)
    arms = np.array(crowd.channels()["arms"])
    assert (arms != "rest").mean() > 0.6
    if table != "rock_concert":
        assert set(arms) <= {"rest", "clap"}
    simulation.run(seconds=25.0)
    assert not crowd.behaviour.reacting.any()


def test_an_unknown_table_is_an_error_of_the_file(simulate: MakeSimulation) -> None:
    with pytest.raises(AssetError, match="no_such_table: there is no such file"):
        simulate(behaviour="no_such_table")

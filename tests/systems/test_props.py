"""Who has a cap, a scarf, a flag, a foam hand or a drum."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import tifo

SPEC = tifo.CrowdSpec(layout="stand", rows=20, columns=50, sides=2, streams=24, history=10)


def test_a_share_of_the_supporters_has_props_in_the_colours_of_its_side() -> None:
    simulation = tifo.Simulation(SPEC.replace(props=0.5, neutrals=0.2))
    crowd = simulation.crowd
    assert set(crowd.parts) == set(tifo.PROPS)
    has = np.logical_or.reduce([part.visible for part in crowd.parts.values()])
    fans = crowd.team.side >= 0
    assert not has[~fans].any()
    assert has[fans].mean() == pytest.approx(0.5, abs=0.06)
    both = crowd.parts["cap"].visible & crowd.parts["scarf"].visible
    assert both.any()
    with simulation.active():
        import esper

        looks = esper.component_for_entity(crowd.parts["scarf"].entity, tifo.Appearance)
    red, _, blue, _ = looks.shirt.astype(int).T
    home = crowd.team.side == 0
    assert (red[home] > blue[home]).all()
    assert (blue[fans & ~home] > red[fans & ~home]).all()
    simulation.close()


def test_none_are_given_where_none_are_wanted_or_none_fit(
    simulate: Callable[..., tifo.Simulation],
) -> None:
    simulation = tifo.Simulation(SPEC.replace(props=0.0))
    assert not simulation.crowd.parts
    with simulation.active():
        with pytest.raises(ValueError, match=r"share is 1\.5, expected 0 to 1"):
            tifo.give_props(simulation.crowd, 1.5, tick=0)
        assert set(tifo.give_props(simulation.crowd, 1.0, tick=0)) == set(tifo.PROPS)
    simulation.close()
    other = simulate(props=1.0)
    assert not other.crowd.parts
    with other.active(), pytest.raises(ValueError, match="'box person' has other joints"):
        tifo.give_props(other.crowd, 0.5, tick=0)


def test_the_same_seed_gives_the_same_people_the_same_props() -> None:
    bits = []
    for seed in (1, 1, 2):
        simulation = tifo.Simulation(SPEC.replace(seed=seed))
        bits.append(next(iter(simulation.crowd.parts.values())).bits.bits.copy())
        simulation.close()
    np.testing.assert_array_equal(bits[0], bits[1])
    assert not np.array_equal(bits[0], bits[2])


def test_a_few_ultras_drum_in_time() -> None:
    simulation = tifo.Simulation(SPEC.replace(props=1.0, ultras=0.3, uniques=4))
    crowd = simulation.crowd
    drummers = np.flatnonzero(crowd.parts["drum"].visible)
    assert 3 <= len(drummers) < 0.1 * len(crowd)
    assert (crowd.team.fervour[drummers] > 1.3).all()
    assert (crowd.body.kind[drummers] == 0).all()
    for name in ("cap", "flag", "foam_hand", "scarf"):
        assert not crowd.parts[name].visible[drummers].any()
    foam = np.flatnonzero(crowd.parts["foam_hand"].visible)
    assert len(foam) > 20
    assert crowd.parts["foam_hand"].attachment.joint == crowd.character.skeleton.index("hand_r")

    def arms(count: int) -> np.ndarray:
        simulation.run(seconds=count / 30)
        clock, skeleton = simulation.clock, crowd.character.skeleton
        chest, hand = skeleton.index("chest"), skeleton.index("hand_r")
        palettes = crowd.palettes(drummers, clock.pose_tick).astype(float)
        square = np.tile(np.eye(4), (len(drummers), 2, 1, 1))
        square[:, :, :3] = palettes[:, [chest, hand]]
        return (np.linalg.inv(square[:, 0]) @ square[:, 1])[:, :3, :3]

    before = arms(30)
    after = arms(5)
    # All hands are turned alike against their chests, and not as they were before.
    assert np.abs(after - after[0]).max() < 0.02
    assert np.abs(after - before).max() > 0.1
    simulation.close()


def test_nobody_drums_where_nothing_is_left_to_move_arms() -> None:
    for changes in ({"uniques": 0}, {"poses": "baked"}):
        simulation = tifo.Simulation(SPEC.replace(props=1.0, ultras=0.3, **changes))
        assert not simulation.crowd.parts["drum"].visible.any()
        assert simulation.crowd.parts["foam_hand"].visible.any()
        simulation.close()

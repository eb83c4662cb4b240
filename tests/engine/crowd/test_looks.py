"""Who has which body, hair and beard."""

from __future__ import annotations

import numpy as np
import pytest

from tifo.components.body import Body
from tifo.engine.assets.character import Character
from tifo.engine.assets.spectator import builtin_spectator
from tifo.engine.assets.variants import PEOPLE, one_look, variant_groups
from tifo.engine.crowd.builds import draw_bodies
from tifo.engine.crowd.looks import choose, draw_choices, people_of, wears
from tifo.engine.crowd.spec import CrowdSpec
from tifo.systems.simulation import Simulation

COUNT = 40_000


@pytest.fixture(scope="module")
def drawn() -> tuple[Character, Body]:
    character = builtin_spectator()
    rng = np.random.default_rng(5)
    body, _ = draw_bodies(COUNT, 0.3, 0.3, 1.75, rng, women=0.4)
    body.choice = draw_choices(character, body, rng)
    return character, body


def test_women_are_as_many_as_wanted_and_smaller() -> None:
    body, scale = draw_bodies(COUNT, 0.2, 0.2, 1.75, np.random.default_rng(2), women=0.3)
    assert body.woman.mean() == pytest.approx(0.3, abs=0.01)
    adult = body.kind == 0
    assert scale[adult & body.woman].mean() == pytest.approx(0.935, abs=0.004)
    assert scale[adult & ~body.woman].mean() == pytest.approx(1.0, abs=0.004)


def test_choices_follow_the_shares(drawn: tuple[Character, Body]) -> None:
    character, body = drawn
    people = people_of(body)
    for row, variants in zip(body.choice, variant_groups(character).values(), strict=True):
        for who, name in enumerate(PEOPLE):
            mine = row[people == who]
            assert len(mine) > 1000
            for number, variant in enumerate(variants):
                expected = variant.shares.get(name, 0.0)
                assert (mine == number).mean() == pytest.approx(expected, abs=0.035), variant


def test_nobody_is_without_body_or_hair_and_only_men_have_beards(
    drawn: tuple[Character, Body],
) -> None:
    character, body = drawn
    groups = variant_groups(character)
    assert list(groups) == ["body", "hair", "beard"]
    assert (body.choice[:2] < 8).all()
    names = np.array([variant.choice.split("_")[0] for variant in groups["body"]])
    sort = np.where(body.kind == 1, "child", np.where(body.woman, "woman", "man"))
    assert (names[body.choice[0]] == sort).all()
    grown_men = (body.kind != 1) & ~body.woman
    beard = wears(character, body, "beard", ("full", "moustache"))
    assert not beard[~grown_men].any()
    assert 0.15 < beard[grown_men].mean() < 0.35
    assert not wears(character, body, "wings", ("left",)).any()


def test_dressing_agents() -> None:
    simulation = Simulation(
        CrowdSpec(layout="stand", rows=2, columns=5, streams=32, history=4, women=1.0)
    )
    crowd = simulation.crowd
    assert crowd.body.woman.all()
    assert crowd.body.choice.shape == (3, 10)
    before, digest = crowd.body.choice.copy(), crowd.state_hash()
    crowd.dress([2, 7], hair="ring", beard="full")
    assert crowd.state_hash() != digest
    groups = variant_groups(crowd.character)
    ring = [variant.choice for variant in groups["hair"]].index("ring")
    np.testing.assert_array_equal(crowd.body.choice[1, [2, 7]], ring)
    np.testing.assert_array_equal(crowd.body.choice[2, [2, 7]], 0)
    crowd.dress(7, beard=None)
    assert crowd.body.choice[2, 7] == 255
    others = np.setdiff1d(np.arange(10), [2, 7])
    np.testing.assert_array_equal(crowd.body.choice[:, others], before[:, others])
    now = crowd.body.choice.copy()
    with pytest.raises(ValueError, match="'hair' has no 'wig', expected one of: short"):
        crowd.dress(1, beard="full", hair="wig")
    with pytest.raises(ValueError, match="no group 'hat'; groups: body, hair, beard"):
        crowd.dress(1, hat="top")
    np.testing.assert_array_equal(crowd.body.choice, now)
    simulation.close()


def test_choosing_for_a_body_without_variants_is_refused() -> None:
    character = builtin_spectator()
    with pytest.raises(ValueError, match="groups: none"):
        choose(one_look(character), Body.allocate(3), np.arange(2), {"hair": "bun"})

"""Every agent is drawn with the meshes of its choices, and with no others."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tifo.engine.assets.spectator import builtin_spectator
from tifo.engine.assets.variants import one_look, variant_groups
from tifo.engine.crowd.spec import CrowdSpec
from tifo.systems.simulation import Simulation

pytestmark = pytest.mark.gl

SPEC = CrowdSpec(
    layout="stand", rows=4, columns=6, streams=32, history=4, occupancy=1.0, lod=False, seed=3
)


@pytest.fixture(scope="module")
def simulation() -> Any:
    made = Simulation(SPEC)
    made.run(seconds=0.2)
    yield made
    made.close()


def test_as_many_triangles_as_the_choices_have(gl: Any, simulation: Simulation) -> None:
    from tifo.engine.crowd.cameras import camera_presets
    from tifo.scripting.camera import FreeCamera
    from tifo.scripting.stage import Stage

    crowd = simulation.crowd
    character = crowd.character
    groups = variant_groups(character)
    stage = Stage(simulation, (160, 90))
    camera = FreeCamera.looking(*camera_presets(simulation.plan)["bowl"])

    def drawn() -> int:
        stage.draw(camera)
        return stage.counts.triangles

    def expected() -> int:
        total = 0
        for agent in np.concatenate(crowd.detail.agents):
            choices = {
                name: None if number == 255 else groups[name][number].choice
                for name, number in zip(groups, crowd.body.choice[:, agent], strict=True)
            }
            total += one_look(character, choices).triangle_count
        return total

    first = drawn()
    assert len(crowd.detail.agents[0]) > 5
    first_expected = expected()
    seen = crowd.detail.agents[0]
    crowd.dress(seen[:3], beard="full", hair="curly")
    crowd.dress(seen[3:], beard=None, hair="crop", body="man_shorts")
    # What else is in the picture stays the same.
    assert drawn() - first == expected() - first_expected
    crowd.dress(seen, beard=None, hair=None, body="child_shirt")
    assert drawn() - first == expected() - first_expected
    stage.close()


@pytest.mark.parametrize("count", [0, 1, 2, 17, 200])
def test_lists_hold_each_agent_at_its_choice(gl: Any, count: int) -> None:
    from tifo.engine.render.variant_lists import VariantLists

    character = builtin_spectator()
    groups = variant_groups(character)
    rng = np.random.default_rng(count)
    choice = np.stack(
        [rng.integers(0, len(variants) + 1, 200) for variants in groups.values()]
    ).astype(np.uint8)
    for row, variants in zip(choice, groups.values(), strict=True):
        row[row == len(variants)] = 255
    lists = VariantLists(character, 1)
    shown = np.sort(rng.permutation(200)[:count]).astype(np.uint32)
    copied = lists.write(shown, choice)
    assert copied == 4 * int((choice[:, shown] < 255).sum())
    assert len(lists.draws) == sum(len(variants) for variants in groups.values())
    found = iter(lists.draws)
    for row, variants in zip(choice, groups.values(), strict=True):
        for number, variant in enumerate(variants):
            meshes, agents = next(found)
            assert all(mesh.variant == variant for mesh in meshes)
            expected = shown[row[shown] == number]
            assert agents.count == len(expected)
            if agents.count:
                there = agents.buffer.read(np.uint32)[: agents.count]
                np.testing.assert_array_equal(there, expected)
    lists.write(shown[:0], choice)
    assert all(agents.count == 0 for _, agents in lists.draws)
    for _, agents in lists.draws:
        agents.delete()

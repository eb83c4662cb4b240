"""Crowd, Section and Agent nodes: one truth with the columns, and signals that tell it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import tifo
from tifo import Node3D, SceneTree, ScriptError, Section, Stadium, Vector3, nodes


def test_questions_are_answered_by_ids(crowd: nodes.Crowd) -> None:
    data = crowd.data
    there = data.seat.occupied
    assert not there.all()
    np.testing.assert_array_equal(crowd.where(), np.flatnonzero(there))
    np.testing.assert_array_equal(crowd.where(present=None), np.arange(90))
    np.testing.assert_array_equal(crowd.where(present=False), np.flatnonzero(~there))
    rows = crowd.where(team=1, row=range(5), present=None)
    np.testing.assert_array_equal(rows, np.flatnonzero((data.team.side == 1) & (data.seat.row < 5)))
    assert 0 < len(rows) < 90
    some = crowd.where(row=[0, 5], column=range(14, 0, -7), present=None)
    assert [data.plan.label(k) for k in some] == ["0|7", "0|14", "5|7", "5|14"]
    np.testing.assert_array_equal(crowd.where(section="0"), crowd.where(section=0))
    seat = data.placement.position[:, 20]
    near = crowd.where(near=(seat, 1.6), present=None)
    assert 20 in near
    assert len(near) == 3, "neighbours are 1.5 m away"
    assert len(crowd.where(motion=data.library.names, present=None)) == 90
    mask = np.zeros(90, bool)
    mask[[3, 7]] = True
    assert [*crowd.where(mask=mask, present=None)] == [3, 7]
    assert len(crowd.where(row=[])) == 0


@pytest.mark.parametrize(
    ("question", "message"),
    [
        ({"section": "north"}, "there is no section 'north'; there are 0"),
        ({"motion": "sit_idel"}, "there is no motion 'sit_idel'; there are sit_idle"),
        ({"row": 1.5}, "row is 1.5, expected a whole number or several"),
        ({"row": [0.5]}, r"row is \[0.5\], expected a whole number"),
        ({"near": (0, 1)}, "expected a place"),
        ({"near": ((0, 0, 0), -1)}, "metres >= 0"),
        ({"mask": np.ones(3, bool)}, r"mask has shape \(3,\) of bool, expected \(90,\)"),
    ],
)
def test_wrong_questions(crowd: nodes.Crowd, question: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        crowd.where(**question)


def test_events_are_told_when_the_crowd_hears_of_them(
    tree: SceneTree, stadium: Stadium, crowd: nodes.Crowd, errors: list[ScriptError]
) -> None:
    told: list[Any] = []
    crowd.goal.connect(lambda side: told.append((tree.tick, side)))
    crowd.ball_hit.connect(lambda place: told.append((tree.tick, place)))
    crowd.event.connect(lambda event: told.append((tree.tick, type(event).__name__)))
    tree.run(3 / 60)
    crowd.send(tifo.Goal(side=1))
    stadium.simulation.crowd.send(tifo.BallHit((1.0, 2.0, 3.0)))  # past the node
    tree.run(4 / 60)
    assert told == [
        *((4, "Goal"), (4, 1), (4, "BallHit"), (4, Vector3(1.0, 2.0, 3.0))),
    ]
    assert not errors


def test_clip_events_are_those_of_the_feed(
    tree: SceneTree, stadium: Stadium, crowd: nodes.Crowd
) -> None:
    alone = tifo.Simulation(stadium.spec)
    heard: list[tuple[int, str, int, float]] = []
    expected: list[tuple[int, str, int, float]] = []
    crowd.clip_event.connect(
        lambda name, agents, weights: heard.append(
            (stadium.simulation.clock.tick, name, len(agents), float(weights.sum()))
        )
    )
    assert alone.crowd.clip_feed is not None
    for name in alone.crowd.clip_feed.names:

        def listen(agents: Any, weights: Any, name: str = name) -> None:
            expected.append((alone.clock.tick, name, len(agents), float(weights.sum())))

        alone.crowd.on_clip_event(name, listen)
    for simulation in (alone, stadium.simulation):
        simulation.send(tifo.Goal(side=0))
    tree.time_scale = 3.0  # several pose ticks in one tick of the tree
    tree.run(1.0)
    alone.run(seconds=3.0)
    assert len(heard) > 10
    assert heard == expected
    alone.close()


def test_heads_follow_a_node(tree: SceneTree, stadium: Stadium, crowd: nodes.Crowd) -> None:
    ball = stadium.add_child(Node3D(name="Ball", position=Vector3(10.0, 3.0, 20.0)))
    stadium.position = Vector3(100.0, 0.0, 0.0)
    crowd.watches = ball
    tree.run(0.1)
    (override,) = crowd.data.overrides.overrides
    np.testing.assert_allclose(override.uniforms["trail"][0], (10.0, 3.0, 20.0), atol=1e-4)
    ball.position = Vector3(-10.0, 3.0, 20.0)
    tree.run(2.0)
    np.testing.assert_allclose(override.uniforms["trail"][0], (-10.0, 3.0, 20.0), atol=0.05)
    ball.free()
    tree.run(0.1)
    assert crowd.data.overrides.overrides == ()


def test_an_agent_is_a_row_of_the_columns(
    tree: SceneTree, stadium: Stadium, crowd: nodes.Crowd
) -> None:
    agent = crowd.agent("2|3")
    data = crowd.data
    assert agent is crowd.agent(33) is crowd["Agent33"]
    assert (agent.agent, agent.seat, agent.row, agent.column) == (33, "2|3", 2, 3)
    assert agent.section == "0"
    placement = data.placement
    assert agent.position == Vector3.of(placement.position[:, 33])
    hat = agent.add_child(Node3D(name="Hat", position=Vector3(0.0, 1.0, 0.0)))
    size = float(placement.scale[33])
    assert hat.global_position.y == pytest.approx(agent.position.y + size)

    version = placement.version
    agent.position += Vector3(0.0, 2.0, 0.0)
    agent.rotation = tifo.Quaternion.from_axis_angle((0, 1, 0), 0.3)
    agent.scale = Vector3(2.0, 2.0, 2.0)
    assert placement.position[1, 33] == pytest.approx(agent.position.y)
    assert placement.yaw[33] == pytest.approx(0.3)
    assert placement.scale[33] == 2.0
    assert placement.version > version
    # The other way round, and where the stadium stands.
    placement.position[:, 33] = 1.0, 2.0, 3.0
    placement.version += 1
    stadium.position = Vector3(10.0, 0.0, 0.0)
    tree.run(1 / 60)
    assert agent.position == Vector3(1.0, 2.0, 3.0)
    assert agent.global_position == Vector3(11.0, 2.0, 3.0)
    assert hat.global_position == Vector3(11.0, 4.0, 3.0)
    agent.global_position = Vector3(12.0, 0.0, 0.0)
    np.testing.assert_allclose(placement.position[:, 33], (2.0, 0.0, 0.0), atol=1e-6)

    agent.is_present, agent.team = False, -1
    assert not data.seat.occupied[33]
    assert data.team.side[33] == -1
    assert agent.motion == data.library.names[data.motion.shown[33]]
    with pytest.raises(ValueError, match="a turn about"):
        agent.rotation = tifo.Quaternion.from_axis_angle((1, 0, 0), 0.3)
    with pytest.raises(ValueError, match="three equal numbers"):
        agent.scale = Vector3(1.0, 2.0, 1.0)
    with pytest.raises(ValueError, match="expected 0"):
        agent.team = 4
    with pytest.raises(ValueError, match="expected 0 to 89"):
        crowd.agent(90)
    agent.free()
    assert crowd.agent(33) is not agent


def test_a_section_is_a_range_of_agents(tree: SceneTree) -> None:
    stadium = Stadium(name="Bowl", seats=3000, streams=24, history=14)
    crowd = stadium.add_child(nodes.Crowd(name="Crowd"))
    section = crowd.add_child(Section(name="South", section="3"))
    tree.root.add_child(stadium)
    name, start, stop = crowd.data.plan.sections[3]
    assert name == "3"
    assert section.span == range(start, stop)
    np.testing.assert_array_equal(section.agents, crowd.where(section="3"))
    np.testing.assert_array_equal(section.where(row=0), crowd.where(section="3", row=0))
    seats = crowd.data.placement.position[:, start:stop].mean(axis=1)
    assert section.centre == pytest.approx(tuple(seats), abs=1e-4)
    assert section.agent(0).agent == start
    section.section = "300"
    with pytest.raises(ValueError, match="there is no section '300'; there are 0, 1"):
        _ = section.span


def test_nodes_in_a_wrong_place_say_what_they_need() -> None:
    with pytest.raises(ValueError, match="has no Stadium above it"):
        _ = nodes.Crowd().data
    with pytest.raises(ValueError, match="has no Crowd above it"):
        _ = Section().agents

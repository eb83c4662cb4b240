"""Fresh components: shapes, types and what they say."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest

from tifo.components import AgentAnimID, Behaviour, Detail, Level, MotionState, Transition, View
from tifo.components.team import Team


def test_agents_begin_on_one_row_at_rest() -> None:
    anim = AgentAnimID.allocate(2, 5, row=9)
    assert anim.row.shape == (2, 5)
    assert (anim.row == 9).all()
    for name, dtype in (("start", np.float32), ("target", np.float32), ("rate", np.float32)):
        column = getattr(anim, name)
        assert column.shape == (2, 5)
        assert column.dtype == dtype
        assert not column.any()
    assert anim.row.dtype == anim.t0.dtype == np.int32
    assert anim.version == 0


def test_no_column_shares_memory_with_another() -> None:
    for component in (AgentAnimID.allocate(1, 4, 0), Transition.allocate(1, 4)):
        columns = [getattr(component, f.name) for f in fields(component) if f.name != "version"]
        for k, column in enumerate(columns):
            assert not any(np.shares_memory(column, other) for other in columns[:k])


def test_no_blend_runs_at_first() -> None:
    transition = Transition.allocate(3, 4)
    assert transition.duration.shape == (3, 4)
    assert not transition.duration.any()
    assert transition.begin.dtype == np.float64
    assert (transition.next_row == -1).all()


def test_a_transition_can_hold_what_an_agent_leaves() -> None:
    source = {f.name for f in fields(AgentAnimID)} - {"version"}
    assert source < {f.name for f in fields(Transition)}


def test_everyone_shows_a_motion_and_wants_no_other() -> None:
    motion = np.array([2, 0, 1], np.int16)
    state = MotionState.allocate(motion)
    for name in ("wanted", "shown"):
        column = getattr(state, name)
        np.testing.assert_array_equal(column, motion)
        assert not np.shares_memory(column, motion)
    state.wanted[0] = 7
    assert state.shown[0] == 2
    assert (state.blend == 12.0).all()
    assert not state.busy_until.any()


def test_nothing_has_moved_anybody_yet() -> None:
    behaviour = Behaviour.allocate(2, 4)
    assert behaviour.state.shape == behaviour.until.shape == (2, 4)
    assert (behaviour.ahead == -1).all()
    assert (behaviour.event == -1).all()
    assert not behaviour.reacting.any()
    assert (behaviour.stirred_until == behaviour.stirred_from).all()
    assert behaviour.signals == {}
    assert Behaviour.allocate(1, 1).signals is not behaviour.signals


def test_supporters_are_ordinary_unless_somebody_says_more() -> None:
    assert Team(np.zeros(3, np.int8)).fervour.tolist() == [1.0, 1.0, 1.0]
    given = np.array([0.4, 1.5], np.float32)
    assert Team(np.zeros(2, np.int8), given).fervour is given


def test_nobody_is_in_view_at_first() -> None:
    detail = Detail()
    assert len(detail.agents) == len(Level) == 4
    assert all(len(ids) == 0 and ids.dtype == np.uint32 for ids in detail.agents)
    assert Detail().agents is not detail.agents


def test_levels_go_from_near_to_far() -> None:
    assert [level.name for level in sorted(Level)] == ["NEAR", "MID", "LOW", "FAR"]


@pytest.mark.parametrize("turn", [0.0, 0.7, -2.0])
def test_the_eye_of_a_view_is_where_the_camera_stands(turn: float) -> None:
    place = np.array([3.0, 4.0, -5.0])
    rotation = np.array(
        [[np.cos(turn), 0, -np.sin(turn)], [0, 1, 0], [np.sin(turn), 0, np.cos(turn)]]
    )
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation, -rotation @ place
    view = View(matrix.astype(np.float32), np.eye(4, dtype=np.float32), 720)
    np.testing.assert_allclose(view.eye, place, atol=1e-5)

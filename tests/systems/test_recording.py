from __future__ import annotations

import numpy as np
import pytest

from tifo.systems.recording import Recorder, present_agents


def test_agents_are_chosen_by_id_mask_and_seat(simulate) -> None:
    simulation = simulate(rows=3, columns=4, occupancy=1.0, empty=("1|2",))
    crowd = simulation.crowd
    everybody = [k for k in range(12) if crowd.plan.label(k) != "1|2"]
    assert present_agents(crowd).tolist() == everybody
    assert present_agents(crowd, 3).tolist() == [3]
    assert present_agents(crowd, np.arange(12) < 2).tolist() == [0, 1]
    assert [crowd.plan.label(k) for k in present_agents(crowd, "rows 1")] == ["1|0", "1|1", "1|3"]
    mixed = present_agents(crowd, ["2|0", 1, "section 0", 1])
    assert mixed.tolist() == everybody
    assert [crowd.plan.label(k) for k in present_agents(crowd, ["2|3", 0])] == ["0|0", "2|3"]


def test_agents_that_are_not_there_are_refused(simulate) -> None:
    crowd = simulate(rows=3, columns=4, occupancy=1.0, empty=("1|2",)).crowd
    empty = crowd.plan.find("1|2")
    for agents, said in (
        (12, "there is no agent 12, expected 0 to 11"),
        ([-1], "there is no agent -1"),
        ("rows 9", "names no seat"),
        ("nobody", "can't be read"),
        (["0|9"], "there is no seat"),
        (1.5, "expected an id, ids"),
        ([], "nobody is there to record, none given"),
        ([empty], "seats of all 1 that are chosen are empty"),
    ):
        with pytest.raises(ValueError, match=said):
            present_agents(crowd, agents)


@pytest.mark.parametrize("fps", [30.0, 24.0, 50.0, 240.0])
def test_frames_show_what_the_crowd_shows_at_their_times(simulate, fps: float) -> None:
    fields = {"rows": 2, "columns": 4, "occupancy": 1.0}
    recording = simulate(**fields).record([1, 5], start=0.3, seconds=0.1, fps=fps)
    other = simulate(**fields)
    assert recording.frames == int(0.1 * fps + 1e-9) + 1
    for frame in range(recording.frames):
        ticks = 60 * (0.3 + frame / fps)
        while other.clock.tick + 1 <= ticks + 1e-9:
            other.run(seconds=1 / 60)
        alpha = (ticks - 2 * other.clock.pose_tick) / 2
        shown = other.crowd.palettes(np.array([1, 5]), other.clock.pose_tick, min(alpha, 1.0))
        np.testing.assert_allclose(recording.palettes[frame], shown, atol=1e-6)
    assert np.abs(np.diff(recording.palettes, axis=0)).max() > 1e-4


def test_recording_changes_nothing(simulate) -> None:
    fields = {"rows": 3, "columns": 4}
    watched, alone = simulate(**fields), simulate(**fields)
    watched.record(start=0.5, seconds=0.5, fps=24.0)
    alone.run(seconds=1.0)
    assert watched.clock.tick == alone.clock.tick == 60
    assert watched.crowd.state_hash() == alone.crowd.state_hash()


def test_absurd_ranges_are_refused_before_time_passes(simulate) -> None:
    simulation = simulate(rows=10, columns=20)
    for values, said in (
        ({"seconds": -1.0}, "seconds is -1.0, expected 0 to 3600"),
        ({"seconds": float("nan")}, "seconds is nan"),
        ({"start": 1e9}, "start is 1000000000.0"),
        ({"fps": 0.0}, "fps is 0.0, expected 1 to 240"),
        ({"fps": 1000.0}, "fps is 1000.0"),
        ({"seconds": 3600.0, "fps": 240.0}, r"take [\d.]+ GB of memory, at most 2.1 GB"),
    ):
        with pytest.raises(ValueError, match=said):
            simulation.record(**values)
    assert simulation.clock.tick == 0


def test_a_recorder_is_for_worlds_that_step_themselves(simulate) -> None:
    simulation = simulate(rows=2, columns=4, occupancy=1.0)
    recorder = Recorder(simulation.crowd, [2], frames=2, fps=30)
    recorder.take(simulation.clock.pose_tick)
    with pytest.raises(ValueError, match="1 of 2 frames were taken"):
        recorder.finish()
    simulation.run(seconds=1.0)
    recorder.take(simulation.clock.pose_tick)
    with pytest.raises(ValueError, match="all 2 frames were taken"):
        recorder.take(simulation.clock.pose_tick)
    recording = recorder.finish()
    assert recording.palettes.shape == (2, 1, 7, 3, 4)
    assert (recording.colors[0, 2] == simulation.crowd.appearance.shirt[2, :3]).all()
    with pytest.raises(ValueError, match="frames is 0"):
        Recorder(simulation.crowd, frames=0, fps=30)


def test_baked_crowds_are_recorded_too(simulate) -> None:
    recording = simulate(rows=2, columns=3, poses="baked").record(seconds=0.2)
    assert recording.frames == 7
    assert np.abs(np.diff(recording.palettes, axis=0)).max() > 1e-4

"""Roles of real clips' names, and how streams are shared out among motions."""

from __future__ import annotations

import re
from collections.abc import Sequence
from types import ModuleType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tifo.engine.animation import Clip, ClipBank
from tifo.engine.assets.spectator import builtin_spectator
from tifo.engine.crowd.motions import (
    MotionLibrary,
    MotionStreams,
    Role,
    sort_motions,
    start_streams,
)
from tifo.engine.streams import StreamPool

KAYKIT = """
    1H_Melee_Attack_Chop 1H_Ranged_Aiming 2H_Melee_Idle 2H_Ranged_Shoot Block Block_Hit Blocking
    Cheer Death_A Death_A_Pose Dodge_Left Dualwield_Melee_Attack_Stab Hit_A Hit_B Idle Interact
    Jump_Full_Long Jump_Full_Short Jump_Idle Jump_Land Jump_Start Lie_Down Lie_Idle Lie_StandUp
    PickUp Running_A Sit_Chair_Down Sit_Chair_Idle Sit_Chair_Pose Sit_Chair_StandUp
    Sit_Floor_Idle Sit_Floor_Pose Spellcasting T-Pose Throw Unarmed_Idle Unarmed_Pose Use_Item
    Walking_A Walking_Backwards
"""
ROBOT = """
    Dance Death Idle Jump No Punch Running Sitting Standing ThumbsUp Walking WalkJump Wave Yes
"""
BUILT_IN = """
    sit_idle sit_idle_2 sit_clap stand_idle stand_idle_2 stand_up sit_down clap cheer cheer_2
    jump wave dismay
"""


def _sort(factories: ModuleType, names: Sequence[str], once: Sequence[str] = ()) -> MotionLibrary:
    body = factories.make_body()
    return sort_motions(
        [factories.make_still(body, name, looping=name not in once) for name in names]
    )


def _named(library: MotionLibrary, role: Role) -> set[str]:
    return {library.names[motion] for motion in library.roles[role]}


def _innate(library: MotionLibrary) -> dict[str, float]:
    shares = zip(library.names, library.innate, strict=True)
    return {name: float(share) for name, share in shares if share > 0}


def test_kaykit(factories: ModuleType) -> None:
    library = _sort(factories, KAYKIT.split())
    assert _named(library, Role.CHEER) == {"Cheer", "Jump_Full_Long", "Jump_Full_Short"}
    assert _named(library, Role.DISMAY) == {"Hit_A"}
    # Nobody claps in this pack: cheering stands for it.
    assert _named(library, Role.APPLAUD) == _named(library, Role.CHEER)
    assert _innate(library) == pytest.approx(
        {"Sit_Chair_Idle": 60 / 130, "Sit_Floor_Idle": 60 / 130, "Idle": 10 / 130}
    )
    assert [KAYKIT.split()[clip] for clip in library.clips] == list(library.names)


def test_robot_expressive(factories: ModuleType) -> None:
    library = _sort(factories, ROBOT.split())
    assert _named(library, Role.CALM) == {"Idle", "Sitting", "Standing"}
    assert _named(library, Role.CHEER) == {"Dance", "Jump", "ThumbsUp", "Wave", "Yes"}
    assert _named(library, Role.DISMAY) == {"No"}
    innate = _innate(library)
    assert max(innate, key=lambda name: innate[name]) == "Sitting"
    assert "Dance" not in innate


def test_the_built_in_names(factories: ModuleType) -> None:
    library = _sort(factories, BUILT_IN.split(), once=("stand_up", "sit_down"))
    assert _named(library, Role.CALM) == {"sit_idle", "sit_idle_2", "stand_idle", "stand_idle_2"}
    assert _named(library, Role.APPLAUD) == {"sit_clap", "clap"}
    assert _named(library, Role.CHEER) == {"cheer", "cheer_2", "jump", "wave"}
    assert _named(library, Role.DISMAY) == {"dismay"}
    innate = _innate(library)
    assert set(innate) == {
        "sit_idle", "sit_idle_2", "stand_idle", "stand_idle_2", "sit_clap", "clap", "wave"
    }  # fmt: skip
    assert innate["sit_idle"] == innate["sit_idle_2"] == pytest.approx(60 / 145.5)


def test_what_the_spectator_does_by_itself() -> None:
    """Motions that need a reason are nobody's by accident, and the roles keep their shares."""
    library = sort_motions(builtin_spectator().clips)
    innate = _innate(library)
    kinds = {"sit_idle", "stand_idle", "sit_clap", "clap", "wave"}
    assert {re.sub(r"_\d+$", "", name) for name in innate} == kinds
    share = {
        kind: sum(w for name, w in innate.items() if re.fullmatch(rf"{kind}(_\d+)?", name))
        for kind in kinds
    }
    assert share == pytest.approx(
        {"sit_idle": 120 / 145.5, "stand_idle": 20 / 145.5, "sit_clap": 3 / 145.5,
         "clap": 1 / 145.5, "wave": 1.5 / 145.5}
    )  # fmt: skip
    assert {re.sub(r"_\d+$", "", name) for name in library.names} == {
        *kinds, "cheer", "fist_pump", "jump", "dismay", "disappointed"
    }  # fmt: skip
    sizes = {role: len(motions) for role, motions in library.roles.items()}
    assert sizes == {Role.CALM: 10, Role.APPLAUD: 8, Role.CHEER: 16, Role.DISMAY: 5}


@pytest.mark.parametrize(("most", "left"), [(None, 39), (64, 39), (16, 16), (10, 10), (1, 10)])
def test_with_few_streams_variants_are_left_out(most: int | None, left: int) -> None:
    library = sort_motions(builtin_spectator().clips, most)
    assert len(library.names) == left
    assert {"sit_idle", "stand_idle", "clap", "sit_clap", "cheer", "jump"} <= set(library.names)
    assert all(len(motions) for motions in library.roles.values())
    assert library.innate.sum() == pytest.approx(1.0)
    assert sum(
        float(w)
        for name, w in zip(library.names, library.innate, strict=True)
        if "sit_idle" in name
    ) == pytest.approx(120 / 145.5)
    numbers = [int(n) for name in library.names for n in re.findall(r"_(\d+)$", name)]
    assert max(numbers, default=1) <= (2 if left == 16 else 5)


@pytest.mark.parametrize("name", ["", "clip 0", "Take 001", "Death", "Cheer", "sit_idle", "No"])
@pytest.mark.parametrize("looping", [True, False])
def test_a_single_clip_is_used_for_everything(
    factories: ModuleType, name: str, looping: bool
) -> None:
    library = _sort(factories, [name], once=() if looping else (name,))
    assert library.names == (name,)
    assert library.innate.tolist() == [1.0]
    assert all(library.roles[role].tolist() == [0] for role in Role)


def test_of_unknown_clips_the_first_is_calm_and_the_second_cheers(factories: ModuleType) -> None:
    library = _sort(factories, ["Take 001", "Take 002", "Take 003"])
    assert _innate(library) == {"Take 001": 1.0}
    assert _named(library, Role.CHEER) == _named(library, Role.APPLAUD) == {"Take 002"}
    assert _named(library, Role.DISMAY) == {"Take 001"}


def test_no_clips_are_refused() -> None:
    with pytest.raises(ValueError, match="at least one clip"):
        sort_motions([])


@given(
    st.lists(
        st.sampled_from([*KAYKIT.split(), *ROBOT.split(), *BUILT_IN.split()]),
        min_size=1,
        max_size=8,
        unique=True,
    )
)
def test_every_role_has_motions_and_shares_sum_to_one(
    factories: ModuleType, names: list[str]
) -> None:
    library = _sort(factories, names)
    assert library.innate.sum() == pytest.approx(1.0)
    assert (library.innate >= 0).all()
    for role in Role:
        motions = library.roles[role]
        assert len(motions) > 0
        assert motions.dtype == np.int16
        assert ((motions >= 0) & (motions < len(library.names))).all()
    rng = np.random.default_rng(1)
    drawn = np.bincount(library.draw_innate(2000, rng), minlength=len(library.names)) / 2000
    np.testing.assert_allclose(drawn, library.innate, atol=0.05)
    assert not drawn[library.innate == 0].any()
    cheers = library.draw(Role.CHEER, 200, rng)
    assert set(cheers.tolist()) == set(library.roles[Role.CHEER].tolist())


def _clips(factories: ModuleType) -> list[Clip]:
    return list(factories.make_character(BUILT_IN.split()).clips)


def _start(factories: ModuleType, streams: int) -> tuple[StreamPool, MotionLibrary, MotionStreams]:
    clips = _clips(factories)
    pool = StreamPool(factories.make_body(), ClipBank(factories.make_body(), clips), capacity=256)
    library = sort_motions(clips)
    return pool, library, start_streams(pool, library, streams, np.random.default_rng(2))


@settings(max_examples=25, deadline=None)
@given(st.one_of(st.integers(1, 30), st.integers(1, 256)))
def test_every_motion_is_playable_with_any_number_of_streams(
    factories: ModuleType, streams: int
) -> None:
    pool, library, shared = _start(factories, streams)
    motions = len(library.names)
    assert int(pool.alive.sum()) == streams
    assert (shared.count >= 1).all()
    assert (shared.first >= 0).all()
    assert (shared.first + shared.count <= streams).all()
    rows = shared.draw_rows(
        np.repeat(np.arange(motions, dtype=np.int16), 50), np.zeros(50 * motions, np.uint8), _rng()
    )
    assert pool.alive[rows].all()
    if streams >= motions:
        assert shared.count.sum() == streams
        played = np.repeat(np.arange(motions), 50)
        np.testing.assert_array_equal(pool.clip[rows], library.clips[played])


def _rng() -> np.random.Generator:
    return np.random.default_rng(9)


def test_fewer_streams_than_motions_go_to_the_first_motions(factories: ModuleType) -> None:
    pool, library, shared = _start(factories, 3)
    assert pool.clip[:3].tolist() == library.clips[:3].tolist()
    assert shared.first.tolist() == [k % 3 for k in range(len(library.names))]
    assert shared.count.tolist() == [1] * len(library.names)


def test_as_many_streams_as_motions_are_one_each(factories: ModuleType) -> None:
    _, library, shared = _start(factories, 11)
    assert len(library.names) == 11
    assert shared.count.tolist() == [1] * 11
    assert shared.first.tolist() == list(range(11))


def test_motions_that_are_wanted_more_get_more_streams(factories: ModuleType) -> None:
    pool, library, shared = _start(factories, 256)
    count = dict(zip(library.names, shared.count.tolist(), strict=True))
    # Half by innate share (60 / 145.5), half evenly over 11 motions: 52.8 + 11.6.
    assert count["sit_idle"] == pytest.approx(64, abs=2)
    assert count["dismay"] == pytest.approx(11.6, abs=2)
    assert 0.92 <= pool.speed[:256].min() < 0.94
    assert 1.06 < pool.speed[:256].max() <= 1.08
    cheering = pool.time[pool.clip == library.clips[library.names.index("cheer")]]
    assert len(np.unique(cheering)) == len(cheering)


def test_all_streams_of_a_motion_are_drawn(factories: ModuleType) -> None:
    _, library, shared = _start(factories, 64)
    motion = library.names.index("sit_idle")
    rows = shared.draw_rows(np.full(2000, motion, np.int16), np.zeros(2000, np.uint8), _rng())
    first, count = int(shared.first[motion]), int(shared.count[motion])
    assert sorted(set(rows.tolist())) == list(range(first, first + count))

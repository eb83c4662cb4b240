"""The lab: every station does what its caption says, and the captions can be read."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from itertools import combinations, pairwise
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageFont

import tifo
from tifo.demo_game.app import Show, make_scene
from tifo.demo_game.captions import (
    TEXT,
    TITLE,
    Caption,
    PlacedCaption,
    draw_captions,
    place_captions,
    text_unit,
)
from tifo.demo_game.lab import SPREAD, Lab
from tifo.demo_game.lab_bodies import BodyStation, LookStation, OverlayStation, PartStation
from tifo.demo_game.lab_motions import BlendSpaceStation, MachineStation, MaskStation
from tifo.demo_game.lab_station import Station
from tifo.demo_game.lab_time import DilatedStation, EntryStation, InStepStation, InterruptedStation

SECONDS = 6
SIZE = (1280, 720)


@pytest.fixture(scope="module")
def lab() -> Iterator[Lab]:
    """The lab after six seconds, as its picture shows it."""
    made = Lab()
    for _ in range(30 * SECONDS):
        made.simulation.run(seconds=1 / 30)
        made.advance(1 / 30)
    yield made
    made.simulation.close()


def find(lab: Lab, kind: type[Station]) -> Station:
    return next(station for station in lab.stations if type(station) is kind)


def joints(lab: Lab, station: Station, *names: str) -> np.ndarray:
    """(K, n, 3) places of joints as the agents show them, model space."""
    crowd = lab.simulation.crowd
    skeleton = crowd.character.skeleton
    inverse = np.tile(np.eye(4), (skeleton.joint_count, 1, 1))
    inverse[:, :3] = skeleton.inverse_bind
    bind = np.linalg.inv(inverse)[:, :, 3]
    palettes = crowd.palettes(station.agents, lab.simulation.clock.pose_tick)
    which = [skeleton.index(name) for name in names]
    return np.einsum("kjrc,jc->kjr", palettes[:, which], bind[which])


HANDS, FEET = ("hand_l", "hand_r"), ("foot_l", "foot_r", "toe_l", "toe_r")


def test_the_blend_space_raises_hands_step_by_step(lab: Lab) -> None:
    station = find(lab, BlendSpaceStation)
    assert station.labels() == ["0.00", "0.25", "0.50", "0.75", "1.00"]
    height = joints(lab, station, *HANDS)[:, :, 1].mean(axis=1)
    assert (np.diff(height) > 0.05).all()


def test_masks_keep_the_legs_and_change_the_rest(lab: Lab) -> None:
    station = find(lab, MaskStation)
    feet, hands = joints(lab, station, *FEET), joints(lab, station, *HANDS)
    np.testing.assert_allclose(feet, np.broadcast_to(feet[0], feet.shape), atol=1e-5)
    for one, other in combinations(range(len(hands)), 2):
        assert np.abs(hands[one] - hands[other]).max() > 0.1, (one, other)


def test_the_machines_are_in_different_states_and_go_on(lab: Lab) -> None:
    station = find(lab, MachineStation)
    names = [name for name, _ in MachineStation.STATES]
    labels = list(station.labels())
    assert sorted(labels) == sorted(names)
    # The order round the machine is kept: each is one state behind its right neighbour.
    turns = {(names.index(b) - names.index(a)) % len(names) for a, b in pairwise(labels)}
    assert turns == {1}
    hips = joints(lab, station, "hips")[:, 0, 1]
    assert hips[labels.index("sit")] < 0.75 * hips[labels.index("stand")]


def test_one_stream_is_in_step_and_dilation_spreads(lab: Lab) -> None:
    step, drifted = find(lab, InStepStation), find(lab, DilatedStation)
    assert isinstance(step, InStepStation)
    assert isinstance(drifted, DilatedStation)
    hands = joints(lab, step, *HANDS)
    np.testing.assert_allclose(hands, np.broadcast_to(hands[0], hands.shape), atol=1e-6)
    assert (step.offsets() == 0).all()
    np.testing.assert_allclose(drifted.offsets(), SPREAD)
    assert step.labels() == ["0"] * 3
    hips = joints(lab, drifted, "hips")[:, 0, 1]
    assert np.ptp(hips) > 0.1  # some jump, some land
    np.testing.assert_allclose(hips[0], joints(lab, step, "hips")[0, 0, 1], atol=1e-5)


def test_who_was_told_first_is_up_first(lab: Lab) -> None:
    station = find(lab, EntryStation)
    crowd = lab.simulation.crowd
    shown = [crowd.library.names[k] for k in crowd.motion.shown[station.agents]]
    assert shown[:2] == ["stand_up"] * 2
    assert list(station.labels()) == ["0.2 s ago", "0.7 s ago", "1.2 s ago"]
    height = joints(lab, station, "head")[:, 0, 1]
    assert height[2] > height[1] + 0.1
    # The streams never stopped: agents are on them where the clip began when they were told.
    assert crowd.pool is not None
    assert crowd.pool.running[crowd.anim.row[0, station.agents[:2]]].all()  # type: ignore[union-attr]


def test_slots_hold_snapshots_of_the_interrupted(lab: Lab) -> None:
    station = find(lab, InterruptedStation)
    assert isinstance(station, InterruptedStation)
    crowd = lab.simulation.crowd
    assert crowd.pool is not None
    assert crowd.transition is not None
    # Their blends come from static rows behind bind pose and uniques, which no stream writes.
    source = crowd.transition.row[0, station.agents]
    assert (source > crowd.pool.store.bind_row).all()
    assert len(set(source.tolist())) == len(source)
    shares = station.shares()
    assert (np.diff(shares) > 0.1).all()
    assert 0 < shares.min() < shares.max() < 1
    assert crowd.blend_counts.total.snapshot > 5 * SECONDS


def test_overlays_leave_the_rest_of_the_seated_alone(lab: Lab) -> None:
    station = find(lab, OverlayStation)
    crowd = lab.simulation.crowd
    assert crowd.overlays is not None
    masks = crowd.overlays.masks
    numbers = crowd.overlays.columns.mask[0, station.agents]
    assert [masks.names[k] for k in numbers] == ["arm_r", "arms", "upper_body"]
    hips, hands = joints(lab, station, "hips")[:, 0, 1], joints(lab, station, *HANDS)
    stand = joints(lab, find(lab, BodyStation), "hips")[0, 0, 1]
    assert (hips < 0.75 * stand).all()
    assert hands[0, 1, 1] > hands[0, 0, 1] + 0.3  # waves with the right
    assert np.linalg.norm(hands[1, 0] - hands[1, 1]) < 0.4  # claps
    assert (hands[2, :, 1] > hips[2] + 0.4).all()  # hands to the head


def test_everybody_has_one_part(lab: Lab) -> None:
    station = find(lab, PartStation)
    crowd = lab.simulation.crowd
    for agent, name in zip(station.agents, station.labels(), strict=True):
        assert np.flatnonzero(crowd.parts[name].visible).tolist() == [agent]
    assert station.text == "with 1, 5 and 11 joints of their own"


def test_heads_turn_to_the_ball(lab: Lab) -> None:
    station = find(lab, LookStation)
    assert isinstance(station, LookStation)
    turns = station.turns()
    places = lab.simulation.crowd.placement.position[:, station.agents].T
    aside = station.ball[0] - places[:, 0]
    assert (np.sign(turns) == np.sign(aside)).all()
    assert (np.abs(turns) > 0.1).all()
    ball = lab.simulation.crowd.parts["ball"]
    shown = ball.palettes(station.agents[:1], lab.simulation.clock.pose_tick)[0, 0, :, 3]
    scale = lab.simulation.crowd.placement.scale[station.agents[0]]
    # A live pose is shown a tick late, so the ball lags by what it moves in two ticks.
    np.testing.assert_allclose(places[0] + scale * shown, station.ball, atol=0.15)


def test_bodies_differ_in_bones_size_and_girth(lab: Lab) -> None:
    station = find(lab, BodyStation)
    crowd = lab.simulation.crowd
    assert crowd.pool is not None
    assert crowd.anim is not None
    rows = crowd.anim.row[0, station.agents]
    assert [int(k) for k in crowd.pool.twins.kind[rows]] == [0, 1, 2, 0, 0]
    assert len(set(rows[[0, 3, 4]].tolist())) == 1
    head = joints(lab, station, "head")[:, 0, 1] * crowd.placement.scale[station.agents]
    assert head[1] < 0.8 * head[0]
    assert head[2] < head[0]
    girth = crowd.body.girth[station.agents]
    assert girth[4] > girth[0] > girth[3]


@pytest.mark.parametrize("size", [SIZE, (1600, 900), (1000, 1000)])
def test_captions_and_people_are_whole_and_apart(lab: Lab, size: tuple[int, int]) -> None:
    camera, captions = lab.camera("tv", size), lab.captions()
    placed = place_captions(captions, camera, size)
    assert len(placed) == len(captions)
    title, text = (
        ImageFont.load_default(round(share * text_unit(size))) for share in (TITLE, TEXT)
    )
    plates = []
    for caption in placed:
        if caption.title:
            wide = max(title.getlength(caption.title), text.getlength(caption.text))
            plates.append((caption.x - 0.5 * wide, caption.x + 0.5 * wide, caption.y))
    assert len(plates) == len(lab.stations)
    for left, right, y in plates:
        assert left > 0
        assert right < size[0]
        assert y < 0.96 * size[1]
    if size[0] > size[1]:
        for one, other in combinations(plates, 2):
            assert one[1] < other[0] or other[1] < one[0] or abs(one[2] - other[2]) > 50
    # Nobody is cut off: feet, and hands raised over the head.
    position = lab.simulation.crowd.placement.position.T
    for lift in (0.0, 2.2):
        places = [Caption((x, y + lift, z), "", "") for x, y, z in position.tolist()]
        assert len(place_captions(places, camera, size)) == len(places)


def test_a_caption_is_below_its_place() -> None:
    camera = tifo.FreeCamera.looking((0.0, 0.0, 10.0), (0.0, 0.0, 0.0))
    words = [Caption((0.0, 0.0, 0.0), "", "here"), Caption((0.0, 0.0, 20.0), "", "behind")]
    (placed,) = place_captions(words, camera, (200, 100))
    assert (placed.x, placed.y) == pytest.approx((100.0, 50.0))
    pixels = np.full((100, 200, 3), 90, np.uint8)
    drawn = draw_captions(pixels, [placed])
    changed = np.argwhere((drawn != 90).any(axis=2))
    assert changed[:, 0].min() >= 47
    assert changed[:, 1].mean() == pytest.approx(100, abs=3)
    assert (pixels == 90).all()
    plate = draw_captions(pixels, [PlacedCaption(5.0, 50.0, "at the border", "moved inside")])
    assert (plate[60, 0:40] != 90).any()


def test_the_lab_takes_no_other_character() -> None:
    spec = tifo.CrowdSpec(character="knight.glb")
    show = Show(spec, None, SIZE, "tv", None, None, None, scene="lab")
    with pytest.raises(ValueError, match="built-in spectator"):
        make_scene(show)


@pytest.mark.gl
def test_the_command_draws_the_lab(tmp_path: Path) -> None:
    file = tmp_path / "lab.png"
    words = ("demo", "--scene", "lab", "--headless", "--size", "480x270", "--seconds", "0.1")
    done = subprocess.run(
        [sys.executable, "-m", "tifo", *words, "--screenshot", str(file)],
        capture_output=True,
        text=True,
        timeout=120,
        cwd=Path(__file__).resolve().parents[2],
    )
    assert done.returncode == 0, done.stderr
    picture = np.asarray(Image.open(file)).astype(int)
    assert picture.shape == (270, 480, 3)
    # The plates of the captions are nearly black and blue, which nothing else is.
    plates = (np.abs(picture - (22, 30, 43)) < 14).all(axis=2)
    assert plates.mean() > 0.03

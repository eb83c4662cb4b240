"""Bodies: who is a child, what a morph does, and how a small body sits on a seat."""

from __future__ import annotations

import numpy as np
import pytest

from tifo.engine.assets.spectator import builtin_spectator
from tifo.engine.crowd.body_types import make_body_types
from tifo.engine.crowd.builds import GIRTH_RANGE, draw_bodies
from tifo.engine.crowd.figure import make_figure
from tifo.engine.crowd.morphs import morph_weights, morphed_positions
from tifo.engine.crowd.physique import SeatHeights, seat_lift
from tifo.engine.crowd.twin_streams import affordable_streams
from tifo.engine.streams.pool import bind_positions


def test_shares_sizes_and_girths() -> None:
    body, scale = draw_bodies(50_000, 0.1, 0.2, 1.75, np.random.default_rng(1))
    share = np.bincount(body.kind, minlength=3) / 50_000
    np.testing.assert_allclose(share, [0.7, 0.1, 0.2], atol=0.01)
    mean = [scale[body.kind == kind].mean() for kind in range(3)]
    np.testing.assert_allclose(mean, [1.0, 0.72, 0.97], atol=0.005)
    assert GIRTH_RANGE[0] <= body.girth.min() < -0.015
    assert 0.06 < body.girth.max() <= GIRTH_RANGE[1] + 1e-6


def test_children_have_larger_heads_and_shorter_legs() -> None:
    character = builtin_spectator()
    skeleton, figure = character.skeleton, make_figure(character)
    types = {kind.name: kind for kind in make_body_types(skeleton, figure)}
    assert set(types) == {"child", "old"}
    child = types["child"]
    of = skeleton.index
    assert child.flesh[of("head")] == pytest.approx(1.24)
    assert child.bones[of("lower_leg_l")] == child.bones[of("foot_r")] == np.float32(0.91)
    # Hips stand as high as the legs are long, so that feet stay on the ground.
    assert child.bones[of("hips")] == np.float32(0.91)
    assert child.bones[of("lower_arm_l")] == np.float32(0.93)
    for name in ("upper_arm", "hand", "lower_leg", "toe"):
        left, right = of(f"{name}_l"), of(f"{name}_r")
        assert child.bones[left] == child.bones[right]
        assert child.flesh[left] == child.flesh[right]


def test_a_morph_widens_the_waist_and_leaves_hands_and_face() -> None:
    character = builtin_spectator()
    skeleton, figure = character.skeleton, make_figure(character)
    weights = morph_weights(skeleton, figure)
    places = bind_positions(skeleton)
    widest = {"waist": 0.0, "hand": 0.0, "head": 0.0}
    for mesh in character.meshes:
        moved = np.linalg.norm(morphed_positions(mesh, weights, 0.06, 0.0) - mesh.positions, axis=1)
        owner = mesh.joints[np.arange(len(moved)), mesh.weights.argmax(axis=1)]
        for name, joints in (
            ("waist", ("spine", "hips")),
            ("hand", ("hand_l", "fingers_r")),
            ("head", ("head",)),
        ):
            here = np.isin(owner, [skeleton.index(j) for j in joints]) & (
                mesh.weights.max(axis=1) > 0.99
            )
            widest[name] = max(widest[name], float(moved[here].max(initial=0.0)))
    assert widest["waist"] == pytest.approx(0.06, rel=0.05)
    assert widest["hand"] == widest["head"] == 0.0
    head = places[skeleton.index("head")]
    for mesh in character.meshes:
        whole = weights.of(mesh)[:, 1] == 1.0
        grown = morphed_positions(mesh, weights, 0.0, 0.1)[whole] - head
        np.testing.assert_allclose(grown, 1.1 * (mesh.positions[whole] - head), atol=1e-6)
    assert any((weights.of(mesh)[:, 1] == 1.0).any() for mesh in character.meshes)


def test_small_people_sit_on_the_seat_and_stand_on_the_ground() -> None:
    seats = SeatHeights(sitting=0.5, standing=0.95, seat=0.5)
    scale, legs = np.array([0.7, 0.7, 1.0, 1.1], np.float32), np.ones(4, np.float32)
    hips = np.array([0.5, 0.95, 0.5, 0.5], np.float32)
    lift = seat_lift(hips, scale, legs, seats)
    np.testing.assert_allclose(lift, [0.15, 0.0, 0.0, -0.05], atol=1e-6)
    # A child's own motions have its hips lower: 0.455 of its own height when it sits.
    (child,) = seat_lift(
        np.array([0.455], np.float32), scale[:1], np.array([0.91], np.float32), seats
    )
    assert child == pytest.approx(0.5 - 0.7 * 0.455, abs=1e-6)


@pytest.mark.parametrize(
    ("rows", "motions", "whole", "types", "own"),
    [
        (256, 13, 6, 2, 148),
        (64, 13, 6, 2, 20),
        (64, 16, 6, 2, 0),
        (256, 13, 0, 0, 256),
        (100, 13, 0, 2, 62),
    ],
)
def test_as_many_streams_as_leave_room_for_twins(
    rows: int, motions: int, whole: int, types: int, own: int
) -> None:
    assert affordable_streams(rows, motions, whole, types) == own

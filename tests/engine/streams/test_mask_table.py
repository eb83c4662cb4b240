"""Masks, anchors, and how a masked subtree is hung up again on the body."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tifo.engine.animation.controllers import Mask
from tifo.engine.streams.mask_table import MaskTable, lay_over

PARENTS = (-1, 0, 0, 1, 1, 3, 3, 4)


def random_pose(rng: np.random.Generator) -> tuple[Any, Any, Any]:
    count = len(PARENTS)
    q = rng.normal(size=(count, 4))
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    return q, rng.normal(size=(count, 3)), rng.uniform(0.6, 1.5, (count, 3))


def test_anchors_are_the_nearest_joints_that_are_left_alone(factories: ModuleType) -> None:
    table = MaskTable(factories.make_body())
    table.add("arms", Mask({"hand_l": 1.0, "hand_r": 0.5}))
    assert table.add("upper", {"chest": 0.5, "head": 1.0}) == 1
    assert table.add("everything", {"hips": 1.0}) == 2
    names = table.skeleton.names
    of = {name: names.index(name) for name in names}
    arms, upper, everything = table.weights
    assert (arms[of["hand_l"]], arms[of["hand_r"]], arms[of["head"]]) == (1.0, 0.5, 0.0)
    assert table.anchors[0, of["hand_r"]] == of["chest"]
    # The hands lie under the chest, so they hang from the hips like it.
    assert upper[of["hand_l"]] == 0.5
    assert table.anchors[1, of["hand_l"]] == of["hips"]
    np.testing.assert_array_equal(everything, 1.0)
    np.testing.assert_array_equal(table.anchors[2], -1)


@pytest.mark.parametrize(
    ("name", "mask", "said"),
    [
        ("a", {"chest": 1.0}, "already"),
        ("b", {"chst": 1.0}, "chest"),
        ("b", {"chest": 1.5}, r"chest.*1\.5"),
        ("b", {"chest": float("nan")}, "nan"),
        ("b", {"chest": 0.0}, "no joint"),
        ("b", {}, "empty"),
    ],
)
def test_masks_that_cannot_be(
    factories: ModuleType, name: str, mask: dict[str, float], said: str
) -> None:
    table = MaskTable(factories.make_body())
    table.add("a", {"head": 1.0})
    with pytest.raises(ValueError, match=said):
        table.add(name, mask)
    assert table.names == ("a",)


@given(seed=st.integers(0, 2**32 - 1), chosen=st.sets(st.integers(1, 7), min_size=1))
@settings(max_examples=40, deadline=None)
def test_laying_over_keeps_every_limb_on_its_body(
    seed: int, chosen: set[int], factories: ModuleType
) -> None:
    """In model matrices: M'_j = M_p (local of the overlay from p to j), joint by joint."""
    rng = np.random.default_rng(seed)
    rest = random_pose(rng)
    skeleton = factories.make_skeleton(PARENTS, rest[1], rest[0], rest[2])
    table = MaskTable(skeleton)
    table.add("some", {skeleton.names[joint]: 1.0 for joint in chosen})
    poses = [random_pose(rng) for _ in range(2)]
    body, over = (factories.reference_models(PARENTS, *pose) for pose in poses)
    expected = body.copy()
    for joint, parent in enumerate(PARENTS):
        if table.weights[0, joint] > 0:
            local = over[joint] if parent < 0 else np.linalg.inv(over[parent]) @ over[joint]
            expected[joint] = local if parent < 0 else expected[parent] @ local
    bind = np.tile(np.eye(4), (len(PARENTS), 1, 1))
    bind[:, :3] = skeleton.inverse_bind

    def palettes(models: Any) -> Any:
        return (models @ bind)[None, :, :3].astype(np.float32)

    shown = lay_over(palettes(body), palettes(over), table.weights[:1], table.anchors[:1])
    scale = max(1.0, float(np.abs(palettes(expected)).max()))
    np.testing.assert_allclose(shown, palettes(expected), rtol=0, atol=3e-4 * scale)
    half = lay_over(palettes(body), palettes(over), 0.5 * table.weights[:1], table.anchors[:1])
    np.testing.assert_allclose(half, 0.5 * (palettes(body) + shown), rtol=0, atol=1e-4 * scale)

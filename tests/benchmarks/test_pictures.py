"""The pictures of docs/: they are made of what the objects say, and lie there as they are drawn."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from tifo.benchmarks.pictures.__main__ import PICTURES, main
from tifo.benchmarks.pictures.blend_space import OUTSIDE, SPACE, nearest_on_hull, shares_at
from tifo.benchmarks.pictures.canvas import BLUE, GROUND, Canvas
from tifo.benchmarks.pictures.figures import joint_places
from tifo.benchmarks.pictures.machine import FAN
from tifo.benchmarks.pictures.overlay import make_poses
from tifo.benchmarks.pictures.reactions import SIZE, head_places, make_stand, run_to
from tifo.benchmarks.pictures.ring import DRIFT_TO, DRIFTER, HISTORY, make_crowd, offsets
from tifo.engine.animation.clip_bank import ClipBank
from tifo.engine.animation.controllers import ClipNode
from tifo.engine.animation.controllers.triangulation import triangulate
from tifo.engine.assets.spectator import builtin_spectator
from tifo.engine.streams.pool import StreamPool

DOCS = Path(__file__).resolve().parents[2] / "docs"
DRAWN = ("blend_space", "state_machine", "ring", "overlay")
"""Those that are drawn without OpenGL."""


@pytest.mark.parametrize("name", DRAWN)
def test_pictures_are_written_and_lie_in_docs(name: str, tmp_path: Path) -> None:
    main(["--to", str(tmp_path), name])
    with Image.open(tmp_path / f"{name}.png") as drawn, Image.open(DOCS / f"{name}.png") as kept:
        assert drawn.size == kept.size
        assert 800 <= drawn.width <= 1000
        pixels, before = np.asarray(drawn).astype(int), np.asarray(kept).astype(int)
    assert 0.01 < (np.abs(pixels - GROUND).max(axis=2) > 30).mean() < 0.6
    # Fonts and libraries differ a little between machines.
    assert np.abs(pixels - before).mean() < 1.0


def test_every_picture_lies_in_docs() -> None:
    sizes = {name: (DOCS / f"{name}.png").stat().st_size for name in PICTURES}
    assert min(sizes.values()) > 20_000
    assert sum(sizes.values()) < 8_000_000


def test_an_unknown_picture_is_named(capsys: Any) -> None:
    with pytest.raises(SystemExit):
        main(["moon"])
    assert "there is no picture 'moon'" in capsys.readouterr().err


def test_the_shares_in_the_blend_space_are_those_that_are_evaluated() -> None:
    points = np.array([at for at, _ in SPACE.points])
    corners, shares = shares_at(points, triangulate(points), np.array(SPACE.position))
    assert (shares > 0).all()
    np.testing.assert_allclose(shares @ points[corners], SPACE.position, atol=1e-12)
    # Translations are blended linearly, so the hips of the space are the mean of the clips'.
    spectator = builtin_spectator()
    pool = StreamPool(spectator.skeleton, ClipBank(spectator.skeleton, spectator.clips), capacity=4)
    rows = [pool.add(SPACE.points[int(corner)][1], time=0.3).row for corner in corners]
    rows.append(pool.add(SPACE, time=0.3).row)
    pool.evaluate(1)
    store, hips = pool.store, spectator.skeleton.index("hips")
    markers = store.ring[store.slice_of(1), rows][:, hips]
    bind = np.append(np.linalg.inv(_square(spectator.skeleton.inverse_bind[hips]))[:3, 3], 1.0)
    places = markers @ bind
    np.testing.assert_allclose(places[3], shares @ places[:3], atol=1e-4)


def test_the_hulls_nearest_point() -> None:
    points = np.array([at for at, _ in SPACE.points])
    triangles = triangulate(points)
    found = nearest_on_hull(points, triangles, np.array(OUTSIDE))
    # Brute force over all pairs: no point of a line between two points that is outside is nearer.
    share = np.linspace(0.0, 1.0, 401)[:, None, None, None]
    lines = points[:, None] * (1 - share) + points[None] * share
    assert np.linalg.norm(found - OUTSIDE) <= np.linalg.norm(lines - OUTSIDE, axis=-1).min() + 1e-9
    np.testing.assert_allclose(found, points[5] + (found[1] - 0.6) / -1.1 * (points[6] - points[5]))


def test_the_machine_is_that_of_the_page() -> None:
    page = (DOCS / "controllers.md").read_text("utf-8")
    names: dict[str, Any] = {}
    exec(re.findall(r"```python\n(.*?)```", page, re.DOTALL)[1], names)
    fan = names["fan"]
    assert list(fan.states) == list(FAN.states)
    assert fan.transitions == FAN.transitions
    for name, node in fan.states.items():
        assert isinstance(node, ClipNode)
        assert node.clip == FAN.states[name].clip  # type: ignore[attr-defined]


def test_the_ring_shows_agents_where_they_are() -> None:
    simulation, stream = make_crowd()
    agents, behind = offsets(simulation, stream)
    assert len(agents) == 36
    assert behind.min() >= 0
    assert behind.max() <= HISTORY - 2
    assert np.ptp(behind) > 30
    assert 20.0 < behind[DRIFTER] < DRIFT_TO  # on its way
    before = behind[DRIFTER]
    simulation.run(seconds=1 / 30)
    # 24 poses in 4 s of 30 ticks.
    assert offsets(simulation, stream)[1][DRIFTER] - before == pytest.approx(24 / 120, abs=1e-4)
    simulation.run(seconds=4.0)
    assert offsets(simulation, stream)[1][DRIFTER] == DRIFT_TO
    simulation.close()


def test_the_overlays_parts_come_from_where_the_mask_says() -> None:
    simulation, palettes, weights = make_poses()
    skeleton = simulation.crowd.character.skeleton
    body, _, shown = (joint_places(skeleton, pose) for pose in palettes)
    untouched = np.append(weights == 0, False)
    np.testing.assert_allclose(shown[untouched], body[untouched], atol=1e-5)
    hand = skeleton.index("hand_r")
    assert weights[hand] == 1
    assert np.linalg.norm(shown[hand] - body[hand]) > 0.3
    simulation.close()


def test_a_canvas_is_smooth() -> None:
    canvas = Canvas(40, 40)
    canvas.disc((20, 20), 10, BLUE)
    pixels = np.asarray(canvas.finish()).astype(int)
    covered = (np.array(GROUND) - pixels)[..., 0].sum() / (GROUND[0] - BLUE[0])
    assert covered == pytest.approx(np.pi * 100, rel=0.04)
    assert len(np.unique(pixels[..., 0])) > 8
    canvas.line([(2, 2), (38, 2)], BLUE, 2, dashed=True)
    dashes = np.asarray(canvas.finish())[2, :, 0]
    assert (dashes == GROUND[0]).any()
    assert (dashes < BLUE[0] + 20).any()


def _square(rows: np.ndarray) -> np.ndarray:
    return np.vstack([rows, [0, 0, 0, 1]])


def test_pictures_of_reactions_lie_in_docs() -> None:
    for name, rows in (("before_and_after", 2), ("long_and_short", 2), ("one_side", 1)):
        with Image.open(DOCS / f"{name}.png") as kept:
            assert kept.width == SIZE[0]
            assert kept.height >= rows * SIZE[1]


@pytest.mark.gl
def test_circles_are_round_heads(gl: Any) -> None:
    """The head of somebody who sits is about 1.25 m above the tread, of who stands about 1.6."""
    simulation = make_stand(rows=2, columns=12, children=0.0, props=0.0)
    run_to(simulation, 10)
    crowd = simulation.crowd
    sits = np.flatnonzero(crowd.behaviour.posture == 0)
    feet = crowd.placement.position[:, sits].T
    head = head_places(simulation, sits) - feet
    assert 1.0 < np.median(head[:, 1]) < 1.4
    assert np.hypot(head[:, 0], head[:, 2]).max() < 0.8
    before = np.median(head[:, 1])
    assert run_to(simulation, 205)[-1] > 0.9
    after = head_places(simulation, sits) - feet
    assert np.median(after[:, 1]) > before + 0.25
    simulation.close()

"""The static geometry: sound triangles, true to the seats and to the Laws of the Game."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.engine.crowd.bowl import build_bowl
from tifo.engine.crowd.cameras import HALF_HEIGHT, HALF_WIDTH, camera_presets
from tifo.engine.crowd.seating import SeatPlan
from tifo.engine.crowd.stadium import build_stadium_mesh
from tifo.engine.crowd.stadium_mesh import MeshBuilder, StadiumMesh, Surface
from tifo.engine.crowd.stand import build_stand

PLANS = {
    "bowl 1": lambda: build_bowl(1),
    "bowl 3000": lambda: build_bowl(3_000),
    "bowl 12000": lambda: build_bowl(12_000),
    "bowl 65000": lambda: build_bowl(65_000),
    "stand 1x1": lambda: build_stand(1, 1),
    "stand 10x20": lambda: build_stand(10, 20),
}


@pytest.fixture(scope="module", params=PLANS)
def stadium(request: pytest.FixtureRequest) -> tuple[SeatPlan, StadiumMesh]:
    plan = PLANS[request.param]()
    return plan, build_stadium_mesh(plan)


@pytest.fixture(scope="module")
def large() -> tuple[SeatPlan, StadiumMesh]:
    plan = build_bowl(65_000)
    return plan, build_stadium_mesh(plan)


def faces(mesh: StadiumMesh) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(T, 3) cross products and (T,) areas."""
    a, b, c = (mesh.positions[mesh.triangles[:, i]].astype(np.float64) for i in range(3))
    cross = np.cross(b - a, c - a)
    return cross, 0.5 * np.linalg.norm(cross, axis=1)


def of(mesh: StadiumMesh, surface: Surface) -> NDArray[np.bool_]:
    """(T,) mask of a surface's triangles."""
    return np.asarray(mesh.surface[mesh.triangles[:, 0]] == surface)


def test_arrays(stadium: tuple[SeatPlan, StadiumMesh]) -> None:
    _, mesh = stadium
    count = len(mesh.positions)
    assert mesh.positions.shape == mesh.normals.shape == (count, 3)
    assert mesh.positions.dtype == mesh.normals.dtype == mesh.uvs.dtype == np.float32
    assert mesh.uvs.shape == (count, 2)
    assert mesh.colors.shape == (count, 4)
    assert mesh.colors.dtype == mesh.surface.dtype == np.uint8
    assert (mesh.colors[:, 3] == 255).all()
    assert mesh.surface.shape == (count,)
    assert mesh.triangles.dtype == np.uint32
    assert mesh.triangles.max() == count - 1
    assert np.isfinite(mesh.positions).all()
    assert np.isfinite(mesh.uvs).all()
    assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1.0, abs=1e-5)
    assert (mesh.surface[mesh.triangles] == mesh.surface[mesh.triangles[:, :1]]).all()
    assert len(np.unique(mesh.triangles)) == count


def test_windings_agree_with_normals(stadium: tuple[SeatPlan, StadiumMesh]) -> None:
    _, mesh = stadium
    cross, area = faces(mesh)
    assert area.min() > 0.0
    unit = cross / (2.0 * area[:, None])
    along = np.einsum("tc,tkc->tk", unit, mesh.normals[mesh.triangles])
    assert along.min() > 0.85


def test_triangle_budget(large: tuple[SeatPlan, StadiumMesh]) -> None:
    assert len(large[1].triangles) < 150_000


def test_pitch_has_its_area(large: tuple[SeatPlan, StadiumMesh]) -> None:
    _, mesh = large
    _, area = faces(mesh)
    assert area[of(mesh, Surface.GRASS)].sum() == pytest.approx(113.0 * 75.0)
    grass = mesh.surface == Surface.GRASS
    assert mesh.uvs[grass] == pytest.approx(mesh.positions[grass][:, [0, 2]])


def test_lines_are_those_of_the_laws_of_the_game(large: tuple[SeatPlan, StadiumMesh]) -> None:
    _, mesh = large
    use = of(mesh, Surface.LINE)
    triangles = mesh.positions[mesh.triangles[use]].astype(np.float64)
    assert triangles[..., 1] == pytest.approx(0.02)

    def painted(x: float, z: float) -> bool:
        a, b, c = (triangles[:, i][:, [0, 2]] for i in range(3))
        p = np.array([x, z])

        def side(u: NDArray[np.float64], v: NDArray[np.float64]) -> NDArray[np.float64]:
            return np.asarray(
                (v[:, 0] - u[:, 0]) * (p[1] - u[:, 1]) - (v[:, 1] - u[:, 1]) * (p[0] - u[:, 0])
            )

        signs = np.stack([side(a, b), side(b, c), side(c, a)])
        return bool(((signs <= 1e-9).all(axis=0) | (signs >= -1e-9).all(axis=0)).any())

    on = [
        (52.44, 10.0),  # goal line
        (-30.0, -33.94),  # touchline
        (0.0, 20.0),  # halfway line
        (9.09, 0.0),  # centre circle
        (0.0, 0.0),  # centre mark
        (52.5 - 16.44, 20.0),  # penalty area
        (-45.0, 20.10),
        (52.5 - 5.44, -9.0),  # goal area
        (52.5 - 11.0, 0.0),  # penalty marks
        (-52.5 + 11.0, 0.0),
        (52.5 - 11.0 - 9.09, 0.0),  # penalty arc
        (52.5 - 0.94 * np.sqrt(0.5), 34.0 - 0.94 * np.sqrt(0.5)),  # corner arc
    ]
    off = [
        (20.0, 20.0),
        (5.0, 0.0),
        (52.6, 0.0),
        (0.0, 34.1),
        (52.5 - 11.0 + 9.09, 0.0),  # no arc inside the penalty area
        (54.0, 36.0),
        (52.5 - 14.0, 0.0),
    ]
    assert [point for point in on if not painted(*point)] == []
    assert [point for point in off if painted(*point)] == []


def test_goals_have_the_right_opening(large: tuple[SeatPlan, StadiumMesh]) -> None:
    _, mesh = large
    x, y, z = mesh.positions[mesh.surface == Surface.STEEL].T
    at_line = (np.abs(x - 52.44) < 0.061) & (np.abs(z) < 5.0) & (y < 3.0)
    assert np.abs(z[at_line]).max() == pytest.approx(7.32 / 2 + 0.12, abs=1e-4)
    bar = at_line & (np.abs(z) < 3.67) & (y > 1.0)
    assert y[bar].min() == pytest.approx(2.44, abs=1e-4)


def test_a_tread_lies_under_everybody(stadium: tuple[SeatPlan, StadiumMesh]) -> None:
    plan, mesh = stadium
    flat = of(mesh, Surface.CONCRETE) & (mesh.normals[mesh.triangles[:, 0], 1] > 0.99)
    triangles = mesh.positions[mesh.triangles[flat]].astype(np.float64)
    for seat in np.linspace(0, plan.count - 1, 25).astype(int):
        x, y, z = plan.position[:, seat]
        level = np.abs(triangles[:, 0, 1] - y) < 1e-3
        assert any(covers(t, x, z) for t in triangles[level]), plan.label(seat)


def covers(triangle: NDArray[np.float64], x: float, z: float) -> bool:
    """Whether the point lies in a triangle seen from above, with 3 cm to spare at the rim."""
    a, b, c = triangle[:, [0, 2]]
    edges = np.array([b - a, c - b, a - c])
    offsets = np.array([x, z]) - np.array([a, b, c])
    cross = edges[:, 0] * offsets[:, 1] - edges[:, 1] * offsets[:, 0]
    turn = np.sign(edges[0, 0] * edges[1, 1] - edges[0, 1] * edges[1, 0])
    return bool((turn * cross / np.linalg.norm(edges, axis=1) > -0.03).all())


def test_a_seat_is_under_everybody_and_counts_whole_numbers(
    large: tuple[SeatPlan, StadiumMesh],
) -> None:
    plan, mesh = large
    pans = of(mesh, Surface.SEATS) & (mesh.normals[mesh.triangles[:, 0], 1] > 0.99)
    u = mesh.uvs[mesh.triangles[pans], 0]
    triangles = mesh.positions[mesh.triangles[pans]].astype(np.float64)
    middle = 0.45
    for seat in np.linspace(0, plan.count - 1, 15).astype(int):
        x, y, z = plan.position[:, seat]
        x -= middle * np.sin(plan.yaw[seat])
        z -= middle * np.cos(plan.yaw[seat])
        near = np.flatnonzero(np.abs(triangles[:, 0, 1] - y - 0.44) < 1e-3)
        under = [i for i in near if covers(triangles[i], x, z)]
        assert under, plan.label(seat)
        # The seat's own middle is at a half: nearest edge of the strip gives u by distance.
        ends = triangles[under[0]][:, [0, 2]]
        weights = np.linalg.solve(np.vstack([ends.T, np.ones(3)]), [x, z, 1.0])
        assert (weights @ u[under[0]]) % 1.0 == pytest.approx(0.5, abs=0.12)


def test_nothing_stands_on_the_pitch_or_hides_the_seats(
    large: tuple[SeatPlan, StadiumMesh],
) -> None:
    _, mesh = large
    centres = mesh.positions[mesh.triangles].mean(axis=1)
    roof = of(mesh, Surface.ROOF)
    assert (np.maximum(np.abs(centres[roof, 0]) / 61.0, np.abs(centres[roof, 2]) / 42.0) > 1).all()
    inside = (np.abs(centres[:, 0]) < 52.0) & (np.abs(centres[:, 2]) < 34.0)
    kinds = set(mesh.surface[mesh.triangles[inside, 0]].tolist())
    assert kinds <= {Surface.GRASS, Surface.LINE}


def test_wrong_winding_and_empty_triangles_are_mended() -> None:
    builder = MeshBuilder()
    for normal in ([0.0, 1.0, 0.0], [0.0, -1.0, 0.0]):
        corners = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 0.0, 1.0], [0.0, 0.0, 1.0]]
        builder.quad(corners, normal, Surface.WALL, (1, 2, 3))
    builder.quad([[5.0, 0.0, 0.0]] * 4, [0.0, 1.0, 0.0], Surface.WALL, (9, 9, 9))
    mesh = builder.build()
    cross, area = faces(mesh)
    assert len(mesh.triangles) == 4
    assert len(mesh.positions) == 8
    assert area.sum() == pytest.approx(4.0)
    assert sorted(np.sign(cross[:, 1]).tolist()) == [-1.0, -1.0, 1.0, 1.0]
    assert mesh.uvs.max(axis=0).tolist() == [2.0, 1.0]


def seen(
    plan: SeatPlan, eye: NDArray[np.float64], target: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """(N,) whether each head is inside a 45 degree, 16:9 picture."""
    back = (eye - target) / np.linalg.norm(eye - target)
    right = np.cross([0.0, 1.0, 0.0], back)
    right /= np.linalg.norm(right)
    up = np.cross(back, right)
    heads = plan.position.T + np.array([0.0, 1.2, 0.0]) - eye
    depth = -(heads @ back)
    wide, high = np.abs(heads @ right), np.abs(heads @ up)
    framed = (wide < HALF_WIDTH * 1.05 * depth) & (high < HALF_HEIGHT * depth)
    return np.asarray(framed & (depth > 0.1))


@pytest.mark.parametrize("name", [*PLANS, "bowl 200"])
def test_presets_see_spectators_and_stand_in_nobody(name: str) -> None:
    plan = PLANS[name]() if name in PLANS else build_bowl(200)
    presets = camera_presets(plan)
    assert list(presets) == ["tv", "close", "bowl"]
    for key, (eye, target) in presets.items():
        at, to = np.array(eye), np.array(target)
        assert np.isfinite(at).all()
        assert np.isfinite(to).all()
        away = np.linalg.norm(plan.position.T + np.array([0.0, 0.9, 0.0]) - at, axis=1)
        assert away.min() > 1.2, key
        assert abs(to - at)[[0, 2]].max() > 0.5, key
        count = int(seen(plan, at, to).sum())
        assert count >= (1 if key != "bowl" else 0.95 * plan.count), (key, count)


def test_tv_sees_many_and_close_sees_faces(large: tuple[SeatPlan, StadiumMesh]) -> None:
    plan, _ = large
    presets = {k: (np.array(e), np.array(t)) for k, (e, t) in camera_presets(plan).items()}
    assert seen(plan, *presets["tv"]).sum() > 15_000
    eye, target = presets["close"]
    look = (target - eye) / np.linalg.norm(target - eye)
    assert -0.5 < look[1] < 0.0
    inside = seen(plan, eye, target)
    assert inside.sum() > 60
    ahead = np.stack([np.sin(plan.yaw), 0 * plan.yaw, np.cos(plan.yaw)])
    near = inside & (np.linalg.norm(plan.position.T - eye, axis=1) < 15.0)
    assert near.sum() > 60
    assert (ahead[:, near].T @ look < -0.8).all()


def test_tv_is_below_the_roof_and_above_the_seats(large: tuple[SeatPlan, StadiumMesh]) -> None:
    plan, mesh = large
    eye = np.array(camera_presets(plan)["tv"][0])
    roof = mesh.positions[mesh.surface == Surface.ROOF]
    assert eye[1] < roof[:, 1].min()
    under = np.hypot(plan.position[0] - eye[0], plan.position[2] - eye[2]) < 5.0
    assert eye[1] > plan.position[1, under].max() + 1.5

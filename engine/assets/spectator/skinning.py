"""Which joints move a vertex: labels by anatomy, smoothed along the surface.

Every vertex of a fine, even mesh first belongs to one joint. The labels then diffuse over the
surface, never through the air, so an arm that hangs beside the torso takes nothing from it. How
far they diffuse depends on the joint: a finger's breadth at the wrist, a hand's at the hip.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .body import Body, arm_coordinates
from .meshing import BODY_BOX, Triangles, Vertices, half_surface, mirrored
from .skeleton import LOWER_ARM, PALM_LENGTH, UPPER_ARM

MESH_STEP = 0.009
MAX_INFLUENCES = 4
_LEAST = 0.03

# Standard deviation of the smoothing in metres where the two joints meet.
_WIDTH = {
    "hips": 0.045,
    "spine": 0.060,
    "chest": 0.060,
    "neck": 0.028,
    "head": 0.020,
    "shoulder": 0.045,
    "upper_arm": 0.034,
    "lower_arm": 0.022,
    "hand": 0.016,
    "fingers": 0.013,
    "upper_leg": 0.038,
    "lower_leg": 0.030,
    "foot": 0.018,
    "toe": 0.016,
}


def _labels(body: Body, points: NDArray[np.float32]) -> list[str]:
    """Joint (without its side) that each (N, 3) point of the left half belongs to."""
    x, y, z = points.T
    along, _, _ = arm_coordinates(points)
    elbow, wrist = UPPER_ARM, UPPER_ARM + LOWER_ARM
    arm = (body.arm(points) < body.torso(points) + 0.004) & (along > 0.012) & (y > 0.7)
    arm &= (x > 0.15) & (along < 0.9) & ~((y < 1.0) & (x < 0.3))
    # The seat stays with the pelvis when the thigh is lifted, the groin folds.
    back = np.clip((0.03 - z) / 0.09, 0.0, 1.0)
    crease = 0.815 + x * 0.55 - back * (0.015 + x * 0.35)
    leg = (y < crease) & ~arm & (body.leg(points) < 0.2)
    ahead_of_ear = np.clip((z + 0.04) / 0.10, 0.0, 1.0)
    in_head = y > 1.560 - 0.050 * ahead_of_ear
    in_neck = (y > 1.440) & (np.hypot(x, z + 0.022) < 0.082)
    yoke = (x > 0.062) & (y > 1.335) & ~in_neck
    torso = np.select(
        [in_head, in_neck, yoke, y > 1.175, y > 1.015],
        ["head", "neck", "shoulder", "chest", "spine"],
        "hips",
    )
    reach = np.select(
        [along < elbow, along < wrist, along < wrist + PALM_LENGTH],
        ["upper_arm", "lower_arm", "hand"],
        "fingers",
    )
    thumb = (points[:, 2] > 0.045) & (along > wrist)
    reach = np.where(thumb, "hand", reach)
    limb = np.select(
        [(y < 0.075) & (z > 0.098), (y < 0.095), y < 0.492],
        ["toe", "foot", "lower_leg"],
        "upper_leg",
    )
    return [str(name) for name in np.where(arm, reach, np.where(leg, limb, torso))]


class SurfaceWeights:
    """Weights over an even mesh of the body, to be read at the vertices of any other.

    Parameters
    ----------
    body
        Whose surface.
    names
        The skeleton's joints, for the columns of the weights.
    """

    def __init__(self, body: Body, names: Sequence[str]) -> None:
        from scipy.spatial import cKDTree

        vertices, triangles = mirrored(*half_surface(body.distance, MESH_STEP, BODY_BOX))
        left = vertices.copy()
        left[:, 0] = np.abs(left[:, 0])
        labels = _labels(body, left.astype(np.float32))
        column = {name: index for index, name in enumerate(names)}
        hard = np.zeros((len(vertices), len(names)))
        for row, label in enumerate(labels):
            if label in column:
                hard[row, column[label]] = 1.0
            elif abs(vertices[row, 0]) < 1e-9:
                hard[row, [column[label + "_l"], column[label + "_r"]]] = 0.5
            else:
                hard[row, column[label + ("_l" if vertices[row, 0] > 0 else "_r")]] = 1.0
        width = np.array([_WIDTH[label] for label in labels])
        self._weights = _diffuse(vertices, triangles, hard, width)
        self._tree = cKDTree(vertices)

    def at(self, points: Vertices) -> NDArray[np.float64]:
        """Weights (N, J) that sum to 1 at (N, 3) points on the surface, at most four non-zero."""
        distance, nearest = self._tree.query(points, k=4)
        closeness = 1.0 / (distance + 1e-4) ** 2
        closeness /= closeness.sum(axis=1, keepdims=True)
        weights = np.einsum("nk,nkj->nj", closeness, self._weights[nearest])
        return strongest(weights)


def _diffuse(
    vertices: Vertices,
    triangles: Triangles,
    hard: NDArray[np.float64],
    width: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Smooth the columns of `hard` over the surface by implicit heat flow.

    Four backward-Euler steps approach the Gaussian whose standard deviation is `width`; the width
    itself is smoothed first, so that it does not jump where joints meet.
    """
    from scipy.sparse import coo_matrix, diags, identity
    from scipy.sparse.linalg import splu

    count = len(vertices)
    edges = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    a, b = np.concatenate([edges, edges[:, ::-1]]).T
    # Long edges conduct less, so that slivers of marching cubes do not speed the flow up.
    squared = np.sum((vertices[a] - vertices[b]) ** 2, axis=1) + MESH_STEP**2 * 0.1
    link = coo_matrix((1.0 / squared, (a, b)), shape=(count, count)).tocsr()
    degree = np.asarray(link.sum(axis=1)).ravel()
    mean_square = np.asarray(
        coo_matrix((np.ones(len(a)), (a, b)), shape=(count, count)).sum(axis=1)
    )
    spread = mean_square.ravel() / degree
    flow = identity(count) - diags(1.0 / degree) @ link
    steps = 4

    def solve(values: NDArray[np.float64], deviation: NDArray[np.float64]) -> NDArray[np.float64]:
        rate = diags(2.0 * deviation**2 / spread / steps)
        solver = splu((identity(count) + rate @ flow).tocsc())
        for _ in range(steps):
            values = solver.solve(values)
        return values

    smooth_width = solve(width[:, None], np.full(count, 0.02))[:, 0]
    return solve(hard, smooth_width)


def strongest(weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """Keep the four largest weights of each row of (N, J), drop traces, and make the sum 1."""
    kept = weights.copy()
    floor = np.sort(kept, axis=1)[:, -MAX_INFLUENCES][:, None]
    kept[(kept < floor) | (kept < _LEAST)] = 0.0
    result: NDArray[np.float64] = kept / kept.sum(axis=1, keepdims=True)
    return result

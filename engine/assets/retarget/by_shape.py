"""Finds the limbs of a body whose joints' names say nothing, by how the tree branches.

The two lowest tips are the feet, the tips farthest out to the sides the hands, the highest tip
near the middle the head. Legs must be mirror images of each other, and so must arms.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from .tree import Tree
from .turns import Array, unit

SYMMETRY = 0.25
"""How far two tips may be from mirror images, in heights of the body."""


def limbs_by_shape(tree: Tree) -> dict[str, int]:
    """Part to joint for what the shape of the reference pose tells; empty if it is no body."""
    tips = [joint for joint, below in enumerate(tree.children) if not below]
    positions = tree.positions
    height = float(np.ptp(positions[tips, 1])) if tips else 0.0
    if len(tips) < 2 or height <= 0:
        return {}
    legs = _legs(tree, tips, height)
    if legs is None:
        return {}
    hips, chains = legs
    side = _left(tree, chains)
    if float(side @ (_middle(positions, chains[0]) - _middle(positions, chains[1]))) < 0:
        chains = (chains[1], chains[0])
    found: dict[str, int] = {}
    for name, chain in zip(("left", "right"), chains, strict=True):
        parts = ("upper_leg", "lower_leg", "foot", "toe")
        found |= {f"{name}_{part}": joint for part, joint in zip(parts, chain, strict=False)}
    return found | _upper_body(tree, hips, tips, side, height)


def _legs(
    tree: Tree, tips: list[int], height: float
) -> tuple[int, tuple[list[int], list[int]]] | None:
    """Hips and the joints of two legs, without those of no length."""
    floor = float(tree.positions[tips, 1].min())
    low = [tip for tip in tips if tree.positions[tip, 1] < floor + 0.15 * height]
    best: tuple[float, int, tuple[list[int], list[int]]] | None = None
    for a, b in combinations(low[:16], 2):
        hips = tree.common((a, b))
        if hips < 0 or tree.positions[hips, 1] < floor + 0.25 * height:
            continue
        chains = (_bones(tree, hips, a), _bones(tree, hips, b))
        if min(len(chain) for chain in chains) < 3 or len(chains[0]) != len(chains[1]):
            continue
        lengths = [_lengths(tree, chain) for chain in chains]
        if not np.allclose(lengths[0], lengths[1], atol=0.03 * height):
            continue
        extent = float(tree.positions[hips, 1])
        if best is None or extent > best[0]:
            best = (extent, hips, chains)
    return None if best is None else best[1:]


def _bones(tree: Tree, top: int, tip: int) -> list[int]:
    """Joints below `top` down to `tip` that are somewhere else than their parent, at most four."""
    chain = tree.path(top, tip)
    size = float(np.ptp(tree.positions[:, 1]))
    kept = [
        joint
        for place, joint in enumerate(chain)
        if place + 1 == len(chain)
        or np.linalg.norm(tree.positions[chain[place + 1]] - tree.positions[joint]) > 0.01 * size
    ]
    return kept[:4]


def _lengths(tree: Tree, chain: list[int]) -> Array:
    places = tree.positions[chain]
    return np.asarray(np.linalg.norm(np.diff(places, axis=0), axis=1))


def _middle(positions: Array, chain: list[int]) -> Array:
    return np.asarray(positions[chain[:2]].mean(axis=0))


def _left(tree: Tree, chains: tuple[list[int], list[int]]) -> Array:
    """Where the body's left is: toes point forward, and +Z is forward where there are none."""
    up = np.array([0.0, 1.0, 0.0])
    apart = _middle(tree.positions, chains[0]) - _middle(tree.positions, chains[1])
    apart[1] = 0.0
    side = unit(apart)
    ahead = np.cross(side, up)
    toes = [chain[-1] for chain in chains if len(chain) == 4]
    feet = [chain[2] for chain in chains if len(chain) == 4]
    pointing = np.array([0.0, 0.0, 1.0])
    if toes:
        pointing = (tree.positions[toes] - tree.positions[feet]).mean(axis=0)
    return side if float(ahead @ pointing) >= 0 else -side


def _upper_body(
    tree: Tree, hips: int, tips: list[int], side: Array, height: float
) -> dict[str, int]:
    """Arms and head above the hips, where there are some."""
    positions = tree.positions
    centre = positions[hips]
    above = [
        t for t in tips if tree.is_below(t, hips) and positions[t, 1] > centre[1] - 0.1 * height
    ]
    out = {t: float((positions[t] - centre) @ side) for t in above}
    found: dict[str, int] = {}
    left = max((t for t in above if out[t] > 0.1 * height), key=lambda t: out[t], default=None)
    right = min((t for t in above if out[t] < -0.1 * height), key=lambda t: out[t], default=None)
    middle = [t for t in above if abs(out[t]) < 0.08 * height and positions[t, 1] > centre[1]]
    head = max(middle, key=lambda t: float(positions[t, 1]), default=None)
    if left is not None and right is not None and abs(out[left] + out[right]) < SYMMETRY * height:
        chest = tree.common([left, right] + ([head] if head is not None else []))
        for name, tip in (("left", left), ("right", right)):
            found |= {f"{name}_{part}": j for part, j in _arm(tree, chest, tip).items()}
    if head is not None:
        found["head"] = head
    return found


def _arm(tree: Tree, chest: int, tip: int) -> dict[str, int]:
    chain = _bones(tree, chest, tip)
    if len(chain) < 3:
        return {}
    lengths = _lengths(tree, chain)
    has_clavicle = len(chain) == 4 and lengths[0] < 0.8 * lengths[1]
    parts = (
        ("clavicle", "upper_arm", "lower_arm", "hand")
        if has_clavicle
        else ("upper_arm", "lower_arm", "hand")
    )
    return dict(zip(parts, chain, strict=False))

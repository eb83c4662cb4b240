"""Which joint of a skeleton is which part of a human body.

Limbs are found by the names of their joints, or by the shape of the tree where names say nothing;
what joins them (hips, spine, neck) follows from where they branch, whatever it is called.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...animation.skeleton import Skeleton
from .by_name import limbs_by_name
from .by_shape import limbs_by_shape
from .tree import Tree

SIDES = ("left", "right")
LEG = ("upper_leg", "lower_leg", "foot", "toe")
ARM = ("clavicle", "upper_arm", "lower_arm", "hand", "fingers")
FINGERS = ("thumb", "index", "middle", "ring", "little")

LIMB_PARTS = (
    "head",
    *(f"{side}_{part}" for side in SIDES for part in (*LEG, *ARM)),
    *(f"{side}_{finger}_{k}" for side in SIDES for finger in FINGERS for k in (1, 2, 3)),
)
"""Parts that a mapping may name, besides ``hips``, ``spine_1`` ... and ``neck_1`` ..."""

LEGS = tuple(f"{side}_{part}" for side in SIDES for part in LEG[:3])
ARMS = tuple(f"{side}_{part}" for side in SIDES for part in ARM[1:3])
"""Parts without which a skeleton is no human body; arms only if no mapping leaves them out."""


class NotHumanoidError(ValueError):
    """A skeleton lacks hips, legs or arms, so no motion of a human body can be given to it."""


@dataclass(frozen=True, slots=True, eq=False)
class Humanoid:
    """A skeleton and the parts of the body that its joints are.

    Parameters
    ----------
    skeleton
        The joints.
    joints
        Part to joint index. Parts are ``hips``, ``spine_1`` (above the hips) up to the chest,
        ``neck_1`` ..., ``head``, and for each side ``left_clavicle``, ``left_upper_arm``,
        ``left_lower_arm``, ``left_hand``, ``left_fingers`` (a mitten's), ``left_upper_leg``,
        ``left_lower_leg``, ``left_foot``, ``left_toe``, and ``left_index_1`` to ``_3`` for thumb,
        index, middle, ring and little.
    found_by
        ``"names"``, ``"shape"`` or ``"mapping"``, by which the limbs were found.
    """

    skeleton: Skeleton
    joints: Mapping[str, int]
    found_by: str

    def chain(self, part: str) -> list[int]:
        """Joints of ``"spine"`` or ``"neck"`` from the bottom up."""
        found: list[int] = []
        while f"{part}_{len(found) + 1}" in self.joints:
            found.append(self.joints[f"{part}_{len(found) + 1}"])
        return found

    @property
    def missing(self) -> tuple[str, ...]:
        """Parts of body and limbs, fingers aside, that no joint of the skeleton is."""
        wanted = ("spine_1", "neck_1", *(part for part in LIMB_PARTS if part[-1] not in "123"))
        return tuple(part for part in wanted if part not in self.joints)

    @property
    def unmapped(self) -> tuple[str, ...]:
        """Names of joints that are no part; they rest."""
        used = set(self.joints.values())
        return tuple(name for k, name in enumerate(self.skeleton.names) if k not in used)

    def describe(self) -> str:
        """One line a part with its joint, then what is missing and which joints are unmapped."""
        lines = [f"{part}: {self.skeleton.names[joint]}" for part, joint in self.joints.items()]
        lines.append(f"found by {self.found_by}")
        lines.append(f"missing: {', '.join(self.missing) or 'nothing'}")
        lines.append(f"unmapped joints, which rest: {', '.join(self.unmapped) or 'none'}")
        return "\n".join(lines)


def humanoid(skeleton: Skeleton, mapping: Mapping[str, str | None] | None = None) -> Humanoid:
    """Find the parts of the body in a skeleton.

    Parameters
    ----------
    skeleton
        The joints.
    mapping
        Overrides: part to joint name, or to None for a part that shall be left alone. They go
        before what is found; see `Humanoid` for the parts.

    Returns
    -------
    Humanoid
        Hips, legs, feet and arms are always there (arms can be left out by mapping all four of
        their parts to None); head, hands and the rest where they were found.

    Raises
    ------
    NotHumanoidError
        If hips, legs, feet or arms can't be found; names what is missing. It is a ValueError.
    ValueError
        If `mapping` names an unknown part or joint, or one joint twice, or the skeleton has
        numbers that are not finite.
    """
    for name in ("rest_rotation", "rest_translation", "rest_scale", "inverse_bind"):
        if not np.isfinite(getattr(skeleton, name)).all():
            raise ValueError(f"{name} of the skeleton has values that are not finite")
    tree = Tree.of(skeleton)
    fixed = _checked(skeleton, mapping or {})
    named = limbs_by_name(tree)
    found_by = "names"
    if not _has_legs(named | fixed):
        named, found_by = limbs_by_shape(tree), "shape"
    if _has_legs(fixed):
        found_by = "mapping"
    limbs = {part: joint for part, joint in named.items() if joint not in fixed.values()}
    limbs |= {part: joint for part, joint in fixed.items() if part in LIMB_PARTS}
    limbs = {part: joint for part, joint in limbs.items() if joint >= 0}
    lacking = [p for p in (*LEGS, *ARMS) if p not in limbs and (p in LEGS or p not in fixed)]
    if lacking:
        raise NotHumanoidError(
            f"is not humanoid: no joint was found for {', '.join(lacking)}; a mapping can name them"
        )
    joints = _with_trunk(tree, limbs, fixed)
    order = {part: k for k, part in enumerate(LIMB_PARTS)}
    trunk = (part for part in joints if part not in order)
    ordered = [*sorted(trunk, key=_trunk_order), *(part for part in LIMB_PARTS if part in joints)]
    return Humanoid(skeleton, {part: joints[part] for part in ordered}, found_by)


def _trunk_order(part: str) -> tuple[int, int, str]:
    """Hips, then the spine upwards, then the neck."""
    return ("hips", "spine", "neck").index(part.partition("_")[0]), len(part), part


def _checked(skeleton: Skeleton, mapping: Mapping[str, str | None]) -> dict[str, int]:
    """Joint of each overridden part, -1 for None."""
    fixed: dict[str, int] = {}
    for part, name in mapping.items():
        stem, _, number = part.rpartition("_")
        is_trunk = part == "hips" or (stem in ("spine", "neck") and number.isdigit())
        if not is_trunk and part not in LIMB_PARTS:
            raise ValueError(
                f"mapping: '{part}' is no part of the body; parts are hips, spine_1, neck_1, "
                f"{', '.join(LIMB_PARTS[:10])}, ..."
            )
        joint = -1 if name is None else skeleton.index(name)
        if joint >= 0 and joint in fixed.values():
            raise ValueError(f"mapping: joint '{name}' is named for two parts")
        fixed[part] = joint
    return fixed


def _has_legs(joints: Mapping[str, int]) -> bool:
    return all(joints.get(part, -1) >= 0 for part in LEGS)


def _with_trunk(tree: Tree, limbs: dict[str, int], fixed: Mapping[str, int]) -> dict[str, int]:
    """Add hips, spine and neck: the joints where the limbs branch and those between."""
    joints = dict(limbs)
    legs = [limbs[f"{side}_upper_leg"] for side in SIDES]
    above = [limbs[part] for part in _TOPS if part in limbs]
    arms = [top for top in (_top_of_arm(limbs, side) for side in SIDES) if top is not None]
    hips = fixed.get("hips", -1)
    if hips < 0:
        hips = tree.common(legs + above)
        if hips < 0 or hips in limbs.values():
            raise NotHumanoidError("is not humanoid: the legs do not meet in any hips")
    joints["hips"] = hips
    if any(part.startswith("spine") for part in fixed):
        spine = [fixed[p] for p in sorted(fixed) if p.startswith("spine") and fixed[p] >= 0]
    else:
        chest = tree.common([*arms, limbs["head"]] if "head" in limbs else arms)
        spine = tree.path(hips, chest) if chest >= 0 else []
    taken = set(limbs.values()) | {hips}
    spine = [joint for joint in spine if joint not in taken]
    joints |= {f"spine_{k}": joint for k, joint in enumerate(spine, 1)}
    if any(part.startswith("neck") for part in fixed):
        neck = [fixed[p] for p in sorted(fixed) if p.startswith("neck") and fixed[p] >= 0]
    elif "head" in limbs:
        neck = tree.path(spine[-1] if spine else hips, limbs["head"])[:-1]
    else:
        neck = []
    taken |= set(spine)
    neck = [joint for joint in neck if joint not in taken]
    return joints | {f"neck_{k}": joint for k, joint in enumerate(neck, 1)}


_TOPS = ("head", *(f"{side}_{part}" for side in SIDES for part in ("clavicle", "upper_arm")))


def _top_of_arm(limbs: Mapping[str, int], side: str) -> int | None:
    return limbs.get(f"{side}_clavicle", limbs.get(f"{side}_upper_arm"))

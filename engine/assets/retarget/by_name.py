"""Finds the limbs of a body by the names of joints."""

from __future__ import annotations

from collections.abc import Sequence

from . import names
from .names import JointName, read_name
from .tree import Tree


def limbs_by_name(tree: Tree) -> dict[str, int]:
    """Part to joint for what the names tell: legs, feet, arms, hands, fingers and the head.

    A name alone is ambiguous: a *shoulder* may be a collarbone or an upper arm, a *leg* the shin,
    a *foot* may hang below an *ankle*. Each limb is read from its middle outwards, and position in
    the tree decides.
    """
    readings = [read_name(name) for name in tree.skeleton.names]
    finder = _Finder(tree, readings)
    found: dict[str, int] = {}
    for side in ("left", "right"):
        found |= finder.leg(side) | finder.arm(side)
    head = finder.head()
    return found | ({"head": head} if head is not None else {})


class _Finder:
    def __init__(self, tree: Tree, readings: Sequence[JointName]) -> None:
        self._tree = tree
        self._readings = readings

    def _candidates(self, side: str, parts: Sequence[str], within: int = -1) -> list[int]:
        """Body joints of a side whose part is in `parts`: best words first."""
        found = [
            (parts.index(reading.part), joint)
            for joint, reading in enumerate(self._readings)
            if reading.is_body and reading.side == side and reading.part in parts
            if within < 0 or self._tree.is_below(joint, within)
        ]
        return [joint for _, joint in sorted(found)]

    def _topmost(self, joint: int) -> int:
        """The first of several joints in a row that one bone is split into."""
        part = self._readings[joint].part
        parent = self._tree.parents[joint]
        while parent >= 0 and self._readings[parent].part == part and self._same(parent, joint):
            joint, parent = parent, self._tree.parents[parent]
        return joint

    def _same(self, a: int, b: int) -> bool:
        first, second = self._readings[a], self._readings[b]
        return first.side == second.side and first.is_body

    def leg(self, side: str) -> dict[str, int]:
        """Upper leg, lower leg, foot and toe."""
        for upper in self._candidates(side, names.UPPER_LEG):
            for lower in self._candidates(side, names.LOWER_LEG, within=upper):
                top = self._topmost(upper)
                leg = {"upper_leg": top, "lower_leg": self._topmost(lower)}
                feet = sorted(self._candidates(side, names.FOOT, within=lower))
                if not feet:
                    # Some rigs hang the foot from a control and bring it to the shin by hand.
                    feet = sorted(self._candidates(side, names.FOOT))
                if feet:
                    leg["foot"] = feet[0]
                    # A foot below an ankle is the toes; a second joint called foot is not.
                    below = names.TOE if self._readings[feet[0]].part == "ankle" else names.TOE[:-1]
                    toes = self._candidates(side, below, within=feet[0])
                    if toes:
                        leg["toe"] = toes[0]
                return {f"{side}_{part}": joint for part, joint in leg.items()}
        return {}

    def arm(self, side: str) -> dict[str, int]:
        """Clavicle, upper arm, lower arm, hand and fingers."""
        for lower in self._candidates(side, names.LOWER_ARM):
            above = self._tree.ancestors(lower)
            uppers = [j for j in above if self._is(j, side, names.UPPER_ARM)]
            if not uppers:
                continue
            upper = self._topmost(uppers[0])
            arm = {"upper_arm": upper, "lower_arm": self._topmost(lower)}
            clavicles = [
                j for j in self._tree.ancestors(upper) if self._is(j, side, names.CLAVICLE)
            ]
            if clavicles:
                words = names.CLAVICLE
                arm["clavicle"] = min(
                    clavicles, key=lambda j: (words.index(self._readings[j].part), j)
                )
            hands = sorted(self._candidates(side, names.HAND, within=lower))
            if hands:
                arm["hand"] = hands[0]
                arm |= self._fingers(side, hands[0])
            return {f"{side}_{part}": joint for part, joint in arm.items()}
        return {}

    def _is(self, joint: int, side: str, parts: Sequence[str]) -> bool:
        reading = self._readings[joint]
        return reading.is_body and reading.side == side and reading.part in parts

    def _fingers(self, side: str, hand: int) -> dict[str, int]:
        found: dict[str, int] = {}
        for finger, parts in names.FINGERS.items():
            joints = sorted(self._candidates(side, parts, within=hand))
            joints = joints or self._numbered(side, hand, list(names.FINGERS).index(finger) + 1)
            found |= {f"{finger}_{k}": joint for k, joint in enumerate(joints[:3], 1)}
        mitten = sorted(self._candidates(side, names.ALL_FINGERS, within=hand))
        if mitten:
            found["fingers"] = mitten[0]
        return found

    def _numbered(self, side: str, hand: int, number: int) -> list[int]:
        """Joints of a finger that is called finger2-1, the thumb being finger1."""
        joints = self._candidates(side, ("finger",), within=hand)
        numbers = {joint: self._readings[joint].numbers for joint in joints}
        return sorted(j for j in joints if len(numbers[j]) == 2 and numbers[j][0] == number)

    def head(self) -> int | None:
        """The topmost joint called head, or the end of a spine that is only numbered."""
        heads = self._candidates("", names.HEAD)
        if heads:
            return heads[0]
        # Rigify calls the head spine.006: the last of the spine above where the arms branch off.
        spine = self._candidates("", ("spine",))
        last = max(spine, key=lambda j: self._readings[j].numbers or (0,), default=None)
        if last is None or (self._readings[last].numbers or (0,)) < (5,):
            return None
        arms = [
            j for side in ("left", "right") for j in self._candidates(side, names.LOWER_ARM)[:1]
        ]
        chest = self._tree.common(arms)
        return last if chest >= 0 and self._tree.is_below(last, chest) else None

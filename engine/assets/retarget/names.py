"""Reads what a joint's name says: which side of the body, which part, and what to ignore.

Programs and studios name the same joint ``LeftUpLeg``, ``mixamorig:LeftUpLeg``, ``DEF-thigh.L``,
``lThigh``, ``UpLeg_L``, ``upperleg01.L``, ``Bip01 L Thigh`` or ``J_Bip_L_UpperLeg``. A name is cut
into words; side, number and the rigs' own prefixes are taken off, and what is left is the part.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|[0-9]+")

_SIDES = {"l": "left", "left": "left", "lft": "left", "r": "right", "right": "right"}
_SIDES["rgt"] = "right"

_PREFIXES = {"def", "org", "bip", "biped", "j", "b", "c", "cc", "base", "jnt", "joint", "bone"}
"""Words of rigs that say nothing about the body, where another word is left."""

_NO_BODY = {
    *("ik", "fk", "pole", "target", "control", "ctrl", "ctl", "mch", "effector", "helper"),
    *("twist", "roll", "end", "nub", "site", "slot", "handslot", "top", "tip", "corrective"),
}
"""Words of joints that steer or end others; such a joint is part of no limb."""


@dataclass(frozen=True, slots=True)
class JointName:
    """What a name says.

    Parameters
    ----------
    side
        ``"left"``, ``"right"`` or ``""``.
    part
        Words without side and numbers, lower case, joined: ``"upperarm"``.
    numbers
        The numbers in it, in order.
    is_body
        Whether it may be a joint of a limb, and not a control, a twist or an end.
    """

    side: str
    part: str
    numbers: tuple[int, ...]
    is_body: bool


def read_name(name: str) -> JointName:
    """Side, part and numbers of a joint's name.

    ``"mixamorig:LeftUpLeg"`` is the left ``upleg``, ``"DEF-upper_arm.L.001"`` the left ``upperarm``
    with the number 1, ``"kneeIK.l"`` no joint of the body.
    """
    own = re.split(r"[:|]", name)[-1]
    words = [word for word in _WORD.findall(own) if word]
    side = ""
    kept: list[str] = []
    numbers: list[int] = []
    for word in words:
        lower = word.lower()
        if word.isdigit():
            numbers.append(int(word[:9]))
        elif lower in _SIDES:
            side = side or _SIDES[lower]
        else:
            kept.append(lower)
    if not side and kept:
        side, kept[0] = _glued_side(kept[0])
    meaning = [word for word in kept if word not in _PREFIXES] or kept
    is_body = not name.startswith("__") and not _NO_BODY.intersection(kept)
    return JointName(side, "".join(meaning), tuple(numbers), is_body)


def _glued_side(word: str) -> tuple[str, str]:
    """``("left", "hand")`` of ``"lefthand"``."""
    for side in ("left", "right"):
        if word.startswith(side) and len(word) > len(side):
            return side, word.removeprefix(side)
        if word.endswith(side) and len(word) > len(side):
            return side, word.removesuffix(side)
    return "", word


UPPER_LEG = ("upleg", "upperleg", "thigh", "legupper", "femur", "hip")
LOWER_LEG = ("lowerleg", "loleg", "lowleg", "shin", "calf", "leglower", "shank", "knee", "leg")
FOOT = ("foot", "ankle")
TOE = ("toebase", "toe", "toes", "ball", "foottoe", "foot")
LOWER_ARM = ("forearm", "lowerarm", "loarm", "lowarm", "armlower", "elbow", "farm")
UPPER_ARM = ("upperarm", "uparm", "armupper", "shldr", "humerus", "arm", "shoulder")
CLAVICLE = ("clavicle", "collar", "collarbone", "shoulder")
HAND = ("hand", "wrist", "palm")
HEAD = ("head", "skull")
FINGERS = {
    "thumb": ("thumb", "handthumb", "thumbfinger"),
    "index": ("index", "handindex", "pointer", "findex", "indexfinger"),
    "middle": ("middle", "handmiddle", "mid", "fmiddle", "middlefinger"),
    "ring": ("ring", "handring", "fring", "ringfinger"),
    "little": (
        "little",
        "pinky",
        "handpinky",
        "fpinky",
        "pinkyfinger",
        "handlittle",
        "littlefinger",
    ),
}
ALL_FINGERS = ("fingers", "fingerbase")
"""One joint that bends all fingers of a mitten."""

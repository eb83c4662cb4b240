"""Human skeletons with known rest poses, and clips made for them from anatomy."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from tifo.engine.animation.clip import Clip
from tifo.engine.animation.skeleton import Skeleton, breadth_first_order

Array = NDArray[Any]

BONES: tuple[tuple[str, str, tuple[float, float, float]], ...] = (
    ("spine", "hips", (0, 0.12, 0)),
    ("chest", "spine", (0, 0.15, 0)),
    ("neck", "chest", (0, 0.24, 0)),
    ("head", "neck", (0, 0.1, 0)),
    ("L upper_leg", "hips", (0.09, -0.05, 0)),
    ("L lower_leg", "L upper_leg", (0, -0.42, 0)),
    ("L foot", "L lower_leg", (0, -0.4, 0)),
    ("L toe", "L foot", (0, -0.06, 0.13)),
    ("L clavicle", "chest", (0.03, 0.18, 0)),
    ("L upper_arm", "L clavicle", (0.15, 0, 0)),
    ("L lower_arm", "L upper_arm", (0.28, 0, 0)),
    ("L hand", "L lower_arm", (0.25, 0, 0)),
)
"""Joint, parent and offset in a T-pose that faces +Z; the right side is the mirror image."""

STYLES = {
    "mixamo": {
        "hips": "mixamorig:Hips", "spine": "mixamorig:Spine", "chest": "mixamorig:Spine1",
        "neck": "mixamorig:Neck", "head": "mixamorig:Head", "upper_leg": "mixamorig:{Side}UpLeg",
        "lower_leg": "mixamorig:{Side}Leg", "foot": "mixamorig:{Side}Foot",
        "toe": "mixamorig:{Side}ToeBase", "clavicle": "mixamorig:{Side}Shoulder",
        "upper_arm": "mixamorig:{Side}Arm", "lower_arm": "mixamorig:{Side}ForeArm",
        "hand": "mixamorig:{Side}Hand",
    },
    "rigify": {
        "hips": "DEF-spine", "spine": "DEF-spine.001", "chest": "DEF-spine.003",
        "neck": "DEF-spine.004", "head": "DEF-spine.006", "upper_leg": "DEF-thigh.{S}",
        "lower_leg": "DEF-shin.{S}", "foot": "DEF-foot.{S}", "toe": "DEF-toe.{S}",
        "clavicle": "DEF-shoulder.{S}", "upper_arm": "DEF-upper_arm.{S}",
        "lower_arm": "DEF-forearm.{S}", "hand": "DEF-hand.{S}",
    },
    "daz": {
        "hips": "hip", "spine": "abdomen", "chest": "chest", "neck": "neck", "head": "head",
        "upper_leg": "{s}Thigh", "lower_leg": "{s}Shin", "foot": "{s}Foot", "toe": "{s}Toe",
        "clavicle": "{s}Collar", "upper_arm": "{s}Shldr", "lower_arm": "{s}ForeArm",
        "hand": "{s}Hand",
    },
    "makehuman": {
        "hips": "root", "spine": "spine05", "chest": "spine01", "neck": "neck01", "head": "head",
        "upper_leg": "upperleg01.{S}", "lower_leg": "lowerleg01.{S}", "foot": "foot.{S}",
        "toe": "toe1-1.{S}", "clavicle": "clavicle.{S}", "upper_arm": "upperarm01.{S}",
        "lower_arm": "lowerarm01.{S}", "hand": "wrist.{S}",
    },
    "unreal": {
        "hips": "pelvis", "spine": "spine_01", "chest": "spine_02", "neck": "neck_01",
        "head": "head", "upper_leg": "thigh_{s}", "lower_leg": "calf_{s}", "foot": "foot_{s}",
        "toe": "ball_{s}", "clavicle": "clavicle_{s}", "upper_arm": "upperarm_{s}",
        "lower_arm": "lowerarm_{s}", "hand": "hand_{s}",
    },
    "biped": {
        "hips": "Bip01 Pelvis", "spine": "Bip01 Spine", "chest": "Bip01 Spine1",
        "neck": "Bip01 Neck", "head": "Bip01 Head", "upper_leg": "Bip01 {S} Thigh",
        "lower_leg": "Bip01 {S} Calf", "foot": "Bip01 {S} Foot", "toe": "Bip01 {S} Toe0",
        "clavicle": "Bip01 {S} Clavicle", "upper_arm": "Bip01 {S} UpperArm",
        "lower_arm": "Bip01 {S} Forearm", "hand": "Bip01 {S} Hand",
    },
    "vroid": {
        "hips": "J_Bip_C_Hips", "spine": "J_Bip_C_Spine", "chest": "J_Bip_C_Chest",
        "neck": "J_Bip_C_Neck", "head": "J_Bip_C_Head", "upper_leg": "J_Bip_{S}_UpperLeg",
        "lower_leg": "J_Bip_{S}_LowerLeg", "foot": "J_Bip_{S}_Foot", "toe": "J_Bip_{S}_ToeBase",
        "clavicle": "J_Bip_{S}_Shoulder", "upper_arm": "J_Bip_{S}_UpperArm",
        "lower_arm": "J_Bip_{S}_LowerArm", "hand": "J_Bip_{S}_Hand",
    },
    "smpl": {
        "hips": "Pelvis", "spine": "Spine1", "chest": "Spine2", "neck": "Neck", "head": "Head",
        "upper_leg": "{S}_Hip", "lower_leg": "{S}_Knee", "foot": "{S}_Ankle", "toe": "{S}_Foot",
        "clavicle": "{S}_Collar", "upper_arm": "{S}_Shoulder", "lower_arm": "{S}_Elbow",
        "hand": "{S}_Wrist",
    },
    "plain": {},
    "nameless": {},
}  # fmt: skip


def anatomy() -> tuple[list[str], list[int], Array]:
    """Plain names (``hips``, ``left_foot``), parents and T-pose places of both sides."""
    names, parents, places = ["hips"], [-1], [np.array([0.0, 0.94, 0.0])]
    for name, parent, offset in BONES:
        sided = name.startswith("L ")
        for side, sign in (("left_", 1), ("right_", -1)) if sided else (("", 1),):
            above = parent.replace("L ", side) if parent.startswith("L ") else parent
            names.append(name.replace("L ", side))
            parents.append(names.index(above))
            places.append(places[parents[-1]] + np.array(offset) * [sign, 1, 1])
    return names, parents, np.array(places)


class Body:
    """A human skeleton whose rest pose is a T-pose with turned limbs, seen in turned joint axes.

    Parameters
    ----------
    style
        How joints are named, a key of `STYLES`.
    limbs
        Plain name to rotation: in the rest pose that bone and all below are turned by it, about
        its joint, in axes of the T-pose.
    world
        Rotation of the whole figure, for those that face or stand elsewhere.
    size
        Metres a unit of the T-pose.
    axes
        Random joint axes are drawn from this generator; parallel to the world's if None.
    """

    def __init__(
        self,
        style: str = "plain",
        *,
        limbs: dict[str, Rotation] | None = None,
        world: Rotation | None = None,
        size: float = 1.0,
        axes: np.random.Generator | None = None,
    ) -> None:
        names, parents, places = anatomy()
        order = breadth_first_order(parents)
        new = {int(old): k for k, old in enumerate(order)}
        self.parts = tuple(names[k] for k in order)
        self.parents = [-1 if parents[k] < 0 else new[parents[k]] for k in order]
        flat = places[order] * size
        world = Rotation.identity() if world is None else world
        count = len(self.parts)
        self.flat = flat
        pose: list[Rotation] = []
        rest = np.empty((count, 3))
        for joint, parent in enumerate(self.parents):
            own = (limbs or {}).get(self.parts[joint], Rotation.identity())
            above = world if parent < 0 else pose[parent]
            pose.append(above * own)
            if parent < 0:
                rest[joint] = world.apply(flat[joint])
            else:
                rest[joint] = rest[parent] + pose[parent].apply(flat[joint] - flat[parent])
        frames = [
            Rotation.identity() if axes is None else Rotation.random(random_state=axes)
            for _ in range(count)
        ]
        self.rest_pose, self.frames, self.world = pose, frames, world
        turns = Rotation.concatenate(frames)
        local_q, local_t = self._local(turns, rest)
        inverse = np.zeros((count, 3, 4), np.float32)
        for joint in range(count):
            matrix = turns[joint].inv().as_matrix()
            inverse[joint] = np.column_stack([matrix, -matrix @ rest[joint]])
        self.skeleton = Skeleton(
            names=tuple(self._name(style, k) for k in range(count)),
            parents=np.array(self.parents, np.int32),
            rest_rotation=local_q.astype(np.float32),
            rest_translation=local_t.astype(np.float32),
            rest_scale=np.ones((count, 3), np.float32),
            inverse_bind=inverse,
        )

    def clip(self, poses: list[dict[str, Rotation]], hips: Array, name: str = "move") -> Clip:
        """A clip of anatomical poses: every part turned from the T-pose, in model axes facing +Z.

        `poses` gives the turn of a part relative to its parent part; `hips` are (F, 3) places.
        """
        rotation, translation = [], []
        for pose, place in zip(poses, hips, strict=True):
            turned: list[Rotation] = []
            positions = np.empty((len(self.parts), 3))
            for joint, parent in enumerate(self.parents):
                own = pose.get(self.parts[joint], Rotation.identity())
                turned.append(own if parent < 0 else turned[parent] * own)
                if parent < 0:
                    positions[joint] = place
                else:
                    offset = self.flat[joint] - self.flat[parent]
                    positions[joint] = positions[parent] + turned[parent].apply(offset)
            # A joint's axes turn with its part, from where they are in the rest pose.
            axes = [
                turned[k] * self.rest_pose[k].inv() * self.frames[k] for k in range(len(turned))
            ]
            q, t = self._local(Rotation.concatenate(axes), positions)
            rotation.append(q)
            translation.append(t)
        frames = len(poses)
        return Clip(
            name=name,
            duration=(frames - 1) / 60,
            rotation=np.array(rotation, np.float32),
            translation=np.array(translation, np.float32),
            scale=np.ones((frames, len(self.parts), 3), np.float32),
            looping=False,
        )

    def _local(self, turns: Rotation, places: Array) -> tuple[Array, Array]:
        count = len(self.parts)
        q, t = np.empty((count, 4)), np.empty((count, 3))
        for joint, parent in enumerate(self.parents):
            if parent < 0:
                q[joint], t[joint] = turns[joint].as_quat(), places[joint]
            else:
                back = turns[parent].inv()
                q[joint] = (back * turns[joint]).as_quat()
                t[joint] = back.apply(places[joint] - places[parent])
        return q, t

    def _name(self, style: str, joint: int) -> str:
        if style == "nameless":
            return f"node {joint}"
        sided = "left" if self.parts[joint].startswith("left") else "right"
        part = self.parts[joint].removeprefix(f"{sided}_")
        pattern = STYLES[style].get(part)
        if pattern is None:
            return self.parts[joint]
        return pattern.format(Side=sided.title(), S=sided[0].upper(), s=sided[0])


def model_places(skeleton: Skeleton, clip: Clip) -> Array:
    """(F, J, 3) where the joints are, by SciPy's rotations."""
    frames, count = clip.frame_count, clip.joint_count
    matrices = np.tile(np.eye(4), (frames, count, 1, 1))
    turns = Rotation.from_quat(clip.rotation.reshape(-1, 4).astype(float)).as_matrix()
    matrices[..., :3, :3] = turns.reshape(frames, count, 3, 3) * clip.scale[..., None, :]
    matrices[..., :3, 3] = clip.translation
    for joint, parent in enumerate(skeleton.parents):
        if parent >= 0:
            matrices[:, joint] = matrices[:, parent] @ matrices[:, joint]
    return matrices[..., :3, 3]

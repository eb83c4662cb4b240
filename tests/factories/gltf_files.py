"""Small glTF files written with pygltflib, and what their vertices should be."""

from __future__ import annotations

import numpy as np
import pygltflib as pg
from scipy.spatial.transform import Rotation

from tifo.engine.assets.gltf import load_gltf

CORNERS = [[0, 0, 0], [2, 0, 0], [0, 2, 0]]
HALF = np.sqrt(0.5)
COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}


def skinned(character, key=None):
    """Skinned vertices of all meshes at rest or at a key of the first clip."""
    skeleton = character.skeleton
    pose = (skeleton.rest_rotation, skeleton.rest_translation, skeleton.rest_scale)
    if key is not None:
        clip = character.clips[0]
        pose = (clip.rotation[key], clip.translation[key], clip.scale[key])
    model = np.zeros((skeleton.joint_count, 4, 4))
    for joint, parent in enumerate(skeleton.parents):
        local = np.eye(4)
        local[:3, :3] = Rotation.from_quat(pose[0][joint]).as_matrix() * pose[2][joint]
        local[:3, 3] = pose[1][joint]
        model[joint] = local if parent < 0 else model[parent] @ local
    binds = np.tile(np.eye(4), (skeleton.joint_count, 1, 1))
    binds[:, :3] = skeleton.inverse_bind
    found = []
    for mesh in character.meshes:
        points = np.column_stack([mesh.positions, np.ones(len(mesh.positions))])
        palettes = (model @ binds)[mesh.joints]
        found.append(np.einsum("vk,vkab,vb->va", mesh.weights, palettes, points)[:, :3])
    return np.concatenate(found)


def two_joints(weights, joints=(0, 1, 0, 0)):
    """A triangle on two joints, nodes 0 and 1, the second 1 m up."""
    file = File()
    nodes = [file.node(), file.node(translation=[0, 1, 0])]
    up = np.eye(4)
    up[1, 3] = -1
    mesh = file.mesh(
        POSITION=file.put(CORNERS),
        JOINTS_0=file.put([list(joints)] * len(weights), "u2"),
        WEIGHTS_0=file.put(weights),
    )
    file.node(mesh=mesh, skin=file.skin(nodes, [np.eye(4), up]))
    return file


class File:
    """A glTF file in the making."""

    def __init__(self):
        self.gltf = pg.GLTF2(scene=0, scenes=[pg.Scene(nodes=[])])
        self.blob = bytearray()

    def view(self, array, stride=None):
        self.blob += b"\0" * (-len(self.blob) % 4)
        data = array.tobytes()
        self.gltf.bufferViews.append(
            pg.BufferView(
                buffer=0, byteOffset=len(self.blob), byteLength=len(data), byteStride=stride
            )
        )
        self.blob += data
        return len(self.gltf.bufferViews) - 1

    def put(self, values, dtype="f4", kind=None, normalized=False):
        array = np.ascontiguousarray(np.round(values) if dtype != "f4" else values, dtype)
        self.gltf.accessors.append(
            pg.Accessor(
                bufferView=self.view(array),
                componentType=COMPONENTS[dtype],
                count=len(array),
                type=kind or ("MAT4" if array.ndim == 3 else f"VEC{array.shape[1]}"),
                normalized=normalized,
            )
        )
        return len(self.gltf.accessors) - 1

    def node(self, root=True, **fields):
        self.gltf.nodes.append(pg.Node(**fields))
        if root:
            self.gltf.scenes[0].nodes.append(len(self.gltf.nodes) - 1)
        return len(self.gltf.nodes) - 1

    def mesh(self, indices=None, material=None, **attributes):
        primitive = pg.Primitive(
            attributes=pg.Attributes(**attributes), indices=indices, material=material
        )
        self.gltf.meshes.append(pg.Mesh(primitives=[primitive]))
        return len(self.gltf.meshes) - 1

    def skin(self, joints, inverse_binds=None):
        binds = None
        if inverse_binds is not None:
            binds = self.put(np.array(inverse_binds).transpose(0, 2, 1))
        self.gltf.skins.append(pg.Skin(joints=joints, inverseBindMatrices=binds))
        return len(self.gltf.skins) - 1

    def animation(self, name, channels):
        animation = pg.Animation(name=name, samplers=[], channels=[])
        for node, path, times, values, *interpolation in channels:
            target = pg.AnimationChannelTarget(node=node, path=path)
            animation.channels.append(
                pg.AnimationChannel(sampler=len(animation.samplers), target=target)
            )
            animation.samplers.append(
                pg.AnimationSampler(
                    input=times, output=values, interpolation=(*interpolation, "LINEAR")[0]
                )
            )
        self.gltf.animations.append(animation)

    def finish(self):
        self.blob += b"\0" * (-len(self.blob) % 4)
        if self.blob:
            self.gltf.buffers = [pg.Buffer(byteLength=len(self.blob))]
            self.gltf.set_binary_blob(bytes(self.blob))

    def save(self, folder):
        self.finish()
        path = folder / "file.glb"
        self.gltf.save(str(path))
        return path

    def load(self, folder):
        return load_gltf(self.save(folder))

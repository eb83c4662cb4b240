"""Overrides in GLSL and in Python, for tests that compare the two."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tifo.engine.overrides import JointOverride, OverriddenJoints, turn_about

Array = NDArray[Any]

TURN = """
uniform float amount;
uniform vec3 axis;
const float PART = 0.25;       // also the name of a macro of another text
float helper(float x) { return amount * x + PART; }
mat4 %s(OverriddenJoint joint)
{
    return turn_about(joint.pose, joint.pivot, axis, helper(joint.values.x) + float(joint.order));
}
"""
BEND = """
#define PART 0.5
uniform mat3 shape;
uniform vec3 axis[2];
struct Pair { vec3 first; vec3 second; };
vec3 helper(Pair pair, float share) { return mix(pair.first, pair.second, share); }
mat4 %s(OverriddenJoint joint)
{
    mat4 bend = mat4(shape);
    bend[3].xyz = joint.bind_pivot - shape * joint.bind_pivot;
    mat4 out_of_it = joint.pose * bend;
    vec3 place = to_stadium(joint.body, joint.pivot);
    out_of_it[3].xyz += PART * helper(Pair(axis[0], axis[1]), joint.values.y) + 0.001 * place;
    return out_of_it;
}
"""


def turn(
    name: str,
    joints: Sequence[str],
    amount: float = 0.0,
    axis: Sequence[float] = (0.0, 0.0, 1.0),
    **options: Any,
) -> JointOverride:
    """Turns joints by ``amount * values.x + 0.25 + order`` about an axis."""

    def python(given: OverriddenJoints, uniforms: Mapping[str, Array]) -> Array:
        angle = uniforms["amount"] * given.values[:, 0] + 0.25 + given.order
        return turn_about(given.pose, given.pivot, uniforms["axis"], angle)

    uniforms = {"amount": amount, "axis": axis}
    return JointOverride(
        name, joints, TURN % name, uniforms=uniforms, **{"python": python, **options}
    )


def bend(name: str, joints: Sequence[str], shape: Array, axis: Array) -> JointOverride:
    """Stretches joints about their place in the bind pose and moves them."""

    def python(given: OverriddenJoints, uniforms: Mapping[str, Array]) -> Array:
        bend = np.eye(4)
        bend[:3, :3] = uniforms["shape"]
        bend[:3, 3] = given.bind_pivot - uniforms["shape"] @ given.bind_pivot
        out = given.pose @ bend
        first, second = uniforms["axis"]
        out[:, :3, 3] += 0.5 * (first + given.values[:, 1:2] * (second - first))
        out[:, :3, 3] += 0.001 * given.body.to_stadium(given.pivot)
        return out

    return JointOverride(
        name, joints, BEND % name, uniforms={"shape": shape, "axis": axis}, python=python
    )

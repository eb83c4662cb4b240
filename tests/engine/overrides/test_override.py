from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tifo.engine.overrides import JointOverride

NOD = """
uniform float angle;
uniform vec3 axis[2];
uniform int count;
mat4 nod(OverriddenJoint joint)
{
    return turn_about(joint.pose, joint.pivot, axis[0], angle);
}
"""
VALUES: dict[str, Any] = {"angle": 0.5, "axis": np.eye(2, 3), "count": 3}


def make(**changes: Any) -> JointOverride:
    given = {"name": "nod", "joints": ["head"], "glsl": NOD, "uniforms": VALUES, **changes}
    return JointOverride(given.pop("name"), given.pop("joints"), given.pop("glsl"), **given)


def test_uniforms_are_set_and_read_back() -> None:
    nod = make()
    nod.uniforms["angle"] = 2
    nod.uniforms["axis"] = [[0, 0, 1], [0, 1, 0]]
    assert nod.uniforms["angle"] == 2.0
    np.testing.assert_array_equal(nod.uniforms["axis"], [[0, 0, 1], [0, 1, 0]])
    assert list(nod.uniforms) == ["angle", "axis", "count"]


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("angel", 1.0, "override 'nod' declares no uniform 'angel'; near: angle"),
        ("angle", np.nan, "uniform 'angle' takes finite numbers of shape"),
        ("angle", [1.0, 2.0], r"shape \(\), got"),
        ("axis", [1.0, 2.0, 3.0], r"shape \(2, 3\)"),
        ("count", 1.5, "whole numbers"),
        ("count", 2**40, "can't hold"),
        ("angle", 1e300, "can't hold"),
        ("angle", "fast", "finite numbers"),
    ],
)
def test_wrong_uniforms_are_refused_when_they_are_set(name: str, value: Any, message: str) -> None:
    with np.errstate(over="ignore"), pytest.raises(ValueError, match=message):
        make().uniforms[name] = value


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"name": "a b"}, "name is 'a b'"),
        ({"name": "gl_nod"}, "name is 'gl_nod'"),
        ({"name": "node"}, "no function 'mat4 node"),
        ({"joints": []}, "joints is"),
        ({"joints": ["head", "head"]}, "each of them once"),
        ({"values": (1.0, 2.0)}, "four finite numbers"),
        ({"uniforms": {"angle": 1.0}}, "has no value for 'axis'"),
        ({"glsl": NOD.replace("OverriddenJoint joint", "vec3 joint")}, "no function"),
        ({"glsl": "uniform sampler2D s;\n" + NOD}, "override 'nod': 'uniform sampler2D s'"),
    ],
)
def test_wrong_overrides_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        make(**changes)

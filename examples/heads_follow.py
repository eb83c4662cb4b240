"""Heads follow a ball by the override that comes with tifo, and nod by one that is written here.

Run with ``python examples/heads_follow.py``; it writes no file and needs no OpenGL. To see it, draw
the simulation with `tifo.Stage`, as the README shows.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

import tifo

NOD = """
uniform float angle;

mat4 nod(OverriddenJoint joint)
{
    vec3 ear = normalize(joint.pose[0].xyz);   // left and right stay where they are
    return turn_about(joint.pose, joint.pivot, ear, angle * joint.values.x);
}
"""


def nod_in_python(
    joints: tifo.OverriddenJoints, uniforms: Mapping[str, NDArray[np.float32]]
) -> NDArray[np.float32]:
    """The same for many agents, for `Crowd.palettes`."""
    ear = joints.pose[:, :3, 0] / np.linalg.norm(joints.pose[:, :3, 0], axis=1, keepdims=True)
    return tifo.turn_about(joints.pose, joints.pivot, ear, uniforms["angle"] * joints.values[:, 0])


def main() -> None:
    simulation = tifo.Simulation(tifo.CrowdSpec(rows=10, columns=40, layout="stand", seed=4))
    crowd = simulation.crowd
    everybody = np.arange(len(crowd))

    look = tifo.look_at(limit=(1.2, 0.6))
    crowd.add_override(look)
    attention = look.draw_attention(len(crowd), np.random.default_rng(1))
    crowd.override_values("look_at", everybody, attention)

    nod = tifo.JointOverride("nod", ["head"], NOD, uniforms={"angle": 0.0}, python=nod_in_python)
    crowd.add_override(nod)
    crowd.override_values("nod", crowd.team.side == 0, (1.0, 0.0, 0.0, 0.0))

    head = crowd.character.skeleton.index("head")
    for tick in range(1, 181):
        seconds = tick / 60
        ball = (30.0 + 40.0 * np.sin(2.0 * seconds), 0.5, 30.0)
        look.aim(ball, seconds=1 / 60)
        nod.uniforms["angle"] = 0.2 * np.sin(6.0 * seconds)
        simulation.run(seconds=1 / 60)
        if tick % 30 == 0:
            palettes = crowd.palettes(everybody, simulation.clock.pose_tick)
            ahead = palettes[:, head, :, 2]  # characters face +Z in the bind pose
            yaw = np.degrees(np.arctan2(ahead[:, 0], ahead[:, 2]))
            print(f"{seconds:.1f} s  ball at x = {ball[0]:5.1f}  heads turned {yaw.mean():5.1f}°")
    simulation.close()


if __name__ == "__main__":
    main()

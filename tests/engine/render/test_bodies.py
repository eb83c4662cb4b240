"""Girth, heads and seats in the shader, against the CPU's rules."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tifo.engine.crowd.morphs import morphed_positions
from tifo.engine.crowd.physique import seat_lift
from tifo.engine.crowd.spec import CrowdSpec
from tifo.systems.simulation import Simulation

pytestmark = pytest.mark.gl


def test_the_spectators_vertices_are_morphed_and_lifted_as_on_the_cpu(shader_crowd: Any) -> None:
    simulation = Simulation(
        CrowdSpec(layout="stand", rows=6, columns=10, children=0.4, old=0.3, occupancy=1.0)
    )
    simulation.run(seconds=1.5)
    crowd, tick, alpha = simulation.crowd, simulation.clock.pose_tick, 0.6
    assert crowd.pool is not None
    assert crowd.physique is not None
    assert len(crowd.pool.twins) > 20
    poses = (crowd.pool, crowd.anim, crowd.transition)
    made = shader_crowd(
        poses,
        crowd.placement,
        crowd.appearance,
        overlays=crowd.overlays,
        body=crowd.body,
        physique=crowd.physique,
    )
    made.update(tick)
    mesh = crowd.character.meshes[0]
    agents = np.arange(len(crowd))
    shown = made.skinned(mesh, agents, tick, alpha)
    palettes = crowd.palettes(agents, tick, alpha).astype(float)
    physique, seats = crowd.physique, crowd.physique.seats
    assert seats is not None
    hips = palettes[:, physique.hips, 1] @ np.append(physique.hips_bind, 1.0)
    lift = seat_lift(hips, crowd.placement.scale, physique.legs[crowd.body.kind], seats)
    assert lift.max() > 0.1
    assert set(np.unique(crowd.body.kind)) == {0, 1, 2}
    for agent in agents[::7]:
        girth, head = float(crowd.body.girth[agent]), float(crowd.body.head[agent])
        bind = morphed_positions(mesh, physique.morphs, girth, head)
        points = np.concatenate([bind, np.ones((len(bind), 1))], axis=1)
        skinned = np.einsum("vkij,vj->vki", palettes[agent][mesh.joints], points)
        model = np.einsum("vk,vki->vi", mesh.weights, skinned)
        yaw = float(crowd.placement.yaw[agent])
        turn = np.array([[np.cos(yaw), 0, np.sin(yaw)], [0, 1, 0], [-np.sin(yaw), 0, np.cos(yaw)]])
        place = crowd.placement.position[:, agent] + [0.0, lift[agent], 0.0]
        expected = place + float(crowd.placement.scale[agent]) * model @ turn.T
        # Morph weights are 8 bits a vertex.
        np.testing.assert_allclose(shown[agent], expected, rtol=0, atol=5e-4)
    simulation.close()

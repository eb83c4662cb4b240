"""The plan against the naive evaluator: random trees, parameters and times."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from tifo.engine.animation.controllers import Controller

CHECK = settings(
    max_examples=40,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)


def draw_value(data: st.DataObject, path: str, old: Any) -> Any:
    """A new value for a parameter."""
    if path.endswith(("position", "speed", "scale")):
        one = st.floats(-3, 3)
    else:
        one = st.sampled_from([0.0, 1.0]) | st.floats(0, 1)
    if isinstance(old, (list, tuple)):
        return [data.draw(one) for _ in old]
    return data.draw(one)


@CHECK
@given(data=st.data(), seed=st.integers(0, 1000))
def test_random_trees_are_as_the_definitions_say(
    data: st.DataObject, seed: int, stage: Any, trees: st.SearchStrategy[Controller]
) -> None:
    pool = stage.pool(capacity=4)
    controllers = data.draw(st.lists(trees, min_size=1, max_size=4))
    rng = np.random.default_rng(seed)
    streams = []
    for controller in controllers:
        time, speed = rng.uniform(-1, 3), rng.choice([0.5, 1.0, -1.3])
        streams.append(
            (
                pool.add(controller, time=time, speed=speed),
                stage.reference(controller, time),
                speed,
            )
        )
    for tick in range(4):
        pool.evaluate(tick)
        pool.commit(tick)
        for stream, reference, speed in streams:
            expected = stage.palettes(reference.tick(speed / 30))
            assume(reference.closest > 1e-3)
            np.testing.assert_allclose(
                pool.store.ring[tick % pool.store.capacity, stream.row], expected, atol=1e-4
            )
        for stream, reference, _ in streams:
            if reference.values:
                path = data.draw(st.sampled_from(sorted(reference.values)))
                value = draw_value(data, path, reference.values[path])
                pool.set(stream, path, value)
                reference.values[path] = value

"""What all tests share."""

from __future__ import annotations

import gc
import signal
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # as a shell starts what runs behind it
    signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_sessionstart() -> None:
    """Let the garbage collector look less often: tracing makes many small objects."""
    gc.freeze()
    gc.set_threshold(50_000, 20, 20)


@pytest.fixture
def rng() -> np.random.Generator:
    """A generator with a fixed seed."""
    return np.random.default_rng(20191211)


@pytest.fixture(scope="session")
def slew() -> Callable[..., Any]:
    """A function that flies a slew of a small satellite by 30 deg; keywords change its setup."""
    from nullmotion import laws, layouts, metrics, sim, spacecraft
    from nullmotion.spacecraft import controllers

    measured = tuple(metrics.get(name)() for name in metrics.applicable(True))

    def fly(**changes: Any) -> Any:
        setup = {
            "array": layouts.pyramid(rate_limit=1.0),
            "law": laws.create("sr"),
            "delta": np.zeros(4),
            "hdot": np.zeros(3),
            "dt": 0.05,
            "steps": 400,
            "spacecraft": spacecraft.Spacecraft(np.array([10.0, 12.0, 8.0])),
            "controller": controllers.create("quaternion-feedback", kp=5.0, kw=10.0),
            "target": np.array([np.cos(np.pi / 12), np.sin(np.pi / 12), 0.0, 0.0]),
            "servo": spacecraft.Servo(inertia=0.005, torque_limit=0.5),
            "metrics": measured,
        }
        return sim.run(sim.Setup(**setup | changes))

    return fly


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark as slow all but n evenly spread cases of ``sampled(n)``; keep dear files whole."""
    cases: dict[str, list[pytest.Item]] = {}
    for item in items:
        if item.path.parent.name == "papers" or item.path.name.startswith("test_rover"):
            item.add_marker(pytest.mark.xdist_group(item.path.stem))  # dear fixtures, made once
        if item.get_closest_marker("sampled"):
            cases.setdefault(item.nodeid.partition("[")[0], []).append(item)
    for group in cases.values():
        marker = group[0].get_closest_marker("sampled")
        assert marker is not None
        kept = {len(group) * i // marker.args[0] for i in range(marker.args[0])}
        for index, item in enumerate(group):
            if index not in kept:
                item.add_marker(pytest.mark.slow)

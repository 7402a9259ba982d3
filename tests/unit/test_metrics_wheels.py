"""Metrics of wheels whose speed changes, against NumPy and what must hold by definition."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import metrics
from nullmotion.array.wheels import Wheels
from nullmotion.compile import compile_function
from nullmotion.metrics import Sample
from nullmotion.scenario import build
from nullmotion.sim import run

INERTIA = np.array([1e-3, 2e-3, 1e-3, 5e-4])
DESIGN = np.array([200.0, 100.0, 150.0, 400.0])
NAMES = ["momentum_settling_s", "wheel_settling_s", "wheel_speed_error", "wheel_torque_Nm"]


def array(design: np.ndarray = DESIGN) -> nm.CmgArray:
    return replace(nm.layouts.pyramid(), h0=INERTIA * design, wheels=Wheels(INERTIA))


def sample(speed: Any, acceleration: Any = 0.0, design: np.ndarray = DESIGN) -> Sample:
    """Return a sample as the time loop makes it: momenta of now, beside those of the design."""
    speed, zero = np.asarray(speed, float), np.zeros(4)
    made = array(design)
    return Sample(
        array=made.altered(h0=INERTIA * speed),
        delta=np.array([0.3, -0.2, 0.5, 0.1]),
        hdot=np.array([0.1, 0.0, 0.0]),
        t=2.0,
        rates=zero,
        previous_rates=zero,
        momentum_wanted=np.zeros(3),
        impulse=np.zeros(3),
        asked=zero,
        motor_torque=zero,
        dt=0.5,
        turning=made,
        wheel_speed=speed,
        wheel_acceleration=np.broadcast_to(np.asarray(acceleration, float), (4,)),
    )


def value(name: str, x: Sample, **parameters: Any) -> float:
    return float(metrics.get(name)(**parameters).of(x))


def test_the_catalogue_tells_who_has_them() -> None:
    assert set(NAMES) == set(metrics.applicable(False, True)) - set(metrics.applicable(False))
    assert not set(NAMES) & set(metrics.applicable(True))
    assert set(metrics.applicable(True, True)) == set(metrics.names())


def test_the_speed_error_is_the_largest_share() -> None:
    x = sample(DESIGN * [1.0, 0.9, 1.02, 1.0])
    assert value("wheel_speed_error", x) == pytest.approx(0.1)
    assert value("wheel_speed_error", sample(np.zeros(4))) == 1.0
    assert value("wheel_speed_error", sample(-DESIGN)) == 2.0


@pytest.mark.parametrize(("share", "expected"), [(0.979, 2.5), (0.981, 0.0), (1.021, 2.5)])
def test_every_wheel_has_to_settle(share: float, expected: float) -> None:
    off = DESIGN * np.array([1.0, 1.0, 1.0, share])
    assert value("wheel_settling_s", sample(off)) == expected
    assert value("wheel_settling_s", sample(off), tolerance=0.05) == 0.0


def test_the_momentum_settles_by_its_norm() -> None:
    mu = np.array([0.0, 0.0, 0.0, 1.0]) * 0.03 * INERTIA[3] * DESIGN[3]
    within = np.linalg.norm(mu) / np.linalg.norm(INERTIA * DESIGN)
    assert within < 0.02  # one wheel is off by 3 %, all momenta by less than 2 %
    x = sample(DESIGN - mu / INERTIA)
    assert value("wheel_settling_s", x) == 2.5
    assert value("momentum_settling_s", x) == 0.0
    assert value("momentum_settling_s", x, tolerance=0.99 * within) == 2.5
    assert value("momentum_settling_s", x, tolerance=1.01 * within) == 0.0


def test_the_torque_is_inertia_times_acceleration() -> None:
    x = sample(DESIGN, [1.0, -2.0, 3.0, -9.0])
    assert value("wheel_torque_Nm", x) == pytest.approx(4.5e-3)


def test_a_wheel_without_a_design_speed_counts_for_nothing() -> None:
    design = DESIGN * [1.0, 1.0, 1.0, 0.0]
    x = sample([200.0, 100.0, 150.0, 77.0], design=design)
    assert value("wheel_speed_error", x) == 0.0
    assert value("wheel_settling_s", x) == 0.0
    assert value("momentum_settling_s", x) == 0.0


def test_compiled_they_are_the_same(rng: np.random.Generator) -> None:
    def together(speed: Any, acceleration: Any) -> Any:
        x = replace(sample(np.zeros(4)), wheel_speed=speed, wheel_acceleration=acceleration)
        return tuple(metrics.get(name)().of(x) for name in NAMES)

    speeds = DESIGN * rng.uniform(0.95, 1.05, (50, 4))
    speeds[0], speeds[1] = 0.0, -DESIGN
    accelerations = rng.normal(size=(50, 4))
    kernel = np.array(compile_function(together, np.zeros(4), np.zeros(4))(speeds, accelerations))
    for i in range(50):
        x = sample(speeds[i], accelerations[i])
        plain = [value(name, x) for name in NAMES]
        assert np.allclose(kernel[:, i], plain, rtol=1e-12)


@pytest.mark.parametrize(
    "speed",
    [
        0.0,
        [0.0, 0.0, 0.0, -30.0],
        [-200.0, 200.0, -200.0, 200.0],
    ],
)
def test_all_metrics_are_finite_whatever_the_wheels_do(speed: Any) -> None:
    scenario = nm.load_scenario(
        "vscmg-startup", {"simulation.duration_s": 0.05, "initial.wheel_speed_rad_s": speed}
    )
    found = run(build.setup(scenario), backend="python").metrics
    times = {name for name in found if name.endswith("settling_s") or name == "settling_time_s"}
    assert {n for n, v in found.items() if not np.isfinite(v)} == times  # nothing settled


def test_metrics_of_a_startup_are_those_of_its_history() -> None:
    values = {"simulation.duration_s": 60.0, "mission.wheel_tolerance": 0.5}
    scenario = nm.load_scenario("vscmg-startup", values)
    names = (*NAMES, "settling_time_s")
    result = run(build.setup(scenario, names))
    off = np.abs(result.wheel_speed / 200.0 - 1.0)
    mu = np.linalg.norm(200.0 - result.wheel_speed, axis=1) / np.linalg.norm([200.0] * 4)
    m, torque = result.metrics, 6.95e-4 * np.abs(result.wheel_acceleration[:-1])
    assert m["final_wheel_speed_error"] == pytest.approx(off[-1].max(), rel=1e-12)
    assert m["max_wheel_speed_error"] == pytest.approx(off.max(), rel=1e-12)
    assert m["max_wheel_torque_Nm"] == pytest.approx(torque.max(), rel=1e-9)
    late = np.flatnonzero(off.max(axis=1) > 0.5).max() + 1
    assert m["wheel_settling_s"] == pytest.approx(result.t[late], abs=1e-9)
    late = np.flatnonzero(mu > 0.5).max() + 1
    assert m["momentum_settling_s"] == pytest.approx(result.t[late], abs=1e-9)
    assert 20 < m["momentum_settling_s"] < m["wheel_settling_s"] < 60

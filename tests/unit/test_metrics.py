"""Every metric against plain NumPy written from its definition, as floats and compiled."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nullmotion as nm
from nullmotion import metrics
from nullmotion.compile import compile_function
from nullmotion.metrics import Sample
from nullmotion.sim import Setup, Trajectory, run
from nullmotion.spacecraft import Servo, Spacecraft, controllers

NAMES = [
    "along_axis_torque_fraction",
    "body_rate_deg_s",
    "condition_number",
    "gimbal_travel_rad",
    "momentum_Nms",
    "momentum_error_Nms",
    "momentum_reserve_Nms",
    "momentum_state",
    "motor_power_W",
    "motor_torque_Nm",
    "off_axis_impulse_Nms",
    "off_axis_torque_fraction",
    "peak_rate_rad_s",
    "pointing_error_deg",
    "rate_saturated_s",
    "rate_step_rad_s",
    "residual_momentum",
    "settling_time_s",
    "sigma_min",
    "sqrt_det_AAT",
]
UNITS = {  # the first that fits
    "_Nms": "N m s",
    "_rad_s": "rad/s",
    "_deg_s": "deg/s",
    "_Nm": "N m",
    "_rad": "rad",
    "_deg": "deg",
    "_W": "W",
    "_s": "s",
    "": "1",
}
ARRAYS: dict[str, Callable[[], nm.CmgArray]] = {
    "pyramid": lambda: nm.layouts.pyramid(h0=2.0, rate_limit=1.2),
    "unequal": lambda: nm.layouts.roof6(
        h0=[1.0, 2.0, 0.5, 3.0, 1.5, 0.7], rate_limit=[1.0, 2.0, 3.0, 2.5, 1.5, 2.0]
    ),
    "frozen": lambda: nm.layouts.orthogonal_pairs(h0=1.5).without(1, frozen_at=0.4),
    "planar": lambda: nm.layouts.planar(n=5, h0=0.5),
    "triangle": lambda: nm.layouts.triangle(),
}


def rotated(angle: float, axis: Any) -> np.ndarray:
    """Return the quaternion, scalar first, of a rotation by 0 to pi."""
    x, y, z, w = Rotation.from_rotvec(angle * np.array(axis) / np.linalg.norm(axis)).as_quat()
    return np.array([w, x, y, z]) * (1.0 if w >= 0 else -1.0)


def sample(array: nm.CmgArray, seed: int, **fixed: Any) -> Sample:
    """Return a random sample."""
    rng = np.random.default_rng(seed)
    n, m = array.n, array.m
    values = {
        "delta": rng.uniform(-np.pi, np.pi, n),
        "hdot": rng.normal(size=m),
        "t": 0.5,
        "rates": rng.normal(size=n),
        "previous_rates": rng.normal(size=n),
        "momentum_wanted": rng.normal(size=m),
        "impulse": rng.normal(size=m),
        "asked": rng.normal(size=n),
        "motor_torque": rng.normal(size=n),
        "omega_BN_B": rng.normal(size=3),
        "q_BR": rotated(rng.uniform(0, np.pi), rng.normal(size=3)),
        "dt": 0.02,
    }
    return Sample(array, **(values | fixed))


def vectors(array: nm.CmgArray, delta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return each CMG's unit momentum and unit column of A in B by Rodrigues' formula."""
    g, s = array.gimbal_axes, array.spin_axes
    c, sn = np.cos(delta)[:, None], np.sin(delta)[:, None]
    h = s * c + np.cross(g, s) * sn  # g is perpendicular to s
    return h, np.cross(g, h)


def expected(x: Sample) -> dict[str, float]:
    """Return every metric from its definition."""
    array = x.array
    basis, h0 = array.torque_axes, array.h0
    h, a = vectors(array, x.delta)
    momentum = basis @ (h0 @ h + array.momentum_bias)
    jacobian = basis @ (a * h0[:, None]).T
    torque = jacobian @ x.rates
    command = np.linalg.norm(x.hdot)
    e = x.hdot / command
    sigma = np.linalg.svd(jacobian / h0.mean(), compute_uv=False)

    def across(v: np.ndarray) -> float:
        return float(np.linalg.norm((np.eye(len(e)) - np.outer(e, e)) @ v))

    e3 = basis.T @ e
    projected = np.array([np.cross(g, np.cross(e3, g)) for g in array.gimbal_axes])
    lengths = np.linalg.norm(projected, axis=1, keepdims=True)
    saturated = (h0[:, None] * projected / lengths).sum(axis=0) + array.momentum_bias
    theta = np.arccos(np.clip(h @ e3, -1, 1))
    alpha = np.arccos(np.abs(np.clip(array.gimbal_axes @ e3, -1, 1)))
    residual = float(np.sum(theta - (np.pi / 2 - alpha)) / np.pi)
    turn = Rotation.from_quat(np.roll(x.q_BR, -1)).magnitude()
    return {
        "along_axis_torque_fraction": abs(torque @ e - command) / command,
        "body_rate_deg_s": np.linalg.norm(x.omega_BN_B) * 180.0 / np.pi,
        "condition_number": sigma[0] / sigma[-1],
        "gimbal_travel_rad": np.linalg.norm(x.rates, 1),
        "momentum_Nms": np.linalg.norm(momentum),
        "momentum_error_Nms": np.linalg.norm(momentum - x.momentum_wanted),
        "momentum_reserve_Nms": np.linalg.norm(basis @ saturated) - np.linalg.norm(momentum),
        "momentum_state": residual + sigma[-1],
        "motor_power_W": sum(abs(t * r) for t, r in zip(x.motor_torque, x.rates, strict=True)),
        "motor_torque_Nm": np.linalg.norm(x.motor_torque, np.inf),
        "off_axis_impulse_Nms": across(x.impulse),
        "off_axis_torque_fraction": across(torque) / command,
        "peak_rate_rad_s": np.abs(x.rates).max(),
        "pointing_error_deg": turn * 180.0 / np.pi,
        "rate_saturated_s": float((np.abs(x.asked) > array.rate_limit).any()),
        "rate_step_rad_s": np.abs(x.rates - x.previous_rates).max(),
        "residual_momentum": residual,
        "settling_time_s": 0.52 if turn > np.radians(0.1) else 0.0,
        "sigma_min": sigma[-1],
        "sqrt_det_AAT": np.sqrt(np.linalg.det(jacobian @ jacobian.T)) / h0.mean() ** len(e),
    }


def evaluated(x: Sample) -> dict[str, Any]:
    """Return every metric of the catalogue."""
    return {name: metrics.get(name)().of(x) for name in NAMES}


FIELDS = ("delta", "hdot", "rates", "previous_rates", "momentum_wanted", "impulse")
FIELDS += ("asked", "motor_torque", "omega_BN_B", "q_BR")


@cache
def compiled(key: str) -> Any:
    """Compile all metrics of one array together."""
    array = ARRAYS[key]()

    def together(*values: Any) -> Any:
        x = Sample(array=array, t=0.5, dt=0.02, **dict(zip(FIELDS, values, strict=True)))
        return tuple(evaluated(x).values())

    n, m = array.n, array.m
    shapes = {"hdot": m, "momentum_wanted": m, "impulse": m, "omega_BN_B": 3, "q_BR": 4}
    return compile_function(together, *[np.zeros(shapes.get(f, n)) for f in FIELDS])


def through_the_kernel(key: str, samples: list[Sample]) -> list[dict[str, float]]:
    """Return every metric of every sample from compiled code."""
    columns = [np.stack([getattr(x, f) for x in samples]) for f in FIELDS]
    rows = zip(*compiled(key)(*columns), strict=True)
    return [dict(zip(NAMES, row, strict=True)) for row in rows]


def test_the_catalogue() -> None:
    assert set(NAMES) <= set(metrics.names())
    for name in metrics.names():
        cls = metrics.get(name)
        assert cls.title and cls.reductions and cls.__doc__
        assert cls.unit == next(unit for suffix, unit in UNITS.items() if name.endswith(suffix))


@pytest.mark.parametrize("key", ARRAYS)
@pytest.mark.sampled(3)
def test_against_the_definitions(key: str) -> None:
    samples = [sample(ARRAYS[key](), seed) for seed in range(20)]
    kernel = through_the_kernel(key, samples)
    for x, compiled_values in zip(samples, kernel, strict=True):
        values, truth = evaluated(x), expected(x)
        for name in NAMES:
            tolerance = 1e-9 * max(1.0, abs(truth[name]))
            assert values[name] == pytest.approx(truth[name], abs=tolerance), name
            assert compiled_values[name] == pytest.approx(truth[name], abs=tolerance), name


@pytest.mark.parametrize("key", ARRAYS)
def test_degenerate_samples_are_finite(key: str) -> None:
    """No command, no rates, no momentum, rotors along the command: no 0/0 anywhere."""
    array = ARRAYS[key]()
    n, zero = array.n, np.zeros(array.m)
    along = array.rotor_momenta(np.zeros(n))[0]
    axis = array.torque_axes @ array.gimbal_axes[0]
    samples = [
        sample(array, 0, hdot=zero),
        sample(array, 0, hdot=zero, delta=np.zeros(n), rates=np.zeros(n), impulse=zero),
        sample(array, 0, hdot=along, delta=np.zeros(n)),
        sample(array, 0, hdot=-along, delta=np.zeros(n)),
        sample(array, 0, hdot=axis, delta=np.zeros(n)),
        sample(array, 0, hdot=1e-9 * along),
        sample(array, 0, hdot=1e9 * along),
        sample(array, 0, q_BR=np.array([1.0, 0, 0, 0]), omega_BN_B=np.zeros(3)),
        sample(array, 0, q_BR=np.array([0.0, 0, -1.0, 0]), motor_torque=np.zeros(n)),
    ]
    for x, kernel in zip(samples, through_the_kernel(key, samples), strict=True):
        values = evaluated(x)
        assert np.isfinite(list(values.values())).all()
        for name in NAMES:
            if name != "condition_number" or values[name] < 1e8:
                assert kernel[name] == pytest.approx(values[name], rel=1e-9, abs=1e-7), name


def test_without_a_command() -> None:
    x = sample(nm.layouts.pyramid(), 1, hdot=np.zeros(3))
    values = evaluated(x)
    assert values["off_axis_torque_fraction"] == 0 and values["along_axis_torque_fraction"] == 0
    assert values["off_axis_impulse_Nms"] == pytest.approx(np.linalg.norm(x.impulse))


def test_saturation_leaves_no_reserve() -> None:
    array, e = nm.layouts.pyramid(h0=2.0), np.array([0.3, -0.5, 0.7])
    delta = np.arctan2(array.transverse_axes @ e, array.spin_axes @ e)
    values = evaluated(sample(array, 2, delta=delta, hdot=e))
    assert values["momentum_reserve_Nms"] == pytest.approx(0, abs=1e-12)
    assert values["residual_momentum"] == pytest.approx(0, abs=1e-7)
    assert values["momentum_state"] == pytest.approx(values["sigma_min"], abs=1e-7)
    assert values["sigma_min"] < 1e-12  # saturation is a singular state
    opposite = evaluated(sample(array, 2, delta=delta + np.pi, hdot=e))
    assert opposite["residual_momentum"] > 1.0


def test_a_singular_state() -> None:
    delta = np.radians([-90.0, 0.0, 90.0, 0.0])
    values = evaluated(sample(nm.layouts.pyramid(), 3, delta=delta))
    assert values["sigma_min"] < 1e-15 and values["sqrt_det_AAT"] < 1e-15
    assert 1e15 < values["condition_number"] <= 2.1e16


def test_the_pseudo_inverse_has_no_torque_error() -> None:
    array, delta = nm.layouts.pyramid(), np.array([0.3, -0.2, 0.5, 0.1])
    hdot = np.array([0.3, 0.4, -0.2])
    rates = np.linalg.pinv(array.jacobian(delta)) @ hdot
    for factor, error in ((1.0, 0.0), (0.75, 0.25), (0.0, 1.0), (-1.0, 2.0)):
        values = evaluated(sample(array, 4, delta=delta, hdot=hdot, rates=factor * rates))
        assert values["along_axis_torque_fraction"] == pytest.approx(error, abs=1e-14)
        assert values["off_axis_torque_fraction"] == pytest.approx(0, abs=1e-14)


def test_a_half_turn_is_as_far_as_it_gets() -> None:
    for q, angle in (([0.0, 1, 0, 0], 180.0), ([-1.0, 0, 0, 0], 0.0), ([0.6, 0, 0.8, 0], None)):
        x = sample(nm.layouts.pyramid(), 5, q_BR=np.array(q))
        expected_angle = 2.0 * np.degrees(np.arccos(0.6)) if angle is None else angle
        value = metrics.get("pointing_error_deg")().of(x)
        assert value == pytest.approx(expected_angle, abs=1e-13)


@pytest.mark.parametrize(("off", "time"), [(0.099, 0.0), (0.101, 0.52)])
def test_settled_within_the_tolerance(off: float, time: float) -> None:
    x = sample(nm.layouts.pyramid(), 6, q_BR=rotated(np.radians(off), [1.0, 2.0, 3.0]))
    assert metrics.get("settling_time_s")().of(x) == pytest.approx(time, abs=1e-15)
    loose = metrics.get("settling_time_s")(tolerance=np.radians(1.0))
    assert loose.of(x) == 0.0


def slew(steps: int, **more: Any) -> Trajectory:
    """Return a slew of 40 deg with every metric that there is."""
    array, law = nm.layouts.pyramid(rate_limit=0.6), nm.laws.create("sr")
    target = rotated(np.radians(40.0), [2.0, -1.0, 2.0])
    base = {
        "dt": 0.01,
        "steps": steps,
        "spacecraft": Spacecraft([12.0, 9.0, 14.0]),
        "controller": controllers.create("quaternion-feedback", kp=4.0, kw=12.0),
        "target": target,
        "servo": Servo(time_constant=0.05, inertia=0.05),
        "metrics": tuple(metrics.get(name)() for name in metrics.applicable(True)),
    }
    return run(Setup(array, law, np.zeros(4), np.zeros(3), **{**base, **more}))


@pytest.mark.parametrize(
    "servo", [Servo(time_constant=0.05, inertia=0.05), pytest.param(None, marks=pytest.mark.slow)]
)
def test_metrics_of_a_slew_are_those_of_its_history(servo: Any) -> None:
    result = slew(4500, servo=servo)
    m, n = result.metrics, 4500
    torque, rates = result.motor_torque[:n], result.rates[:n]
    error = np.degrees(result.pointing_error)
    body = np.degrees(np.linalg.norm(result.omega_BN_B, axis=1))
    power = np.abs(torque * rates).sum(axis=1)
    saturated = (np.abs(result.rates_asked[:n]) > 0.6).any(axis=1).sum()
    truth = {
        "final_pointing_error_deg": error[-1],
        "max_pointing_error_deg": error.max(),
        "settling_time_s": result.t[np.flatnonzero(error > 0.1).max() + 1],
        "max_motor_torque_Nm": np.abs(torque).max(),
        "max_motor_power_W": power.max(),
        "mean_motor_power_W": power.mean(),
        "gimbal_travel_rad": np.abs(np.diff(result.delta, axis=0)).sum(),
        "rate_saturated_s": 0.01 * saturated,
        "max_body_rate_deg_s": body.max(),
        "final_body_rate_deg_s": body[-1],
    }
    for name, value in truth.items():
        assert m[name] == pytest.approx(value, rel=1e-9, abs=1e-11), name
    assert 20 < truth["settling_time_s"] < 40 and saturated > 20
    assert np.abs(np.ptp(result.delta, axis=0)).sum() < truth["gimbal_travel_rad"]


def test_torque_of_ideal_motors() -> None:
    """They work against omega . c alone: at most h0 times the body rate."""
    result = slew(1000, servo=None, metrics=(metrics.get("motor_torque_Nm")(),))
    body = np.linalg.norm(result.omega_BN_B, axis=1)[:1000]
    assert result.metrics["max_motor_torque_Nm"] <= body.max() * 1.0
    assert result.metrics["max_motor_torque_Nm"] > 0.3 * body.max()


def test_a_slew_that_does_not_settle_has_no_settling_time() -> None:
    metric = (metrics.get("settling_time_s")(),)
    assert np.isnan(slew(300, metrics=metric).metrics["settling_time_s"])
    there = rotated(np.radians(0.05), [1.0, 0.0, 0.0])
    assert slew(300, metrics=metric, target=there).metrics["settling_time_s"] == 0.0

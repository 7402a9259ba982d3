"""Every metric against plain NumPy written from its definition, as floats and compiled."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import metrics
from nullmotion.compile import compile_function
from nullmotion.metrics import Sample

NAMES = [
    "along_axis_torque_fraction",
    "condition_number",
    "momentum_Nms",
    "momentum_error_Nms",
    "momentum_reserve_Nms",
    "momentum_state",
    "off_axis_impulse_Nms",
    "off_axis_torque_fraction",
    "peak_rate_rad_s",
    "rate_step_rad_s",
    "residual_momentum",
    "sigma_min",
    "sqrt_det_AAT",
]
ARRAYS: dict[str, Callable[[], nm.CmgArray]] = {
    "pyramid": lambda: nm.layouts.pyramid(h0=2.0),
    "unequal": lambda: nm.layouts.roof6(h0=[1.0, 2.0, 0.5, 3.0, 1.5, 0.7]),
    "frozen": lambda: nm.layouts.orthogonal_pairs(h0=1.5).without(1, frozen_at=0.4),
    "planar": lambda: nm.layouts.planar(n=5, h0=0.5),
    "triangle": lambda: nm.layouts.triangle(),
}


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
    return {
        "along_axis_torque_fraction": abs(torque @ e - command) / command,
        "condition_number": sigma[0] / sigma[-1],
        "momentum_Nms": np.linalg.norm(momentum),
        "momentum_error_Nms": np.linalg.norm(momentum - x.momentum_wanted),
        "momentum_reserve_Nms": np.linalg.norm(basis @ saturated) - np.linalg.norm(momentum),
        "momentum_state": residual + sigma[-1],
        "off_axis_impulse_Nms": across(x.impulse),
        "off_axis_torque_fraction": across(torque) / command,
        "peak_rate_rad_s": np.abs(x.rates).max(),
        "rate_step_rad_s": np.abs(x.rates - x.previous_rates).max(),
        "residual_momentum": residual,
        "sigma_min": sigma[-1],
        "sqrt_det_AAT": np.sqrt(np.linalg.det(jacobian @ jacobian.T)) / h0.mean() ** len(e),
    }


def evaluated(x: Sample) -> dict[str, Any]:
    """Return every metric of the catalogue."""
    return {name: metrics.get(name)().of(x) for name in NAMES}


FIELDS = ("delta", "hdot", "rates", "previous_rates", "momentum_wanted", "impulse")


@cache
def compiled(key: str) -> Any:
    """Compile all metrics of one array together."""
    array = ARRAYS[key]()

    def together(*values: Any) -> Any:
        x = Sample(array=array, t=0.5, **dict(zip(FIELDS, values, strict=True)))
        return tuple(evaluated(x).values())

    n, m = array.n, array.m
    shapes = {"hdot": m, "momentum_wanted": m, "impulse": m}
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
        suffixes = [("_Nms", "N m s"), ("_rad_s", "rad/s"), ("_Nm", "N m"), ("", "1")]
        assert cls.unit == next(unit for suffix, unit in suffixes if name.endswith(suffix))


@pytest.mark.parametrize("key", ARRAYS)
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

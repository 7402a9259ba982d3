"""Plant errors reach the true array alone, for every law, compiled or not."""

from __future__ import annotations

import numpy as np
import pytest

from nullmotion import laws, layouts
from nullmotion.campaign import compare
from nullmotion.scenario import load_scenario
from nullmotion.sim import run

VALUES = {
    "plant.gimbal_axis_error_deg": 0.5,
    "plant.h0_error": 0.01,
    "plant.encoder_bias_deg": 0.0,
    "simulation.duration_s": 0.6,
}


QUICK = ("pseudo-inverse", "dsea")
NAMES = [
    n if n in QUICK else pytest.param(n, marks=pytest.mark.slow)
    for n in laws.names()
    if not laws.create(n).supports(layouts.create("pyramid"))
]


@pytest.mark.parametrize("law", NAMES)
def test_every_law_meets_plant_errors(law):
    scenario = load_scenario("plant-errors", {**VALUES, "law.name": law})
    case = compare(scenario, [law]).cases[0]
    assert case.law == law
    kernel = case.trajectory
    assert case.metrics["max_off_axis_torque_fraction"] > 1e-4
    nominal, true = kernel.setup.array, kernel.setup.true_array
    tilt = np.degrees(np.arccos(np.sum(nominal.gimbal_axes * true.gimbal_axes, axis=1)))
    np.testing.assert_allclose(tilt, 0.5, rtol=1e-6)
    off = true.h0 / nominal.h0 - 1
    assert (np.abs(off) <= 0.01).all() and (np.abs(off) > 0).any()
    np.testing.assert_array_equal(nominal.h0, 1.0)

    if not kernel.setup.law.traceable:
        return  # a host law has no kernel to compare with
    plain = run(kernel.setup, backend="python")
    assert (kernel.backend, plain.backend) == ("kernel", "python")
    assert len(plain.t) == len(kernel.t) == 61
    np.testing.assert_allclose(kernel.torque[:-1], plain.torque[:-1], rtol=0, atol=1e-9)
    for key, value in kernel.metrics.items():
        np.testing.assert_allclose(value, plain.metrics[key], rtol=1e-9, atol=1e-9)

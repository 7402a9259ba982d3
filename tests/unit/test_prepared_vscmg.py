"""A prepared law of variable-speed CMGs answers as its source does."""

from __future__ import annotations

import numpy as np

import nullmotion as nm


def test_rates_and_accelerations_are_those_of_the_law():
    wheels = nm.Wheels(np.array(0.01), torque_limit=np.array(0.5))
    array = nm.layouts.pyramid(h0=2.0, rate_limit=1.0, wheels=wheels)
    law = nm.laws.create("vscmg-weighted")
    prepared, rng = nm.prepare(law, array), np.random.default_rng(3)
    assert np.array_equal(prepared.wheel_speed, array.design_speed)
    for _ in range(20):
        delta, hdot, speed = rng.normal(size=4), rng.normal(size=3), rng.normal(size=4) * 200.0
        prepared.wheel_speed[:] = speed
        rates = prepared(delta, hdot, 0.5)
        seen = nm.Observation(delta, hdot, 0.5, 0.01, wheel_speed=speed)
        (wanted, accelerations), _ = law.step(array, seen, law.init(array, delta))
        np.testing.assert_allclose(rates, wanted, rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(prepared.accelerations, accelerations, rtol=1e-9, atol=1e-9)

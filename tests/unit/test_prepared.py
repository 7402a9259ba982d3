"""A prepared law gives what the plain law gives, call by call."""

from __future__ import annotations

import numpy as np
import pytest

import nullmotion as nm


@pytest.mark.parametrize("name", ["pseudo-inverse", "sr", "dsea", "vcbsae"])
def test_prepared_equals_plain(name, rng):
    array = nm.layouts.pyramid(rate_limit=2.0)
    law = nm.laws.create(name)
    prepared = nm.prepare(law, array, period=0.02)
    state = law.init(array, np.zeros(4))
    for k in range(20):
        delta, hdot, t = rng.uniform(-1, 1, 4), rng.normal(size=3), 0.02 * k
        rates, state = law.step(array, nm.Observation(delta, hdot, t, 0.02), state)
        np.testing.assert_allclose(prepared(delta, hdot, t), array.limited(rates), atol=1e-10)
    assert prepared.status == []


def test_reset_starts_the_state_anew(rng):
    array = nm.layouts.pyramid(rate_limit=2.0)
    prepared = nm.prepare(nm.laws.create("dsea"), array)
    first = prepared(np.full(4, 0.1), [1.0, 0.0, 0.0]).copy()
    for _ in range(5):
        prepared(rng.uniform(-1, 1, 4), rng.normal(size=3))
    prepared.reset()
    np.testing.assert_array_equal(prepared(np.full(4, 0.1), [1.0, 0.0, 0.0]), first)


def test_status_and_refusal():
    array = nm.layouts.pyramid()
    prepared = nm.prepare(nm.laws.create("sr"), array)
    prepared(np.array([2e5, 0, 0, 0]), np.ones(3))
    assert prepared.status == ["angle-range"]
    with pytest.raises(nm.NullmotionError, match="nd"):
        nm.prepare(nm.laws.create("nd"), nm.layouts.planar(n=2))

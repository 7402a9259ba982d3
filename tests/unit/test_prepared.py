"""A prepared law gives what the plain law gives, call by call."""

from __future__ import annotations

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import tree
from nullmotion.compile import compile_function


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


def test_a_call_runs_the_same_code_as_a_batch(rng):
    """Arguments, carried state and flags in one buffer, against the kernel over batches."""
    array, law = nm.layouts.pyramid(rate_limit=2.0), nm.laws.create("dsea")
    state = law.init(array, np.zeros(4))

    def step(delta, hdot, t, state):
        rates, after = law.step(array, nm.Observation(delta, hdot, t, 0.01), state)
        return array.limited(rates), after

    batch = compile_function(step, np.zeros(4), np.zeros(3), 0.0, state, width=1)
    prepared = nm.prepare(law, array)
    carried = np.array(tree.flatten(state), float)[None]
    for k in range(10):
        delta, hdot, t = rng.uniform(-1, 1, 4), rng.normal(size=3), np.array([0.01 * k])
        rates, after = batch(delta[None], hdot[None], t, carried)
        np.testing.assert_array_equal(prepared(delta, hdot, t[0]), rates[0])
        carried = np.concatenate([np.reshape(leaf, (1, -1)) for leaf in after], axis=1)


def test_status_and_refusal():
    array = nm.layouts.pyramid()
    prepared = nm.prepare(nm.laws.create("sr"), array)
    prepared(np.array([2e5, 0, 0, 0]), np.ones(3))
    assert prepared.status == ["angle-range"]
    with pytest.raises(nm.NullmotionError, match="nd"):
        nm.prepare(nm.laws.create("nd"), nm.layouts.planar(n=2))

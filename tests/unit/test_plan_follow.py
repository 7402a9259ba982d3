"""The law follow-plan: its course, its null motion, its base law."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import Observation, laws, tree
from nullmotion.errors import InputError
from nullmotion.sim import Setup, run

HDOT = np.array([0.4, -0.2, 0.3])


def made(**fields):
    return laws.create("follow-plan", **fields)


@pytest.mark.parametrize("knots", [(0.3,), (1.0, -1.0), (0.2, 0.0, -0.7, 1.0, 0.5)])
def test_the_course_is_linear_between_knots_and_over_at_the_end(knots):
    law = made(knots=knots, duration_s=3.0, k_max=0.4)
    times = np.linspace(0.0, 2.999, 50)
    expected = 0.4 * np.interp(times, np.linspace(0.0, 3.0, len(knots)), knots)
    np.testing.assert_allclose([law.gain(t) for t in times], expected, atol=1e-14)
    assert law.gain(3.0) == law.gain(5.0) == 0.0


@pytest.mark.parametrize("layout", ["pyramid", "box90", "planar", "roof6"])
def test_the_torque_is_that_of_the_base_law(layout, rng):
    array = nm.layouts.create(layout)
    law = made(base="pseudo-inverse", knots=(0.8, -0.5), duration_s=2.0)
    base = laws.create("pseudo-inverse")
    for _ in range(20):
        delta, hdot = rng.uniform(-3, 3, array.n), rng.normal(size=array.m)
        seen = Observation(delta, hdot, 0.3)
        rates = law.step(array, seen, law.init(array, delta))[0]
        plain = base.step(array, seen, ())[0]
        assert np.linalg.norm(rates - plain) > 1e-6
        np.testing.assert_allclose(array.jacobian(delta) @ (rates - plain), 0, atol=1e-12)


def test_the_null_vector_is_the_paper_s(rng):
    array, law = nm.layouts.pyramid(), made(knots=(1.0,), k_max=0.7)
    delta = rng.uniform(-3, 3, 4)
    c = array.jacobian(delta).T
    minors = [np.linalg.det([c[j] for j in range(4) if j != i]) for i in range(4)]
    null = np.array([1, -1, 1, -1]) * minors  # Eq 23
    rates = law.step(array, Observation(delta, np.zeros(3)), law.init(array, delta))[0]
    np.testing.assert_allclose(rates, 4 * 0.7 * null, atol=1e-14)


def test_with_a_lag_the_null_vector_is_that_of_the_sample_before(rng):
    array = nm.layouts.pyramid()
    late, now = made(knots=(1.0,), lag=True), made(knots=(1.0,))
    first, second = rng.uniform(-3, 3, (2, 4))
    none = Observation(first, np.zeros(3)), Observation(second, np.zeros(3), 0.01)
    rates, state = late.step(array, none[0], late.init(array, first))
    assert not rates.any()
    rates, _ = late.step(array, none[1], state)
    np.testing.assert_allclose(rates, now.step(array, none[0], now.init(array, first))[0])


def test_the_base_law_keeps_its_state_and_its_parameters_stay_leaves():
    array = nm.layouts.pyramid(rate_limit=np.pi)
    setup = Setup(array, laws.create("vcbsae", sigma_c=0.2), np.zeros(4), HDOT, steps=200)
    follow = made(base="vcbsae", base_parameters={"sigma_c": 0.2})
    assert tree.flatten(made(base="vcbsae", base_parameters={"sigma_c": 0.123})).count(0.123) == 1
    alone, followed = run(setup), run(dataclasses.replace(setup, law=follow))
    np.testing.assert_allclose(followed.delta, alone.delta, atol=1e-12)
    assert follow.base_law == laws.create("vcbsae", sigma_c=0.2)
    assert dataclasses.replace(follow, knots=(1.0,)).base_law == follow.base_law


def test_exactness_is_that_of_the_base_law():
    array = nm.layouts.pyramid()
    assert made().exact_above(array) == laws.create("sr").exact_above(array)
    assert made(base="pseudo-inverse").supports(nm.layouts.pyramid(n=3))
    assert not made().supports(array)


@pytest.mark.parametrize(
    ("fields", "key"),
    [
        ({"knots": ()}, "law.knots"),
        ({"knots": (float("nan"),)}, "law.knots"),
        ({"knots": "ab"}, "law.knots"),
        ({"duration_s": 0.0}, "law.duration_s"),
        ({"k_max": -1.0}, "law.k_max"),
        ({"base": "follow-plan"}, "law.base"),
        ({"base": "no-such-law"}, "law.base"),
        ({"base": 3}, "law.base"),
        ({"base_parameters": 3}, "law.base_parameters"),
        ({"base_parameters": {"lambda": 3}}, "law.base_parameters.lambda"),
        ({"base_parameters": {"lambda0": -3}}, "law.base_parameters.lambda0"),
    ],
)
def test_what_cannot_be_is_refused_under_its_key(fields, key):
    with pytest.raises(InputError) as error:
        made(**fields)
    assert error.value.key == key


def test_whole_numbers_of_a_file_become_floats():
    law = made(base_parameters={"lambda0": 1}, knots=[1, 0, -1])
    assert law.base_law.lambda0 == 1.0 and isinstance(law.base_law.lambda0, float)
    assert law.knots == (1.0, 0.0, -1.0)

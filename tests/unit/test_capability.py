"""Torque capability: known values, bounds, singular states, limits, batches, errors."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import nullmotion as nm
from nullmotion.array import capability_batch
from nullmotion.array.capability import direction_capability, rows_capability, torque_capability
from nullmotion.array.minors import columns, least_rates
from nullmotion.array.torque_set import inradius, least_rates_capability
from nullmotion.compile import compile_function
from nullmotion.errors import InputError, UnknownNameError

NAMES = nm.layouts.names()
METHODS = {"pseudo-inverse": {}, "optimal": {}, "local-gradient": {"k": 0.3}}
HALF_B = np.arccos(np.sqrt(6) / 3)  # acos(b/4), b = 4 sqrt(6)/3


def angles(array, count, seed=0):
    return np.random.default_rng(seed).uniform(-np.pi, np.pi, (count, array.n))


@pytest.mark.parametrize("n", range(3, 10))
def test_evenly_spread_planar_cmgs(n):
    """Odd n point 2n ways at equal steps: the optimum is the regular 2n-gon's."""
    array, delta = nm.layouts.create("planar", n=n), 2 * np.pi * np.arange(n) / n
    sides = n if n % 2 else n // 2
    assert torque_capability(array, delta) == pytest.approx(n / 2, rel=1e-14)
    best = (n / sides) / np.tan(np.pi / (2 * sides))
    assert torque_capability(array, delta, "optimal") == pytest.approx(best, rel=1e-14)


def test_five_planar_cmgs_gain_23_percent_by_the_optimum():
    array, delta = nm.layouts.create("planar", n=5), 2 * np.pi * np.arange(5) / 5
    gain = torque_capability(array, delta, "optimal") / torque_capability(array, delta)
    assert gain == pytest.approx(1.2311, abs=1e-4)


def test_box90_without_momentum():
    array = nm.layouts.create("box90")
    delta = np.array([np.pi - HALF_B, np.pi + HALF_B, -HALF_B, HALF_B])
    assert np.allclose(array.momentum(delta), 0.0, atol=1e-15)
    assert torque_capability(array, delta) == pytest.approx(4 / 3, rel=1e-14)
    assert torque_capability(array, delta, "optimal") == pytest.approx(np.sqrt(8 / 3), rel=1e-14)
    assert torque_capability(array, delta, "local-gradient", k=1.0) == pytest.approx(4 / 3)


@pytest.mark.parametrize("name", NAMES)
def test_bounds(name):
    """Linear laws have at most n/m; the optimum may have more, up to a mean over directions."""
    array = nm.layouts.create(name)
    n, m = array.n, array.m
    delta = angles(array, 2000)
    least, best = (torque_capability(array, delta, x) for x in ("pseudo-inverse", "optimal"))
    assert np.all(least <= n / m + 1e-12)
    assert np.all(best >= least - 1e-14)
    assert np.all(best <= {2: 1 / np.tan(np.pi / (2 * n)), 3: n / 2}[m] + 1e-12)
    assert best.max() > least.max()


@pytest.mark.parametrize("name", NAMES)
def test_any_right_inverse_is_within_the_bounds(name, rng):
    array = nm.layouts.create(name)
    A = array.unit_jacobian(angles(array, 200))
    W = np.linalg.pinv(A)
    null = np.eye(array.n) - W @ A
    other = rows_capability(W + null @ rng.normal(size=W.shape) * 0.3)
    assert np.all(other <= array.n / array.m + 1e-12)
    assert np.all(other <= inradius(A) + 1e-12)


def test_the_optimum_exceeds_what_linear_laws_can_have():
    array = nm.layouts.create("box90")
    delta = np.array([np.pi - HALF_B, np.pi + HALF_B, -HALF_B, HALF_B])
    assert torque_capability(array, delta, "optimal") > array.n / array.m


SINGULAR = [
    ("pyramid", [-90, 0, 90, 0]),
    ("pyramid", [90, 90, 90, 90]),
    ("pyramid", [90, 180, -90, 0]),
    ("box90", [90, 90, 90, 90]),  # all columns along x
    ("box90", [90, -90, 90, -90]),
    ("box90", [0, 0, 0, 0]),
    ("planar", [30, 30, 210, 210]),
    ("scissored_pairs", [90, -90, 0, 0, 0, 0]),
    ("orthogonal_pairs", [90, 90, 0, 0, 0, 0]),
    ("roof6", [90, -90, 90, -90, 90, -90]),
]


@pytest.mark.parametrize(("name", "degrees"), SINGULAR)
@pytest.mark.parametrize("method", METHODS)
def test_singular_arrays_have_exactly_none(name, degrees, method):
    array = nm.layouts.create(name)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = torque_capability(array, np.radians(degrees), method, **METHODS[method])
        many = np.tile(np.radians(degrees), (capability_batch._KERNEL_FROM, 1))
        batch = torque_capability(array, many, method, **METHODS[method])
    assert found == 0.0
    assert not batch.any()


def test_fewer_cmgs_than_torque_dimensions():
    array = nm.layouts.create("pyramid").without([0, 1])
    for method, more in METHODS.items():
        assert torque_capability(array, [0.3, 0.4], method, **more) == 0.0
    assert direction_capability(array, [0.3, 0.4], [1.0, 0.0, 0.0]) == 0.0


@pytest.mark.parametrize("name", ["pyramid", "roof6", "planar"])
def test_a_failed_cmg_counts_for_nothing(name):
    """Taken out or without momentum: the same, but for the CMGs' number."""
    array = nm.layouts.create(name)
    delta = angles(array, 30)
    alive = array.altered(h0=np.array([0.0, *array.h0[1:]]))
    for method, more in METHODS.items():
        out = torque_capability(array.without(0), delta[:, 1:], method, **more)
        assert np.allclose(torque_capability(alive, delta, method, **more), out, atol=1e-13)


def test_units_are_mean_momentum_times_the_least_rate_limit():
    delta = np.array([0.3, -0.4, 1.2, 0.6])
    plain = nm.layouts.create("pyramid")
    scaled = nm.layouts.create("pyramid", h0=7.0, rate_limit=0.4)
    for method, more in METHODS.items():
        more = {} if not more else {"k": 0.0}
        value = torque_capability(plain, delta, method, **more)
        assert torque_capability(scaled, delta, method, **more) == pytest.approx(value, rel=1e-14)
    fast = nm.layouts.create("pyramid", rate_limit=np.array([0.4, 0.8, 0.4, 1.2]))
    assert torque_capability(fast, delta, "optimal") > torque_capability(plain, delta, "optimal")


def test_a_cmg_without_limit_beside_limited_ones():
    delta = angles(nm.layouts.create("pyramid"), 20)
    free = nm.layouts.create("pyramid", rate_limit=np.array([1.0, np.inf, 1.0, 1.0]))
    fast = nm.layouts.create("pyramid", rate_limit=np.array([1.0, 1e12, 1.0, 1.0]))
    for method in ("pseudo-inverse", "optimal"):
        found = torque_capability(free, delta, method)
        assert np.allclose(found, torque_capability(fast, delta, method), rtol=1e-9)


def transcribed(array, delta, k, rate_limit):
    """Eq 143, with the gradient by central differences and LAPACK's pseudo-inverse."""
    A = array.jacobian(delta) / array.mean_momentum

    def omega(d):
        J = array.jacobian(d) / array.mean_momentum
        return np.linalg.det(J @ J.T)

    step = 1e-5
    d = np.array(
        [(omega(delta + e) - omega(delta - e)) / (2 * step) for e in step * np.eye(array.n)]
    )
    P = np.linalg.pinv(A)
    nu = k * (np.eye(array.n) - P @ A) @ d
    return np.min((1 - np.abs(nu) / rate_limit) / np.linalg.norm(P, axis=1))


@pytest.mark.parametrize("name", ["box90", "pyramid", "roof6", "planar", "orthogonal_pairs"])
def test_local_gradient_against_eq_143(name):
    array = nm.layouts.create(name, h0=3.0, rate_limit=0.5)
    for delta in angles(array, 10):
        for k in (0.2, 1.0):
            wanted = transcribed(array, delta, k, 0.5)
            found = torque_capability(array, delta, "local-gradient", k=k)
            assert found == pytest.approx(wanted, abs=1e-7)


def test_local_gradient_is_the_laws_null_motion():
    array = nm.layouts.create("box90", h0=2.0, rate_limit=0.8)
    law = nm.laws.create("local-gradient", k=0.6)
    for delta in angles(array, 20):
        obs = nm.Observation(delta, np.zeros(3), 0.0, 0.01)
        nu, _ = law.step(array, obs, law.init(array, delta))
        found = torque_capability(array, delta, "local-gradient", k=0.6)
        given = torque_capability(array, delta, null_motion=nu)
        assert found == pytest.approx(given, rel=1e-10, abs=1e-12)


def test_null_motion_beyond_the_limit_gives_a_negative_capability():
    array = nm.layouts.create("box90", rate_limit=1.0)
    delta = np.array([0.3, -0.8, 2.0, 4.0])
    rows = np.linalg.norm(np.linalg.pinv(array.jacobian(delta)), axis=1)
    found = torque_capability(array, delta, null_motion=[0.0, 1.5, 0.0, 0.0])
    assert found == pytest.approx(np.min(np.array([1.0, -0.5, 1.0, 1.0]) / rows))
    assert found < 0


def test_null_motion_broadcasts_against_angles():
    array = nm.layouts.create("pyramid")
    delta, nu = angles(array, 6).reshape(2, 3, 4), angles(array, 3, seed=1) / 10
    found = torque_capability(array, delta, null_motion=nu)
    alone = [torque_capability(array, delta[1, j], null_motion=nu[j]) for j in range(3)]
    assert found.shape == (2, 3)
    assert np.allclose(found[1], alone, rtol=1e-14)


def test_rows():
    W = np.array([[3.0, 4.0], [0.0, 0.0], [0.0, 1.0]])
    assert rows_capability(W) == pytest.approx(0.2)
    assert rows_capability(W, [10.0, 1.0, 1.0]) == pytest.approx(1.0)
    assert rows_capability(W, [1.0, -1.0, 1.0]) == -np.inf
    assert rows_capability(np.array([[np.nan, 1.0], [1.0, 0.0]])) == 0.0
    assert np.allclose(rows_capability(np.stack([W, 2 * W])), [0.2, 0.1])


@pytest.mark.parametrize("method", METHODS)
def test_kernel_and_plain_evaluation_agree(method):
    array = nm.layouts.create("box90", h0=np.array([1.0, 1.2, 1.0, 0.9]), rate_limit=0.5)
    delta = angles(array, capability_batch._KERNEL_FROM)
    many = torque_capability(array, delta, method, **METHODS[method])
    few = torque_capability(array, delta[:3000], method, **METHODS[method])
    one = torque_capability(array, delta[7], method, **METHODS[method])
    assert np.allclose(many[:3000], few, rtol=1e-12, atol=1e-14)
    assert np.ndim(one) == 0
    assert one == few[7]


def test_an_equal_array_takes_the_same_kernel():
    delta = angles(nm.layouts.create("pyramid"), capability_batch._KERNEL_FROM)
    torque_capability(nm.layouts.create("pyramid"), delta)
    hits = capability_batch._kernel.cache_info().hits
    torque_capability(nm.layouts.create("pyramid"), delta)
    assert capability_batch._kernel.cache_info().hits == hits + 1


def test_angles_beyond_the_kernels_sines():
    array = nm.layouts.create("pyramid")
    delta = angles(array, capability_batch._KERNEL_FROM)
    delta[0] += 2 * np.pi * 1e5
    assert torque_capability(array, delta)[0] == torque_capability(array, delta[0])


@pytest.mark.parametrize("source", [least_rates, inradius])
def test_source_without_sharpening_runs_in_kernels(source):
    """As a proof by intervals takes it."""

    def blunt(A):
        if source is inradius:
            return inradius(A, sharp=False)
        return least_rates_capability(least_rates(columns(A), sharp=False))

    array = nm.layouts.create("roof6")
    A = array.unit_jacobian(angles(array, 50))
    assert np.allclose(compile_function(blunt, A[0])(A), blunt(A), rtol=1e-12)


@pytest.mark.parametrize("shape", [(3,), (2, 3), ()])
def test_wrong_number_of_angles(shape):
    with pytest.raises(InputError, match="4 gimbal angles") as caught:
        torque_capability(nm.layouts.create("pyramid"), np.zeros(shape))
    assert caught.value.key == "delta"


@pytest.mark.parametrize(
    ("key", "arguments"),
    [
        ("delta", {"delta": [0.0, np.nan, 0.0, 0.0]}),
        ("delta", {"delta": "north"}),
        ("k", {"method": "local-gradient"}),
        ("k", {"method": "local-gradient", "k": -1.0}),
        ("k", {"method": "local-gradient", "k": np.nan}),
        ("k", {"method": "local-gradient", "k": "fast"}),
        ("k", {"k": 1.0}),
        ("null_motion", {"null_motion": [0.1, 0.2]}),
        ("null_motion", {"null_motion": np.zeros(4), "method": "optimal"}),
    ],
)
def test_refused_input(key, arguments):
    with pytest.raises(InputError) as caught:
        torque_capability(nm.layouts.create("pyramid"), **{"delta": np.zeros(4)} | arguments)
    assert caught.value.key == key


def test_unknown_method():
    with pytest.raises(UnknownNameError, match="did you mean optimal"):
        torque_capability(nm.layouts.create("pyramid"), np.zeros(4), "optimum")


@pytest.mark.parametrize("direction", [[1.0, 0.0], [0.0, 0.0, 0.0], [1.0, np.inf, 0.0]])
def test_refused_directions(direction):
    with pytest.raises(InputError) as caught:
        direction_capability(nm.layouts.create("pyramid"), np.zeros(4), direction)
    assert caught.value.key == "directions"

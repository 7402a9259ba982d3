"""Torque capability against LAPACK, Qhull and linear programs of SciPy, and mpmath."""

from __future__ import annotations

from itertools import product

import mpmath
import numpy as np
import pytest
from scipy.optimize import linprog
from scipy.spatial import ConvexHull

import nullmotion as nm
from nullmotion.array.capability import direction_capability, rows_capability, torque_capability
from nullmotion.array.minors import columns, least_rates
from nullmotion.array.torque_set import inradius, least_rates_capability, reach

LAYOUTS = ["pyramid", "box90", "orthogonal_pairs", "scissored_pairs", "planar", "triangle"]
LIMITS = np.array([0.5, 0.8, 0.6, 1.1, 0.5, 0.9])
MOMENTA = np.array([1.0, 1.3, 0.7, 2.0, 1.1, 0.9])


def arrays(name):
    """Return a plain array of a layout, one with all its CMGs different, one with a failed CMG."""
    plain = nm.layouts.create(name)
    uneven = nm.layouts.create(name, h0=MOMENTA[: plain.n], rate_limit=LIMITS[: plain.n])
    return [plain, uneven, uneven.without(1)] if plain.n > plain.m else [plain, uneven]


def states(name, count=30):
    """Return each array with its angles, Jacobians over the mean momentum, and limits."""
    rng = np.random.default_rng(7)
    for array in arrays(name):
        delta = rng.uniform(-np.pi, np.pi, (count, array.n))
        limited = np.isfinite(array.rate_limit).all()
        limits = array.rate_limit / np.min(array.rate_limit) if limited else np.ones(array.n)
        yield array, delta, array.jacobian(delta) / np.mean(array.h0), limits


def program(A, u, limits):
    """Return max t with A w = t u, |w| <= limits."""
    m, n = A.shape
    bounds = [(-x, x) for x in limits] + [(0, None)]
    found = linprog(
        np.r_[np.zeros(n), -1.0], A_eq=np.c_[A, -u], b_eq=np.zeros(m), bounds=bounds, method="highs"
    )
    return -found.fun


@pytest.mark.parametrize("name", LAYOUTS)
def test_pseudo_inverse_against_lapack(name):
    for array, delta, A, limits in states(name):
        wanted = np.min(limits / np.linalg.norm(np.linalg.pinv(A), axis=-1), axis=-1)
        assert np.allclose(torque_capability(array, delta), wanted, rtol=1e-12)
        assert np.allclose(rows_capability(np.linalg.pinv(A), limits), wanted, rtol=1e-12)


@pytest.mark.parametrize("name", LAYOUTS)
def test_optimum_is_the_inradius_of_the_hull_of_all_corners(name):
    for array, delta, A, limits in states(name):
        found = torque_capability(array, delta, "optimal")
        corners = np.array(list(product([-1.0, 1.0], repeat=array.n))) * limits
        for jacobian, value in zip(A, found, strict=True):
            hull = ConvexHull(corners @ jacobian.T)
            assert value == pytest.approx(-hull.equations[:, -1].max(), rel=1e-9)


@pytest.mark.parametrize("name", LAYOUTS)
def test_directions_against_linear_programs(name):
    rng = np.random.default_rng(3)
    for array, delta, A, limits in states(name, 4):
        u = rng.normal(size=(8, 1, array.m))
        found = direction_capability(array, delta, 5.0 * u)
        u = u / np.linalg.norm(u, axis=-1, keepdims=True)
        wanted = [[program(a, v[0], limits) for a in A] for v in u]
        assert found.shape == (8, 4)
        assert np.allclose(found, wanted, rtol=1e-8)
        assert np.all(torque_capability(array, delta, "optimal") <= found.min(axis=0) + 1e-12)


@pytest.mark.parametrize("rank", [1, 2])
def test_directions_of_singular_arrays_against_linear_programs(rank, rng):
    """Along the torques that are left, rotated so that rounding blurs them; none elsewhere."""
    Q = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    A = rng.normal(size=(3, 5))
    A[rank:] = 0.0
    array = nm.layouts.create("roof6").without(0)
    for u in ([1.0, 0.0, 0.0], [0.6, 0.8, 0.0], [0.6, 0.0, 0.8], [0.0, 0.0, 1.0]):
        wanted = program(A, np.array(u), np.ones(array.n))
        assert reach(A, np.array(u)) == pytest.approx(wanted, rel=1e-10, abs=1e-14)
        assert reach(Q @ A, Q @ u) == pytest.approx(wanted, rel=1e-10, abs=1e-14)


@pytest.mark.parametrize("rank", [1, 2])
@pytest.mark.parametrize("distance", [1e-3, 1e-7, 1e-11])
def test_near_singular_to_the_last_bits_against_mpmath(rank, distance, rng):
    """LAPACK's own error is about the same: rounding of A, not of the result."""
    for _ in range(5):
        B = rng.normal(size=(3, 5))
        B[rank:] *= distance
        A = np.linalg.qr(rng.normal(size=(3, 3)))[0] @ B
        A = A / np.linalg.norm(A, axis=0)
        with mpmath.workdps(60):
            M = mpmath.matrix(A.tolist())
            W = M.T * (M * M.T) ** -1
            rows = [mpmath.norm(W[i, :]) for i in range(5)]
            c = [mpmath.matrix(A[:, k].tolist()) for k in range(5)]
            least = min(support(c, i, j) for i in range(5) for j in range(i))
        found = least_rates_capability(least_rates(columns(A)))
        assert found == pytest.approx(float(1 / max(rows)), abs=1e-15)
        assert inradius(A) == pytest.approx(float(least), abs=1e-15)


def support(c, i, j):
    """Return the distance of the facet of columns i and j in mpmath."""
    x, y = c[i], c[j]
    n = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]
    n = mpmath.matrix(n) / mpmath.norm(mpmath.matrix(n))
    return sum(abs((n.T * a)[0]) for a in c)

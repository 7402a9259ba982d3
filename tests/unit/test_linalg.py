"""Small linear algebra against LAPACK, through floats and through compiled code."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from nullmotion import linalg
from nullmotion.compile import compile_function

EXACT = 5e-15  # relative to the greatest singular value
SHAPES = [(2, 2), (2, 3), (2, 5), (2, 12), (3, 2), (3, 3), (3, 4), (3, 5), (3, 6), (3, 9), (3, 12)]
entries = st.floats(-1e3, 1e3).map(lambda x: x if abs(x) > 1e-3 else 0.0)


def spread(rng: np.random.Generator, m: int, n: int, sigma: Any) -> np.ndarray:
    """Return a matrix with given singular values."""
    u = np.linalg.qr(rng.normal(size=(m, m)))[0]
    v = np.linalg.qr(rng.normal(size=(max(m, n), m)))[0][:n]
    return (u * np.asarray(sigma)) @ v.T


def matrices(m: int, n: int) -> np.ndarray:
    """Return matrices of every rank, with close, equal, tiny and vanishing singular values."""
    rng = np.random.default_rng(10 * m + n)
    out = [rng.normal(size=(m, n)) * 10.0 ** rng.integers(-3, 4) for _ in range(150)]
    spectra = [[1, 1, 1], [1, 1, 0], [1, 0, 0], [1, 1 - 1e-9, 1e-3], [1, 1e-8, 1e-9]]
    spectra += [[1, 1e-15, 1e-15], [1e5, 1, 1e-5], [3, 2, 0], [3, 3, 1e-12], [1, 1, 1 - 1e-15]]
    for sigma in spectra:
        out += [spread(rng, m, n, sigma[:m]) for _ in range(10)]
    row, column = rng.normal(size=n), rng.normal(size=m)
    out += [np.zeros((m, n)), np.eye(m, n), np.ones((m, n)), np.outer(column, row)]
    out += [np.outer(np.eye(m)[i], row) for i in range(m)] + [np.outer(column, np.eye(n)[0])]
    integers = rng.integers(-1, 2, (60, m, n)).astype(float)
    return np.concatenate([np.stack(out), integers])


def check(a: np.ndarray, d: linalg.Svd) -> None:
    """Check one decomposition."""
    m, n = a.shape
    scale = max(np.linalg.norm(a, 2), 1e-300)
    truth = np.linalg.svd(a, compute_uv=False)
    assert np.all(np.diff(d.s) <= EXACT * scale) and np.all(d.s >= 0)
    assert np.abs(d.s[: len(truth)] - truth).max() <= EXACT * scale
    assert np.all(d.s[len(truth) :] <= EXACT * scale)
    assert np.abs(d.u.T @ d.u - np.eye(m)).max() <= EXACT
    assert np.abs((d.u * d.s) @ d.v.T - a).max() <= EXACT * scale
    if n >= m:
        basis = np.concatenate([d.v, d.null], axis=1)
        assert np.abs(basis.T @ basis - np.eye(n)).max() <= EXACT
        if n > m:
            assert np.abs(a @ d.null).max() <= EXACT * scale


@pytest.mark.parametrize(("m", "n"), SHAPES)
def test_svd_on_floats(m: int, n: int) -> None:
    for a in matrices(m, n)[::4]:
        check(a, linalg.svd(a))


@pytest.mark.parametrize(("m", "n"), SHAPES)
@pytest.mark.sampled(5)
def test_svd_in_compiled_code(m: int, n: int) -> None:
    batch = matrices(m, n)
    found = compile_function(linalg.svd, np.zeros((m, n)))(batch)
    for i, a in enumerate(batch):
        check(a, linalg.Svd(*[part[i] for part in found]))


def test_svd_of_one_row() -> None:
    for a in (np.array([[3.0, -4.0, 0.0]]), np.zeros((1, 3)), np.array([[-2.0]])):
        check(a, linalg.svd(a))


@pytest.mark.parametrize("power", [-60, -20, 20, 60])
def test_svd_scales(power: int) -> None:
    a = matrices(3, 4)[3] * 10.0**power
    check(a, linalg.svd(a))


@given(hnp.arrays(float, (3, 4), elements=entries))
@settings(max_examples=200, deadline=None)
def test_svd_of_any_matrix(a: np.ndarray) -> None:
    check(a, linalg.svd(a))


@pytest.mark.parametrize(("m", "n"), [(1, 2), (2, 3), (3, 4)])
def test_null_vector_with_one_degree_of_freedom(m: int, n: int) -> None:
    rng = np.random.default_rng(n)
    for a in rng.normal(size=(50, m, n)):
        v = linalg.null_vector(a)
        volume = np.sqrt(np.linalg.det(a @ a.T))
        assert np.abs(a @ v).max() < 1e-13
        assert np.linalg.norm(v) == pytest.approx(volume, rel=1e-10)


@pytest.mark.parametrize(("m", "n"), [(2, 5), (3, 5), (3, 6), (3, 8)])
def test_null_vector_with_more_freedom(m: int, n: int) -> None:
    rng = np.random.default_rng(n)
    for a in rng.normal(size=(20, m, n)):
        v = linalg.null_vector(a)
        assert np.abs(a @ v).max() < 1e-12 * max(1, np.linalg.norm(v))
        assert np.linalg.norm(v) > 0


def test_null_vector_is_continuous_through_a_singularity() -> None:
    rng = np.random.default_rng(1)
    a, b = spread(rng, 3, 4, [2.0, 1.0, 0.0]), rng.normal(size=(3, 4))
    assert np.abs(linalg.null_vector(a)).max() < 1e-14
    before, after = (linalg.null_vector(a + t * b) / t for t in (-1e-6, 1e-6))
    assert np.abs(before - after).max() < 1e-4 * np.abs(after).max()


@pytest.mark.parametrize("size", [1, 2, 3])
def test_adjugate_determinant_and_solution(size: int) -> None:
    rng = np.random.default_rng(size)
    for a in rng.normal(size=(50, size, size)):
        adjugate = linalg.adjugate(a)
        assert np.allclose(a @ adjugate, np.linalg.det(a) * np.eye(size), atol=1e-13)
        assert np.allclose(adjugate, np.linalg.inv(a) * np.linalg.det(a), rtol=1e-8, atol=1e-12)
        assert linalg.det(a) == pytest.approx(np.linalg.det(a), rel=1e-9, abs=1e-13)
        b = rng.normal(size=size)
        assert np.allclose(linalg.solve(a, b), np.linalg.solve(a, b), rtol=1e-7, atol=1e-10)


def test_adjugate_of_a_singular_matrix() -> None:
    a = np.outer([1.0, 2.0, 3.0], [1.0, -1.0, 0.5])
    assert np.array_equal(linalg.adjugate(a), np.zeros((3, 3)))
    a[0, 0] += 1
    assert np.allclose(a @ linalg.adjugate(a), 0)
    assert np.linalg.matrix_rank(linalg.adjugate(a)) == 1


@given(hnp.arrays(float, (2, 3), elements=entries))
@settings(deadline=None)
def test_vectors(pair: np.ndarray) -> None:
    a, b = pair
    assert np.allclose(linalg.cross(a, b), np.cross(a, b))
    assert linalg.dot(a, b) == pytest.approx(np.dot(a, b))
    assert linalg.norm(a) == pytest.approx(np.linalg.norm(a))


@cache
def several() -> Any:
    """Compile the other functions together."""

    def together(a: Any, s: Any, b: Any) -> Any:
        return linalg.null_vector(a), linalg.adjugate(s), linalg.solve(s, b), linalg.det(s)

    return compile_function(together, np.zeros((3, 5)), np.zeros((3, 3)), np.zeros(3))


def test_compiled_code_agrees_with_floats() -> None:
    rng = np.random.default_rng(8)
    a, s = rng.normal(size=(40, 3, 5)), rng.normal(size=(40, 3, 3)) + 3 * np.eye(3)
    b = rng.normal(size=(40, 3))
    null, adjugate, solution, determinant = several()(a, s, b)
    for i in range(40):
        assert np.allclose(null[i], linalg.null_vector(a[i]), rtol=1e-12, atol=1e-13)
        assert np.allclose(adjugate[i], linalg.adjugate(s[i]), rtol=1e-12, atol=1e-13)
        assert np.allclose(solution[i], np.linalg.solve(s[i], b[i]), rtol=1e-10)
        assert determinant[i] == pytest.approx(np.linalg.det(s[i]), rel=1e-10)

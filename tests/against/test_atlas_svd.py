"""Singular points of random arrays against LAPACK: singular, of the type that Q says."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import null_space

import nullmotion as nm
from nullmotion import atlas

SINGULAR = 1e-12
CLEAR = 1e-6  # |eigenvalue| of Q over the mean momentum that decides


@st.composite
def arrays(draw: st.DrawFn) -> nm.CmgArray:
    """3 to 8 CMGs of any axes and momenta, some of them parallel, planar, or failed."""
    n = draw(st.integers(3, 8))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    gimbal = rng.normal(size=(n, 3))
    if draw(st.booleans()):  # pairs of parallel axes
        gimbal[1::2] = gimbal[: 2 * (n // 2) : 2] * rng.choice([-1.0, 1.0], size=(n // 2, 1))
    if draw(st.integers(0, 4)) == 0:
        gimbal[:] = gimbal[0] * rng.choice([-1.0, 1.0], size=(n, 1))
    gimbal /= np.linalg.norm(gimbal, axis=1, keepdims=True)
    spin = np.cross(gimbal, rng.normal(size=(n, 3)))
    spin /= np.linalg.norm(spin, axis=1, keepdims=True)
    h0 = rng.uniform(0.1, 5.0, n) if draw(st.booleans()) else np.full(n, 2.0)
    fate = draw(st.sampled_from(["whole", "removed", "frozen", "idle"]))
    h0[n // 2] *= fate != "idle"
    array = nm.CmgArray(gimbal, spin, h0, momentum_bias=rng.normal(size=3))
    if fate in ("whole", "idle") or n == 3:
        return array
    return array.without(int(rng.integers(n)), rng.normal() if fate == "frozen" else None)


def directions(array: nm.CmgArray, seed: int) -> np.ndarray:
    """Return random directions, the gimbal axes, and directions very close to these."""
    rng = np.random.default_rng(seed)
    axes = array.gimbal_axes @ array.torque_axes.T
    axes = axes[np.linalg.norm(axes, axis=1) > 0.5]
    beside = axes + rng.choice([1e-15, 1e-12, 1e-9, 1e-4], size=(len(axes), 1)) * rng.normal(
        size=axes.shape
    )
    return np.concatenate([rng.normal(size=(20, array.m)), axes, -axes, beside])


@settings(max_examples=80, deadline=None)
@given(arrays(), st.integers(0, 2**32 - 1))
def test_every_point_is_singular_and_has_its_momentum(array: nm.CmgArray, seed: int) -> None:
    u = directions(array, seed)
    signs = np.random.default_rng(seed).choice([-1.0, 1.0], size=(len(u), array.n))
    for towards in (None, np.random.default_rng(seed + 1).normal(size=u.shape)):
        points = atlas.singular_points(array, u, signs, towards)
        for delta, direction, momentum in zip(points.delta, points.u, points.momentum, strict=True):
            A = array.jacobian(delta) / array.mean_momentum
            sigma = np.linalg.svd(A, compute_uv=False)
            assert sigma[-1] < SINGULAR
            assert np.abs(direction @ A).max() < SINGULAR
            assert momentum == pytest.approx(array.momentum(delta), abs=1e-13)


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(arrays(), st.integers(50, 400))
def test_every_point_of_every_sheet_is_singular(array: nm.CmgArray, resolution: int) -> None:
    sheets = atlas.surfaces(array, resolution)
    assert len(sheets) == 2 ** (np.sum(array.h0 > 0) - 1)
    for sheet in sheets[:: max(1, len(sheets) // 6)]:
        A = array.jacobian(sheet.delta) / array.mean_momentum
        assert np.linalg.svd(A, compute_uv=False)[:, -1].max() < SINGULAR
        assert np.abs(sheet.momentum - array.momentum(sheet.delta)).max() < 1e-13 * array.n * 5


def eigenvalues(array: nm.CmgArray, delta: np.ndarray, u: np.ndarray) -> np.ndarray | None:
    """Return those of Q over the mean momentum; None where A has less than m - 1 dimensions."""
    works = array.h0 > 0
    N = null_space(array.jacobian(delta)[:, works] / array.mean_momentum, rcond=1e-9)
    if N.shape[1] != works.sum() - array.m + 1 or N.shape[1] == 0:
        return None
    E = np.diag(array.rotor_momenta(delta)[works] @ u) / array.mean_momentum
    return np.linalg.eigvalsh(N.T @ E @ N)


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(arrays(), st.integers(0, 2**32 - 1))
def test_types_are_those_of_the_form_on_the_null_space(array: nm.CmgArray, seed: int) -> None:
    rng = np.random.default_rng(seed)
    sheets = atlas.surfaces(array, 60)
    for sheet in (sheets[k] for k in rng.integers(len(sheets), size=3)):
        for k in rng.integers(len(sheet.u), size=12):
            value = eigenvalues(array, sheet.delta[k], sheet.u[k])
            if value is None or np.abs(value).min() < CLEAR:
                continue
            kind = atlas.KINDS[sheet.kind[k]]
            assert (value[0] < 0 < value[-1]) == (kind == "hyperbolic")
            assert kind in ("hyperbolic", "elliptic", "saturation")
            assert nm.singularity.classify(array, sheet.delta[k]) == kind
            along = array.rotor_momenta(sheet.delta[k]) @ sheet.u[k]
            one_side = (along > -1e-9).all() or (along < 1e-9).all()
            assert one_side == (kind == "saturation")


@settings(max_examples=40, deadline=None)
@given(arrays(), st.integers(0, 2**32 - 1))
def test_types_agree_with_the_curvature(array: nm.CmgArray, seed: int) -> None:
    """By the determinant of [[E, B^T], [B, 0]], det Q has the sign of K times all epsilon."""
    rng = np.random.default_rng([seed, 1])  # not the numbers that the axes are made of
    u = rng.normal(size=(40, array.m))
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    signs = rng.choice([-1.0, 1.0], size=(len(u), array.n))
    points = atlas.singular_points(array, u, signs)
    product = numeric_product(array, u, signs)
    K = atlas.gaussian_curvature(array, u, signs)
    scale, works = array.mean_momentum ** (array.m - 1), array.h0 > 0
    radii = 1.0 / K
    assert radii == pytest.approx(product, rel=1e-3, abs=1e-6 * scale)
    for delta, direction, sign, curvature in zip(points.delta, u, signs, product, strict=True):
        value = eigenvalues(array, delta, direction)
        if value is None or np.abs(value).min() < CLEAR or abs(curvature) < 1e-5 * scale:
            continue
        negative = int((value < 0).sum())
        assert (-1) ** negative == np.prod(sign[works]) * np.sign(curvature)
        if works.sum() == array.m + 1:
            definite = np.prod(sign[works]) * np.sign(curvature) > 0
            kind = nm.singularity.classify(array, delta)
            assert definite == (kind in ("elliptic", "saturation"))


def numeric_product(array: nm.CmgArray, u: np.ndarray, signs: np.ndarray) -> np.ndarray:
    """Return det(dh/du) in the plane normal to u, 1/K, by differences of two steps (Richardson)."""
    basis = np.linalg.svd(u[:, None])[2][:, 1:]  # (k, m - 1, m)

    def slope(e: np.ndarray, step: float) -> np.ndarray:
        ahead, behind = (
            atlas.singular_points(array, u + side * step * e, signs).momentum for side in (1, -1)
        )
        return np.einsum("kbm,km->kb", basis, ahead - behind) / (2 * step)

    step = 2e-5
    columns = [(4 * slope(e, step / 2) - slope(e, step)) / 3 for e in np.moveaxis(basis, 1, 0)]
    return np.linalg.det(np.stack(columns, axis=-1))

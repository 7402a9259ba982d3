"""Singular lines of planar arrays: against brute force, the general search and LAPACK."""

from __future__ import annotations

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import singular_lines, singularity
from nullmotion.papers.pereira2022_figures import singular_lines_within

TURN = 2 * np.pi


@pytest.fixture(scope="module")
def triangle():
    return nm.layouts.create("triangle", h0=2.0)


def lattice(delta: np.ndarray) -> tuple[float, bool]:
    """Return distance to the nearest line of Eq 21 by looking at all of them, and whether 3h."""
    k = np.arange(-80, 81)
    e1 = delta[0] - delta[2] + np.pi / 3 - k[:, None] * np.pi
    e2 = delta[1] - delta[2] - np.pi / 3 - k[None, :] * np.pi
    square = (e1**2 + e2**2) - (e1 + e2) ** 2 / 3
    i, j = np.unravel_index(np.argmin(square), square.shape)
    return float(np.sqrt(square[i, j])), bool(k[i] % 2 and k[j] % 2)


def test_lines_of_unwrapped_angles_against_all_of_them(triangle, rng):
    delta = rng.uniform(-60, 60, (200, 3))
    found = singular_lines.nearest(triangle, delta)
    distance, outer = zip(*map(lattice, delta), strict=True)
    np.testing.assert_allclose(found.distance, distance, atol=1e-9)
    assert (np.round(found.momentum) == np.where(outer, 3, 1)).all()
    sigma = np.linalg.svd(triangle.unit_jacobian(found.delta_s), compute_uv=False)[:, -1]
    assert sigma.max() < 1e-12
    np.testing.assert_allclose(np.linalg.norm(delta - found.delta_s, axis=1), found.distance)


def test_whole_turns_change_nothing(triangle, rng):
    delta = rng.uniform(-np.pi, np.pi, (200, 3))
    turned = delta + TURN * rng.integers(-9, 10, delta.shape)
    for nearest in (singular_lines.nearest, singularity.nearest):
        found, again = nearest(triangle, delta), nearest(triangle, turned)
        np.testing.assert_allclose(again.distance, found.distance, atol=1e-9)


@pytest.mark.parametrize(("layout", "n"), [("triangle", 3), ("planar", 4), ("planar", 6)])
def test_lines_agree_with_the_general_search(layout, n, rng):
    parameters = {} if layout == "triangle" else {"n": n}
    array = nm.layouts.create(layout, **parameters)
    delta = rng.uniform(-20, 20, (60, n))
    line, general = singular_lines.nearest(array, delta), singularity.nearest(array, delta)
    np.testing.assert_allclose(line.distance, general.distance, atol=1e-9)
    assert general.delta_s.shape == (60, n) and general.u.shape == (60, 2)
    one = singularity.nearest(array, delta[7])
    assert one.distance == pytest.approx(general.distance[7], abs=1e-12)


def test_axes_that_point_down_are_lines_too(rng):
    up = nm.layouts.create("triangle")
    down = nm.CmgArray(up.gimbal_axes * [[1], [-1], [1]], up.spin_axes)
    delta = rng.uniform(-9, 9, (40, 3))
    found = singular_lines.nearest(down, delta)
    general = singularity.nearest(down, delta)
    np.testing.assert_allclose(found.distance, general.distance, atol=1e-9)
    sigma = np.linalg.svd(down.unit_jacobian(found.delta_s), compute_uv=False)[:, -1]
    assert sigma.max() < 1e-12


def test_on_a_line_and_farthest_from_all(triangle):
    on = singular_lines.nearest(triangle, [0.3, 0.3 + 2 * np.pi / 3, 0.3 - 2 * np.pi / 3])
    assert on.distance < 1e-12 and on.momentum == pytest.approx(3)
    ties = singular_lines.nearest(nm.layouts.create("planar", n=3), np.pi * np.array([1.0, 0, -3]))
    assert ties.distance == 0.0
    farthest = singular_lines.nearest(triangle, np.zeros(3))
    assert farthest.distance == pytest.approx(np.sqrt(2) * np.pi / 3, abs=1e-12)


def test_minors_manipulability_and_sigma(triangle, rng):
    delta = rng.uniform(-7, 7, (100, 3))
    J = triangle.jacobian(delta)
    minors = np.stack(
        [np.linalg.det(J[:, :, [i for i in range(3) if i != k]]) for k in range(3)], axis=1
    )
    g1, g2, g3 = delta.T
    pairs = (g2 - g3, g3 - g1, g1 - g2)
    printed = [0.5 * 2.0**4 * (1 + np.cos(2 * p + np.pi / 3)) for p in pairs]  # Eq 20
    np.testing.assert_allclose(minors**2, np.stack(printed, axis=1), atol=1e-10)
    measures = singularity.measures(triangle, delta)
    scaled = np.sqrt(sum(printed)) / 2.0**2  # Cauchy-Binet, over the mean momentum
    np.testing.assert_allclose(measures["sqrt_det_AAT"], scaled, atol=1e-10)
    sigma = np.linalg.svd(J / 2.0, compute_uv=False)
    np.testing.assert_allclose(measures["sigma_min"], sigma[:, -1], atol=1e-10)


def test_near_a_line_measures_grow_with_the_distance(triangle):
    on, away = np.array([0.0, 2 * np.pi / 3, -2 * np.pi / 3]), np.array([1.0, -1.0, 0.0])
    d = 1e-4
    near = singularity.measures(triangle, on + d * away / np.sqrt(2))
    assert near["distance_to_singularity"] == pytest.approx(d, rel=1e-6)
    assert near["sqrt_det_AAT"] == pytest.approx(np.sqrt(3) * d, rel=1e-6)
    assert near["sigma_min"] == pytest.approx(d, rel=1e-6)


def test_twelve_lines_cross_the_cube_of_one_turn():
    found = singular_lines_within(np.full(3, -np.pi), np.full(3, np.pi))
    assert len(found) == 12
    array = nm.layouts.create("triangle")
    for ends, outer in found:
        line = singular_lines.nearest(array, ends.mean(axis=0))
        assert line.distance < 1e-12 and (round(float(line.momentum)) == 3) == outer


def test_arrays_without_lines_are_refused():
    for array in (nm.layouts.create("pyramid"), nm.layouts.create("planar", h0=[0, 1, 1, 1])):
        with pytest.raises(nm.InputError, match="parallel gimbal axes"):
            singular_lines.nearest(array, np.zeros(array.n))

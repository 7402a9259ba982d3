"""Singularity measures and the nearest singular configuration."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

import nullmotion as nm

measures, nearest = nm.singularity.measures, nm.singularity.nearest
NAMES = nm.layouts.names()


def angles(name: str, count: int, seed: int = 0) -> tuple[nm.CmgArray, np.ndarray]:
    """Return a layout and random gimbal angles."""
    array = nm.layouts.create(name, h0=2.5)
    return array, np.random.default_rng(seed).uniform(-np.pi, np.pi, (count, array.n))


def wrapped(x: np.ndarray) -> np.ndarray:
    """Return x mod pi in [-pi/2, pi/2)."""
    return (x + np.pi / 2) % np.pi - np.pi / 2


def searched(array: nm.CmgArray, delta: np.ndarray, starts: int, seed: int = 0) -> float:
    """Return the least distance found by SciPy from many random directions (not our formulas)."""
    rng = np.random.default_rng(seed)
    spin = array.spin_axes @ array.torque_axes.T
    torque = array.transverse_axes @ array.torque_axes.T

    def squared(u: np.ndarray) -> float:
        singular = np.arctan2(torque @ u, spin @ u)
        return float(np.sum(wrapped(delta - singular) ** 2))

    directions = rng.normal(size=(20 * starts, array.m))
    best = sorted(directions, key=squared)[:starts]
    options = {"xatol": 1e-10, "fatol": 1e-14, "maxiter": 2000, "maxfev": 4000}
    found = [minimize(squared, u, method="Nelder-Mead", options=options).fun for u in best]
    return float(np.sqrt(min(found)))


@pytest.mark.parametrize("name", NAMES)
def test_measures_against_lapack(name: str) -> None:
    array, delta = angles(name, 20)
    found = measures(array, delta)
    for i, d in enumerate(delta):
        a = array.jacobian(d) / 2.5
        sigma = np.linalg.svd(a)[1]
        assert found["sqrt_det_AAT"][i] == pytest.approx(np.sqrt(np.linalg.det(a @ a.T)), rel=1e-6)
        assert found["sigma_min"][i] == pytest.approx(sigma[-1], abs=1e-14)
        assert found["condition_number"][i] == pytest.approx(np.linalg.cond(a), rel=1e-9)
    alone = [nearest(array, d).distance for d in delta[:5]]
    assert np.allclose(found["distance_to_singularity"][:5], alone, rtol=1e-9)


def test_measures_have_deltas_leading_axes() -> None:
    array, delta = angles("pyramid", 6)
    for value in measures(array, delta.reshape(2, 3, 4)).values():
        assert value.shape == (2, 3)
    single, batch = measures(array, delta[1]), measures(array, delta)
    for name, value in single.items():
        assert np.ndim(value) == 0 and value == pytest.approx(batch[name][1], rel=1e-12)
    empty = measures(array, np.zeros((0, 4)))
    assert all(value.shape == (0,) for value in empty.values())


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.sampled(4)
def test_the_nearest_configuration_is_singular_and_as_far_as_it_says(name: str) -> None:
    array, delta = angles(name, 15, seed=1)
    for d in delta:
        found = nearest(array, d)
        a = array.unit_jacobian(found.delta_s)
        assert np.linalg.svd(a)[1][-1] < 1e-14
        assert np.abs(found.u @ a).max() < 1e-9
        assert np.linalg.norm(found.u) == pytest.approx(1, abs=1e-12)
        assert np.linalg.norm(found.delta_s - d) == pytest.approx(found.distance, abs=1e-12)
        assert np.abs(found.delta_s - d).max() <= np.pi / 2 + 1e-12


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.sampled(4)
def test_no_other_search_finds_a_nearer_one(name: str) -> None:
    array, delta = angles(name, 3, seed=2)
    for d in delta:
        assert nearest(array, d).distance <= searched(array, d, starts=6) + 1e-9


def test_triangle_lines_lie_along_111() -> None:
    """Pereira: singular lines along (1, 1, 1), pi sqrt(2/3) apart; gamma = 0 is farthest."""
    array, delta = angles("triangle", 20, seed=3)
    assert nearest(array, np.zeros(3)).distance == pytest.approx(np.sqrt(2) * np.pi / 3, abs=1e-12)
    assert nearest(array, np.zeros(3)).distance == pytest.approx(1.481, abs=1e-3)
    assert measures(array, delta)["distance_to_singularity"].max() < np.sqrt(2) * np.pi / 3
    # closed form: all of gamma + (2 pi/3, 0, -2 pi/3) equal mod pi
    phase = np.array([2, 0, -2]) * np.pi / 3
    shifts = np.array([(i, j, 0) for i in range(-8, 9) for j in range(-8, 9)]) * np.pi
    for d in delta:
        x = d + phase - shifts
        exact = np.linalg.norm(x - x.mean(axis=1, keepdims=True), axis=1).min()
        assert nearest(array, d).distance == pytest.approx(exact, abs=1e-12)


def test_triangle_measures_close_to_a_line() -> None:
    """Pereira: near a line the manipulability is sqrt3 d and sigma_min is d (in units of h0)."""
    array = nm.layouts.triangle(h0=2.0)
    line = nearest(array, np.array([0.3, -0.8, 1.2])).delta_s
    across = np.array([1.0, -1.0, 0.0]) / np.sqrt(2)
    found = measures(array, line + 1e-5 * across)
    assert found["distance_to_singularity"] == pytest.approx(1e-5, rel=1e-6)
    assert found["sigma_min"] == pytest.approx(1e-5, rel=1e-4)
    assert found["sqrt_det_AAT"] == pytest.approx(np.sqrt(3) * 1e-5, rel=1e-4)


def test_planar_is_singular_where_all_rotors_are_in_line() -> None:
    array, delta = angles("planar", 10, seed=4)
    shifts = np.stack(np.meshgrid(*[range(-6, 7)] * 3), axis=-1).reshape(-1, 3) * np.pi
    for d in delta:
        x = d - np.concatenate([shifts, np.zeros((len(shifts), 1))], axis=1)
        exact = np.linalg.norm(x - x.mean(axis=1, keepdims=True), axis=1).min()
        assert nearest(array, d).distance == pytest.approx(exact, abs=1e-12)


def test_pyramid_elliptic_singularity_has_distance_0() -> None:
    delta = np.radians([-90.0, 0.0, 90.0, 0.0])
    found = nearest(nm.layouts.pyramid(), delta)
    assert found.distance < 1e-9
    assert np.allclose(np.abs(found.u), [1, 0, 0], atol=1e-9)
    assert np.allclose(found.delta_s, delta, atol=1e-9)
    at = measures(nm.layouts.pyramid(), delta)
    assert at["sigma_min"] < 1e-15 and at["condition_number"] > 1e15


def test_every_singular_configuration_has_distance_0() -> None:
    rng = np.random.default_rng(5)
    for name in NAMES:
        array = nm.layouts.create(name)
        u = rng.normal(size=(10, array.m)) @ array.torque_axes
        delta = np.arctan2(u @ array.transverse_axes.T, u @ array.spin_axes.T)
        delta = delta + np.pi * rng.integers(0, 2, delta.shape)
        assert measures(array, delta)["sigma_min"].max() < 1e-14
        assert measures(array, delta)["distance_to_singularity"].max() < 1e-7


def test_box90_on_a_gimbal_axis() -> None:
    """Plane 2 in line along x: no torque along z, whatever plane 1 does (its CMGs are free)."""
    delta = np.array([0.4, 1.5, np.pi / 2 - 0.05, -np.pi / 2 + 0.1])
    found = nearest(nm.layouts.box90(), delta)
    assert np.allclose(np.abs(found.u), [0, 0, 1], atol=1e-12)
    assert np.allclose(found.delta_s, [0.4, 1.5, np.pi / 2, -np.pi / 2], atol=1e-12)
    assert found.distance == pytest.approx(np.hypot(0.05, 0.1), abs=1e-12)


def test_turning_the_body_changes_nothing() -> None:
    turn = Rotation.random(random_state=6)
    array, delta = angles("pyramid", 5, seed=6)
    turned = nm.CmgArray(turn.apply(array.gimbal_axes), turn.apply(array.spin_axes), h0=7.0)
    for name, value in measures(array, delta).items():
        assert np.allclose(measures(turned, delta)[name], value, rtol=1e-9)


def test_a_cmg_without_momentum_does_not_count() -> None:
    _, delta = angles("orthogonal_pairs", 5, seed=7)
    weak = nm.layouts.orthogonal_pairs(h0=[1.0, 1.0, 1.0, 1.0, 1.0, 0.0])
    left = weak.without(5)
    for name, value in measures(weak, delta).items():
        assert np.allclose(measures(left, delta[:, :5])[name], value, rtol=1e-9)
    assert nearest(weak, delta[0]).delta_s[5] == delta[0, 5]


@pytest.mark.parametrize("n", [1, 2])
def test_too_few_cmgs_are_always_singular(n: int) -> None:
    array = nm.layouts.pyramid().without(range(n, 4))
    space = nm.CmgArray(array.gimbal_axes, array.spin_axes, torque_axes=np.eye(3))
    found = measures(space, np.full(n, 0.3))
    assert found["sigma_min"] == 0 and found["sqrt_det_AAT"] == 0
    assert found["distance_to_singularity"] < 1e-7


def test_one_torque_dimension() -> None:
    array = nm.CmgArray([[0, 0, 1]] * 2, [[1, 0, 0]] * 2, torque_axes=[[1, 0, 0]])
    found = nearest(array, np.array([0.2, -0.3]))
    assert found.distance == pytest.approx(np.hypot(0.2, 0.3)) and np.allclose(found.delta_s, 0)


@pytest.mark.parametrize("delta", [np.zeros(3), 0.0, np.array([0, 0, np.nan, 0])])
def test_bad_angles_are_refused(delta: np.ndarray) -> None:
    for function in (measures, nearest):
        with pytest.raises(nm.InputError, match="delta"):
            function(nm.layouts.pyramid(), delta)


def test_nearest_has_deltas_leading_axes() -> None:
    array, delta = angles("pyramid", 6)
    found = nearest(array, delta.reshape(2, 3, 4))
    assert found.distance.shape == (2, 3) and found.u.shape == (2, 3, 3)
    for d, distance, delta_s in zip(
        delta, found.distance.ravel(), found.delta_s.reshape(-1, 4), strict=True
    ):
        alone = nearest(array, d)
        assert distance == pytest.approx(alone.distance, abs=1e-12)
        assert np.allclose(delta_s, alone.delta_s, atol=1e-9)

"""The array model: kinematics against differences of momentum, limits, failures, conventions."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nullmotion as nm

PYRAMID = nm.layouts.pyramid()


def random_array(rng: np.random.Generator, n: int, **parameters: object) -> nm.CmgArray:
    """Return an array with random axes and unequal momenta."""
    frames = Rotation.random(n, random_state=rng).as_matrix()
    parameters.setdefault("h0", rng.uniform(0.2, 3.0, n))
    return nm.CmgArray(frames[:, 2], frames[:, 0], **parameters)


def arrays() -> list[nm.CmgArray]:
    """Return every layout and random arrays of 2 to 12 CMGs."""
    rng = np.random.default_rng(3)
    layouts = [nm.layouts.create(name) for name in nm.layouts.names()]
    return layouts + [random_array(rng, n) for n in range(2, 13)]


def difference(array: nm.CmgArray, delta: np.ndarray, step: float = 1e-5) -> np.ndarray:
    """Return the central difference of momentum, (m, n)."""
    columns = [
        (array.momentum(delta + step * e) - array.momentum(delta - step * e)) / (2 * step)
        for e in np.eye(array.n)
    ]
    return np.stack(columns, axis=1)


@pytest.mark.parametrize("array", arrays(), ids=lambda a: f"{a.label}-{a.n}")
def test_jacobian_is_the_derivative_of_momentum(array: nm.CmgArray) -> None:
    rng = np.random.default_rng(0)
    for delta in rng.uniform(-np.pi, np.pi, (5, array.n)):
        error = array.jacobian(delta) - difference(array, delta)
        assert np.abs(error).max() < 1e-9 * array.h0.max()


@pytest.mark.parametrize("array", arrays(), ids=lambda a: f"{a.label}-{a.n}")
def test_rotors_turn_right_handed_about_their_gimbal_axes(array: nm.CmgArray) -> None:
    rng = np.random.default_rng(1)
    delta = rng.uniform(-4, 4, array.n)
    turned = Rotation.from_rotvec(delta[:, None] * array.gimbal_axes).apply(array.spin_axes)
    expected = array.h0[:, None] * turned @ array.torque_axes.T
    assert np.allclose(array.rotor_momenta(delta), expected, atol=1e-14)
    assert np.allclose(array.momentum(delta), expected.sum(axis=0), atol=1e-13)


@pytest.mark.parametrize("shape", [(), (1,), (7,), (2, 3), (0,)])
def test_leading_batch_axes(shape: tuple[int, ...]) -> None:
    rng = np.random.default_rng(2)
    for array in (random_array(rng, 5), nm.layouts.planar(n=5)):
        delta = rng.uniform(-3, 3, (*shape, 5))
        assert array.momentum(delta).shape == (*shape, array.m)
        assert array.jacobian(delta).shape == (*shape, array.m, 5)
        assert array.rotor_momenta(delta).shape == (*shape, 5, array.m)
        for index in np.ndindex(*shape):
            one = delta[index]
            assert np.allclose(array.momentum(delta)[index], array.momentum(one), atol=1e-15)
            assert np.array_equal(array.jacobian(delta)[index], array.jacobian(one))


def test_unit_jacobian_counts_working_cmgs_only() -> None:
    array = nm.layouts.pyramid(h0=[2.0, 0.0, 4.0, 6.0])
    assert array.mean_momentum == pytest.approx(4.0)
    delta = np.array([0.1, 0.2, 0.3, 0.4])
    assert np.allclose(array.unit_jacobian(delta) * 4.0, array.jacobian(delta))


def test_pyramid_has_the_printed_axes() -> None:
    skew = np.radians(54.73)
    s, c = np.sin(skew), np.cos(skew)
    gimbal = [[s, 0, c], [0, s, c], [-s, 0, c], [0, -s, c]]
    assert np.allclose(PYRAMID.gimbal_axes, gimbal, atol=1e-15)
    assert np.array_equal(PYRAMID.spin_axes, [[0, 1, 0], [-1, 0, 0], [0, -1, 0], [1, 0, 0]])


def test_pyramid_has_the_printed_jacobian() -> None:
    c1, c2, c3, c4 = np.cos(delta := np.array([0.3, -1.2, 2.0, 0.7]))
    s1, s2, s3, s4 = np.sin(delta)
    sb, cb = np.sin(np.radians(54.73)), np.cos(np.radians(54.73))
    printed = [
        [-cb * c1, s2, cb * c3, -s4],
        [-s1, -cb * c2, s3, cb * c4],
        [sb * c1, sb * c2, sb * c3, sb * c4],
    ]
    assert np.allclose(PYRAMID.jacobian(delta), printed, atol=1e-15)


def test_pyramid_momentum_with_all_gimbals_at_90_deg() -> None:
    array = nm.layouts.pyramid(skew=np.arcsin(0.8))
    assert np.allclose(array.momentum(np.full(4, np.pi / 2)), [0, 0, 3.2], atol=1e-14)


def test_pyramid_is_singular_at_the_elliptic_state() -> None:
    assert np.linalg.svd(PYRAMID.jacobian(np.radians([-90, 0, 90, 0])))[1][-1] < 1e-15


def test_least_rates_stick_at_1_155_along_x() -> None:
    """[1, 0, 0] from zero momentum runs into the elliptic singularity at 2 cos(54.73 deg) h0."""
    array, delta, dt = nm.layouts.pyramid(rate_limit=np.pi), np.zeros(4), 0.01
    for _ in range(400):
        rates = np.linalg.pinv(array.jacobian(delta), rcond=1e-4) @ [1.0, 0.0, 0.0]
        delta = delta + dt * array.limited(rates)
    assert array.momentum(delta)[0] == pytest.approx(2 * np.cos(np.radians(54.73)), abs=2e-3)
    assert array.momentum(delta)[0] == pytest.approx(1.155, abs=2e-3)


def test_torque_space_of_parallel_gimbals() -> None:
    tilt = Rotation.from_euler("x", 0.4).as_matrix()
    g, s = np.tile(tilt @ [0, 0, 1], (3, 1)), np.tile(tilt @ [1, 0, 0], (3, 1))
    array = nm.CmgArray(g * [[1], [-1], [1]], s)
    assert array.m == 2
    basis = array.torque_axes
    assert np.allclose(basis @ basis.T, np.eye(2)) and np.allclose(basis @ g[0], 0)
    planar = nm.layouts.planar()
    assert np.array_equal(planar.torque_axes, np.eye(3)[:2])
    angles = np.array([0.1, 0.2, 0.3, 0.4])
    expected = [np.cos(angles).sum(), np.sin(angles).sum()]
    assert np.allclose(planar.momentum(angles), expected)


def test_axes_are_made_exactly_orthonormal() -> None:
    array = nm.CmgArray([[0, 0, 1 + 5e-7]], [[1 - 3e-7, 0, 2e-7]])
    assert np.linalg.norm(array.gimbal_axes) == pytest.approx(1, abs=1e-15)
    assert abs(array.gimbal_axes[0] @ array.spin_axes[0]) < 1e-16


def test_rates_are_scaled_together() -> None:
    array = nm.layouts.pyramid(rate_limit=[1.0, 2.0, 1.0, 1.0])
    assert np.allclose(array.limited(np.array([0.5, 4.0, -1.0, 0.0])), [0.25, 2.0, -0.5, 0.0])
    inside = np.array([0.5, -2.0, 1.0, 0.0])
    assert np.array_equal(array.limited(inside), inside)
    assert np.array_equal(array.limited(np.zeros(4)), np.zeros(4))


def test_rates_are_clipped_one_by_one() -> None:
    array = nm.layouts.pyramid(rate_limit=[1.0, 2.0, 1.0, 1.0], rate_limit_mode="clip")
    assert np.array_equal(array.limited(np.array([0.5, 4.0, -3.0, 0.0])), [0.5, 2.0, -1.0, 0.0])


def test_no_rate_limit_leaves_rates_alone() -> None:
    rates = np.array([1e9, -1e3, 0.0, 5.0])
    for mode in ("scale", "clip"):
        array = nm.layouts.pyramid(rate_limit_mode=mode)
        assert np.array_equal(array.limited(rates), rates)
    assert PYRAMID.reference_rate == np.pi
    assert nm.layouts.pyramid(rate_limit=[3, 2, 5, 4]).reference_rate == 2


def test_gimbals_stop_at_their_end_stops() -> None:
    delta = np.array([-3.0, -1.0, 1.0, 3.0])
    assert PYRAMID.within_angle_limits(delta) is delta and not PYRAMID.has_angle_limits
    both = nm.layouts.pyramid(angle_limits=[-2.0, 1.5])
    assert both.has_angle_limits
    assert np.array_equal(both.within_angle_limits(delta), [-2.0, -1.0, 1.0, 1.5])
    free = [-np.inf, np.inf]
    one = nm.layouts.pyramid(angle_limits=[[-1.0, 1.0], free, free, free])
    assert np.array_equal(one.within_angle_limits(delta), [-1.0, -1.0, 1.0, 3.0])


def test_a_removed_cmg_takes_its_momentum_along() -> None:
    array = random_array(np.random.default_rng(5), 5, rate_limit=[1, 2, 3, 4, 5])
    left, delta = array.without(2), np.array([0.1, 0.2, 0.3, 0.4, 0.5])
    keep = [0, 1, 3, 4]
    expected = array.rotor_momenta(delta)[keep].sum(axis=0)
    assert np.allclose(left.momentum(delta[keep]), expected)
    assert np.allclose(left.jacobian(delta[keep]), array.jacobian(delta)[:, keep])
    assert np.array_equal(left.rate_limit, [1, 2, 4, 5]) and "without CMG 2" in left.label


@pytest.mark.parametrize("failed", [[1], [1, 3], [3, 1]])
def test_a_frozen_cmg_keeps_its_momentum(failed: list[int]) -> None:
    array = random_array(np.random.default_rng(6), 5)
    delta = np.array([0.1, -1.2, 0.3, 2.4, 0.5])
    keep = [i for i in range(5) if i not in failed]
    left = array.without(failed, frozen_at=delta[failed])
    assert np.allclose(left.momentum(delta[keep]), array.momentum(delta))
    assert np.allclose(left.jacobian(delta[keep]), array.jacobian(delta)[:, keep])


def test_failures_add_up() -> None:
    array = random_array(np.random.default_rng(7), 5)
    twice = array.without(3, frozen_at=0.3).without(1, frozen_at=0.7)
    at_once = array.without((1, 3), frozen_at=(0.7, 0.3))
    assert np.allclose(twice.momentum_bias, at_once.momentum_bias)
    assert np.array_equal(twice.gimbal_axes, at_once.gimbal_axes)


def test_a_failure_keeps_the_torque_space() -> None:
    left = nm.layouts.box90().without([2, 3])
    assert left.m == 3 and left.n == 2
    assert nm.layouts.planar().without(0, frozen_at=1.0).momentum(np.zeros(3)).shape == (2,)


@pytest.mark.parametrize("mode", ["scale", "clip"])
def test_rates_of_many_states_are_limited_one_by_one(mode, rng):
    array = nm.layouts.pyramid(rate_limit=[0.5, 1.0, 1.5, 2.0], rate_limit_mode=mode)
    rates = rng.normal(size=(2, 5, 4))
    found = array.limited(rates)
    one_by_one = [[array.limited(row) for row in block] for block in rates]
    np.testing.assert_array_equal(found, one_by_one)
    assert (np.abs(found) <= array.rate_limit * (1 + 1e-15)).all()

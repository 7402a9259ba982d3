"""Attitudes as quaternions against SciPy, through floats and through compiled code."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy.spatial.transform import Rotation

from nullmotion import rotation
from nullmotion.compile import compile_function

EXACT = 1e-14

units = (
    hnp.arrays(float, 4, elements=st.floats(-1.0, 1.0))
    .filter(lambda q: np.linalg.norm(q) > 1e-3)
    .map(lambda q: q / np.linalg.norm(q))
)
vectors = hnp.arrays(float, 3, elements=st.floats(-10.0, 10.0))
angles = st.floats(-3.1, 3.1)


def active(q: Any) -> Rotation:
    """Return SciPy's rotation of the same quaternion: it takes vectors of B to N."""
    return Rotation.from_quat(np.roll(q, -1))


def same_attitude(p: Any, q: Any, tolerance: float = 1e-7) -> bool:
    return bool((active(p).inv() * active(q)).magnitude() < tolerance)


@given(units, vectors)
def test_matrix_turns_vectors_of_n_into_b(q_BN: Any, v_N: Any) -> None:
    C = rotation.matrix(q_BN)
    assert np.abs(C @ v_N - active(q_BN).inv().apply(v_N)).max() < 20 * EXACT
    assert np.abs(C @ C.T - np.eye(3)).max() < EXACT
    assert np.linalg.det(C) == pytest.approx(1.0)


@given(units, units)
def test_product_and_conjugate(q_AN: Any, q_BA: Any) -> None:
    product = rotation.multiply(q_AN, q_BA)
    scipys = np.roll((active(q_AN) * active(q_BA)).as_quat(), 1)
    assert min(np.abs(product - scipys).max(), np.abs(product + scipys).max()) < EXACT
    chained = rotation.matrix(q_BA) @ rotation.matrix(q_AN)
    assert np.abs(rotation.matrix(product) - chained).max() < EXACT
    back = rotation.multiply(rotation.conjugate(q_AN), product)
    assert np.abs(back - q_BA).max() < EXACT


def test_quaternion_units() -> None:
    one, i, j, k = np.eye(4)
    for a, b, c in ((i, j, k), (j, k, i), (k, i, j)):
        np.testing.assert_array_equal(rotation.multiply(a, b), c)
        np.testing.assert_array_equal(rotation.multiply(b, a), -c)
        np.testing.assert_array_equal(rotation.multiply(a, a), -one)


@given(units, st.floats(1e-3, 1e3))
def test_normalised(q: Any, length: float) -> None:
    assert np.abs(rotation.normalised(length * q) - q).max() < EXACT


@given(units)
def test_angle_and_the_shorter_way(q: Any) -> None:
    expected = active(q).magnitude()
    for sign in (1.0, -1.0):
        assert rotation.angle(sign * q) == pytest.approx(expected, abs=1e-12)
        near = rotation.shortest(sign * q)
        assert near[0] >= 0 and same_attitude(near, q)
        if abs(q[0]) > 0:
            np.testing.assert_array_equal(near, rotation.shortest(q))


@pytest.mark.parametrize("size", [0.0, 1e-200, 1e-12, 1e-4, np.pi - 1e-9, np.pi])
def test_angles_keep_their_digits(size: float) -> None:
    q = np.array([np.cos(0.5 * size), 0.0, -np.sin(0.5 * size), 0.0])
    assert rotation.angle(q) == pytest.approx(size, rel=1e-15 if size != 1e-200 else 1.0)


@given(units, vectors)
def test_kinematics(q: Any, omega_BN_B: Any) -> None:
    """The rate has its components in the frame that turns: q(t + h) = q * exp(h omega / 2)."""
    h = 1e-5
    before, after = (
        np.roll((active(q) * Rotation.from_rotvec(s * h * omega_BN_B)).as_quat(), 1)
        for s in (-1.0, 1.0)
    )
    before, after = (p * np.sign(p @ q) for p in (before, after))
    slope = (after - before) / (2.0 * h)
    assert np.abs(0.5 * rotation.doubled_rate(q, omega_BN_B) - slope).max() < 1e-6
    pure = np.concatenate([[0.0], omega_BN_B])
    exact = rotation.multiply(q, pure)
    assert np.abs(rotation.doubled_rate(q, omega_BN_B) - exact).max() < 1e-13


@given(st.tuples(angles, angles, angles))
def test_from_euler_angles(yaw_pitch_roll: tuple[float, float, float]) -> None:
    q = rotation.from_euler_321(yaw_pitch_roll)
    expected = Rotation.from_euler("ZYX", yaw_pitch_roll).as_matrix()
    assert np.abs(rotation.matrix(q).T - expected).max() < EXACT


@given(st.tuples(angles, st.floats(-1.5, 1.5), angles))
def test_euler_angles_and_back(yaw_pitch_roll: tuple[float, float, float]) -> None:
    q = rotation.from_euler_321(yaw_pitch_roll)
    for same in (q, -q):
        assert np.abs(rotation.euler_321(same) - yaw_pitch_roll).max() < 1e-12


@given(angles, angles, st.sampled_from([-0.5, 0.5]))
@settings(max_examples=30)
def test_euler_angles_of_a_vertical_body_are_finite(yaw: float, roll: float, turn: float) -> None:
    """At gimbal lock pitch is right to the root of rounding; yaw and roll are finite."""
    found = rotation.euler_321(rotation.from_euler_321((yaw, np.pi * turn, roll)))
    assert np.isfinite(found).all()
    assert found[1] == pytest.approx(np.pi * turn, abs=1e-7)


def test_compiled_code_agrees_with_floats() -> None:
    def everything(p: Any, q: Any, omega: Any) -> Any:
        return (
            rotation.multiply(p, q),
            rotation.conjugate(p),
            rotation.normalised(3.0 * p),
            rotation.doubled_rate(q, omega),
            rotation.shortest(p),
            rotation.matrix(p),
            rotation.angle(p),
            rotation.euler_321(p),
        )

    rng = np.random.default_rng(2)
    p, q = (v / np.linalg.norm(v, axis=-1, keepdims=True) for v in rng.normal(size=(2, 200, 4)))
    omega = rng.normal(size=(200, 3))
    found = compile_function(everything, np.zeros(4), np.zeros(4), np.zeros(3))(p, q, omega)
    for i in range(200):
        for part, expected in zip(found, everything(p[i], q[i], omega[i]), strict=True):
            np.testing.assert_allclose(part[i], expected, rtol=1e-11, atol=1e-13)

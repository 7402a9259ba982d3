"""Runs against an independent integration with SciPy, from formulas written again here."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import nullmotion as nm
from nullmotion.sim import Setup, run

BETA, H0 = np.radians(50.0), 1.7
START, COMMAND = np.array([0.3, -0.4, 0.2, 0.6]), np.array([0.5, -0.3, 0.4])


def momentum(d):
    """The pyramid's momentum, entry by entry."""
    s, c = np.sin(d), np.cos(d)
    cb, sb = np.cos(BETA), np.sin(BETA)
    x = -cb * s[0] - c[1] + cb * s[2] + c[3]
    y = c[0] - cb * s[1] - c[2] + cb * s[3]
    z = sb * s.sum()
    return H0 * np.array([x, y, z])


def jacobian(d):
    """Its derivative, entry by entry."""
    s, c = np.sin(d), np.cos(d)
    cb, sb = np.cos(BETA), np.sin(BETA)
    rows = [
        [-cb * c[0], s[1], cb * c[2], -s[3]],
        [-s[0], -cb * c[1], s[2], cb * c[3]],
        [sb * c[0], sb * c[1], sb * c[2], sb * c[3]],
    ]
    return H0 * np.array(rows)


def damped_inverse(d):
    a = jacobian(d) / H0
    gram = a @ a.T
    damping = 0.01 * np.exp(-10.0 * np.linalg.det(gram))
    return a.T @ np.linalg.solve(gram + damping * np.eye(3), COMMAND / H0)


def least_squares(d):
    return np.linalg.pinv(jacobian(d)) @ COMMAND


@pytest.mark.parametrize(
    ("law", "parameters", "rates"),
    [
        ("pseudo-inverse", {}, least_squares),
        ("sr", {"lambda0": 0.01, "mu": 10.0, "schedule": "det"}, damped_inverse),
    ],
)
def test_sampled_runs_converge_to_the_continuous_law(law, parameters, rates):
    truth = solve_ivp(
        lambda t, d: rates(d), (0.0, 0.5), START, method="DOP853", rtol=1e-12, atol=1e-13
    ).y[:, -1]
    array = nm.layouts.pyramid(skew=BETA, h0=H0)
    errors = []
    for steps in (500, 1000, 2000):
        setup = Setup(
            array, nm.laws.create(law, **parameters), START, COMMAND, dt=0.5 / steps, steps=steps
        )
        errors.append(np.abs(run(setup).delta[-1] - truth).max())
    assert errors[2] < 3e-4
    # rates held between samples: first order, so the error halves with the period
    np.testing.assert_allclose(np.array(errors[:-1]) / errors[1:], 2.0, rtol=0.02)
    extrapolated = abs(2 * errors[2] - errors[1])
    assert extrapolated < 1e-6


def test_momentum_and_jacobian_entry_by_entry(rng):
    array = nm.layouts.pyramid(skew=BETA, h0=H0)
    for d in rng.uniform(-np.pi, np.pi, (50, 4)):
        np.testing.assert_allclose(array.momentum(d), momentum(d), atol=1e-14)
        np.testing.assert_allclose(array.jacobian(d), jacobian(d), atol=1e-14)


def test_impulse_is_the_integral_of_torque(rng):
    """RK4 of the achieved torque under held rates, against adaptive integration step by step."""
    array = nm.layouts.pyramid(skew=BETA, h0=H0)
    setup = Setup(array, nm.laws.create("sr"), START, COMMAND, dt=0.05, steps=20)
    result = run(setup)
    total = np.zeros(3)
    for d, r in zip(result.delta[:-1], result.rates[:-1], strict=True):
        piece = solve_ivp(
            lambda t, y, d=d, r=r: jacobian(d + r * t) @ r,
            (0, 0.05),
            np.zeros(3),
            rtol=1e-12,
            atol=1e-14,
        )
        total += piece.y[:, -1]
    np.testing.assert_allclose(result.impulse[-1], total, atol=1e-8)
    np.testing.assert_allclose(result.momentum[-1] - result.momentum[0], total, atol=1e-11)

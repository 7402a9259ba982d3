"""Laws against LAPACK, finite differences and hand-made states."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from nullmotion import InputError, Observation, laws, layouts, linalg
from nullmotion.array import momentum_state

ARRAY = layouts.create("pyramid", h0=2.0, rate_limit=np.pi)
RNG = np.random.default_rng(4)
STATES = [(RNG.uniform(-np.pi, np.pi, 4), RNG.normal(size=3)) for _ in range(20)]


def rates(law: Any, delta: Any, hdot: Any, array: Any = ARRAY, t: float = 0.0) -> np.ndarray:
    return law.step(array, Observation(delta, hdot, t), law.init(array, delta))[0]


@pytest.mark.parametrize("shape", [(2, 2), (2, 3), (2, 5), (3, 2), (3, 3), (3, 4), (3, 6), (3, 12)])
def test_rows_are_a_singular_value_decomposition(shape: tuple[int, int]) -> None:
    for k in range(40):
        a = RNG.normal(size=shape)
        if k % 2:  # towards a singular matrix
            a[-1] = a[0] + a[-1] * 10.0 ** -RNG.uniform(0, 17)
        b = RNG.normal(size=shape[0])
        rows = linalg.rows(a, b)
        values = np.linalg.svd(a, compute_uv=False)
        got = np.sqrt(rows.squares)
        np.testing.assert_allclose(got[: len(values)], values, atol=2e-14 * values[0])
        r = np.sqrt(rows.weights)[:, None] * rows.x
        np.testing.assert_allclose(r.T @ r, a.T @ a, atol=2e-14 * values[0] ** 2)
        np.testing.assert_allclose(
            r.T @ rows.along, a.T @ b, atol=2e-14 * values[0] * linalg.norm(b)
        )
        np.testing.assert_allclose(r @ r.T, np.diag(rows.squares), atol=2e-14 * values[0] ** 2)


def test_pseudo_inverse_is_numpys() -> None:
    for delta, hdot in STATES:
        expected = np.linalg.pinv(ARRAY.jacobian(delta)) @ hdot
        np.testing.assert_allclose(rates(laws.create("pi"), delta, hdot), expected, rtol=1e-9)


@pytest.mark.parametrize(
    ("schedule", "mu", "damping"),
    [
        ("constant", 1.0, lambda w: 0.3),
        ("manipulability", 1.2, lambda w: 0.3 * max(1 - w / 1.2, 0) ** 2),
        ("exponential", 2.0, lambda w: 0.3 * np.exp(-2 * w)),
        ("det", 2.0, lambda w: 0.3 * np.exp(-2 * w * w)),
    ],
)
def test_sr_minimises_the_damped_residual(schedule: str, mu: float, damping: Any) -> None:
    law = laws.create("sr", lambda0=0.3, mu=mu, schedule=schedule)
    for delta, hdot in STATES:
        a = ARRAY.jacobian(delta) / 2.0
        lam = damping(np.prod(np.linalg.svd(a, compute_uv=False)))
        stacked = np.vstack([a, np.sqrt(lam) * np.eye(4)])
        wanted = np.concatenate([hdot / 2.0, np.zeros(4)])
        expected = np.linalg.lstsq(stacked, wanted, rcond=None)[0]
        np.testing.assert_allclose(rates(law, delta, hdot), expected, rtol=1e-8, atol=1e-10)


def test_sda_errs_along_the_singular_direction_only() -> None:
    law = laws.create("sda", alpha0=0.5, kappa=0.1)
    for delta, hdot in STATES:
        u, s, _ = np.linalg.svd(ARRAY.unit_jacobian(delta))
        error = u.T @ (hdot - ARRAY.jacobian(delta) @ rates(law, delta, hdot))
        np.testing.assert_allclose(error[:2], 0.0, atol=1e-9)
        alpha = 0.5 * np.exp(-0.1 * np.prod(s) ** 2)
        expected = alpha / (s[2] ** 2 + alpha) * (u.T @ hdot)[2]
        np.testing.assert_allclose(error[2], expected, atol=1e-9)


@pytest.mark.parametrize("layout", ["pyramid", "planar", "roof6", "triangle"])
def test_local_gradient_is_the_slope_of_the_determinant(layout: str) -> None:
    array = layouts.create(layout, h0=3.0)
    delta = np.random.default_rng(8).uniform(-np.pi, np.pi, array.n)

    def det(d: np.ndarray) -> float:
        a = array.unit_jacobian(d)
        return float(np.linalg.det(a @ a.T))

    h = 1e-6
    slope = [(det(delta + h * e) - det(delta - h * e)) / (2 * h) for e in np.eye(array.n)]
    a = array.jacobian(delta)
    expected = 0.7 * (np.eye(array.n) - np.linalg.pinv(a) @ a) @ slope
    got = rates(laws.create("local-gradient", k=0.7), delta, np.zeros(array.m), array)
    np.testing.assert_allclose(got, expected, atol=1e-7)


def test_gsr_damping_has_the_published_pattern() -> None:
    phase = (0.1, 0.7, 2.0)
    law = laws.create("gsr", epsilon0=0.2, mu0=0.4, kappa=0.3, omega=1.5, phase=phase)
    e1, e2, e3 = (0.2 * np.sin(1.5 * 0.6 + p) for p in phase)
    dither = np.array([[1, e3, e2], [e3, 1, e1], [e2, e1, 1]])
    for delta, hdot in STATES:
        a = ARRAY.jacobian(delta) / 2.0
        mu = 0.4 * np.exp(-0.3 * np.linalg.det(a @ a.T))
        expected = a.T @ np.linalg.inv(a @ a.T + mu * dither) @ hdot / 2.0
        np.testing.assert_allclose(rates(law, delta, hdot, t=0.6), expected, rtol=1e-9, atol=1e-12)


def test_nd_moves_through_the_null_space_within_the_reference_rate() -> None:
    for delta, hdot in STATES:
        free = rates(laws.create("nd"), delta, hdot) - rates(laws.create("pi"), delta, hdot)
        np.testing.assert_allclose(ARRAY.jacobian(delta) @ free, 0.0, atol=1e-12)
        assert np.linalg.norm(free) <= np.pi + 1e-9


def test_dsea_leaves_a_regular_array_alone_and_moves_one_at_rest_in_a_deadlock() -> None:
    law = laws.create("dsea")
    start = np.radians([-90.0, 0.0, 90.0, 0.0])
    stuck = np.array([2.0, 0.0, 0.0])
    assert np.abs(rates(laws.create("sda"), start, stuck)).max() < 1e-9
    assert np.abs(rates(law, start, stuck)).max() > 0.1
    assert not rates(law, start, np.zeros(3)).any()


def test_dsea_signs_minimise_the_sum() -> None:
    from itertools import product

    from nullmotion.laws import dsea

    for n in (2, 4, 6, 8, 12):
        arms = RNG.normal(size=(n, 3))
        theta = np.asarray(dsea._best_signs(arms), float)
        assert set(theta) <= {-1.0, 1.0} and theta[-1] == 1.0
        lengths = [np.linalg.norm(np.array(s) @ arms) for s in product((1, -1), repeat=n)]
        if n <= 6:
            assert np.linalg.norm(theta @ arms) == pytest.approx(min(lengths), abs=1e-9)
        else:
            assert np.linalg.norm(theta @ arms) <= np.median(lengths)


def test_dsea_ties_do_not_hang_on_rounding() -> None:
    from nullmotion.laws import dsea

    arms = np.array([[1.0, 0, 0], [1.0, 0, 0], [-1.0, 0, 0], [-1.0, 0, 0]])
    for _ in range(50):
        noisy = arms + RNG.normal(size=arms.shape) * 1e-15
        assert list(dsea._best_signs(noisy)) == [1.0, 1.0, 1.0, 1.0]


def test_dsea_guard_keeps_the_side_it_turned_to() -> None:
    law = laws.create("dsea")
    delta, hdot = np.radians([-80.0, 10.0, 85.0, 3.0]), np.array([2.0, 0.1, 0.0])
    _, state = law.step(ARRAY, Observation(delta, hdot), law.init(ARRAY, delta))
    reversed_ = type(state)(-state.theta, state.inside, -state.escape)
    _, after = law.step(ARRAY, Observation(delta, hdot), reversed_)
    np.testing.assert_allclose(after.escape, reversed_.escape)


def test_vcbsae_is_continuous_where_escape_sets_in() -> None:
    law = laws.create("vcbsae")
    target = np.radians([-90.0, 0.0, 90.0, 0.0])
    hdot = np.array([2.0, 0.3, 0.2])
    away = np.array([0.3, 0.5, 0.4, 1.0])

    def least(x: float) -> float:
        return float(np.linalg.svd(ARRAY.unit_jacobian(target + x * away), compute_uv=False)[-1])

    low, high = 0.0, 0.5
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if least(middle) < 0.1 else (low, middle)
    before = rates(law, target + (low - 1e-9) * away, hdot)
    after = rates(law, target + (high + 1e-9) * away, hdot)
    np.testing.assert_allclose(before, after, atol=1e-5)


def test_residual_momentum_runs_from_full_to_used_up() -> None:
    e = np.array([0.3, -0.5, 0.8])
    g = ARRAY.gimbal_axes
    unit = e / np.linalg.norm(e)
    against = -(unit - (g @ unit)[:, None] * g)
    delta = np.arctan2(
        np.sum(against * ARRAY.transverse_axes, axis=1), np.sum(against * ARRAY.spin_axes, axis=1)
    )
    alpha = np.arccos(np.abs(g @ unit))
    full = momentum_state.eram(ARRAY, delta, e)
    np.testing.assert_allclose(full, 2 * alpha / np.pi, atol=1e-12)
    np.testing.assert_allclose(momentum_state.eram(ARRAY, delta + np.pi, e), 0.0, atol=1e-12)
    assert momentum_state.sse(ARRAY, delta, e, 0.5) == pytest.approx(full.sum() + 0.5)


@pytest.mark.parametrize(
    ("law", "key", "value"),
    [
        ("pseudo-inverse", "sigma_floor", 0.0),
        ("sr", "lambda0", -1.0),
        ("sr", "mu", float("nan")),
        ("sr", "schedule", "sometimes"),
        ("gsr", "epsilon0", 0.5),
        ("gsr", "phase", (0.0, 1.0)),
        ("odsr", "mu0", 0.02),
        ("odsr", "w", (1.0, 0.0, 1.0, 1.0)),
        ("sda", "alpha0", float("inf")),
        ("nd", "gain", -1.0),
        ("local-gradient", "k", "much"),
        ("dsea", "tau_max", 0.0),
        ("dsea", "xi", True),
        ("vcbsae", "varsigma", 0.0),
        ("vcbsae", "sigma_c", -0.1),
    ],
)
def test_impossible_parameters_are_refused_by_key(law: str, key: str, value: Any) -> None:
    with pytest.raises(InputError) as caught:
        laws.create(law, **{key: value})
    assert caught.value.key == f"law.{key}"


def test_whole_numbers_become_floats() -> None:
    law = laws.create("odsr", w=[1, 1, 1, 1], kappa=10)
    assert law.w == (1.0, 1.0, 1.0, 1.0) and all(isinstance(x, float) for x in (*law.w, law.kappa))
    assert "3 weights" in laws.create("odsr", w=(1.0, 1.0, 1.0)).supports(ARRAY)

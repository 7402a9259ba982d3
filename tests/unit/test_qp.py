"""Quadratic programs: every solver is held to the same KKT residuals, by the problem itself."""

from __future__ import annotations

import numpy as np
import pytest

from nullmotion import qp
from nullmotion.errors import InputError, UnknownNameError
from nullmotion.qp.solvers.piqp import Piqp


def problem(seed: int, n: int = 12, k: int = 8, equations: int = 2) -> qp.Problem:
    """A feasible problem with bounds of every kind."""
    rng = np.random.default_rng(seed)
    root, A, inside = rng.normal(size=(n, n)), rng.normal(size=(k, n)), rng.uniform(-1, 1, n)
    lower, upper = A @ inside - rng.uniform(0, 1, k), A @ inside + rng.uniform(0, 1, k)
    lower[:equations] = upper[:equations] = (A @ inside)[:equations]
    lower[3], upper[4] = -np.inf, np.inf
    x_lower, x_upper = np.full(n, -1.0), np.full(n, 1.0)
    x_lower[:3], x_upper[2:4] = -np.inf, np.inf
    g = 20.0 * rng.normal(size=n)
    return qp.Problem(root @ root.T + np.eye(n), g, A, lower, upper, x_lower, x_upper)


@pytest.mark.parametrize("name", qp.names())
@pytest.mark.parametrize("seed", range(4))
def test_every_solver_satisfies_the_same_conditions(name, seed):
    asked = problem(seed)
    found, reference = qp.solve(asked, name), qp.solve(asked, "clarabel", tolerance=1e-7)
    assert found.solved and found.solver == name and found.iterations > 0 and found.seconds > 0
    residuals = asked.residuals(found.x, found.multipliers)
    assert residuals.worst == found.residual <= 1e-6
    np.testing.assert_allclose(found.x, reference.x, atol=1e-5)
    np.testing.assert_allclose(asked.cost(found.x), asked.cost(reference.x), rtol=1e-6)


def test_residuals_see_each_condition():
    """One variable: minimise 1/2 x^2 - 2 x with x <= 1, so x = 1 and y = 1."""
    one = qp.Problem([[1.0]], [-2.0], x_upper=[1.0])
    x, y = np.array([1.0]), np.array([1.0])
    assert one.residuals(x, y).worst == 0.0
    assert one.residuals(x, 0 * y).stationarity == pytest.approx(0.5)
    assert one.residuals(2 * x, 0 * y) == (0.0, pytest.approx(0.5), 0.0, 0.0)
    assert one.residuals(3 * x, -y).dual == 1.0
    assert one.residuals(0.5 * x, 1.5 * y).complementarity == pytest.approx(0.5)
    assert one.residuals(np.nan * x, y).worst == np.inf


@pytest.mark.parametrize("name", ["daqp", "osqp"])
def test_a_warm_start_saves_iterations(name):
    asked = problem(5, 30, 20)
    cold = qp.solve(asked, name)
    nearly = qp.Problem(
        asked.H, asked.g + 1e-5, asked.A, asked.lower, asked.upper, asked.x_lower, asked.x_upper
    )
    warm = qp.create(name).solve(nearly, cold)
    assert warm.solved and warm.iterations < 0.7 * cold.iterations
    assert qp.create(name).solve(problem(6), cold).solved, "a start of another shape is left out"


@pytest.mark.parametrize("name", qp.names())
def test_trouble_is_a_status(name):
    asked = problem(7, 30, 20)
    late = qp.solve(asked, name, iteration_limit=1)
    assert late.status is qp.Status.ITERATION_LIMIT and not late.solved
    assert qp.solve(asked, name, time_limit_s=1e-9).status in (
        qp.Status.TIME_LIMIT, qp.Status.ITERATION_LIMIT,
    )  # fmt: skip
    none = qp.Problem(np.eye(2), np.ones(2), [[1.0, 0.0]], [2.0], [3.0], [-1, -1], [1, 1])
    assert qp.solve(none, name).status is qp.Status.INFEASIBLE


def test_a_contented_solver_is_not_believed(monkeypatch):
    """PIQP with bounds of 1e20 for infinity: what it returns must not count as solved."""
    right = problem(8)
    run = Piqp.run

    def sloppy(self, asked, start):
        raw = run(self, asked, start)
        return raw._replace(x=raw.x + 1e-4, status=qp.Status.SOLVED)

    monkeypatch.setattr(Piqp, "run", sloppy)
    assert qp.solve(right, "piqp").status is qp.Status.INACCURATE


def test_solvers_leave_the_problem_alone():
    asked = problem(9)
    before = [np.array(v) for v in (asked.H, asked.g, asked.A, asked.lower, asked.x_upper)]
    for name in qp.names():
        qp.solve(asked, name)
    after = (asked.H, asked.g, asked.A, asked.lower, asked.x_upper)
    for old, new in zip(before, after, strict=True):
        np.testing.assert_array_equal(old, new)
    with pytest.raises(ValueError, match="read-only"):
        asked.H[0, 0] = 1.0


@pytest.mark.parametrize("name", ["daqp", "piqp"])
def test_soft_rows_give_way_at_a_price(name):
    """Rows x <= 1 and x >= 3 cannot both hold; with prices 1 and 4 the middle is weighted."""
    hard = qp.Problem([[1e-9]], [0.0], [[1.0], [1.0]], [-np.inf, 3.0], [1.0, np.inf])
    soft = qp.softened(hard, [0, 1], [1.0, 4.0])
    found = qp.solve(soft, name)
    np.testing.assert_allclose(found.x, [2.6, 1.6, 0.4], atol=1e-6)
    between = qp.Problem([[1.0]], [-5.0], [[1.0]], [0.0], [1.0])
    exact = qp.solve(qp.softened(between, [0], 1.0, linear=10.0), name)
    np.testing.assert_allclose(exact.x, [1.0, 0.0], atol=1e-7)
    dear = qp.solve(qp.softened(between, [0], 1.0), name)
    np.testing.assert_allclose(dear.x, [3.0, 2.0], atol=1e-7)
    below = qp.Problem([[1.0]], [5.0], [[1.0]], [0.0], [1.0])
    np.testing.assert_allclose(qp.solve(qp.softened(below, [0], 1.0), name).x, [-2.5, 2.5])


def test_a_missing_solver_says_what_to_install(monkeypatch):
    monkeypatch.setattr(Piqp, "package", "no_such_solver")
    with pytest.raises(InputError, match=r"nullmotion\[qp\]"):
        qp.create("piqp")
    with pytest.raises(UnknownNameError, match="daqp"):
        qp.create("dakp")


def test_shapes_are_checked():
    with pytest.raises(InputError, match=r"problem\.H"):
        qp.Problem(np.eye(3), np.zeros(2))
    with pytest.raises(InputError, match=r"problem\.lower"):
        qp.Problem(np.eye(2), np.zeros(2), np.ones((1, 2)), [0.0, 1.0], [2.0])
    with pytest.raises(InputError, match="rows"):
        qp.softened(problem(0), [8], 1.0)

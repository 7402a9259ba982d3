"""The planar closed forms against SciPy's SQP from many starts: nothing better is found."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize

import nullmotion as nm


def _squares(delta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the squared rows of the pseudo-inverse, (n,), and their gradients, (n, n)."""
    h = np.array([np.cos(delta), np.sin(delta)])
    a = np.array([-h[1], h[0]])
    inverse = np.linalg.inv(a @ a.T)
    rows = inverse @ a  # columns are the rows of A^+
    back = inverse @ rows
    n = len(delta)
    gradient = np.zeros((n, n))
    for k in range(n):
        change = -(np.outer(h[:, k], a[:, k]) + np.outer(a[:, k], h[:, k]))
        gradient[:, k] = -2 * np.einsum("ij,ik,kj->j", back, change, rows)
        gradient[k, k] -= 2 * back[:, k] @ h[:, k]
    return np.sum(rows * rows, axis=0), gradient


def _best(n: int, H: float, starts: int, rng: np.random.Generator) -> float:
    """Return the least greatest row norm that SQP finds at momentum (H, 0)."""
    slack = np.eye(n + 1)[n]
    best = np.inf
    for _ in range(starts):
        x0 = np.append(rng.uniform(-np.pi, np.pi, n) * rng.uniform(0.2, 1), 1.0)
        found = minimize(
            lambda x: (x[n], slack),
            x0,
            jac=True,
            method="SLSQP",
            constraints=[
                {
                    "type": "eq",
                    "fun": lambda x: [np.cos(x[:n]).sum() - H, np.sin(x[:n]).sum()],
                    "jac": lambda x: [[*-np.sin(x[:n]), 0.0], [*np.cos(x[:n]), 0.0]],
                },
                {
                    "type": "ineq",
                    "fun": lambda x: x[n] - _squares(x[:n])[0],
                    "jac": lambda x: np.hstack([-_squares(x[:n])[1], np.ones((n, 1))]),
                },
            ],
            options={"maxiter": 300, "ftol": 1e-14},
        )
        met = np.hypot(np.cos(found.x[:n]).sum() - H, np.sin(found.x[:n]).sum())
        if met < 1e-9:
            best = min(best, np.sqrt(_squares(found.x[:n])[0].max()))
    return best


@pytest.mark.parametrize(
    "n", [n if n == 5 else pytest.param(n, marks=pytest.mark.slow) for n in range(4, 16)]
)
@pytest.mark.filterwarnings("ignore")
def test_sqp_never_beats_the_closed_form(n: int) -> None:
    """In the static region, just beyond H_c and up to .99 n."""
    rng = np.random.default_rng(n)
    constraint = nm.guarantee.create("planar", n=n)
    critical = constraint.critical_momentum
    for H in (0.4 * critical, critical + 0.02, 0.5 * (critical + n), 0.99 * n):
        mine = 1 / constraint.torque_capability([H, 0.0])
        found = _best(n, H, 12, rng)
        assert found > mine - 1e-6, (H, found, mine)
        assert found < mine + 1e-3  # the search does reach it


def test_three_cmgs_at_their_worst() -> None:
    """With three CMGs nothing exceeds TC = 1 at H = 1: a scan of the one free angle."""
    theta = np.linspace(-np.pi, np.pi, 20001)
    rest = np.array([1 - np.cos(theta), -np.sin(theta)])
    r = np.hypot(*rest)
    direction, spread = np.arctan2(rest[1], rest[0]), np.arccos(np.minimum(r / 2, 1))
    delta = np.stack([theta, direction - spread, direction + spread], axis=1)[(r > 1e-3) & (r < 2)]
    A = np.stack([-np.sin(delta), np.cos(delta)], axis=1)
    best = (1 / np.linalg.norm(np.linalg.pinv(A), axis=-1).max(axis=-1)).max()
    mine = nm.guarantee.create("planar", n=3).torque_capability([1.0, 0.0])
    assert best < mine + 1e-6

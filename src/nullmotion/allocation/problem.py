"""The quadratic program of N moves of n gimbals, condensed to the rates and N slacks.

    minimise sum_tau 1/2 |hdot - hdot_c|_H^2 + 1/2 |x_tau|_U^2 + 1/2 |x_tau - x_tau-1|_M^2
             + 1/2 rho s_tau^2
    subject to the gimbals' limits and  eta_tau+1 <= s_tau, s_tau >= 0

(Pereira 2022, Eqs 42, 43): at the optimum s = max(eta, 0). What does not change from sample to
sample is made once, as a `_Template`.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from nullmotion.allocation.blocks import Blocks
from nullmotion.allocation.exclusion import Exclusion
from nullmotion.allocation.limits import Limits
from nullmotion.qp import Problem


class Weights(NamedTuple):
    """Weights beside the torque's.

    Attributes:
        size: Diagonal of U, one number or one for each CMG.
        change: Diagonal of M, likewise.
        rho: Price of the slack; 0 if there is none.
        kappa: Distance to singularity that is asked for [rad].
    """

    size: float | tuple[float, ...]
    change: float | tuple[float, ...]
    rho: float
    kappa: float


def problem(
    torque: Blocks,
    weights: Weights,
    limits: Limits,
    keep_off: Exclusion | None,
    before: Any,
    delta: Any,
    period: float,
) -> Problem:
    """Return the program; its x holds the rates (N, n), then the slacks (N,) if there are any.

    Args:
        torque: Blocks of the torque term.
        weights: The other weights.
        limits: What the gimbals can do.
        keep_off: The singular configuration to stay away from, with rho > 0.
        before: Rates in force until now [rad/s], (n,).
        delta: Gimbal angles [rad], (n,).
        period: Length of a move [s].
    """
    N, n = torque.linear.shape
    fixed = _template(N, n, weights, limits.change, limits.has_angles, tuple(limits.rate.tolist()))
    H, A, lower, upper = fixed.H.copy(), fixed.A, fixed.lower, fixed.upper
    H[: N * n, : N * n] += torque.matrix()
    g = fixed.zero.copy()
    g[: N * n] = torque.linear.ravel()
    if limits.change < np.inf or limits.has_angles or keep_off is not None:
        lower, upper = lower.copy(), upper.copy()
    if limits.change < np.inf:
        lower[:n] += before
        upper[:n] += before
    if limits.has_angles:
        rows = slice(fixed.changes, fixed.changes + N * n)
        lower[rows], upper[rows] = np.tile((limits.angle - delta) / period, N)
    if keep_off is not None:
        step = -weights.kappa * period
        A = A.copy()
        A[-N:, : N * n].reshape(N, N, n)[...] = fixed.later * (step * keep_off.normal)
        upper[-N:] = weights.kappa * (keep_off.distance - weights.kappa)
    g[:n] -= np.asarray(weights.change) * before
    return Problem(H, g, A, lower, upper, fixed.x_lower, fixed.x_upper)


class _Template(NamedTuple):
    """The fixed parts: see `Problem`; ``changes`` counts the rows of changes of rates."""

    H: np.ndarray
    zero: np.ndarray
    A: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    x_lower: np.ndarray
    x_upper: np.ndarray
    later: np.ndarray
    changes: int


@lru_cache(maxsize=16)
def _template(
    N: int, n: int, weights: Weights, change: float, angles: bool, rate: tuple[float, ...]
) -> _Template:
    slack = N if weights.rho > 0 else 0
    rates = N * n
    D, L = np.eye(rates) - np.eye(rates, k=-n), np.tril(np.ones((N, N)))
    size, smooth = (np.resize(w, rates) for w in (weights.size, weights.change))
    H = np.diag(np.concatenate([size, np.full(slack, weights.rho)]))
    H[:rates, :rates] += D.T @ (smooth[:, None] * D)
    changes = rates if change < np.inf else 0
    rows = [D[:changes], np.kron(L, np.eye(n))[: rates if angles else 0], np.zeros((slack, rates))]
    A = np.zeros((sum(map(len, rows)), rates + slack))
    A[:, :rates] = np.concatenate(rows)
    A[len(A) - slack :, rates:] = -np.eye(slack)
    upper = np.full(len(A), np.inf)
    upper[:changes] = change
    most = np.concatenate([np.tile(rate, N), np.full(slack, np.inf)])
    least = np.concatenate([-most[:rates], np.zeros(slack)])
    zero = np.zeros(rates + slack)
    return _Template(H, zero, A, -upper, upper, least, most, L[..., None], changes)

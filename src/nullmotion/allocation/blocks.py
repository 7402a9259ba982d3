"""The torque term of an allocation over N moves, as blocks of its matrices.

Move tau = 0 ... N - 1 holds the gimbal rates x_tau for a sample of T seconds. About rates p_tau
that were planned before, with gamma_phi,tau = gamma + T (p_0 + ... + p_tau-1),

    hdot_tau = J_tau x_tau + A_tau T sum_{j < tau} (x_j - p_j),      A = d(J gamma_dot)/d(gamma)

(Pereira 2022, Eqs 43a, 44), J and A at gamma_phi,tau; with ``midpoint`` at the middle of the
move, gamma_phi,tau + T p_tau / 2, and A_tau T (x_tau - p_tau) / 2 beside it: hdot_tau is then the
mean over the sample to second order. The term 1/2 sum |hdot_tau - hdot_c,tau|_H^2 is
1/2 x^T P x + f^T x with

    P_ij = O_max(i,j) (transposed below the diagonal) for i != j,    P_ii = D_i.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from nullmotion import ops


class Blocks(NamedTuple):
    """Blocks of P and f.

    Attributes:
        diagonal: D_j, (N, n, n).
        above: O_j, every block above D_j, (N, n, n).
        linear: f_j, (N, n).
    """

    diagonal: Any
    above: Any
    linear: Any

    def matrix(self) -> np.ndarray:
        """Return P, (N n, N n), of floats."""
        N, n = self.linear.shape
        parts = np.concatenate([self.above, self.above.mT, self.diagonal])
        found: np.ndarray = parts[_which(N)].transpose(0, 2, 1, 3).reshape(N * n, N * n)
        return found


@lru_cache(maxsize=16)
def _which(N: int) -> np.ndarray:
    """Return for each block of P its number among those above, below and on the diagonal."""
    row, column = np.indices((N, N))
    return np.where(row < column, column, np.where(row > column, N + row, 2 * N + row))


def blocks(
    spin: Any,
    transverse: Any,
    delta: Any,
    plan: Any,
    wanted: Any,
    weight: Any,
    period: Any,
    midpoint: bool = False,
) -> Blocks:
    """Return the blocks, on floats or symbols.

    Args:
        spin: Rotor momenta at delta = 0 over the mean momentum, (n, m).
        transverse: Columns of A at delta = 0 over the mean momentum, (n, m).
        delta: Gimbal angles now [rad], (n,).
        plan: Rates planned before [rad/s], (N, n).
        wanted: hdot_c over the mean momentum [rad/s], (N, m).
        weight: Diagonal of H, (m,).
        period: T [s].
        midpoint: Whether to linearise at the middle of each move.
    """
    places: list[tuple[Any, Any, Any]] = []
    done = 0.0 * delta
    for p in plan:
        own = (0.5 * period) * p if midpoint else 0.0 * p
        J, A = linearised(spin, transverse, delta + done + own, p)
        places.append((J, A, wanted[len(places)] + A @ (done + own)))
        done = done + period * p
    diagonal, above, linear = [], [], []
    curvature: Any = np.zeros((len(delta), len(delta)))
    later: Any = np.zeros(len(delta))
    for J, A, b in reversed(places):
        S = J + (0.5 * period) * A if midpoint else J
        weighted, carried = S * weight[:, None], period * A
        diagonal.append(S.T @ weighted + curvature)
        above.append(carried.T @ weighted + curvature)
        linear.append(-(weighted.T @ b) + later)
        curvature = curvature + carried.T @ (carried * weight[:, None])
        later = later - carried.T @ (weight * b)
    return Blocks(*(np.array(part[::-1]) for part in (diagonal, above, linear)))


def linearised(spin: Any, transverse: Any, delta: Any, rates: Any) -> tuple[Any, Any]:
    """Return J (m, n) and A = d(J rates)/d(delta) [1/s], (m, n), over the mean momentum."""
    c, s = ops.cos(delta), ops.sin(delta)
    J = c * transverse.T - s * spin.T
    return J, -(c * spin.T + s * transverse.T) * rates

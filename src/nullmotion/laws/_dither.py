"""What the generalised and the off-diagonal singularity-robust laws share."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion import linalg, ops
from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError
from nullmotion.law import Observation, check_parameters


def check_dither(law: Any) -> None:
    """Refuse impossible dither parameters."""
    check_parameters(law, positive=("mu0", "omega"), not_negative=("epsilon0", "kappa"))
    if not law.epsilon0 < 0.5:
        raise InputError("law.epsilon0", law.epsilon0, "below 0.5 (the damping stays positive)")
    try:
        phase = tuple(float(p) for p in law.phase)
    except (TypeError, ValueError):
        phase = ()
    if len(phase) != 3 or not np.isfinite(phase).all():
        raise InputError("law.phase", law.phase, "three numbers (rad)")
    object.__setattr__(law, "phase", phase)


def dither_matrix(m: int, size: Any, angle: Any, phase: Any) -> Any:
    """Return E (m x m): ones, and e_k = size sin(angle + phase_k) at (i, j), k = 3 - i - j.

    For m = 3, E = [[1, e3, e2], [e3, 1, e1], [e2, e1, 1]]; for m = 2 its upper left corner.
    """
    e = [size * ops.sin(angle + p) for p in phase]
    return np.array([[1.0 if i == j else e[3 - i - j] for j in range(m)] for i in range(m)])


def dithered_rates(law: Any, array: CmgArray, obs: Observation, weights: Any, coupled: bool) -> Any:
    """Return W A^T (A W A^T + mu E)^-1 hdot, mu = mu0 exp(-kappa det(A A^T)).

    Args:
        law: Holder of epsilon0, mu0, kappa, omega, phase, as_published.
        array: The array.
        obs: What the law sees.
        weights: Diagonal of W, (n,).
        coupled: Whether W has mu off its diagonal.
    """
    A = array.unit_jacobian(obs.delta)
    mu = law.mu0 * ops.exp(-law.kappa * linalg.det(A @ A.T))
    omega = array.reference_rate / np.pi if law.omega is None else law.omega
    clock = obs.t + 0.5 * obs.period if law.as_published else obs.t
    E = dither_matrix(array.m, law.epsilon0, omega * clock, law.phase)
    diagonal = np.eye(array.n)
    W = diagonal * weights
    W = W + mu * (1.0 - diagonal) if coupled else W
    return W @ (A.T @ linalg.solve(A @ W @ A.T + mu * E, obs.hdot / array.mean_momentum))

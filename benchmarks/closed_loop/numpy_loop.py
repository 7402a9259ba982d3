"""One run in plain NumPy: the readable statement of the workload, and the truth for the others."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import workload as w
from workload import Array, Batch

Law = Callable[[Array, Array], Array]


def momenta(delta: Array) -> Array:
    """Columns h_i = h0 (s_i cos delta_i + t_i sin delta_i), 3 x 4."""
    return w.H0 * (w.SPIN_AXES.T * np.cos(delta) + w.CROSS_AXES.T * np.sin(delta))


def jacobian(delta: Array) -> Array:
    """A = dh/d(delta), columns h0 (-s_i sin delta_i + t_i cos delta_i), 3 x 4."""
    return w.H0 * (w.CROSS_AXES.T * np.cos(delta) - w.SPIN_AXES.T * np.sin(delta))


def cross(a: Array, b: Array) -> Array:
    """Cross product of 3-vectors; np.cross takes ten times as long on one pair."""
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


def adjugate(m: Array) -> Array:
    """Adjugate of a symmetric 3 x 3 matrix: its columns are cross products of its columns."""
    return np.array([cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])])


def robust_inverse(a: Array) -> Array:
    """A^T (A A^T + lambda I)^-1, lambda = 0.01 exp(-10 det(A A^T))."""
    gram = a @ a.T
    lam = w.LAMBDA0 * np.exp(-w.LAMBDA_SLOPE * np.linalg.det(gram))
    return a.T @ np.linalg.inv(gram + lam * np.eye(3))


def law_sr(delta: Array, hdot: Array) -> Array:
    """Singularity-robust inverse."""
    return robust_inverse(jacobian(delta)) @ hdot


def law_gradient(delta: Array, hdot: Array) -> Array:
    """The same plus k (I - A# A) grad det(A A^T), grad_i = -2 h_i^T adj(A A^T) a_i."""
    a, h = jacobian(delta), momenta(delta)
    inverse = robust_inverse(a)
    grad = -2.0 * np.einsum("ki,kl,li->i", h, adjugate(a @ a.T), a)
    return inverse @ hdot + w.GRADIENT_GAIN * (grad - inverse @ (a @ grad))


def law_svd(delta: Array, hdot: Array) -> Array:
    """V diag(1/s1, 1/s2, s3/(s3^2 + alpha)) U^T hdot, alpha = 0.01 exp(-10 s3^2)."""
    u, s, vt = np.linalg.svd(jacobian(delta), full_matrices=False)
    alpha = w.LAMBDA0 * np.exp(-w.LAMBDA_SLOPE * s[2] ** 2)
    gain = np.array([1.0 / s[0], 1.0 / s[1], s[2] / (s[2] ** 2 + alpha)])
    return vt.T @ (gain * (u.T @ hdot))


LAW: dict[str, Law] = {"sr": law_sr, "sr+gradient": law_gradient, "svd": law_svd}


def derivative(x: Array, rates: Array) -> Array:
    """d/dt (q, omega, delta) under held gimbal rates."""
    q, omega, delta = x[:4], x[4:7], x[7:]
    q_dot = 0.5 * np.concatenate([[-q[1:] @ omega], q[0] * omega + cross(q[1:], omega)])
    h = momenta(delta).sum(axis=1)
    torque = -cross(omega, w.INERTIA * omega + h) - jacobian(delta) @ rates
    return np.concatenate([q_dot, torque / w.INERTIA, rates])


def gimbal_rates(x: Array, law: Law) -> Array:
    """Quaternion feedback, the law, and the common scaling to the rate limit."""
    q, omega, delta = x[:4], x[4:7], x[7:]
    sign = -1.0 if q[0] < 0 else 1.0
    torque = -(w.KP * sign * q[1:] + w.KW * omega)
    hdot = -torque - cross(omega, momenta(delta).sum(axis=1))
    rates = law(delta, hdot)
    return rates * min(1.0, w.RATE_MAX / np.max(np.abs(rates)))


def step(x: Array, law: Law) -> Array:
    """One control period: RK4 with the rates held, then normalise q."""
    rates = gimbal_rates(x, law)
    k1 = derivative(x, rates)
    k2 = derivative(x + 0.5 * w.DT * k1, rates)
    k3 = derivative(x + 0.5 * w.DT * k2, rates)
    k4 = derivative(x + w.DT * k3, rates)
    x = x + w.DT / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    x[:4] /= np.linalg.norm(x[:4])
    return x


def watch(law: str, q: Array, omega: Array, delta: Array, steps: int) -> tuple[Batch, Array]:
    """Final states of every run, and the least sigma_min(A) / h0 each of them met."""
    x = np.concatenate([q, omega, delta]).T.copy()
    nearest = np.full(len(x), np.inf)
    for i in range(len(x)):
        for _ in range(steps):
            sigma = np.linalg.svd(jacobian(x[i, 7:]), compute_uv=False)[-1] / w.H0
            nearest[i] = min(nearest[i], sigma)
            x[i] = step(x[i], LAW[law])
    return Batch(x[:, :4].T, x[:, 4:7].T, x[:, 7:].T), nearest


def run(law: str, q: Array, omega: Array, delta: Array, steps: int) -> Batch:
    """Final states of every run, one after the other."""
    x = np.concatenate([q, omega, delta]).T.copy()
    for i in range(len(x)):
        for _ in range(steps):
            x[i] = step(x[i], LAW[law])
    return Batch(x[:, :4].T, x[:, 4:7].T, x[:, 7:].T)

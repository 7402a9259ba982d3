"""The workload in Numba: the scalar loop of one run, @njit, over a batch of runs.

Written as a Numba user writes it: explicit small arrays, plain loops, one thread, LAPACK's SVD
through ``np.linalg.svd``. Raises ImportError where Numba is not installed.
"""

from __future__ import annotations

import numpy as np
import workload as w
from numba import njit
from workload import Array, Batch

S, T, J = w.SPIN_AXES.T.copy(), w.CROSS_AXES.T.copy(), w.INERTIA
H0, DT, KP, KW, RATE_MAX = w.H0, w.DT, w.KP, w.KW, w.RATE_MAX
LAMBDA0, SLOPE, GAIN = w.LAMBDA0, w.LAMBDA_SLOPE, w.GRADIENT_GAIN
CODE = {law: i for i, law in enumerate(w.LAWS)}


@njit(cache=True)
def kinematics(delta, h, a):
    """h_i in the columns of h, a_i in those of a."""
    for i in range(4):
        s, c = np.sin(delta[i]), np.cos(delta[i])
        for k in range(3):
            h[k, i] = H0 * (S[k, i] * c + T[k, i] * s)
            a[k, i] = H0 * (T[k, i] * c - S[k, i] * s)


@njit(cache=True)
def adjugate(m, g):
    """G = adj(m) of a symmetric 3 x 3 matrix; returns det(m)."""
    g[0, 0] = m[1, 1] * m[2, 2] - m[1, 2] * m[1, 2]
    g[1, 1] = m[0, 0] * m[2, 2] - m[0, 2] * m[0, 2]
    g[2, 2] = m[0, 0] * m[1, 1] - m[0, 1] * m[0, 1]
    g[0, 1] = g[1, 0] = m[0, 2] * m[1, 2] - m[0, 1] * m[2, 2]
    g[0, 2] = g[2, 0] = m[0, 1] * m[1, 2] - m[0, 2] * m[1, 1]
    g[1, 2] = g[2, 1] = m[0, 1] * m[0, 2] - m[1, 2] * m[0, 0]
    return m[0, 0] * g[0, 0] + m[0, 1] * g[0, 1] + m[0, 2] * g[0, 2]


@njit(cache=True)
def gram(a, m):
    """M = A A^T."""
    for k in range(3):
        for j in range(k, 3):
            m[k, j] = m[j, k] = (
                a[k, 0] * a[j, 0] + a[k, 1] * a[j, 1] + a[k, 2] * a[j, 2] + a[k, 3] * a[j, 3]
            )


@njit(cache=True)
def law_sr(a, h, hdot, with_gradient, rates, grad, m, g):
    """Singularity-robust inverse, with the gradient's null motion if asked."""
    gram(a, m)
    lam = LAMBDA0 * np.exp(-SLOPE * adjugate(m, g))
    b0, b1, b2 = hdot[0], hdot[1], hdot[2]
    for i in range(4):
        grad[i] = 0.0
        if with_gradient:
            for k in range(3):
                ga = g[k, 0] * a[0, i] + g[k, 1] * a[1, i] + g[k, 2] * a[2, i]
                grad[i] -= 2.0 * GAIN * h[k, i] * ga
            b0 -= a[0, i] * grad[i]
            b1 -= a[1, i] * grad[i]
            b2 -= a[2, i] * grad[i]
    for k in range(3):
        m[k, k] += lam
    inverse_det = 1.0 / adjugate(m, g)
    y0 = (g[0, 0] * b0 + g[0, 1] * b1 + g[0, 2] * b2) * inverse_det
    y1 = (g[1, 0] * b0 + g[1, 1] * b1 + g[1, 2] * b2) * inverse_det
    y2 = (g[2, 0] * b0 + g[2, 1] * b1 + g[2, 2] * b2) * inverse_det
    for i in range(4):
        rates[i] = a[0, i] * y0 + a[1, i] * y1 + a[2, i] * y2 + grad[i]


@njit(cache=True)
def law_svd(a, hdot, rates):
    """Singular direction avoidance on LAPACK's SVD."""
    u, s, vt = np.linalg.svd(a, False)
    alpha = LAMBDA0 * np.exp(-SLOPE * s[2] * s[2])
    rates[:] = 0.0
    for k in range(3):
        gain = s[k] / (s[k] * s[k] + alpha) if k == 2 else 1.0 / s[k]
        gain *= u[0, k] * hdot[0] + u[1, k] * hdot[1] + u[2, k] * hdot[2]
        for i in range(4):
            rates[i] += gain * vt[k, i]


@njit(cache=True)
def derivative(x, h, a, rates, k):
    """K = d/dt (q, omega, delta); h and a at x's gimbal angles."""
    w0, w1, w2 = x[4], x[5], x[6]
    k[0] = 0.5 * (-x[1] * w0 - x[2] * w1 - x[3] * w2)
    k[1] = 0.5 * (x[0] * w0 + x[2] * w2 - x[3] * w1)
    k[2] = 0.5 * (x[0] * w1 + x[3] * w0 - x[1] * w2)
    k[3] = 0.5 * (x[0] * w2 + x[1] * w1 - x[2] * w0)
    l0, l1, l2 = J[0] * w0, J[1] * w1, J[2] * w2
    u0 = u1 = u2 = 0.0
    for i in range(4):
        l0, l1, l2 = l0 + h[0, i], l1 + h[1, i], l2 + h[2, i]
        u0 += a[0, i] * rates[i]
        u1 += a[1, i] * rates[i]
        u2 += a[2, i] * rates[i]
        k[7 + i] = rates[i]
    k[4] = (l1 * w2 - l2 * w1 - u0) / J[0]
    k[5] = (l2 * w0 - l0 * w2 - u1) / J[1]
    k[6] = (l0 * w1 - l1 * w0 - u2) / J[2]


@njit(cache=True)
def command(x, h, a, law, rates, hdot, grad, m, g):
    """Quaternion feedback, law, common scaling to the rate limit."""
    kp = -KP if x[0] < 0.0 else KP
    h0, h1, h2 = h[0].sum(), h[1].sum(), h[2].sum()
    hdot[0] = kp * x[1] + KW * x[4] - (x[5] * h2 - x[6] * h1)
    hdot[1] = kp * x[2] + KW * x[5] - (x[6] * h0 - x[4] * h2)
    hdot[2] = kp * x[3] + KW * x[6] - (x[4] * h1 - x[5] * h0)
    if law == 2:
        law_svd(a, hdot, rates)
    else:
        law_sr(a, h, hdot, law == 1, rates, grad, m, g)
    peak = 0.0
    for i in range(4):
        peak = max(peak, abs(rates[i]))
    if peak > RATE_MAX:
        for i in range(4):
            rates[i] *= RATE_MAX / peak


@njit(cache=True)
def run_one(x, law, steps):
    """``steps`` steps of one run, in place."""
    h, a, k = np.empty((3, 4)), np.empty((3, 4)), np.empty(11)
    y, total, rates, grad = np.empty(11), np.empty(11), np.empty(4), np.empty(4)
    hdot, m, g = np.empty(3), np.empty((3, 3)), np.empty((3, 3))
    for _ in range(steps):
        kinematics(x[7:], h, a)
        command(x, h, a, law, rates, hdot, grad, m, g)
        y[:] = x
        total[:] = x
        for stage in range(4):
            if stage == 1 or stage == 3:  # stages 2 and 3 have the same gimbal angles
                kinematics(y[7:], h, a)
            derivative(y, h, a, rates, k)
            weight = DT / 6.0 if stage == 0 or stage == 3 else DT / 3.0
            ahead = DT if stage == 2 else 0.5 * DT
            for i in range(11):
                total[i] += weight * k[i]
                y[i] = x[i] + ahead * k[i]
        norm = np.sqrt(total[0] ** 2 + total[1] ** 2 + total[2] ** 2 + total[3] ** 2)
        x[:] = total
        for i in range(4):
            x[i] = total[i] / norm


@njit(cache=True)
def run_batch(states, law, steps):
    """All runs, one after the other."""
    for r in range(states.shape[0]):
        run_one(states[r], law, steps)


def run(law: str, q: Array, omega: Array, delta: Array, steps: int) -> Batch:
    """Final states of every run."""
    x = np.ascontiguousarray(np.concatenate([q, omega, delta]).T)
    run_batch(x, CODE[law], steps)
    return Batch(x[:, :4].T, x[:, 4:7].T, x[:, 7:].T)

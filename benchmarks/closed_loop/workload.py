"""The workload all implementations share: constants and initial states.

Four-CMG pyramid (skew 54.73 deg, h0 = 1 N m s) on a rigid body J = diag(24, 20, 16) kg m^2,
quaternion feedback, rates scaled to a limit and held over dt, RK4 on (q, omega, delta):

    q_dot = 1/2 q * [0, omega]
    J omega_dot = -omega x (J omega + h(delta)) - A(delta) delta_dot
    Tc = -(kp sign(q0) q_vec + kw omega),  hdot = -Tc - omega x h
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LAWS = ("sr", "sr+gradient", "svd")
SKEW = np.radians(54.73)
SIN_B, COS_B = np.sin(SKEW), np.cos(SKEW)
H0 = 1.0
GIMBAL_AXES = np.array(
    [[SIN_B, 0, COS_B], [0, SIN_B, COS_B], [-SIN_B, 0, COS_B], [0, -SIN_B, COS_B]]
)
SPIN_AXES = np.array([[0.0, 1, 0], [-1, 0, 0], [0, -1, 0], [1, 0, 0]])
CROSS_AXES = np.cross(GIMBAL_AXES, SPIN_AXES)
INERTIA = np.array([24.0, 20.0, 16.0])
DT = 0.01
KP, KW = 4.0, 12.0
RATE_MAX = 1.5
LAMBDA0, LAMBDA_SLOPE = 0.01, 10.0
GRADIENT_GAIN = 0.5
SEED = 20240501


class Batch(NamedTuple):
    """States of n runs, one column a run."""

    q: Array  # (4, n) q_BN, scalar first
    omega: Array  # (3, n) rad/s
    delta: Array  # (4, n) rad


def initial_states(n: int, seed: int = SEED) -> Batch:
    """Rest-to-rest slews of up to 60 deg about random axes from random gimbal angles."""
    rng = np.random.default_rng(seed)
    axis = rng.normal(size=(n, 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    half = 0.5 * np.radians(rng.uniform(5.0, 60.0, size=n))
    sign = rng.choice([-1.0, 1.0], size=n)
    delta = rng.uniform(-0.5, 0.5, size=(n, 4))
    q = sign * np.vstack([np.cos(half), np.sin(half) * axis.T])
    return Batch(q, np.zeros((3, n)), np.ascontiguousarray(delta.T))

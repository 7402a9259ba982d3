"""Attitude as scalar-first unit quaternions, on floats and symbols alike.

q_BN turns N into B: v_B = matrix(q_BN) v_N, and q_dot = 1/2 q * [0, omega_BN_B].
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion import linalg, ops

Quaternion = Any  # four floats or symbols, scalar first


def multiply(p: Quaternion, q: Quaternion) -> Quaternion:
    """Return the Hamilton product p * q."""
    a, b, c, d = p
    w, x, y, z = q
    return np.array(
        [
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y + c * w + d * x - b * z,
            a * z + d * w + b * y - c * x,
        ]
    )


def conjugate(q: Quaternion) -> Quaternion:
    """Return (q0, -q1, -q2, -q3), the inverse of a unit quaternion."""
    return np.array([q[0], -q[1], -q[2], -q[3]])


def normalised(q: Quaternion) -> Quaternion:
    """Return q / |q|."""
    return q * ops.rsqrt(q @ q)


def doubled_rate(q: Quaternion, omega: Any) -> Quaternion:
    """Return 2 q_dot = q * [0, omega]; the half goes into the step size."""
    x, y, z = omega
    return np.array(
        [
            -q[1] * x - q[2] * y - q[3] * z,
            q[0] * x + q[2] * z - q[3] * y,
            q[0] * y - q[1] * z + q[3] * x,
            q[0] * z + q[1] * y - q[2] * x,
        ]
    )


def shortest(q: Quaternion) -> Quaternion:
    """Return q or -q, the same attitude, with a scalar part that is not negative."""
    return q * ops.where(ops.less(q[0], 0.0), -1.0, 1.0)


def matrix(q: Quaternion) -> Any:
    """Return the direction cosine matrix C_BN of a unit quaternion q_BN, (3, 3)."""
    w, x, y, z = q
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)],
            [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)],
            [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def angle(q: Quaternion) -> Any:
    """Return the rotation angle of a unit quaternion in [0, pi]; q and -q are the same."""
    return 2.0 * ops.atan2(linalg.norm(q[1:]), ops.absolute(q[0]))


def from_euler_321(angles: Any) -> np.ndarray:
    """Return q_BN of yaw, pitch and roll [rad], turned in this order about z, y, x."""
    yaw, pitch, roll = (0.5 * np.asarray(a, float) for a in angles)
    about_z = np.array([np.cos(yaw), 0.0, 0.0, np.sin(yaw)])
    about_y = np.array([np.cos(pitch), 0.0, np.sin(pitch), 0.0])
    about_x = np.array([np.cos(roll), np.sin(roll), 0.0, 0.0])
    product: np.ndarray = multiply(multiply(about_z, about_y), about_x)
    return product


def euler_321(q: Quaternion) -> Any:
    """Return yaw, pitch and roll [rad] of a unit quaternion, pitch within +-pi/2."""
    w, x, y, z = q
    sine = ops.clip(2.0 * (w * y - z * x), -1.0, 1.0)
    return np.array(
        [
            ops.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
            ops.atan2(sine, ops.sqrt(1.0 - sine * sine)),
            ops.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
        ]
    )

"""What a slew asks of an array: its momentum and torque over time.

With the total momentum H, at first the bias b, of spacecraft and array, and a torque T from
outside, both in B:

    h    = H - J omega,                      H_dot = T - omega x H
    hdot = T - omega x H - J alpha

Without bias and torque h = -J omega and hdot = -J alpha: the body's own omega x J omega asks
nothing of an array that starts without momentum.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nullmotion.sizing.profile import RateProfile

_SAMPLES = 401


class Demand(NamedTuple):
    """What is asked of the array over time, in B; slews first.

    Attributes:
        t: Times [s], (samples,).
        momentum: h [N m s], (slews, samples, 3).
        torque: hdot [N m], (slews, samples, 3).
    """

    t: np.ndarray
    momentum: np.ndarray
    torque: np.ndarray

    @property
    def momenta(self) -> np.ndarray:
        """|h| [N m s], (slews, samples)."""
        return np.linalg.norm(self.momentum, axis=2)

    @property
    def torques(self) -> np.ndarray:
        """|hdot| [N m], (slews, samples)."""
        return np.linalg.norm(self.torque, axis=2)


def demand(
    profile: RateProfile,
    inertia: np.ndarray,
    axes: np.ndarray,
    bias: np.ndarray,
    torque: np.ndarray,
) -> Demand:
    """Return what slews ask of the array.

    Args:
        profile: Rate about each axis.
        inertia: J in B [kg m^2], (3, 3).
        axes: Unit vectors in B, (slews, 3).
        bias: Momentum of the array before each slew [N m s], (slews, 3).
        torque: Constant torque from outside in B [N m], (3,).
    """
    t = np.linspace(0.0, profile.time, _SAMPLES)
    angle, rate, acceleration = profile.at(t)
    omega, alpha = (axes[:, None, :] * v[None, :, None] for v in (rate, acceleration))
    given = _turned(axes, angle, np.broadcast_to(torque, (len(axes), 3)), -1.0)
    steps = 0.5 * (given[:, 1:] + given[:, :-1]) * np.diff(t)[None, :, None]
    held = np.concatenate([np.zeros((len(axes), 1, 3)), np.cumsum(steps, axis=1)], axis=1)
    total = _turned(axes, angle, bias[:, None, :] + held, 1.0)
    h = total - omega @ inertia
    return Demand(t, h, torque - np.cross(omega, total) - alpha @ inertia)


def _turned(axes: np.ndarray, angle: np.ndarray, vectors: np.ndarray, sign: float) -> np.ndarray:
    """Return vectors of N in B (sign 1) or of B in N (-1) as the body turns, (slews, samples, 3).

    Rodrigues: C v = v cos(angle) - (e x v) sin(angle) + e (e . v) (1 - cos(angle)).
    """
    v = vectors if vectors.ndim == 3 else vectors[:, None, :]
    e = axes[:, None, :]
    c, s = np.cos(angle)[None, :, None], np.sin(angle)[None, :, None]
    along = (e * v).sum(axis=2, keepdims=True) * e
    return v * c - sign * np.cross(e, v) * s + along * (1.0 - c)

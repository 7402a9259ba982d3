"""The rate profile of a slew: from rest to rest, with eased ramps and a coast between them.

In units of the slew's angle and time, x = t / T, with ramps of length r = (1 - coast) / 2
and edges of length b = smoothing r / 2:

    peak rate          w_max = angle / (T (1 - r))
    peak acceleration  a_max = w_max / (T (r - b))

The acceleration rises over an edge, holds, and falls over an edge (a trapezoid in time); the
rate is its integral. Without smoothing the rate is a trapezoid; with smoothing = 1 the
acceleration is a triangle.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class RateProfile:
    """A slew about one axis from rest to rest.

    Args:
        angle: Angle turned [rad].
        time: From the start to rest [s].
        coast: Share of the time at constant rate, from 0 to below 1.
        smoothing: Share of each ramp in which its acceleration changes, from 0 to 1.
    """

    angle: float
    time: float
    coast: float = 0.3
    smoothing: float = 0.5

    @property
    def _ramp(self) -> float:
        return 0.5 * (1.0 - self.coast)

    @property
    def peak_rate(self) -> float:
        """Greatest rate [rad/s]."""
        return self.angle / (self.time * (1.0 - self._ramp))

    @property
    def peak_acceleration(self) -> float:
        """Greatest acceleration [rad/s^2]."""
        return self.peak_rate / (self.time * self._ramp * (1.0 - 0.5 * self.smoothing))

    def at(self, times: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return angle [rad], rate [rad/s] and acceleration [rad/s^2] at times [s]."""
        x = np.clip(np.asarray(times, float) / self.time, 0.0, 1.0)
        r = self._ramp
        up, down = _ramp(x / r, self.smoothing), _ramp((x - (1.0 - r)) / r, self.smoothing)
        angle = r * (up[0] - down[0]) + np.maximum(x - r, 0.0)
        scale = self.angle / (1.0 - r)
        return (
            scale * angle,
            scale / self.time * (up[1] - down[1]),
            scale / (r * self.time**2) * (up[2] - down[2]),
        )

    def reference(self, times: Any, axis: Any = (1.0, 0.0, 0.0)) -> np.ndarray:
        """Return a reference attitude that starts at the identity, (len(times), 10).

        Args:
            times: Time of each row [s].
            axis: Unit vector of the slew, the same in N and in the reference's frame R.

        Returns:
            Rows of q_RN, omega_RN_R [rad/s] and alpha_RN_R [rad/s^2], as the `tracking`
            controller follows them.
        """
        angle, rate, acceleration = (part[:, None] for part in self.at(times))
        e = np.asarray(axis, float)
        q = [np.cos(0.5 * angle), np.sin(0.5 * angle) * e]
        return np.concatenate([*q, rate * e, acceleration * e], axis=1)


def _ramp(u: np.ndarray, smoothing: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the integral, the value and the slope of a ramp from 0 to 1 over u in [0, 1].

    Beyond the ramp the integral stays: what coasts there is added by the caller.
    """
    inside, u, b = (u > 0) & (u < 1), np.clip(u, 0.0, 1.0), 0.5 * smoothing
    if b == 0:
        return 0.5 * u * u, u, np.where(inside, 1.0, 0.0)
    early, late = np.minimum(u, b), np.maximum(u - (1.0 - b), 0.0)
    flat, scale = u - early, 1.0 / (b * (1.0 - b))
    area = early**3 / 6 + 0.5 * early * flat * (early + flat) - late**3 / 6
    value = 0.5 * early * early + b * flat - 0.5 * late * late
    return scale * area, scale * value, scale * np.where(inside, early - late, 0.0)

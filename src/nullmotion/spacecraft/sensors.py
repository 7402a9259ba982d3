"""Noise of gyro and star tracker, drawn inside the run from a seed."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from nullmotion.errors import InputError
from nullmotion.spacecraft.body import checked_vector


@dataclass(frozen=True, eq=False)
class Sensors:
    """Errors of the measured body rate and attitude, drawn anew at each sample of the controller.

        omega_measured = omega + gyro_bias + gyro_noise n_1
        q_measured     = q * [1, 1/2 attitude_noise n_2] (normalised)

    Args:
        gyro_noise: Standard deviation of a rate sample, each axis [rad/s].
        gyro_bias: Constant error in B [rad/s], (3,).
        attitude_noise: Standard deviation of a small rotation about each axis [rad].
        seed: Whole number that the noise comes from.
    """

    gyro_noise: Any = 0.0
    gyro_bias: Any = field(default_factory=lambda: np.zeros(3))
    attitude_noise: Any = 0.0
    seed: int = 0

    def __post_init__(self) -> None:
        """Check shapes and signs."""
        for key in ("gyro_noise", "attitude_noise"):
            value = float(getattr(self, key))
            if not (np.isfinite(value) and value >= 0):
                raise InputError(f"sensors.{key}", value, "finite and from 0")
            object.__setattr__(self, key, value)
        bias = checked_vector("sensors.gyro_bias", self.gyro_bias)
        object.__setattr__(self, "gyro_bias", bias)
        whole = isinstance(self.seed, (int, np.integer)) and not isinstance(self.seed, bool)
        if not whole or self.seed < 0:
            raise InputError("sensors.seed", self.seed, "a whole number from 0")

    @property
    def noisy(self) -> bool:
        """Whether anything is drawn."""
        return any(
            not isinstance(v, float) or v > 0 for v in (self.gyro_noise, self.attitude_noise)
        )

"""What gimbals can do over a sample: rates, changes of the rates, angles."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from nullmotion.array.model import CmgArray


@lru_cache(maxsize=64)
def _has_angles(array: CmgArray) -> bool:
    return array.has_angle_limits


@dataclass(frozen=True, eq=False)
class Limits:
    """Bounds on the rates x of the next samples, each (n,), infinite where there is none.

        |x_i| <= rate,   |x_i - x_i before| <= change,   low <= gamma_i + T sum x_i <= high

    Attributes:
        rate: Largest gimbal rate [rad/s].
        change: Largest change of the rate from one sample to the next [rad/s].
        angle: Lowest and highest gimbal angle [rad], (2, n).
        has_angles: Whether any of them is finite.
    """

    rate: np.ndarray
    change: float
    angle: np.ndarray
    has_angles: bool

    @classmethod
    def of(cls, array: CmgArray, acceleration: float | None, period: float) -> Limits:
        """Return an array's limits; the acceleration [rad/s^2] has none if None."""
        change = np.inf if acceleration is None else acceleration * period
        return cls(array.rate_limit, change, array.angle_limits.T, _has_angles(array))

    def held(self, rates: Any, before: Any, delta: Any, period: float) -> np.ndarray:
        """Return rates within the limits of this sample, each gimbal by itself.

        Limits that contradict each other yield in this order: angle, rate, change.
        """
        x = np.clip(rates, before - self.change, before + self.change)
        x = np.clip(x, -self.rate, self.rate)
        low, high = (self.angle - delta) / period
        return np.asarray(np.clip(x, np.minimum(low, 0.0), np.maximum(high, 0.0)))

"""Mechanical power of the gimbal motors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import ops
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class MotorPower(Metric):
    """sum_i |T_i delta_dot_i|: what a motor takes back is not counted against it."""

    name: ClassVar[str] = "motor_power_W"
    title: ClassVar[str] = "gimbal motor power"
    unit: ClassVar[str] = "W"
    reductions: ClassVar[tuple[Reduction, ...]] = ("max", "mean")
    needs_rates: ClassVar[bool] = True

    def of(self, sample: Sample) -> Any:
        """Return the power of all motors [W]."""
        return ops.absolute(sample.motor_torque * sample.rates).sum()

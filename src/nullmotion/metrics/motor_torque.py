"""Torque of the gimbal motors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import ops
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class MotorTorque(Metric):
    """max_i |T_i|, T_i = I_i delta_ddot_i - omega . c_i (c_i: column of A).

    The second part is the gyroscopic torque of the wheel in a body that turns, at most the
    wheel's momentum times the body rate across its gimbal axis; it sizes the motor.
    """

    name: ClassVar[str] = "motor_torque_Nm"
    title: ClassVar[str] = "gimbal motor torque"
    unit: ClassVar[str] = "N m"
    reductions: ClassVar[tuple[Reduction, ...]] = ("max",)
    needs_rates: ClassVar[bool] = True

    def of(self, sample: Sample) -> Any:
        """Return the greatest motor torque [N m]."""
        return ops.amax(ops.absolute(sample.motor_torque))

"""Torque that changes the wheels' speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import ops
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class WheelTorque(Metric):
    """max_i |I_i Omega_dot_i|: what the wheels' acceleration takes of their motors."""

    name: ClassVar[str] = "wheel_torque_Nm"
    title: ClassVar[str] = "wheel torque"
    unit: ClassVar[str] = "N m"
    reductions: ClassVar[tuple[Reduction, ...]] = ("max",)
    needs_rates: ClassVar[bool] = True
    needs_wheels: ClassVar[bool] = True

    def of(self, sample: Sample) -> Any:
        """Return the greatest torque on a wheel [N m]."""
        return ops.amax(ops.absolute(sample.array.flywheels.inertia * sample.wheel_acceleration))

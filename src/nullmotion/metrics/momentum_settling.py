"""When the wheels hold the momentum that they were designed for, for good."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import ops
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class MomentumSettling(Metric):
    """First sample after which |mu| stays within the tolerance, as a share of |I Omega_d|.

        mu = I (Omega_d - Omega), one component for each wheel

    At a sample within it: 0. At one outside: the time of the next sample. The greatest of
    these is the settling time; one beyond the last sample of a run means not settled.

    Args:
        tolerance: |mu| / |I Omega_d| that counts as settled.
    """

    name: ClassVar[str] = "momentum_settling_s"
    title: ClassVar[str] = "settling time of the wheels' momentum"
    unit: ClassVar[str] = "s"
    citation: ClassVar[str] = "Kim, Leve, Fitz-Coy & Dixon, J. Guid. Control Dyn. 35 (2012), Eq 42"
    reductions: ClassVar[tuple[Reduction, ...]] = ("latest",)
    needs_wheels: ClassVar[bool] = True

    tolerance: float = 0.02

    def of(self, sample: Sample) -> Any:
        """Return the time from which this sample lets the momentum be settled [s]."""
        inertia, aim = sample.array.flywheels.inertia, sample.design_speed
        off = ops.where(ops.less(0.0, aim), inertia * (aim - sample.wheel_speed), 0.0)
        full = inertia * aim
        outside = ops.less(self.tolerance**2 * (full @ full), off @ off)
        return ops.where(outside, sample.t + sample.dt, 0.0)

"""When every wheel is near the speed that the array was designed for, for good."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import ops
from nullmotion.metrics.base import Metric, Reduction, Sample
from nullmotion.metrics.wheel_speed_error import relative_errors


@dataclass(frozen=True)
class WheelSettling(Metric):
    """First sample after which max_i |Omega_i / Omega_d,i - 1| stays within the tolerance.

    At a sample within it: 0. At one outside: the time of the next sample. The greatest of
    these is the settling time; one beyond the last sample of a run means not settled.

    Args:
        tolerance: Relative error that counts as settled.
    """

    name: ClassVar[str] = "wheel_settling_s"
    title: ClassVar[str] = "settling time of the wheels"
    unit: ClassVar[str] = "s"
    citation: ClassVar[str] = (
        "Kim, Leve, Fitz-Coy & Dixon, J. Guid. Control Dyn. 35 (2012), Sec. VI"
    )
    reductions: ClassVar[tuple[Reduction, ...]] = ("latest",)
    needs_wheels: ClassVar[bool] = True

    tolerance: float = 0.02

    def of(self, sample: Sample) -> Any:
        """Return the time from which this sample lets the wheels be settled [s]."""
        outside = ops.less(self.tolerance, ops.amax(relative_errors(sample)))
        return ops.where(outside, sample.t + sample.dt, 0.0)

"""When the pointing error is within its tolerance for good."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import ops, rotation
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class SettlingTime(Metric):
    """First sample after which the pointing error stays within the tolerance.

    At a sample within it: 0. At one outside: the time of the next sample. The greatest of
    these is the settling time; one beyond the last sample of a run means not settled.

    Args:
        tolerance: Pointing error that counts as settled [rad].
    """

    name: ClassVar[str] = "settling_time_s"
    title: ClassVar[str] = "settling time"
    unit: ClassVar[str] = "s"
    reductions: ClassVar[tuple[Reduction, ...]] = ("latest",)
    needs_body: ClassVar[bool] = True

    tolerance: float = 1.7453292519943296e-3

    def of(self, sample: Sample) -> Any:
        """Return the time from which this sample lets the run be settled [s]."""
        outside = ops.less(self.tolerance, rotation.angle(sample.q_BR))
        return ops.where(outside, sample.t + sample.dt, 0.0)

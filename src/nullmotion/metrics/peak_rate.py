"""Greatest gimbal rate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import ops
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class PeakRate(Metric):
    """max_i |delta_dot_i|."""

    name: ClassVar[str] = "peak_rate_rad_s"
    title: ClassVar[str] = "peak gimbal rate"
    unit: ClassVar[str] = "rad/s"
    reductions: ClassVar[tuple[Reduction, ...]] = ("max",)
    needs_rates: ClassVar[bool] = True

    def of(self, sample: Sample) -> Any:
        """Return the greatest gimbal rate [rad/s]."""
        return ops.amax(ops.absolute(sample.rates))

"""Step of the gimbal rates from one sample to the next."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import ops
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class RateStep(Metric):
    """max_i |delta_dot_i(now) - delta_dot_i(step before)|; 0 in the first step."""

    name: ClassVar[str] = "rate_step_rad_s"
    title: ClassVar[str] = "gimbal rate step"
    unit: ClassVar[str] = "rad/s"
    reductions: ClassVar[tuple[Reduction, ...]] = ("max",)
    needs_rates: ClassVar[bool] = True

    def of(self, sample: Sample) -> Any:
        """Return the greatest change of a gimbal rate [rad/s]."""
        return ops.amax(ops.absolute(sample.rates - sample.previous_rates))

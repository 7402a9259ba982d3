"""Time for which the law asks for more rate than there is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import ops
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class RateSaturated(Metric):
    """Time for which a rate asked by the law exceeds the array's rate limit."""

    name: ClassVar[str] = "rate_saturated_s"
    title: ClassVar[str] = "rate-saturated time"
    unit: ClassVar[str] = "s"
    reductions: ClassVar[tuple[Reduction, ...]] = ("total",)
    needs_rates: ClassVar[bool] = True

    def of(self, sample: Sample) -> Any:
        """Return 1 where a gimbal is asked for more than its limit, else 0."""
        excess = ops.amax(ops.absolute(sample.asked) - sample.array.rate_limit)
        return ops.where(ops.less(0.0, excess), 1.0, 0.0)

"""How far the gimbals turn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import ops
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class GimbalTravel(Metric):
    """Integral of sum_i |delta_dot_i|: the way of all gimbals together."""

    name: ClassVar[str] = "gimbal_travel_rad"
    title: ClassVar[str] = "gimbal travel"
    unit: ClassVar[str] = "rad"
    reductions: ClassVar[tuple[Reduction, ...]] = ("total",)
    needs_rates: ClassVar[bool] = True

    def of(self, sample: Sample) -> Any:
        """Return the sum of the gimbals' rates [rad/s]."""
        return ops.absolute(sample.rates).sum()

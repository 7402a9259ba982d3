"""How far the wheels are from the speeds that the array was designed for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import ops
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class WheelSpeedError(Metric):
    """max_i |Omega_i / Omega_d,i - 1| over the wheels that have a design speed: 1 at rest."""

    name: ClassVar[str] = "wheel_speed_error"
    title: ClassVar[str] = "wheel speed error"
    reductions: ClassVar[tuple[Reduction, ...]] = ("final", "max")
    needs_wheels: ClassVar[bool] = True

    def of(self, sample: Sample) -> Any:
        """Return the greatest relative error of a wheel's speed."""
        return ops.amax(relative_errors(sample))


def relative_errors(sample: Sample) -> Any:
    """Return |Omega_i / Omega_d,i - 1|, (n,); 0 where a wheel has no design speed."""
    aim = sample.design_speed
    counts = ops.less(0.0, aim)
    off = ops.absolute(sample.wheel_speed - aim) / ops.where(counts, aim, 1.0)
    return ops.where(counts, off, 0.0)

"""Torque error along the commanded direction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import ops
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class AlongAxisTorque(Metric):
    """|A delta_dot . e - |hdot|| / |hdot|, e = hdot / |hdot|; 0 without a command."""

    name: ClassVar[str] = "along_axis_torque_fraction"
    title: ClassVar[str] = "along-axis torque error"
    citation: ClassVar[str] = "Mao et al., IEEE Access 7 (2019), Sec. V"
    reductions: ClassVar[tuple[Reduction, ...]] = ("max", "rms")
    needs_rates: ClassVar[bool] = True

    def of(self, sample: Sample) -> Any:
        """Return the along-axis torque error as a fraction of the command."""
        commanded = ops.less(0.0, sample.command)
        error = ops.absolute(sample.torque @ sample.direction - sample.command)
        return ops.where(commanded, error / ops.where(commanded, sample.command, 1.0), 0.0)

"""Torque across the commanded direction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import linalg, ops
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class OffAxisTorque(Metric):
    """|A delta_dot - (A delta_dot . e) e| / |hdot|, e = hdot / |hdot|; 0 without a command."""

    name: ClassVar[str] = "off_axis_torque_fraction"
    title: ClassVar[str] = "off-axis torque error"
    citation: ClassVar[str] = "Mao et al., IEEE Access 7 (2019), Sec. V"
    reductions: ClassVar[tuple[Reduction, ...]] = ("max", "rms")
    needs_rates: ClassVar[bool] = True

    def of(self, sample: Sample) -> Any:
        """Return the off-axis torque as a fraction of the command."""
        e, commanded = sample.direction, ops.less(0.0, sample.command)
        across = sample.torque - (sample.torque @ e) * e
        return ops.where(
            commanded, linalg.norm(across) / ops.where(commanded, sample.command, 1.0), 0.0
        )

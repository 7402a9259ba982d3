"""Error of the array's momentum against the integrated command."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import linalg
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class MomentumError(Metric):
    """|h(delta) - h_wanted|, where h_wanted = h(0) + integral of hdot."""

    name: ClassVar[str] = "momentum_error_Nms"
    title: ClassVar[str] = "momentum error"
    unit: ClassVar[str] = "N m s"
    reductions: ClassVar[tuple[Reduction, ...]] = ("max", "final")

    def of(self, sample: Sample) -> Any:
        """Return the length of the momentum error [N m s]."""
        return linalg.norm(sample.momentum - sample.momentum_wanted)

"""State of the array's momentum: what is left along the command, plus sigma_min."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion.array.momentum_state import sse
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class MomentumState(Metric):
    """sse = rrss + sigma_min(A / mean momentum): near 0 only at saturation."""

    name: ClassVar[str] = "momentum_state"
    title: ClassVar[str] = "momentum state sse"
    citation: ClassVar[str] = "Mao et al., IEEE Access 7 (2019), Eq 29"
    reductions: ClassVar[tuple[Reduction, ...]] = ("min", "final")

    def of(self, sample: Sample) -> Any:
        """Return sse along the commanded direction."""
        return sse(sample.working, sample.delta, sample.hdot, sample.singular_values[-1])

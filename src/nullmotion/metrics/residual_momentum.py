"""Residual angular momentum of the array along the command."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion.array.momentum_state import rrss
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class ResidualMomentum(Metric):
    """rrss = sum of the CMGs' effective residual angular momenta: 0 at saturation."""

    name: ClassVar[str] = "residual_momentum"
    title: ClassVar[str] = "residual momentum rrss"
    citation: ClassVar[str] = "Mao et al., IEEE Access 7 (2019), Eq 28"
    reductions: ClassVar[tuple[Reduction, ...]] = ("min", "final")

    def of(self, sample: Sample) -> Any:
        """Return rrss along the commanded direction."""
        return rrss(sample.working, sample.delta, sample.hdot)

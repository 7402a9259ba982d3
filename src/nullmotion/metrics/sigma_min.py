"""Least singular value of the normalised Jacobian."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class SigmaMin(Metric):
    """sigma_min(A / mean momentum): 0 at a singular state."""

    name: ClassVar[str] = "sigma_min"
    title: ClassVar[str] = "least singular value"
    citation: ClassVar[str] = "Mao et al., IEEE Access 7 (2019), Sec. III-A"
    reductions: ClassVar[tuple[Reduction, ...]] = ("min", "final")

    def of(self, sample: Sample) -> Any:
        """Return the least singular value."""
        return sample.singular_values[-1]

"""Condition number of the Jacobian."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import ops
from nullmotion.metrics.base import Metric, Reduction, Sample

_LEAST = 1e-16  # divisor at a singular state


@dataclass(frozen=True)
class ConditionNumber(Metric):
    """sigma_1 / max(sigma_m, 1e-16) of A / mean momentum: 1 at best."""

    name: ClassVar[str] = "condition_number"
    title: ClassVar[str] = "condition number"
    citation: ClassVar[str] = "Golub and Van Loan, Matrix Computations, Sec. 2.6"
    reductions: ClassVar[tuple[Reduction, ...]] = ("max", "final")

    def of(self, sample: Sample) -> Any:
        """Return the ratio of the greatest to the least singular value."""
        sigma = sample.singular_values
        return sigma[0] / ops.maximum(sigma[-1], _LEAST)

"""Manipulability: the root of det(A A^T) of the normalised Jacobian."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class SqrtDetAAT(Metric):
    """sqrt(det(A A^T)) = sigma_1 ... sigma_m of A / mean momentum: 0 at a singular state."""

    name: ClassVar[str] = "sqrt_det_AAT"
    title: ClassVar[str] = "manipulability sqrt(det(A A^T))"
    citation: ClassVar[str] = "Yoshikawa, Int. J. Robotics Research 4 (1985)"
    reductions: ClassVar[tuple[Reduction, ...]] = ("min", "final")

    def of(self, sample: Sample) -> Any:
        """Return the product of the singular values (near zero more exact than the determinant)."""
        product = sample.singular_values[0]
        for sigma in sample.singular_values[1:]:
            product = product * sigma
        return product

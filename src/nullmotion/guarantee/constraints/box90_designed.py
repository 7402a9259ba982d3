"""Box-90: a bias designed for what it guarantees."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.guarantee._bias import Term, checked_terms, even_terms
from nullmotion.guarantee._two_planes import TwoPlanes

_B = float(4 * np.sqrt(6.0) / 3)


@dataclass(frozen=True)
class Box90Designed(TwoPlanes):
    """Bias of the two planes by an even polynomial in the momentum.

        Psi = sum c X^i Y^j Z^k,    X = (h_x/2)^2,  Y = (h_y/2)^2,  Z = (h_z/2)^2

    The coefficients come from `nullmotion design constraint`.

    Args:
        terms: Rows (i, j, k, c).
    """

    name: ClassVar[str] = "box90-designed"
    full_name: ClassVar[str] = "Box-90, designed bias"
    citation: ClassVar[str] = "nullmotion design constraint"
    layout: ClassVar[str] = "box90"

    terms: tuple[Term, ...] = (
        (0, 0, 0, _B),
        (1, 0, 0, 2.0 - _B),
        (0, 1, 0, -_B),
        (0, 0, 1, -_B),
        (1, 1, 0, _B),
        (1, 0, 1, _B),
        (0, 1, 1, _B),
    )

    def __post_init__(self) -> None:
        """Check the coefficients."""
        checked_terms(self, "terms")

    def bias(self, h: Any) -> tuple[Any, Any]:
        """Return Psi and its gradient."""
        return even_terms(self.terms, 2.0, h)

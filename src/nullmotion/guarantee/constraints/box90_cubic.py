"""Box-90: the published cubic bias."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.guarantee._bias import checked_coefficients, even_polynomial
from nullmotion.guarantee._two_planes import TwoPlanes
from nullmotion.law import check_parameters


@dataclass(frozen=True)
class Box90Cubic(TwoPlanes):
    """Bias of the two planes by a product of parabolas and a polynomial in h_x.

        Psi = b (1 - (h_x/2)^2) (1 - (h_y/2)^2) (1 - (h_z/2)^2) + P(h_x)          (Eq 51)
        P   = sum_k p_k h_x^(2k),   p = 47/60, -11/24, 1/6, -67/3840

    With b = 4 sqrt 6/3 TC is 4/3 at h = 0, the greatest of any linear right inverse.

    Args:
        b: Bias at no momentum.
        polynomial: Coefficients p_1, p_2, ... of P.
    """

    name: ClassVar[str] = "box90-cubic"
    full_name: ClassVar[str] = "Box-90, cubic bias"
    citation: ClassVar[str] = "Elliott, dissertation (2019), Eqs 50-51"
    layout: ClassVar[str] = "box90"

    b: float = float(4 * np.sqrt(6.0) / 3)
    polynomial: tuple[float, ...] = (47 / 60, -11 / 24, 1 / 6, -67 / 3840)

    def __post_init__(self) -> None:
        """Check the coefficients."""
        check_parameters(self, positive=("b",), kind="constraint")
        checked_coefficients(self, "polynomial")

    def bias(self, h: Any) -> tuple[Any, Any]:
        """Return Psi and its gradient."""
        fx, fy, fz = (1.0 - 0.25 * (c * c) for c in h)
        value, slope = even_polynomial(self.polynomial, h[0])
        gradient = [
            slope - 0.5 * self.b * h[0] * (fy * fz),
            -0.5 * self.b * h[1] * (fx * fz),
            -0.5 * self.b * h[2] * (fx * fy),
        ]
        return self.b * (fx * (fy * fz)) + value, np.array(gradient)

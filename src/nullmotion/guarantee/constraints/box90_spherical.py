"""Box-90: the published spherical bias."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion import ops
from nullmotion.guarantee._bias import checked_coefficients, even_polynomial
from nullmotion.guarantee._two_planes import TwoPlanes
from nullmotion.law import check_parameters


@dataclass(frozen=True)
class Box90Spherical(TwoPlanes):
    """Bias of the two planes by half a sphere and a polynomial in h_x.

        Psi = b sqrt(1 - (h_x/2)^2 - (h_y/2)^2 - (h_z/2)^2) + P(h_x)            (Eq 162)
        P   = sum_k p_k h_x^(2k),   p = 0, 9/40, -3/20, 1/32

    Args:
        b: Bias at no momentum.
        polynomial: Coefficients p_1, p_2, ... of P.
    """

    name: ClassVar[str] = "box90-spherical"
    full_name: ClassVar[str] = "Box-90, spherical bias"
    citation: ClassVar[str] = "Elliott, dissertation (2019), Eqs 161-162"
    layout: ClassVar[str] = "box90"

    b: float = float(4 * np.sqrt(6.0) / 3)
    polynomial: tuple[float, ...] = (0.0, 9 / 40, -3 / 20, 1 / 32)

    def __post_init__(self) -> None:
        """Check the coefficients."""
        check_parameters(self, positive=("b",), kind="constraint")
        checked_coefficients(self, "polynomial")

    def bias(self, h: Any) -> tuple[Any, Any]:
        """Return Psi and its gradient; not a number beyond |h| = 2."""
        root = ops.sqrt(1.0 - 0.25 * (h[0] * h[0] + h[1] * h[1] + h[2] * h[2]))
        value, slope = even_polynomial(self.polynomial, h[0])
        pull = -0.25 * self.b / root
        gradient = np.array([slope + pull * h[0], pull * h[1], pull * h[2]])
        return self.b * root + value, gradient

"""Box-90: a bias designed for what it guarantees."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion.guarantee._bias import Term, checked_terms, even_terms
from nullmotion.guarantee._two_planes import TwoPlanes


@dataclass(frozen=True)
class Box90Designed(TwoPlanes):
    """Bias of the two planes by an even polynomial in the momentum.

        Psi = sum c X^i Y^j Z^k,    X = (h_x/2)^2,  Y = (h_y/2)^2,  Z = (h_z/2)^2

    Found by a sequence of linear programs for the greatest radius of TC >= 1, with more torque
    capability than both published biases at every |h| (`nullmotion design constraint`):

        radius of    envelope   TC >= 0.5   TC >= 1    least TC at |h| = 0.4    1    1.6
        designed        1.928       1.476     0.821                    1.223 0.878 0.388
        cubic           1.790       1.391     0.744                    1.161 0.810 0.309
        spherical       1.835       1.416     0.805                    1.186 0.873 0.318

    No plane is without momentum below |h| = 1.973. TC is 1.326 at no momentum.

    Args:
        terms: Rows (i, j, k, c).
    """

    name: ClassVar[str] = "box90-designed"
    full_name: ClassVar[str] = "Box-90, designed bias"
    citation: ClassVar[str] = "nullmotion design constraint"
    layout: ClassVar[str] = "box90"

    terms: tuple[Term, ...] = (
        (0, 0, 0, 3.136356),
        (1, 0, 0, 0.11374151),
        (0, 1, 0, -1.7424439),
        (0, 0, 1, -1.7424439),
        (2, 0, 0, -5.0530882),
        (1, 1, 0, -0.513923),
        (1, 0, 1, -0.513923),
        (0, 2, 0, -0.88944652),
        (0, 0, 2, -0.88944652),
        (0, 1, 1, 2.7624474),
        (3, 0, 0, 6.6423789),
        (4, 0, 0, -2.9117049),
    )

    def __post_init__(self) -> None:
        """Check the coefficients."""
        checked_terms(self, "terms")

    def bias(self, h: Any) -> tuple[Any, Any]:
        """Return Psi and its gradient."""
        return even_terms(self.terms, 2.0, h)

"""Six-CMG roof: two planes of three, biased against each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion.guarantee._bias import Term, checked_terms, even_terms
from nullmotion.guarantee._two_planes import TwoPlanes
from nullmotion.guarantee.constraints.roof5 import Roof5


@dataclass(frozen=True)
class Roof6(TwoPlanes):
    """Bias of the two planes by an even polynomial in the momentum.

        Psi = sum c X^i Y^j Z^k,    X = (h_x/3)^2,  Y = (h_y/3)^2,  Z = (h_z/3)^2

    Each plane holds its part by three CMGs: one along it, two beside it. The coefficients are
    found by a sequence of linear programs (`nullmotion design constraint --layout roof6`) for
    the radii of TC >= 0.5, 1 and 1.5 with an envelope of at least 2.9:

        radius of                      envelope   TC >= 0.5   TC >= 1   TC >= 1.5
        designed                          2.913       2.472     1.847       1.124
        product of parabolas (Eq 51)      2.151       2.142     1.854       0.845

    No plane is without momentum below |h| = 2.992. TC is 1.801 at no momentum; the greatest
    of any linear right inverse is 2.

    Args:
        terms: Rows (i, j, k, c).
    """

    name: ClassVar[str] = "roof6"
    full_name: ClassVar[str] = "Six-CMG roof, designed bias"
    aliases: ClassVar[tuple[str, ...]] = ("roof6-designed",)
    citation: ClassVar[str] = "nullmotion design constraint"
    layout: ClassVar[str] = "roof6"

    terms: tuple[Term, ...] = (
        (0, 0, 0, 4.3238703),
        (1, 0, 0, 2.0508481),
        (0, 1, 0, -3.82688),
        (0, 0, 1, -3.82688),
        (2, 0, 0, -10.345853),
        (1, 1, 0, 0.85866536),
        (1, 0, 1, 0.85866536),
        (0, 2, 0, -0.10366975),
        (0, 0, 2, -0.10366975),
        (0, 1, 1, 4.322106),
        (3, 0, 0, 10.763811),
        (4, 0, 0, -3.7957496),
    )

    def __post_init__(self) -> None:
        """Check the coefficients."""
        checked_terms(self, "terms")

    @property
    def counts(self) -> tuple[int, int]:
        """CMGs in each plane."""
        return 3, 3

    def bias(self, h: Any) -> tuple[Any, Any]:
        """Return Psi and its gradient."""
        return even_terms(self.terms, 3.0, h)

    def without(self, failed: int) -> Roof5:
        """Return the constraint for the five CMGs left."""
        return Roof5(failed)

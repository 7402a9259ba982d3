"""Six-CMG roof: two planes of three, biased against each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion.guarantee._bias import Term, checked_terms, even_terms
from nullmotion.guarantee._two_planes import TwoPlanes

_B = 4.735


@dataclass(frozen=True)
class Roof6(TwoPlanes):
    """Bias of the two planes by an even polynomial in the momentum.

        Psi = sum c X^i Y^j Z^k,    X = (h_x/3)^2,  Y = (h_y/3)^2,  Z = (h_z/3)^2

    Each plane holds its part by three CMGs: one along it, two beside it. The coefficients
    come from `nullmotion design constraint`.

    Args:
        terms: Rows (i, j, k, c).
    """

    name: ClassVar[str] = "roof6"
    full_name: ClassVar[str] = "Six-CMG roof, designed bias"
    aliases: ClassVar[tuple[str, ...]] = ("roof6-designed",)
    citation: ClassVar[str] = "nullmotion design constraint"
    layout: ClassVar[str] = "roof6"
    counts: ClassVar[tuple[int, int]] = (3, 3)

    terms: tuple[Term, ...] = (
        (0, 0, 0, _B),
        (1, 0, 0, 3.0 - _B),
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
        return even_terms(self.terms, 3.0, h)

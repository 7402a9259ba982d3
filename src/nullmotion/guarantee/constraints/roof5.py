"""The six-CMG roof after one CMG failed: a plane of three and one of two."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.array import layouts
from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError
from nullmotion.guarantee._bias import Term, checked_terms, tilted_terms
from nullmotion.guarantee._two_planes import TwoPlanes


@dataclass(frozen=True)
class Roof5(TwoPlanes):
    """Bias of a plane of three CMGs against one of two.

        Psi = sum c x^i Y^j Z^k,    x = h_x/2,  Y = (h_y/2)^2,  Z = (h_z/2)^2

    for a failure in the x-z plane; after one in the x-y plane the two planes change places,
    Psi(-h_x, h_z, h_y). Odd powers of x let the plane of three hold more of h_x. The
    coefficients are found by a sequence of linear programs
    (`nullmotion design constraint --layout roof5`) with an envelope of at least 1.9:

        radius of     envelope   TC >= 0.5   TC >= 1   TC >= 1.25
                         1.941       1.475     0.863        0.500

    No plane is without momentum below |h| = 1.941. TC is 1.350 at no momentum.

    Args:
        failed: Index of the CMG that failed, counted from 0.
        terms: Rows (i, j, k, c).
    """

    name: ClassVar[str] = "roof5"
    full_name: ClassVar[str] = "Six-CMG roof without one, designed bias"
    citation: ClassVar[str] = "nullmotion design constraint"
    layout: ClassVar[str] = "roof6"

    failed: int = 5
    terms: tuple[Term, ...] = (
        (0, 0, 0, 3.4257782),
        (1, 0, 0, -0.11839105),
        (2, 0, 0, -1.0124926),
        (0, 1, 0, -0.96212887),
        (0, 0, 1, -1.9578201),
        (3, 0, 0, -1.3223524),
        (1, 1, 0, -0.46918731),
        (1, 0, 1, -0.87955062),
        (4, 0, 0, -0.071128166),
        (2, 1, 0, 0.68324714),
        (0, 2, 0, 0.35489929),
        (2, 0, 1, 0.79509242),
        (0, 1, 1, 0.69217889),
        (0, 0, 2, -0.92161386),
        (5, 0, 0, 0.73135089),
        (6, 0, 0, 1.1999979),
        (7, 0, 0, -0.13758146),
        (8, 0, 0, -0.70436301),
    )

    def __post_init__(self) -> None:
        """Check index and coefficients."""
        if isinstance(self.failed, bool) or self.failed not in range(6):
            raise InputError("constraint.failed", self.failed, "a whole number from 0 to 5")
        checked_terms(self, "terms")

    @property
    def counts(self) -> tuple[int, int]:
        """CMGs in each plane."""
        return (2, 3) if self.failed < 3 else (3, 2)

    def bias(self, h: Any) -> tuple[Any, Any]:
        """Return Psi and its gradient."""
        if self.failed >= 3:
            return tilted_terms(self.terms, 2.0, h)
        value, slope = tilted_terms(self.terms, 2.0, [-h[0], h[2], h[1]])
        return value, np.array([-slope[0], slope[2], slope[1]])

    def array(self, **parameters: Any) -> CmgArray:
        """Return the five CMGs that are left; parameters are those of all six."""
        return layouts.create(self.layout, **parameters).without(self.failed)

"""Planar array: the closed forms of greatest torque capability."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion import ops
from nullmotion.errors import InputError
from nullmotion.guarantee._planar import PlanarConstraint, checked_count


@dataclass(frozen=True)
class Planar(PlanarConstraint):
    """n >= 3 CMGs with one gimbal axis, in angles symmetric to the momentum H (along 0).

    With H_c = n/sqrt 2 (n even) or 1 + sqrt((n-1)(n-2)/2) (n odd, one CMG at angle 0),

        cos delta = x + c_j sqrt(max(s, 0)),    x = H/n, s = n^2 - 2 H^2               n even
                                                x = (H-1)/(n-1), s = 2 (H_c - H)(H + H_c - 2)
                                                                                      n odd

    Below H_c (static region) A A^T = (n/2) I and TC = n/2, the greatest of any linear right
    inverse; above it (declining region) all |delta| but the one at 0 are equal. The groups
    and c_j are those of Eqs 24-48, with k_4 = k_3 + ceil((n-1)/4): the printed floor leaves
    out a CMG at n = 11, 15, ...

    Three CMGs have no static region (Jones et al. 2012): 0 and +-acos((H-1)/2), continuous
    for every H; TC is 1 at the least, at H = 1, as much as any angles give there.

    Angles turn through H = 0 in no time, and grow as sqrt(H_c - H) at H_c: a law that follows
    the constraint to the letter is singular there, `constraint-feedback` is not.

    Args:
        n: Number of CMGs.
    """

    name: ClassVar[str] = "planar"
    full_name: ClassVar[str] = "Planar, greatest torque capability"
    citation: ClassVar[str] = "Elliott, dissertation (2019), Eqs 24-48; n = 3: Jones et al. (2012)"

    n: int = 5

    def __post_init__(self) -> None:
        """Refuse two CMGs: they have no null motion."""
        checked_count(self.n)

    @property
    def critical_momentum(self) -> float:
        """Momentum H_c at which the static region ends."""
        n = self.n
        return float(1 + np.sqrt((n - 1) * (n - 2) / 2) if n % 2 else n / np.sqrt(2))

    def half(self, H: Any) -> list[tuple[Any, int]]:
        """Return the cosines of the positive half of the angles, the greatest angle first."""
        n, critical = self.n, self.critical_momentum
        odd = n % 2
        x = (H - odd) / (n - odd)
        spread = ops.sqrt(ops.maximum(2.0 * (critical - H) * (H + critical - 2 * odd), 0.0))
        return [(x + factor * spread, count) for factor, count in _spreads(n)]

    def without(self, failed: int) -> Planar:
        """Return the closed form of one CMG less.

        Raises:
            InputError: When two would be left.
        """
        if not 0 <= failed < self.n:
            raise InputError("failed CMG", failed, f"0 to {self.n - 1}")
        return Planar(self.n - 1)


def _spreads(n: int) -> list[tuple[float, int]]:
    """Return c_j and the size of its group, for the positive half of the angles."""
    if n == 3:
        return [(0.0, 1)]
    if n == 7:
        return [(float(c / (12 * np.sqrt(7.0))), 1) for c in (-5, 1, 4)]
    even = n - n % 2
    outer, inner = even // 4, even // 2 - even // 4
    root = np.sqrt(2.0 * outer * inner)
    return [(float(-root / (2 * outer * even)), outer), (float(root / (2 * inner * even)), inner)]

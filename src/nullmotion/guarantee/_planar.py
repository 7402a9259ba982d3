"""What constraints of planar arrays share: angles that are symmetric to the momentum."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion import linalg, ops
from nullmotion.errors import InputError
from nullmotion.guarantee.constraint import Constraint
from nullmotion.guarantee.region import Box, Region


@dataclass(frozen=True)
class PlanarConstraint(Constraint):
    """Base of the planar constraints: gimbal angles measured from the momentum's direction.

    With the angles symmetric to the momentum, A A^T = diag(S, C) across and along it,
    C = sum cos^2 delta, S = n - C, and row i of the pseudo-inverse has the square

        sin^2 delta_i / S^2 + cos^2 delta_i / C^2.
    """

    layout: ClassVar[str] = "planar"
    method: ClassVar[str] = "pseudo-inverse"

    n: int = 5

    @property
    def layout_parameters(self) -> dict[str, Any]:
        """The number of CMGs."""
        return {"n": self.n}

    @property
    def groups(self) -> tuple[tuple[int, ...], ...]:
        """All CMGs may change places."""
        return (tuple(range(self.n)),)

    @property
    def reach(self) -> float:
        """All CMGs in line."""
        return float(self.n)

    def half(self, H: Any) -> list[tuple[Any, int]]:
        """Return the cosines of the positive half of the angles and how many CMGs have each.

        The greatest angle comes first; a CMG left over is at angle 0.
        """
        raise NotImplementedError

    def offsets(self, H: Any) -> Any:
        """Return gimbal angles from the momentum's direction [rad], (n,), rising; source."""
        half = [a for c, k in self.half(H) for a in [ops.acos(ops.clip(c, -1.0, 1.0))] * k]
        return np.array([*[-a for a in half], *[0.0] * (self.n % 2), *half[::-1]])

    def angles(self, h: Any) -> Any:
        """Return the gimbal angles [rad], (n,); the direction of no momentum is x."""
        return ops.atan2(h[1], h[0]) + self.offsets(linalg.norm(h))

    def inside(self, h: Any) -> Any:
        """Return whether |h| < n."""
        return ops.less(linalg.norm(h), float(self.n))

    def squares(self, h: Any) -> Any:
        """Return the squared row norms of A^+, one for each cosine."""
        return self.radial_squares(linalg.norm(h))

    def claim(self, radius: float, torque_capability: float) -> tuple[Callable[[Any], Any], Region]:
        """Return source over |h| alone: TC does not depend on the momentum's direction."""

        def margins(x: Any) -> Any:
            rows = [torque_capability**2 * s - 1.0 for s in self.radial_squares(x[0])]
            return np.array([*rows, x[0] - float(self.n)])

        return margins, Box((0.0,), (radius,))

    def momentum_of(self, point: Any) -> Any:
        """Return the momentum of size point[0] along x."""
        return np.array([point[0], 0.0 * point[0]])

    def radial_squares(self, H: Any) -> Any:
        """Return the squared row norms of A^+ at a momentum of size H."""
        return self.squares_of(self.half(H))

    def squares_of(self, half: list[tuple[Any, int]]) -> Any:
        """Return the squared row norms of A^+ for the cosines of half the angles."""
        along, across = self.spread(half)
        rows = [(1.0 - c * c) / (across * across) + c * c / (along * along) for c, _ in half]
        return np.array([*rows, *([1.0 / (along * along)] * (self.n % 2))])

    def spread(self, half: list[tuple[Any, int]]) -> tuple[Any, Any]:
        """Return the eigenvalues C and S of A A^T along and across the momentum."""
        along = sum(2.0 * k * (c * c) for c, k in half) + float(self.n % 2)
        return along, float(self.n) - along


def checked_count(n: Any) -> None:
    """Refuse a number of CMGs that leaves no null motion."""
    if isinstance(n, bool) or not isinstance(n, (int, np.integer)) or n < 3:
        raise InputError("constraint.n", n, "a whole number from 3: two CMGs have no null motion")

"""Orthogonal pairs: three planes of two CMGs, biased against each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion import ops
from nullmotion.guarantee._two_planes import Plane, angles_of, outer_rates, square_of
from nullmotion.guarantee.constraint import Constraint
from nullmotion.law import check_parameters


@dataclass(frozen=True)
class OrthogonalPairs(Constraint):
    """The planes x-y, y-z and z-x share every axis out by halves, with a bias along each.

        p_1 = (h_x/2 + b_x, h_y/2 - b_y)    p_2, p_3: x, y, z in turn
        b_i = b (1 - (h_i/extent)^2)

    Two CMGs hold each part as in the box-90. With b = 1 every plane has r = sqrt 2 at no
    momentum, where TC = 2, the greatest of any linear right inverse (n/m). An extent of 2.6
    then leaves the largest ball without singularity, 1.995: with less a plane is without
    momentum at h = (-1, 1, 0) sqrt 2 or before, with more one is saturated at (1, -1, 0).

    Args:
        b: Bias at no momentum.
        extent: Momentum along an axis at which its bias is gone.
    """

    name: ClassVar[str] = "orthogonal-pairs"
    full_name: ClassVar[str] = "Three orthogonal pairs, biased"
    aliases: ClassVar[tuple[str, ...]] = ("orthogonal_pairs",)
    citation: ClassVar[str] = "after Elliott, Peck and Nesnas (2018) and Elliott (2019), Fig 3E"
    layout: ClassVar[str] = "orthogonal_pairs"

    b: float = 1.0
    extent: float = 2.6

    def __post_init__(self) -> None:
        """Check the parameters."""
        check_parameters(self, positive=("b", "extent"), kind="constraint")

    @property
    def groups(self) -> tuple[tuple[int, ...], ...]:
        """CMGs of a plane may change places."""
        return (0, 1), (2, 3), (4, 5)

    @property
    def reach(self) -> float:
        """Two planes in line along every axis."""
        return float(4 * np.sqrt(3.0))

    def planes(self, h: Any) -> list[Plane]:
        """Return the three planes' parts of a momentum; source."""
        bias = [self.b * (1.0 - c * c * (1.0 / self.extent**2)) for c in h]
        slope = [-2.0 * self.b / self.extent**2 * c for c in h]
        found = []
        for i in range(3):
            j, axes = (i + 1) % 3, np.eye(3)
            rows = np.stack([(0.5 + slope[i]) * axes[i], (0.5 - slope[j]) * axes[j]])
            found.append(Plane(0.5 * h[i] + bias[i], 0.5 * h[j] - bias[j], rows, 2))
        return found

    def angles(self, h: Any) -> Any:
        """Return the gimbal angles [rad], (6,)."""
        return np.concatenate([angles_of(plane) for plane in self.planes(h)])

    def inside(self, h: Any) -> Any:
        """Return whether every plane has 0 < r < 2 and every |h_i| <= extent."""
        good = ops.less_equal(ops.amax(ops.absolute(h)), self.extent)
        for plane in self.planes(h):
            square = square_of(plane)
            good = ops.logical_and(good, ops.less(0.0, square))
            good = ops.logical_and(good, ops.less(square, 4.0))
        return good

    def parts(self, h: Any) -> list[Any]:
        """Return the planes' momenta."""
        return [np.array([plane.x, plane.other]) for plane in self.planes(h)]

    def edges(self, h: Any) -> list[Any]:
        """Return |h_i| - extent."""
        return [ops.absolute(c) - self.extent for c in h]

    def squares(self, h: Any) -> Any:
        """Return the squared row norms; a plane's rows of P are at right angles."""
        found = []
        for i, plane in enumerate(self.planes(h)):
            a, b = plane.slope[0][i], plane.slope[1][(i + 1) % 3]
            for v in outer_rates(plane):
                found.append((v[0] * a) * (v[0] * a) + (v[1] * b) * (v[1] * b))
        return np.array(found)

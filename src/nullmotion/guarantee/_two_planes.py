"""What constraints of two orthogonal planes share: the planes biased against each other.

The x-y plane and the x-z plane share the x axis. They share the momentum along it out by
a bias Psi(h), which leaves the array's momentum alone:

    p_1 = ((h_x - Psi)/2, h_y),    p_2 = ((h_x + Psi)/2, h_z)                      (Eq 50)

and each plane holds its part p, r = |p|, by CMGs at the angle of p and beside it:

    two CMGs    theta -+ acos(r/2)              q = sqrt(4 - r^2)
    three CMGs  theta, theta -+ acos((r-1)/2)   q = sqrt(4 - (r-1)^2)

Their rates are e_theta . p'/r +- e_r . p'/q (the middle one of three has the first term
alone), p' = P hdot with P from the gradient of Psi. That is J_t^-1 of Eq 12 in closed form:
singular at r = 0 and where a plane is saturated, and nowhere else.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from nullmotion import ops
from nullmotion.guarantee.constraint import Constraint
from nullmotion.guarantee.region import Ball, Region

_NEAR = 1e-3  # momentum of a plane, in units of one CMG's, that counts as none or as saturated


class Plane(NamedTuple):
    """One plane's part: momentum (x, other), its slope P over h, (2, 3), number of CMGs."""

    x: Any
    other: Any
    slope: Any
    cmgs: int


@dataclass(frozen=True)
class TwoPlanes(Constraint):
    """Base of box-90 and roof-6 constraints; an entry gives `bias` and `extent`."""

    @property
    def counts(self) -> tuple[int, int]:
        """CMGs in the x-y plane and in the x-z plane."""
        return 2, 2

    def bias(self, h: Any) -> tuple[Any, Any]:
        """Return Psi and its gradient (3,) at a momentum; source."""
        raise NotImplementedError

    @property
    def extent(self) -> float:
        """Greatest |h_x| of the restricted envelope: where the planes cannot be told apart."""
        return float(min(self.counts))

    @property
    def groups(self) -> tuple[tuple[int, ...], ...]:
        """CMGs of a plane may change places."""
        first, second = self.counts
        return tuple(range(first)), tuple(range(first, first + second))

    @property
    def reach(self) -> float:
        """Corner of the restricted envelope."""
        return float(np.hypot(self.extent, np.hypot(*self.counts)))

    def planes(self, h: Any) -> tuple[Plane, Plane]:
        """Return the two planes' parts of a momentum; source."""
        psi, gradient = self.bias(h)
        first = np.array([0.5 * (float(i == 0) - gradient[i]) for i in range(3)])
        second = np.array([0.5 * (float(i == 0) + gradient[i]) for i in range(3)])
        y, z = np.eye(3)[1], np.eye(3)[2]
        one = Plane(0.5 * (h[0] - psi), h[1], np.stack([first, y]), self.counts[0])
        two = Plane(0.5 * (h[0] + psi), h[2], np.stack([second, z]), self.counts[1])
        return one, two

    def angles(self, h: Any) -> Any:
        """Return the gimbal angles [rad], (n,)."""
        return np.concatenate([angles_of(plane) for plane in self.planes(h)])

    def inside(self, h: Any) -> Any:
        """Return whether |h_x| <= extent and both planes have 0 < r < their number of CMGs."""
        good = ops.less_equal(ops.absolute(h[0]), self.extent)
        for plane in self.planes(h):
            square = square_of(plane)
            good = ops.logical_and(good, ops.less(0.0, square))
            good = ops.logical_and(good, ops.less(square, float(plane.cmgs**2)))
        return good

    def gimbal_jacobian(self, h: Any) -> Any:
        """Return d angles / d h, (n, 3), in closed form."""
        return np.concatenate([np.array(rates_of(p)) @ p.slope for p in self.planes(h)])

    def squares(self, h: Any) -> Any:
        """Return the squared row norms of `gimbal_jacobian`, without a middle CMG's (least)."""
        found = []
        for plane in self.planes(h):
            for v in outer_rates(plane):
                row = v[0] * plane.slope[0] + v[1] * plane.slope[1]
                found.append(row @ row)
        return np.array(found)

    def parts(self, h: Any) -> list[Any]:
        """Return the planes' momenta."""
        return [np.array([plane.x, plane.other]) for plane in self.planes(h)]

    def edges(self, h: Any) -> list[Any]:
        """Return |h_x| - extent."""
        return [ops.absolute(h[0]) - self.extent]

    def regular_claim(self, radius: float) -> tuple[Callable[[Any], Any], Region]:
        """Return source over the ball: a plane is saturated, or no plane has r = 0.

        Both within `_NEAR`; the planes' determinant is r sqrt(4 - r^2)/2 or the like.
        """

        def margins(h: Any) -> Any:
            squares = [(square_of(plane), plane.cmgs) for plane in self.planes(h)]
            saturated = ops.minimum(*((k - _NEAR) ** 2 - s for s, k in squares))
            return np.array([ops.minimum(_NEAR**2 - s, saturated) for s, _ in squares])

        return margins, Ball(radius, 3)


def square_of(plane: Plane) -> Any:
    return plane.x * plane.x + plane.other * plane.other


def _ratio(plane: Plane, square: Any) -> Any:
    """Return r/q."""
    if plane.cmgs == 2:
        return ops.sqrt(square / (4.0 - square))
    r = ops.sqrt(square)
    return r / ops.sqrt((3.0 - r) * (1.0 + r))


def outer_rates(plane: Plane) -> list[Any]:
    """Return e_theta/r + e_r/q and e_theta/r - e_r/q: the outer CMGs' rates on p', (2,) each."""
    square = square_of(plane)
    k, inverse = _ratio(plane, square), 1.0 / square
    x, y = plane.x * inverse, plane.other * inverse
    return [np.array([x * k - y, x + y * k]), np.array([-y - x * k, x - y * k])]


def rates_of(plane: Plane) -> list[Any]:
    first, last = outer_rates(plane)
    if plane.cmgs == 2:
        return [first, last]
    inverse = 1.0 / square_of(plane)
    return [first, np.array([-plane.other * inverse, plane.x * inverse]), last]


def angles_of(plane: Plane) -> Any:
    r = ops.sqrt(square_of(plane))
    theta = ops.atan2(plane.other, plane.x)
    cosine = 0.5 * r if plane.cmgs == 2 else 0.5 * (r - 1.0)
    spread = ops.acos(ops.clip(cosine, -1.0, 1.0))
    middle = [theta] if plane.cmgs == 3 else []
    return np.array([theta - spread, *middle, theta + spread])

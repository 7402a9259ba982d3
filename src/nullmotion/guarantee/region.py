"""Regions over which something is proven.

A region is covered by its root box, which a proof cuts into halves. Whether a box is outside,
or a point inside, is told with rounding on the safe side: where it is not certain, it is not.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from nullmotion.errors import InputError

if TYPE_CHECKING:
    from nullmotion.compile.interval_replay import Enclosure

_SLACK = 2.0**-48  # more than the rounding of a sum of three squares, relative
_ROUNDING = 2.0**-44  # more than that of a bound, relative to what is added up


@dataclass(frozen=True)
class Ball:
    """All points of m dimensions with |h| <= radius, m = 1, 2 or 3.

    Raises:
        InputError: For a radius or a dimension that is none.
    """

    radius: float
    m: int = 3

    def __post_init__(self) -> None:
        """Refuse what is no ball."""
        if not 1e-100 < self.radius < 1e100:
            raise InputError("region.radius", self.radius, "a positive number")
        _check_dimension(self.m)

    def root(self) -> np.ndarray:
        """Return the lower and upper corner of the box around the region, (2, m)."""
        return np.array([[-self.radius] * self.m, [self.radius] * self.m])

    def outside(self, boxes: np.ndarray) -> np.ndarray:
        """Return which boxes (B, 2, m) certainly have no point in the region."""
        nearest = np.maximum(np.maximum(boxes[:, 0], -boxes[:, 1]), 0.0)
        least: np.ndarray = (nearest * nearest).sum(axis=1) * (1.0 - _SLACK)
        return least > self.radius**2 * (1.0 + _SLACK)

    def greatest(self, boxes: np.ndarray, found: Enclosure) -> np.ndarray:
        """Return upper bounds (B, k) that hold in the boxes' parts in the region.

        With p >= 0, c the centre and S the slopes, and as |h|^2 <= radius^2 there,

            f(h) <= f(h) + p (radius^2 - |h|^2)
                 <= f(c) + p (radius^2 - |c|^2) + (S - 2 p c) (h - c):

        where f grows outwards, what sticks out of the ball does not count. The bound is
        convex and piecewise linear in p; it is least at 0 or where a component of S - 2 p c
        vanishes.
        """
        centre, reach = middle(boxes)[:, None], reach_of(boxes)[:, None]
        room = self.radius**2 - (centre * centre).sum(axis=2)
        size = np.abs(found.slope).max(axis=2) + found.spread.max(axis=2)
        best = found.upper
        with np.errstate(all="ignore"):  # slopes may be unknown
            for axis in range(self.m):
                p = found.slope[:, :, axis] / (2.0 * centre[:, :, axis])
                p = np.where((p > 0.0) & (p < 1e100), p, 0.0)
                steep = np.abs(found.slope - 2.0 * p[:, :, None] * centre) + found.spread
                bound = found.at_most + p * room + (steep * reach).sum(axis=2)
                whole = np.abs(found.at_most) + (size + p) * (1.0 + self.radius) ** 2
                best = np.fmin(best, bound + whole * _ROUNDING + 1e-290)
        return best

    def holds(self, points: np.ndarray) -> np.ndarray:
        """Return which points (B, m) certainly are in the region."""
        most: np.ndarray = (points * points).sum(axis=1) * (1.0 + _SLACK)
        return most <= self.radius**2 * (1.0 - _SLACK)


@dataclass(frozen=True)
class Box:
    """All points with lower <= h <= upper, component by component; 1 to 3 of them.

    Raises:
        InputError: For ends that are not finite or not in order.
    """

    lower: tuple[float, ...]
    upper: tuple[float, ...]

    def __post_init__(self) -> None:
        """Refuse what is no box."""
        for name in ("lower", "upper"):
            object.__setattr__(self, name, tuple(float(v) for v in getattr(self, name)))
        _check_dimension(len(self.lower))
        if len(self.upper) != len(self.lower):
            raise InputError("region.upper", self.upper, f"{len(self.lower)} numbers")
        for low, high in zip(self.lower, self.upper, strict=True):
            if not -math.inf < low < high < math.inf:
                raise InputError("region.upper", self.upper, f"finite and above {self.lower}")

    @property
    def m(self) -> int:
        """Number of components."""
        return len(self.lower)

    def root(self) -> np.ndarray:
        """Return the lower and upper corner, (2, m)."""
        return np.array([self.lower, self.upper])

    def outside(self, boxes: np.ndarray) -> np.ndarray:
        """Return which boxes (B, 2, m) have no point in the region: none of its parts."""
        return np.zeros(len(boxes), bool)

    def greatest(self, boxes: np.ndarray, found: Enclosure) -> np.ndarray:
        """Return the upper bounds (B, k) as they are."""
        return found.upper

    def holds(self, points: np.ndarray) -> np.ndarray:
        """Return which points (B, m) are in the region."""
        lower, upper = self.root()
        return np.asarray(((points >= lower) & (points <= upper)).all(axis=1))


Region = Ball | Box


def middle(boxes: np.ndarray) -> np.ndarray:
    """Return the middles (B, m) of boxes (B, 2, m), as they are enclosed."""
    lower, upper = boxes[:, 0], boxes[:, 1]
    return np.asarray(np.clip(0.5 * lower + 0.5 * upper, lower, upper))


def reach_of(boxes: np.ndarray) -> np.ndarray:
    """Return how far boxes (B, 2, m) reach from their middles, (B, m), rounded up."""
    centre = middle(boxes)
    return np.asarray(np.maximum(boxes[:, 1] - centre, centre - boxes[:, 0]) * (1.0 + _SLACK))


def _check_dimension(m: int) -> None:
    if m not in (1, 2, 3):
        raise InputError("region.m", m, "1, 2 or 3 dimensions")

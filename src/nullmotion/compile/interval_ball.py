"""Slopes of recorded source as balls |s - mid| <= rad, rounding included.

Products of balls cost a third of intervals' and lose only what is of second order in the box.
A ball whose mid or rad is not finite is unknown, and so is all that is made of it: nothing
here decides by a comparison of radii, which a NaN would pass.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from nullmotion.compile.interval import TINY, UNIT, Interval, Value, choose, greater
from nullmotion.compile.tape import product

UP = 1.0 + 2.0**-49  # more than the rounding of the few sums and products that make a radius


@dataclass(frozen=True, eq=False)
class Ball:
    """The numbers within ``rad`` of ``mid``."""

    mid: Value
    rad: Value

    @property
    def magnitude(self) -> Value:
        """Greatest absolute value, rounded up."""
        return product(abs(self.mid) + self.rad, UP)

    def __add__(self, other: Ball) -> Ball:
        mid = self.mid + other.mid
        return Ball(mid, product(self.rad + other.rad + product(abs(mid), UNIT), UP))

    def __neg__(self) -> Ball:
        return Ball(-self.mid, self.rad)

    def __mul__(self, other: Ball) -> Ball:
        mid = product(self.mid, other.mid)
        spread = _spread(abs(self.mid), other.rad)
        spread = spread + _spread(abs(other.mid) + other.rad, self.rad)
        return Ball(mid, product(spread + product(abs(mid), UNIT) + TINY, UP))

    def hull(self, other: Ball) -> Ball:
        """Return a ball that holds both."""
        mid = product(self.mid, 0.5) + product(other.mid, 0.5)
        apart = abs(self.mid - other.mid)
        spread = product(apart + self.rad + other.rad + abs(self.rad - other.rad), 0.5)
        return Ball(mid, product(spread + product(abs(mid) + apart, UNIT) + TINY, UP))

    def unless(self, undefined: Value) -> Ball:
        """Return the same, or unknown where a condition holds."""
        return Ball(self.mid, choose(undefined, math.inf, self.rad))


def _spread(size: Value, rad: Value) -> Value:
    """Return size * rad; 0 at once for what is exact."""
    return 0.0 if isinstance(rad, float) and rad == 0.0 else product(size, rad)


Slope = Ball | None  # None: does not change along that axis
ZERO = Ball(0.0, 0.0)
ONE = Ball(1.0, 0.0)


def ball(x: Interval) -> Ball:
    """Return a ball that holds an interval."""
    if x.constant:
        return Ball(x.lo, 0.0)
    mid = product(x.lo, 0.5) + product(x.hi, 0.5)
    return Ball(mid, product(greater(x.hi - mid, mid - x.lo) + TINY, UP))

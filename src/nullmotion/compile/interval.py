"""Intervals [lo, hi] that hold what they should, rounding included.

The ends are floats, arrays or symbols: the same arithmetic runs in NumPy over a batch and in
a kernel. Every end is rounded outward: with round to nearest, an exact v and its rounded
value w differ by half a unit in the last place of w, which is at most 2^-53 |w|; ulp(w) <=
2^-52 |w|, and w - ulp(w) is a double, so that

    w - 2^-52 |w|, rounded,  <=  w - ulp(w)  <  v,

whether that product is fused with the difference or not. Sums and roots lose nothing to
underflow; a product or quotient loses less than the 1e-300 taken off beside. Nothing on the
tape undoes it: `product` is neither folded nor fused, and kernels know no fast-math.

An end is never NaN; lo is never +inf, hi never -inf. What may be undefined somewhere is
(-inf, inf), and so is everything made of it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from nullmotion.compile import tape as tp
from nullmotion.compile.tape import apply, product

Value = Any  # a float, an array or a Symbol

UNIT = 2.0**-52
TINY = 1e-300


def choose(condition: Value, a: Value, b: Value) -> Value:
    """Return a where the condition holds, else b; a plain number for plain numbers."""
    found = apply("select", condition, a, b)
    return found if isinstance(found, tp.Symbol) else found[()]


def lesser(a: Value, b: Value) -> Value:
    """Return a if a < b, else b: b where either is NaN."""
    return choose(apply("less", a, b), a, b)


def greater(a: Value, b: Value) -> Value:
    """Return a if a > b, else b: b where either is NaN."""
    return choose(apply("less", b, a), a, b)


def below(v: Value, units: float = 1.0) -> Value:
    """Return at most what was rounded to v, wrong by so many ulp; -inf for NaN."""
    return greater(v - product(abs(v), units * UNIT), -math.inf)


def above(v: Value, units: float = 1.0) -> Value:
    """Return at least what was rounded to v, wrong by so many ulp; inf for NaN."""
    return lesser(v + product(abs(v), units * UNIT), math.inf)


@dataclass(frozen=True, eq=False)
class Interval:
    """The numbers from lo to hi; a constant has two equal Python floats for ends."""

    lo: Value
    hi: Value

    @cached_property
    def magnitude(self) -> Value:
        """Greatest absolute value."""
        return greater(abs(self.lo), abs(self.hi))

    @cached_property
    def bounded(self) -> Value:
        """Whether both ends are finite."""
        return apply("less", self.magnitude, math.inf)

    @property
    def constant(self) -> bool:
        """Whether it is one number, known while the source is replayed."""
        return isinstance(self.lo, float) and isinstance(self.hi, float) and self.lo == self.hi

    def __add__(self, other: Interval) -> Interval:
        return Interval(below(self.lo + other.lo), above(self.hi + other.hi))

    def __neg__(self) -> Interval:
        return Interval(-self.hi, -self.lo)

    def __sub__(self, other: Interval) -> Interval:
        return self + -other

    def __mul__(self, other: Interval) -> Interval:
        if self.constant or other.constant:
            return self._times(other) if self.constant else other._times(self)
        ends = [product(a, b) for a in (self.lo, self.hi) for b in (other.lo, other.hi)]
        least = lesser(lesser(ends[0], ends[1]), lesser(ends[2], ends[3]))
        most = greater(greater(ends[0], ends[1]), greater(ends[2], ends[3]))
        # infinite or NaN (0 inf) if any end is infinite: then nothing is known
        error = product(product(self.magnitude, other.magnitude), UNIT) + TINY
        return Interval(greater(least - error, -math.inf), lesser(most + error, math.inf))

    def _times(self, other: Interval) -> Interval:
        """Return a constant times another interval."""
        ends = [product(self.lo, other.lo), product(self.lo, other.hi)]
        least, most = ends if self.lo >= 0.0 else ends[::-1]
        return Interval(below(least - TINY), above(most + TINY))

    def square(self) -> Interval:
        """Return x^2."""
        a, b = product(self.lo, self.lo), product(self.hi, self.hi)
        across = apply("less_equal", greater(self.lo, -self.hi), 0.0)
        least = choose(across, 0.0, greater(below(lesser(a, b) - TINY), 0.0))
        return Interval(least, above(greater(a, b) + TINY)).defined_with(self)

    def reciprocal(self) -> Interval:
        """Return 1/x; (-inf, inf) if 0 is among the x."""
        zero = apply("and", apply("less_equal", self.lo, 0.0), apply("less_equal", 0.0, self.hi))
        least, most = apply("div", 1.0, self.hi), apply("div", 1.0, self.lo)
        return Interval(below(least - TINY), above(most + TINY)).unless(zero)

    def sqrt(self) -> Interval:
        """Return the square root; (-inf, inf) if any x < 0."""
        least, most = tp.sqrt(self.lo), tp.sqrt(self.hi)
        return Interval(below(least), above(most)).unless(apply("less", self.lo, 0.0))

    def unless(self, undefined: Value) -> Interval:
        """Return the same, or (-inf, inf) where a condition holds."""
        return Interval(choose(undefined, -math.inf, self.lo), choose(undefined, math.inf, self.hi))

    def defined_with(self, *operands: Interval) -> Interval:
        """Return the same, or (-inf, inf) where an operand is not bounded."""
        result = self
        for operand in operands:
            if not operand.constant:
                result = result.unless(apply("not", operand.bounded))
        return result

    def hull(self, other: Interval) -> Interval:
        """Return the least interval that holds both."""
        return Interval(lesser(self.lo, other.lo), greater(self.hi, other.hi))

    def meet(self, other: Interval) -> Interval:
        """Return what is in both."""
        return Interval(greater(self.lo, other.lo), lesser(self.hi, other.hi))


WHOLE = Interval(-math.inf, math.inf)


def point(v: Value) -> Interval:
    """Return the interval of one number; (-inf, inf) for a constant that is not finite."""
    if isinstance(v, float) and not math.isfinite(v):
        return WHOLE
    return Interval(v, v)


@dataclass(frozen=True, eq=False)
class Truth:
    """What is known of a condition: certainly true, certainly false, or neither.

    Attributes:
        yes: It holds for all numbers in the intervals that it is about.
        no: It holds for none of them.
        defined: All those numbers exist.
    """

    yes: Value
    no: Value
    defined: Value

    def both(self, other: Truth) -> Truth:
        """Return whether both hold."""
        return Truth(
            apply("and", self.yes, other.yes),
            apply("or", self.no, other.no),
            apply("and", self.defined, other.defined),
        )

    def inverse(self) -> Truth:
        """Return whether it does not hold."""
        return Truth(self.no, self.yes, self.defined)

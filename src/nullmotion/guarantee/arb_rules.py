"""What steps mean in ball arithmetic (python-flint); nan is what may be undefined.

A truth is (certainly true, certainly false, defined). ``a_slope`` is the slope of step a along
one axis from the ranges and the slopes of its operands.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from flint import arb

Ball = Any  # arb
Balls = Sequence[Ball]
Truth = tuple[bool, bool, bool]

zero, one, nan = arb(0), arb(1), arb.nan()
_HALF = arb(0.5)


def constant(value: float) -> Ball:
    """Return a constant."""
    return arb(value) if math.isfinite(value) else nan


def side(lower: float, upper: float) -> tuple[Ball, Ball, Ball]:
    """Return one side's middle, the side, and the side moved to 0."""
    low, high = arb(lower), arb(upper)
    centre = arb(0.5 * lower + 0.5 * upper)
    reach = arb(0, (high - centre).max(centre - low).upper())
    whole = centre + reach
    if lower >= 0.0:
        whole = whole.nonnegative_part()
    elif upper <= 0.0:
        whole = -(-whole).nonnegative_part()
    return centre, whole, reach


def meet(a: Ball, b: Ball) -> Ball:
    """Return what is in both; a where b tells nothing."""
    return a.intersection(b) if b.is_finite() else a


def finite(value: Ball, *operands: Ball) -> Ball:
    """Return a value, or nan where an operand may be undefined."""
    return value if all(x.is_finite() for x in operands) else nan


def inverse(x: Ball) -> Ball:
    """Return 1/x."""
    return one / x


def square_(x: Ball) -> Ball:
    """Return x^2."""
    return (x * x).nonnegative_part() if x.contains(zero) else x * x


def sqrt_(x: Ball) -> Ball:
    """Return the root."""
    return x.sqrt()


def sin_(x: Ball) -> Ball:
    """Return the sine."""
    return finite(x.sin(), x)


def cos_(x: Ball) -> Ball:
    """Return the cosine."""
    return finite(x.cos(), x)


def exp_(x: Ball) -> Ball:
    """Return e^x."""
    return finite(x.exp(), x)


def log_(x: Ball) -> Ball:
    """Return the natural logarithm."""
    return x.log()


def acos_(x: Ball, within: bool = False) -> Ball:
    """Return the arc cosine; ``within`` says that x is in [-1, 1], whatever its ball."""
    if not within:
        return x.acos()
    low, high = x.lower().max(-one), x.upper().min(one)
    return finite(high.acos().union(low.acos()), x)


def atan2_(y: Ball, x: Ball) -> Ball:
    """Return the angle of the point (x, y)."""
    return finite(arb.atan2(y, x), y, x)


def atan2_slope(y: Ball, x: Ball, dy: Ball, dx: Ball) -> Ball:
    """Jumps across the negative x axis."""
    if y.contains(zero) and not x > 0:
        return nan
    return (x * dy - y * dx) / (square_(x) + square_(y))


def minimum_(a: Ball, b: Ball) -> Ball:
    """Return the lesser."""
    return finite(a.min(b), a, b)


def maximum_(a: Ball, b: Ball) -> Ball:
    """Return the greater."""
    return finite(a.max(b), a, b)


def minimum_slope(a: Ball, b: Ball, da: Ball, db: Ball) -> Ball:
    """Return the slope of the lesser, or both."""
    return da if a <= b else db if b <= a else da.union(db)


def maximum_slope(a: Ball, b: Ball, da: Ball, db: Ball) -> Ball:
    """Return the slope of the greater, or both."""
    return minimum_slope(b, a, da, db)


def sign(x: Ball) -> Ball:
    """Return the slope of |x|."""
    return one if x >= 0 else -one if x <= 0 else arb(0, 1)


def copysign_(a: Ball, b: Ball) -> Ball:
    """Return |a| with the sign of b."""
    size = abs(a)
    return size if b > 0 else -size if b < 0 else finite(size.union(-size), b)


def copysign_slope(a: Ball, b: Ball, da: Ball, db: Ball) -> Ball:
    """Jumps where the sign of b does."""
    return nan if not (b > 0 or b < 0) else sign(a) * sign(b) * da


def rint_(x: Ball) -> Ball:
    """Return the nearest whole number; both where two are as near."""
    shifted = x + _HALF
    down = shifted.floor()
    return down.union(down - one) if shifted.contains_integer() else down


def rint_slope(x: Ball, dx: Ball) -> Ball:
    """Flat or a jump."""
    return nan if (x + _HALF).contains_integer() else zero


def select_(condition: Truth, a: Ball, b: Ball) -> Ball:
    """Return a or b, or both while the choice is open."""
    yes, no, defined = condition
    return a if yes else b if no else a.union(b) if defined else nan


def select_slope(condition: Truth, a: Ball, b: Ball, _: Any, da: Ball, db: Ball) -> Ball:
    """Return the slope of a or b, or both: centres are then both, too."""
    return select_(condition, da, db)


def less_(a: Ball, b: Ball) -> Truth:
    """Return what is known of a < b."""
    return a < b, b <= a, a.is_finite() and b.is_finite()


def less_equal_(a: Ball, b: Ball) -> Truth:
    """Return what is known of a <= b."""
    return a <= b, b < a, a.is_finite() and b.is_finite()


def equal_(a: Ball, b: Ball) -> Truth:
    """Return what is known of a == b."""
    return a <= b and b <= a, a < b or b < a, a.is_finite() and b.is_finite()


def and_(a: Truth, b: Truth) -> Truth:
    """Return whether both hold."""
    return a[0] and b[0], a[1] or b[1], a[2] and b[2]


def or_(a: Truth, b: Truth) -> Truth:
    """Return whether at least one holds."""
    return a[0] or b[0], a[1] and b[1], a[2] and b[2]


def not_(a: Truth) -> Truth:
    """Return whether it does not hold."""
    return a[1], a[0], a[2]


def in_ball(
    radius: float,
) -> Callable[[Ball, Sequence[Ball], Sequence[Ball], Sequence[Ball]], bool]:
    """Return a function that tells whether an output is <= 0 in a box's part with |h| <= radius.

    There f(h) <= f(h) + p (radius^2 - |h|^2) <= c + p (radius^2 - |m|^2) + sum (s_j - 2 p m_j) d_j
    for every p >= 0, m being the box's middle.
    """
    square = arb(radius) * arb(radius)

    def part(
        c: Ball, slopes: Sequence[Ball], middle: Sequence[Ball], reach: Sequence[Ball]
    ) -> bool:
        room = square - sum((m * m for m in middle), zero)
        for slope, side in zip(slopes, middle, strict=True):
            p = float((slope / (side + side)).mid())
            if not 0.0 < p < 1e100:
                continue
            double = arb(2.0 * p)
            terms = zip(slopes, middle, reach, strict=True)
            if c + arb(p) * room + sum(((s - double * m) * d for s, m, d in terms), zero) <= 0:
                return True
        return False

    return part

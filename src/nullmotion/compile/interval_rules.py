"""What each step of recorded source means on intervals.

Roots and quotients are rounded correctly; sin, cos, exp, log, acos and atan2 are good to
1.3 ulp on the tape and to 4 ulp in NumPy: their ends are moved by 8.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import reduce
from typing import Any

from nullmotion import ops
from nullmotion.compile import tape as tp
from nullmotion.compile.interval import (
    TINY,
    Interval,
    Truth,
    Value,
    above,
    below,
    choose,
    greater,
    lesser,
)
from nullmotion.compile.tape import apply, product

_ULPS = 8.0
_TURN = 1.0 / (2.0 * math.pi)
_FAR = 1e5  # rad; beyond it sin and cos promise nothing on the tape


def _rounded(least: Value, most: Value, low: float, high: float, *operands: Interval) -> Interval:
    """Return an elementary function's interval, limited to [low, high] where that is finite."""
    lo, hi = below(least - TINY, _ULPS), above(most + TINY, _ULPS)
    lo = greater(lo, low) if low > -math.inf else lo
    hi = lesser(hi, high) if high < math.inf else hi
    return Interval(lo, hi).defined_with(*operands)


def _wave(x: Interval, function: Callable[[Value], Value], top: float) -> Interval:
    """Return the range of a sine or cosine whose maximum is at 2 pi (n + top).

    A turn n + top, or n + top + 1/2 for the minimum, is inside if the one nearest to the
    middle is; 1e-9 turns are far more than the error of the test.
    """
    half = product(x.hi - x.lo, 0.5 * _TURN) + 1e-9
    middle = product(product(x.lo, 0.5) + product(x.hi, 0.5), _TURN)

    def inside(place: float) -> Value:
        t = middle - place
        return apply("less_equal", abs(t - tp.rint(t)), half)

    # beyond _FAR the argument's place is not told apart well enough
    far = apply("less", _FAR, x.magnitude)
    near = [choose(far, 0.0, v) for v in (x.lo, x.hi)]
    a, b = function(near[0]), function(near[1])
    least = choose(apply("or", far, inside(top + 0.5)), -1.0, lesser(a, b))
    most = choose(apply("or", far, inside(top)), 1.0, greater(a, b))
    return _rounded(least, most, -1.0, 1.0, x)


def sine(x: Interval) -> Interval:
    """Return the range of sin."""
    return _wave(x, ops.sin, 0.25)


def cosine(x: Interval) -> Interval:
    """Return the range of cos."""
    return _wave(x, ops.cos, 0.0)


def _exp(x: Interval) -> Interval:
    return _rounded(ops.exp(x.lo), ops.exp(x.hi), 0.0, math.inf, x)


def _log(x: Interval) -> Interval:
    outside = apply("less_equal", x.lo, 0.0)
    return _rounded(ops.log(x.lo), ops.log(x.hi), -math.inf, math.inf, x).unless(outside)


def _acos(x: Interval) -> Interval:
    outside = apply("or", apply("less", x.lo, -1.0), apply("less", 1.0, x.hi))
    return _rounded(ops.acos(x.hi), ops.acos(x.lo), 0.0, math.inf, x).unless(outside)


def cut_crossed(y: Interval, x: Interval) -> Value:
    """Return whether the box meets the half line x <= 0, y = 0, where the angle jumps."""
    level = apply("and", apply("less_equal", y.lo, 0.0), apply("less_equal", 0.0, y.hi))
    return apply("and", level, apply("less_equal", x.lo, 0.0))


def _atan2(y: Interval, x: Interval) -> Interval:
    corners = [ops.atan2(b, a) for a in (x.lo, x.hi) for b in (y.lo, y.hi)]
    least = lesser(lesser(corners[0], corners[1]), lesser(corners[2], corners[3]))
    most = greater(greater(corners[0], corners[1]), greater(corners[2], corners[3]))
    crossed = cut_crossed(y, x)
    least, most = choose(crossed, -math.pi, least), choose(crossed, math.pi, most)
    return _rounded(least, most, -math.inf, math.inf, y, x)


def _abs(x: Interval) -> Interval:
    least = greater(0.0, greater(x.lo, -x.hi))
    return Interval(least, x.magnitude).defined_with(x)


def _copysign(a: Interval, b: Interval) -> Interval:
    size = _abs(a)
    positive, negative = apply("less", 0.0, b.lo), apply("less", b.hi, 0.0)
    lo = choose(positive, size.lo, -size.hi)
    hi = choose(negative, -size.lo, size.hi)
    return Interval(lo, hi).defined_with(a, b)


def _minimum(a: Interval, b: Interval) -> Interval:
    return Interval(lesser(a.lo, b.lo), lesser(a.hi, b.hi)).defined_with(a, b)


def _maximum(a: Interval, b: Interval) -> Interval:
    return Interval(greater(a.lo, b.lo), greater(a.hi, b.hi)).defined_with(a, b)


def chosen(flag: Value, a: Interval, b: Interval) -> Interval:
    """Return one interval where a flag is set, else the other."""
    return Interval(choose(flag, a.lo, b.lo), choose(flag, a.hi, b.hi))


def _select(condition: Truth, a: Interval, b: Interval) -> Interval:
    either = a.hull(b).unless(apply("not", condition.defined))
    return chosen(condition.yes, a, chosen(condition.no, b, either))


def _compared(yes: Value, no: Value, a: Interval, b: Interval) -> Truth:
    known = [x.bounded for x in (a, b) if not x.constant]
    return Truth(yes, no, reduce(lambda p, q: apply("and", p, q), known, True))


def _less(a: Interval, b: Interval) -> Truth:
    return _compared(apply("less", a.hi, b.lo), apply("less_equal", b.hi, a.lo), a, b)


def _less_equal(a: Interval, b: Interval) -> Truth:
    return _compared(apply("less_equal", a.hi, b.lo), apply("less", b.hi, a.lo), a, b)


def _equal(a: Interval, b: Interval) -> Truth:
    same = apply("and", apply("equal", a.lo, b.hi), apply("equal", a.hi, b.lo))
    apart = apply("or", apply("less", a.hi, b.lo), apply("less", b.hi, a.lo))
    return _compared(same, apart, a, b)


RANGES: dict[str, Callable[..., Any]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "square": lambda a: a.square(),
    "div": lambda a, b: a * b.reciprocal(),
    "neg": lambda a: -a,
    "sqrt": lambda a: a.sqrt(),
    "abs": _abs,
    "minimum": _minimum,
    "maximum": _maximum,
    "sin": sine,
    "cos": cosine,
    "exp": _exp,
    "log": _log,
    "acos": _acos,
    "atan2": _atan2,
    "rint": lambda a: Interval(tp.rint(a.lo), tp.rint(a.hi)),
    "copysign": _copysign,
    "select": _select,
    "less": _less,
    "less_equal": _less_equal,
    "equal": _equal,
    "and": lambda a, b: a.both(b),
    "or": lambda a, b: a.inverse().both(b.inverse()).inverse(),
    "not": lambda a: a.inverse(),
}

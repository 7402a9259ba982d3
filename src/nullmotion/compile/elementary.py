"""Elementary functions as straight-line compositions of tape operations.

Defined once here, they are the same operations in every target, so compiled
kernels and exported C agree bit for bit. A NaN argument gives NaN; signed
zeros and infinities are treated as in C99. ``design/elementary_coefficients.py``
derives every constant and measures the errors given below (in units in the
last place of the exact result, largest found).
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

from nullmotion.compile.tape import (
    Symbol,
    bit,
    copysign,
    equal,
    exponent,
    fma,
    maximum,
    minimum,
    power_of_two,
    select,
    significand,
    sqrt,
)

GUARDED_LIMIT = 1e5  # rad; sin and cos promise nothing beyond it

_ROUND = 1.5 * 2.0**52  # x + _ROUND - _ROUND is x rounded to a whole number, and never -0
_LARGEST = sys.float_info.max
_SMALLEST_NORMAL = sys.float_info.min

_PI_2 = (1.5707963267948966, 6.123233995679432e-17, 5.721188726109832e-27)  # 53 + 33 + 53 bits
_PI_4 = (0.7853981633974483, 0.0)
_LN2 = (0.0, 0.0)
_SIN = ()
_COS = ()
_EXP = ()
_LOG = ()
_ATAN = ()
_ASIN = ()


def _polynomial(x: Symbol, coefficients: Sequence[float]) -> Symbol:
    """Return sum c_j x**j by Horner's rule."""
    result: Symbol | float = coefficients[-1]
    for c in coefficients[-2::-1]:
        result = fma(result, x, c)
    return result  # type: ignore[return-value]


def _paired(x: Symbol, coefficients: Sequence[float]) -> Symbol:
    """Return sum c_j x**j by Horner's rule on pairs: one operation more, half the latency."""
    pairs = [_polynomial(x, coefficients[j : j + 2]) for j in range(0, len(coefficients), 2)]
    square = x * x
    result = pairs[-1]
    for pair in pairs[-2::-1]:
        result = fma(result, square, pair)
    return result


def _reduce(x: Symbol) -> tuple[Symbol, Symbol, Symbol]:
    """Return k, r, t with x = k π/2 + r - t, |r| <= π/4 (1 + 1e-10), |t| <= ulp(r)/2.

    x - k p0 is exact because both are multiples of 2**-53 and the difference is
    below 1; k p1 is exact because p1 has 33 bits. So r - t has at least 100 good
    bits, and no cancellation hurts (the nearest to kπ/2 a double comes below
    1e5 is about 1e-17).
    """
    k = fma(x, 2.0 / math.pi, _ROUND) - _ROUND
    first = fma(k, -_PI_2[0], x)
    r = fma(k, -_PI_2[1], first)
    t = fma(k, _PI_2[2], fma(k, _PI_2[1], r - first))
    return k, r, t


def _quadrant(x: Symbol) -> tuple[Symbol, Symbol, Symbol]:
    """Return k, sin(r - t) and cos(r - t); polynomials in z = -(r - t)**2.

    The products with +0 and the order of signs keep sin(-0) = -0.
    """
    k, r, t = _reduce(x)
    z = fma(-r, r, fma(r + r, t, 0.0))
    sine = r + fma(r * z, _polynomial(z, _SIN), -t)
    cosine = fma(z, fma(z, _polynomial(z, _COS), 0.5), 1.0)
    return k, sine, cosine


def sin(x: Symbol) -> Symbol:
    """Return sin x for |x| <= 1e5 rad; error below @sin@ ulp.

    Reduction by multiples of π/2 in 139 bits, odd polynomial of degree 13.
    """
    k, sine, cosine = _quadrant(x)
    result = select(bit(k, 0), cosine, sine)
    return select(bit(k, 1), -result, result)


def cos(x: Symbol) -> Symbol:
    """Return cos x for |x| <= 1e5 rad; error below @cos@ ulp.

    Shares all but the last step with `sin`; even polynomial of degree 14.
    """
    k, sine, cosine = _quadrant(x)
    result = select(bit(k, 0), sine, cosine)
    return select(bit(k + 1.0, 1), -result, result)


def exp(x: Symbol) -> Symbol:
    """Return e**x for every x; error below @exp@ ulp (@expsub@ where the result is subnormal).

    x = k ln 2 + r, polynomial of degree 11 in r, and 2**k in two steps, so that
    the result overflows to infinity and underflows gradually by itself.
    """
    x = minimum(710.0, maximum(-746.0, x))
    k = fma(x, 1.0 / math.log(2.0), _ROUND) - _ROUND
    r = fma(k, -_LN2[1], fma(k, -_LN2[0], x))
    result = fma(r, fma(r, _paired(r, _EXP), 1.0), 1.0)
    half = fma(k, 0.5, _ROUND) - _ROUND
    return result * power_of_two(half) * power_of_two(k - half)

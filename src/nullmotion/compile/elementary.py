"""Elementary functions as straight-line compositions of tape operations.

Defined once here, they are the same operations in every target, so compiled
kernels and exported C agree bit for bit. A NaN argument gives NaN; signed
zeros and infinities are treated as in C99. ``design/elementary_coefficients.py``
derives the constants and measures the errors given below (in units in the last
place of the exact result; largest found, rounded up).
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any

from nullmotion.compile.tape import (
    Symbol,
    copysign,
    equal,
    exponent,
    flip,
    fma,
    guard,
    maximum,
    minimum,
    power_of_two,
    product,
    raw_bit,
    rsqrt_guess,
    select,
    significand,
    sqrt,
)

GUARDED_LIMIT = 1e5  # rad; sin and cos promise nothing beyond it

_ROUND = 1.5 * 2.0**52  # x + _ROUND - _ROUND is x rounded to a whole number, and never -0
_LARGEST = sys.float_info.max
_SMALLEST_NORMAL = sys.float_info.min

# constants in parts, the first ones short, so that their multiples by k or j are exact
_PI_2 = (1.5707963267948966, 6.12323399538461e-17, 3.5215598651832e-27)
_PI_4 = (0.7853981633974483, 3.061616997868383e-17)
_LN2 = (0.6931471805598903, 5.497923018708371e-14)
# fmt: off
# polynomial coefficients, lowest power first
_SIN = (
    0.1666666666666663, 0.008333333333322116, 0.00019841269829588563, 2.7557313621079626e-06,
    2.5050747719608165e-08, 1.5896227898748953e-10,
)
_COS = (
    0.041666666666666595, 0.0013888888888873058, 2.480158728885259e-05, 2.7557314179558865e-07,
    2.0875700878275175e-09, 1.1358538432369307e-11,
)
_EXP = (
    0.5000000000000011, 0.16666666666666413, 0.04166666666653027, 0.008333333333494203,
    0.0013888888943595656, 0.0001984126950705135, 2.4801493138649113e-05, 2.7557586032422622e-06,
    2.763023294485598e-07, 2.5000143430251545e-08,
)
_LOG = (
    0.6666666666666734, 0.399999999994164, 0.2857142874201069, 0.22222198611194058,
    0.18183562384440802, 0.15314099395356592, 0.14795469018654078,
)
_ATAN = (
    -0.33333333333333315, 0.19999999999993268, -0.14285714284960938, 0.11111111068562785,
    -0.09090907669722886, 0.07692277079543529, -0.06666219000901927, 0.05877771367468846,
    -0.052298200685004605, 0.04588749962997304, -0.037102480456469425, 0.023633014765179896,
    -0.008352523484375627,
)
_ASIN = (
    0.16666666666665408, 0.07500000000336998, 0.044642856828333605, 0.03038195913689131,
    0.022371758050551763, 0.0173597047758075, 0.013885235260529559, 0.012169213330680037,
    0.00652796681757796, 0.019528291282746336, -0.016224298376242133, 0.0319123042659134,
)
_RSQRT = (0.5, 0.375, 0.3125, 0.2734375)  # of (1 - e)**(-1/2)
# fmt: on


def _named(function: Callable[..., Symbol]) -> Callable[..., Symbol]:
    """Let the tape remember of which arguments a node is this function."""

    @wraps(function)
    def named(*args: Any, **options: Any) -> Symbol:
        result = function(*args, **options)
        if isinstance(result, Symbol):
            tape, reals = result.tape, [a for a in args if not isinstance(a, bool)]
            ids = [a.node if isinstance(a, Symbol) else tape.constant(a) for a in reals]
            tape.remember(function.__name__, tuple(ids), result.node)
        return result

    return named


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
    """Return b, r, t with x = k π/2 + r - t, r in [-π/4, π/4], t far smaller, k in b's low bits.

    x - k p0 is exact: both are multiples of 2**-53 and the difference is below 1.
    k p1 is exact: p1 has 33 bits. The last part leaves an error below 1e-37, while
    no double below 1e5 comes nearer to a multiple of π/2 than 6e-19.
    """
    guard("angle-range", abs(x) <= GUARDED_LIMIT)
    biased = fma(x, 2.0 / math.pi, _ROUND)
    k = biased - _ROUND
    first = fma(k, -_PI_2[0], x)
    r = fma(k, -_PI_2[1], first)
    t = fma(k, _PI_2[2], fma(k, _PI_2[1], r - first))
    return biased, r, t


def _quadrant(x: Symbol) -> tuple[Symbol, Symbol, Symbol]:
    """Return b, sin(r - t) and cos r, by polynomials in z = -r**2.

    t is left out where it changes less than an ulp. The added 0.0 makes z = +0 at
    r = 0, so that sin(-0) = -0 at no cost.
    """
    biased, r, t = _reduce(x)
    z = fma(-r, r, 0.0)
    sine = r + fma(product(r, z), _polynomial(z, _SIN), -t)
    cosine = fma(z, fma(z, _polynomial(z, _COS), 0.5), 1.0)
    return biased, sine, cosine


@_named
def sin(x: Symbol) -> Symbol:
    """Return sin x for |x| <= 1e5 rad; error below 1.3 ulp.

    Reduction by multiples of π/2 in 139 bits, odd polynomial of degree 13.
    """
    b, sine, cosine = _quadrant(x)
    return flip(select(raw_bit(b, 0), cosine, sine), b, 1)


@_named
def cos(x: Symbol) -> Symbol:
    """Return cos x for |x| <= 1e5 rad; error below 1.3 ulp.

    Shares all but the last step with `sin`; even polynomial of degree 14.
    """
    b, sine, cosine = _quadrant(x)
    return flip(select(raw_bit(b, 0), -sine, cosine), b, 1)


@_named
def rsqrt(x: Symbol, rough: bool = False) -> Symbol:
    """Return 1/sqrt(x); error below 1.2 ulp, or 4e-7 if rough.

    For normal x > 0; a large finite number below, so that x rsqrt(x) vanishes at 0.

    A guess from the bits, then steps of order five and three: products and sums alone,
    which pipeline where division and square root do not, and the same on every CPU.
    """
    y = rsqrt_guess(x)
    for series in (_RSQRT,) if rough else (_RSQRT, _RSQRT[:2]):
        e = fma(-(product(x, y)), y, 1.0)
        y = fma(product(y, e), _polynomial(e, series), y)
    return y


@_named
def exp(x: Symbol) -> Symbol:
    """Return e**x for every x; error below 0.95 ulp.

    x = k ln 2 + r, polynomial of degree 11 in r, and 2**k in two steps, so that
    the result overflows to infinity and underflows gradually by itself.
    """
    x = minimum(710.0, maximum(-746.0, x))
    k = fma(x, 1.0 / math.log(2.0), _ROUND) - _ROUND
    r = fma(k, -_LN2[1], fma(k, -_LN2[0], x))
    result = fma(r, fma(r, _paired(r, _EXP), 1.0), 1.0)
    half = fma(k, 0.5, _ROUND) - _ROUND
    return result * power_of_two(half) * power_of_two(k - half)


@_named
def log(x: Symbol) -> Symbol:
    """Return the natural logarithm; error below 0.75 ulp. -inf at 0, NaN below.

    x = 2**k (1 + f) with 1 + f in [sqrt(1/2), sqrt 2]; log(1 + f) = 2 atanh(s) with
    s = f/(2 + f), written as f - (f**2/2 - s (f**2/2 + R(s**2))); k ln 2 + f is
    added without error.
    """
    subnormal = x < _SMALLEST_NORMAL
    normal = select(subnormal, x * 2.0**54, x)
    k, m = exponent(normal), significand(normal)
    upper = m > math.sqrt(2.0)
    f = select(upper, 0.5 * m, m) - 1.0
    k = select(upper, k + 1.0, k) - select(subnormal, 54.0, 0.0)
    s = f / (2.0 + f)
    z = s * s
    h = 0.5 * f
    total = fma(k, _LN2[0], f)
    rest = fma(k, _LN2[1], f - fma(k, -_LN2[0], total))
    rest = fma(s, fma(h, f, z * _paired(z, _LOG)), rest)
    result = total + fma(-h, f, rest)
    result = select(x < math.inf, result, x)
    return select(x > 0.0, result, select(equal(x, 0.0), -math.inf, math.nan))


@_named
def atan2(y: Symbol, x: Symbol) -> Symbol:
    """Return the angle of the point (x, y), C99's atan2; error below 0.90 ulp.

    The quotient n/d of the smaller by the larger coordinate, above 1/2 replaced by
    (n - d)/(n + d), is corrected by its remainder; odd polynomial of degree 27.
    The angle is j π/4 plus its arc tangent.
    """
    a, b = abs(y), abs(x)
    swap = a > b
    small, large = select(swap, b, a), select(swap, a, b)
    infinite = large > _LARGEST
    # exact scaling: the sum below stays finite, the remainder does not underflow
    scale = select(large < 1.0, 2.0**110, select(small > 1.0, 0.5, 1.0))
    n = select(small > _LARGEST, 1.0, small * select(infinite, 0.0, scale))
    d = select(infinite | equal(large, 0.0), 1.0, large * scale)

    side = copysign(1.0, x)
    turn = select(swap, -side, side)
    shift = n + n > d
    added = select(shift, n, 0.0)
    top, bottom = turn * (n - select(shift, d, 0.0)), d + added  # the difference is exact
    q = top / bottom
    remainder = fma(-q, (d - bottom) + added, fma(-q, bottom, top))

    j = select(swap, 2.0, 2.0 - (side + side)) + select(shift, turn, 0.0)
    z = q * q
    rest = fma(q * z, _paired(z, _ATAN), fma(j, _PI_4[1], remainder / bottom))
    return copysign(fma(j, _PI_4[0], q + rest), y)


@_named
def acos(x: Symbol) -> Symbol:
    """Return the arc cosine; error below 0.85 ulp. NaN outside [-1, 1].

    π/2 - asin(x) up to 1/2, beyond it 2 asin(sqrt((1 - |x|)/2)), the root corrected
    by its remainder; polynomial of degree 25 for asin on [0, 1/2].
    """
    a = abs(x)
    outer = a > 0.5
    half = fma(-0.5, a, 0.5)
    root = sqrt(half)
    lost = fma(-root, root, half) / copysign(maximum(2.0**-100, root), x)
    z = select(outer, half, x * x)
    v = select(outer, copysign(root + root, x), -x)
    j = select(outer, select(x < 0.0, 2.0, 0.0), 1.0)
    rest = fma(v * z, _paired(z, _ASIN), fma(j, 2.0 * _PI_4[1], select(outer, lost, 0.0)))
    return fma(j, 2.0 * _PI_4[0], v + rest)

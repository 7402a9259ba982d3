"""The operations that source shares between floats, arrays and symbols.

NumPy's own arithmetic and ``np.sin`` and the like work on all of them; what
needs a decision (comparisons, where, min, max, clip, sign) goes through here.
A minimum or maximum returns its *second* operand when either is NaN, on every
target; `clip` keeps a NaN.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from nullmotion.compile import elementary
from nullmotion.compile import tape as _tape
from nullmotion.compile.tape import Symbol

Value = Any  # a float, a Symbol, or an array of either


def is_symbolic(*values: Value) -> bool:
    """Return whether any value is a symbol or an array that holds objects."""
    return any(isinstance(v, Symbol) or getattr(v, "dtype", None) == object for v in values)


def _elementwise(function: Callable[..., Any], *values: Value) -> Value:
    if any(np.ndim(v) for v in values):
        return np.frompyfunc(function, len(values), 1)(*values)
    return function(*[v[()] if isinstance(v, np.ndarray) else v for v in values])


def _mapped(function: Callable[[Any], Any], x: Value) -> Value:
    """Return a function of each element: NumPy's own needs arrays of symbols without floats."""
    if getattr(x, "dtype", None) == object:
        return np.frompyfunc(function, 1, 1)(x)
    return function(x)


def where(condition: Value, a: Value, b: Value) -> Value:
    """Return a where the condition holds, else b."""
    if is_symbolic(condition, a, b):
        return _elementwise(_tape.select, condition, a, b)
    if np.ndim(condition) or np.ndim(a) or np.ndim(b):
        return np.where(condition, a, b)
    return a if condition else b


def less(a: Value, b: Value) -> Value:
    """Return a < b."""
    if is_symbolic(a, b):
        return _elementwise(lambda x, y: _tape.apply("less", x, y), a, b)
    return np.less(a, b)


def less_equal(a: Value, b: Value) -> Value:
    """Return a <= b."""
    if is_symbolic(a, b):
        return _elementwise(lambda x, y: _tape.apply("less_equal", x, y), a, b)
    return np.less_equal(a, b)


def greater(a: Value, b: Value) -> Value:
    """Return a > b."""
    return less(b, a)


def greater_equal(a: Value, b: Value) -> Value:
    """Return a >= b."""
    return less_equal(b, a)


def equal(a: Value, b: Value) -> Value:
    """Return a == b."""
    if is_symbolic(a, b):
        return _elementwise(_tape.equal, a, b)
    return np.equal(a, b)


def logical_and(a: Value, b: Value) -> Value:
    """Return whether both hold."""
    if is_symbolic(a, b):
        return _elementwise(lambda x, y: _tape.apply("and", x, y), a, b)
    return np.logical_and(a, b)


def logical_or(a: Value, b: Value) -> Value:
    """Return whether at least one holds."""
    if is_symbolic(a, b):
        return _elementwise(lambda x, y: _tape.apply("or", x, y), a, b)
    return np.logical_or(a, b)


def logical_not(a: Value) -> Value:
    """Return whether it does not hold."""
    if is_symbolic(a):
        return _elementwise(lambda x: _tape.apply("not", x), a)
    return np.logical_not(a)


def minimum(a: Value, b: Value) -> Value:
    """Return the smaller; b when either is NaN."""
    return where(less(a, b), a, b)


def maximum(a: Value, b: Value) -> Value:
    """Return the larger; b when either is NaN."""
    return where(less(b, a), a, b)


def clip(x: Value, low: Value, high: Value) -> Value:
    """Return x limited to [low, high]; a NaN stays."""
    return minimum(high, maximum(low, x))


def amin(x: Value) -> Value:
    """Return the least element of a one-dimensional array."""
    result = x[..., 0][()]
    for i in range(1, x.shape[-1]):
        result = minimum(result, x[..., i][()])
    return result


def amax(x: Value) -> Value:
    """Return the greatest element of a one-dimensional array."""
    result = x[..., 0][()]
    for i in range(1, x.shape[-1]):
        result = maximum(result, x[..., i][()])
    return result


def sign(x: Value) -> Value:
    """Return -1, 0 or 1."""
    return where(less(0.0, x), 1.0, where(less(x, 0.0), -1.0, 0.0))


def absolute(x: Value) -> Value:
    """Return |x|."""
    return _mapped(np.abs, x)


def sin(x: Value) -> Value:
    """Return sin x; |x| up to 1e5 rad on the tape."""
    return _mapped(np.sin, x)


def cos(x: Value) -> Value:
    """Return cos x; |x| up to 1e5 rad on the tape."""
    return _mapped(np.cos, x)


def exp(x: Value) -> Value:
    """Return e**x."""
    return _mapped(np.exp, x)


def log(x: Value) -> Value:
    """Return the natural logarithm."""
    return _mapped(np.log, x)


def sqrt(x: Value) -> Value:
    """Return the square root."""
    return _mapped(np.sqrt, x)


def rsqrt(x: Value, rough: bool = False) -> Value:
    """Return 1/sqrt(x) for x >= 0; large and finite at 0, so that x rsqrt(x) is 0 there.

    On the tape it is made of products and sums alone, which keep the pipelines full where
    divisions and roots stall them. A rough one is good to 4e-7 there.
    """
    if is_symbolic(x):
        return _elementwise(lambda v: elementary.rsqrt(v, rough), x)
    return 1.0 / np.sqrt(np.maximum(x, 1e-300))


def rint(x: Value) -> Value:
    """Return the nearest whole number, ties to even."""
    if is_symbolic(x):
        return _elementwise(_tape.rint, x)
    return np.rint(x)


def copysign(a: Value, b: Value) -> Value:
    """Return |a| with the sign of b."""
    if is_symbolic(a, b):
        return _elementwise(_tape.copysign, a, b)
    return np.copysign(a, b)


def acos(x: Value) -> Value:
    """Return the arc cosine."""
    return _mapped(np.arccos, x)


def atan2(y: Value, x: Value) -> Value:
    """Return the angle of the point (x, y)."""
    if is_symbolic(y, x):
        tape = next(v.tape for v in _leaves(y, x) if isinstance(v, Symbol))
        lift = np.frompyfunc(
            lambda v: v if isinstance(v, Symbol) else Symbol(tape, tape.constant(v)), 1, 1
        )
        return np.arctan2(lift(y), lift(x))
    return np.arctan2(y, x)


def _leaves(*values: Value) -> list[Any]:
    return [leaf for v in values for leaf in np.asarray(v, dtype=object).ravel()]


def power(x: Value, p: float) -> Value:
    """Return x**p for x >= 0: by products when p is whole, a root for 1/2, else exp(p log x)."""
    if p == 0.5:
        return _mapped(np.sqrt, x)
    if float(p).is_integer():
        return _elementwise(lambda v: _tape.integer_power(v, p), x)
    positive = less(0.0, x)
    return where(positive, exp(p * log(where(positive, x, 1.0))), 0.0)


def constant_like(value: float, x: Value) -> Value:
    """Return an array of x's shape filled with a float (works when x holds symbols)."""
    return np.full(np.shape(x), value)

"""One rule of differentiation for each tape operation and each elementary function.

A rule takes the result y, the operands x and their tangents t (None where an operand
stays as it is) and returns the tangent of y, on floats and symbols alike. Where a
function has no derivative the rule gives that of one side, or 0 where it would be
infinite: a root at 0, an angle at the origin. What is ``FLAT``, comparisons among it, has
no tangent; a `select` takes that of what it selects.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from nullmotion import ops
from nullmotion.compile import tape as tp

Value = Any  # float or Symbol
Tangent = Any  # float or Symbol; None: no change
Rule = Callable[[Value, Sequence[Value], Sequence[Tangent]], Tangent]


def plus(a: Tangent, b: Tangent) -> Tangent:
    """Return a + b."""
    return b if a is None else a if b is None else a + b


def minus(a: Tangent, b: Tangent) -> Tangent:
    """Return a - b."""
    return a if b is None else -b if a is None else a - b


def times(t: Tangent, factor: Value) -> Tangent:
    """Return t times a value."""
    return None if t is None else t * factor


def _mul(y: Value, x: Sequence[Value], t: Sequence[Tangent]) -> Tangent:
    return plus(times(t[0], x[1]), times(t[1], x[0]))


def _div(y: Value, x: Sequence[Value], t: Sequence[Tangent]) -> Tangent:
    change = minus(t[0], times(t[1], y))
    return None if change is None else change / x[1]


def _fma(y: Value, x: Sequence[Value], t: Sequence[Tangent]) -> Tangent:
    return plus(_mul(y, x, t), t[2])


def _select(y: Value, x: Sequence[Value], t: Sequence[Tangent]) -> Tangent:
    a, b = (0.0 if v is None else v for v in t[1:])
    return None if t[1] is t[2] is None else tp.select(x[0], a, b)


def _sqrt(y: Value, x: Sequence[Value], t: Sequence[Tangent]) -> Tangent:
    return ops.where(ops.less(0.0, y), 0.5 * t[0], 0.0) / ops.where(ops.less(0.0, y), y, 1.0)


def _rsqrt(y: Value, x: Sequence[Value], t: Sequence[Tangent]) -> Tangent:
    return y * (y * (y * (-0.5 * t[0])))  # in this order 0 where nothing changes, whatever y


def _atan2(y: Value, x: Sequence[Value], t: Sequence[Tangent]) -> Tangent:
    square = x[0] * x[0] + x[1] * x[1]
    off = ops.less(0.0, square)
    turned = minus(times(t[0], x[1]), times(t[1], x[0]))
    return ops.where(off, turned, 0.0) / ops.where(off, square, 1.0)


def _acos(y: Value, x: Sequence[Value], t: Sequence[Tangent]) -> Tangent:
    square = (1.0 - x[0]) * (1.0 + x[0])
    inside = ops.less(0.0, square)
    return -ops.where(inside, t[0], 0.0) / ops.sqrt(ops.where(inside, square, 1.0))


RULES: dict[str, Rule] = {
    "add": lambda y, x, t: plus(t[0], t[1]),
    "sub": lambda y, x, t: minus(t[0], t[1]),
    "mul": _mul,
    "product": _mul,
    "div": _div,
    "neg": lambda y, x, t: -t[0],
    "fma": _fma,
    "select": _select,
    "sqrt": _sqrt,
    "fabs": lambda y, x, t: t[0] * tp.copysign(1.0, x[0]),
    "copysign": lambda y, x, t: times(t[0], tp.copysign(1.0, x[0]) * tp.copysign(1.0, x[1])),
    "flip": lambda y, x, t: None if t[0] is None else tp.apply("flip", t[0], x[1], x[2]),
    "sin": lambda y, x, t: t[0] * ops.cos(x[0]),
    "cos": lambda y, x, t: -(t[0] * ops.sin(x[0])),
    "exp": lambda y, x, t: t[0] * y,
    "log": lambda y, x, t: t[0] / x[0],
    "rsqrt": _rsqrt,
    "atan2": _atan2,
    "acos": _acos,
}

FLAT = frozenset({"input", "constant", "less", "less_equal", "equal", "and", "or", "not", "rint"})

"""Slopes: how far recorded source can move from its value at a point.

For every x of a box with the point c inside, a number y of the source is held by

    y(x) in C + S (x - c),    y(x) in R:    at the centre, slopes, range.

A product f g has the slopes S_f R_g + C_f S_g, as f g - c_f c_g = (f - c_f) g + c_f (g - c_g);
a square has R + C, a quotient y = f/g has (S_f - C_y S_g)/R_g, a root 1/(R_y + C_y). These are
about half as wide as derivatives over the box, and need no derivative: C may be the set of two
branches' values, so that a choice that is open holds even where the source jumps. What is
smooth otherwise has its derivative over R.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

from nullmotion.compile.interval import TINY, Interval, Truth, Value, choose, point
from nullmotion.compile.interval_ball import ONE, UP, ZERO, Ball, Slope, ball
from nullmotion.compile.interval_rules import cosine, cut_crossed, sine
from nullmotion.compile.tape import apply, product


@dataclass(frozen=True, eq=False)
class Held:
    """What is known of one number of the source; slopes are empty for what is constant."""

    centre: Interval
    range: Interval
    slopes: Sequence[Slope]

    @cached_property
    def C(self) -> Ball:
        """Centre as a ball."""
        return ball(self.centre)

    @cached_property
    def R(self) -> Ball:
        """Range as a ball."""
        return ball(self.range)

    def within(self, radii: Sequence[Value]) -> Interval:
        """Return the range cut down to C + S (x - c), |x - c| <= radii."""
        pairs = zip(self.slopes, radii, strict=True)
        moves = [product(s.magnitude, r) for s, r in pairs if s is not None]
        reach = product(sum(moves) + TINY, UP)
        return self.range.meet(self.centre + Interval(-reach, reach))


Rule = Callable[..., Slope]  # slopes of the operands along one axis -> slope of the result


def plus(a: Slope, b: Slope) -> Slope:
    """Return a + b."""
    return b if a is None else a if b is None else a + b


def minus(a: Slope, b: Slope) -> Slope:
    """Return a - b."""
    return a if b is None else plus(a, -b)


def times(a: Slope, factor: Ball) -> Slope:
    """Return a times a number."""
    return None if a is None else factor if a is ONE else a * factor


def _mul(y: Held, f: Held, g: Held) -> Rule:
    return lambda a, b: plus(times(a, g.R), times(b, f.C))


def _div(y: Held, f: Held, g: Held) -> Rule:
    inverse = ball(g.range.reciprocal())
    return lambda a, b: times(minus(a, times(b, y.C)), inverse)


def _factor(slope: Callable[[Held, Held], Interval]) -> Callable[[Held, Held], Rule]:
    """Return the rule of a function of one number from its slope."""

    def rule(y: Held, x: Held) -> Rule:
        factor = ball(slope(y, x))
        return lambda a: times(a, factor)

    return rule


def _acos(y: Held, x: Held) -> Interval:
    one = point(1.0)
    return -((one - x.range) * (one + x.range)).sqrt().reciprocal()


def _sign(x: Interval) -> Interval:
    """Return the slope of |x|."""
    lo = choose(apply("less_equal", 0.0, x.lo), 1.0, -1.0)
    return Interval(lo, choose(apply("less_equal", x.hi, 0.0), -1.0, 1.0))


def _atan2(z: Held, y: Held, x: Held) -> Rule:
    norm = (y.range.square() + x.range.square()).reciprocal()
    inverse = ball(norm.unless(cut_crossed(y.range, x.range)))
    return lambda a, b: times(minus(times(a, x.R), times(b, y.R)), inverse)


def _either(yes: Value, no: Value, defined: Value) -> Rule:
    """Return the rule of a choice between two numbers: of both while it is open."""

    def rule(a: Slope, b: Slope) -> Slope:
        first, second = (ZERO if s is None else s for s in (a, b))
        both = first.hull(second).unless(apply("not", defined))
        picked = [(first.mid, second.mid, both.mid), (first.rad, second.rad, both.rad)]
        return Ball(*(choose(yes, p, choose(no, q, r)) for p, q, r in picked))

    return rule


def _select(y: Held, condition: Truth, f: Held, g: Held) -> Rule:
    choice = _either(condition.yes, condition.no, condition.defined)
    return lambda _, a, b: choice(a, b)


def _lesser(y: Held, f: Held, g: Held) -> Rule:
    a, b = f.range, g.range
    return _either(apply("less_equal", a.hi, b.lo), apply("less_equal", b.hi, a.lo), True)


def _greater(y: Held, f: Held, g: Held) -> Rule:
    a, b = f.range, g.range
    return _either(apply("less_equal", b.hi, a.lo), apply("less_equal", a.hi, b.lo), True)


def _copysign(y: Held, f: Held, g: Held) -> Rule:
    """Jumps where the sign does."""
    lo, hi = g.range.lo, g.range.hi
    known = apply("or", apply("less", 0.0, lo), apply("less", hi, 0.0))
    factor = ball(_sign(f.range) * _sign(g.range)).unless(apply("not", known))
    return lambda a, b: times(ZERO if a is None else a, factor)


def _rint(y: Held, x: Held) -> Rule:
    """Flat or a jump."""
    step = ZERO.unless(apply("not", apply("equal", y.range.lo, y.range.hi)))
    return lambda a: step


SLOPES: dict[str, Callable[..., Rule]] = {
    "add": lambda y, f, g: plus,
    "sub": lambda y, f, g: minus,
    "neg": lambda y, x: lambda a: None if a is None else -a,
    "mul": _mul,
    "div": _div,
    "square": _factor(lambda y, x: x.range + x.centre),
    "sqrt": _factor(lambda y, x: (y.range + y.centre).reciprocal()),
    "abs": _factor(lambda y, x: _sign(x.range)),
    "minimum": _lesser,
    "maximum": _greater,
    "select": _select,
    "sin": _factor(lambda y, x: cosine(x.range)),
    "cos": _factor(lambda y, x: -sine(x.range)),
    "exp": _factor(lambda y, x: y.range),
    "log": _factor(lambda y, x: x.range.reciprocal()),
    "acos": _factor(_acos),
    "atan2": _atan2,
    "copysign": _copysign,
    "rint": _rint,
}

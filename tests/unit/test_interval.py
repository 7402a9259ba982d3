"""Enclosures against mpmath and exact fractions: nothing outside, nothing where it is undefined."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import pytest

from nullmotion import ops
from nullmotion.compile import tape as tp
from nullmotion.compile.enclosing import enclosing
from nullmotion.errors import TraceError

mp = mpmath.mp.clone()
mp.dps = 50


class UndefinedError(Exception):
    """A number that does not exist."""


def need(condition: bool) -> None:
    if not condition:
        raise UndefinedError


def whole_number(x: Any) -> Any:
    down = mp.floor(x)
    rest = x - down
    up = rest > 0.5 or (rest == 0.5 and int(down) % 2)
    return down + 1 if up else down


def divided(a: Any, b: Any) -> Any:
    need(b != 0)
    return a / b


def on_domain(inside: Any, function: Any) -> Any:
    def value(x: Any) -> Any:
        need(inside(x))
        return function(x)

    return value


# name: (source, meaning in mpmath)
UNARY = {
    "negative": (lambda x: -x, lambda x: -x),
    "square": (lambda x: x * x, lambda x: x * x),
    "cube": (lambda x: x**3, lambda x: x * x * x),
    "fourth": (lambda x: x**4, lambda x: x**4),
    "inverse": (lambda x: 1.0 / x, lambda x: divided(mp.mpf(1), x)),
    "scaled": (lambda x: -2.7 * x + 0.3, lambda x: mp.mpf(-2.7) * x + mp.mpf(0.3)),
    "abs": (ops.absolute, abs),
    "sqrt": (ops.sqrt, on_domain(lambda x: x >= 0, mp.sqrt)),
    "rsqrt": (ops.rsqrt, on_domain(lambda x: x > 0, lambda x: 1 / mp.sqrt(x))),
    "sin": (ops.sin, mp.sin),
    "cos": (ops.cos, mp.cos),
    "exp": (ops.exp, mp.exp),
    "log": (ops.log, on_domain(lambda x: x > 0, mp.log)),
    "acos": (ops.acos, on_domain(lambda x: abs(x) <= 1, mp.acos)),
    "rint": (ops.rint, whole_number),
    "sign": (ops.sign, mp.sign),
    "limited": (lambda x: ops.clip(x, -0.6, 0.7), lambda x: min(max(x, mp.mpf(-0.6)), mp.mpf(0.7))),
}
BINARY = {
    "add": (lambda a, b: a + b, lambda a, b: a + b),
    "sub": (lambda a, b: a - b, lambda a, b: a - b),
    "mul": (lambda a, b: a * b, lambda a, b: a * b),
    "div": (lambda a, b: a / b, divided),
    "minimum": (ops.minimum, min),
    "maximum": (ops.maximum, max),
    "atan2": (ops.atan2, lambda a, b: mp.atan2(a, b) if a or b else mp.mpf(0)),
    "copysign": (ops.copysign, lambda a, b: abs(a) if b >= 0 else -abs(a)),
    "chosen": (
        lambda a, b: ops.where(ops.less(a, 0.5 * b), a + b, -2.0 * b),
        lambda a, b: a + b if a < b / 2 else -2 * b,
    ),
    "between": (
        lambda a, b: ops.where(
            ops.logical_and(ops.less_equal(-1.0, a + b), ops.logical_not(ops.less(b, a))), b, -a
        ),
        lambda a, b: b if a + b >= -1 and not b < a else -a,
    ),
}


def grown(rng: np.random.Generator, size: int, depth: int) -> Any:
    """Return a random expression: a tree of names and inputs, constants beside them."""
    if depth == 0 or rng.uniform() < 0.1:
        return int(rng.integers(size))
    first = grown(rng, size, depth - 1)
    second = grown(rng, size, depth - 1) if rng.uniform() < 0.8 else float(rng.normal())
    if rng.uniform() < 0.4 or first == second:  # x - x is the constant 0 on the tape
        return (str(rng.choice(list(UNARY))), first)
    pair = (first, second) if rng.uniform() < 0.5 else (second, first)
    return (str(rng.choice(list(BINARY))), *pair)


def evaluated(tree: Any, x: Any, which: int) -> Any:
    """Return an expression's value in source (0) or mpmath (1)."""
    if isinstance(tree, int):
        return x[tree]
    if isinstance(tree, float):
        return mp.mpf(tree) if which else tree
    operands = [evaluated(t, x, which) for t in tree[1:]]
    return (UNARY | BINARY)[tree[0]][which](*operands)


def boxes_of(rng: np.random.Generator, count: int, size: int) -> np.ndarray:
    """Return random boxes of all sizes, points among them, some with ends at 0 or 1."""
    middle = rng.normal(size=(count, size)) * 1.5
    width = 10.0 ** rng.uniform(-9, 0.5, (count, 1)) * rng.uniform(0, 1, (count, size))
    width[::5] = 0.0
    boxes = np.stack([middle - width, middle + width], axis=1)
    return np.where(rng.uniform(size=boxes.shape) < 0.1, np.round(boxes), boxes)


def check_inside(trees: list[Any], boxes: np.ndarray, bounds: Any, rng: np.random.Generator) -> int:
    """Hold exact values at points of the boxes against bounds; return how many exist."""
    lower, upper = bounds
    found = 0
    for b, box in enumerate(boxes):
        corners = rng.uniform(size=(5, box.shape[1])).round(rng.integers(2) * 20)
        points = box[0] + corners * (box[1] - box[0])
        points[:2] = np.where(corners[:2] > 0.5, box[1], box[0])
        for point in np.clip(points, box[0], box[1]):
            for k, tree in enumerate(trees):
                low, high = lower[b, k], upper[b, k]
                assert low <= high
                try:
                    value = evaluated(tree, [mp.mpf(v) for v in point.tolist()], 1)
                except UndefinedError:
                    assert low == -np.inf and high == np.inf, (tree, box, point)
                    continue
                found += 1
                assert low <= value <= high, (tree, box, point)
    return found


@pytest.mark.parametrize("name", [*UNARY, *BINARY])
def test_every_operation_encloses_the_exact_values(name, rng):
    size = 1 if name in UNARY else 2
    tree = (name, *range(size))
    boxes = np.sort(boxes_of(rng, 40, size), axis=1)
    for derivatives in (False, True):
        e = enclosing(
            lambda x: evaluated(tree, x, 0), size, derivatives=derivatives, compiled=False
        )
        assert check_inside([tree], boxes, e(boxes), rng) > 20


@pytest.mark.parametrize("size", [1, 2, 3])
def test_random_programs_enclose_the_exact_values(size, rng):
    boxes = np.sort(boxes_of(rng, 12, size), axis=1)
    existing = 0
    for _ in range(6):
        trees = [grown(rng, size, 5) for _ in range(3)]
        for derivatives in (False, True):
            e = enclosing(
                lambda x, trees=trees: [evaluated(t, x, 0) for t in trees],
                size,
                derivatives=derivatives,
                compiled=False,
            )
            existing += check_inside(trees, boxes, e(boxes), rng)
    assert existing > 1000


def test_the_centre_is_enclosed_too(rng):
    boxes = np.sort(boxes_of(rng, 30, 2), axis=1)
    trees = [grown(rng, 2, 3) for _ in range(6)]
    e = enclosing(lambda x: [evaluated(t, x, 0) for t in trees], 2, compiled=False)
    found = e.enclosure(boxes)
    middles = 0.5 * boxes[:, :1] + 0.5 * boxes[:, 1:]
    at = np.concatenate([middles, middles], axis=1)
    check_inside(trees, at, (found.at_least, found.at_most), rng)


HARD = [
    0.1, 1 / 3, -0.2, 1.0, -3.0, 1 + 2**-52, 1 - 2**-53, 2.0**-1022, 5e-324, -5e-324, 3e-310,
    1e-300, -1.7e-160, 1.3e-154, 6e153, -1e200, 1.7976931348623157e308, -1e308, 7.0, 1e16 + 2,
]  # fmt: skip
EXACT = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
}


@pytest.mark.parametrize("compiled", [False, True])
def test_rounding_is_outward_and_by_little(compiled):
    pairs = np.array([(a, b) for a in HARD for b in HARD])
    e = enclosing(
        lambda x: [*(BINARY[name][0](x[0], x[1]) for name in EXACT), x[0] * x[0], 0.1 * x[1]],
        2,
        derivatives=False,
        compiled=compiled,
    )
    lower, upper = e(np.stack([pairs, pairs], axis=1))
    assert not np.isnan(lower).any() and not np.isnan(upper).any()
    for (x, y), lows, highs in zip(pairs.tolist(), lower, upper, strict=True):
        a, b = Fraction(x), Fraction(y)
        exact = [f(a, b) for f in EXACT.values()] + [a * a, Fraction(0.1) * b]
        for value, low, high in zip(exact, lows.tolist(), highs.tolist(), strict=True):
            assert low == -math.inf or Fraction(low) <= value
            assert high == math.inf or value <= Fraction(high)
            if abs(value) < Fraction(10) ** 307 and 1e-200 < abs(y) < 1e200:  # 1/y with room
                width = Fraction(high) - Fraction(low)
                assert width <= abs(value) / 2**49 + Fraction(1, 10**299)


def test_roots_and_exact_values():
    e = enclosing(lambda x: [ops.sqrt(x[0]), ops.sqrt(x[0] * x[0] + x[0])], 1, derivatives=False)
    values = np.array([0.0, 5e-324, 1e-310, 2.0, 4.0, 1e300])
    lower, upper = e(np.stack([values, values], axis=1)[:, :, None])
    for x, low, high in zip(values.tolist(), lower.tolist(), upper.tolist(), strict=True):
        assert low[0] <= mp.sqrt(mp.mpf(x)) <= high[0] and low[0] >= 0.0
        assert high[0] - low[0] <= 1e-15 * high[0]
    assert lower[0, 1] == 0.0  # a root of a sum that ends at 0 exists


def test_squares_are_recognised():
    e = enclosing(lambda x: [x[0] * x[0], x[0] ** 4, x[0] ** 2 + x[1] ** 2], 2, compiled=False)
    lower, upper = e(np.array([[[-1.0, -2.0], [2.0, 1.0]]]))
    assert (lower == 0.0).all()
    assert upper[0] == pytest.approx([4.0, 16.0, 8.0], rel=1e-12)


SINGULAR = {
    "inverse": lambda x: 1.0 / x,
    "ratio": lambda x: x / (x * x),
    "root": lambda x: ops.sqrt(x),
    "root of a square less a little": lambda x: ops.sqrt(x * x - 1e-9),
    "logarithm": lambda x: ops.log(x),
    "arc cosine": lambda x: ops.acos(4.0 * x + 1.0),
    "sine of an inverse": lambda x: ops.sin(1.0 / x),
    "limited inverse": lambda x: ops.clip(1.0 / x, -1.0, 1.0),
    "exponential of a logarithm": lambda x: ops.exp(ops.log(x)),
    "angle of an inverse": lambda x: ops.atan2(1.0 / x, 1.0),
    "sign of an inverse": lambda x: ops.copysign(1.0, 1.0 / x),
    "choice by an inverse": lambda x: ops.where(1.0 / x < 0.0, 1.0, 2.0),
    "lesser of an inverse": lambda x: ops.minimum(1.0 / x, 5.0),
    "absolute inverse": lambda x: ops.absolute(1.0 / x) - 3.0,
    "no number": lambda x: x * math.nan,
    "infinite": lambda x: ops.where(x < 0.0, x, math.inf),
}


@pytest.mark.parametrize("derivatives", [False, True])
def test_nothing_is_claimed_where_something_is_undefined(derivatives):
    e = enclosing(
        lambda x: [f(x[0]) for f in SINGULAR.values()], 1, derivatives=derivatives, compiled=False
    )
    lower, upper = e(np.array([[[-0.5], [0.25]], [[-1e-300], [1e-9]], [[-0.25], [0.5]]]))
    assert (lower == -np.inf).all() and (upper == np.inf).all()


def test_an_untaken_branch_does_no_harm():
    def f(x: Any) -> Any:
        positive = ops.less(0.0, x[0])
        return [ops.where(positive, ops.log(ops.where(positive, x[0], 1.0)), -1.0),
                ops.where(x[0] > 0.5, ops.sqrt(x[0] - 0.5), 0.0)]  # fmt: skip

    lower, upper = enclosing(f, 1, compiled=False)(np.array([[[-2.0], [-1.0]], [[1.0], [2.0]]]))
    assert np.isfinite(lower).all() and np.isfinite(upper).all()
    assert lower[0].tolist() == [-1.0, 0.0] and upper[1, 0] == pytest.approx(np.log(2.0))


def test_a_jump_is_enclosed_with_both_sides():
    e = enclosing(
        lambda x: [ops.where(x[0] < 0.3, 5.0, 1.0), ops.sign(x[0] - 0.3) * x[1] + x[1]],
        2,
        compiled=False,
    )
    lower, upper = e(np.array([[[0.0, 1.0], [1.0, 1.5]]]))
    assert lower[0, 0] == 1.0 and upper[0, 0] == 5.0
    assert lower[0, 1] <= 0.0 and upper[0, 1] >= 3.0


def test_a_kink_keeps_slopes():
    e = enclosing(lambda x: ops.absolute(x[0]) - ops.maximum(x[0], 0.0), 1, compiled=False)
    lower, upper = e(np.array([[[-1e-3], [1e-3]]]))
    assert -4e-3 < lower[0, 0] <= 0.0 and 1e-3 <= upper[0, 0] < 4e-3


def test_bounds_shrink_with_the_square_of_the_box():
    def f(x: Any) -> Any:
        return ops.sin(x[0]) * x[1] / (1.0 + x[0] * x[0]) - ops.sqrt(x[0] * x[1]) * ops.exp(-x[1])

    e = enclosing(f, 2, compiled=False)
    centre, direction = np.array([1.2, 0.7]), np.array([1.0, -0.6])
    excess = []
    for w in (0.02, 0.01, 0.005):
        lower, upper = e(np.stack([centre - w * abs(direction), centre + w * abs(direction)])[None])
        grid = np.linspace(-1, 1, 41)
        values = [f(centre + w * abs(direction) * np.array([a, b])) for a in grid for b in grid]
        excess.append((upper - lower)[0, 0] - (max(values) - min(values)))
    assert excess[0] / excess[1] > 3.5 and excess[1] / excess[2] > 3.5


def test_a_kernel_finds_the_same_bounds_as_numpy(rng):
    def f(x: Any) -> Any:
        norm = ops.sqrt(x[0] * x[0] + x[1] * x[1])
        ratio = x[1] / ops.maximum(norm, 0.1)
        return np.array([norm - ratio, ops.where(x[0] < ratio, x[0], -x[1] / (3.0 - x[0])), 1.0])

    boxes = np.sort(boxes_of(rng, 203, 2), axis=1)
    slow, fast = (enclosing(f, 2, compiled=c) for c in (False, True))
    assert fast.compiled and not slow.compiled
    for a, b in zip(slow.enclosure(boxes), fast.enclosure(boxes), strict=True):
        np.testing.assert_array_equal(a, b)
    assert slow(boxes[:0])[0].shape == fast(boxes[:0])[0].shape == (0, 3)


def test_a_kernel_encloses_elementary_functions(rng):
    names = ["sin", "cos", "exp", "log", "acos", "rsqrt", "rint"]
    trees = [(name, 0) for name in names] + [("atan2", 0, 1), ("copysign", 0, 1)]
    boxes = np.sort(boxes_of(rng, 50, 2), axis=1)
    e = enclosing(lambda x: [evaluated(t, x, 0) for t in trees], 2)
    assert check_inside(trees, boxes, e(boxes), rng) > 1000


def test_sines_of_great_angles(rng):
    low = rng.uniform(-2e5, 2e5, (200, 1))
    boxes = np.stack([low, low + 10.0 ** rng.uniform(-6, 1, (200, 1))], axis=1)
    e = enclosing(lambda x: [ops.sin(x[0]), ops.cos(x[0])], 1, compiled=False)
    check_inside([("sin", 0), ("cos", 0)], boxes, e(boxes), rng)


def test_what_is_no_real_function_is_refused():
    with pytest.raises(TraceError, match="exponent"):
        enclosing(lambda x: tp.exponent(x[0]), 1)
    with pytest.raises(TraceError, match="condition"):
        enclosing(lambda x: x[0] < 1.0, 1)
    with pytest.raises(TraceError, match="decides by a value"):
        enclosing(lambda x: x[0] if x[0] > 0 else -x[0], 1)

"""The tape's elementary functions against mpmath, C99's special values and themselves."""

from __future__ import annotations

import math
from functools import cache

import mpmath
import numpy as np
import pytest

from nullmotion import ops
from nullmotion.compile import CompiledFunction, compile_function, elementary, trace
from nullmotion.compile.program import interpret

ARITY = {"sin": 1, "cos": 1, "exp": 1, "log": 1, "acos": 1, "atan2": 2}
LIMIT = 1.5
TINY, SMALLEST, LARGEST = 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308
SPECIAL = [0.0, 0.5, 1.0, 3.0, TINY, SMALLEST, 1e-300, 1e300, LARGEST, math.inf, math.nan]
SPECIAL += [-v for v in SPECIAL]

mp = mpmath.mp.clone()
mp.dps = 50


@cache
def compiled(name: str, fuse: bool = True) -> CompiledFunction:
    """Compile one function."""
    function = getattr(elementary, name)
    return compile_function(function, *[1.0] * ARITY[name], fuse=fuse)


def evaluate(name: str, *arguments: np.ndarray) -> np.ndarray:
    """Evaluate through the compiled kernel."""
    return compiled(name)(*[np.asarray(a, float) for a in arguments])


def ulps(name: str, value: float, *arguments: float) -> float:
    """Return a value's error in units in the last place of the exact result."""
    exact = getattr(mp, name)(*arguments)
    if exact == 0 or math.isinf(value):
        return 0.0 if value == float(exact) else math.inf
    place = max(mp.frexp(exact)[1] - 53, -1074)
    return float(abs(value - exact) * mp.mpf(2) ** -place)


def assert_accurate(name: str, *arguments: np.ndarray) -> None:
    """Compare with mpmath point by point."""
    points = np.array(arguments, float).T
    values = evaluate(name, *arguments)
    errors = [ulps(name, v, *p) for v, p in zip(values.tolist(), points.tolist(), strict=True)]
    worst = int(np.argmax(errors))
    assert errors[worst] <= LIMIT, f"{name}{tuple(points[worst])} is {errors[worst]:.3f} ulp off"


def same(a: float, b: float) -> bool:
    """Return whether two values are the same double, signs of zero included (any NaN is one)."""
    return (a == b and math.copysign(1.0, a) == math.copysign(1.0, b)) or (
        math.isnan(a) and math.isnan(b)
    )


def log_uniform(draw: np.random.Generator, low: float, high: float, count: int) -> np.ndarray:
    """Draw magnitudes 2**low to 2**high with random signs."""
    return np.exp2(draw.uniform(low, high, count)) * draw.choice([-1.0, 1.0], count)


@pytest.fixture
def draw() -> np.random.Generator:
    """Return a generator of random numbers with a fixed seed."""
    return np.random.default_rng(20240)


@pytest.mark.parametrize("name", ["sin", "cos"])
def test_circular_functions(name: str, draw: np.random.Generator) -> None:
    quarter_turns = draw.integers(1, 63662, 500)
    # 29 * 2**j quarter turns have the doubles nearest to them below 1e5
    quarter_turns = np.append(quarter_turns, [*range(1, 60), 116, 232, 464, 928, 1856, 63661])
    near = quarter_turns * (math.pi / 2)
    assert_accurate(name, np.concatenate([near, np.nextafter(near, 0.0), -np.nextafter(near, 1e9)]))
    odd_eighths = draw.integers(0, 4, 1500) * (math.pi / 2) + draw.uniform(0.7, 0.8, 1500)
    assert_accurate(name, odd_eighths)
    limit = elementary.GUARDED_LIMIT
    assert_accurate(name, np.append(draw.uniform(-limit, limit, 2000), [limit, -limit]))
    assert_accurate(name, log_uniform(draw, -1074, 2, 500))


def test_exp(draw: np.random.Generator) -> None:
    assert_accurate("exp", draw.uniform(-0.4, 0.4, 2000))
    assert_accurate("exp", draw.uniform(-708.0, 709.78, 2000))
    assert_accurate("exp", draw.uniform(-746.0, -708.0, 500))
    assert_accurate("exp", log_uniform(draw, -1074, 0, 300))
    # the last doubles before overflow and before underflow to zero
    assert_accurate("exp", np.array([709.782712893384, 709.7827128933839, -745.1332191019411]))
    assert evaluate("exp", [709.7827128933841, 1e5, LARGEST]).tolist() == [math.inf] * 3
    assert evaluate("exp", [-745.1332191019412, -746.0, -1e5, -LARGEST]).tolist() == [0.0] * 4


def test_log(draw: np.random.Generator) -> None:
    assert_accurate("log", draw.uniform(0.5, 2.0, 2500))
    assert_accurate("log", 1.0 + log_uniform(draw, -52, -1, 1500))
    assert_accurate("log", np.abs(log_uniform(draw, -1074, 1023.99, 1500)))
    assert_accurate("log", np.array([TINY, 2 * TINY, SMALLEST, np.nextafter(SMALLEST, 0), LARGEST]))


def test_acos(draw: np.random.Generator) -> None:
    assert_accurate("acos", draw.uniform(-1.0, 1.0, 2000))
    assert_accurate("acos", draw.uniform(0.45, 0.55, 1000))
    near_one = 1.0 - np.abs(log_uniform(draw, -53, -1, 1000))
    assert_accurate("acos", np.concatenate([near_one, -near_one, [1.0, -1.0, 0.5, -0.5]]))
    assert_accurate("acos", log_uniform(draw, -1074, -1, 300))
    outside = [1.0000000000000002, -1.0000000000000002, 2.0, -1e300, math.inf, -math.inf]
    assert np.isnan(evaluate("acos", outside)).all()


def test_atan2(draw: np.random.Generator) -> None:
    assert_accurate("atan2", draw.uniform(-1, 1, 1500), draw.uniform(-1, 1, 1500))
    assert_accurate("atan2", draw.uniform(0.2, 0.6, 1500), np.ones(1500))
    assert_accurate("atan2", log_uniform(draw, -4, 4, 1000), log_uniform(draw, -4, 4, 1000))
    # every pair of magnitudes, then pairs of like magnitude near overflow and underflow
    wide = [log_uniform(draw, -1074, 1023.99, 1000) for _ in range(2)]
    assert_accurate("atan2", *wide)
    for low, high in ((1022, 1023.99), (-1074, -1021), (-1000, -960)):
        both = [log_uniform(draw, low, high, 300) for _ in range(2)]
        assert_accurate("atan2", *both)
        assert_accurate("atan2", both[0], both[0] * draw.uniform(0.4, 0.9, 300))


@pytest.mark.parametrize(
    ("name", "argument", "result"),
    [
        ("sin", 0.0, 0.0),
        ("sin", -0.0, -0.0),
        ("sin", TINY, TINY),
        ("sin", -SMALLEST, -SMALLEST),
        ("cos", -0.0, 1.0),
        ("exp", 0.0, 1.0),
        ("exp", -0.0, 1.0),
        ("exp", math.inf, math.inf),
        ("exp", -math.inf, 0.0),
        ("log", 1.0, 0.0),
        ("log", 0.0, -math.inf),
        ("log", -0.0, -math.inf),
        ("log", math.inf, math.inf),
        ("acos", 1.0, 0.0),
        ("acos", 0.0, math.pi / 2),
        ("acos", -1.0, math.pi),
        *[(name, math.inf, math.nan) for name in ("sin", "cos", "acos")],
        *[(name, -math.inf, math.nan) for name in ("sin", "cos", "acos", "log")],
        *[(name, math.nan, math.nan) for name in ("sin", "cos", "acos", "log", "exp")],
        *[("log", x, math.nan) for x in (-TINY, -1.0, -LARGEST)],
    ],
)
def test_special_values(name: str, argument: float, result: float) -> None:
    assert same(evaluate(name, [argument])[0], result)


def test_atan2_special_values() -> None:
    y, x = (a.ravel() for a in np.meshgrid(SPECIAL, SPECIAL))
    for value, *point in zip(evaluate("atan2", y, x), y, x, strict=True):
        expected = math.atan2(*point)  # the C library's
        exact = 0.0 in point or not np.isfinite(point).all() or abs(point[0]) == abs(point[1])
        assert (
            same(value, expected)
            if exact
            else value == pytest.approx(expected, rel=3e-16, abs=TINY)
        )


def test_reciprocal_roots(draw: np.random.Generator) -> None:
    x = np.abs(np.concatenate([log_uniform(draw, -1022, 1023.99, 2000), draw.uniform(1, 4, 2000)]))
    x = np.append(x, [SMALLEST, LARGEST, 1.0])
    fine, rough = (compile_function(lambda v, r=r: ops.rsqrt(v, r), 1.0)(x) for r in (False, True))
    exact = [1 / mp.sqrt(v) for v in x.tolist()]
    for value, coarse, truth in zip(fine.tolist(), rough.tolist(), exact, strict=True):
        assert abs(value - truth) <= LIMIT * mp.mpf(2) ** (mp.frexp(truth)[1] - 53)
        assert abs(coarse / truth - 1) <= 4e-7


@pytest.mark.parametrize("rough", [False, True])
def test_reciprocal_root_of_nothing_is_finite(rough: bool) -> None:
    x = np.array([0.0, TINY, 1e-310])
    found = compile_function(lambda v: ops.rsqrt(v, rough), 1.0)(x)
    assert np.isfinite(found).all() and (found > 1e100).all() and (x * found)[0] == 0.0
    assert np.isfinite(ops.rsqrt(x, rough)).all()
    assert ops.rsqrt(4.0, rough) == 0.5


def test_sine_and_cosine_share_their_work() -> None:
    both, _ = trace(lambda x: (elementary.sin(x), elementary.cos(x)), 1.0)
    assert both.operations <= 33  # two of them the guard


@pytest.mark.parametrize("name", ["sin", "cos"])
def test_angles_out_of_range_are_reported(name: str) -> None:
    limit = elementary.GUARDED_LIMIT
    beyond = np.nextafter(limit, math.inf)
    evaluate(name, [0.0, -limit, limit, beyond, -beyond, 1e300, math.inf, math.nan])
    assert compiled(name).status.tolist() == [[False] * 3 + [True] * 5]


@pytest.mark.parametrize("name", ARITY)
def test_every_target_gives_the_same_bits(name: str, draw: np.random.Generator) -> None:
    arguments = [
        draw.uniform(0.0, 1.0, 200) * draw.choice([1.0, 1e-3], 200) for _ in range(ARITY[name])
    ]
    values = evaluate(name, *arguments)
    assert np.array_equal(values, compiled(name, fuse=False)(*arguments))
    (interpreted,) = interpret(compiled(name).program, [a[:40] for a in arguments])
    assert np.array_equal(values[:40], interpreted)


@pytest.mark.parametrize(
    ("parts", "value", "bits"),
    [
        (elementary._PI_2, mp.pi / 2, 138),
        (elementary._PI_4, mp.pi / 4, 100),
        (elementary._LN2, mp.log(2), 94),
    ],
)
def test_split_constants(parts: tuple[float, ...], value: mpmath.mpf, bits: int) -> None:
    assert abs(mp.fsum(parts) - value) < mp.mpf(2) ** -bits
